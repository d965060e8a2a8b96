// Integrators: their list, and compared on a system.
#include <pybind11/stl.h>

#include <string>
#include <utility>
#include <vector>

#include "analyses/compare/command.hpp"
#include "analyses/compare/report.hpp"
#include "carom/analyses/compare/archive.hpp"
#include "cli/commands/commands.hpp"
#include "cli/common.hpp"
#include "cli/reports/scheme_report.hpp"
#include "loaded.hpp"
#include "run_in_background.hpp"

namespace py = pybind11;

namespace carom::python {

namespace {

struct ComparisonOutcome {
  LoadedPointer system;
  Comparison result;
};

py::tuple compare(const std::shared_ptr<Loaded>& loaded, const py::object& progress) {
  ComparisonOutcome outcome;
  outcome.system = loaded;
  Course course;
  ComparePlan plan = cli::compare_plan(loaded->options);
  plan.interrupted = [&] { return course.stop.load(std::memory_order_relaxed); };
  plan.progress = [&](std::size_t done, std::size_t all) {
    course.done = done;
    course.share = static_cast<double>(done) / static_cast<double>(all);
  };
  const std::exception_ptr interruption = run_in_background(
      course, progress, [&] { outcome.result = carom::compare(loaded->system(), plan); });
  return py::make_tuple(std::move(outcome), error_of(interruption));
}

ComparisonOutcome open_comparison(const std::string& file) {
  StoredComparison stored = read_comparison(file);
  auto loaded = std::make_shared<Loaded>();
  loaded->options = options_of(stored.system_toml, file + ": /system", "compare", {}, {});
  loaded->loaded = cli::system_of_command(loaded->options);
  loaded->loaded.system.name = stored.system_name;
  ComparisonOutcome outcome;
  outcome.system = std::move(loaded);
  outcome.result = std::move(stored.result);
  return outcome;
}

void save(const ComparisonOutcome& self, const std::string& file, bool force) {
  const LoadedSystem& loaded = self.system->loaded;
  write_comparison(followed(file), loaded,
                   cli::provenance_of(self.system->options, loaded.system, 1), self.result, force);
}

}  // namespace

void add_comparisons(py::module_& module) {
  py::class_<ComparisonOutcome>(module, "ComparisonOutcome")
      .def_property_readonly("system",
                             [](const ComparisonOutcome& self) {
                               return std::const_pointer_cast<Loaded>(self.system);
                             })
      .def("json",
           [](const ComparisonOutcome& self) {
             return cli::compare_json(self.system->system(), self.result, "").text();
           })
      .def("text",
           [](const ComparisonOutcome& self) {
             return cli::compare_text(self.system->system(), self.result, "", false);
           })
      .def("doubts", [](const ComparisonOutcome&) { return std::vector<std::string>(); })
      .def("save", &save, py::call_guard<py::gil_scoped_release>(), py::arg("file"),
           py::arg("force"));
  module.def("compare", &compare, py::arg("system"), py::arg("progress"));
  module.def("open_comparison", &open_comparison, py::call_guard<py::gil_scoped_release>(),
             py::arg("file"));
  module.def("schemes", [] { return cli::schemes_json().text(); });
}

}  // namespace carom::python
