// Tables of the guide: what describe() and lists of fields hold, as rows of Markdown.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "carom/events/step_counts.hpp"
#include "carom/results/fate_counts.hpp"
#include "files/hdf5/fields.hpp"

namespace carom::files {

/// Of an archive, or of what --json prints.
enum class Kept { datasets, keys };

/// Rows "| `x`, `y` | length | Position |": neighbours of one unit and meaning share a row.
class FieldTable {
 public:
  explicit FieldTable(Kept kept = Kept::datasets) : kept_(kept) {}
  /// `within`: a key whose object or list has this one.
  void add(const Label& label, const std::string& within = "") {
    const std::string name =
        "`" + within + (kept_ == Kept::keys ? label.name : dataset_name(label)) + "`";
    if (!rows_.empty() && rows_.back().unit == label.unit && rows_.back().text == label.text)
      rows_.back().names += ", " + name;
    else
      rows_.push_back({name, label.unit, label.text});
  }
  template <class List>
  void add_fields(const std::string& within = "") {
    each_field<List>([&](const auto& one) { add(one.label, within); });
  }
  /// Numbers by fate, which the guide explains once.
  void add_fates() {
    std::string names;
    each_field<Fields<FateCounts>>([&](const auto& one) {
      names += (names.empty() ? "`" : ", `") + std::string(one.label.name) + "`";
    });
    rows_.push_back({names, "1", "Numbers by [fate](escape.md#fates)"});
  }
  void head(const std::string& name, const std::string& text, const std::string& unit = "") {
    rows_.push_back({name, unit, text});
  }
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
  Kept kept_;
  std::vector<Row> rows_;
};

/// The visitor: everything that an archive of that kind, or its report in JSON, may hold.
class Reference {
 public:
  static constexpr bool reads = false;
  explicit Reference(Kept kept = Kept::datasets) : kept_(kept), table_(kept) {}

  std::string text() const { return table_.text(in_json() ? "key" : "dataset"); }

  void group(const char* path, const char* text) {
    path_ = path;
    text_ = text;
    if (!in_json()) table_.head(std::string("**`/") + path + "`**", text);
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
    add_dataset(label);
  }
  template <class T>
  bool kept_if(bool, const Label& label, const T&) {
    add_dataset(label);
    return true;
  }
  template <class Struct>
  void kept_numbers(const Struct&) {
    if (!in_json()) table_.add_fields<Fields<Struct>>();
  }
  template <class Struct>
  void numbers_if(bool, const Struct&) {
    // Of those of steps a report has some (cli/reports/doubts.hpp).
    if (in_json() && std::is_same_v<Struct, StepCounts>) return;
    table_.add_fields<Fields<Struct>>();
  }
  template <class Counts>
  void fates(const Counts&, std::size_t) {
    in_json() ? table_.add_fates() : table_.add_fields<Fields<FateCounts>>();
  }
  template <class T>
  void kept_all(const Label& label, const T&) {
    add_dataset(label);
  }
  template <class T>
  void kept_column(const Label& label, const T&, std::size_t) {
    add_dataset(label);
  }
  template <class Get>
  void kept_each(const Label& label, std::size_t, Get) {
    add_dataset(label);
  }
  template <class T, class Count>
  void first_rows(const Label& label, const T&, Count) {
    add_dataset(label);
  }
  template <class Names>
  void named_column(const Label& label, const std::vector<std::uint64_t>&, Names) {
    add_dataset(label);
  }
  template <class Bins>
  void bins(const Label& from, const Label& count, const Bins&) {
    add_dataset(from);
    add_dataset(count);
  }
  template <class Get>
  void sums(const Label& label, std::size_t, Get) {
    add_dataset(label);
  }
  template <class Make>
  void rows(Make) {
    using Points = decltype(std::declval<Make>()());
    if (in_json()) table_.head("`" + path_ + "`", text_, "list");
    table_.add_fields<Fields<typename Points::value_type>>(in_json() ? path_ + "." : "");
  }
  template <class Make>
  void kept_rows(Make make) {
    if (!in_json()) rows(make);
  }
  template <class Make>
  void computed(const Label& label, Make) {
    add_dataset(label);
  }
  template <class Struct>
  void provenance(const Struct&) {
    if (in_json()) return;
    table_.head("**`/provenance`**", "Attributes");
    table_.add_fields<Fields<Struct>>();
  }

 private:
  bool in_json() const { return kept_ == Kept::keys; }
  void add_dataset(const Label& label) {
    if (!in_json()) table_.add(label);
  }

  Kept kept_;
  FieldTable table_;
  std::string path_, text_;  // of the group
};

}  // namespace carom::files
