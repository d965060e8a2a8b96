// Certified orbits: every digit that is handed over is guaranteed.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "analyses/run/command_certified.hpp"
#include "carom/analyses/run/certified_archive.hpp"
#include "carom/base/error.hpp"
#include "carom/base/stopwatch.hpp"
#include "carom/certify/certified_orbit.hpp"
#include "cli/common.hpp"
#include "loaded.hpp"
#include "run_in_background.hpp"

namespace py = pybind11;

namespace carom::python {

namespace {

struct CertifiedOutcome {
  std::shared_ptr<Loaded> system;
  CertifiedTask task;
  CertifiedEnd end;
  CertifiedEffort effort;
  std::vector<CertifiedHit> hits;
  double seconds = 0, cpu_seconds = 0;
};

py::tuple run(const std::shared_ptr<Loaded>& loaded, const py::object& progress) {
  CertifiedOutcome outcome;
  outcome.system = std::make_shared<Loaded>(*loaded);  // its start is drawn
  Course course;
  const std::exception_ptr interruption = run_in_background(course, progress, [&] {
    const Stopwatch watch;
    outcome.task = cli::certified_task(loaded->options, outcome.system->loaded);
    CertifiedOrbit orbit(outcome.system->loaded.exact, outcome.task,
                         [&] { return course.stop.load(std::memory_order_relaxed); });
    while (auto hit = orbit.next()) {
      course.done.store(hit->number, std::memory_order_relaxed);
      if (outcome.task.collisions > 0)
        course.share.store(
            static_cast<double>(hit->number) / static_cast<double>(outcome.task.collisions),
            std::memory_order_relaxed);
      outcome.hits.push_back(std::move(*hit));
    }
    outcome.end = orbit.end_state();
    outcome.effort = orbit.effort();
    outcome.seconds = watch.seconds();
    outcome.cpu_seconds = watch.cpu_seconds();
  });
  if (interruption && !outcome.end.x.has_value()) std::rethrow_exception(interruption);
  return py::make_tuple(std::move(outcome), error_of(interruption));
}

// Of each hit: number, wall, and t, x, y, vx, vy as text.
py::list hits(const CertifiedOutcome& self) {
  py::list all;
  for (const CertifiedHit& hit : self.hits) {
    py::tuple row(7);
    row[0] = hit.number;
    row[1] = self.system->system().table->wall(hit.wall).name;
    std::size_t column = 2;
    for (const CertifiedNumber* number : {&hit.t, &hit.x, &hit.y, &hit.vx, &hit.vy})
      row[column++] = number->text(self.task.digits);
    all.append(row);
  }
  return all;
}

CertifiedOutcome open_certified(const std::string& file) {
  StoredCertified stored = read_certified(file);
  if (!stored.end.x.has_value())
    throw InputError(Place{file, 0, 0, ""}, "the run was interrupted before its first state");
  CertifiedOutcome outcome;
  outcome.system = std::make_shared<Loaded>();
  outcome.system->loaded = read_system(stored.system_toml, file + ": /system");
  outcome.system->loaded.system.name = stored.system_name;
  outcome.system->options.command = "run";
  outcome.task = std::move(stored.task);
  outcome.end = std::move(stored.end);
  outcome.effort = stored.effort;
  outcome.hits = std::move(stored.hits);
  return outcome;
}

void save(const CertifiedOutcome& self, const std::string& file, bool force) {
  const LoadedSystem& loaded = self.system->loaded;
  CertifiedArchive archive(followed(file), loaded,
                           cli::provenance_of(self.system->options, loaded.system, 1), self.task,
                           force);
  for (const CertifiedHit& hit : self.hits) archive.hit(hit);
  archive.finish(self.end, self.effort, name_of(self.end.fate),
                 self.end.fate != CertifiedFate::interrupted);
}

}  // namespace

void add_certified(py::module_& module) {
  py::class_<CertifiedOutcome>(module, "CertifiedOutcome")
      .def_property_readonly("system", [](const CertifiedOutcome& self) { return self.system; })
      .def("json",
           [](const CertifiedOutcome& self) {
             return cli::certified_json(self.system->system(), self.end, self.task, self.effort, "",
                                        self.seconds, self.cpu_seconds)
                 .text();
           })
      .def("text",
           [](const CertifiedOutcome& self) {
             return cli::certified_text(self.system->system(), self.end, self.task, self.effort, "",
                                        self.seconds);
           })
      .def("doubts", [](const CertifiedOutcome&) { return std::vector<std::string>(); })
      .def("hits", &hits)
      .def("save", &save, py::call_guard<py::gil_scoped_release>(), py::arg("file"),
           py::arg("force"));
  module.def("run_certified", &run, py::arg("system"), py::arg("progress"));
  module.def("open_certified", &open_certified, py::call_guard<py::gil_scoped_release>(),
             py::arg("file"));
}

}  // namespace carom::python
