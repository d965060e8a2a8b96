// Many walls: with and without the grid every flight ends alike, to the last bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "carom/events/world.hpp"
#include "carom/geometry/hull.hpp"
#include "events/flight/cell_walk.hpp"
#include "events/flight/locator.hpp"
#include "events/flight/next_hit.hpp"
#include "events/flight/wall_grid.hpp"
#include "events/recorder.hpp"
#include "random_tables.hpp"

namespace carom::tests {

using namespace events;

namespace {

constexpr DecisionOptions always{1.0, 0}, never_a_grid{1.0, std::numeric_limits<int>::max()};

/// Discs of different sizes at random places of a cell about (0.5, 0.5), apart from each other and
/// from their copies.
std::vector<Curve> random_discs(int count, double radius, Vector first, Vector second,
                                bool periodic, Dice& dice) {
  std::vector<Circle> placed;
  while (static_cast<int>(placed.size()) < count) {
    const double a = dice.unit() - 0.5, b = dice.unit() - 0.5, r = radius * dice.between(0.3, 1.0);
    const Vector c{0.5 + a * first.x + b * second.x, 0.5 + a * first.y + b * second.y};
    bool apart = true;
    for (const Circle& other : placed)
      for (int m = periodic ? -1 : 0; m <= (periodic ? 1 : 0); ++m)
        for (int n = periodic ? -1 : 0; n <= (periodic ? 1 : 0); ++n) {
          const double x = c.x - other.centre.x + m * first.x + n * second.x;
          const double y = c.y - other.centre.y + m * first.y + n * second.y;
          apart = apart && std::sqrt(x * x + y * y) > r + other.radius + 1e-9;
        }
    if (apart) placed.push_back({c, r, false});
  }
  return {placed.begin(), placed.end()};
}

Table obstacles(const std::vector<Curve>& discs) {
  Table table;
  for (const Curve& disc : discs) add_loop(table, {disc});
  table.extent = Extent::open_plane;
  return table;
}

Table on_lattice(Table table, Vector first, Vector second) {
  table.extent = Extent::lattice;
  table.lattice = geometry::make_lattice(first, second, {0.5, 0.5});
  return table;
}

Table random_lorentz(Vector first, Vector second, int count, double radius) {
  Dice dice(7);
  return on_lattice(obstacles(random_discs(count, radius, first, second, true, dice)), first,
                    second);
}

/// A star with long thin rays.
Table star(int sides, double least) {
  Dice dice(11);
  std::vector<Vector> corners;
  for (int i = 0; i < sides; ++i) {
    const double angle = 6.283185307179586 / sides * (i + dice.between(-0.3, 0.3));
    const double r = dice.between(least, 1.0);
    corners.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  return polygon(corners);
}

Table regular(int sides) {
  std::vector<Vector> corners;
  for (int i = 0; i < sides; ++i) {
    const double angle = 6.283185307179586 / sides * (i + 0.3);
    corners.push_back({std::cos(angle), std::sin(angle)});
  }
  return polygon(corners);
}

/// A regular polygon as an obstacle, from whose neighbours flights come, too.
Table regular_on_lattice(int sides) {
  Table table;
  std::vector<Curve> walls;
  const auto corner = [&](int i) {
    const double angle = 6.283185307179586 / sides * (i % sides + 0.3);
    return Vector{0.5 + 0.53 * std::cos(angle), 0.5 - 0.53 * std::sin(angle)};
  };
  for (int i = 0; i < sides; ++i) walls.push_back(Segment{corner(i), corner(i + 1)});
  add_loop(table, walls);
  return on_lattice(table, {1.1, 0}, {0.5, 1});
}

/// A body with thin teeth, each a fifth as wide as their distance.
Table comb(int teeth) {
  std::vector<Vector> corners{{0, 0}, {1, 0}, {1, 0.5}};
  for (int i = teeth - 1; i >= 0; --i) {
    const double left = (i + 0.4) / teeth, right = (i + 0.6) / teeth;
    for (const Vector& corner :
         {Vector{right, 0.5}, Vector{right, 1}, Vector{left, 1}, Vector{left, 0.5}})
      corners.push_back(corner);
  }
  corners.push_back({0, 0.5});
  return polygon(corners);
}

/// Discs near the middle of a box, in a square of side 1.
Table discs_in_a_box(int count, double radius, double side) {
  Table table = rectangle(side, side);
  Dice dice(13);
  for (const Curve& disc : random_discs(count, radius, {1, 0}, {0, 1}, false, dice)) {
    Circle moved = std::get<Circle>(disc);
    moved.centre = moved.centre + Vector{0.5 * side, 0.5 * side};
    add_loop(table, {moved});
  }
  return table;
}

/// One obstacle of each kind after the other on a square array, clockwise.
Table many_kinds(int n, bool box) {
  Table table = box ? rectangle(n, n) : Table();
  const double s = 0.25;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) {
      const double x = i + 0.5, y = k + 0.5;
      switch ((i + 2 * k) % 5) {
        case 0:
          add_loop(table, {Circle{{x, y}, s, false}});
          break;
        case 1:
          add_loop(
              table,
              {Segment{{x - s, y - s}, {x - s, y + s}}, Segment{{x - s, y + s}, {x + s, y + s}},
               Segment{{x + s, y + s}, {x + s, y - s}}, Segment{{x + s, y - s}, {x - s, y - s}}});
          break;
        case 2:
          add_loop(table, {Segment{{x + s, y}, {x - s, y}},
                           CircularArc{{x - s, y}, {x + s, y}, 0.0, false}});
          break;
        case 3:
          add_loop(table, {Ellipse{{x, y}, {s, 0.125}, 0.5, false}});
          break;
        default:
          add_loop(table, {CircularArc{{x - s, y}, {x + s, y}, -0.5, false},
                           EllipticArc{{x + s, y}, {x - s, y}, {1.0, 0.0}, 0.5, 0.0, false}});
      }
    }
  if (!box) table.extent = Extent::open_plane;
  return table;
}

struct Flown {
  long flights = 0, hits = 0, crossings = 0, exact = 0;
};

class TwoFinders {
 public:
  explicit TwoFinders(const Table& table)
      : table_(table), grid_(table, always), loop_(table, never_a_grid) {}

  /// From a wall or a point, through as many cells as it passes.
  void fly(Flight flight) {
    Flight other = flight;
    grid_.pieces().begin(flight);
    loop_.pieces().begin(other);
    ++flown.flights;
    for (int cells = 0; cells < 100; ++cells) {
      DecisionCounts counts, unused;
      const Ahead a = grid_.next(flight, counts), b = loop_.next(other, unused);
      flown.exact += static_cast<long>(counts.exact);
      ASSERT_EQ(a.kind, b.kind) << describe(flight);
      if (a.kind == Ahead::Kind::none) return;
      ASSERT_EQ(a.piece, b.piece) << describe(flight);
      ASSERT_EQ(a.root, b.root) << describe(flight);
      ASSERT_EQ(std::bit_cast<std::uint64_t>(a.kappa), std::bit_cast<std::uint64_t>(b.kappa))
          << describe(flight);
      ASSERT_EQ(std::bit_cast<std::uint64_t>(a.duration), std::bit_cast<std::uint64_t>(b.duration))
          << describe(flight);
      if (a.kind != Ahead::Kind::edge) {
        ++flown.hits;
        return;
      }
      ++flown.crossings;
      grid_.pieces().cross(flight, a);
      loop_.pieces().cross(other, b);
    }
  }

  Flight from_point(Vector point, Vector velocity, double omega) const {
    Flight flight;
    flight.start = point;
    flight.velocity = velocity;
    flight.omega = omega;
    flight.square_speed = dot(velocity, velocity);
    return flight;
  }
  /// From a random point of a random wall, or joint; false: the direction leads into the wall.
  bool from_wall(Dice& dice, double omega, Flight& flight) const {
    const int wall = dice.whole(0, static_cast<int>(table_.walls.size()) - 1);
    const geometry::PreparedCurve& curve = grid_.pieces().curve(wall);
    const double u = dice.whole(0, 15) == 0 ? 0.0 : dice.between(0.0, curve.last());
    const auto frame = curve.frame(u);
    flight = from_point(frame.point, dice.direction(), omega);
    flight.square_speed = 1.0;
    flight.wall = wall;
    flight.u = u;
    flight.start_error = curve.point_error;
    DecisionCounts counts;
    return grid_.pieces().inward(wall, u, flight.velocity, frame.normal, counts) == Sign::positive;
  }

  Flown flown;

 private:
  static std::string describe(const Flight& f) {
    char text[300];
    std::snprintf(text, sizeof text, "wall %d u %a x %a y %a vx %a vy %a omega %a cell %ld %ld",
                  f.wall, f.u, f.start.x, f.start.y, f.velocity.x, f.velocity.y, f.omega,
                  static_cast<long>(f.cell.first), static_cast<long>(f.cell.second));
    return text;
  }
  const Table& table_;
  HitFinder grid_, loop_;
};

/// Flights without field and of all Larmor radii, from walls and from within.
void fly_everywhere(const Table& table, Vector low, Vector high, long count) {
  TwoFinders finders(table);
  Locator locator(table);
  Dice dice(3);
  for (long i = 0; i < count; ++i) {
    const double size = high.x - low.x;
    const double omega =
        dice.whole(0, 2) == 0 ? 0.0 : dice.sign() / (size * dice.spread(1e-3, 1e3));
    Flight flight;
    if (dice.coin()) {
      if (!finders.from_wall(dice, omega, flight)) continue;
    } else {
      const Vector point{dice.between(low.x, high.x), dice.between(low.y, high.y)};
      if (!locator.contains(point)) continue;
      flight = finders.from_point(point, dice.direction(), omega);
      flight.square_speed = 1.0;
    }
    finders.fly(flight);
    if (testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(finders.flown.hits, count / 20);
  EXPECT_LT(finders.flown.exact, finders.flown.flights / 5);
}

TEST(Grid, DiscsOnASquareLatticeAreThoseOfTheLoop) {
  fly_everywhere(random_lorentz({1, 0}, {0, 1}, 150, 0.05), {0, 0}, {1, 1}, cases(8000, 400000));
}
TEST(Grid, DiscsOnAnObliqueLatticeAreThoseOfTheLoop) {
  fly_everywhere(random_lorentz({1, 0}, {0.5, 0.8660254037844386}, 60, 0.05), {0, 0}, {1, 1},
                 cases(6000, 400000));
}
TEST(Grid, AThinGasIsThatOfTheLoop) {
  fly_everywhere(random_lorentz({1, 0}, {0.25, 1}, 40, 0.004), {0, 0}, {1, 1}, cases(3000, 100000));
}
TEST(Grid, DiscsInThePlaneAreThoseOfTheLoop) {
  Dice dice(5);
  fly_everywhere(obstacles(random_discs(150, 0.05, {1, 0}, {0, 1}, false, dice)), {-0.2, -0.2},
                 {1.2, 1.2}, cases(6000, 400000));
}
TEST(Grid, PolygonsAreThoseOfTheLoop) {
  fly_everywhere(star(300, 0.95), {-1, -1}, {1, 1}, cases(6000, 400000));
  fly_everywhere(star(200, 0.05), {-1, -1}, {1, 1}, cases(6000, 400000));
}
// Most of these is empty: flights leap over it.
TEST(Grid, PolygonsOfManySidesAreThoseOfTheLoop) {
  fly_everywhere(regular(150), {-1, -1}, {1, 1}, cases(4000, 200000));
  fly_everywhere(regular(3000), {-1, -1}, {1, 1}, cases(2000, 100000));
  fly_everywhere(star(3000, 0.9), {-1, -1}, {1, 1}, cases(2000, 100000));
  fly_everywhere(star(1000, 0.2), {-1, -1}, {1, 1}, cases(2000, 100000));
  fly_everywhere(regular_on_lattice(500), {0, 0}, {1, 1}, cases(2000, 100000));
}
TEST(Grid, AThinCombIsThatOfTheLoop) {
  fly_everywhere(comb(100), {0, 0}, {1, 1}, cases(4000, 200000));
}
TEST(Grid, DiscsInALargeBoxAreThoseOfTheLoop) {
  for (const double side : {4.0, 20.0, 100.0})
    fly_everywhere(discs_in_a_box(150, 0.04, side), {0, 0}, {side, side}, cases(3000, 150000));
}

WallGrid grid_of(const Table& table) {
  std::vector<geometry::Piece> pieces;
  for (const Wall& wall : table.walls) pieces.push_back({wall.curve, {}, wall.next, false});
  return {pieces, {}, {}, geometry::hull_of(table.walls, [](const Wall& wall) {
            return geometry::bounding_box(wall.curve);
          })};
}

// A clearing that is one cell too wide would lose walls.
TEST(Grid, KnowsHowFarItsCellsAreFromWalls) {
  int widest = 0;
  for (const Table& table :
       {regular(100), regular(10000), star(200, 0.05), comb(30), discs_in_a_box(150, 0.04, 100)}) {
    const WallGrid grid = grid_of(table);
    std::vector<std::pair<int, int>> occupied;
    for (int k = 0; k < grid.rows(); ++k)
      for (int i = 0; i < grid.columns(); ++i)
        if (!grid.is_empty(i, k)) occupied.push_back({i, k});
    Dice dice(17);
    for (int n = 0; n < 3000; ++n) {
      const int i = dice.whole(0, grid.columns() - 1), k = dice.whole(0, grid.rows() - 1);
      int away = grid.columns() + grid.rows();
      for (const auto& [column, row] : occupied)
        away = std::min(away, std::max(std::abs(column - i), std::abs(row - k)));
      ASSERT_LE(grid.clearance(i, k), away);
      ASSERT_EQ(grid.clearance(i, k) == 0, away == 0);
      ASSERT_GT(grid.clearance(i, k), away - 32);  // two blocks
      widest = std::max(widest, away);
    }
  }
  EXPECT_GT(widest, 64);  // blocks of cells are empty
}

// Whatever the start's error: all points that the flight may come to are of cells that were
// visited.
TEST(Grid, VisitsTheCellsOfAllPointsNearAFlight) {
  for (const Table& table :
       {regular(3000), star(300, 0.05), comb(30), discs_in_a_box(150, 0.04, 20)}) {
    const WallGrid grid = grid_of(table);
    const geometry::Box box = geometry::hull_of(
        table.walls, [](const Wall& wall) { return geometry::bounding_box(wall.curve); });
    const double size = box.high.x - box.low.x;
    Dice dice(19);
    for (long n = 0; n < cases(4000, 200000); ++n) {
      const Vector start{dice.between(box.low.x, box.high.x), dice.between(box.low.y, box.high.y)},
          v = dice.direction();
      const double delta = size * (dice.coin() ? 1e-12 : dice.spread(1e-4, 1e-1));
      const double omega = dice.coin() ? 0.0 : dice.sign() / (size * dice.spread(1e-2, 1e2));
      std::vector<char> visited(table.walls.size(), 0);
      const auto visit = [&](int cell) {
        for (const int piece : grid.pieces(cell)) visited[static_cast<std::size_t>(piece)] = 1;
      };
      const auto passed = [](double) { return false; };
      if (omega == 0.0)
        grid.along_line(start, delta, v, visit, passed);
      else
        grid.along_circle(start, delta, v, omega, 1.0, visit, passed);
      const Vector shift{0.99 * delta * dice.sign(), 0.99 * delta * dice.sign()};
      const double way = omega == 0.0 ? 1.5 * size : std::min(6.3 / std::fabs(omega), 1.5 * size);
      for (int k = 0; k < 200; ++k) {
        const double t = way * dice.unit(), h = 0.5 * std::fabs(omega);
        const Vector d = omega == 0.0 ? Vector{t * v.x, t * v.y}
                                      : geometry::displacement(h / std::tan(h * t), v, omega, 0.5);
        const Vector x = start + shift + d;
        if (x.x < box.low.x || x.x > box.high.x || x.y < box.low.y || x.y > box.high.y) continue;
        for (const int piece : grid.pieces_at(x))
          ASSERT_TRUE(visited[static_cast<std::size_t>(piece)]);
      }
    }
  }
}

// A line aimed at any point of a wall comes to a cell that lists it, before it is told that all
// cells were visited up to there.
TEST(Grid, LinesCellByCellComeToTheWallsTheyMeet) {
  for (const Table& table : {regular(3000), star(300, 0.05), comb(30),
                             discs_in_a_box(150, 0.04, 20), discs_in_a_box(150, 0.04, 100)}) {
    const WallGrid grid = grid_of(table);
    const geometry::Box box = geometry::hull_of(
        table.walls, [](const Wall& wall) { return geometry::bounding_box(wall.curve); });
    const double size = box.high.x - box.low.x;
    Dice dice(23);
    for (long n = 0; n < cases(4000, 200000); ++n) {
      const auto wall =
          static_cast<std::size_t>(dice.whole(0, static_cast<int>(table.walls.size()) - 1));
      const geometry::CurveFrame frame = geometry::frame_of(table.walls[wall].curve);
      const Vector aim = geometry::point_at(frame, frame.last * dice.unit());
      Vector start{dice.between(box.low.x - size, box.high.x + size),
                   dice.between(box.low.y - size, box.high.y + size)};
      // Along a wall, or nearly along an axis, at times.
      if (dice.coin()) start = geometry::point_at(frame, frame.last * dice.unit());
      if (dice.whole(0, 7) == 0) start.x = aim.x + size * dice.sign() * dice.spread(1e-15, 1e-3);
      const Vector d = aim - start;
      if (d.x == 0.0 || d.y == 0.0) continue;
      const Vector v = dice.spread(1e-3, 1e3) * d;
      double known = 0.0, first = HUGE_VAL;  // times of all that was visited, and of the wall
      const auto visit = [&](int cell) {
        for (const int piece : grid.pieces(cell))
          if (piece == static_cast<int>(wall)) first = std::min(first, known);
      };
      const auto passed = [&](double kappa) {
        known = kappa > 0.0 ? 1.0 / kappa : HUGE_VAL;
        return false;
      };
      ASSERT_TRUE(grid.walk_line(start, 1e-15 * size, v, visit, passed));
      const double time = std::sqrt(dot(d, d) / dot(v, v));
      ASSERT_LE(first, time * (1.0 + 1e-12) + 1e-9 * size / std::sqrt(dot(v, v)));
    }
    EXPECT_FALSE(grid.walk_line(
        box.low, size, {1.0, 1.0}, [](int) {}, [](double) { return true; }));
    EXPECT_FALSE(grid.walk_line(
        box.low, 0.0, {1.0, 0.0}, [](int) {}, [](double) { return true; }));
  }
}

TEST(Grid, EveryKindOfWallIsThatOfTheLoop) {
  fly_everywhere(many_kinds(7, true), {0, 0}, {7, 7}, cases(4000, 200000));
  fly_everywhere(many_kinds(6, false), {0, 0}, {6, 6}, cases(4000, 200000));
  const Table cell = on_lattice(many_kinds(5, false), {5.25, 0}, {1.5, 5.25});
  fly_everywhere(cell, {-1, -1}, {6, 6}, cases(4000, 200000));
}

// Along the rows and columns of an array whose pitch is a power of two, through corners and tangent
// to discs: the exact stage has the same pieces to choose from.
TEST(Grid, FlightsAlongItsLinesAreThoseOfTheLoop) {
  for (const bool box : {true, false}) {
    const Table table = many_kinds(4, box);
    TwoFinders finders(table);
    for (int i = 1; i < 32; ++i)
      for (const int k : {4, 8, 16, 31})
        for (const Vector& v :
             {Vector{1, 0}, Vector{0, 1}, Vector{-1, 0}, Vector{0, -1}, Vector{0.6, 0.8}})
          for (const bool turned : {false, true}) {
            const Vector point{(turned ? k : i) * 0.125, (turned ? i : k) * 0.125};
            // Only from points that no obstacle comes near.
            const double x = std::fabs(point.x - std::floor(point.x) - 0.5);
            const double y = std::fabs(point.y - std::floor(point.y) - 0.5);
            if (std::max(x, y) < 0.375) continue;
            finders.fly(finders.from_point(point, v, i % 8 == 3 ? 0.5 : 0.0));
            if (HasFatalFailure()) return;
          }
    EXPECT_GT(finders.flown.exact, 50);
  }
}

}  // namespace
}  // namespace carom::tests
