#include "orbits/itinerary.hpp"

#include <cmath>

#include "carom/base/elementary.hpp"

namespace carom::orbits {

using geometry::Vector;

namespace {

// Is the word the first of its rotations, and different from all others?
bool is_least_rotation(const std::vector<int>& word) {
  const std::size_t n = word.size();
  for (std::size_t shift = 1; shift < n; ++shift)
    for (std::size_t i = 0; i <= n; ++i) {
      if (i == n) return false;
      const int other = word[(i + shift) % n];
      if (word[i] < other) break;
      if (word[i] > other) return false;
    }
  return true;
}

bool grow(std::vector<int>& word, int letters, std::size_t length,
          const std::function<bool(const std::vector<int>&)>& each) {
  if (word.size() == length)
    return word.front() == word.back() || !is_least_rotation(word) || each(word);
  // No letter of a least rotation is before its first one.
  for (int next = word.empty() ? 0 : word.front(); next < letters; ++next) {
    if (!word.empty() && next == word.back()) continue;
    word.push_back(next);
    const bool more = grow(word, letters, length, each);
    word.pop_back();
    if (!more) return false;
  }
  return true;
}

}  // namespace

bool for_each_word(int letters, std::size_t length,
                   const std::function<bool(const std::vector<int>&)>& each) {
  std::vector<int> word;
  return grow(word, letters, length, each);
}

Chain chain_of_word(const Boundary& boundary, const std::vector<int>& word) {
  const std::size_t n = word.size();
  const auto centre = [&](std::size_t i) {
    return boundary.frames[static_cast<std::size_t>(word[i % n])].middle;
  };
  const auto unit = [](Vector v) { return (1.0 / std::sqrt(dot(v, v))) * v; };
  Chain chain;
  for (std::size_t i = 0; i < n; ++i) {
    const geometry::CurveFrame& frame = boundary.frames[static_cast<std::size_t>(word[i])];
    const Vector here = centre(i);
    // Towards the bisector of the neighbours. Never back to back: then one of them is as good.
    const Vector one = unit(centre(i + 1) - here), two = unit(centre(i + n - 1) - here);
    Vector towards = one + two;
    towards = dot(towards, towards) > 0.0 ? unit(towards) : one;
    Link link;
    link.wall = word[i];
    link.u = geometry::parameter_of(frame, here + frame.major * towards);
    chain.push_back(link);
  }
  const double k = std::abs(boundary.flight_curvature());
  if (k == 0.0) return chain;
  const ChainGeometry g = geometry_of(boundary, chain);
  for (std::size_t i = 0; i < n; ++i) {
    const double sine = 0.5 * k * g.flights[i].chord;
    if (!(sine < 1.0)) return {};
    chain[i].half_turn = elementary::atan2(sine, std::sqrt((1.0 - sine) * (1.0 + sine)));
  }
  return chain;
}

}  // namespace carom::orbits
