// Tables and particles made by hand are asked what those from files are.
#include <gtest/gtest.h>

#include <stdexcept>

#include "carom/base/error.hpp"
#include "carom/events/world.hpp"
#include "recorder.hpp"

namespace carom {
namespace {

using geometry::Vector;

/// The unit square with a ceiling that bulges outwards, about a centre so many chords away.
Table with_ceiling(double offset) {
  return tests::loop({geometry::Segment{{0, 0}, {1, 0}}, geometry::Segment{{1, 0}, {1, 1}},
                      geometry::CircularArc{{1, 1}, {0, 1}, offset, true},
                      geometry::Segment{{0, 1}, {0, 0}}});
}

TEST(ByHand, FlatArcsAreRefused) {
  const Table bent = with_ceiling(1e4), flat = with_ceiling(1e5);
  EXPECT_NO_THROW(World{bent});
  EXPECT_THROW(World{flat}, InputError);
}

TEST(ByHand, ScalesAreThoseOfDecisions) {
  const Table square = tests::square();
  World world(square);
  const auto add = [&](double speed, double omega) {
    world.add(tests::particle(omega, speed), tests::start({0.5, 0.5}, {speed, 0}));
  };
  for (const double speed : {0x1p-199, 1.0, 0x1p199}) EXPECT_NO_THROW(add(speed, 0.0)) << speed;
  for (const double speed : {0x1p-201, 0x1p201})
    EXPECT_THROW(add(speed, 0.0), std::invalid_argument) << speed;
  EXPECT_THROW(add(1.0, 0x1p-201), std::invalid_argument);
  const Table ellipse = tests::loop({geometry::Ellipse{{0.5, 0.5}, {1, 0}, 0.75, true}});
  World round(ellipse);
  EXPECT_THROW(round.add(tests::particle(1.0, 0x1p62), tests::start({0.5, 0.5}, {0x1p62, 0})),
               std::invalid_argument);
  EXPECT_EQ(world.size(), 3);
}

}  // namespace
}  // namespace carom
