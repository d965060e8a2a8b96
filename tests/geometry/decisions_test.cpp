// Which wall is met first: filter, integers and CGAL agree on random flights.
#include "geometry/decisions.hpp"

namespace carom::tests {
namespace {

/// How the tables and fields of a random family are spread.
struct Spread {
  double flattest = 30.0;       ///< arcs
  double largest_radius = 1e6;  ///< of Larmor circles, in sizes
};

/// Flights of all kinds in random tables of one shape.
Tally random_flights(Shape shape, double size, long count, long with_cgal, std::uint64_t seed,
                     Spread spread = {}) {
  Dice dice(seed);
  Tally tally;
  constexpr int per_table = 60;
  while (tally.cases < count) {
    Bench bench(sound_table(shape, size, dice, spread.flattest));
    for (int i = 0; i < per_table && tally.cases < count; ++i) {
      const double speed = dice.coin() ? 1.0 : dice.spread(1e-3, 1e3);
      // Straight; Larmor circles from far smaller to far larger than the table.
      const double omega =
          dice.whole(0, 2) == 0
              ? 0.0
              : dice.sign() * speed /
                    (size * dice.spread(0.03, dice.coin() ? 10.0 : spread.largest_radius));
      Start s = bench.on_wall(dice, speed, omega);
      if (dice.whole(0, 3) == 0) s = bench.half_way(s);
      const bool ask = (tally.cases * with_cgal) / count != ((tally.cases + 1) * with_cgal) / count;
      bench.check(s, ask, tally);
    }
  }
  return tally;
}

class RandomFlights : public testing::TestWithParam<std::pair<Shape, const char*>> {};

TEST_P(RandomFlights, FilterIntegersAndCgalAgree) {
  const auto [shape, name] = GetParam();
  for (const double size : {1.0, 1e-6, 1e6}) {
    // A quartic's exact root costs a hundred times a quadratic's.
    const bool quartic = shape == Shape::ellipse || shape == Shape::elliptic_arcs;
    const Tally t = random_flights(shape, size, quartic ? cases(500, 20000) : cases(2500, 60000),
                                   quartic ? cases(120, 4000) : cases(1000, 60000),
                                   static_cast<std::uint64_t>(shape) + 1);
    t.print((std::string(name) + " of size " +
             (size == 1.0  ? "1"
              : size < 1.0 ? "1e-6"
                           : "1e6"))
                .c_str());
    EXPECT_EQ(t.differ, 0);
    EXPECT_EQ(t.cgal_differs, 0);
    EXPECT_GE(t.filter_share(), 0.999);
    // One more: a hit that one step does not put on its curve is asked exactly.
    EXPECT_GE(double(t.hole_by_filter + 1), 0.999 * double(t.hole_decisions));
  }
}

TEST(Decisions, FlatArcsAndNearlyStraightFlightsAgree) {
  // Centres and radii lose their digits here: the filter may pass on what it likes, but never err.
  for (const auto& [shape, name] :
       {std::pair{Shape::arcs, "flat arcs"}, std::pair{Shape::elliptic_arcs, "flat elliptic arcs"},
        std::pair{Shape::stadium, "nearly straight flights"}}) {
    const Tally t =
        random_flights(shape, 1.0, cases(400, 10000), cases(200, 4000), 77, {1e9, 1e13});
    t.print(name);
    EXPECT_EQ(t.differ, 0);
    EXPECT_EQ(t.cgal_differs, 0);
    EXPECT_GE(t.filter_share(), 0.5);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Decisions, RandomFlights,
    testing::Values(std::pair{Shape::polygon, "polygons"}, std::pair{Shape::arcs, "arcs"},
                    std::pair{Shape::stadium, "stadiums"}, std::pair{Shape::mushroom, "mushrooms"},
                    std::pair{Shape::discs, "discs"}, std::pair{Shape::annulus, "annuli"},
                    std::pair{Shape::ellipse, "ellipses"},
                    std::pair{Shape::elliptic_arcs, "elliptic_arcs"}),
    [](const auto& shape) { return std::string(shape.param.second); });

}  // namespace
}  // namespace carom::tests
