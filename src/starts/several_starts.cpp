// Starts of many trajectories at once.
#include <algorithm>
#include <array>
#include <cstddef>

#include "carom/base/random.hpp"
#include "carom/starts/sampler.hpp"
#include "starts/start_formulas.hpp"

namespace carom {

using geometry::Vector;
using Kind = InitialCondition::Kind;

bool Sampler::draws_free_points() const {
  const Dynamics& dynamics = system_.dynamics;
  return (system_.initial.kind == Kind::uniform || system_.initial.kind == Kind::rectangle) &&
         system_.particles.size() == 1 && system_.particles[0].speed != 0.0 &&
         !system_.of_discs() && !(dynamics.forces && dynamics.forces->external());
}

void Sampler::draw_several(const World& world, std::uint64_t first, std::span<State> states) const {
  if (!draws_free_points()) {
    for (State& state : states) state = draw(world, first++, 0);
    return;
  }
  const auto random = [&](std::uint64_t trajectory, std::uint64_t block) {
    return RandomStream(system_.run.seed, Purpose::initial_state, trajectory, 0, block);
  };
  const bool of_table = system_.initial.kind == Kind::uniform;
  const Vector low = of_table ? low_ : system_.initial.low,
               high = of_table ? high_ : system_.initial.high;
  const double speed = system_.particles[0].speed;
  constexpr std::size_t most = 64;
  std::array<RandomStream::Block, most> words;
  std::array<Vector, most> positions, directions;
  while (!states.empty()) {
    const std::size_t count = std::min(most, states.size());
    // One thing for all starts, then the next: rounds of a loop do not need each other, so that the
    // processor works on several at once.
    for (std::size_t i = 0; i < count; ++i)
      RandomStream::block(system_.run.seed, Purpose::initial_state, first + i, 0, 0, words[i]);
    for (std::size_t i = 0; i < count; ++i) {
      const auto& [right, up, x, y] = words[i];
      positions[i] =
          starts::point_of_box(low, high, RandomStream::uniform(right), RandomStream::uniform(up));
      directions[i] = {RandomStream::symmetric(x), RandomStream::symmetric(y)};
    }
    for (std::size_t i = 0; i < count; ++i)
      if (!RandomStream::in_disc(directions[i].x, directions[i].y))
        random(first + i, 1).point_in_disc(directions[i].x, directions[i].y);
    for (std::size_t i = 0; i < count; ++i) directions[i] = speed * starts::unit(directions[i]);
    for (std::size_t i = 0; i < count; ++i) {
      starts::put_off_walls(states[i], *system_.table, positions[i], directions[i]);
      // With another point the direction is another, too.
      if (!admits(world, states[i])) states[i] = draw(world, first + i, 0);
    }
    first += count;
    states = states.subspan(count);
  }
}

}  // namespace carom
