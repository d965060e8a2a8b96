// Sweeps: a list of ordinary archives. While a sweep goes on, FILE.part holds the archive of each
// value; at the end they are groups of FILE, beside a table.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "carom/files/archive.hpp"
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

  /// Number of the values: of a plane all pairs.
  std::size_t points() const;
  /// What the keys are at a value, in their order.
  std::vector<std::string> at(std::size_t index) const;
  std::string named(std::size_t index) const;  ///< the same for readers: "field.B = 0.5"
  /// The system without the sweep.
  LoadedSystem base() const;
};

/// The archive of a value: while the sweep goes on a file by itself, later a group of FILE, which
/// readers of archives take by this name.
std::string part_of_sweep(const std::string& file, std::size_t index);
std::string value_of_sweep(const std::string& file, std::size_t index);
/// Throws InputError where the system `toml` of a value's archive is not the planned one.
void refuse_other_value(std::size_t index, const std::string& planned, const std::string& toml,
                        const std::string& archive);

/// A column of a sweep's table: a number for each value, NaN where there is none.
struct SweepNumbers {
  std::string name;
  std::vector<double> values;
};

/// For the process that holds the lock of FILE: keeps the plan, which makes FILE.part that of a
/// sweep.
void keep_plan(const std::string& file, const SweepPlan&);
/// Is FILE.part that of a sweep which has not ended?
bool has_sweep(const std::string& file);
/// Throws InputError where a value's archive that FILE.part has was changed after it was complete,
/// or belongs to another value.
void check_parts(const std::string& file, const SweepPlan&);
/// Makes FILE of what FILE.part holds, and empties FILE.part.
void write_sweep(const std::string& file, const SweepPlan&, const std::vector<SweepNumbers>& table,
                 const Provenance&, const std::string& status, bool complete);
/// The opposite: FILE.part has the values of the archive FILE, which stays.
void unpack_sweep(const std::string& file);
/// For the process that holds the lock of FILE: removes the plan first, then all values.
void remove_sweep(const std::string& file);

/// A sweep as its archive holds it, or FILE.part where it has not ended.
struct StoredSweep {
  SweepPlan plan;
  std::string status;
  bool complete = false;
  std::vector<std::size_t> computed;  ///< the values that have archives
  std::vector<Origin> origins;
};
/// Throws InputError for anything but a sweep.
StoredSweep read_sweep(const std::string& file);
/// Is FILE the archive of a sweep?
bool is_sweep_archive(const std::string& file);
/// Writes the archive of a value, by its name as of value_of_sweep, as a file by itself.
void extract_value(const std::string& value, const std::string& target);

}  // namespace carom::files
