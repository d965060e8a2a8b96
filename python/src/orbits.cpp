// Periodic orbits.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <memory>
#include <utility>
#include <vector>

#include "analyses/orbits/command.hpp"
#include "analyses/orbits/report.hpp"
#include "carom/analyses/orbits/archive.hpp"
#include "carom/files/archive.hpp"
#include "cli/common.hpp"
#include "loaded.hpp"
#include "run_in_background.hpp"

namespace py = pybind11;

namespace carom::python {

namespace {

struct OrbitsOutcome {
  LoadedPointer system;
  std::uint64_t most_hits = 0;
  OrbitSearchResult result;
  ProofsOfOrbits proofs;

  cli::OrbitContext context() const {
    return {most_hits, result.complete ? "completed" : "interrupted", "", false, proofs};
  }
};

py::tuple orbits(const std::shared_ptr<Loaded>& loaded, const py::object& progress) {
  OrbitSearchOptions how = cli::orbit_search_options(loaded->options);
  OrbitsOutcome outcome;
  outcome.system = loaded;
  outcome.most_hits = how.most_hits;
  Course course;
  how.interrupted = &course.stop;
  how.progress = [&](std::uint64_t tried, std::uint64_t all) {
    course.done = tried;
    course.share = static_cast<double>(tried) / static_cast<double>(all);
  };
  const std::exception_ptr interruption = run_in_background(course, progress, [&] {
    cli::digits_of_orbits(loaded->options, *loaded->system().table);  // refused at once
    outcome.result = find_orbits(loaded->system(), how);
    outcome.proofs =
        cli::proofs_of_orbits(loaded->options, loaded->loaded, outcome.result, course.stop);
  });
  return py::make_tuple(std::move(outcome), error_of(interruption));
}

OrbitsOutcome open_orbits(const std::string& file) {
  StoredOrbits stored = read_orbits(file);
  auto loaded = std::make_shared<Loaded>();
  loaded->loaded = read_system(stored.system_toml, file + ": /system");
  loaded->loaded.system.name = stored.system_name;
  loaded->options.command = "orbit";
  OrbitsOutcome outcome;
  outcome.system = std::move(loaded);
  outcome.most_hits = stored.most_hits;
  outcome.result = std::move(stored.result);
  outcome.proofs = std::move(stored.proofs);
  return outcome;
}

void save(const OrbitsOutcome& self, const std::string& file, bool force) {
  const LoadedSystem& loaded = self.system->loaded;
  write_orbits(followed(file), loaded,
               cli::provenance_of(self.system->options, loaded.system, self.result.threads),
               self.result, self.proofs, self.most_hits, force);
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
    all.push_back(path_of(orbit, *self.system->system().table));
  return all;
}

}  // namespace

void add_orbits(py::module_& module) {
  py::class_<OrbitsOutcome>(module, "OrbitsOutcome")
      .def_property_readonly(
          "system",
          [](const OrbitsOutcome& self) { return std::const_pointer_cast<Loaded>(self.system); })
      .def("json",
           [](const OrbitsOutcome& self) {
             return cli::orbit_json(self.system->system(), self.result, self.context()).text();
           })
      .def("text",
           [](const OrbitsOutcome& self) {
             return cli::orbit_text(self.system->system(), self.result, self.context());
           })
      .def("doubts", [](const OrbitsOutcome&) { return std::vector<std::string>(); })
      .def("paths", &paths)
      .def("save", &save, py::call_guard<py::gil_scoped_release>(), py::arg("file"),
           py::arg("force"));
  module.def("orbits", &orbits, py::arg("system"), py::arg("progress"));
  module.def("open_orbits", &open_orbits, py::call_guard<py::gil_scoped_release>(),
             py::arg("file"));
}

}  // namespace carom::python
