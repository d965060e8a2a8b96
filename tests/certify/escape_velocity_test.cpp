// The velocity that an orbit leaves with: the one it came with, to all digits that were asked for.
#include <gtest/gtest.h>

#include "certify/number/exact_value.hpp"
#include "certify/systems.hpp"
#include "certify/wall/ball_table.hpp"
#include "random_tables.hpp"

namespace carom {
namespace {

using certify::Ball;
using certify::ball_of;
using certify::Precision;
using certify::value_of;
using tests::exactly;
using tests::Shaped;

constexpr int digits = 25;

CertifiedEnd end_of(const ExactSystem& system, std::uint64_t collisions, int decimals) {
  CertifiedTask task = tests::task_of(collisions, decimals);
  task.t_max = exactly("1000");
  CertifiedOrbit orbit(system, task);
  return orbit.finish();
}

// Is what is printed of a number within 10^-digits of all that another one may be?
bool prints(const CertifiedNumber& few, const Ball& many) {
  const Ball error = value_of(exactly("1/10^" + std::to_string(digits)));
  const Ball off = value_of(exactly(few.text(digits))) - many;
  return sign(error - off) == Sign::positive && sign(error + off) == Sign::positive;
}

// A random orbit of 16 tables, every other one in a field, with a hole in the first wall; and the
// same without.
struct Flight {
  ExactSystem open, closed;
};
Flight flight(long k, tests::Dice& dice) {
  const std::vector<Shaped> shapes = tests::all_shapes();
  Shaped s = shapes[static_cast<std::size_t>(k) % shapes.size()];
  const geometry::Vector d = dice.direction();
  Flight f;
  f.closed = tests::system_of(s, {d.x, d.y});
  HoleSpec hole;
  const Wall& wall = f.closed.table->walls.front();
  hole.wall = wall.name;
  const double length = geometry::length(wall.curve);
  hole.center = 0.37 * length;
  hole.width = 0.1 * length;
  s.spec.holes = {hole};
  f.open = tests::system_of(s, {d.x, d.y});
  const char* const fields[] = {"0", "3/4", "0", "-sqrt(2)"};
  f.open.omega = f.closed.omega = exactly(fields[k / 16 % 4]);
  return f;
}

TEST(EscapeVelocity, HasTheDigitsThatWereAskedFor) {
  tests::Dice dice(41);
  const Precision precision(400);
  long escaped = 0;
  for (long k = 0; k < tests::cases(200, 3000); ++k) {
    const Flight f = flight(k, dice);
    SCOPED_TRACE(f.open.spec->shape + ", orbit " + std::to_string(k));
    const CertifiedEnd few = end_of(f.open, 60, digits), many = end_of(f.open, 60, 2 * digits);
    ASSERT_EQ(few.fate, many.fate);
    if (few.fate != CertifiedFate::escaped) continue;
    ++escaped;
    ASSERT_TRUE(prints(few.vx, ball_of(many.vx)));
    ASSERT_TRUE(prints(few.vy, ball_of(many.vy)));
    ASSERT_TRUE(prints(few.x, ball_of(many.x)));
    ASSERT_TRUE(prints(few.y, ball_of(many.y)));
    ASSERT_TRUE(prints(few.t, ball_of(many.t)));
  }
  EXPECT_GT(escaped, 50);
}

// Without the hole the orbit is reflected where it left: the sum of both velocities runs along the
// wall.
TEST(EscapeVelocity, IsTheOneBeforeTheReflection) {
  tests::Dice dice(42);
  const Precision precision(400);
  long escaped = 0;
  for (long k = 0; k < tests::cases(200, 3000); ++k) {
    const Flight f = flight(k, dice);
    SCOPED_TRACE(f.open.spec->shape + ", orbit " + std::to_string(k));
    const CertifiedEnd out = end_of(f.open, 60, 2 * digits);
    if (out.fate != CertifiedFate::escaped) continue;
    ++escaped;
    const CertifiedEnd back = end_of(f.closed, out.collisions + 1, 2 * digits);
    ASSERT_EQ(back.collisions, out.collisions + 1);
    ASSERT_TRUE(ball_of(out.x).overlaps(ball_of(back.x)));
    ASSERT_TRUE(ball_of(out.t).overlaps(ball_of(back.t)));
    // The velocity changes along the normal only.
    const Ball ux = ball_of(out.vx), uy = ball_of(out.vy), wx = ball_of(back.vx),
               wy = ball_of(back.vy);
    const certify::WallOf<Ball> w = certify::ball_table(*f.open.spec).walls.front();
    certify::BallVector P{ball_of(out.x), ball_of(out.y)};
    if (f.open.table->lattice) {  // seen from the wall's own cell
      const certify::BallTable table = certify::ball_table(*f.open.spec);
      const Ball m(static_cast<double>(out.cell.first)), n(static_cast<double>(out.cell.second));
      P = {P.x - (m * table.lattice->first.x + n * table.lattice->second.x),
           P.y - (m * table.lattice->first.y + n * table.lattice->second.y)};
    }
    const certify::BallVector normal =
        w.form == certify::Form::segment ? w.normal : certify::normal_at<Ball, Ball>(w, P);
    ASSERT_TRUE(((wx - ux) * normal.y - (wy - uy) * normal.x).contains(Ball(0)));
    ASSERT_TRUE((ux * ux + uy * uy).contains(Ball(1)));
    // It leaves: out of the domain, which lies on the left.
    const Ball inwards = ux * normal.x + uy * normal.y;
    ASSERT_EQ(sign(w.form == certify::Form::segment || w.turn < 0 ? inwards : -inwards),
              Sign::negative);
  }
  EXPECT_GT(escaped, 50);
}

}  // namespace
}  // namespace carom
