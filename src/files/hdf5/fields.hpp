// The fields of structs (carom/base/fields.hpp) as datasets: numbers of a group, and rows.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "carom/base/error.hpp"
#include "carom/base/fields.hpp"
#include "files/hdf5/columns.hpp"
#include "files/hdf5/hdf5.hpp"

namespace carom::files {

/// Throws InputError: what an archive holds cannot be.
[[noreturn]] void damaged(const std::string& name, const std::string& problem);

/// The name of a field's dataset.
inline std::string dataset_name(const Label& label) {
  std::string name = label.name;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}
inline hdf5::Description description_of(const Label& label) { return {label.unit, label.text}; }

/// The only number of a dataset.
template <class T>
T read_number(hid_t group, const std::string& dataset, const std::string& file) {
  const std::vector<T> values = hdf5::read_column<T>(group, dataset.c_str(), file);
  if (values.size() != 1)
    damaged(file, "'" + hdf5::path_of(group, file) + "/" + dataset + "' is not one number");
  return values.front();
}

template <class Struct, class List = Fields<Struct>>
void write_numbers(hid_t group, const Struct& s, const std::string& file) {
  each_field<List>([&](const auto& one) {
    hdf5::write_number(group, dataset_name(one.label).c_str(), one.kept(s),
                       description_of(one.label), file);
  });
}
template <class Struct, class List = Fields<Struct>>
void read_numbers(hid_t group, Struct& s, const std::string& file) {
  each_field<List>([&](const auto& one) {
    const std::string name = dataset_name(one.label);
    one.set(s, read_number<typename std::decay_t<decltype(one)>::kept_type>(group, name, file));
  });
}

/// Rows that are appended in batches; a value as in Row() is the usual one of its column.
template <class Row, class List = Fields<Row>>
class Rows {
 public:
  explicit Rows(std::string file, double expected = 0.0) : columns_(std::move(file), expected) {}

  void create(hid_t group) {
    each_field<List>([&](const auto& one) {
      made_.emplace_back(one.label.name, columns_.add(group, dataset_name(one.label).c_str(),
                                                      description_of(one.label), one.kept(Row())));
    });
  }
  /// A column that was just created, for its attributes.
  hid_t column(std::string_view name) const {
    return std::find_if(made_.begin(), made_.end(), [&](const auto& m) { return m.first == name; })
        ->second;
  }
  void open(hid_t group) {
    each_field<List>([&](const auto& one) {
      columns_.open(group, dataset_name(one.label).c_str(), one.kept(Row()));
    });
  }
  void add(const Row& row) {
    std::apply([&](const auto&... one) { columns_.row(one.kept(row)...); }, List::list);
  }
  void close(hdf5::KnownSums* sums = nullptr) { columns_.close(sums); }

 private:
  hdf5::Columns columns_;
  std::vector<std::pair<std::string_view, hid_t>> made_;
};

/// Columns that are written at once. Fixed in size.
template <class Row, class List = Fields<Row>>
void write_columns(hid_t group, std::span<const Row> rows, const std::string& file) {
  each_field<List>([&](const auto& one) {
    std::vector<typename std::decay_t<decltype(one)>::kept_type> values;
    values.reserve(rows.size());
    for (const Row& row : rows) values.push_back(one.kept(row));
    hdf5::write_column(group, dataset_name(one.label).c_str(), std::span(std::as_const(values)),
                       description_of(one.label), file);
  });
}

template <class Row, class List = Fields<Row>>
class RowReader {
 public:
  /// Throws InputError where columns are missing or differ in length.
  RowReader(hid_t group, std::string file) : file_(std::move(file)) {
    each_field<List>([&](const auto& one) {
      const std::string name = dataset_name(one.label);
      if (one.later && !hdf5::has(group, name.c_str())) {
        columns_.emplace_back();
        return;
      }
      columns_.push_back(hdf5::open_column(group, name.c_str(), file_));
      const std::size_t count = hdf5::rows_of(columns_.back().get(), file_);
      if (known_ && count != rows_)
        damaged(file_, "'" + hdf5::path_of(columns_.back().get(), file_) +
                           "' has another length than its neighbours");
      rows_ = count;
      known_ = true;
    });
  }
  std::size_t rows() const { return rows_; }
  /// Sets rows first … first + into.size() - 1.
  void read(std::size_t first, std::span<Row> into) const {
    if (into.empty()) return;
    std::size_t number = 0;
    each_field<List>([&](const auto& one) {
      using T = typename std::decay_t<decltype(one)>::kept_type;
      const hdf5::Handle& column = columns_[number++];
      if (!column) return;
      std::vector<T> values(into.size());
      hdf5::read_rows(column.get(), hdf5::native_type<T>(), first, values.size(), values.data(),
                      file_);
      for (std::size_t i = 0; i < into.size(); ++i) {
        one.set(into[i], values[i]);
        if constexpr (std::is_integral_v<T>)
          if (one.kept(into[i]) != values[i])
            damaged(file_, "'" + hdf5::path_of(column.get(), file_) + "' holds what cannot be");
      }
    });
  }

 private:
  std::string file_;
  std::vector<hdf5::Handle> columns_;
  std::size_t rows_ = 0;
  bool known_ = false;
};

template <class Row, class List = Fields<Row>>
std::vector<Row> read_all_rows(hid_t group, const std::string& file) {
  const RowReader<Row, List> reader(group, file);
  std::vector<Row> rows(reader.rows());
  reader.read(0, rows);
  return rows;
}

/// Overwrites columns that were created with as many rows.
template <class Row, class List = Fields<Row>>
void overwrite_columns(hid_t group, std::span<const Row> rows, const std::string& file) {
  each_field<List>([&](const auto& one) {
    using T = typename std::decay_t<decltype(one)>::kept_type;
    const std::string name = dataset_name(one.label);
    std::vector<T> values;
    for (const Row& row : rows) values.push_back(one.kept(row));
    hdf5::Handle dataset =
        hdf5::checked(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose, file);
    hdf5::check(values.empty() || H5Dwrite(dataset.get(), hdf5::native_type<T>(), H5S_ALL, H5S_ALL,
                                           H5P_DEFAULT, values.data()) >= 0,
                file);
    hdf5::check(dataset.close(), file);
  });
}
template <class Row, class List = Fields<Row>>
void create_columns(hid_t group, std::size_t rows, const std::string& file) {
  each_field<List>([&](const auto& one) {
    hdf5::create_fixed(group, dataset_name(one.label).c_str(),
                       hdf5::native_type<typename std::decay_t<decltype(one)>::kept_type>(), rows,
                       description_of(one.label), file);
  });
}

}  // namespace carom::files
