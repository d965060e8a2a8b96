// What systems do each in their own way.
#pragma once

#include <cstdint>
#include <filesystem>

namespace carom::files {

/// The file of this program; empty where the system does not say.
std::filesystem::path path_of_program();
/// Waits until the disk has what was written to the file; the contents and their length are enough.
/// False: errno says why it has not.
bool sync_contents(int descriptor);
/// The same with dates and rights, or the names in a folder.
bool sync_all(int descriptor);

/// What a Mac does, compiled everywhere.
namespace portable {

/// `ask` fills a buffer with a path. Where it is too short, it returns another number than 0, and
/// in `size` the length that is enough.
std::filesystem::path path_of_program(int (*ask)(char* path, std::uint32_t* size));
/// By the fcntl command `full`, which empties the disk's own memory too; by fsync where a disk does
/// not know it.
bool sync(int descriptor, int full);

}  // namespace portable

}  // namespace carom::files
