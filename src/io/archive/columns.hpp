// Datasets of one length that grow together, row by row, in batches.
#pragma once

#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

#include "io/archive/hdf5.hpp"

namespace carom::io::hdf5 {

class Columns {
 public:
  Columns() = default;
  explicit Columns(std::string file) : file_(std::move(file)) {}

  /// Adds a column; rows are pushed in the order in which columns were added.
  template <class T>
  hid_t add(hid_t group, const char* name, Description description) {
    return take(create_growing(group, name, native_type<T>(), chunk, description, file_),
                native_type<T>());
  }
  /// The same for a column that is in the file already; new rows follow the old ones.
  template <class T>
  void open(hid_t group, const char* name) {
    take(checked(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose, file_), native_type<T>());
    rows_ = rows_of(columns_.back().dataset.get(), file_);
  }

  template <class... Values>
  void row(Values... values) {
    std::size_t column = 0;
    (push(columns_[column++], values), ...);
    if ((rows_ + ++pending_) % batch == 0) flush();
  }

  /// Writes what is pending and makes it visible to readers.
  void flush() {
    if (pending_ == 0) return;
    for (Column& column : columns_) {
      append_rows(column.dataset.get(), column.type, rows_, pending_, column.values.data(), file_);
      check(H5Dflush(column.dataset.get()) >= 0, file_);
    }
    rows_ += pending_;
    pending_ = 0;
  }

  void close() {
    flush();
    for (Column& column : columns_) check(column.dataset.close(), file_);
    columns_.clear();
  }

 private:
  // Rows written at a time, and rows stored together: short runs make small files. A batch fills
  // its chunks, so that a reader never meets a chunk that is being written again.
  static constexpr std::size_t batch = 4096, chunk = 1024;
  static_assert(batch % chunk == 0);
  struct Column {
    Handle dataset;
    hid_t type;
    std::vector<std::byte> values;  ///< of the rows that are pending
  };

  hid_t take(Handle dataset, hid_t type) {
    columns_.push_back(
        {std::move(dataset), type, std::vector<std::byte>(batch * H5Tget_size(type))});
    return columns_.back().dataset.get();
  }
  template <class T>
  void push(Column& column, T value) {
    std::memcpy(column.values.data() + pending_ * sizeof value, &value, sizeof value);
  }

  std::string file_;
  std::vector<Column> columns_;
  std::size_t rows_ = 0, pending_ = 0;
};

}  // namespace carom::io::hdf5
