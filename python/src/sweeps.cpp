// Sweeps: their values as numbers that are written, their table, their archive.
#include <pybind11/stl.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "carom/base/error.hpp"
#include "carom/files/archive.hpp"
#include "cli/commands/sweep.hpp"
#include "cli/common.hpp"
#include "files/checkpoint/sweep_archive.hpp"
#include "loaded.hpp"

namespace py = pybind11;

namespace carom::python {

namespace {

using Keys = std::vector<std::pair<std::string, std::vector<std::string>>>;

struct SweepOutcome final : Outcome {
  explicit SweepOutcome(const files::SweepPlan& plan) : Outcome(std::make_shared<Loaded>()) {
    result.plan = plan;
    loaded->loaded = plan.base();
    loaded->loaded.resolved_toml = plan.system_toml;
    result.title = system().title;
  }
  files::Json json() const override { return cli::sweep_json(result); }
  std::string text() const override { return cli::sweep_text(result); }
  std::vector<std::string> doubts() const override;
  void save(const std::string& file, bool force, const std::atomic<bool>& stop) const override;

  cli::SweepResult result;
  std::vector<cli::OutcomePointer> values;  ///< that were computed
  std::string file;                         ///< that it was read from, or ""
};

std::vector<std::string> SweepOutcome::doubts() const {
  std::vector<std::string> doubts;
  for (const cli::SweepRow& row : result.rows)
    if (const std::string one = row.doubts(); !one.empty()) doubts.push_back(one);
  return doubts;
}

void SweepOutcome::save(const std::string& name, bool force, const std::atomic<bool>& stop) const {
  const std::string target = followed(name);
  const ArchiveLock lock = lock_archive(target);
  refuse_existing(target, force);
  files::keep_plan(target, result.plan);
  try {
    for (std::size_t i = 0; i < values.size() && !stop; ++i)
      values[i]->save(files::part_of_sweep(target, i), true, stop);
    cli::Options options;
    options.command = result.plan.command;
    options.line = "carom." + result.plan.command + " (Python)";
    if (!stop) cli::keep_sweep(options, result, target, {});
  } catch (...) {
    files::remove_sweep(target);
    throw;
  }
  if (stop) files::remove_sweep(target);
}

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

std::shared_ptr<SweepOutcome> make_sweep(const files::SweepPlan& plan,
                                         const std::vector<cli::OutcomePointer>& values) {
  auto made = std::make_shared<SweepOutcome>(plan);
  made->values = values;
  cli::SweepResult& result = made->result;
  for (std::size_t i = 0; i < values.size(); ++i) result.rows.emplace_back(i, *values[i]);
  result.status = values.size() == plan.systems.size() ? "completed" : "interrupted";
  if (const auto error = cli::why_nothing(result)) throw *error;  // as the program
  return made;
}

std::shared_ptr<SweepOutcome> open_sweep(const std::string& file) {
  const files::StoredSweep stored = files::read_sweep(file);
  auto opened = std::make_shared<SweepOutcome>(stored.plan);
  opened->file = file;
  opened->result.status = stored.status;
  for (const std::size_t i : stored.computed)
    opened->result.rows.emplace_back(i, *cli::open_outcome(files::value_of_sweep(file, i)));
  return opened;
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
  py::class_<SweepOutcome, Outcome, std::shared_ptr<SweepOutcome>>(module, "SweepOutcome")
      .def_property_readonly("values",
                             [](const SweepOutcome& self) {
                               std::vector<std::string> names;
                               for (const cli::SweepRow& row : self.result.rows)
                                 names.push_back(files::value_of_sweep(self.file, row.index));
                               return names;
                             })
      .def("table", &table_of);
  py::class_<files::SweepPlan>(module, "SweepPlan").def_property_readonly("keys", &keys_of);
  module.def("plan_sweep", &plan_sweep, py::call_guard<py::gil_scoped_release>(), py::arg("toml"),
             py::arg("name"), py::arg("command"), py::arg("set"), py::arg("texts"),
             py::arg("typed"));
  module.def("make_sweep", &make_sweep, py::arg("plan"), py::arg("values"));
  module.def("extract_value", &files::extract_value, py::call_guard<py::gil_scoped_release>(),
             py::arg("value"), py::arg("target"));
  module.def("open_sweep", &open_sweep, py::call_guard<py::gil_scoped_release>(), py::arg("file"));
}

}  // namespace carom::python
