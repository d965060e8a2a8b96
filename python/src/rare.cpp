// Rare events: survival by splitting populations.
#include <pybind11/stl.h>

#include <exception>
#include <memory>
#include <utility>

#include "analyses/splitting/command.hpp"
#include "carom/analyses/splitting.hpp"
#include "cli/common.hpp"
#include "loaded.hpp"
#include "run_in_background.hpp"

namespace py = pybind11;

namespace carom::python {

namespace {

struct SplittingOutcome {
  std::shared_ptr<Loaded> system;
  SplittingResult result;
};

py::tuple split(const std::shared_ptr<Loaded>& loaded, const py::object& progress) {
  SplittingOutcome outcome{loaded, {}};
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
      course, progress, [&] { outcome.result = run_splitting(loaded->system(), plan, how); });
  // Without a population of each kick there is nothing to report.
  if (interruption && (outcome.result.runs.empty() || outcome.result.runs.back().empty() ||
                       outcome.result.at.empty()))
    std::rethrow_exception(interruption);
  return py::make_tuple(std::move(outcome), error_of(interruption));
}

}  // namespace

void add_rare(py::module_& module) {
  py::class_<SplittingOutcome>(module, "SplittingOutcome")
      .def_property_readonly("system", [](const SplittingOutcome& self) { return self.system; })
      .def("json",
           [](const SplittingOutcome& self) {
             return cli::splitting_json(self.system->system(), self.result).text();
           })
      .def("text",
           [](const SplittingOutcome& self) {
             return cli::splitting_text(self.system->system(), self.result);
           })
      .def("doubts", [](const SplittingOutcome& self) {
        std::vector<std::string> lines = cli::doubts_of(self.result).lines;
        for (const std::string& note : cli::notes_of(self.result)) lines.push_back(note);
        return lines;
      });
  module.def("split", &split, py::arg("system"), py::arg("progress"));
}

}  // namespace carom::python
