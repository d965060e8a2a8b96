// The flattest arcs that tables may have: hits lie on them to 2^-16 of their sagitta.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"
#include "geometry/quad.hpp"
#include "random_tables.hpp"

namespace carom {
namespace {

using tests::Dice;
using tests::Quad;
using tests::QuadVector;

/// A square of that side, from (at, at), whose floor bulges by a part of its side.
std::string table(double side, double at, double bulge, const char* ellipse) {
  char text[600];
  const double end = at + side, middle = at + 0.5 * side, dip = at - bulge * side;
  std::snprintf(text, sizeof text,
                "[table]\nshape = \"path\"\n[[table.loop]]\nstart = [\"%.17g\", \"%.17g\"]\n"
                "pieces = [{%s_via = [\"%.17g\", \"%.17g\"], %s_to = [\"%.17g\", \"%.17g\"]%s, "
                "name = \"floor\"}, {line_to = [\"%.17g\", \"%.17g\"]},\n"
                "{line_to = [\"%.17g\", \"%.17g\"]}, {line_to = [\"%.17g\", \"%.17g\"]}]\n",
                at, at, *ellipse ? "ellipse" : "arc", middle, dip, *ellipse ? "ellipse" : "arc",
                end, at, ellipse, end, end, at, end, at, at);
  return text;
}

std::string fault(const std::string& text) {
  try {
    read_system(text, "flat");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

struct Distances : Observer {
  explicit Distances(const geometry::Curve& curve) : floor(curve) {
    const QuadVector chord = floor.to - floor.from;
    const double sine = double(metric(chord) / metric(floor.a)) / 4.0;
    sagitta = sine / (1.0 + std::sqrt(1.0 - sine));
  }
  Quad metric(const QuadVector& e) const { return floor.metric(e, e); }
  void hit(const HitEvent& event) override {
    if (event.wall != 0) return;
    const Quad off = metric(tests::quad(event.position) - floor.centre) / metric(floor.a) - Quad(1);
    worst = std::max(worst, 0.5 * std::fabs(double(off)) / sagitta);
    ++hits;
  }
  tests::QuadCurve floor;
  double sagitta = 0.0, worst = 0.0;
  long hits = 0;
};

TEST(FlatArcs, HitsLieOnTheFlattestThatAreTaken) {
  Dice dice(5);
  for (const char* ellipse :
       {"", ", ellipse_ratio = \"1/2\"", ", ellipse_ratio = 3, ellipse_angle = \"0.3\""}) {
    for (const double side : {1.0, 1e-9}) {
      for (const double away : {-0.5, 1000.0}) {
        // The flattest one, by halving.
        double taken = 0.05, refused = 1e-16;
        const double at = away * side;
        ASSERT_EQ(fault(table(side, at, taken, ellipse)), "") << ellipse;
        ASSERT_NE(fault(table(side, at, refused, ellipse)), "");
        while (taken > 1.2 * refused) {
          const double middle = std::sqrt(taken * refused);
          (fault(table(side, at, middle, ellipse)).empty() ? taken : refused) = middle;
        }
        double worst = 0.0;
        for (const double omega : {0.0, 0.9, -3.0}) {
          const System system = read_system(table(side, at, taken, ellipse), "flat").system;
          World world(*system.table);
          for (int k = 0; k < 8; ++k) {
            Distances seen(system.table->walls[0].curve);
            Particle particle;
            State start;
            start.position = {at + side * dice.between(0.01, 0.99),
                              at + side * dice.between(0.01, 0.99)};
            start.velocity = dice.direction();
            particle.speed = std::sqrt(dot(start.velocity, start.velocity));
            particle.omega = omega * particle.speed / side;
            world.clear();
            world.limit_hits(100);
            const int i = world.add(particle, start);
            world.run_until(1e3 * side, seen);
            EXPECT_NE(world.fate(i), Fate::lost) << world.report(i);
            worst = std::max(worst, seen.worst);
          }
        }
        EXPECT_LT(worst, 0x1p-16) << ellipse << " side " << side << " at " << away;
        EXPECT_GT(worst, 0x1p-22) << ellipse << " side " << side << " at " << away;
      }
    }
  }
}

TEST(FlatArcs, FlatterOnesAreRefusedByName) {
  const std::string text = fault(table(1.0, 0.0, 1e-9, ""));
  EXPECT_NE(text.find("'floor'"), std::string::npos) << text;
  EXPECT_EQ(fault(table(1.0, 0.0, 1e-5, "")), "");
}

}  // namespace
}  // namespace carom
