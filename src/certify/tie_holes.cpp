// Exact ties with the ends of holes.
#include "carom/table/table.hpp"
#include "certify/tie_follower.hpp"
#include "certify/with_pi.hpp"

namespace carom::certify {
namespace {

Tie at_hole(Tie::Kind kind, std::string text, int hole) {
  Tie tie{kind, std::move(text)};
  tie.hole = hole;
  return tie;
}

/// The arc length of an end of a hole.
WithPi end_of(const HoleSpec& spec, int side) {
  return WithPi(spec.center) + WithPi(Quadratic(side)) * WithPi(spec.width) / WithPi(Quadratic(2));
}

}  // namespace

// The point of the wall it stands on where the hole starts (side -1) or ends (+1); nothing where that point has no algebraic
// coordinates, so that no tie is there.
std::optional<TieFollower::Vector> TieFollower::end_of_hole(const HoleSpec& spec, int side) const {
  const Wall& w = wall(standing_);
  const WithPi s = end_of(spec, side);
  if (is_zero(s)) return w.from;
  if (w.form == Form::ellipse) throw NotQuadratic("an arc length of an ellipse");
  // The angle a + b pi with algebraic a, b has an algebraic sine only if a is zero (Lindemann; Baker).
  if (!is_zero(s.plain)) return std::nullopt;
  const Quadratic share = Quadratic(12) * s.pi / sqrt(w.radius2);  // s/r in units of pi/12, if that is a whole number
  for (int k = -24; k <= 24; ++k) {
    if (!is_zero(share - Quadratic(k))) continue;
    const Vector turn = twenty_fourth(w.turn > 0 ? k : -k), start = w.from - w.centre;
    return w.centre + turn.x * start + turn.y * left(start);
  }
  throw NotQuadratic("an end of a hole at an angle that is no multiple of pi/12");
}

bool TieFollower::is_at(const HoleSpec& spec, int side) const {
  const Wall& w = wall(standing_);
  if (w.form != Form::segment) {
    const std::optional<Vector> end = end_of_hole(spec, side);
    return end && is_zero(*end - P_);
  }
  // The arc length squared against that of the end: so it costs no root.
  const Quadratic s = Quadratic(spec.center) + Quadratic(side) * Quadratic(spec.width) / Quadratic(2);
  return is_zero(square(dot(P_ - w.from, w.chord)) - square(s) * dot(w.chord, w.chord));
}

std::optional<Tie> TieFollower::with_hole(int index) const {
  const std::vector<HoleSpec>& specs = system_.spec->holes;
  const std::string& called = system_.table->holes[static_cast<std::size_t>(index)].name;
  const std::string hole = " '" + called + "' in " + name(standing_);
  for (std::size_t k = 0; k < specs.size(); ++k) {
    if (name_of_hole(specs, k) != called) continue;
    if (is_at(specs[k], -1))
      return at_hole(Tie::hole_start, "exactly at the start of hole" + hole + ", which belongs to it", index);
    if (!is_at(specs[k], +1)) continue;
    for (std::size_t next = 0; next < specs.size(); ++next)
      if (next != k && specs[next].wall == specs[k].wall && is_at(specs[next], -1))
        return at_hole(Tie::hole_start, "exactly at the end of hole" + hole + ", where the next one starts",
                       system_.table->hole_index(name_of_hole(specs, next)));
    return at_hole(Tie::hole_end, "exactly at the end of hole" + hole + ", which does not belong to it", index);
  }
  return std::nullopt;
}

}  // namespace carom::certify
