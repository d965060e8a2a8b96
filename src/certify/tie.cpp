#include "certify/tie.hpp"

#include "carom/table/table.hpp"
#include "certify/flight/flight.hpp"
#include "certify/wall/hole.hpp"
#include "certify/wall/start.hpp"

namespace carom::certify {
namespace {

using Vector = VectorOf<Rational>;

void check_length(const Rational& x) {
  constexpr std::size_t most_bits = 1u << 16;
  const auto bits = [](const mpz_class& n) { return mpz_sizeinbase(n.get_mpz_t(), 2); };
  if (x.value() == nullptr || bits(x.value()->get_num()) + bits(x.value()->get_den()) > most_bits)
    throw NotRational();
}

// Along the wall, of any length.
Vector tangent_at(const WallOf<Rational>& w, const Vector& P) {
  if (w.form == Form::segment) return w.chord;
  const Vector outwards = normal_at<Rational, Rational>(w, P);
  return w.turn > 0 ? left(outwards) : -left(outwards);
}

// How a flight with that velocity passes a wall at a point of it: negative: it leaves the domain
// there.
Sign passes(const WallOf<Rational>& w, const Vector& P, const Vector& velocity) {
  return sign(cross(tangent_at(w, P), velocity));
}

// The n of an interior angle pi/n between two walls with these tangents, or 0. Between rational
// tangents n is 2 or 4.
int parts_of_half_turn(const Vector& before, const Vector& after) {
  if (sign(cross(before, after)) != Sign::positive) return 0;
  const Rational cosine = -dot(before, after);
  if (is_zero(cosine)) return 2;
  const bool quarter = sign(cosine) == Sign::positive && is_zero(cosine - cross(before, after));
  return quarter ? 4 : 0;
}

Tie at_hole(Tie::Kind kind, std::string text, int hole) {
  Tie tie{kind, std::move(text)};
  tie.hole = hole;
  return tie;
}

}  // namespace

std::optional<Tie> TieFinder::find(const std::vector<Copy>& path, const Doubt& doubt) {
  if (hopeless_) return std::nullopt;
  try {
    prepare();
    for (; followed_ < path.size(); ++followed_) fly_to(now_, path[followed_]);
  } catch (const NotRational&) {
    hopeless_ = true;
    return std::nullopt;
  }
  try {
    std::optional<Tie> found = tie(doubt);
    if (found) found->text = "event " + std::to_string(path.size() + 1) + ": " + found->text;
    return found;
  } catch (const NotRational&) {
    return std::nullopt;
  }
}

void TieFinder::prepare() {
  if (prepared_) return;
  if (!is_zero(Rational(system_.omega))) throw NotRational();
  table_ = rational_table(*system_.spec);
  const ExactStart& start = system_.start;
  now_.standing = start.wall;
  now_.position = start.wall >= 0 ? point_with_parameter(wall(start.wall), start.u)
                                  : Vector{Rational(start.position.x), Rational(start.position.y)};
  now_.velocity = start.angle ? rational_direction(*start.angle)
                              : Vector{Rational(start.direction.x), Rational(start.direction.y)};
  // The speed is that of the direction: only the time is another one.
  motion_.speed2 = dot(now_.velocity, now_.velocity);
  motion_.inverse_speed2 = Rational(1) / motion_.speed2;
  prepared_ = true;
}

void TieFinder::fly_to(Flight& flight, const Copy& copy) const {
  const bool same = copy.wall == flight.standing && copy.cell == geometry::Cell{};
  const LandingOf<Rational> landing = fly<Rational, Rational>(
      wall(copy.wall), seen(flight.position, copy), flight.velocity, motion_, same);
  flight = {landing.position, landing.velocity, flight.time + landing.time, copy.wall};
  for (const Rational* x : {&flight.position.x, &flight.position.y, &flight.velocity.x,
                            &flight.velocity.y, &flight.time})
    check_length(*x);
}

std::optional<Tie> TieFinder::tie(const Doubt& doubt) const {
  if (doubt.kind == Doubt::choice) {
    const std::optional<Tie> first = with_wall(doubt.first);
    return first || doubt.second.wall < 0 ? first : with_wall(doubt.second);
  }
  Flight there = now_;
  fly_to(there, doubt.first);
  return doubt.kind == Doubt::hole ? with_hole(there, doubt.hole_index) : with_last_time(there);
}

std::optional<Tie> TieFinder::with_wall(const Copy& copy) const {
  const Wall& w = wall(copy.wall);
  const Vector P = seen(now_.position, copy), &v = now_.velocity;
  const bool standing = copy.wall == now_.standing && copy.cell == geometry::Cell{};
  if (const std::optional<Tie> tie = touching(w, P, copy, standing); tie || w.closed) return tie;
  const Vector* along = nullptr;
  for (const Vector* end : {&w.from, &w.to}) {
    const Vector d = *end - P;
    if (!is_zero(cross(v, d)) || sign(dot(v, d)) != Sign::positive) continue;
    const Sign sense = passes(w, *end, v);
    if (sense == Sign::negative) return at_joint(*end, copy);
    if (sense == Sign::zero) along = end;
  }
  return along != nullptr ? at_joint(*along, copy) : std::nullopt;
}

std::optional<Tie> TieFinder::touching(const Wall& w, const Vector& P, const Copy& copy,
                                       bool standing) const {
  const Vector& v = now_.velocity;
  if (w.form == Form::segment) {
    if (!is_zero(cross(v, w.chord)) || !is_zero(dot(P - w.from, w.normal))) return std::nullopt;
    const Rational from = dot(v, w.from - P), to = dot(v, w.to - P);
    const bool from_ahead = sign(from) == Sign::positive, to_ahead = sign(to) == Sign::positive;
    if (!from_ahead && !to_ahead)
      return Tie{
          Tie::tangency, "exactly in line with " + name(copy.wall) + ", which lies behind", {copy}};
    Tie tie{Tie::along_wall, "exactly along " + name(copy.wall)};
    tie.joint = {copy};
    if (from_ahead && to_ahead) tie.at = WallEnd{copy, sign(to - from) == Sign::negative};
    return tie;
  }
  const Vector u = in_round_frame(w, v);
  const Rational a = dot(u, u), b = dot(in_round_frame(w, P - w.centre), u);
  if (standing) {
    if (!is_zero(b)) return std::nullopt;
    return Tie{Tie::along_wall, "exactly tangent to " + name(copy.wall) + ", on which it lies"};
  }
  const Rational c = level_at(w, P);
  if (!is_zero(square(b) - a * c)) return std::nullopt;
  if (is_zero(c))
    return Tie{Tie::along_wall, "exactly tangent to " + name(copy.wall)};  // where it is
  return Tie{Tie::tangency, "exactly tangent to " + name(copy.wall) + ", which is no hit", {copy}};
}

// Does a hole begin or end where the wall does?
bool TieFinder::opens_at(int index, bool at_its_end) const {
  bool known = true;
  for (const HoleSpec& hole : system_.spec->holes) {
    if (system_.table->wall_index(hole.wall) != index) continue;
    const Sign s = at_its_end ? past_end(system_, hole) : before_start(hole);
    if (s == Sign::zero || s == (at_its_end ? Sign::positive : Sign::negative)) return true;
    known = known && s != Sign::undecided;
  }
  if (!known) throw NotRational();
  return false;
}

std::optional<Tie> TieFinder::at_joint(const Vector& J, const Copy& met) const {
  const Vector& v = now_.velocity;
  int ends = -1, begins = -1, meeting = 0;
  std::vector<Copy>
      walls_there;  // a wall into whose domain the flight comes there may be met before
  for (std::size_t k = 0; k < table_.walls.size(); ++k) {
    const Wall& w = table_.walls[k];
    if (w.closed) continue;
    const bool stops = is_zero(w.to - J), starts = is_zero(w.from - J);
    if (!stops && !starts) continue;
    meeting += stops + starts;
    if (stops) ends = static_cast<int>(k);
    if (starts) begins = static_cast<int>(k);
    if (passes(w, J, v) != Sign::positive) walls_there.push_back({static_cast<int>(k), met.cell});
  }
  const auto corner = [&](const std::string& text) {
    Tie tie{Tie::corner, text};
    tie.walls = {met};
    tie.joint = walls_there;
    tie.at = WallEnd{met, is_zero(wall(met.wall).to - J)};
    return tie;
  };
  if (ends < 0 || begins < 0 || meeting > 2)
    return corner("exactly into an end of " + name(met.wall));
  const Form form_before = wall(ends).form, form_after = wall(begins).form;
  const Vector before = tangent_at(wall(ends), J), after = tangent_at(wall(begins), J);
  const bool across =
      sign(cross(before, v)) == Sign::negative && sign(cross(after, v)) == Sign::negative;
  const bool smooth = is_zero(cross(before, after)) && sign(dot(before, after)) == Sign::positive;
  const std::string text = std::string("exactly into the ") + (smooth ? "joint" : "corner") +
                           " between " + name(ends) + " and " + name(begins);
  const int n = across && !smooth ? parts_of_half_turn(before, after) : 0;
  if (smooth ? !across : n == 0) return corner(text);
  // Orbits beside one that meets a hole there leave through it.
  if (opens_at(ends, true) || opens_at(begins, false)) return corner(text + ", at a hole");
  // A straight flight does not meet a segment through the joint again; it may meet a curve
  // elsewhere.
  const auto beside = [this](int other) { return wall(other).form == Form::segment ? other : -1; };
  Tie tie{Tie::reflection, text};
  tie.joint = {{ends, met.cell}, {begins, met.cell}};
  tie.at = WallEnd{tie.joint.front(), true};
  if (smooth) {
    // It leaves the joint from a curve, where there is one: from there a segment beside it is not
    // met.
    const bool from_end = form_after == Form::segment && form_before != Form::segment;
    tie.text += ", where they have one tangent";
    tie.walls = {{from_end ? ends : begins, met.cell}};
    tie.beside = beside(from_end ? begins : ends);
    return tie;
  }
  // In either order n reflections come to the same.
  tie.text += ", whose angle is pi/" + std::to_string(n);
  for (int i = 0; i < n; ++i)
    tie.walls.push_back({i % 2 == 0 ? ends : begins, i == 0 ? met.cell : geometry::Cell{}});
  tie.beside = beside(n % 2 == 0 ? ends : begins);
  return tie;
}

// Is the particle exactly where the hole of its wall starts (side -1) or ends (+1)?
bool TieFinder::is_at(const Flight& there, const HoleSpec& spec, int side) const {
  const Wall& w = wall(there.standing);
  const Rational s = Rational(spec.center) + Rational(side) * Rational(spec.width) / Rational(2);
  // Arc lengths squared: so the length of the wall costs no root.
  if (w.form == Form::segment)
    return is_zero(square(dot(there.position - w.from, w.chord)) -
                   square(s) * dot(w.chord, w.chord));
  if (is_zero(s)) return is_zero(there.position - w.from);
  // The cosine of an algebraic angle s/r that is not zero is transcendental (Lindemann): no
  // rational point lies there.
  if (w.form == Form::circle) return false;
  throw NotRational();
}

std::optional<Tie> TieFinder::with_hole(const Flight& there, int index) const {
  const std::vector<HoleSpec>& specs = system_.spec->holes;
  const std::string& called = system_.table->holes[static_cast<std::size_t>(index)].name;
  const std::string hole = " '" + called + "' in " + name(there.standing);
  for (std::size_t k = 0; k < specs.size(); ++k) {
    if (name_of_hole(specs, k) != called) continue;
    if (is_at(there, specs[k], -1))
      return at_hole(Tie::hole_start,
                     "exactly at the start of hole" + hole + ", which belongs to it", index);
    if (!is_at(there, specs[k], +1)) continue;
    for (std::size_t next = 0; next < specs.size(); ++next)
      if (next != k && specs[next].wall == specs[k].wall && is_at(there, specs[next], -1))
        return at_hole(Tie::hole_start,
                       "exactly at the end of hole" + hole + ", where the next one starts",
                       system_.table->hole_index(name_of_hole(specs, next)));
    return at_hole(Tie::hole_end,
                   "exactly at the end of hole" + hole + ", which does not belong to it", index);
  }
  return std::nullopt;
}

// |v| t = speed t_max, squared.
std::optional<Tie> TieFinder::with_last_time(const Flight& there) const {
  const Rational last = Rational(system_.speed) * Rational(*task_.t_max);
  if (!is_zero(square(there.time) * motion_.speed2 - square(last))) return std::nullopt;
  return Tie{Tie::last_time,
             name(there.standing) + " is met exactly at the last time: the hit counts"};
}

}  // namespace carom::certify
