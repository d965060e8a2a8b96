// Sweeps: their values as numbers that are written, their table, their archive.
#include <pybind11/stl.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "carom/base/error.hpp"
#include "carom/files/archive.hpp"
#include "cli/commands/sweep.hpp"
#include "cli/commands/sweep_plan.hpp"
#include "cli/common.hpp"
#include "files/checkpoint/sweep_archive.hpp"
#include "loaded.hpp"

namespace py = pybind11;

namespace carom::python {

namespace {

// A title needs no step.
SystemOverrides without_step() {
  SystemOverrides overrides;
  overrides.choose_step = false;
  return overrides;
}

using Keys = std::vector<std::pair<std::string, std::vector<std::string>>>;

struct SweepOutcome {
  cli::SweepResult result;
  std::string file;  ///< that it was read from, or ""
};

files::SweepPlan plan_sweep(const std::string& toml, const std::string& name,
                            const std::string& command, const Texts& set, const Texts& texts,
                            const std::vector<std::string>& typed) {
  cli::Options options = options_of(toml, name, command, set, texts);
  options.sweep = typed;
  return cli::plan_of_sweep(options);
}

Keys keys_of(const files::SweepPlan& plan) {
  Keys keys;
  for (const files::SweptKey& key : plan.keys) keys.emplace_back(key.key, key.values);
  return keys;
}

// `reports`: of the values that were computed, with their doubts.
SweepOutcome make_sweep(const files::SweepPlan& plan,
                        const std::vector<std::pair<std::string, std::string>>& reports) {
  SweepOutcome made;
  cli::SweepResult& result = made.result;
  result.plan = plan;
  for (std::size_t i = 0; i < reports.size(); ++i) {
    const auto& [report, doubts] = reports[i];
    result.rows.emplace_back(i, files::Json::parse(report, "report"), doubts);
  }
  result.status = reports.size() == plan.systems.size() ? "completed" : "interrupted";
  if (const auto error = cli::why_nothing(result)) throw *error;  // as the program
  result.title = read_system(plan.system_toml, plan.system_name, without_step()).system.title;
  return made;
}

SweepOutcome open_sweep(const std::string& file) {
  const files::StoredSweep stored = files::read_sweep(file);
  SweepOutcome opened{{stored.plan, {}, "", stored.status, ""}, file};
  for (std::size_t i = 0; i < stored.reports.size(); ++i)
    if (!stored.reports[i].empty())
      opened.result.rows.emplace_back(i, files::Json::parse(stored.reports[i], file));
  opened.result.title =
      read_system(stored.plan.system_toml, stored.plan.system_name, without_step()).system.title;
  return opened;
}

// `archives`: of the values that were computed; "" where there is none.
void save(const SweepOutcome& self, const std::string& name, bool force,
          const std::vector<std::string>& archives) {
  const std::string file = followed(name);
  const ArchiveLock lock = lock_archive(file);
  refuse_existing(file, force);
  files::keep_plan(file, self.result.plan);
  try {
    for (std::size_t i = 0; i < self.result.rows.size(); ++i) {
      const cli::SweepRow& row = self.result.rows[i];
      if (!archives[i].empty()) {
        const std::string value = files::value_of_sweep(file, row.index);
        std::filesystem::remove(value);  // a new file, never through a link
        std::filesystem::copy_file(archives[i], value);
      }
      files::keep_report(file, self.result.plan, row.index, row.report.text());
    }
    cli::Options options;
    options.command = self.result.plan.command;
    options.line = "carom." + self.result.plan.command + " (Python)";
    cli::keep_sweep(options, self.result, file, {});
  } catch (...) {
    files::remove_sweep(file);
    throw;
  }
}

py::dict table_of(const SweepOutcome& self) {
  py::dict table;
  for (const cli::SweepColumn& column : cli::sweep_table(self.result.plan, self.result.rows))
    table[column.name.c_str()] =
        column.texts.empty() ? py::cast(column.numbers) : py::cast(column.texts);
  return table;
}

}  // namespace

void add_sweeps(py::module_& module) {
  py::class_<SweepOutcome>(module, "SweepOutcome")
      .def_property_readonly("command",
                             [](const SweepOutcome& self) { return self.result.plan.command; })
      .def_property_readonly("system",
                             [](const SweepOutcome& self) {
                               return std::pair(self.result.plan.system_toml,
                                                self.result.plan.system_name);
                             })
      .def_property_readonly("indices",
                             [](const SweepOutcome& self) {
                               std::vector<std::size_t> indices;
                               for (const cli::SweepRow& row : self.result.rows)
                                 indices.push_back(row.index);
                               return indices;
                             })
      .def("json", [](const SweepOutcome& self) { return cli::sweep_json(self.result).text(); })
      .def("text", [](const SweepOutcome& self) { return cli::sweep_text(self.result); })
      .def("doubts",
           [](const SweepOutcome& self) {
             std::vector<std::string> doubts;
             for (const cli::SweepRow& row : self.result.rows)
               if (const std::string one = row.doubts(); !one.empty()) doubts.push_back(one);
             return doubts;
           })
      .def("table", &table_of)
      .def("save", &save, py::call_guard<py::gil_scoped_release>(), py::arg("file"),
           py::arg("force"), py::arg("archives"))
      .def(
          "extract",
          [](const SweepOutcome& self, std::size_t index, const std::string& target) {
            return files::extract_value(self.file, index, target);
          },
          py::arg("index"), py::arg("target"));
  py::class_<files::SweepPlan>(module, "SweepPlan").def_property_readonly("keys", &keys_of);
  module.def("plan_sweep", &plan_sweep, py::call_guard<py::gil_scoped_release>(), py::arg("toml"),
             py::arg("name"), py::arg("command"), py::arg("set"), py::arg("texts"),
             py::arg("typed"));
  module.def("make_sweep", &make_sweep, py::arg("plan"), py::arg("reports"));
  module.def("open_sweep", &open_sweep, py::call_guard<py::gil_scoped_release>(), py::arg("file"));
}

}  // namespace carom::python
