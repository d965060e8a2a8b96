#include "certify/wall/containment.hpp"

#include "table/loops.hpp"

namespace carom::certify {
namespace {

// The wall seen from its other side.
WallOf<Ball> turned_round(const WallOf<Ball>& w) {
  WallOf<Ball> r = w;
  r.turn = -w.turn;
  r.from = w.to;
  r.to = w.from;
  r.chord = -w.chord;
  r.normal = -w.normal;
  return r;
}

Verdict within(const WallOf<Ball>& closed, const BallVector& P) {
  const Ball beyond = level_at(closed, P);
  return above_zero(sign_or_tie(closed.turn > 0 ? -beyond : beyond));
}

// A ray from a point of the domain first crosses the boundary from inside, a ray from outside from
// the outer side. A direction that stays undecided, say through a joint, is replaced by another.
Verdict within(const WallLoop& loop, const std::vector<WallOf<Ball>>& walls, const BallVector& P) {
  const auto wall = [&](int k) -> const WallOf<Ball>& {
    return walls[static_cast<std::size_t>(k)];
  };
  if (wall(loop.walls.front()).closed) return within(wall(loop.walls.front()), P);
  for (const geometry::Vector& ray : {geometry::Vector{0.5625, 0.828125},
                                      {-0.875, 0.484375},
                                      {0.203125, -0.984375},
                                      {-0.6875, -0.71875},
                                      {0.984375, 0.171875},
                                      {-0.09375, 0.984375}}) {
    const BallVector v{ray.x, ray.y};
    MotionOf<Ball> motion;
    motion.speed2 = dot(v, v);
    const std::vector<std::pair<int, bool>> none;
    First<Ball, std::pair<int, bool>> first(none);
    for (const int k : loop.walls) {
      first.offer(meets(wall(k), P, v, motion, false), {k, true});
      first.offer(meets(turned_round(wall(k)), P, v, motion, false), {k, false});
    }
    if (first.rival() != nullptr) continue;
    const bool inside = first.found() ? first.key().second : loop.obstacle;
    return inside ? Verdict::yes : Verdict::no;
  }
  return Verdict::undecided;
}

}  // namespace

std::vector<WallLoop> loops_of(const Table& table) {
  std::vector<WallLoop> loops;
  for (const std::vector<int>& loop : table::wall_loops(table))
    loops.push_back({loop, geometry::area({table::curves_of(table, loop)}) < 0.0});
  return loops;
}

Containment::Containment(const std::vector<WallLoop>& loops, const BallTable& table,
                         const BallVector& P) {
  if (!table.lattice) {
    for (const WallLoop& loop : loops) ask({&loop, {}}, table, P);
    return;
  }
  const Whereabouts where = whereabouts_of(table);
  if (!std::isfinite(where.rounding)) {  // more bits will tell
    verdict_ = Verdict::undecided;
    return;
  }
  const geometry::Vector P0{P.x.to_double(), P.y.to_double()};
  // Twice: the disc around a loop is at most twice as large as all coordinates of its walls, and
  // its radius is rounded by 5 u.
  const double off = off_by(P, P0) + 2.0 * where.rounded_off(std::sqrt(dot(P0, P0)), 0.0);
  if (!(off <= where.stretch)) {
    too_far_ = true;
    return;
  }
  for (const WallLoop& loop : loops) {
    // A disc around the whole of it.
    const auto disc = [&](int k) { return where.discs[static_cast<std::size_t>(k)]; };
    const geometry::Vector centre = disc(loop.walls.front()).centre;
    double radius = 0.0;
    for (const int k : loop.walls) {
      const geometry::Vector d = disc(k).centre - centre;
      radius = std::max(radius, std::sqrt(dot(d, d)) + disc(k).radius);
    }
    const geometry::Vector d = P0 - centre;
    const double reach = radius + off;
    const double c = dot(where.to_first, d), s = dot(where.to_second, d);
    const double c_reach = reach * std::sqrt(dot(where.to_first, where.to_first));
    const double s_reach = reach * std::sqrt(dot(where.to_second, where.to_second));
    for (double m = std::ceil(c - c_reach); m <= c + c_reach; ++m)
      for (double n = std::ceil(s - s_reach); n <= s + s_reach; ++n) {
        const geometry::Cell cell{static_cast<std::int64_t>(m), static_cast<std::int64_t>(n)};
        ask({&loop, cell}, table, cell == geometry::Cell{} ? P : P - table.lattice->at(cell));
      }
  }
}

void Containment::ask(const LoopCopy& copy, const BallTable& table, const BallVector& seen) {
  const Verdict verdict = within(*copy.loop, table.walls, seen);
  if (verdict == Verdict::undecided) in_doubt_.push_back(copy);
  verdict_ = both(verdict_, verdict);
}

}  // namespace carom::certify
