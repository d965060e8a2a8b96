// The folder FILE.part while the archive of a sweep is made: the plan, and the archive and the
// report of each value.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "files/json.hpp"
#include "files/toml/sweep_values.hpp"

namespace carom::files {

/// What a sweep computes. A value, or point of a plane, is a system; the last key runs fastest.
struct SweepPlan {
  std::string command;                   ///< "escape"
  std::string system_name, system_toml;  ///< without the sweep, where that is a system
  std::vector<SweptKey> keys;
  std::vector<std::string> systems;  ///< resolved TOML of each value
  /// Options that are no part of a system, as they were typed: {"engine", "steps"}.
  std::vector<std::pair<std::string, std::string>> options;

  /// What the keys are at a value, in their order.
  std::vector<std::string> at(std::size_t index) const;
  Json json() const;
  static SweepPlan of(const Json&, const std::string& name);
};
/// Number of the points of these keys.
std::size_t points_of(const std::vector<SweptKey>&);
/// What the keys are at a point.
std::vector<std::string> values_at(const std::vector<SweptKey>&, std::size_t index);

/// The archive of a value, by itself.
std::string value_of_sweep(const std::string& file, std::size_t index);

/// For the process that holds the lock of FILE: keeps the plan, which makes the folder that of a
/// sweep.
void keep_plan(const std::string& file, const SweepPlan&);
/// Throws InputError where it was changed.
SweepPlan kept_plan(const std::string& file);
/// Is FILE.part that of a sweep which has not ended?
bool has_sweep(const std::string& file);
/// Keeps the report of a value whose archive, if it has one, is there: checksums of both tell that
/// they belong to this value of this plan.
void keep_report(const std::string& file, const SweepPlan&, std::size_t index,
                 const std::string& text);
void remove_report(const std::string& file, std::size_t index);
bool has_report(const std::string& file, std::size_t index);
/// Throws InputError where the report, or the archive beside it, was changed or belongs to another
/// value.
std::optional<std::string> kept_report(const std::string& file, const SweepPlan&,
                                       std::size_t index);
/// For the process that holds the lock of FILE: removes the plan first, then all values.
void remove_sweep(const std::string& file);

}  // namespace carom::files
