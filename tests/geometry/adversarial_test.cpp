// Flights made to be hard. Each family names the stage that must decide it.
#include "geometry/decisions.hpp"

namespace carom::tests {
namespace {

enum class Stage { filter, exact, either };

/// Runs a family: `make` fills in a start on a bench, or gives false. At least 99 % of a filter
/// family must be decided by the filter, all of an exact one beyond it, some of either by both.
template <class MakeBench, class MakeStart>
Tally run(const char* name, Stage stage, long count, MakeBench&& make_bench, MakeStart&& make,
          int per_table = 40, double share = 0.99) {
  Dice dice(static_cast<std::uint64_t>(std::string(name).size()) * 7919);
  Tally tally;
  const long cgal_every = 4;
  for (long tables = 0; tally.cases < count && tables < 100 * count; ++tables) {
    Bench bench(make_bench(dice));
    for (int i = 0; i < per_table && tally.cases < count; ++i) {
      Start s;
      if (!make(bench, dice, s) || !bench.inward(s)) continue;
      bench.check(s, tally.cases % cgal_every == 0, tally);
    }
  }
  tally.print(name);
  EXPECT_EQ(tally.cases, count) << name;
  EXPECT_EQ(tally.differ, 0) << name;
  EXPECT_EQ(tally.cgal_differs, 0) << name;
  if (stage == Stage::filter)
    EXPECT_GE(tally.filter_share(), share) << name;
  else
    EXPECT_EQ(tally.by_filter > 0, stage == Stage::either) << name;
  if (stage == Stage::either) {
    EXPECT_LT(tally.filter_share(), 0.9) << name;
  }
  return tally;
}

long count() { return cases(600, 12000); }
double norm(Vector v) { return std::sqrt(dot(v, v)); }
Vector turned_by(Vector v, double small) { return {v.x - small * v.y, v.y + small * v.x}; }

/// Aims from a wall at a joint that it sees: the nearest doubles to the direction, turned by `off`.
bool aim_at_joint(Bench& bench, Dice& dice, double omega_times_size, double size, double off,
                  Start& s) {
  const auto& walls = bench.table().walls;
  const int wall = dice.whole(0, static_cast<int>(walls.size()) - 1);
  const Wall& begins = walls[static_cast<std::size_t>(wall)];
  if (geometry::is_closed(begins.curve)) return false;
  s = bench.on_wall(dice, 1.0, 0.0);
  const Vector d = geometry::start_point(begins.curve) - bench.place(s);
  const double l = norm(d);
  if (!(l > 1e-3 * size)) return false;
  s.omega = omega_times_size / size;
  const double sine = 0.5 * s.omega * l;
  if (std::fabs(sine) > 0.99) return false;
  const double cosine = std::sqrt(1.0 - sine * sine);
  s.velocity = s.omega == 0.0 ? d : (1.0 / l) * (cosine * d + sine * left(d));
  s.velocity = turned_by(s.velocity, off);
  if (!bench.inward(s)) return false;
  const events::Ahead a = bench.ahead(s);
  return a.kind != events::Ahead::Kind::wall || a.piece == wall || a.piece == begins.previous;
}

constexpr Shape jointed[] = {Shape::polygon, Shape::arcs, Shape::stadium, Shape::mushroom,
                             Shape::discs};
Table jointed_table(double size, Dice& dice) {
  return sound_table(jointed[dice.whole(0, 4)], size, dice);
}

TEST(Adversarial, FlightsAimedAtJointsAgreeWithExactDecisions) {
  for (const double size : {1.0, 1e-6, 1e6}) {
    const auto table = [&](Dice& dice) { return jointed_table(size, dice); };
    for (const double field : {0.0, 1.3, -0.4}) {
      run("at joints, to the last digit", Stage::exact, count(), table,
          [&](Bench& b, Dice& dice, Start& s) {
            return aim_at_joint(b, dice, field, size, 0.0, s);
          });
      run("beside joints, by 1e-9", Stage::filter, count(), table,
          [&](Bench& b, Dice& dice, Start& s) {
            return aim_at_joint(b, dice, field, size, dice.sign() * dice.between(1e-9, 2e-9), s);
          });
    }
  }
}

TEST(Adversarial, FlightsAimedAtJointsOfEllipticArcsAgree) {
  const auto table = [](Dice& dice) { return sound_table(Shape::elliptic_arcs, 1.0, dice); };
  for (const double field : {0.0, 0.7, -1.1})
    run("at elliptic joints, last digit", Stage::exact, cases(100, 2000), table,
        [&](Bench& b, Dice& dice, Start& s) { return aim_at_joint(b, dice, field, 1.0, 0.0, s); });
}

/// A star polygon with whole coordinates, and aims that meet a joint exactly.
Table whole_star(Dice& dice) {
  for (;;) {
    const int n = dice.whole(3, 8);
    std::vector<Vector> points;
    for (int i = 0; i < n; ++i) {
      const double angle = 6.283185307179586 * i / n;
      const double r = dice.whole(4, 24);
      points.push_back({std::nearbyint(r * std::cos(angle)), std::nearbyint(r * std::sin(angle))});
    }
    Table t = polygon(points);
    if (sound(t)) return t;
  }
}

TEST(Adversarial, FlightsExactlyThroughJointsAgree) {
  const Tally t = run(
      "exactly through joints", Stage::exact, count(), whole_star,
      [](Bench& b, Dice& dice, Start& s) {
        const auto& walls = b.table().walls;
        s.wall = dice.whole(0, static_cast<int>(walls.size()) - 1);
        s.u = 0.25 * dice.whole(1, 3);
        const Vector at = b.place(s);
        s.velocity =
            geometry::start_point(
                walls[static_cast<std::size_t>(dice.whole(0, static_cast<int>(walls.size()) - 1))]
                    .curve) -
            at;
        return true;
      });
  EXPECT_GT(t.joints, t.cases / 4);
}

/// The same with arcs for some sides.
Table whole_arcs(Dice& dice) {
  for (;;) {
    const Table star = whole_star(dice);
    std::vector<Curve> sides;
    for (const Wall& w : star.walls) {
      const auto& side = std::get<Segment>(w.curve);
      const double offset = 0.5 * dice.whole(1, 6);
      if (dice.coin())
        sides.push_back(side);
      else if (dice.coin())
        sides.push_back(CircularArc{side.from, side.to, offset, true});
      else
        sides.push_back(CircularArc{side.from, side.to, -offset, false});
    }
    Table t = loop(sides);
    if (sound(t)) return t;
  }
}

TEST(Adversarial, JointsAheadAndBehindAreToldApart) {
  // A joint exactly behind the particle must not count, and its walls' parity must stay whole.
  const auto start = [](Bench& b, Dice& dice, double omega, Start& s) {
    const auto& walls = b.table().walls;
    const Vector joint = geometry::start_point(
        walls[static_cast<std::size_t>(dice.whole(0, static_cast<int>(walls.size()) - 1))].curve);
    s.point = {0.5 * dice.whole(-20, 20), 0.5 * dice.whole(-20, 20)};
    std::vector<geometry::NamedCurve> sides;
    for (const Wall& w : walls) sides.push_back({w.name, w.curve});
    const Vector d = joint - s.point;
    if (!(dot(d, d) > 0) || geometry::locate(sides, s.point) <= 0) return false;
    // side = 2 v x d + omega d.d = 0 for v = d + (omega/2) left(d).
    s.omega = omega;
    s.velocity = d + (0.5 * omega) * left(d);
    if (dice.coin()) {  // the same circle, the other way round
      s.velocity = -s.velocity;
      s.omega = -omega;
    }
    return true;
  };
  for (const double omega : {0.0, 0.25, -1.0})
    run("through joints of arcs", Stage::exact, count(), whole_arcs,
        [&](Bench& b, Dice& dice, Start& s) { return start(b, dice, omega, s); });
}

TEST(Adversarial, FlightsFromJointsAgree) {
  run(
      "from joints", Stage::exact, count(), [](Dice& dice) { return jointed_table(1.0, dice); },
      [](Bench& b, Dice& dice, Start& s) {
        s = b.on_wall(dice, 1.0, dice.coin() ? 0.0 : dice.between(-3.0, 3.0));
        s.u = 0.0;
        return !b.curve(s.wall).closed;
      });
}

/// Four discs in a square; flights from the square that graze one of them.
bool graze(Bench& bench, Dice& dice, double off, Start& s) {
  const auto& walls = bench.table().walls;
  if (walls.size() < 5) return false;
  s = bench.on_wall(dice, 1.0, 0.0);
  if (s.wall > 3) return false;
  const auto& disc = std::get<Circle>(
      walls[static_cast<std::size_t>(dice.whole(4, static_cast<int>(walls.size()) - 1))].curve);
  const Vector e = disc.centre - bench.place(s);
  const double square = dot(e, e), along = std::sqrt(square - disc.radius * disc.radius);
  const double side = dice.sign() * disc.radius * (1.0 + off);
  s.velocity = (1.0 / square) * (along * e + side * left(e));
  return true;
}
TEST(Adversarial, GrazingFlightsAgree) {
  for (const double size : {1.0, 1e-6, 1e6}) {
    const auto table = [&](Dice& dice) {
      const double r = size * dice.between(0.1, 0.45);
      const double h = 0.5 * size;
      return with_disc(with_disc(rectangle(2 * size, 2 * size), {h, h}, r), {3 * h, h}, r);
    };
    run("grazing a disc, to the last digit", Stage::exact, count(), table,
        [](Bench& b, Dice& dice, Start& s) { return graze(b, dice, 0.0, s); });
    run("grazing a disc within 1e-6", Stage::filter, count(), table,
        [](Bench& b, Dice& dice, Start& s) {
          return graze(b, dice, dice.sign() * dice.between(0.5e-6, 1e-6), s);
        });
  }
}

TEST(Adversarial, LarmorCirclesGraze) {
  const auto table = [](Dice& dice) {
    return with_disc(rectangle(4, 4), {2, 2}, dice.between(0.2, 0.8));
  };
  for (const bool exact : {true, false})
    run(exact ? "Larmor circle grazing, last digit" : "Larmor circle grazing within 1e-6",
        exact ? Stage::exact : Stage::filter, count(), table, [&](Bench& b, Dice& dice, Start& s) {
          const double r = std::get<Circle>(b.table().walls[4].curve).radius;
          const double rho = dice.between(0.1, 0.5),
                       gap = exact ? 0.0 : dice.sign() * dice.between(0.5e-6, 1e-6);
          const Vector n = dice.direction(), m = dice.direction();
          const Vector centre = Vector{2, 2} + (r + rho + gap) * n;
          s.point = centre + rho * m;
          const Vector d = s.point - Vector{2, 2};
          if (!(dot(d, d) > 1.0001 * r * r)) return false;
          s.omega = dice.sign() / rho;
          s.velocity = s.omega > 0 ? right(m) : left(m);
          // The bounds know the doubles that are given, not the rounding that made them.
          return true;
        });
}

TEST(Adversarial, ExactTangencyIsNoHit) {
  // Along y = centre + r from the left; and Larmor circles of radius rho about a Pythagorean point.
  const auto table = [](Dice& dice) {
    return with_disc(rectangle(8, 8), {4, 4}, 0.125 * dice.whole(1, 24));
  };
  const Tally t = run("exactly tangent lines", Stage::exact, count(), table,
                      [](Bench& b, Dice& dice, Start& s) {
                        const double r = std::get<Circle>(b.table().walls[4].curve).radius;
                        const bool up = dice.coin();
                        s.wall = up ? 0 : 3;  // bottom, left (downwards from y = 8)
                        s.u = (4.0 + dice.sign() * r) / 8.0;
                        s.velocity = up ? Vector{0, 1} : Vector{1, 0};
                        return true;
                      });
  EXPECT_EQ(t.joints + t.none, 0);
  run("exactly tangent Larmor circles", Stage::exact, count(), table,
      [](Bench& b, Dice& dice, Start& s) {
        const double r = std::get<Circle>(b.table().walls[4].curve).radius;
        // |(3, 4) k| = 5 k = r + rho.
        const double k = 0.125 * dice.whole(1, 7), rho = 5 * k - r;
        if (!(rho > 0)) return false;
        const Vector c{4 + dice.sign() * 3 * k, 4 + dice.sign() * 4 * k};
        s.omega = dice.sign();
        s.velocity = {dice.sign() * rho, 0.0};
        s.point = c - (1.0 / s.omega) * right(s.velocity);
        return s.point.x > 0 && s.point.x < 8 && s.point.y > 0 && s.point.y < 8;
      });
  const auto ellipse = [](Dice& dice) {
    Table square = rectangle(8, 8);
    add_loop(square, {Ellipse{{4, 4}, {2, 0}, 0.125 * dice.whole(1, 12), false}});
    return square;
  };
  run("exactly tangent to ellipses", Stage::exact, cases(100, 2000), ellipse,
      [](Bench& b, Dice& dice, Start& s) {
        const double height = 2.0 * std::get<Ellipse>(b.table().walls[4].curve).ratio;
        const bool above = dice.coin();
        const double y = 4.0 + (above ? height : -height);
        s.velocity = {dice.sign(), 0.0};
        const double rho = 0.125 * dice.whole(1, 3);
        if (dice.coin()) {  // a line
          s.point = {s.velocity.x > 0 ? 0.5 : 7.5, y};
        } else {  // a circle outside that touches from above or below
          s.omega = dice.sign() / rho;
          if (s.omega != std::nearbyint(s.omega)) return false;
          s.point = {4.0, y + (above ? 2 * rho : -2 * rho)};
          s.velocity.x = (s.omega > 0) == above ? 1.0 : -1.0;
        }
        return true;
      });
}

TEST(Adversarial, ConcentricLarmorCircles) {
  const auto table = [](Dice& dice) {
    return with_disc(loop({Circle{{3, -1}, 1.0, true}}), {3, -1}, 0.125 * dice.whole(1, 6));
  };
  for (const bool near : {false, true}) {
    const Tally t = run(near ? "concentric, radii alike to 2^-51" : "concentric",
                        near ? Stage::exact : Stage::filter, count(), table,
                        [&](Bench& b, Dice& dice, Start& s) {
                          const double inner = std::get<Circle>(b.table().walls[1].curve).radius;
                          const double rho = near ? (dice.coin() ? 1.0 - 0x1p-51 : inner + 0x1p-51)
                                                  : dice.between(inner + 1e-3, 1.0 - 1e-3);
                          const double x = 3.0 + rho;  // exact up to 2^-51
                          s.point = {x, -1.0};
                          s.omega = dice.sign() * 4.0;
                          s.velocity = {0.0, -s.omega * (x - 3.0)};
                          return true;
                        });
    EXPECT_EQ(t.none, t.cases);  // nothing is ever met
  }
}

TEST(Adversarial, NearlyEqualTimesAreOrdered) {
  // A flat obstacle just below the top: its near side and the wall behind it are met at nearly one
  // time. Once one flight has shown which comes first, the joints tell others with the same ones on
  // their right.
  for (const bool near : {true, false})
    run(
        near ? "slit of 2^-51" : "slit of 1e-9", near ? Stage::either : Stage::filter, count(),
        [&](Dice&) {
          const double gap = near ? 0x1p-51 : 1e-9;
          Table t = rectangle(4, 1 + 2 * gap);
          add_loop(t, {Segment{{1, 1}, {1, 1 + gap}}, Segment{{1, 1 + gap}, {3, 1 + gap}},
                       Segment{{3, 1 + gap}, {3, 1}}, Segment{{3, 1}, {1, 1}}});
          return t;
        },
        [](Bench& b, Dice& dice, Start& s) {
          s = b.on_wall(dice, 1.0, dice.coin() ? 0.0 : dice.between(-0.1, 0.1));
          if (s.wall != 0) return false;
          const Vector p = b.place(s);
          s.velocity = Vector{dice.between(1.2, 2.8), 1.0} - p;  // up, upon the slit
          return std::fabs(s.velocity.x) < 1.0;
        });
}

TEST(Adversarial, FlightsAlongTheAxesAgree) {
  const auto axis = [](Dice& dice) {
    return dice.coin() ? Vector{dice.sign(), 0} : Vector{0, dice.sign()};
  };
  run(
      "vertical and horizontal", Stage::filter, count(),
      [](Dice& dice) { return jointed_table(1.0, dice); },
      [&](Bench& b, Dice& dice, Start& s) {
        s = b.on_wall(dice, 1.0, 0.0);
        s.velocity = axis(dice);
        return true;
      },
      40, 0.95);
  run("along grid lines through joints", Stage::exact, count(), whole_star,
      [&](Bench& b, Dice& dice, Start& s) {
        // From the centre, which sees every corner of the star.
        const auto& walls = b.table().walls;
        const Vector j = geometry::start_point(
            walls[static_cast<std::size_t>(dice.whole(0, static_cast<int>(walls.size()) - 1))]
                .curve);
        const bool across = dice.coin();
        s.point = across ? Vector{0.5 * j.x, j.y} : Vector{j.x, 0.5 * j.y};
        s.velocity = across ? Vector{j.x > 0 ? 1.0 : -1.0, 0} : Vector{0, j.y > 0 ? 1.0 : -1.0};
        std::vector<geometry::NamedCurve> sides;
        for (const Wall& w : walls) sides.push_back({w.name, w.curve});
        return geometry::locate(sides, s.point) > 0;
      });
}

TEST(Adversarial, HolesEndWhereTheyEnd) {
  // Exactly at the start of a hole: out; exactly at its end: not.
  Table t = rectangle(8, 8);
  t.holes.push_back({"hole", 0, 0.25, 0.5});
  t.walls[0].holes.push_back(0);
  Bench bench(t);
  Tally tally;
  for (int i = 0; i <= 64; ++i)
    for (const double x : {2.0, 4.0}) {
      Start s;
      s.wall = 2;  // top, leftwards
      s.u = i / 64.0;
      if (i == 0 || i == 64) continue;
      const double from = 8.0 - 8.0 * s.u;
      s.velocity = {x - from, -8.0};
      const long before = tally.holes;
      bench.check(s, true, tally);
      EXPECT_EQ(tally.holes - before, x == 2.0 ? 1 : 0);
    }
  tally.print("at the ends of a hole");
  EXPECT_EQ(tally.hole_by_filter, 0);
  EXPECT_EQ(tally.cgal_differs + tally.differ, 0);
}

}  // namespace
}  // namespace carom::tests
