// The numbers and rows of what describe() says of a result (results/describe_ends.hpp) as JSON.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "carom/base/fields.hpp"
#include "carom/events/step_counts.hpp"
#include "files/json.hpp"

namespace carom::files {

/// A number; a digest in hexadecimal digits.
template <class T>
Json json_of(const Label& label, const T& value) {
  if constexpr (std::is_same_v<T, std::uint64_t>)
    if (std::string_view(label.name) == "digest") return fmt::format("{:016x}", value);
  return value;
}

/// Adds the fields of a struct; "energy_error.end" is the key `end` of the object energy_error.
template <class Struct>
void add_numbers(Json& json, const Struct& s) {
  std::string outer;
  Json inner;
  const auto close = [&] {
    if (!outer.empty()) json.set(outer, std::move(inner));
    outer.clear();
  };
  each_field<Fields<Struct>>([&](const auto& one) {
    const std::string_view name = one.label.name;
    const std::size_t dot = name.find('.');
    const std::string_view group = dot == name.npos ? std::string_view() : name.substr(0, dot);
    if (group != outer) close();
    if (group.empty()) {
      json.set(name, json_of(one.label, one.kept(s)));
      return;
    }
    if (outer.empty()) inner = Json::object();
    outer = group;
    inner.set(name.substr(dot + 1), one.kept(s));
  });
  close();
}

class JsonOut {
 public:
  static constexpr bool reads = false;
  explicit JsonOut(Json& json) : json_(json) {}

  void group(const char* path, const char*) { group_ = path; }
  bool group_if(bool, const char*, const char*) { return false; }
  bool has_if(bool, const char*) { return false; }
  void number(const Label& label, const auto& value) {
    json_.set(label.name, json_of(label, value));
  }
  void number_if(bool there, const Label& label, const auto& value) {
    if (there) number(label, value);
  }
  template <class Struct>
  void numbers_if(bool there, const Struct& s) {
    // Which numbers of steps a report has depends on the plan (cli/reports/doubts.hpp).
    if constexpr (!std::is_same_v<Struct, StepCounts>)
      if (there) add_numbers(json_, s);
  }
  void fates(const auto& counts, std::uint64_t) { add_numbers<FateCounts>(json_, counts); }
  void rows(auto make) {
    Json list = Json::array();
    for (const auto& point : make()) {
      Json row = Json::object();
      add_numbers(row, point);
      list.push(std::move(row));
    }
    json_.set(group_, std::move(list));
  }

  void kept(const Label&, const auto&) {}
  bool kept_if(bool, const Label&, const auto&) { return false; }
  void kept_numbers(const auto&) {}
  void kept_all(const Label&, const auto&) {}
  void kept_column(const Label&, const auto&, std::size_t) {}
  void kept_each(const Label&, std::size_t, auto) {}
  void first_rows(const Label&, const auto&, auto) {}
  void named_column(const Label&, const std::vector<std::uint64_t>&, auto) {}
  void bins(const Label&, const Label&, const auto&) {}
  void sums(const Label&, std::size_t, auto) {}
  void kept_rows(auto) {}
  void computed(const Label&, auto) {}
  void provenance(const auto&) {}

 private:
  Json& json_;
  std::string group_;
};

}  // namespace carom::files
