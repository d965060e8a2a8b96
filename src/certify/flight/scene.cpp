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

geometry::Vector middle_of(const BallVector& v) { return {v.x.to_double(), v.y.to_double()}; }
Ball length(const BallVector& v) { return sqrt(square(v.x) + square(v.y)); }

/// Is it known to u/8 of itself, u = 2^-53?
constexpr double narrow = 0x1p-56;
bool is_narrow(const Ball& x) { return !(Bound(narrow) * size_of(x) < x.radius()); }
bool is_narrow(const BallVector& v) {
  return !(Bound(narrow) * size_of(length(v)) < v.x.radius() + v.y.radius());
}

}  // namespace

Whereabouts whereabouts_of(const BallTable& table, const Ball& omega) {
  Whereabouts r;
  bool known = is_narrow(omega);
  if (table.lattice) {
    known = known && is_narrow(table.lattice->first) && is_narrow(table.lattice->second);
    r.first = middle_of(table.lattice->first);
    r.second = middle_of(table.lattice->second);
    const double area = cross(r.first, r.second);
    r.to_first = {r.second.y / area, -r.second.x / area};
    r.to_second = {-r.first.y / area, r.first.x / area};
    r.stretch = std::sqrt(std::min(dot(r.first, r.first), dot(r.second, r.second)));
  }
  // Around a point of doubles, as far as the balls reach from there.
  const auto disc_around = [&](const BallVector& centre, const Ball& radius) {
    const geometry::Vector c = middle_of(centre);
    const Interval reach = interval_of(length(centre - BallVector{Ball(c.x), Ball(c.y)}) + radius);
    known = known && reach.high - reach.low <= 0x1p-20 * r.stretch;
    return Whereabouts::Disc{c, reach.high};
  };
  for (const WallOf<Ball>& w : table.walls) {
    const Ball half(0.5), half_chord = half * length(w.chord);
    const BallVector middle{half * (w.from.x + w.to.x), half * (w.from.y + w.to.y)};
    Whereabouts::Disc disc;
    if (w.form == Form::segment) {
      disc = disc_around(middle, half_chord);
    } else if (w.form == Form::circle) {
      disc = disc_around(w.centre, sqrt(w.radius2));
    } else {
      // Rows of the map to the unit circle are axes over their squares.
      const Whereabouts::Disc a = disc_around(w.centre, Ball(1) / length(w.along)),
                              b = disc_around(w.centre, Ball(1) / length(w.across));
      disc = a.radius < b.radius ? b : a;
    }
    r.widest = std::max(r.widest, disc.radius);
    if (is_half_at_most(w)) {
      // No point of it is farther from the middle of its chord than the ends; of an ellipse, where
      // that is a circle.
      const BallVector round{dot(w.along, w.chord), dot(w.across, w.chord)};
      disc = disc_around(
          middle, w.form == Form::ellipse ? Ball(disc.radius) * half * length(round) : half_chord);
    }
    r.discs.push_back(disc);
  }
  if (table.lattice) {
    const auto norm = [](geometry::Vector v) { return std::sqrt(dot(v, v)); };
    r.skew = norm(r.to_first) * norm(r.first) + norm(r.to_second) * norm(r.second);
    r.size = norm(r.first) + norm(r.second);
    for (const Whereabouts::Disc& disc : r.discs)
      r.size = std::max(r.size, norm(disc.centre) + disc.radius + r.stretch);
    if (!known) r.rounding = HUGE_VAL;
  }
  return r;
}

}  // namespace carom::certify
