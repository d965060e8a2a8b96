// A sweep as an archive: the archives of its values are groups of it.
#pragma once

#include <string>
#include <vector>

#include "carom/files/archive.hpp"
#include "files/checkpoint/sweep_files.hpp"

namespace carom::files {

inline constexpr const char* sweep_archive_kind = "sweep";

/// A column of a sweep's table: a number for each value, NaN where there is none.
struct SweepNumbers {
  std::string name, description;
  std::vector<double> values;
};

/// Makes FILE of what FILE.part holds, and empties FILE.part.
void write_sweep(const std::string& file, const LoadedSystem& base, const SweepPlan&,
                 const std::vector<SweepNumbers>& table, const Provenance&,
                 const std::string& status, bool complete);
/// The opposite: FILE.part has the values of the archive FILE, which stays.
void unpack_sweep(const std::string& file);

/// A sweep as its archive holds it.
struct StoredSweep {
  SweepPlan plan;
  std::string status;
  bool complete = false;
  std::vector<std::string> reports;  ///< of each value; "" where it was not computed
  std::vector<Origin> origins;
};
/// Throws InputError for anything but the archive of a sweep.
StoredSweep read_sweep(const std::string& file);
/// Is FILE the archive of a sweep?
bool is_sweep_archive(const std::string& file);
/// Writes the archive of a value as a file by itself. False where the sweep holds none.
bool extract_value(const std::string& file, std::size_t index, const std::string& target);

}  // namespace carom::files
