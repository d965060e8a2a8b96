#include "certify/wall/system_check.hpp"

#include <variant>

#include "certify/number/exact_value.hpp"
#include "certify/wall/containment.hpp"
#include "certify/wall/rational_table.hpp"
#include "certify/wall/start.hpp"
#include "table/numbers.hpp"

namespace carom::certify {
namespace {

constexpr const char* off_the_walls =
    "a point inside, off the walls; kind = \"birkhoff\" starts on a wall";

std::string called(const ExactSystem& system, int wall) {
  return "'" + system.table->walls[static_cast<std::size_t>(wall)].name + "'";
}

// Whether a mushroom has a brim, and which way an arc turns, is read off the numbers as written and
// off the doubles: that may differ.
void check_walls(const ExactSystem& system) {
  const Precision precision(bits_of_a_first_look);
  const TableSpec& spec = *system.spec;
  const std::vector<Wall>& rounded = system.table->walls;
  const auto other_walls = [&] {
    return InputError(
        spec.shape_place,
        "the table as it was written has other walls than the same in double precision",
        "numbers that differ by more than the rounding of doubles");
  };
  if (spec.shape == "mushroom") {
    const ExactNumber& stem = spec.numbers.at("stem_width");
    const Sign brim =
        sign_of(table::shapes::derived("2*" + table::shapes::quoted(spec.numbers.at("cap_radius")) +
                                           "-" + table::shapes::quoted(stem),
                                       stem));
    if (brim == Sign::negative)
      throw InputError(stem.place(), "the stem is wider than the cap",
                       "stem_width <= 2 cap_radius");
    if (brim == Sign::undecided)
      throw InputError(stem.place(), "whether the stem is as wide as the cap cannot be decided",
                       "numbers that differ by more");
    if ((brim == Sign::positive) != (system.table->wall_index("brim_left") >= 0))
      throw other_walls();
  }
  for (const HoleSpec& hole : spec.holes)
    if (system.table->wall_index(hole.wall) < 0)
      throw InputError(
          hole.wall_place,
          "certified orbits leave through holes of one wall, and '" + hole.wall + "' are several",
          "one of these walls");
  const BallTable table = ball_table(spec);
  for (std::size_t k = 0; k < rounded.size(); ++k) {
    const bool counterclockwise = table.walls[k].turn > 0;
    if (const auto* arc = std::get_if<geometry::CircularArc>(&rounded[k].curve);
        arc && arc->counterclockwise != counterclockwise)
      throw other_walls();
    if (const auto* arc = std::get_if<geometry::EllipticArc>(&rounded[k].curve);
        arc && arc->counterclockwise != counterclockwise)
      throw other_walls();
  }
}

void check_on_wall(const ExactSystem& system) {
  const ExactStart& start = system.start;
  const auto index = static_cast<std::size_t>(start.wall);
  if (index >= system.table->walls.size())
    throw InputError(Place{}, "the start lies on a wall that the table does not have");
  const geometry::Curve& curve = system.table->walls[index].curve;
  const bool closed = geometry::is_closed(curve);
  if (!((closed ? start.u >= 0.0 : start.u > 0.0) && start.u < geometry::end_parameter(curve)))
    throw InputError(Place{}, "the start does not lie on its wall " + called(system, start.wall),
                     "a parameter between those of its ends");
  for (const slong bits : {bits_of_a_first_look, most_bits_of_a_sign}) {
    const Precision precision(bits);
    const WallOf<Ball> w = ball_table(*system.spec).walls[index];
    const BallVector P = point_with_parameter(w, start.u);
    BallVector v{value_of(start.direction.x), value_of(start.direction.y)};
    if (start.angle) {
      const CosSin d = direction_of(*start.angle);
      v = {d.cos, d.sin};
    }
    const BallVector across = w.form == Form::segment ? w.normal : normal_at<Ball, Ball>(w, P);
    const bool outwards = w.form != Form::segment && w.turn > 0;
    const Sign inwards = sign(outwards ? -dot(v, across) : dot(v, across));
    if (inwards == Sign::negative)
      throw InputError(Place{}, "the velocity does not point into the domain");
    if (inwards != Sign::undecided) return;
  }
}

bool lies_on(const WallOf<Rational>& w, const VectorOf<Rational>& P) {
  const auto none_negative = [](const Rational& a, const Rational& b) {
    return sign(a) != Sign::negative && sign(b) != Sign::negative;
  };
  if (!is_zero(level_at(w, P))) return false;
  if (w.form == Form::segment)
    return none_negative(dot(P - w.from, w.chord), dot(w.to - P, w.chord));
  return is_zero(P - w.to) || on_arc(w, P) == Verdict::yes;
}

// The walls that a point lies on exactly, among those of the loops in doubt, in words. Throws
// NotRational.
std::string walls_at(const ExactSystem& system, const std::vector<LoopCopy>& in_doubt) {
  const TableOf<Rational> table = rational_table(*system.spec);
  const VectorOf<Rational> P{Rational(system.start.position.x), Rational(system.start.position.y)};
  std::string text;
  for (const LoopCopy& copy : in_doubt) {
    const VectorOf<Rational> seen =
        copy.cell == geometry::Cell{} ? P : P - table.lattice->at(copy.cell);
    for (const int k : copy.loop->walls)
      if (lies_on(table.walls[static_cast<std::size_t>(k)], seen))
        text += (text.empty() ? "" : " and ") + called(system, k);
  }
  return text;
}

void check_inside(const ExactSystem& system) {
  const ExactPoint& at = system.start.position;
  const auto refuse = [&](const std::string& why, const char* expected) {
    throw InputError(at.x.place(), "the start (" + at.x.text() + ", " + at.y.text() + ") " + why,
                     expected);
  };
  const std::vector<WallLoop> loops = loops_of(*system.table);
  for (const slong bits : {bits_of_a_first_look, slong{1024}, most_bits_of_a_sign}) {
    const Precision precision(bits);
    const BallTable table = ball_table(*system.spec);
    const Containment place(loops, table, {value_of(at.x), value_of(at.y)});
    if (place.too_far() || place.verdict() == Verdict::yes) return;
    if (place.verdict() == Verdict::no) refuse("is not inside the table", off_the_walls);
    if (bits != bits_of_a_first_look) continue;
    try {
      const std::string walls = walls_at(system, place.in_doubt());
      if (!walls.empty()) refuse("is not inside the table: it lies on " + walls, off_the_walls);
    } catch (const NotRational&) {  // more bits may tell
    }
  }
  refuse("is not distinguished from a point on a wall by " + std::to_string(most_bits_of_a_sign) +
             " bits",
         "a point farther from the walls");
}

}  // namespace

void check_velocity(const ExactStart& start) {
  if (start.angle) return;
  const Sign x = sign_of(start.direction.x), y = sign_of(start.direction.y);
  const auto moves = [](Sign s) { return s == Sign::positive || s == Sign::negative; };
  if (moves(x) || moves(y)) return;
  if (x == Sign::zero && y == Sign::zero)
    throw InputError(start.direction.x.place(), "the velocity is zero",
                     "a velocity that is not zero");
  throw InputError(start.direction.x.place(), "the velocity cannot be distinguished from zero",
                   "another velocity");
}

void check_system(const ExactSystem& system) {
  check_walls(system);
  check_velocity(system.start);
  if (system.start.wall >= 0)
    check_on_wall(system);
  else
    check_inside(system);
}

}  // namespace carom::certify
