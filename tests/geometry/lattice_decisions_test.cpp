// Flights over a lattice of discs against the same discs laid out in the plane.
#include "geometry/decisions.hpp"

namespace carom::tests {

using events::Ahead;

namespace {

constexpr int reach = 6;  // cells laid out to each side; the horizon is far nearer

Table lorentz(double spacing, bool square) {
  Table t;
  t.extent = Extent::lattice;
  t.lattice = square ? geometry::make_lattice({spacing, 0}, {0, spacing}, {0, 0})
                     : geometry::make_lattice(
                           {spacing, 0}, {0.5 * spacing, 0.5 * std::sqrt(3.0) * spacing}, {0, 0});
  add_loop(t, {Circle{{0, 0}, 1.0, false}});
  if (square) add_loop(t, {Circle{{0.5 * spacing, 0.5 * spacing}, 0.4, false}});
  return t;
}

Table laid_out(const Table& cell) {
  Table t;
  t.extent = Extent::open_plane;
  for (int m = -reach; m <= reach; ++m)
    for (int n = -reach; n <= reach; ++n)
      for (const Wall& w : cell.walls) {
        auto disc = std::get<Circle>(w.curve);
        disc.centre = disc.centre + cell.lattice->translation({m, n});
        add_loop(t, {disc});
      }
  return t;
}

struct Met {
  bool found = false;
  int wall = -1, edges = 0;
  geometry::Cell cell;
  double kappa = 0.0;
  friend bool operator==(const Met&, const Met&) = default;
};

Met follow(events::HitFinder& finder, const Start& s, DecisionCounts& counts) {
  events::Flight f;
  f.omega = s.omega;
  f.square_speed = dot(s.velocity, s.velocity);
  finder.pieces().begin_on_wall(f, s.wall, s.u, finder.pieces().curve(s.wall).point(s.u),
                                s.velocity);
  Met met;
  for (; met.edges < 100; ++met.edges) {
    const Ahead a = finder.next(f, counts);
    if (a.kind == Ahead::Kind::wall) {
      const events::PieceTable::Landing l = finder.pieces().land(f, a, counts);
      return {true, l.wall, met.edges, l.cell, a.kappa};
    }
    if (a.kind != Ahead::Kind::edge) break;
    finder.pieces().cross(f, a);
  }
  return met;
}

TEST(Decisions, LatticesAreDiscsInThePlane) {
  for (const bool square : {false, true}) {
    const Table table = lorentz(square ? 2.6 : 2.25, square), plane = laid_out(table);
    events::HitFinder fast(table), integers(table, {no_filter});
    const Oracle oracle(plane);
    Dice dice(11);
    DecisionCounts counts, unused;
    const int walls = static_cast<int>(table.walls.size());
    long edges = 0;
    const long count = cases(300, 20000);
    for (long i = 0; i < count; ++i) {
      Start s;
      s.wall = dice.whole(0, walls - 1);
      s.u = 4.0 * dice.unit() * (1.0 - 0x1p-50) + 0x1p-52;
      s.velocity = dice.direction();
      s.omega = dice.coin() ? 0.0 : dice.between(-2.0, 2.0);
      if (fast.pieces().exact->inward(s.wall, s.u, s.velocity) == Sign::negative)
        s.velocity = -s.velocity;
      const Met a = follow(fast, s, counts), b = follow(integers, s, unused);
      ASSERT_TRUE(a.found) << i;
      ASSERT_EQ(a, b) << i;
      edges += a.edges;
      const int home = (reach * (2 * reach + 1) + reach) * walls;
      const Expected e = oracle.first(home + s.wall, s.u, {}, s.velocity, s.omega);
      ASSERT_EQ(e.kind, Expected::Kind::wall) << i;
      const int cell = e.wall / walls;
      EXPECT_EQ(e.wall % walls, a.wall) << i;
      EXPECT_EQ(cell / (2 * reach + 1) - reach, a.cell.first) << i;
      EXPECT_EQ(cell % (2 * reach + 1) - reach, a.cell.second) << i;
    }
    std::printf("%s lattice: %ld flights over %ld edges, %.4f %% by the filter\n",
                square ? "square" : "triangular", count, edges,
                100.0 * double(counts.filter) / double(counts.filter + counts.exact));
    EXPECT_GE(double(counts.filter), 0.999 * double(counts.filter + counts.exact));
    EXPECT_GT(edges, count / 2);
  }
}

}  // namespace
}  // namespace carom::tests
