// Arc lengths of many places have the bits of one at a time.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <random>
#include <vector>

#include "carom/geometry/arc_lengths.hpp"

namespace carom::geometry {
namespace {

TEST(ArcLengths, HaveTheBitsOfOneByOne) {
  const std::vector<CurveFrame> frames = {
      frame_of(Segment{{0.0, 0.0}, {3.0, 1.0}}), frame_of(Circle{{1.0, 2.0}, 0.7}),
      frame_of(Ellipse{{0.0, 0.0}, {2.0, 0.5}, 0.4}), frame_of(Circle{{0.0, 0.0}, 1e-3})};
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> anywhere(-0.1, 1.1);
  for (std::size_t n = 0; n < 200; ++n) {
    std::vector<std::int32_t> curve;
    std::vector<double> u;
    for (std::size_t i = 0; i < n; ++i) {
      curve.push_back(static_cast<std::int32_t>(random() % frames.size()));
      const double end = frames[random() % frames.size()].end;
      u.push_back(random() % 20 == 0 ? static_cast<double>(random() % 5) : end * anywhere(random));
    }
    const std::vector<double> lengths = arc_lengths_at(frames, curve, u);
    ASSERT_EQ(lengths.size(), n);
    for (std::size_t i = 0; i < n; ++i)
      EXPECT_EQ(std::bit_cast<std::uint64_t>(lengths[i]),
                std::bit_cast<std::uint64_t>(
                    arc_length_at(frames[static_cast<std::size_t>(curve[i])], u[i])))
          << curve[i] << " at " << u[i];
  }
}

}  // namespace
}  // namespace carom::geometry
