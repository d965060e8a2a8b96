// Exact ties with walls: along them, touching them, into their joints.
#include "carom/table/table.hpp"
#include "certify/hole_reach.hpp"
#include "certify/larmor_wall.hpp"
#include "certify/tie_follower.hpp"

namespace carom::certify {
namespace {

using Vector = VectorOf<Quadratic>;

// Along the wall, of any length.
Vector tangent_at(const WallOf<Quadratic>& w, const Vector& P) {
  if (w.form == Form::segment) return w.chord;
  const Vector outwards = normal_at<Quadratic, Quadratic>(w, P);
  return w.turn > 0 ? left(outwards) : -left(outwards);
}

// How the flight with that velocity passes a wall at a point of it: negative: it leaves the domain there.
Sign passes(const WallOf<Quadratic>& w, const Vector& P, const Vector& velocity) {
  return sign(cross(tangent_at(w, P), velocity));
}

// The n of an interior angle pi/n between two walls with these tangents; 0 where it is none of 2, 3, 4, 6.
int parts_of_half_turn(const Vector& before, const Vector& after) {
  if (sign(cross(before, after)) != Sign::positive) return 0;
  const Quadratic cosine = -dot(before, after), squares = dot(before, before) * dot(after, after);
  if (is_zero(cosine)) return 2;
  if (sign(cosine) == Sign::negative) return 0;
  const Quadratic four = Quadratic(4) * square(cosine);
  if (is_zero(four - squares)) return 3;
  if (is_zero(four - Quadratic(2) * squares)) return 4;
  return is_zero(four - Quadratic(3) * squares) ? 6 : 0;
}

}  // namespace

std::optional<Tie> TieFollower::with_wall(const Copy& copy) const {
  const Wall& w = wall(copy.wall);
  const Vector P = seen(copy);
  const bool standing = copy.wall == standing_ && copy.cell == geometry::Cell{};
  const std::optional<Tie> touching =
      turns() ? touching_in_field(w, P, copy, standing) : touching_straight(w, P, copy, standing);
  if (touching || w.closed) return touching;
  const std::optional<Passing> passing = joint_ahead(w, P);
  return passing ? at_joint(*passing, copy) : std::nullopt;
}

std::optional<Tie> TieFollower::touching_straight(const Wall& w, const Vector& P, const Copy& copy,
                                                  bool standing) const {
  if (w.form == Form::segment) {
    if (!is_zero(cross(v_, w.chord)) || !is_zero(dot(P - w.from, w.normal))) return std::nullopt;
    const Quadratic from = dot(v_, w.from - P), to = dot(v_, w.to - P);
    const bool from_ahead = sign(from) == Sign::positive, to_ahead = sign(to) == Sign::positive;
    if (!from_ahead && !to_ahead)
      return Tie{Tie::tangency, "exactly in line with " + name(copy.wall) + ", which lies behind", {copy}};
    Tie tie{Tie::along_wall, "exactly along " + name(copy.wall)};
    tie.joint = {copy};
    if (from_ahead && to_ahead) tie.at = WallEnd{copy, sign(to - from) == Sign::negative};
    return tie;
  }
  const Vector d = P - w.centre;
  const bool ellipse = w.form == Form::ellipse;
  const Vector e = ellipse ? Vector{dot(d, w.along), dot(d, w.across)} : d;
  const Vector u = ellipse ? Vector{dot(v_, w.along), dot(v_, w.across)} : v_;
  const Quadratic a = dot(u, u), b = dot(e, u);
  if (standing) {
    if (!is_zero(b)) return std::nullopt;
    return Tie{Tie::along_wall, "exactly tangent to " + name(copy.wall) + ", on which it lies"};
  }
  const Quadratic c = dot(e, e) - (ellipse ? Quadratic(1) : w.radius2);
  if (!is_zero(square(b) - a * c)) return std::nullopt;
  if (is_zero(c)) return Tie{Tie::along_wall, "exactly tangent to " + name(copy.wall)};  // where it is
  return Tie{Tie::tangency, "exactly tangent to " + name(copy.wall) + ", which is no hit", {copy}};
}

// A Larmor circle that touches a line or circle crosses it nowhere: it stays on the domain's side, whichever side of
// the wall its centre is on.
std::optional<Tie> TieFollower::touching_in_field(const Wall& w, const Vector& P, const Copy& copy,
                                                  bool standing) const {
  if (w.form == Form::ellipse) throw NotQuadratic("a Larmor circle against an ellipse");
  const LarmorQuadratic<Quadratic> f =
      larmor_quadratic<Quadratic, Quadratic>(w, P, v_, scene_.motion, standing);
  if (standing) {
    if (!is_zero(f.b)) return std::nullopt;
    return Tie{Tie::along_wall, "exactly tangent to " + name(copy.wall) + ", on which it lies"};
  }
  if (!is_zero(discriminant_of(f))) return std::nullopt;
  if (is_zero(f.a)) {  // then b = 0, too: along the wall's line or circle, in the plane or where it is
    Tie tie{Tie::along_wall, "exactly along " + name(copy.wall)};
    if (w.closed || !is_zero(f.c)) return tie;
    tie.joint = {copy};
    const auto when = [&](const Vector& end) { return passing_of(end, P, v_, scene_.motion); };
    if (is_zero(w.from - P) || is_zero(w.to - P)) return tie;
    tie.at = WallEnd{copy, sign(when(w.to) - when(w.from)) == Sign::negative};
    return tie;
  }
  return Tie{Tie::tangency, "exactly tangent to " + name(copy.wall) + ", which is no hit", {copy}};
}

std::optional<TieFollower::Passing> TieFollower::joint_ahead(const Wall& w, const Vector& P) const {
  std::optional<Passing> along;
  for (const Vector* end : {&w.from, &w.to}) {
    const Vector d = *end - P;
    if (is_zero(d)) continue;
    const Vector u = turns() ? velocity_after(d) : v_;
    const bool met = turns() ? is_zero(dot(u, u) - scene_.motion.speed2)
                             : is_zero(cross(v_, d)) && sign(dot(v_, d)) == Sign::positive;
    if (!met) continue;
    const Sign sense = passes(w, *end, u);
    if (sense == Sign::negative) return Passing{*end, u};
    if (sense == Sign::zero) along = Passing{*end, u};
  }
  return along;
}

// A hole that begins or ends where the wall does.
bool TieFollower::opens_at(int index, bool at_its_end) const {
  bool known = true;
  for (const HoleSpec& hole : system_.spec->holes) {
    if (system_.table->wall_index(hole.wall) != index) continue;
    const HoleReach reach = reach_of(system_, hole);
    if (at_its_end ? reach.opens_at_end() : reach.opens_at_start()) return true;
    known = known && (at_its_end ? reach.past_end : reach.before_start) != Sign::undecided;
  }
  if (!known) throw NotQuadratic("whether a hole ends at the corner");
  return false;
}

std::optional<Tie> TieFollower::at_joint(const Passing& passing, const Copy& met) const {
  const Vector& J = passing.end;
  int ends = -1, begins = -1, meeting = 0;
  std::vector<Copy> walls_there;  // a wall into whose domain the flight comes there may be met before
  for (std::size_t k = 0; k < scene_.walls.size(); ++k) {
    const Wall& w = scene_.walls[k];
    if (w.closed) continue;
    const bool stops = is_zero(w.to - J), starts = is_zero(w.from - J);
    if (!stops && !starts) continue;
    meeting += stops + starts;
    if (stops) ends = static_cast<int>(k);
    if (starts) begins = static_cast<int>(k);
    if (passes(w, J, passing.velocity) != Sign::positive) walls_there.push_back({static_cast<int>(k), met.cell});
  }
  const auto corner = [&](const std::string& text) {
    Tie tie{Tie::corner, text};
    tie.walls = {met};
    tie.joint = walls_there;
    tie.at = WallEnd{met, is_zero(wall(met.wall).to - J)};
    return tie;
  };
  if (ends < 0 || begins < 0 || meeting > 2) return corner("exactly into an end of " + name(met.wall));
  const Form form_before = wall(ends).form, form_after = wall(begins).form;
  // It may be met at another place before: balls would have to look for that.
  if (turns() && (form_before == Form::ellipse || form_after == Form::ellipse))
    throw NotQuadratic("a Larmor circle against an ellipse");
  const Vector before = tangent_at(wall(ends), J), after = tangent_at(wall(begins), J);
  const std::string walls = name(ends) + " and " + name(begins);
  const bool across = sign(cross(before, passing.velocity)) == Sign::negative &&
                      sign(cross(after, passing.velocity)) == Sign::negative;
  const bool smooth = is_zero(cross(before, after)) && sign(dot(before, after)) == Sign::positive;
  const std::string text = std::string("exactly into the ") + (smooth ? "joint" : "corner") + " between " + walls;
  const int n = across && !smooth ? parts_of_half_turn(before, after) : 0;
  if (smooth ? !across : n == 0) return corner(text);
  // Orbits beside one that meets a hole there leave through it.
  if (opens_at(ends, true) || opens_at(begins, false)) return corner(text + ", at a hole");
  // A segment through the joint is not met again by who flies straight; a curve may be met elsewhere.
  const auto beside = [this](int other) {
    return !turns() && wall(other).form == Form::segment ? other : -1;
  };
  const auto reflection = [&](const std::string& why) {
    Tie tie{Tie::reflection, text + why};
    tie.joint = {{ends, met.cell}, {begins, met.cell}};
    tie.at = WallEnd{tie.joint.front(), true};
    return tie;
  };
  if (smooth) {
    // It leaves the joint from a curve, where there is one: from there a segment beside it is not met.
    const bool from_end = form_after == Form::segment && form_before != Form::segment;
    Tie tie = reflection(", where they have one tangent");
    tie.walls = {{from_end ? ends : begins, met.cell}};
    tie.beside = beside(from_end ? begins : ends);
    return tie;
  }
  // In either order n reflections come to the same.
  Tie tie = reflection(", whose angle is pi/" + std::to_string(n));
  for (int i = 0; i < n; ++i)
    tie.walls.push_back({i % 2 == 0 ? ends : begins, i == 0 ? met.cell : geometry::Cell{}});
  tie.beside = beside(n % 2 == 0 ? ends : begins);
  return tie;
}

}  // namespace carom::certify
