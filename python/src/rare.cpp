// Rare events: survival by splitting populations.
#include <exception>
#include <memory>

#include "analyses/splitting/command.hpp"
#include "carom/analyses/splitting.hpp"
#include "cli/common.hpp"
#include "loaded.hpp"
#include "run_in_background.hpp"

namespace py = pybind11;

namespace carom::python {

namespace {

using cli::SplittingOutcome;

py::tuple split(const LoadedPointer& loaded, const py::object& progress) {
  const auto outcome = std::make_shared<SplittingOutcome>(loaded);
  SplittingResult& result = outcome->result;
  const SplittingPlan plan = cli::plan_of(loaded->options);
  Course course;
  SplittingOptions how;
  how.threads = cli::threads_of(loaded->options);
  how.interrupted = &course.stop;
  how.progress = [&](std::uint64_t done, std::uint64_t all, std::uint64_t) {
    course.done = done;
    course.share = static_cast<double>(done) / static_cast<double>(all);
  };
  const std::exception_ptr interruption = run_in_background(
      course, progress, [&] { result = run_splitting(loaded->system(), plan, how); });
  // Without a population of each kick there is nothing to report.
  if (interruption && (result.runs.empty() || result.runs.back().empty() || result.at.empty()))
    std::rethrow_exception(interruption);
  return py::make_tuple(outcome, error_of(interruption));
}

}  // namespace

void add_rare(py::module_& module) {
  py::class_<SplittingOutcome, Outcome, std::shared_ptr<SplittingOutcome>>(module,
                                                                           "SplittingOutcome");
  module.def("split", &split, py::arg("system"), py::arg("progress"));
}

}  // namespace carom::python
