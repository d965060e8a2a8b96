// Certified orbits among curves: against walls of the same shape, more digits, doubles, and their
// way back.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "carom/base/error.hpp"
#include "carom/certify/certified_orbit.hpp"
#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"
#include "soak.hpp"

namespace carom {
namespace {

ExactSystem system_of(const std::string& table, const std::string& more = "") {
  return read_system("[table]\n" + table +
                         "\n[particles]\nspeed = 2\n[initial]\nkind = \"point\"\nposition = [0.3, "
                         "\"1/7\"]\nangle = \"pi/5\"\n" +
                         more,
                     "test")
      .exact;
}
CertifiedTask task_of(std::uint64_t collisions, int digits) {
  CertifiedTask task;
  task.collisions = collisions;
  task.digits = digits;
  return task;
}
void expect_same(const CertifiedState& a, const CertifiedState& b, int digits) {
  // The last digits are rounded from numbers that may differ by the error.
  for (const auto member : {&CertifiedState::t, &CertifiedState::x, &CertifiedState::y,
                            &CertifiedState::vx, &CertifiedState::vy})
    EXPECT_EQ((a.*member).text(digits), (b.*member).text(digits));
}

const char* const four_pieces =
    "shape = \"path\"\nloop = [{start = [1, 0], pieces = [{bezier = [[1, 0.5], [0.5, 1], [0, 1]]}, "
    "{bezier = [[-0.5, 1], [-1, 0.5], [-1, 0]]}, {bezier = [[-1, -0.5], [-0.5, -1], [0, -1]]}, "
    "{bezier = [[0.5, -1], [1, -0.5], [1, 0]]}]}]";

void start_from(ExactSystem& system, const char* x, const char* y, const char* vx, const char* vy) {
  system.start.position = {ExactNumber(x), ExactNumber(y)};
  system.start.angle.reset();
  system.start.direction = {ExactNumber(vx), ExactNumber(vy)};
}

TEST(CurveOrbit, ConicsWrittenAsCurvesHaveTheirDigits) {
  const std::pair<const char*, const char*> same[] = {
      {"shape = \"circle\"\nradius = \"1/3 + 1/2\"", "shape = \"polar\"\nradius = \"1/3 + 1/2\""},
      {"shape = \"ellipse\"\na = 2\nb = 0.7",
       "shape = \"parametric\"\nx = \"2*cos(t)\"\ny = \"0.7*sin(t)\""},
      {"shape = \"ellipse\"\na = 2\nb = 0.7",
       "shape = \"parametric\"\nx = \"2*sin(t)\"\ny = \"0.7*cos(t)\""},
      {"shape = \"ellipse\"\na = 2\nb = 0.7",
       "shape = \"polar\"\nradius = \"1.4/sqrt((0.7*cos(phi))^2 + (2*sin(phi))^2)\""},
      {"shape = \"circle\"\nradius = \"5/6\"",
       "shape = \"implicit\"\nequation = \"x^2 + y^2 - 25/36\"\ninside = [0.1, 0.2]"},
      {"shape = \"ellipse\"\na = 2\nb = 0.7",
       "shape = \"implicit\"\nequation = \"1 - x^2/4 - (y/0.7)^2\"\ninside = [0, 0]"},
      // A straight side, and one that is a Bézier curve.
      {"shape = \"path\"\nloop = [{start = [-1, -1], pieces = [{line_to = [1, -1]}, {arc_via = [2, "
       "0], arc_to = [1, 1]}, {line_to = [-1, 1]}, {ellipse_via = [-1.5, 0], ellipse_to = [-1, -1],"
       " ellipse_ratio = 2}]}]",
       "shape = \"path\"\nloop = [{start = [-1, -1], pieces = [{bezier = [[-0.5, -1], [0, -1], [1, "
       "-1]]}, {arc_via = [2, 0], arc_to = [1, 1]}, {bezier = [[0.5, 1], [-0.1, 1], [-0.3, 1], "
       "[-1, "
       "1]]}, {ellipse_via = [-1.5, 0], ellipse_to = [-1, -1], ellipse_ratio = 2}]}]"},
      // The spline through these points has rational control points.
      {four_pieces, "shape = \"spline\"\npoints = [[1, 0], [0, 1], [-1, 0], [0, -1]]"},
      {four_pieces, "shape = \"spline\"\npoints = [[1, 0], [0, -1], [-1, 0], [0, 1]]"},
      // Obstacles.
      {"shape = \"rectangle\"\nwidth = 1\nheight = 1\n[[table.obstacle]]\nshape = "
       "\"circle\"\ncenter = [0.6, \"2/3\"]\nradius = 0.25\n[[table.obstacle]]\nshape = "
       "\"ellipse\"\ncenter = [0.7, 0.2]\na = 0.2\nb = 0.1",
       "shape = \"rectangle\"\nwidth = 1\nheight = 1\n[[table.obstacle]]\nshape = "
       "\"polar\"\ncenter = [0.6, \"2/3\"]\nradius = \"1/4\"\n[[table.obstacle]]\nshape = "
       "\"parametric\"\nx = \"0.7 + 0.2*sin(t)\"\ny = \"0.1*cos(t) + 1/5\""},
      {"shape = \"annulus\"\nouter = 1\ninner = 0.2\noffset = -0.4",
       "shape = \"parametric\"\nx = \"sin(t)\"\ny = \"cos(t)\"\n[[table.obstacle]]\nshape = "
       "\"circle\"\ncenter = [-0.4, 0]\nradius = 0.2"}};
  const auto most = static_cast<std::uint64_t>(tests::cases(6, 25));
  std::size_t turn = 0;
  for (const auto& [conic, curve] : same)
    for (const char* field : {"", "[field]\nB = 0.6\n", "[field]\nB = -3\n"}) {
      if (!tests::soak() && turn++ % 2 == 1) continue;
      CertifiedOrbit one(system_of(conic, field), task_of(most, 42)),
          other(system_of(curve, field), task_of(most, 42));
      for (std::uint64_t n = 1; n <= most; ++n) {
        const auto a = one.next(), b = other.next();
        ASSERT_TRUE(a && b) << curve << field;
        EXPECT_EQ(b->number, n);
        expect_same(*a, *b, 40);
      }
      EXPECT_FALSE(other.next());
      EXPECT_EQ(other.end_state().fate, CertifiedFate::completed);
      CertifiedTask until = task_of(0, 42);
      until.t_max = ExactNumber("17/3");
      CertifiedOrbit first(system_of(conic, field), until), second(system_of(curve, field), until);
      expect_same(first.finish(), second.finish(), 40);
      EXPECT_EQ(first.end_state().collisions, second.end_state().collisions);
    }
}

const char* const curves[] = {
    "shape = \"cardioid\"\nradius = 1",
    "shape = \"robnik\"\nradius = 1\nlambda = 0.3",
    "shape = \"superellipse\"\na = 1\nb = 1.5\nexponent = 4",
    "shape = \"egg\"\na = 1.2\nb = 1\nepsilon = 0.2",
    "shape = \"spline\"\npoints = [[-1, -1], [1.1, -1.2], [1.5, 0.3], [0.5, "
    "1], [0.1, 0.9], [-1, 1.4]]",
    "shape = \"path\"\nloop = [{start = [-1, -1], pieces = [{bezier = [[0, "
    "-0.5], [1, -1]]}, {bezier = [[2, 0], [1, 0.1], [0.8, 0.2], [0.7, "
    "1]]}, {bezier = [[-1, 2], [-0.1, 0], [-1, -1]]}]}]",
    "shape = \"robnik\"\nradius = 1\nlambda = 0.3\n[[table.obstacle]]\n"
    "shape = \"path\"\nstart = [0.2, -0.2]\npieces = [{bezier = [[-0.1, "
    "0.4], [-0.3, -0.2]]}, {line_to = [0.2, -0.2]}]",
    "shape = \"implicit\"\nequation = \"x^4 + y^4 + 0.3*x*y^2 - 1\"\ninside = [0, 0]"};

TEST(CurveOrbit, MoreDigitsBeginWithTheSame) {
  const auto most = static_cast<std::uint64_t>(tests::cases(8, 40));
  for (const char* curve : curves) {
    CertifiedOrbit few(system_of(curve), task_of(most, 12)),
        many(system_of(curve), task_of(most, 60));
    while (const auto hit = few.next()) {
      const auto same = many.next();
      ASSERT_TRUE(same) << curve;
      EXPECT_LT(std::fabs(hit->x.to_double() - same->x.to_double()), 1e-12);
      EXPECT_LT(same->x.log2_error(), -60.0 * 3.32);
      EXPECT_EQ(hit->wall, same->wall);
    }
    EXPECT_FALSE(many.next());
    EXPECT_GE(many.effort().bits, 200);
  }
}

TEST(CurveOrbit, DoublesBeginAlike) {
  for (const char* curve : curves) {
    const ExactSystem system = system_of(curve);
    CertifiedOrbit certified(system, task_of(6, 20));
    World world(*system.table);
    State start;
    start.position = {0.3, 1.0 / 7.0};
    const double angle = M_PI / 5.0;
    start.velocity = {2.0 * std::cos(angle), 2.0 * std::sin(angle)};
    Particle particle;
    particle.speed = 2.0;
    world.add(particle, start);
    struct Hits : Observer {
      std::vector<HitEvent> all;
      void hit(const HitEvent& e) override { all.push_back(e); }
    } hits;
    world.limit_hits(6);
    world.run_until(1e300, hits);
    ASSERT_EQ(hits.all.size(), 6U);
    for (const HitEvent& hit : hits.all) {
      const auto exact = certified.next();
      ASSERT_TRUE(exact);
      EXPECT_NEAR(exact->x.to_double(), hit.position.x, 1e-8) << curve;
      EXPECT_NEAR(exact->y.to_double(), hit.position.y, 1e-8) << curve;
    }
  }
}

// Its last decimals, as a start: there and back it is the start again.
TEST(CurveOrbit, TheWayBackLeadsToTheStart) {
  for (const char* curve : curves)
    for (const char* field : {"", "[field]\nB = 1.1\n"}) {
      ExactSystem system = system_of(curve, field);
      CertifiedTask task = task_of(0, 80);
      task.t_max = ExactNumber(tests::soak() ? "9.7" : "4.7");
      CertifiedOrbit there(system, task);
      const CertifiedEnd end = there.finish();
      ASSERT_EQ(end.fate, CertifiedFate::completed) << end.reason;
      EXPECT_GT(end.collisions, tests::soak() ? 5U : 1U);
      system.start = {};
      system.start.position = {ExactNumber(end.x.text(80)), ExactNumber(end.y.text(80))};
      system.start.direction = {ExactNumber("-(" + end.vx.text(80) + ")"),
                                ExactNumber("-(" + end.vy.text(80) + ")")};
      system.omega = ExactNumber("-(" + system.omega.text() + ")");
      task.digits = 50;
      CertifiedOrbit back(system, task);
      const CertifiedEnd& start = back.finish();
      EXPECT_EQ(start.x.text(40), "0.3000000000000000000000000000000000000000") << curve;
      EXPECT_EQ(start.y.text(40), "0.1428571428571428571428571428571428571429");
      EXPECT_EQ(start.collisions, end.collisions);
    }
}

std::string hole(const std::string& wall, const char* center, const char* width) {
  return "\n[[table.hole]]\nwall = \"" + wall + "\"\ncenter = \"" + center + "\"\nwidth = \"" +
         width + "\"\n";
}
void expect_same_end(const std::string& walls, const std::string& written) {
  CertifiedOrbit one(system_of(walls), task_of(100, 42)),
      other(system_of(written), task_of(100, 42));
  expect_same(one.finish(), other.finish(), 40);
  EXPECT_EQ(one.end_state().fate, CertifiedFate::escaped) << walls;
  EXPECT_EQ(other.end_state().fate, CertifiedFate::escaped) << written << other.end_state().reason;
  EXPECT_EQ(one.end_state().collisions, other.end_state().collisions) << written;
  EXPECT_EQ(one.end_state().hole, other.end_state().hole);
}

TEST(CurveOrbit, HolesAreThoseOfTheWalls) {
  const std::string ellipse = "shape = \"ellipse\"\na = 2\nb = 0.7",
                    round = "shape = \"parametric\"\nx = \"2*cos(t)\"\ny = \"0.7*sin(t)\"",
                    circle = "shape = \"circle\"\nradius = \"5/6\"",
                    polar = "shape = \"polar\"\nradius = \"5/6\"";
  for (const char* center : {"sqrt(7)", "8", "1"}) {
    expect_same_end(ellipse + hole("ellipse", center, "0.2"), round + hole("curve", center, "0.2"));
    if (!tests::soak()) break;
  }
  expect_same_end(circle + hole("circle", "0", "0.3"), polar + hole("curve", "0", "0.3"));
  // Of segments and arcs beside curves.
  const std::string others =
      "{arc_via = [2, 0], arc_to = [1, 1]}, {line_to = [-1, 1]}, {ellipse_via = [-1.5, 0], "
      "ellipse_to = [-1, -1], ellipse_ratio = 2}]}]";
  const std::string path = "shape = \"path\"\nloop = [{start = [-1, -1], pieces = [",
                    plain = path + "{line_to = [1, -1]}, " + others,
                    bezier = path + "{bezier = [[-0.5, -1], [0, -1], [1, -1]]}, " + others;
  for (const char* wall : {"wall_1", "wall_2", "wall_3", "wall_4"})
    expect_same_end(plain + hole(wall, "0.9", "0.2"), bezier + hole(wall, "0.9", "0.2"));
}

TEST(CurveOrbit, HolesBeginAndEndAtArcLengths) {
  // Of length 8; from its cusp to the point opposite to it, 4.
  const std::string cardioid = curves[0];
  const auto fate = [&](const std::string& center) {
    ExactSystem system = system_of(cardioid + hole("curve", center.c_str(), "0.01"));
    start_from(system, "1", "0", "1", "0");
    CertifiedTask task = task_of(1, 20);
    task.most_bits_a_doubt = 256;
    CertifiedOrbit orbit(system, task);
    return orbit.finish().fate;
  };
  EXPECT_EQ(fate("4.005 - 1e-25"), CertifiedFate::escaped);
  EXPECT_EQ(fate("3.995 - 1e-25"), CertifiedFate::completed);
  if (tests::soak()) {
    EXPECT_EQ(fate("4"), CertifiedFate::escaped);
    EXPECT_EQ(fate("4.005 + 1e-25"), CertifiedFate::completed);
    EXPECT_EQ(fate("3.995 + 1e-25"), CertifiedFate::escaped);
    EXPECT_EQ(fate("4.005"), CertifiedFate::undecided);
  }
  // To the end of a wall.
  ExactSystem corner = system_of(
      "shape = \"path\"\nloop = [{start = [-1, -1], pieces = [{line_to = [1, -1]}, {bezier = [[2, "
      "0], "
      "[1, 1]]}, {line_to = [-1, 1]}, {line_to = [-1, -1]}]}]" +
      hole("wall_1", "1.95", "0.1"));
  start_from(corner, "0.3", "0.5", "0.7 - 1e-25", "-1.5");
  CertifiedOrbit out(corner, task_of(3, 20));
  EXPECT_EQ(out.finish().fate, CertifiedFate::escaped) << out.end_state().reason;
}

TEST(CurveOrbit, DrawingsAreThePathsThatTheyAreReadAs) {
  const std::string file = testing::TempDir() + "certified_drawing.svg";
  std::ofstream(file) << "<svg xmlns='http://www.w3.org/2000/svg'><path d='M -1 1 Q 0 0.5 1 1 L 1 "
                         "-1 L -1 -1 Z'/><circle cx='0' cy='0' r='0.1'/></svg>";
  CertifiedOrbit drawn(system_of("shape = \"svg\"\npath = \"" + file + "\"\nscale = 1"),
                       task_of(20, 42)),
      written(system_of("shape = \"path\"\nloop = [{start = [-1, -1], pieces = [{bezier = [[0, "
                        "-0.5], [1, -1]]}, {line_to = [1, 1]}, {line_to = [-1, 1]}, {line_to = "
                        "[-1, -1]}]}]\n[[table.obstacle]]\nshape = \"circle\"\ncenter = [0, "
                        "0]\nradius = 0.1"),
              task_of(20, 42));
  expect_same(drawn.finish(), written.finish(), 40);
  EXPECT_EQ(drawn.end_state().collisions, 20U);
}

TEST(CurveOrbit, RaysLeaveThePlane) {
  const std::string obstacle =
      "shape = \"path\"\nloop = [{start = [2, 0], pieces = [{bezier = [[3, 1], [4, 0]]}, {bezier "
      "= [[3, -1], [2, 0]]}]}]";
  ExactSystem system = system_of(obstacle);
  CertifiedOrbit away(system, task_of(5, 20));
  EXPECT_EQ(away.finish().fate, CertifiedFate::unbounded) << away.end_state().reason;
  EXPECT_EQ(away.end_state().collisions, 0U);
  system.start.angle.reset();
  system.start.direction = {ExactNumber("2"), ExactNumber("0.1")};
  CertifiedOrbit towards(system, task_of(5, 20));
  EXPECT_EQ(towards.finish().fate, CertifiedFate::unbounded) << towards.end_state().reason;
  EXPECT_EQ(towards.end_state().collisions, 1U);
  system.start.position = {ExactNumber("3"), ExactNumber("0")};
  EXPECT_THROW(CertifiedOrbit(system, task_of(5, 20)), InputError);
}

// To 1e-25 beside a joint, and at it.
TEST(CurveOrbit, JointsAreTold) {
  ExactSystem system = system_of(curves[5]);
  for (const char* beside : {"1e-25", "-1e-25", "0"}) {
    system.start.position = {ExactNumber("0.3"), ExactNumber("0.5")};
    system.start.angle.reset();
    system.start.direction = {ExactNumber("0.7"), ExactNumber(std::string("-1.5 + ") + beside)};
    CertifiedTask task = task_of(1, 20);
    task.most_bits_a_doubt = 256;
    CertifiedOrbit orbit(system, task);
    const auto hit = orbit.next();
    EXPECT_EQ(hit.has_value(), beside[0] != '0');
    if (hit) {
      EXPECT_EQ(hit->wall, beside[0] == '-' ? 0 : 1) << beside;
    }
  }
}

TEST(CurveOrbit, StartsOnTheWall) {
  ExactSystem system = system_of("shape = \"limacon\"\nradius = 1\nepsilon = 0.5");
  system.start = {};
  system.start.wall = 2;
  system.start.u = 0.25;
  system.start.direction = {ExactNumber("-1"), ExactNumber("0.1")};
  CertifiedOrbit orbit(system, task_of(10, 20));
  EXPECT_EQ(orbit.finish().collisions, 10U) << orbit.end_state().reason;
  system.start.direction = {ExactNumber("1"), ExactNumber("0.1")};
  EXPECT_THROW(CertifiedOrbit(system, task_of(10, 20)), InputError);
}

TEST(CurveOrbit, RefusesByName) {
  const std::string curve = curves[1];
  ExactSystem outside = system_of(curve);
  outside.start.position = {ExactNumber("1.5"), ExactNumber("1")};
  EXPECT_THROW(CertifiedOrbit(outside, task_of(5, 20)), InputError);
  ExactSystem on_the_wall = system_of("shape = \"polar\"\nradius = \"1 + 0.1*cos(phi)\"");
  on_the_wall.start.position = {ExactNumber("1.1"), ExactNumber("0")};
  EXPECT_THROW(CertifiedOrbit(on_the_wall, task_of(5, 20)), InputError);
  ExactSystem lattice = system_of(
      "shape = \"plane\"\n[[table.obstacle]]\nshape = \"polar\"\ncenter = [0, 0]\nradius = \"0.1 "
      "+ 0.01*cos(phi)\"",
      "[lattice]\nvectors = [[1, 0], [0, 1]]\n");
  EXPECT_THROW(CertifiedOrbit(lattice, task_of(5, 20)), InputError);
}

TEST(CurveOrbit, SmallCirclesArePinned) {
  CertifiedOrbit orbit(system_of(curves[1], "[field]\nB = 40\n"), task_of(5, 20));
  EXPECT_EQ(orbit.finish().fate, CertifiedFate::pinned);
}

// Of a curve that is not convex, from beside its joints, with hits on the next piece: a zero behind
// the start is none.
TEST(CurveOrbit, HitsLieAhead) {
  ExactSystem system = system_of("shape = \"polar\"\nradius = \"1 + 0.3*cos(3*phi)\"");
  const World world(*system.table);
  int hits = 0;
  const int step = tests::soak() ? 1 : 8;
  for (int k = 0; k < 80; k += step) {
    system.start = {};
    system.start.wall = (37 * k) % static_cast<int>(system.table->walls.size());
    system.start.u = 0.9 + 0.001 * k;
    const geometry::Curve& curve = system.table->wall(system.start.wall).curve;
    const geometry::Vector n = geometry::normal_at(curve, system.start.u);
    // Nearly along the wall.
    const double sine = 0.0005 * (1.0 + k);
    const geometry::Vector d = sine * n - std::sqrt(1.0 - sine * sine) * left(n);
    system.start.direction = {ExactNumber(d.x), ExactNumber(d.y)};
    CertifiedTask task = task_of(1, 12);
    task.most_bits_a_doubt = 256;
    CertifiedOrbit orbit(system, task);
    const auto hit = orbit.next();
    if (!hit) continue;  // undecided
    ++hits;
    const geometry::Vector from = geometry::point_at(curve, system.start.u),
                           e = geometry::Vector{hit->x.to_double(), hit->y.to_double()} - from;
    EXPECT_GT(dot(d, e), 0.0) << k;
    World one(*system.table);
    Particle particle;
    State start;
    start.wall = system.start.wall;
    start.u = system.start.u;
    start.position = from;
    start.velocity = d;
    one.add(particle, start);
    one.limit_hits(1);
    Observer silent;
    one.run_until(1e300, silent);
    EXPECT_NEAR(one.state(0).position.x, hit->x.to_double(), 1e-8) << k;
    EXPECT_NEAR(one.state(0).position.y, hit->y.to_double(), 1e-8) << k;
  }
  EXPECT_GT(hits * step, 75);
  // Here a step of Newton's leads far behind the start.
  system.start = {};
  system.start.wall = system.table->wall_index("curve_261");
  const geometry::CurveFrame frame =
      geometry::frame_of(system.table->wall(system.start.wall).curve);
  system.start.u = geometry::parameter_at_length(frame, 0.007519816674304043);
  const geometry::Vector t = geometry::tangent_at(frame, system.start.u);
  const double along = 0.9999889024956274, across = std::sqrt(1.0 - along * along);
  const geometry::Vector d = along * t + across * left(t);
  system.start.direction = {ExactNumber(d.x), ExactNumber(d.y)};
  CertifiedOrbit orbit(system, task_of(1, 12));
  EXPECT_NEAR(orbit.finish().t.to_double() * 2.0, 0.008163205412, 1e-8);
}

// Its formula goes on beyond its ends, inside: that is no wall.
TEST(CurveOrbit, FormulasEndWhereTheyAreSaidTo) {
  ExactSystem system =
      system_of("shape = \"polar\"\nradius = \"1 + 0.3*cos(3*phi) + 0.0001*phi^3*(2*pi - phi)^3\"");
  system.start = {};
  system.start.position = {ExactNumber(0.1650693880836361), ExactNumber(-0.6186520615954586)};
  system.start.direction = {ExactNumber(0.9902399699673184), ExactNumber(0.13937288789116808)};
  CertifiedOrbit orbit(system, task_of(1, 12));
  const auto hit = orbit.next();
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->t.to_double() * 2.0, 0.37249, 1e-5);  // speed 2
}

TEST(CurveOrbit, StartsBetweenTheCurveAndItsPolygon) {
  ExactSystem system = system_of("shape = \"polar\"\nradius = \"1 + 0.3*cos(3*phi)\"");
  system.start = {};
  system.start.position = {ExactNumber("1.299973"), ExactNumber("0.003988")};
  system.start.direction = {ExactNumber("1"), ExactNumber("0")};
  CertifiedOrbit orbit(system, task_of(3, 12));
  EXPECT_EQ(orbit.finish().collisions, 3U) << orbit.end_state().reason;
}

// Straight into the cusp: no direction is its normal.
TEST(CurveOrbit, TheCuspIsUndecided) {
  ExactSystem system = system_of(curves[0]);
  start_from(system, "1", "0", "-1", "0");
  CertifiedTask task = task_of(5, 10);
  task.most_bits_a_doubt = 256;
  CertifiedOrbit orbit(system, task);
  EXPECT_EQ(orbit.finish().fate, CertifiedFate::undecided);
  EXPECT_NE(orbit.end_state().reason, "");
}

}  // namespace
}  // namespace carom
