// Reads what describe() says of a result (results/describe_ends.hpp) from an archive. Everything
// throws InputError where datasets are missing or cannot be.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "carom/results/fate_counts.hpp"
#include "files/checkpoint/ensemble_columns.hpp"
#include "files/hdf5/exact_sums.hpp"
#include "files/hdf5/fields.hpp"

namespace carom::files {

class ArchiveIn {
 public:
  static constexpr bool reads = true;
  ArchiveIn(hid_t file, const std::string& name) : file_(file), name_(name) {}

  void group(const char* path, const char*) {
    group_ = open_group(file_, path, name_);
    path_ = path;
  }
  bool group_if(bool, const char* path, const char* text) {
    const bool there = hdf5::has(file_, path);
    if (there) group(path, text);
    return there;
  }
  /// A column of any group.
  template <class T>
  std::vector<T> values(const char* group, const char* column) const {
    return hdf5::read_column<T>(open_group(file_, group, name_).get(), column, name_);
  }
  void expect(bool fits, const char* problem) const {
    if (!fits) damaged(name_, "'/" + path_ + "' " + problem);
  }
  bool has_if(bool, const char* column) const { return hdf5::has(id(), column); }

  template <class T>
  void number(const Label& label, T& value) {
    value = read_number<T>(id(), dataset_name(label), name_);
  }
  bool kept_if(bool, const Label& label, auto& value) {
    const bool there = hdf5::has(id(), dataset_name(label).c_str());
    if (there) number(label, value);
    return there;
  }
  void number_if(bool, const Label& label, auto& value) { kept_if(true, label, value); }
  void kept(const Label& label, auto& value) { number(label, value); }
  void kept_numbers(auto& s) { read_numbers(id(), s, name_); }
  template <class Struct>
  void numbers_if(bool, Struct& s) {
    const Label& first = std::get<0>(Fields<Struct>::list).label;
    if (hdf5::has(id(), dataset_name(first).c_str())) kept_numbers(s);
  }
  void fates(FateCounts& counts, std::uint64_t all) { counts = read_fates(group_, name_, all); }

  template <class T>
  void kept_all(const Label& label, std::vector<T>& values) {
    values = hdf5::read_column<T>(id(), dataset_name(label).c_str(), name_);
  }
  template <class T>
  void kept_column(const Label& label, std::vector<T>& values, std::size_t count) {
    kept_all(label, values);
    if (values.size() != count) lost(label);
  }
  void kept_each(const Label& label, std::size_t count, auto get) {
    std::vector<std::decay_t<decltype(get(0))>> values;
    kept_column(label, values, count);
    for (std::size_t i = 0; i < count; ++i) get(i) = values[i];
  }
  template <class T, class Count>
  void first_rows(const Label& label, std::vector<T>& values, Count) {
    std::vector<T> first;
    kept_all(label, first);
    if (first.size() > values.size())
      damaged(name_, "'/" + path_ + "/" + label.name + "' is too long");
    std::copy(first.begin(), first.end(), values.begin());
  }
  void named_column(const Label& label, std::vector<std::uint64_t>& values, auto) {
    if (hdf5::has(id(), label.name)) kept_all(label, values);
  }
  template <class Bins>
  void bins(const Label& from, const Label& count, Bins& bins) {
    std::vector<double> starts;
    std::vector<std::uint64_t> counts;
    kept_all(from, starts);
    kept_column(count, counts, starts.size());
    for (std::size_t i = 0; i < starts.size(); ++i) {
      expect(starts[i] > 0.0 && Bins::bin_of(starts[i]).from == starts[i],
             "has a row that is not the start of a bin");
      bins.add(starts[i], counts[i]);
    }
  }
  void sums(const Label& label, std::size_t count, auto get) {
    std::vector<ExactSum> all = read_sums(group_, path_, label.name, count, name_);
    for (std::size_t i = 0; i < count; ++i) get(i) = std::move(all[i]);
  }
  void rows(auto) {}
  void kept_rows(auto) {}
  void computed(const Label&, auto) {}
  template <class Struct>
  void provenance(Struct& s) {
    const hdf5::Handle group = open_group(file_, "provenance", name_);
    each_field<Fields<Struct>>([&](const auto& one) {
      one.set(s, static_cast<std::uint64_t>(
                     hdf5::read_attribute<std::int64_t>(group.get(), one.label.name, name_)));
    });
  }

 private:
  hid_t id() const { return group_.get(); }
  [[noreturn]] void lost(const Label& label) const {
    damaged(name_, "'/" + path_ + "/" + label.name + "' has lost rows");
  }

  hid_t file_;
  const std::string& name_;
  hdf5::Handle group_;
  std::string path_;
};

}  // namespace carom::files
