// A stream of zlib whose parts are either stored as they are or deflated by a library.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace carom::files::hdf5 {

/// ISA-L deflates in a tenth of zlib's time (docs/developer/archives.md); what reads a stream of
/// one reads one of the other.
enum class DeflateLibrary { isal, zlib };
bool has(DeflateLibrary);

class Deflate {
 public:
  explicit Deflate(DeflateLibrary library) : library_(library) {}
  /// Begins a stream.
  void start();
  void store(std::span<const std::uint8_t>);
  void deflate(std::span<const std::uint8_t>);
  /// `all` that was added, one after the other. The stream is valid until the next start.
  std::span<const std::uint8_t> finish(std::span<const std::uint8_t> all);

 private:
  void deflate_by_isal(std::span<const std::uint8_t>);
  void deflate_by_zlib(std::span<const std::uint8_t>);

  DeflateLibrary library_;
  std::vector<std::uint8_t> made_, room_;  ///< room_: memory of ISA-L
};

}  // namespace carom::files::hdf5
