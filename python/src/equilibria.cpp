// Equilibria.
#include <memory>

#include "analyses/relax/report.hpp"
#include "loaded.hpp"
#include "run_in_background.hpp"

namespace py = pybind11;

namespace carom::python {

namespace {

using cli::RelaxOutcome;

py::tuple relax(const LoadedPointer& loaded, const py::object& progress) {
  RelaxOptions how = cli::relax_options(loaded->options);
  const auto outcome = std::make_shared<RelaxOutcome>(loaded);
  Course course;
  how.interrupted = &course.stop;
  how.progress = [&](std::uint64_t done) {
    course.done = done;
    course.share = static_cast<double>(done) / static_cast<double>(how.starts);
  };
  const std::exception_ptr interruption = run_in_background(
      course, progress, [&] { outcome->result = run_relax(loaded->system(), how); });
  return py::make_tuple(outcome, error_of(interruption));
}

}  // namespace

void add_equilibria(py::module_& module) {
  py::class_<RelaxOutcome, Outcome, std::shared_ptr<RelaxOutcome>>(module, "RelaxOutcome");
  module.def("relax", &relax, py::arg("system"), py::arg("progress"));
}

}  // namespace carom::python
