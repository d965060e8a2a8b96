// Integrators: their list, and compared on a system.
#include <memory>

#include "analyses/compare/report.hpp"
#include "cli/reports/scheme_report.hpp"
#include "loaded.hpp"
#include "run_in_background.hpp"

namespace py = pybind11;

namespace carom::python {

namespace {

using cli::ComparisonOutcome;

py::tuple compare(const LoadedPointer& loaded, const py::object& progress) {
  const auto outcome = std::make_shared<ComparisonOutcome>(loaded);
  Course course;
  ComparePlan plan = cli::compare_plan(loaded->options);
  plan.interrupted = [&] { return course.stop.load(std::memory_order_relaxed); };
  plan.progress = [&](std::size_t done, std::size_t all) {
    course.done = done;
    course.share = static_cast<double>(done) / static_cast<double>(all);
  };
  const std::exception_ptr interruption = run_in_background(
      course, progress, [&] { outcome->result = carom::compare(loaded->system(), plan); });
  return py::make_tuple(outcome, error_of(interruption));
}

}  // namespace

void add_comparisons(py::module_& module) {
  py::class_<ComparisonOutcome, Outcome, std::shared_ptr<ComparisonOutcome>>(module,
                                                                             "ComparisonOutcome");
  module.def("compare", &compare, py::arg("system"), py::arg("progress"));
  module.def("schemes", [] { return cli::schemes_json().text(); });
}

}  // namespace carom::python
