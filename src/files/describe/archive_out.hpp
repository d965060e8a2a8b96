// Writes what describe() says of a result (results/describe_ends.hpp) as groups of an archive.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "carom/files/ensembles.hpp"
#include "files/hdf5/archive_file.hpp"
#include "files/hdf5/exact_sums.hpp"
#include "files/hdf5/fields.hpp"

namespace carom::files {

class ArchiveOut {
 public:
  static constexpr bool reads = false;
  explicit ArchiveOut(const ArchiveFile& file) : file_(file) {}

  void group(const char* path, const char* text) { group_ = file_.group(path, text); }
  bool group_if(bool there, const char* path, const char* text) {
    if (there) group(path, text);
    return there;
  }
  bool has_if(bool there, const char*) { return there; }

  void number(const Label& label, const auto& value) {
    hdf5::write_number(id(), dataset_name(label).c_str(), value, description_of(label), name());
  }
  void number_if(bool there, const Label& label, const auto& value) {
    if (there) number(label, value);
  }
  void kept(const Label& label, const auto& value) { number(label, value); }
  bool kept_if(bool there, const Label& label, const auto& value) {
    number_if(there, label, value);
    return there;
  }
  void kept_numbers(const auto& s) { write_numbers(id(), s, name()); }
  void numbers_if(bool there, const auto& s) {
    if (there) kept_numbers(s);
  }
  void fates(const auto& counts, std::uint64_t) { write_numbers<FateCounts>(id(), counts, name()); }

  template <class T>
  void kept_all(const Label& label, const std::vector<T>& values) {
    hdf5::write_column(id(), dataset_name(label).c_str(), std::span(values), description_of(label),
                       name());
  }
  template <class T>
  void kept_column(const Label& label, const std::vector<T>& values, std::size_t) {
    kept_all(label, values);
  }
  void kept_each(const Label& label, std::size_t count, auto get) {
    std::vector<std::decay_t<decltype(get(0))>> values;
    for (std::size_t i = 0; i < count; ++i) values.push_back(get(i));
    kept_all(label, values);
  }
  /// The first ones alone.
  template <class T, class Count>
  void first_rows(const Label& label, const std::vector<T>& values, Count count) {
    kept_each(label, count(), [&](std::size_t i) { return values[i]; });
  }
  void named_column(const Label& label, const std::vector<std::uint64_t>& values, auto names) {
    if (values.empty()) return;
    kept_all(label, values);
    const hdf5::Handle dataset = hdf5::open_column(id(), label.name, name());
    hdf5::write_attribute(dataset.get(), "names", names(), name());
  }
  void bins(const Label& from, const Label& count, const auto& bins) {
    const auto all = bins.bins();
    kept_each(from, all.size(), [&](std::size_t i) { return all[i].from; });
    kept_each(count, all.size(), [&](std::size_t i) { return all[i].count; });
  }
  void sums(const Label& label, std::size_t count, auto get) {
    std::vector<const ExactSum*> all;
    for (std::size_t i = 0; i < count; ++i) all.push_back(&get(i));
    write_sums(group_, label.name, all, description_of(label), name());
  }
  void rows(auto make) {
    const auto points = make();
    write_columns(id(), std::span(points), name());
  }
  void kept_rows(auto make) { rows(make); }
  void computed(const Label& label, auto make) {
    if constexpr (std::is_arithmetic_v<decltype(make())>)
      number(label, make());
    else
      kept_all(label, make());
  }
  template <class Struct>
  void provenance(const Struct& s) {
    const hdf5::Handle group = file_.open_group("provenance");
    each_field<Fields<Struct>>([&](const auto& one) {
      hdf5::write_attribute(group.get(), one.label.name, static_cast<std::int64_t>(one.kept(s)),
                            name());
    });
  }

 private:
  hid_t id() const { return group_.get(); }
  const std::string& name() const { return file_.name(); }

  const ArchiveFile& file_;
  hdf5::Handle group_;
};

}  // namespace carom::files
