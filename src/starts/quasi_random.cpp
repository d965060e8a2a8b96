#include "starts/quasi_random.hpp"

#include <cmath>
#include <utility>

#include "carom/base/elementary.hpp"
#include "carom/base/random.hpp"
#include "carom/events/world.hpp"
#include "carom/results/interval.hpp"
#include "carom/starts/sampler.hpp"

namespace carom {

using geometry::Vector;

namespace {

constexpr double full_turn = 6.283185307179586;
constexpr std::int64_t most_tries = 1'000'000;

bool at_home(const Table& table, const World& world, Vector position) {
  geometry::Cell cell;
  fold_into_cell(table, position, cell);
  return cell == geometry::Cell{} && world.contains(position);
}

}  // namespace

namespace starts {

QuasiRandom::QuasiRandom(std::uint64_t seed, Cover cover) : cover_(std::move(cover)) {
  for (std::uint64_t r = 0; r < replicates; ++r) sequences_.emplace_back(seed, r);
}

Sobol::Point QuasiRandom::point(std::uint64_t trajectory) const {
  return sequences_[trajectory % replicates].point(trajectory / replicates);
}

}  // namespace starts

void Sampler::prepare_quasi_random() {
  const InitialCondition& initial = system_.initial;
  if (system_.particles.size() != 1 || system_.of_discs() || !system_.injections.empty())
    throw InputError(initial.place, "quasi-random starts are those of single particles",
                     "one particle a trajectory, no discs, no injections; or kind = \"uniform\"");
  std::vector<geometry::CurveFrame> edges = frames_;
  if (system_.table->lattice)
    for (const geometry::CellEdge& edge : system_.table->lattice->edges)
      edges.push_back(geometry::frame_of(edge.segment));
  const World world(*system_.table);
  quasi_random_ = std::make_shared<starts::QuasiRandom>(
      system_.run.seed, starts::Cover({low_, high_}, edges, [&](Vector point) {
        return at_home(*system_.table, world, point);
      }));
}

// Most points of the sequence lie in the domain. One that does not is replaced by random points
// until one does: the replacement has the same distribution as the others.
State Sampler::quasi_random(const World& world, RandomStream& random, std::uint64_t trajectory,
                            double speed, bool again) const {
  const starts::Sobol::Point point = quasi_random_->point(trajectory);
  const elementary::SinCos angle = elementary::sincos(full_turn * point[2]);
  const Vector direction{angle.cos, angle.sin};
  State state;
  state.velocity = (speed / std::sqrt(dot(direction, direction))) * direction;
  const std::int64_t most = patience(most_tries, trajectory);
  for (std::int64_t tries = 0; tries < most; ++tries) {
    stop_if_asked(tries);
    const bool drawn = again || tries > 0;
    const double u = drawn ? random.uniform() : point[0], v = drawn ? random.uniform() : point[1];
    state.position = quasi_random_->cover().point(u, v);
    if (at_home(*system_.table, world, state.position)) return state;
  }
  throw InputError(system_.initial.place, "no point was found inside the table",
                   "a table with more room");
}

void refuse_quasi_random(const System& system, const char* what) {
  if (!system.quasi_random()) return;
  throw InputError(system.initial.place,
                   std::string("quasi-random starts are not independent, and the errors of ") +
                       what + " take that they are",
                   "kind = \"uniform\", the same distribution drawn at random");
}

}  // namespace carom
