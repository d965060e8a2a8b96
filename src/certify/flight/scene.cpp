#include "certify/flight/scene.hpp"

#include "certify/number/interval.hpp"

namespace carom::certify {
namespace {

/// An arc of at most half a turn: its centre is beside it or behind its chord. Of others this is
/// not said.
bool is_half_at_most(const WallOf<Ball>& w) {
  if (w.form == Form::segment || w.closed) return false;
  return sign(cross(w.chord, w.centre - w.from)) ==
         (w.turn > 0.0 ? Sign::positive : Sign::negative);
}

}  // namespace

Whereabouts whereabouts_of(const BallTable& table) {
  Whereabouts r;
  const auto vector = [](const BallVector& v) {
    return geometry::Vector{v.x.to_double(), v.y.to_double()};
  };
  for (const WallOf<Ball>& w : table.walls) {
    Whereabouts::Disc disc;
    if (w.form == Form::segment) {
      const geometry::Vector from = vector(w.from), to = vector(w.to), d = to - from;
      disc = {0.5 * from + 0.5 * to, 0.5 * std::sqrt(dot(d, d))};
    } else if (w.form == Form::circle) {
      disc = {vector(w.centre), std::sqrt(w.radius2.to_double())};
    } else {
      // Rows of the map to the unit circle are axes over their squares.
      const geometry::Vector p = vector(w.along), q = vector(w.across);
      disc = {vector(w.centre), 1.0 / std::sqrt(std::min(dot(p, p), dot(q, q)))};
    }
    r.widest = std::max(r.widest, disc.radius);
    if (is_half_at_most(w)) {
      // No point of it is farther from the middle of its chord than the ends; of an ellipse, where
      // that is a circle.
      double half = 0.5 * std::sqrt(dot(vector(w.chord), vector(w.chord)));
      if (w.form == Form::ellipse) {
        const double x = dot(w.along, w.chord).to_double(), y = dot(w.across, w.chord).to_double();
        half = disc.radius * 0.5 * std::sqrt(x * x + y * y);
      }
      disc = {0.5 * vector(w.from) + 0.5 * vector(w.to), half};
    }
    disc.radius *= 1.0 + 0x1p-40;  // rounded some ten times, relative to itself
    r.discs.push_back(disc);
  }
  if (table.lattice) {
    r.first = vector(table.lattice->first);
    r.second = vector(table.lattice->second);
    const double area = cross(r.first, r.second);
    r.to_first = {r.second.y / area, -r.second.x / area};
    r.to_second = {-r.first.y / area, r.first.x / area};
    r.stretch = std::sqrt(std::min(dot(r.first, r.first), dot(r.second, r.second)));
    const auto length = [](geometry::Vector v) { return std::sqrt(dot(v, v)); };
    r.skew = length(r.to_first) * length(r.first) + length(r.to_second) * length(r.second);
    r.size = length(r.first) + length(r.second);
    for (const Whereabouts::Disc& disc : r.discs)
      r.size = std::max(r.size, length(disc.centre) + disc.radius + r.stretch);
  }
  return r;
}

}  // namespace carom::certify
