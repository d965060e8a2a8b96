// Datasets of one length that grow together, row by row, in batches.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "files/hdf5/checksums.hpp"
#include "files/hdf5/hdf5.hpp"

namespace carom::files::hdf5 {

class Columns {
 public:
  Columns() = default;
  /// Few rows are stored in small chunks, so that short runs make small files; where very many are
  /// expected, HDF5 is called less often.
  explicit Columns(std::string file, double expected_rows = 0.0)
      : file_(std::move(file)),
        chunk_(expected_rows < 4.0 * long_chunk ? short_chunk : long_chunk) {}

  /// Adds a column; rows are pushed in the order in which columns were added. Chunks in which each
  /// value is `usual` are not stored: HDF5 knows them by the dataset's fill value.
  template <class T>
  hid_t add(hid_t group, const char* name, Description description, T usual = {}) {
    return take(create_growing(group, name, native_type<T>(), chunk_, description, file_, &usual),
                native_type<T>(), &usual);
  }
  /// The same for a column that is in the file already; new rows follow the old ones.
  template <class T>
  void open(hid_t group, const char* name, T usual = {}) {
    open(checked(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose, file_), native_type<T>(), &usual);
  }

  template <class... Values>
  void row(Values... values) {
    std::size_t column = 0;
    (push(columns_[column++], values), ...);
    if (++pending_ == until_full_) flush();
  }

  /// Writes what is pending and makes it visible to readers.
  void flush();
  /// `sums`: takes the checksums of columns that were written from their first row on.
  void close(KnownSums* sums = nullptr);

 private:
  // Rows written at a time, and rows stored together. A batch fills its chunks, so that a reader
  // never meets a chunk that is being written again.
  static constexpr std::size_t short_batch = 4096, short_chunk = 1024, long_chunk = 16384;
  static_assert(short_batch % short_chunk == 0 && long_chunk % short_batch == 0);
  struct Column {
    Handle dataset;
    hid_t type;
    std::size_t size;                  ///< of a value
    bool packed;                       ///< whole chunks go past HDF5's filters
    std::vector<std::uint8_t> usual;   ///< a chunk of the usual value
    std::vector<std::uint8_t> values;  ///< of the rows that are pending
    std::uint32_t sum = 0;             ///< of the rows that were written
    ChunkPacker packer{};
    std::optional<ChunkPacker::Packed> chunk = {};  ///< all pending rows, packed
  };

  hid_t take(Handle dataset, hid_t type, const void* usual);
  void open(Handle dataset, hid_t type, const void* usual);
  static bool is_usual(const Column&, std::span<const std::uint8_t> values);
  void write(Column& column);
  std::size_t batch() const { return chunk_ < short_batch ? short_batch : chunk_; }
  void push(Column& column, auto value) {
    std::memcpy(column.values.data() + pending_ * sizeof value, &value, sizeof value);
  }

  std::string file_;
  std::vector<Column> columns_;
  std::size_t chunk_ = short_chunk;
  std::size_t rows_ = 0, pending_ = 0;
  std::size_t until_full_ = batch();  ///< pending rows that end a batch
  bool whole_ = true;                 ///< all rows went through here
};

}  // namespace carom::files::hdf5
