// Points that pictures draw through: walls, flights, potentials.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "carom/analyses/run/rows.hpp"
#include "carom/events/medium.hpp"
#include "carom/events/world.hpp"
#include "carom/forces/force_field.hpp"
#include "carom/geometry/curve_frame.hpp"
#include "carom/starts/sampler.hpp"
#include "carom/table/table.hpp"
#include "loaded.hpp"
#include "motion/free_motion.hpp"

namespace py = pybind11;

namespace carom::python {

namespace {

using geometry::Vector;

constexpr int points_a_quarter = 48;

struct PathPoint {
  double t, x, y;
};

py::array_t<double> pairs(const std::vector<Vector>& points) {
  py::array_t<double> array({static_cast<py::ssize_t>(points.size()), py::ssize_t{2}});
  auto view = array.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < view.shape(0); ++i) {
    view(i, 0) = points[static_cast<std::size_t>(i)].x;
    view(i, 1) = points[static_cast<std::size_t>(i)].y;
  }
  return array;
}

// A piece of a wall from the parameter u to v.
std::vector<Vector> piece(const geometry::Curve& curve, double u, double v) {
  const geometry::CurveFrame frame = geometry::frame_of(curve);
  if (frame.kind == geometry::CurveFrame::Kind::segment)
    return {geometry::point_at(frame, u), geometry::point_at(frame, v)};
  const int count = 1 + static_cast<int>(std::ceil((v - u) * points_a_quarter));
  std::vector<Vector> points;
  for (int i = 0; i <= count; ++i) {
    const double w = i == count ? v : u + (v - u) * i / count;
    const bool end = w >= geometry::end_parameter(curve);
    points.push_back(end ? geometry::end_point(curve) : geometry::point_at(frame, w));
  }
  return points;
}

// Of every wall, and of the edges of regions once: its name, its pieces, its holes with their
// names, and whether it is such an edge.
py::list walls(const Loaded& loaded) {
  const Table& table = *loaded.system().table;
  py::list all;
  for (std::size_t w = 0; w < table.walls.size(); ++w) {
    if (is_inner_side(table, static_cast<int>(w))) continue;
    const Wall& wall = table.walls[w];
    py::list pieces, holes;
    const double last = geometry::end_parameter(wall.curve);
    double from = 0.0;
    for (const int index : wall.holes) {
      const Hole& hole = table.holes[static_cast<std::size_t>(index)];
      if (hole.from > from) pieces.append(pairs(piece(wall.curve, from, hole.from)));
      holes.append(py::make_tuple(hole.name, pairs(piece(wall.curve, hole.from, hole.to))));
      from = hole.to;
    }
    if (from < last) pieces.append(pairs(piece(wall.curve, from, last)));
    all.append(py::make_tuple(wall.name, pieces, holes, is_passed(wall)));
  }
  return all;
}

// The walls around what is outside of all regions, and around each region.
py::list parts(const Loaded& loaded) {
  const Table& table = *loaded.system().table;
  py::list all;
  for (int r = -1; r < static_cast<int>(table.regions.size()); ++r) {
    py::list part;
    for (const Wall& wall : seen_from(table, r).walls)
      part.append(pairs(piece(wall.curve, 0.0, geometry::end_parameter(wall.curve))));
    all.append(part);
  }
  return all;
}

py::list cell(const Loaded& loaded) {
  py::list all;
  const Table& table = *loaded.system().table;
  if (table.lattice)
    for (const auto& edge : table.lattice->edges)
      all.append(pairs({edge.segment.from, edge.segment.to}));
  return all;
}

// Where cells of a lattice lie; without one, cells are where they are.
py::list translations(const Loaded& loaded,
                      const std::vector<std::pair<std::int64_t, std::int64_t>>& cells) {
  py::list all;
  const Table& table = *loaded.system().table;
  for (const auto& [first, second] : cells)
    all.append(pairs({table.lattice ? table.lattice->translation({first, second}) : Vector{}}));
  return all;
}

// The flight of a free particle from one event to the next; its end is left to the next one.
void fly(std::vector<PathPoint>& path, Vector x, Vector v, double omega, double from, double to) {
  const double quarter = 1.5707963267948966;
  const double turn = std::fabs(omega) * (to - from);
  const int count =
      turn > 0.0 ? 1 + static_cast<int>(std::min(1e6, turn / quarter * points_a_quarter)) : 1;
  for (int i = 0; i < count; ++i) {
    const double duration = (to - from) * i / count;
    const Vector y = i == 0 ? x : motion::moved(x, v, omega, duration).first;
    path.push_back({from + duration, y.x, y.y});
  }
}

// Rows of (t, x, y, vx, vy), from each of which a particle flies on; and, where regions differ, the
// wall that it flies from, -1: none.
using Flights = py::array_t<double, py::array::c_style>;

// The Larmor frequency of a flight. `free`: it is one, between events.
class Turning {
 public:
  Turning(const Loaded& loaded, std::size_t particle, bool free)
      : table_(*loaded.system().table), particle_(loaded.system().particles.at(particle)) {
    if (!free) particle_.omega = 0.0;
    if (free && !table_.regions.empty()) world_.emplace(table_);
  }
  template <class Rows>
  double operator()(const Rows& row, py::ssize_t i) {
    if (!world_) return particle_.omega;
    if (row(i, 5) >= 0.0)
      return in_region(table_, particle_, region_of(table_, static_cast<int>(row(i, 5)))).omega;
    State state;
    state.position = {row(i, 1), row(i, 2)};
    state.velocity = {row(i, 3), row(i, 4)};
    fold_into_cell(table_, state.position, state.cell);
    world_->clear();
    world_->add(particle_, state);
    return world_->particle(0).omega;
  }

 private:
  const Table& table_;
  Particle particle_;
  std::optional<World> world_;
};

// The flights through rows, the last of which ends the path.
py::array_t<PathPoint> path(const Loaded& loaded, std::size_t particle, bool free,
                            const Flights& rows) {
  const auto row = rows.unchecked<2>();
  Turning turning(loaded, particle, free);
  std::vector<PathPoint> points;
  for (py::ssize_t i = 0; i + 1 < row.shape(0); ++i)
    fly(points, {row(i, 1), row(i, 2)}, {row(i, 3), row(i, 4)}, turning(row, i), row(i, 0),
        row(i + 1, 0));
  if (row.shape(0) > 0) {
    const py::ssize_t last = row.shape(0) - 1;
    points.push_back({row(last, 0), row(last, 1), row(last, 2)});
  }
  return array_of(std::move(points));
}

// Are the starts listed in the system, rather than drawn? How many of its trajectories differ.
std::uint64_t listed(const Loaded& loaded) { return listed_trajectories(loaded.system()); }

// The start of each particle of the first trajectories: x, y, vx, vy.
py::array_t<double> starts(const Loaded& loaded, std::uint64_t trajectories) {
  const System& system = loaded.system();
  const Sampler sampler(system);
  std::vector<State> states;
  for (std::uint64_t i = 0; i < trajectories; ++i) {
    World world(*system.table, system.dynamics);
    add_starts(world, sampler, i);
    for (int p = 0; p < world.size(); ++p) states.push_back(world.state(p));
  }
  py::array_t<double> array({static_cast<py::ssize_t>(states.size()), py::ssize_t{4}});
  auto view = array.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < view.shape(0); ++i) {
    const SampleRow row =
        sample_row(0, Time(0.0), states[static_cast<std::size_t>(i)], *system.table);
    view(i, 0) = row.x;
    view(i, 1) = row.y;
    view(i, 2) = row.vx;
    view(i, 3) = row.vy;
  }
  return array;
}

// Where particles are at each time: x and y by time and particle, NaN before the start and after
// the end. Rows are those of path(), one table a particle, each in order of time.
py::array_t<double> frames(const Loaded& loaded, const std::vector<std::size_t>& particles,
                           bool free, const std::vector<Flights>& tables,
                           const std::vector<double>& times) {
  const auto many = static_cast<py::ssize_t>(tables.size());
  py::array_t<double> array({static_cast<py::ssize_t>(times.size()), many, py::ssize_t{2}});
  auto view = array.mutable_unchecked<3>();
  for (py::ssize_t p = 0; p < many; ++p) {
    const auto row = tables[static_cast<std::size_t>(p)].unchecked<2>();
    Turning turning(loaded, particles[static_cast<std::size_t>(p)], free);
    py::ssize_t i = 0, from = -1;
    double omega = 0.0;
    for (py::ssize_t k = 0; k < view.shape(0); ++k) {
      const double t = times[static_cast<std::size_t>(k)];
      while (i + 1 < row.shape(0) && row(i + 1, 0) <= t) ++i;
      Vector x{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
      if (row.shape(0) > 0 && row(0, 0) <= t && t <= row(row.shape(0) - 1, 0)) {
        if (i + 1 < row.shape(0) && i != from) omega = turning(row, from = i);
        x = motion::moved({row(i, 1), row(i, 2)}, {row(i, 3), row(i, 4)}, omega, t - row(i, 0))
                .first;
      }
      view(k, p, 0) = x.x;
      view(k, p, 1) = x.y;
    }
  }
  return array;
}

// Of each particle outside, and in each region.
std::vector<double> omegas(const Loaded& loaded) {
  std::vector<double> all;
  const Table& table = *loaded.system().table;
  for (const Particle& p : loaded.system().particles) {
    all.push_back(p.omega);
    for (std::size_t r = 0; r < table.regions.size(); ++r)
      all.push_back(in_region(table, p, static_cast<int>(r)).omega);
  }
  return all;
}

// Of each particle; none where they are points.
std::vector<double> disc_radii(const Loaded& loaded) {
  if (!loaded.system().of_discs()) return {};
  return loaded.system().dynamics.forces->disc_radii();
}

// The potential energy of the first particle on a grid; None where there is no potential.
py::object potential(const Loaded& loaded, const std::vector<double>& xs,
                     const std::vector<double>& ys) {
  const System& system = loaded.system();
  if (!system.dynamics.forces || !system.dynamics.forces->external()) return py::none();
  py::array_t<double> array({ys.size(), xs.size()});
  auto view = array.mutable_unchecked<2>();
  for (std::size_t j = 0; j < ys.size(); ++j)
    for (std::size_t i = 0; i < xs.size(); ++i) {
      Vector unused{};
      view(static_cast<py::ssize_t>(j), static_cast<py::ssize_t>(i)) =
          system.dynamics.forces->add_external(system.particles.front(), {xs[i], ys[j]}, unused);
    }
  return array;
}

}  // namespace

void add_pictures(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(PathPoint, t, x, y);
  module.def("walls", &walls, py::arg("system"));
  module.def("parts", &parts, py::arg("system"));
  module.def("cell", &cell, py::arg("system"));
  module.def("translations", &translations, py::arg("system"), py::arg("cells"));
  module.def("path", &path, py::arg("system"), py::arg("particle"), py::arg("free"),
             py::arg("rows"));
  module.def("disc_radii", &disc_radii, py::arg("system"));
  module.def("frames", &frames, py::arg("system"), py::arg("particles"), py::arg("free"),
             py::arg("tables"), py::arg("times"));
  module.def("listed", &listed, py::arg("system"));
  module.def("starts", &starts, py::arg("system"), py::arg("trajectories"));
  module.def("omegas", &omegas, py::arg("system"));
  module.def("potential", &potential, py::arg("system"), py::arg("xs"), py::arg("ys"));
}

}  // namespace carom::python
