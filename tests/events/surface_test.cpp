// Crossings of a free flight with a surface of section, against dense sampling.
#include "carom/events/surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "events/bracketed_root.hpp"
#include "motion/free_motion.hpp"

namespace carom {
namespace {

using geometry::Vector;
using Kind = Surface::Kind;

const Kind kinds[] = {Kind::line,       Kind::segment,    Kind::circle,    Kind::position_x,
                      Kind::position_y, Kind::velocity_x, Kind::velocity_y};

class Cases {
 public:
  double in(double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<double>()(random_);
  }
  Vector point() { return {in(-1, 1), in(-1, 1)}; }
  Surface surface(Kind kind) { return {kind, point(), point(), in(0.2, 1.5), in(-0.7, 0.7)}; }
  FreeFlight flight(double omega, double duration) {
    const double angle = in(0, 6.2831853);
    FreeFlight f{point(), {std::cos(angle), std::sin(angle)}, omega, duration, {}};
    f.end = motion::moved(f.position, f.velocity, omega, duration).first;
    return f;
  }

 private:
  std::mt19937_64 random_{17};
};

std::vector<SurfaceCrossing> all(const Surface& s, const FreeFlight& f) {
  std::vector<SurfaceCrossing> found;
  crossings(s, f, 1000000, found);
  return found;
}

// Signs at many times. A pair of crossings between two of them goes unnoticed.
struct Change {
  double from, to;
  int direction;
};
std::vector<Change> sampled(const Surface& s, const FreeFlight& f, int steps) {
  std::vector<Change> changes;
  double before = 0, t_before = 0;
  for (int i = 0; i <= steps; ++i) {
    const double t = f.duration * i / steps;
    const auto [position, velocity] = motion::moved(f.position, f.velocity, f.omega, t);
    const double g = surface_function(s, position, velocity);
    if (i > 0 && (g > 0) != (before > 0)) {
      bool inside = true;
      if (s.kind == Kind::segment) {
        const double part =
            dot(position - s.from, s.to - s.from) / dot(s.to - s.from, s.to - s.from);
        inside = part >= 0 && part < 1;
      }
      if (inside) changes.push_back({t_before, t, g > 0 ? 1 : -1});
    }
    before = g;
    t_before = t;
  }
  return changes;
}

TEST(Surface, CrossingsAreThoseOfDenseSampling) {
  Cases cases;
  int crossings_seen = 0, differ = 0, flights = 0;
  for (const Kind kind : kinds) {
    for (const double omega : {0.0, 1e-7, 0.3, -1.0, 4.0, -20.0}) {
      for (int i = 0; i < 60; ++i) {
        const Surface s = cases.surface(kind);
        const FreeFlight f = cases.flight(omega, cases.in(0.1, 6));
        const auto found = all(s, f);
        const auto expected = sampled(s, f, 4000);
        ++flights;
        if (found.size() != expected.size()) {
          ++differ;  // a pair within a step, or the end of a segment
          continue;
        }
        for (std::size_t k = 0; k < found.size(); ++k) {
          EXPECT_GE(found[k].time, expected[k].from - 1e-12);
          EXPECT_LE(found[k].time, expected[k].to + 1e-12);
          EXPECT_EQ(found[k].direction, expected[k].direction);
          ++crossings_seen;
        }
      }
    }
  }
  EXPECT_GT(crossings_seen, 2000);
  EXPECT_LT(differ, flights / 200);
}

TEST(Surface, CrossingsLieOnTheSurfaceToRounding) {
  Cases cases;
  for (const Kind kind : kinds) {
    for (const double omega : {0.0, 1e-9, 0.5, -3.0}) {
      for (int i = 0; i < 200; ++i) {
        const Surface s = cases.surface(kind);
        const FreeFlight f = cases.flight(omega, 5);
        for (const SurfaceCrossing& c : all(s, f)) {
          const double g = surface_function(s, c.position, c.velocity);
          EXPECT_LT(std::fabs(g), 1e-14) << static_cast<int>(kind) << ' ' << omega;
          const auto [position, velocity] = motion::moved(f.position, f.velocity, f.omega, c.time);
          EXPECT_EQ(position, c.position);
          EXPECT_EQ(velocity, c.velocity);
        }
      }
    }
  }
}

TEST(Surface, ALarmorCircleCrossesTwiceATurn) {
  // Clockwise about (0, -1) with radius 1, ten turns and a half.
  FreeFlight f{{0, 0}, {1, 0}, 1.0, 21 * 3.14159265358979, {}};
  f.end = motion::moved(f.position, f.velocity, f.omega, f.duration).first;
  EXPECT_EQ(all({Kind::position_y, {}, {}, 0, -0.5}, f).size(), 21u);
  EXPECT_EQ(all({Kind::position_x, {}, {}, 0, 0.25}, f).size(), 22u)
      << "the first at once, the last at the end";
  EXPECT_EQ(all({Kind::velocity_x, {}, {}, 0, 0.1}, f).size(), 21u);
  EXPECT_EQ(all({Kind::position_y, {}, {}, 0, 0.5}, f).size(), 0u);
  EXPECT_EQ(all({Kind::circle, {0, -1}, {}, 0.5, 0}, f).size(), 0u) << "concentric";
  std::vector<SurfaceCrossing> few;
  crossings({Kind::position_y, {}, {}, 0, -0.5}, f, 3, few);
  EXPECT_EQ(few.size(), 3u);
  // Going round for ever without a crossing ends.
  f.duration = 1e12;
  EXPECT_EQ(all({Kind::position_y, {}, {}, 0, 0.5}, f).size(), 0u);
}

TEST(Surface, DirectionsAlternateAndTellTheSide) {
  Cases cases;
  for (const Kind kind : {Kind::line, Kind::circle, Kind::velocity_y}) {
    for (int i = 0; i < 200; ++i) {
      const Surface s = cases.surface(kind);
      const FreeFlight f = cases.flight(3.0, 10);
      int side = surface_function(s, f.position, f.velocity) > 0 ? 1 : -1;
      for (const SurfaceCrossing& c : all(s, f)) {
        EXPECT_EQ(c.direction, -side);
        side = c.direction;
      }
    }
  }
}

// Cut anywhere, even at a crossing, a flight has the same crossings, each once.
TEST(Surface, FlightsCanBeCut) {
  Cases cases;
  for (const Kind kind : {Kind::line, Kind::circle, Kind::position_x}) {
    for (const double omega : {0.0, 0.7, -5.0}) {
      for (int i = 0; i < 200; ++i) {
        const Surface s = cases.surface(kind);
        const FreeFlight whole = cases.flight(omega, 4);
        const auto expected = all(s, whole);
        double cut = cases.in(0, 4);
        if (i % 2 == 0 && !expected.empty()) cut = expected[expected.size() / 2].time;
        const auto [position, velocity] = motion::moved(whole.position, whole.velocity, omega, cut);
        const FreeFlight first{whole.position, whole.velocity, omega, cut, position};
        const FreeFlight second{position, velocity, omega, 4 - cut, whole.end};
        const auto a = all(s, first), b = all(s, second);
        ASSERT_EQ(a.size() + b.size(), expected.size())
            << static_cast<int>(kind) << ' ' << omega << ' ' << cut;
        for (std::size_t k = 0; k < expected.size(); ++k) {
          const double t = k < a.size() ? a[k].time : cut + b[k - a.size()].time;
          EXPECT_NEAR(t, expected[k].time, 1e-6);
        }
      }
    }
  }
}

TEST(Surface, BackwardsTheSameCrossingsTurnRound) {
  Cases cases;
  for (const Kind kind : {Kind::line, Kind::segment, Kind::circle, Kind::position_y}) {
    for (int i = 0; i < 200; ++i) {
      const Surface s = cases.surface(kind);
      const FreeFlight f = cases.flight(i % 2 ? 2.0 : 0.0, 3);
      const auto [end, velocity] = motion::moved(f.position, f.velocity, f.omega, f.duration);
      const FreeFlight back{end, -velocity, -f.omega, f.duration, f.position};
      const auto there = all(s, f), again = all(s, back);
      ASSERT_EQ(there.size(), again.size());
      for (std::size_t k = 0; k < there.size(); ++k) {
        const SurfaceCrossing& other = again[again.size() - 1 - k];
        EXPECT_NEAR(there[k].time, f.duration - other.time, 1e-6);
        EXPECT_EQ(there[k].direction, -other.direction);
      }
    }
  }
}

TEST(Surface, StartsOnTheSurfaceCountToThePositiveSide) {
  const Surface x{Kind::position_x, {}, {}, 0, 0.0};
  const FreeFlight right{{0, 0}, {1, 0}, 0, 1, {1, 0}}, left{{0, 0}, {-1, 0}, 0, 1, {-1, 0}};
  ASSERT_EQ(all(x, right).size(), 1u);
  EXPECT_EQ(all(x, right).front().time, 0.0);
  EXPECT_TRUE(all(x, left).empty());
  // Onto the surface from the right: at the end; from the left: it belongs to the next flight.
  EXPECT_EQ(all(x, {{1, 0}, {-1, 0}, 0, 1, {0, 0}}).size(), 1u);
  EXPECT_TRUE(all(x, {{-1, 0}, {1, 0}, 0, 1, {0, 0}}).empty());
}

// A chord through a circle so small that its far side lies in the last digits of the way: where the
// flight comes nearest to the centre Newton's method says nothing.
TEST(Surface, ShortChordsAreAsExactAsLongOnes) {
  for (double radius = 1e-3; radius > 1e-15; radius *= 0.3) {
    const FreeFlight f{{-1, 0}, {1, 0}, 0, 3, {2, 0}};
    const auto found = all({Kind::circle, {0, 0}, {}, radius, 0}, f);
    ASSERT_EQ(found.size(), 2u) << radius;
    EXPECT_NEAR(found[0].position.x, -radius, 0x1p-52) << radius;
    EXPECT_NEAR(found[1].position.x, radius, 0x1p-52) << radius;
  }
}

TEST(BracketedRoot, LeavesNoDoubleBetweenTheSides) {
  struct Path {
    double order, zero, floor;
    int calls = 0;
    double at(double t) {
      ++calls;
      return t;
    }
    static double time(double t) { return t; }
    // t^order about the zero, with steps at its foot as rounding makes them.
    double g(double t) const {
      const double x = t - zero, y = std::copysign(std::pow(std::fabs(x), order), x);
      return floor > 0.0 ? floor * std::floor(y / floor) + (y < 0.0 ? 0.0 : 0.5 * floor) : y;
    }
    double rate(double t) const { return order * std::pow(std::fabs(t - zero), order - 1.0); }
  };
  for (const double order : {0.5, 1.0, 2.0, 3.0, 7.0})
    for (const double floor : {0.0, 1e-18, 1e-6})
      for (const double zero : {0.3, 1.0 / 3.0, 0.9999}) {
        Path path{order, zero, floor};
        const double root = events::bracketed_root(path, 0.0, 1.0);
        const bool above = path.g(root) > 0.0;
        EXPECT_TRUE(path.g(root) == 0.0 ||
                    path.g(std::nextafter(root, above ? 0.0 : 1.0)) * path.g(root) <= 0.0)
            << order << ' ' << floor << ' ' << zero;
        EXPECT_LT(path.calls, 250);
      }
  // In a plain case it is Newton's method and two points more.
  Path plain{1.0, 1.0 / 3.0, 0.0};
  EXPECT_DOUBLE_EQ(events::bracketed_root(plain, 0.0, 1.0), 1.0 / 3.0);
  EXPECT_LT(plain.calls, 6);
}

TEST(Surface, CoordinatesRunAlongIt) {
  const Surface line{Kind::line, {1, 0}, {1, 4}, 0, 0};
  EXPECT_EQ(surface_coordinates(line, {1, 3}, {0.5, 2}).s, 3.0);
  EXPECT_EQ(surface_coordinates(line, {1, 3}, {0.5, 2}).v_parallel, 2.0);
  const Surface circle{Kind::circle, {0, 0}, {}, 2, 0};
  EXPECT_NEAR(surface_coordinates(circle, {0, 2}, {-1, 5}).s, 3.14159265358979, 1e-13);
  EXPECT_NEAR(surface_coordinates(circle, {0, 2}, {-1, 5}).v_parallel, 1.0, 1e-15);
  EXPECT_EQ(surface_coordinates({Kind::position_x, {}, {}, 0, 1}, {1, 7}, {2, 3}).s, 7.0);
}

}  // namespace
}  // namespace carom
