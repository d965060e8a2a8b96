// One decision taken three times: by the filter (exact arithmetic where it cannot tell), in
// integers alone, and by CGAL.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include "carom/geometry/region.hpp"
#include "events/flight/next_hit.hpp"
#include "geometry/oracle.hpp"
#include "random_tables.hpp"

namespace carom::tests {

inline bool sound(const Table& t) {
  std::vector<geometry::Loop> loops;
  std::vector<bool> seen(t.walls.size(), false);
  for (std::size_t i = 0; i < t.walls.size(); ++i) {
    if (seen[i]) continue;
    loops.emplace_back();
    for (std::size_t k = i; !seen[k]; k = static_cast<std::size_t>(t.walls[k].next)) {
      seen[k] = true;
      loops.back().push_back({t.walls[k].name, t.walls[k].curve});
    }
  }
  return geometry::check_region(loops, geometry::RegionKind::bounded, std::nullopt, 1).empty();
}

/// A random table with a hole somewhere.
inline Table sound_table(Shape shape, double size, Dice& dice, double flattest = 30.0) {
  for (;;) {
    const Vector at =
        shape == Shape::mushroom ? Vector{} : (2.0 * size * dice.unit()) * dice.direction();
    Table t = random_table(shape, size, at, dice, flattest);
    if (!sound(t)) continue;
    const int wall = dice.whole(0, static_cast<int>(t.walls.size()) - 1);
    Wall& w = t.walls[static_cast<std::size_t>(wall)];
    const double end = geometry::end_parameter(w.curve),
                 from = dice.coin() ? 0.0 : dice.unit() * end;
    t.holes.push_back({"hole", wall, from, from + (end - from) * dice.between(0.1, 0.9)});
    w.holes.push_back(0);
    return t;
  }
}

struct Start {
  int wall = -1;
  double u = 0.0;
  Vector point;
  Vector velocity;
  double omega = 0.0;
};

/// Every bound so large that no filter decides anything.
inline constexpr double no_filter = 1e300;

/// What the decisions of one family came to.
struct Tally {
  long cases = 0, by_filter = 0, by_cgal = 0, differ = 0, cgal_differs = 0;
  long joints = 0, cusps = 0, none = 0, holes = 0, hole_by_filter = 0, hole_decisions = 0;
  double filter_share() const { return cases > 0 ? double(by_filter) / double(cases) : 0.0; }
  void print(const char* name) const {
    std::printf(
        "%-36s %8ld cases, %8.4f %% by the filter, CGAL %7ld, joints %ld, cusps %ld, none %ld, "
        "holes %ld\n",
        name, cases, 100.0 * filter_share(), by_cgal, joints, cusps, none, holes);
  }
};

class Bench {
 public:
  explicit Bench(Table table)
      : table_(std::move(table)), fast_(table_), integers_(table_, {no_filter}) {}

  const Table& table() const { return table_; }
  events::HitFinder& finder() { return fast_; }
  const geometry::PreparedCurve& curve(int wall) const { return fast_.pieces().curve(wall); }
  Vector place(const Start& s) const { return s.wall < 0 ? s.point : curve(s.wall).point(s.u); }

  /// A random start on a wall, into the domain, as fast as `speed`.
  Start on_wall(Dice& dice, double speed, double omega) const {
    Start s;
    s.wall = dice.whole(0, static_cast<int>(table_.walls.size()) - 1);
    const Curve& on = table_.walls[static_cast<std::size_t>(s.wall)].curve;
    s.u = std::clamp(dice.unit() * geometry::end_parameter(on), geometry::first_parameter,
                     geometry::last_parameter(on));
    const Vector d = dice.direction();
    s.velocity = speed * d;
    s.omega = omega;
    if (fast_.pieces().exact->inward(s.wall, s.u, s.velocity) == Sign::negative)
      s.velocity = -s.velocity;
    return s;
  }
  bool inward(const Start& s) const {
    if (s.wall < 0) return true;
    if (fast_.pieces().exact->inward(s.wall, s.u, s.velocity) != Sign::positive) return false;
    return s.u > 0.0 || curve(s.wall).closed ||
           fast_.pieces().exact->inward_at_end(
               table_.walls[static_cast<std::size_t>(s.wall)].previous, s.velocity) ==
               Sign::positive;
  }
  events::Ahead ahead(const Start& s) {
    DecisionCounts counts;
    return fast_.next(flight(fast_, s), counts);
  }
  /// A free start half way to what lies ahead.
  Start half_way(const Start& s) {
    DecisionCounts counts;
    const events::Ahead a = fast_.next(flight(fast_, s), counts);
    if (a.kind == events::Ahead::Kind::none) return s;
    Start free = s;
    free.wall = -1;
    const Vector from = place(s);
    if (s.omega == 0.0) {
      free.point = from + (0.5 * a.duration) * s.velocity;
    } else {
      const double h = 0.5 * s.omega, angle = 0.5 * a.duration * h;
      const double kappa = h * std::cos(angle) / std::sin(angle);
      free.point = from + geometry::displacement(kappa, s.velocity, s.omega, 0.5);
      const geometry::FlightFactors<double> f = geometry::flight_factors(kappa, s.omega, 0.5);
      free.velocity = geometry::turned_by(s.omega * f.along, s.omega * f.across, s.velocity);
    }
    return free;
  }

  events::Flight flight(const events::HitFinder& finder, const Start& s) const {
    events::Flight f;
    f.omega = s.omega;
    f.square_speed = dot(s.velocity, s.velocity);
    if (s.wall >= 0) {
      finder.pieces().begin_on_wall(f, s.wall, s.u, place(s), s.velocity);
    } else {
      f.start = s.point;
      f.velocity = s.velocity;
      finder.pieces().begin(f);
    }
    return f;
  }

  void check(const Start& s, bool with_cgal, Tally& tally) {
    DecisionCounts counts, unused;
    const events::Flight f = flight(fast_, s), g = flight(integers_, s);
    const events::Ahead a = fast_.next(f, counts), b = integers_.next(g, unused);
    ++tally.cases;
    tally.by_filter += counts.filter == 1 && counts.exact == 0;
    tally.joints += a.kind == events::Ahead::Kind::joint;
    tally.cusps += a.kind == events::Ahead::Kind::cusp;
    tally.none += a.kind == events::Ahead::Kind::none;
    const bool same =
        a.kind == b.kind && a.piece == b.piece &&
        (a.kind == events::Ahead::Kind::none || (a.kappa == b.kappa && a.duration == b.duration));
    if (!same && tally.differ++ < 3)
      ADD_FAILURE() << "filter " << text(a) << ", integers " << text(b) << "; " << text(s);
    int hole = -2;
    if (same && a.kind == events::Ahead::Kind::wall &&
        !table_.walls[static_cast<std::size_t>(a.piece)].holes.empty()) {
      DecisionCounts fast, slow;
      hole = fast_.pieces().land(f, a, fast).hole;
      if (hole != integers_.pieces().land(g, b, slow).hole && tally.differ++ < 3)
        ADD_FAILURE() << "hole " << hole << ", integers "
                      << integers_.pieces().land(g, b, slow).hole << " at u "
                      << fast_.pieces().land(f, a, fast).at.u << "; " << text(a) << "; " << text(s);
      ++tally.hole_decisions;
      tally.hole_by_filter += fast.exact == 0;
      tally.holes += hole >= 0;
    }
    if (!with_cgal) return;
    if (!oracle_) oracle_ = std::make_unique<Oracle>(table_);
    ++tally.by_cgal;
    const Expected e = oracle_->first(s.wall, s.u, s.point, s.velocity, s.omega);
    const bool agrees =
        static_cast<int>(e.kind) == (a.kind == events::Ahead::Kind::none    ? 0
                                     : a.kind == events::Ahead::Kind::wall  ? 1
                                     : a.kind == events::Ahead::Kind::joint ? 2
                                                                            : 3) &&
        (e.kind == Expected::Kind::none || e.kind == Expected::Kind::cusp || e.wall == a.piece);
    if (!agrees && tally.cgal_differs++ < 3)
      ADD_FAILURE() << "engine " << text(a) << ", CGAL " << static_cast<int>(e.kind) << " wall "
                    << e.wall << "; " << text(s);
    if (agrees && hole != -2) {
      int expected = -1;
      for (const int h : table_.walls[static_cast<std::size_t>(a.piece)].holes)
        if (oracle_->within(table_.holes[static_cast<std::size_t>(h)].from,
                            table_.holes[static_cast<std::size_t>(h)].to))
          expected = h;
      if (expected != hole && tally.cgal_differs++ < 3)
        ADD_FAILURE() << "hole " << hole << ", CGAL " << expected << "; " << text(s);
    }
  }

 private:
  static std::string text(const events::Ahead& a) {
    char line[120];
    std::snprintf(line, sizeof line, "kind %d piece %d kappa %a duration %a",
                  static_cast<int>(a.kind), a.piece, a.kappa, a.duration);
    return line;
  }
  std::string text(const Start& s) const {
    char line[400];
    const Vector p = place(s);
    std::snprintf(line, sizeof line, "walls %zu, wall %d u %a point %a %a velocity %a %a omega %a",
                  table_.walls.size(), s.wall, s.u, p.x, p.y, s.velocity.x, s.velocity.y, s.omega);
    return line;
  }

  Table table_;
  events::HitFinder fast_, integers_;
  std::unique_ptr<Oracle> oracle_;
};

}  // namespace carom::tests
