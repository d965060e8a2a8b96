// Equilibria.
#include <pybind11/stl.h>

#include <string>
#include <vector>

#include "analyses/relax/report.hpp"
#include "carom/analyses/relax/archive.hpp"
#include "cli/common.hpp"
#include "loaded.hpp"
#include "run_in_background.hpp"

namespace py = pybind11;

namespace carom::python {

namespace {

struct RelaxOutcome {
  LoadedPointer system;
  RelaxResult result;
};

py::tuple relax(const std::shared_ptr<Loaded>& loaded, const py::object& progress) {
  RelaxOptions how = cli::relax_options(loaded->options);
  RelaxOutcome outcome;
  outcome.system = loaded;
  Course course;
  how.interrupted = &course.stop;
  how.progress = [&](std::uint64_t done) {
    course.done = done;
    course.share = static_cast<double>(done) / static_cast<double>(how.starts);
  };
  const std::exception_ptr interruption = run_in_background(
      course, progress, [&] { outcome.result = run_relax(loaded->system(), how); });
  return py::make_tuple(std::move(outcome), error_of(interruption));
}

void save(const RelaxOutcome& self, const std::string& file, bool force) {
  const LoadedSystem& loaded = self.system->loaded;
  write_equilibria(followed(file), loaded,
                   cli::provenance_of(self.system->options, loaded.system, self.result.threads),
                   self.result, force);
}

RelaxOutcome open_relax(const std::string& file) {
  StoredEquilibria stored = read_equilibria(file);
  auto loaded = std::make_shared<Loaded>();
  SystemOverrides without_step;
  without_step.choose_step = false;
  loaded->loaded = read_system(stored.system_toml, file + ": /system", without_step);
  loaded->loaded.system.name = stored.system_name;
  loaded->options.command = "relax";
  return {std::move(loaded), std::move(stored.result)};
}

}  // namespace

void add_equilibria(py::module_& module) {
  py::class_<RelaxOutcome>(module, "RelaxOutcome")
      .def_property_readonly(
          "system",
          [](const RelaxOutcome& self) { return std::const_pointer_cast<Loaded>(self.system); })
      .def("json",
           [](const RelaxOutcome& self) {
             return cli::relax_json(self.system->system(), self.result, "").text();
           })
      .def("text",
           [](const RelaxOutcome& self) {
             return cli::relax_text(self.system->system(), self.result, "", false);
           })
      .def("doubts", [](const RelaxOutcome&) { return std::vector<std::string>(); })
      .def("save", &save, py::call_guard<py::gil_scoped_release>(), py::arg("file"),
           py::arg("force"));
  module.def("relax", &relax, py::arg("system"), py::arg("progress"));
  module.def("open_relax", &open_relax, py::call_guard<py::gil_scoped_release>(), py::arg("file"));
}

}  // namespace carom::python
