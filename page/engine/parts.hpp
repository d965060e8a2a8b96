// Parts of an ensemble, which other workers have flown, as text: what describe() says of a result
// (results/describe_ends.hpp) by name, digit for digit.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "carom/base/exact_sum.hpp"
#include "carom/base/fields.hpp"
#include "carom/results/ensemble_result.hpp"
#include "carom/results/fate_counts.hpp"

namespace carom::page {

/// Columns of numbers, each as its 64 bits.
class Part {
 public:
  Part() = default;
  explicit Part(const std::string& text);
  std::string text() const;

  bool has(const std::string& key) const { return columns_.contains(key); }
  /// Of the columns that begin so, the rest of their names.
  std::vector<std::string> names(const std::string& begin) const;
  template <class T>
  void put(const std::string& key, const std::vector<T>& values) {
    std::vector<std::uint64_t>& bits = columns_[key];
    for (const T x : values) {
      if constexpr (std::is_same_v<T, double>)
        bits.push_back(std::bit_cast<std::uint64_t>(x));
      else
        bits.push_back(static_cast<std::uint64_t>(x));
    }
  }
  /// Throws InputError where there is none.
  template <class T>
  std::vector<T> get(const std::string& key) const {
    std::vector<T> values;
    for (const std::uint64_t bits : column(key)) {
      if constexpr (std::is_same_v<T, double>)
        values.push_back(std::bit_cast<double>(bits));
      else
        values.push_back(static_cast<T>(bits));
    }
    return values;
  }

 private:
  const std::vector<std::uint64_t>& column(const std::string& key) const;
  std::map<std::string, std::vector<std::uint64_t>> columns_;
};

class PartOut {
 public:
  static constexpr bool reads = false;
  explicit PartOut(Part& part) : part_(part) {}

  void group(const char* path, const char*) { path_ = path; }
  bool group_if(bool there, const char* path, const char* text) {
    group(path, text);
    if (there) part_.put<int>(path_, {});
    return there;
  }
  bool has_if(bool there, const char*) { return there; }
  template <class T>
  void number(const Label& label, const T& value) {
    part_.put<T>(key(label), {value});
  }
  template <class T>
  void number_if(bool there, const Label& label, const T& value) {
    if (there) number(label, value);
  }
  template <class T>
  void kept(const Label& label, const T& value) {
    number(label, value);
  }
  template <class T>
  bool kept_if(bool there, const Label& label, const T& value) {
    number_if(there, label, value);
    return there;
  }
  template <class Struct>
  void kept_numbers(const Struct& s) {
    each_field<Fields<Struct>>([&](const auto& one) { number(one.label, one.kept(s)); });
  }
  template <class Struct>
  void numbers_if(bool there, const Struct& s) {
    if (there) kept_numbers(s);
  }
  void fates(const FateCounts& counts, std::uint64_t) { kept_numbers(counts); }
  template <class T>
  void kept_all(const Label& label, const std::vector<T>& values) {
    part_.put(key(label), values);
  }
  template <class T>
  void kept_column(const Label& label, const std::vector<T>& values, std::size_t) {
    kept_all(label, values);
  }
  template <class Get>
  void kept_each(const Label& label, std::size_t count, Get get) {
    std::vector<std::decay_t<decltype(get(0))>> values;
    for (std::size_t i = 0; i < count; ++i) values.push_back(get(i));
    kept_all(label, values);
  }
  template <class T, class Count>
  void first_rows(const Label& label, const std::vector<T>& values, Count) {
    kept_all(label, values);
  }
  template <class Names>
  void named_column(const Label& label, const std::vector<std::uint64_t>& values, Names) {
    kept_all(label, values);
  }
  template <class Bins>
  void bins(const Label& from, const Label& count, const Bins& bins) {
    const auto all = bins.bins();
    kept_each(from, all.size(), [&](std::size_t i) { return all[i].from; });
    kept_each(count, all.size(), [&](std::size_t i) { return all[i].count; });
  }
  template <class Get>
  void sums(const Label& label, std::size_t count, Get get) {
    std::vector<std::int64_t> digits;
    for (std::size_t i = 0; i < count; ++i)
      for (const std::int64_t digit : get(i).state()) digits.push_back(digit);
    kept_all(label, digits);
  }
  template <class Make>
  void rows(Make make) {
    const auto points = make();
    each_field<Fields<std::decay_t<decltype(points[0])>>>([&](const auto& one) {
      kept_each(one.label, points.size(), [&](std::size_t i) { return one.kept(points[i]); });
    });
  }
  template <class Make>
  void kept_rows(Make make) {
    rows(make);
  }
  template <class Make>
  void computed(const Label& label, Make make) {
    if constexpr (!std::is_arithmetic_v<decltype(make())>) kept_all(label, make());
  }
  template <class Struct>
  void provenance(const Struct&) {}

 private:
  std::string key(const Label& label) const { return path_ + '/' + label.name; }
  Part& part_;
  std::string path_;
};

class PartIn {
 public:
  static constexpr bool reads = true;
  explicit PartIn(const Part& part) : part_(part) {}

  void group(const char* path, const char*) { path_ = path; }
  bool group_if(bool, const char* path, const char* text) {
    group(path, text);
    return part_.has(path_);
  }
  template <class T>
  std::vector<T> values(const char* group, const char* column) const {
    return part_.get<T>(std::string(group) + '/' + column);
  }
  void expect(bool fits, const char* problem) const;
  bool has_if(bool, const char* column) const { return part_.has(path_ + '/' + column); }
  template <class T>
  void number(const Label& label, T& value) {
    const std::vector<T> one = part_.get<T>(key(label));
    expect(one.size() == 1, label.name);
    value = one[0];
  }
  template <class T>
  bool kept_if(bool, const Label& label, T& value) {
    if (!part_.has(key(label))) return false;
    number(label, value);
    return true;
  }
  template <class T>
  void number_if(bool, const Label& label, T& value) {
    kept_if(true, label, value);
  }
  template <class T>
  void kept(const Label& label, T& value) {
    number(label, value);
  }
  template <class Struct>
  void kept_numbers(Struct& s) {
    each_field<Fields<Struct>>([&](const auto& one) {
      typename std::decay_t<decltype(one)>::kept_type value{};
      number(one.label, value);
      one.set(s, value);
    });
  }
  template <class Struct>
  void numbers_if(bool, Struct& s) {
    if (part_.has(key(std::get<0>(Fields<Struct>::list).label))) kept_numbers(s);
  }
  void fates(FateCounts& counts, std::uint64_t) { kept_numbers(counts); }
  template <class T>
  void kept_all(const Label& label, std::vector<T>& values) {
    values = part_.get<T>(key(label));
  }
  template <class T>
  void kept_column(const Label& label, std::vector<T>& values, std::size_t count) {
    kept_all(label, values);
    expect(values.size() == count, label.name);
  }
  template <class Get>
  void kept_each(const Label& label, std::size_t count, Get get) {
    std::vector<std::decay_t<decltype(get(0))>> values;
    kept_column(label, values, count);
    for (std::size_t i = 0; i < count; ++i) get(i) = values[i];
  }
  template <class T, class Count>
  void first_rows(const Label& label, std::vector<T>& values, Count) {
    kept_column(label, values, values.size());
  }
  template <class Names>
  void named_column(const Label& label, std::vector<std::uint64_t>& values, Names) {
    kept_all(label, values);
  }
  template <class Bins>
  void bins(const Label& from, const Label& count, Bins& bins) {
    const auto starts = part_.get<double>(key(from));
    const auto counts = part_.get<std::uint64_t>(key(count));
    for (std::size_t i = 0; i < starts.size(); ++i) bins.add(starts[i], counts.at(i));
  }
  template <class Get>
  void sums(const Label& label, std::size_t count, Get get) {
    const auto digits = part_.get<std::int64_t>(key(label));
    expect(digits.size() == count * ExactSum::digits, label.name);
    for (std::size_t i = 0; i < count; ++i) {
      std::array<std::int64_t, ExactSum::digits> state{};
      std::copy_n(digits.begin() + static_cast<std::ptrdiff_t>(i * ExactSum::digits), state.size(),
                  state.begin());
      get(i) = ExactSum::from_state(state);
    }
  }
  template <class Make>
  void rows(Make) {}
  template <class Make>
  void kept_rows(Make) {}
  template <class Make>
  void computed(const Label&, Make) {}
  template <class Struct>
  void provenance(Struct&) {}

 private:
  std::string key(const Label& label) const { return path_ + '/' + label.name; }
  const Part& part_;
  std::string path_;
};

/// What all ensembles have besides.
void put_common(Part&, const EnsembleResult&);
void get_common(const Part&, EnsembleResult&);

}  // namespace carom::page
