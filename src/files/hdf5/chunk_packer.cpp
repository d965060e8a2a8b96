#include "files/hdf5/chunk_packer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace carom::files::hdf5 {

namespace {

constexpr std::size_t widest = 8;

// What some rows say of all: is it worth while to deflate the bytes at each place of a value (a
// plane), and is it better to leave values whole, as they are often the one before?
struct Plan {
  bool deflated[widest];
  bool whole;
};

double information(double count) { return count > 0.0 ? count * std::log2(count) : 0.0; }

Plan plan_of(const std::uint8_t* values, std::size_t count, std::size_t size) {
  constexpr std::size_t some = 512;
  static const auto informations = [] {
    std::array<double, some + 1> made{};
    for (std::size_t i = 0; i <= some; ++i) made[i] = information(static_cast<double>(i));
    return made;
  }();
  std::uint16_t counts[widest][256] = {};
  std::size_t same[widest] = {}, like_before = 0, seen = 0;
  const std::size_t step = std::max<std::size_t>(1, count / some);
  for (std::size_t row = step; row < count && seen < some; row += step, ++seen) {
    const std::uint8_t *at = values + row * size, *before = at - size;
    bool middle = true;
    for (std::size_t k = 0; k < size; ++k) {
      const bool equal = at[k] == before[k];
      ++counts[k][at[k]];
      same[k] += equal;
      middle = middle && (equal || k == 0 || k == widest - 1);
    }
    like_before += middle;
  }
  // Bytes that a value takes, one way and the other: a copy takes about one.
  const auto n = static_cast<double>(std::max<std::size_t>(seen, 1));
  Plan plan{};
  double by_planes = 0.0;
  for (std::size_t k = 0; k < size; ++k) {
    double bits = informations[seen];
    for (const std::uint16_t often : counts[k]) bits -= informations[often];
    bits /= n;
    // Some hundred bytes like noise have 7.6 bits, not 8.
    const double changes = 1.0 - static_cast<double>(same[k]) / n;
    plan.deflated[k] = changes < 0.25 || bits <= 7.4;
    by_planes += plan.deflated[k] ? std::min(bits / 8.0, 2.0 * changes) : 1.0;
  }
  const double copied = static_cast<double>(like_before) / n;
  plan.whole = size == widest && 8.0 * (1.0 - copied) + copied < by_planes;
  return plan;
}

#if __has_builtin(__builtin_shufflevector)
#define CAROM_SHUFFLES
#endif

// Sixteen rows are `size` vectors. The index of a byte in them has the bits r3 r2 r1 r0 of its row,
// then those of its place in the value. Laying the two halves of the vectors together, byte by
// byte, turns these bits round by one; after four times the row's are the last.
template <std::size_t size>
void shuffle(const std::uint8_t* values, std::size_t count, std::uint8_t* planes) {
  std::size_t row = 0;
#ifdef CAROM_SHUFFLES
  using Sixteen = std::uint8_t __attribute__((vector_size(16)));
  for (; size > 1 && row + 16 <= count; row += 16) {
    Sixteen now[size], next[size];
    std::memcpy(now, values + row * size, sizeof now);
    for (int turn = 0; turn < 4; ++turn) {
      for (std::size_t j = 0; j < size / 2; ++j) {
        const Sixteen a = now[j], b = now[j + size / 2];
        next[2 * j] =
            __builtin_shufflevector(a, b, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
        next[2 * j + 1] = __builtin_shufflevector(a, b, 8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13,
                                                  29, 14, 30, 15, 31);
      }
      std::memcpy(now, next, sizeof now);
    }
    for (std::size_t k = 0; k < size; ++k) std::memcpy(planes + k * count + row, &now[k], 16);
  }
#endif
  for (; row < count; ++row)
    for (std::size_t k = 0; k < size; ++k) planes[k * count + row] = values[row * size + k];
}

void shuffle(std::size_t size, const std::uint8_t* values, std::size_t count,
             std::uint8_t* planes) {
  switch (size) {
    case 1:
      return shuffle<1>(values, count, planes);
    case 2:
      return shuffle<2>(values, count, planes);
    case 4:
      return shuffle<4>(values, count, planes);
    default:
      return shuffle<8>(values, count, planes);
  }
}

}  // namespace

ChunkPacker::Packed ChunkPacker::pack(std::span<const std::uint8_t> values, std::size_t size) {
  const std::size_t count = values.size() / size;
  const Plan plan = plan_of(values.data(), count, size);
  deflate_.start();
  if (plan.whole) {
    deflate_.deflate(values);
    return {deflate_.finish(values), false};
  }
  planes_.resize(values.size());
  shuffle(size, values.data(), count, planes_.data());
  for (std::size_t k = 0; k < size; ++k) {
    const std::span<const std::uint8_t> plane(planes_.data() + k * count, count);
    plan.deflated[k] ? deflate_.deflate(plane) : deflate_.store(plane);
  }
  return {deflate_.finish(planes_), true};
}

}  // namespace carom::files::hdf5
