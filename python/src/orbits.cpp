// Periodic orbits.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <memory>
#include <vector>

#include "analyses/orbits/report.hpp"
#include "loaded.hpp"
#include "run_in_background.hpp"

namespace py = pybind11;

namespace carom::python {

namespace {

using cli::OrbitsOutcome;

py::tuple orbits(const LoadedPointer& loaded, const py::object& progress) {
  OrbitSearchOptions how = cli::orbit_search_options(loaded->options);
  const auto outcome = std::make_shared<OrbitsOutcome>(loaded);
  outcome->most_hits = how.most_hits;
  Course course;
  how.interrupted = &course.stop;
  how.progress = [&](std::uint64_t tried, std::uint64_t all) {
    course.done = tried;
    course.share = static_cast<double>(tried) / static_cast<double>(all);
  };
  const std::exception_ptr interruption = run_in_background(course, progress, [&] {
    cli::digits_of_orbits(loaded->options, *loaded->system().table);  // refused at once
    outcome->result = find_orbits(loaded->system(), how);
    outcome->proofs =
        cli::proofs_of_orbits(loaded->options, loaded->loaded, outcome->result, course.stop);
  });
  return py::make_tuple(outcome, error_of(interruption));
}

// (t, x, y, vx, vy) at each hit and at the end of the period, in the plane.
py::array_t<double> path_of(const PeriodicOrbit& orbit, const Table& table) {
  const std::size_t n = orbit.hits.size();
  py::array_t<double> rows({static_cast<py::ssize_t>(n + 1), py::ssize_t{5}});
  auto view = rows.mutable_unchecked<2>();
  geometry::Cell cell;
  double time = 0.0;
  for (std::size_t i = 0; i <= n; ++i) {
    const OrbitHit& hit = orbit.hits[i % n];
    geometry::Vector at = hit.position;
    if (table.lattice) at = at + table.lattice->translation(cell);
    const double row[] = {time, at.x, at.y, hit.velocity.x, hit.velocity.y};
    for (py::ssize_t k = 0; k < 5; ++k) view(static_cast<py::ssize_t>(i), k) = row[k];
    time += hit.flight_time;
    cell = {cell.first + hit.step.first, cell.second + hit.step.second};
  }
  return rows;
}

std::vector<py::array_t<double>> paths(const OrbitsOutcome& self) {
  std::vector<py::array_t<double>> all;
  for (const PeriodicOrbit& orbit : self.result.orbits)
    all.push_back(path_of(orbit, *self.system().table));
  return all;
}

}  // namespace

void add_orbits(py::module_& module) {
  py::class_<OrbitsOutcome, Outcome, std::shared_ptr<OrbitsOutcome>>(module, "OrbitsOutcome")
      .def("paths", &paths);
  module.def("orbits", &orbits, py::arg("system"), py::arg("progress"));
}

}  // namespace carom::python
