// The engine against identities and published values.
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "carom/files/ensembles.hpp"
#include "cli/commands/validate.hpp"
#include "cli/common.hpp"
#include "loaded.hpp"
#include "run_in_background.hpp"

namespace py = pybind11;

namespace carom::python {

namespace {

struct ValidationOutcome final : Outcome {
  files::Json json() const override { return cli::validation_json(all); }
  std::string text() const override {
    std::string text;
    for (const auto& one : all.cases) text += cli::text_of(one);
    return text + cli::summary_of(all);
  }
  std::vector<std::string> doubts() const override {
    std::vector<std::string> failed;
    for (const auto& one : all.cases)
      if (!one.check.passed) failed.push_back(fmt::format("failed: {}", one.of.name));
    return failed;
  }

  cli::Validation all;
};

py::tuple validate(bool soak, const std::string& scale, const std::string& threads,
                   const py::object& progress) {
  cli::Options options;
  options.command = "validate";
  options.soak = soak;
  options.scale = scale;
  options.threads = threads;
  validation::CheckOptions how;
  how.threads = cli::threads_of(options);
  Course course;
  how.interrupted = &course.stop;
  const auto outcome = std::make_shared<ValidationOutcome>();
  const std::exception_ptr interruption = run_in_background(course, progress, [&] {
    outcome->all = cli::run_validation(
        options, how, [&](double share, const std::string&) { course.share = share; },
        [&](const auto&) { ++course.done; });
  });
  return py::make_tuple(outcome, error_of(interruption));
}

}  // namespace

void add_validation(py::module_& module) {
  py::class_<ValidationOutcome, Outcome, std::shared_ptr<ValidationOutcome>>(module,
                                                                             "ValidationOutcome");
  module.def("validate", &validate, py::arg("soak"), py::arg("scale"), py::arg("threads"),
             py::arg("progress"));
}

}  // namespace carom::python
