// The table of a sweep: a row for each value, for scripts and for readers.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "carom/base/error.hpp"
#include "cli/outcome.hpp"
#include "files/checkpoint/sweep_archive.hpp"
#include "files/json.hpp"

namespace carom::cli {

/// A value that was computed.
struct SweepRow {
  /// `text`: the doubts about it, or "".
  SweepRow(std::size_t row, files::Json printed, const std::string& text = {})
      : index(row), report(std::move(printed)) {
    if (!text.empty()) report.set("doubts", text);
  }
  SweepRow(std::size_t row, const Outcome& outcome);
  std::size_t index;
  files::Json report;  ///< as the command prints it with --json, with `doubts` if there are any
  /// Why it cannot be trusted, a line each; "" if it can.
  std::string doubts() const;
  /// Is it one that its command alone refuses after it was computed?
  bool measured_nothing() const;
};

/// A sweep with what was computed of it.
struct SweepResult {
  files::SweepPlan plan;
  std::vector<SweepRow> rows;  ///< in the order of their index
  std::string title;
  std::string status;   ///< "completed" or "interrupted"
  std::string archive;  ///< or ""
};

/// A column of the table: numbers, NaN where there is none, or texts.
struct SweepColumn {
  std::string name;
  std::vector<double> numbers;
  std::vector<std::string> texts;
};
/// The keys, then what the command's reports have of value and error ("rate", "rate_stderr"), then
/// their `doubts` and `note`. A row for each of `rows`.
std::vector<SweepColumn> sweep_table(const files::SweepPlan&, const std::vector<SweepRow>& rows);
/// The numbers of the same for archives: a row for each value of the plan, NaN where it was not
/// computed.
std::vector<files::SweepNumbers> sweep_numbers(const SweepResult&);

/// The error of a sweep none of whose values measured what its command is run for: the command
/// refuses each of them alone.
std::optional<InputError> why_nothing(const SweepResult&);

files::Json sweep_json(const SweepResult&);
std::string sweep_text(const SweepResult&);

}  // namespace carom::cli
