// Certified orbits: every digit that is handed over is guaranteed.
#include <pybind11/pybind11.h>

#include <memory>
#include <utility>

#include "analyses/run/command_certified.hpp"
#include "carom/base/stopwatch.hpp"
#include "carom/certify/certified_orbit.hpp"
#include "loaded.hpp"
#include "run_in_background.hpp"

namespace py = pybind11;

namespace carom::python {

namespace {

using cli::CertifiedOutcome;

py::tuple run(const LoadedPointer& loaded, const py::object& progress) {
  // Its start is drawn.
  const auto made = std::make_shared<CertifiedOutcome>(std::make_shared<Loaded>(*loaded));
  CertifiedOutcome& outcome = *made;
  Course course;
  const std::exception_ptr interruption = run_in_background(course, progress, [&] {
    const Stopwatch watch;
    outcome.task = cli::certified_task(loaded->options, outcome.loaded->loaded);
    CertifiedOrbit orbit(outcome.loaded->loaded.exact, outcome.task,
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
  return py::make_tuple(made, error_of(interruption));
}

// Of each hit: number, wall, and t, x, y, vx, vy as text.
py::list hits(const CertifiedOutcome& self) {
  py::list all;
  for (const CertifiedHit& hit : self.hits) {
    py::tuple row(7);
    row[0] = hit.number;
    row[1] = self.system().table->wall(hit.wall).name;
    std::size_t column = 2;
    for (const CertifiedNumber* number : {&hit.t, &hit.x, &hit.y, &hit.vx, &hit.vy})
      row[column++] = number->text(self.task.digits);
    all.append(row);
  }
  return all;
}

}  // namespace

void add_certified(py::module_& module) {
  py::class_<CertifiedOutcome, Outcome, std::shared_ptr<CertifiedOutcome>>(module,
                                                                           "CertifiedOutcome")
      .def("hits", &hits);
  module.def("run_certified", &run, py::arg("system"), py::arg("progress"));
}

}  // namespace carom::python
