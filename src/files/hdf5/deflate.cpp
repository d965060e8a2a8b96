#include "files/hdf5/deflate.hpp"

#include <zlib.h>

#include <algorithm>

#include "carom/base/error.hpp"
#ifdef CAROM_ISAL
#include <isa-l/igzip_lib.h>
#endif

namespace carom::files::hdf5 {

namespace {

void failed() { throw InternalError("bytes could not be deflated"); }

}  // namespace

bool has(DeflateLibrary library) {
#ifdef CAROM_ISAL
  return library == DeflateLibrary::isal || library == DeflateLibrary::zlib;
#else
  return library == DeflateLibrary::zlib;
#endif
}

void Deflate::start() { made_.assign({0x78, 0x01}); }

// Blocks of at most 65535 bytes, each with its length and the complement of that (RFC 1951, 3.2.4).
void Deflate::store(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const auto size = static_cast<unsigned>(std::min<std::size_t>(bytes.size(), 65535));
    for (const unsigned byte : {0u, size & 255u, size >> 8, ~size & 255u, ~size >> 8 & 255u})
      made_.push_back(static_cast<std::uint8_t>(byte));
    made_.insert(made_.end(), bytes.begin(), bytes.begin() + size);
    bytes = bytes.subspan(size);
  }
}

void Deflate::deflate(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return;
  library_ == DeflateLibrary::isal ? deflate_by_isal(bytes) : deflate_by_zlib(bytes);
}

// Both end at a whole byte, by an empty stored block (a full flush).
void Deflate::deflate_by_isal([[maybe_unused]] std::span<const std::uint8_t> bytes) {
#ifdef CAROM_ISAL
  const std::size_t before = made_.size();
  made_.resize(before + bytes.size() + bytes.size() / 8 + 512);
  room_.resize(ISAL_DEF_LVL1_DEFAULT);
  isal_zstream stream;
  isal_deflate_stateless_init(&stream);
  stream.level = 1;
  stream.level_buf = room_.data();
  stream.level_buf_size = static_cast<std::uint32_t>(room_.size());
  stream.flush = FULL_FLUSH;
  stream.end_of_stream = 0;
  stream.next_in = const_cast<std::uint8_t*>(bytes.data());
  stream.avail_in = static_cast<std::uint32_t>(bytes.size());
  stream.next_out = made_.data() + before;
  stream.avail_out = static_cast<std::uint32_t>(made_.size() - before);
  if (isal_deflate_stateless(&stream) != COMP_OK || stream.avail_in != 0) failed();
  made_.resize(before + stream.total_out);
#endif
}

void Deflate::deflate_by_zlib(std::span<const std::uint8_t> bytes) {
  z_stream stream{};
  if (deflateInit2(&stream, 1, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY) != Z_OK) failed();
  const std::size_t before = made_.size();
  made_.resize(before + deflateBound(&stream, bytes.size()) + 16);
  stream.next_in = const_cast<std::uint8_t*>(bytes.data());
  stream.avail_in = static_cast<unsigned>(bytes.size());
  stream.next_out = made_.data() + before;
  stream.avail_out = static_cast<unsigned>(made_.size() - before);
  const bool done = ::deflate(&stream, Z_FULL_FLUSH) == Z_OK && stream.avail_in == 0;
  made_.resize(before + stream.total_out);
  deflateEnd(&stream);
  if (!done) failed();
}

std::span<const std::uint8_t> Deflate::finish(std::span<const std::uint8_t> all) {
  made_.insert(made_.end(), {0x01, 0x00, 0x00, 0xff, 0xff});  // the last block, empty
#ifdef CAROM_ISAL
  const std::uint32_t sum = isal_adler32(1, all.data(), all.size());
#else
  const auto sum = static_cast<std::uint32_t>(adler32_z(1, all.data(), all.size()));
#endif
  for (int shift = 24; shift >= 0; shift -= 8)
    made_.push_back(static_cast<std::uint8_t>(sum >> shift));
  return made_;
}

}  // namespace carom::files::hdf5
