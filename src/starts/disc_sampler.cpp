// Starts of hard discs: none may overlap another.
#include <fmt/format.h>

#include "base/interrupt.hpp"
#include "carom/base/error.hpp"
#include "carom/base/random.hpp"
#include "carom/starts/sampler.hpp"
#include "forces/nearest_copy.hpp"

namespace carom {

using geometry::Vector;

namespace {

// All discs are drawn again so often until none overlap, each of them so often until it finds room.
constexpr int draws_of_all = 10'000, draws_of_one = 100'000;
// Most pairs that are compared before that is given up; those of an arrangement that is found do
// not count.
constexpr double most_pairs = 2e8;

bool overlap(const System& system, const State& a, const State& b, double reach) {
  Vector d = a.position - b.position;
  if (system.table->lattice) d = forces::nearest_copy(d, *system.table->lattice);
  return dot(d, d) < reach * reach;
}

}  // namespace

/// Draws all discs again until none overlap, so that every allowed arrangement is as likely as any
/// other. If they are too many or too large for that, places one after the other.
std::vector<State> Sampler::draw_discs(const World& world, std::uint64_t trajectory) const {
  const std::size_t count = system_.particles.size();
  base::Interrupt interrupt(&stopped_);
  double pairs = 0.0;  // of draws that did not fit
  const auto fits = [&](const std::vector<State>& placed, const State& next) {
    if (interrupt.after(200.0 + 4.0 * static_cast<double>(placed.size()))) throw SamplingStopped();
    const double radius = system_.particles[placed.size()].radius;
    for (std::size_t q = 0; q < placed.size(); ++q)
      if (overlap(system_, next, placed[q], radius + system_.particles[q].radius)) {
        pairs += static_cast<double>(q + 1);
        return false;
      }
    return true;
  };
  std::vector<RandomStream> random;
  for (std::size_t p = 0; p < count; ++p)
    random.emplace_back(system_.run.seed, Purpose::initial_state, trajectory, p);
  const auto draw_next = [&](const std::vector<State>& placed) {
    return draw_free(world, random[placed.size()], trajectory, static_cast<int>(placed.size()));
  };
  std::vector<State> states;
  if (!random_positions()) {
    while (states.size() < count) states.push_back(draw_next(states));
    return states;  // the world says which overlap
  }
  for (int draw = 0; draw < draws_of_all && pairs < 0.5 * most_pairs; ++draw) {
    states.clear();
    while (states.size() < count) {
      State next = draw_next(states);
      if (!fits(states, next)) break;
      states.push_back(next);
    }
    if (states.size() == count) return states;
  }
  for (std::int64_t attempt = patience(1, trajectory); attempt > 0; --attempt) {
    states.clear();
    pairs = 0.0;
    while (states.size() < count) {
      State next = draw_next(states);
      for (int draw = 0; draw < draws_of_one && pairs < most_pairs && !fits(states, next); ++draw)
        next = draw_next(states);
      if (!fits(states, next)) break;
      states.push_back(next);
    }
    if (states.size() == count) return states;
  }
  Place place = system_.initial.place;
  place.key = "particles.count";
  throw InputError(
      place,
      fmt::format("no room was found for disc {} of {} beside the others", states.size(), count),
      "fewer or smaller discs, or kind = \"list\" with their places");
}

}  // namespace carom
