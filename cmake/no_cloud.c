/* What HDF5 asks of libcurl and libcrypto to read files in the cloud, for programs that hold HDF5 themselves (archives.cmake).
   Carom opens no such file: nobody calls these. */
#define NOBODY_CALLS(name) void* name(void); void* name(void) { return 0; }
NOBODY_CALLS(curl_easy_cleanup)
NOBODY_CALLS(curl_easy_init)
NOBODY_CALLS(curl_easy_perform)
NOBODY_CALLS(curl_easy_setopt)
NOBODY_CALLS(curl_global_cleanup)
NOBODY_CALLS(curl_global_init)
NOBODY_CALLS(curl_slist_append)
NOBODY_CALLS(curl_slist_free_all)
NOBODY_CALLS(EVP_sha256)
NOBODY_CALLS(HMAC)
NOBODY_CALLS(SHA256)
