// Tables of the guide: what describe() and lists of fields hold, as rows of Markdown.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "carom/results/fate_counts.hpp"
#include "files/hdf5/fields.hpp"

namespace carom::files {

/// Rows "| `x`, `y` | length | Position |": neighbours of one unit and meaning share a row.
class FieldTable {
 public:
  void add(const Label& label) {
    const std::string name = "`" + dataset_name(label) + "`";
    if (!rows_.empty() && rows_.back().unit == label.unit && rows_.back().text == label.text)
      rows_.back().names += ", " + name;
    else
      rows_.push_back({name, label.unit, label.text});
  }
  template <class List>
  void add_fields() {
    each_field<List>([&](const auto& one) { add(one.label); });
  }
  void head(const std::string& name, const std::string& text) { rows_.push_back({name, "", text}); }
  std::string text(const std::string& first) const {
    std::string all = "| " + first + " | units | means |\n|---|---|---|\n";
    for (const Row& row : rows_) {
      std::string means = row.text;
      for (std::size_t at = 0; (at = means.find('|', at)) != means.npos; at += 2)
        means.insert(at, "\\");
      all += "| " + row.names + " | " + row.unit + " | " + means + " |\n";
    }
    return all;
  }

 private:
  struct Row {
    std::string names, unit, text;
  };
  std::vector<Row> rows_;
};

/// The visitor: everything that an archive of that kind may hold.
class Reference {
 public:
  static constexpr bool reads = false;

  std::string text() const { return table_.text("dataset"); }

  void group(const char* path, const char* text) {
    table_.head(std::string("**`/") + path + "`**", text);
  }
  bool group_if(bool, const char* path, const char* text) {
    group(path, text);
    return true;
  }
  bool has_if(bool, const char*) { return true; }
  template <class T>
  void number(const Label& label, const T&) {
    table_.add(label);
  }
  template <class T>
  void number_if(bool, const Label& label, const T&) {
    table_.add(label);
  }
  template <class T>
  void kept(const Label& label, const T&) {
    table_.add(label);
  }
  template <class T>
  bool kept_if(bool, const Label& label, const T&) {
    table_.add(label);
    return true;
  }
  template <class Struct>
  void kept_numbers(const Struct&) {
    table_.add_fields<Fields<Struct>>();
  }
  template <class Struct>
  void numbers_if(bool, const Struct&) {
    table_.add_fields<Fields<Struct>>();
  }
  template <class Counts>
  void fates(const Counts&, std::size_t) {
    table_.add_fields<Fields<FateCounts>>();
  }
  template <class T>
  void kept_all(const Label& label, const T&) {
    table_.add(label);
  }
  template <class T>
  void kept_column(const Label& label, const T&, std::size_t) {
    table_.add(label);
  }
  template <class Get>
  void kept_each(const Label& label, std::size_t, Get) {
    table_.add(label);
  }
  template <class T, class Count>
  void first_rows(const Label& label, const T&, Count) {
    table_.add(label);
  }
  template <class Names>
  void named_column(const Label& label, const std::vector<std::uint64_t>&, Names) {
    table_.add(label);
  }
  template <class Bins>
  void bins(const Label& from, const Label& count, const Bins&) {
    table_.add(from);
    table_.add(count);
  }
  template <class Get>
  void sums(const Label& label, std::size_t, Get) {
    table_.add(label);
  }
  template <class Make>
  void rows(Make) {
    using Points = decltype(std::declval<Make>()());
    table_.add_fields<Fields<typename Points::value_type>>();
  }
  template <class Make>
  void kept_rows(Make make) {
    rows(make);
  }
  template <class Make>
  void computed(const Label& label, Make) {
    table_.add(label);
  }
  template <class Struct>
  void provenance(const Struct&) {
    table_.head("**`/provenance`**", "Attributes");
    table_.add_fields<Fields<Struct>>();
  }

 private:
  FieldTable table_;
};

}  // namespace carom::files
