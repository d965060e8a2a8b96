#include "files/hdf5/columns.hpp"

#include <algorithm>
#include <future>
#include <thread>

namespace carom::files::hdf5 {

hid_t Columns::take(Handle dataset, hid_t type, const void* usual) {
  const std::size_t size = H5Tget_size(type);
  std::vector<std::uint8_t> chunk(chunk_ * size);
  for (std::size_t i = 0; i < chunk_; ++i) std::memcpy(chunk.data() + i * size, usual, size);
  const bool packed = is_packed(dataset.get(), file_);
  columns_.push_back({std::move(dataset), type, size, packed, std::move(chunk),
                      std::vector<std::uint8_t>(batch() * size)});
  return columns_.back().dataset.get();
}

void Columns::open(Handle dataset, hid_t type, const void* usual) {
  chunk_ = chunk_of(dataset.get(), file_);
  rows_ = rows_of(dataset.get(), file_);
  until_full_ = batch() - rows_ % batch();
  whole_ = false;
  take(std::move(dataset), type, usual);
}

void Columns::flush() {
  if (pending_ == 0) return;
  const bool one_chunk = pending_ == chunk_ && rows_ % chunk_ == 0;
  const auto prepare = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      Column& column = columns_[i];
      const std::span<const std::uint8_t> values(column.values.data(), pending_ * column.size);
      if (whole_) column.sum = crc32(values.data(), values.size(), column.sum);
      if (one_chunk && column.packed && !is_usual(column, values))
        column.chunk = column.packer.pack(values, column.size);
    }
  };
  // Packing takes half of a run's time. Columns are independent, so two threads share it; OpenMP's
  // would wait for the next batch awake.
  const std::size_t half =
      one_chunk && std::thread::hardware_concurrency() > 1 ? columns_.size() / 2 : 0;
  std::future<void> others;
  if (half > 0) others = std::async(std::launch::async, prepare, 0, half);
  prepare(half, columns_.size());
  if (half > 0) others.get();
  for (Column& column : columns_) {
    write(column);
    column.chunk.reset();
    check(H5Dflush(column.dataset.get()) >= 0, file_);
  }
  rows_ += pending_;
  pending_ = 0;
  until_full_ = batch() - rows_ % batch();
}

bool Columns::is_usual(const Column& column, std::span<const std::uint8_t> values) {
  return std::memcmp(values.data(), column.usual.data(), values.size()) == 0;
}

// Chunk by chunk. A chunk that is begun here and holds nothing but usual values need not be stored.
void Columns::write(Column& column) {
  extend(column.dataset.get(), rows_ + pending_, file_);
  for (std::size_t row = 0; row < pending_;) {
    const std::size_t in_chunk = (rows_ + row) % chunk_;
    const std::size_t count = std::min(chunk_ - in_chunk, pending_ - row);
    const std::uint8_t* values = column.values.data() + row * column.size;
    const bool begins = in_chunk == 0;
    if (column.chunk)
      write_packed_chunk(column.dataset.get(), rows_ + row, *column.chunk, file_);
    else if (begins && is_usual(column, {values, count * column.size}))
      ;  // the dataset's fill value says it
    else if (begins && count == chunk_ && column.packed)
      write_packed_chunk(column.dataset.get(), rows_ + row,
                         column.packer.pack({values, count * column.size}, column.size), file_);
    else
      write_rows(column.dataset.get(), column.type, rows_ + row, count, values, file_);
    row += count;
  }
}

void Columns::close(KnownSums* sums) {
  flush();
  for (Column& column : columns_) {
    if (sums && whole_) (*sums)[path_of(column.dataset.get(), file_)] = {column.sum, rows_};
    check(column.dataset.close(), file_);
  }
  columns_.clear();
}

}  // namespace carom::files::hdf5
