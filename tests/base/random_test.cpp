#include "carom/base/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

namespace carom {
namespace {

using Words = std::array<std::uint64_t, 4>;

__extension__ using Wide = unsigned __int128;

// Philox4x64-10 written once more from the paper (Salmon et al. 2011, section 3.3).
Words philox(Words c, std::uint64_t k0, std::uint64_t k1) {
  for (int round = 0; round < 10; ++round) {
    const Wide a = Wide{0xd2e7470ee14c6c93u} * c[0];
    const Wide b = Wide{0xca5a826395121157u} * c[2];
    c = {static_cast<std::uint64_t>(b >> 64) ^ c[1] ^ k0, static_cast<std::uint64_t>(b),
         static_cast<std::uint64_t>(a >> 64) ^ c[3] ^ k1, static_cast<std::uint64_t>(a)};
    k0 += 0x9e3779b97f4a7c15u;
    k1 += 0xbb67ae8584caa73bu;
  }
  return c;
}

TEST(RandomStream, GivesTheKnownAnswers) {
  const Words zero = {0x16554d9eca36314cu, 0xdb20fe9d672d0fdcu, 0xd7e772cee186176bu,
                      0x7e68b68aec7ba23bu};
  EXPECT_EQ(philox({0, 0, 0, 0}, 0, 0), zero);
  const std::uint64_t ones = ~std::uint64_t{0};
  EXPECT_EQ(
      philox({ones, ones, ones, ones}, ones, ones),
      (Words{0x87b092c3013fe90bu, 0x438c3c67be8d0224u, 0x9cc7d7c69cd777b6u, 0xa09caebf594f0ba0u}));
  RandomStream stream(0, static_cast<Purpose>(0), 0, 0);
  for (const std::uint64_t word : zero) EXPECT_EQ(stream.word(), word);
}

TEST(RandomStream, IsPhiloxOfSeedPurposeTrajectoryDrawAndParticle) {
  const std::uint64_t seed = 0x0123456789abcdefu, trajectory = 987654321987u, particle = 17;
  RandomStream stream(seed, Purpose::injection, trajectory, particle);
  for (std::uint64_t block = 0; block < 10; ++block) {
    for (const std::uint64_t word : philox({trajectory, block, particle, 0}, seed, 2)) {
      EXPECT_EQ(stream.word(), word);
    }
  }
}

TEST(RandomStream, BeginsWithAnyBlock) {
  RandomStream all(3, Purpose::initial_state, 4, 5);
  for (std::uint64_t number = 0; number < 10; ++number) {
    RandomStream from(3, Purpose::initial_state, 4, 5, number);
    RandomStream::Block words;
    RandomStream::block(3, Purpose::initial_state, 4, 5, number, words);
    for (const std::uint64_t word : words) {
      EXPECT_EQ(word, all.word());
      EXPECT_EQ(word, from.word());
    }
  }
}

TEST(RandomStream, StreamsDiffer) {
  std::set<std::uint64_t> firsts;
  for (std::uint64_t i = 0; i < 100; ++i) {
    firsts.insert(RandomStream(i, Purpose::initial_state, 0).word());
    firsts.insert(RandomStream(0, Purpose::initial_state, i + 1).word());
    firsts.insert(RandomStream(0, Purpose::initial_state, 0, i + 1).word());
    firsts.insert(RandomStream(i, Purpose::splitting, 0).word());
  }
  EXPECT_EQ(firsts.size(), 400u);
}

TEST(RandomStream, UniformIsTheUpper53Bits) {
  RandomStream words(5, Purpose::initial_state, 6), stream(5, Purpose::initial_state, 6);
  double sum = 0;
  for (int i = 0; i < 100000; ++i) {
    const double u = stream.uniform();
    ASSERT_EQ(u, static_cast<double>(words.word() >> 11) / 9007199254740992.0);
    ASSERT_TRUE(u >= 0.0 && u < 1.0);
    sum += u;
  }
  EXPECT_NEAR(sum / 100000, 0.5, 5 / std::sqrt(12.0 * 100000));
}

TEST(RandomStream, SymmetricIsOddMultiplesOfTheSpacing) {
  RandomStream stream(7, Purpose::initial_state, 8);
  double sum = 0;
  for (int i = 0; i < 100000; ++i) {
    const double u = stream.symmetric();
    const double multiple = u * 0x1p53;  // an odd integer below 2^53
    ASSERT_EQ(std::fabs(std::fmod(multiple, 2.0)), 1.0);
    ASSERT_LT(std::fabs(u), 1.0);
    sum += u;
  }
  EXPECT_NEAR(sum / 100000, 0.0, 5 / std::sqrt(3.0 * 100000));
}

TEST(RandomStream, PointsFillTheDiscEvenly) {
  RandomStream stream(9, Purpose::initial_state, 10);
  const int n = 100000;
  double x_sum = 0, y_sum = 0, square_sum = 0;
  int inner = 0;
  std::array<int, 8> octants{};
  for (int i = 0; i < n; ++i) {
    double x = 0, y = 0;
    stream.point_in_disc(x, y);
    const double square = x * x + y * y;
    ASSERT_TRUE(square > 0.0 && square < 1.0);
    x_sum += x;
    y_sum += y;
    square_sum += square;
    inner += square < 0.5 ? 1 : 0;
    ++octants[(x < 0 ? 1u : 0u) + (y < 0 ? 2u : 0u) + (std::fabs(x) < std::fabs(y) ? 4u : 0u)];
  }
  const double root = std::sqrt(static_cast<double>(n));
  EXPECT_NEAR(x_sum / n, 0.0, 5 * 0.5 / root);
  EXPECT_NEAR(y_sum / n, 0.0, 5 * 0.5 / root);
  EXPECT_NEAR(square_sum / n, 0.5, 5 * std::sqrt(1.0 / 12) / root);
  EXPECT_NEAR(inner, n / 2.0, 5 * 0.5 * root);
  for (const int count : octants) EXPECT_NEAR(count, n / 8.0, 5 * std::sqrt(7.0 / 64) * root);
}

// How many words a point takes is part of "the same bits on every machine".
TEST(RandomStream, PointsTakeAFixedNumberOfWords) {
  RandomStream stream(1, Purpose::initial_state, 0);
  double x = 0, y = 0;
  for (int i = 0; i < 1000; ++i) stream.point_in_disc(x, y);
  RandomStream words(1, Purpose::initial_state, 0);
  const std::uint64_t next = stream.word();
  int drawn = 0;
  while (words.word() != next) ++drawn;
  EXPECT_EQ(drawn, 2568);  // 8/pi each
}

}  // namespace
}  // namespace carom
