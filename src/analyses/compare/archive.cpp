#include "carom/analyses/compare.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analyses/compare/columns.hpp"
#include "files/hdf5/archive_file.hpp"
#include "files/hdf5/fields.hpp"

namespace carom {

using namespace files;
using namespace analyses;
using hdf5::Handle;
using RunRow = StoredRunRow;
using SchemeRow = StoredSchemeRow;

namespace {

constexpr const char* kind = "compare";
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

void write_names(hid_t group, const char* column, const std::vector<std::string>& names,
                 const std::string& file) {
  const Handle dataset = hdf5::open_column(group, column, file);
  hdf5::write_attribute(dataset.get(), "names", names, file);
}
std::vector<std::string> read_names(hid_t group, const char* column, const std::string& file) {
  const Handle dataset = hdf5::open_column(group, column, file);
  return hdf5::read_string_list_attribute(dataset.get(), "names", file);
}

std::int64_t index_of(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return found - names.begin();
  names.push_back(name);
  return static_cast<std::int64_t>(names.size()) - 1;
}

SchemeRow row_of(const ComparedScheme& scheme) {
  const auto value = [](const std::optional<MeasuredNumber>& n) { return n ? n->value : unknown; };
  const auto error = [](const std::optional<MeasuredNumber>& n) { return n ? n->error : unknown; };
  SchemeRow row;
  row.order = scheme.order;
  row.adaptive = scheme.adaptive ? 1 : 0;
  row.steps = scheme.measured.steps;
  row.reversible = scheme.reversible ? (*scheme.reversible ? 1 : 0) : -1;
  row.measured = value(scheme.measured.slope);
  row.measured_error = error(scheme.measured.slope);
  row.from = scheme.measured.longest;
  row.to = scheme.measured.shortest;
  row.areas = value(scheme.areas);
  row.areas_error = error(scheme.areas);
  row.areas_step = scheme.areas_step;
  row.work_step = scheme.work ? scheme.work->step : unknown;
  row.work_tolerance = scheme.work ? scheme.work->tolerance : unknown;
  row.work_evaluations = scheme.work ? scheme.work->force_evaluations : unknown;
  row.work_cpu = scheme.work ? scheme.work->cpu_seconds : unknown;
  return row;
}

ComparedScheme scheme_of(const SchemeRow& row) {
  ComparedScheme scheme;
  scheme.order = static_cast<int>(row.order);
  scheme.adaptive = row.adaptive != 0;
  if (row.reversible >= 0) scheme.reversible = row.reversible == 1;
  if (!std::isnan(row.measured))
    scheme.measured.slope = MeasuredNumber{row.measured, row.measured_error};
  scheme.measured.steps = static_cast<int>(row.steps);
  scheme.measured.longest = row.from;
  scheme.measured.shortest = row.to;
  if (!std::isnan(row.areas)) scheme.areas = MeasuredNumber{row.areas, row.areas_error};
  scheme.areas_step = row.areas_step;
  if (!std::isnan(row.work_evaluations))
    scheme.work =
        WorkForError{row.work_step, row.work_tolerance, row.work_evaluations, row.work_cpu};
  return scheme;
}

void write_result(const ArchiveFile& file, const Comparison& result, const std::string& name) {
  const Handle all = file.group("comparison", "What integrators are compared with");
  write_numbers(all.get(), result, name);
  hdf5::write_attribute(all.get(), "reference", result.exact ? "exact flights" : result.reference,
                        name);
  std::vector<std::string> schemes, reasons{""}, failures{""};
  std::vector<SchemeRow> rows;
  std::vector<RunRow> runs;
  for (const ComparedScheme& scheme : result.schemes) {
    schemes.push_back(scheme.name);
    rows.push_back(row_of(scheme));
    rows.back().reason = index_of(reasons, scheme.measured.reason);
    for (const ComparedRun& run : scheme.runs) {
      RunRow row{run};
      row.scheme = static_cast<std::int64_t>(schemes.size()) - 1;
      row.all_same = run.same_hits ? 1 : 0;
      row.failed_by = index_of(failures, run.failure);
      runs.push_back(row);
    }
  }
  const Handle list = file.group("schemes", "The schemes that are compared");
  write_columns(list.get(), std::span<const SchemeRow>(rows), name);
  write_names(list.get(), "order", schemes, name);
  write_names(list.get(), "reason", reasons, name);
  const Handle end = file.group("end", "Where the reference ends, one row a particle");
  write_columns(end.get(), std::span<const ComparedEnd>(result.end), name);
  const Handle group = file.group("runs", "Runs, scheme after scheme");
  write_columns(group.get(), std::span<const RunRow>(runs), name);
  write_names(group.get(), "scheme", schemes, name);
  write_names(group.get(), "failure", failures, name);
}

}  // namespace

void write_comparison(const std::string& name, const LoadedSystem& loaded, const Provenance& origin,
                      const Comparison& result, bool force, ArchiveLock lock) {
  ArchiveFile file = ArchiveFile::begin(kind, name, loaded, origin, force, lock);
  write_result(file, result, name);
  file.write_seconds({result.seconds, result.cpu_seconds});
  file.finish(result.complete ? "completed" : "interrupted", result.complete);
}

StoredComparison read_comparison(const std::string& name) {
  const Handle file = open_kind(name, kind, "the archive holds no comparison of integrators",
                                "an archive written by carom compare");
  StoredComparison stored;
  Comparison& result = stored.result;
  read_head(file.get(), name, stored, result);
  const auto opened = [&](const char* group) { return open_group(file.get(), group, name); };
  const Handle all = opened("comparison"), list = opened("schemes"), group = opened("runs"),
               end = opened("end");
  read_numbers(all.get(), result, name);
  result.end = read_all_rows<ComparedEnd>(end.get(), name);
  result.reference = hdf5::read_string_attribute(all.get(), "reference", name);
  result.exact = result.reference == "exact flights";
  if (result.exact) result.reference.clear();
  const std::vector<SchemeRow> rows = read_all_rows<SchemeRow>(list.get(), name);
  const std::vector<std::string> names = read_names(list.get(), "order", name),
                                 reasons = read_names(list.get(), "reason", name),
                                 failures = read_names(group.get(), "failure", name);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    result.schemes.push_back(scheme_of(rows[k]));
    result.schemes.back().name = names.at(k);
    result.schemes.back().measured.reason = reasons.at(static_cast<std::size_t>(rows[k].reason));
  }
  for (RunRow& row : read_all_rows<RunRow>(group.get(), name)) {
    row.failure = failures.at(static_cast<std::size_t>(row.failed_by));
    row.same_hits = row.all_same != 0;
    result.schemes.at(static_cast<std::size_t>(row.scheme)).runs.push_back(row);
  }
  name_best_schemes(result);
  return stored;
}

}  // namespace carom
