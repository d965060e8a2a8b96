#include <algorithm>
#include <cmath>

#include "carom/analyses/diffusion.hpp"
#include "table/inset.hpp"

namespace carom {

namespace {

constexpr double pi = 3.141592653589793;

// Spacing s of a triangular lattice, 0 for any other: the squares of three vectors are equal, but
// for what rounding does to them. With u = 2^-53 each coordinate, such as sqrt(3)/2 s, was rounded
// to a double and to the lattice's grid of 4u s: 3u s together, so a square errs by 2 sqrt(2) 3u
// s^2, that of a sum or difference by twice as much; together less than 26u s^2, and 4u here.
double triangular_spacing(const geometry::Lattice& lattice) {
  const geometry::Vector a = lattice.first, b = lattice.second;
  double squares[] = {dot(a, a), dot(b, b), dot(a + b, a + b), dot(a - b, a - b)};
  std::sort(std::begin(squares), std::end(squares));
  return squares[2] - squares[0] <= 0x1p-48 * squares[0] ? std::sqrt(squares[0]) : 0.0;
}

// Machta and Zwanzig, Phys. Rev. Lett. 50, 1959 (1983): jumps between traps of area
// (sqrt(3)/4) s^2 - pi R^2/2 through three gaps s - 2R, uncorrelated.
std::optional<double> machta_zwanzig(const Table& table, double speed) {
  if (table.walls.size() != 1) return std::nullopt;
  const auto* disc = std::get_if<geometry::Circle>(&table.walls.front().curve);
  const double spacing = triangular_spacing(*table.lattice);
  if (!disc || !(spacing > 0)) return std::nullopt;
  const double w = spacing / disc->radius - 2, s = 2 + w;
  return disc->radius * speed * w * s * s / (pi * (std::sqrt(3.0) * s * s - 2 * pi));
}

}  // namespace

Horizon horizon_of(const System& system) {
  // A hard disc flies as its centre does: among the curves at its radius from the walls. Several
  // also meet each other, and what corridors there are is not where they fly freely.
  const bool of_discs = system.of_discs(), one_disc = of_discs && system.particles.size() == 1;
  const bool inset = one_disc && system.table->extent == Extent::lattice;
  const Table table =
      inset ? table::inset_table(*system.table, system.particles.front().radius) : *system.table;
  Horizon horizon;
  const bool bent = std::all_of(system.particles.begin(), system.particles.end(),
                                [](const Particle& p) { return p.omega != 0.0; });
  const bool forces = system.has_forces();
  switch (table.extent) {
    case Extent::bounded:
      horizon.kind = Horizon::Kind::bounded;
      return horizon;
    case Extent::open_plane:
      horizon.kind = bent || forces ? Horizon::Kind::unknown : Horizon::Kind::open_plane;
      return horizon;
    case Extent::lattice:
      break;
  }
  if ((of_discs && !one_disc) || !table.regions.empty()) return horizon;
  std::vector<geometry::Curve> curves;
  for (const Wall& wall : table.walls) curves.push_back(wall.curve);
  horizon.corridors = geometry::free_corridors(*table.lattice, curves);
  if (forces || !horizon.corridors.decided) return horizon;
  const bool open = !horizon.corridors.list.empty() && !bent;
  horizon.kind = open ? Horizon::Kind::infinite : Horizon::Kind::finite;
  if (open) horizon.flight_tail = geometry::flight_tail(horizon.corridors, measure(table).area);
  const bool straight = std::all_of(system.particles.begin(), system.particles.end(),
                                    [](const Particle& p) { return p.omega == 0.0; });
  if (!open && straight)
    horizon.machta_zwanzig = machta_zwanzig(table, system.particles.front().speed);
  return horizon;
}

std::string no_diffusion(const Horizon& horizon) {
  switch (horizon.kind) {
    case Horizon::Kind::infinite:
      return "infinite horizon: particles fly freely along corridors and the MSD grows faster than "
             "t";
    case Horizon::Kind::bounded:
      return "the table is bounded: the MSD tends to a constant";
    case Horizon::Kind::open_plane:
      return "open plane: particles leave for good and the MSD ends as t^2";
    case Horizon::Kind::finite:
    case Horizon::Kind::unknown:
      break;
  }
  return {};
}

}  // namespace carom
