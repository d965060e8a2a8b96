#include "analyses/orbits/close_returns.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "carom/analyses/run.hpp"
#include "carom/engines/engine.hpp"

namespace carom::analyses {

using geometry::Vector;
using orbits::Boundary;
using orbits::Chain;
using orbits::Link;

namespace {

struct Recurrence {
  double distance;
  std::uint64_t trajectory;
  Chain chain;
  bool operator<(const Recurrence& o) const {
    return std::pair(distance, trajectory) < std::pair(o.distance, o.trajectory);
  }
};

std::vector<int> least_rotation(const Boundary& boundary, const Chain& chain) {
  std::vector<int> word, least;
  for (const Link& link : chain)
    word.push_back(boundary.curves[static_cast<std::size_t>(link.wall)]);
  least = word;
  for (std::size_t i = 1; i < word.size(); ++i) {
    std::rotate(word.begin(), word.begin() + 1, word.end());
    least = std::min(least, word);
  }
  return least;
}

// Keeps the hits of trajectories under way, and the closest recurrences of those that have ended.
class Recurrences : public Listener {
 public:
  Recurrences(const Boundary& boundary, const CloseReturnPlan& plan)
      : boundary_(boundary), plan_(plan), of_length_(plan.most_hits + 1) {}

  void begin(const Trajectory& t) override {
    if (states_.size() <= t.slot) states_.resize(t.slot + 1);
    states_[t.slot].assign(1, t.starts.front());
  }
  void hit(const Trajectory& t, int, const State& state, std::uint64_t hits) override {
    // A corner counts several hits, and no orbit through it is looked for.
    if (hits == states_[t.slot].size()) states_[t.slot].push_back(state);
  }
  void end(const Trajectory& t, const TrajectoryEnd&) override {
    if (plan_.progress) plan_.progress(++ended_, plan_.starts);
    const std::vector<State>& states = states_[t.slot];
    for (std::size_t n = plan_.fewest_hits; n < states.size(); ++n)
      if (curve_of(states[n]) == curve_of(states[0])) add(t.number, states, n);
  }

  /// In turn the closest, second closest … of each sequence of walls.
  std::vector<Chain> chains() {
    std::vector<Chain> all;
    for (auto& words : of_length_) {
      std::uint64_t left = plan_.tries;
      for (auto& [word, list] : words) std::sort(list.begin(), list.end());
      for (std::size_t rank = 0; left > 0; ++rank) {
        bool any = false;
        for (auto& [word, list] : words) {
          if (rank >= list.size() || left == 0) continue;
          all.push_back(std::move(list[rank].chain));
          any = true;
          --left;
        }
        if (!any) break;
      }
    }
    return all;
  }

 private:
  int curve_of(const State& s) const { return boundary_.curves[static_cast<std::size_t>(s.wall)]; }
  void add(std::uint64_t trajectory, const std::vector<State>& states, std::size_t n) {
    const Vector apart = (1.0 / boundary_.size) * (states[n].position - states[0].position);
    const Vector turned =
        (1.0 / boundary_.particle.speed) * (states[n].velocity - states[0].velocity);
    const double distance = dot(apart, apart) + dot(turned, turned);
    Chain chain;
    for (std::size_t i = 0; i < n; ++i) {
      const State &from = states[i], &to = states[i + 1];
      Link link;
      link.wall = from.wall;
      link.u = from.u;
      link.half_turn =
          0.5 * std::abs(boundary_.particle.omega) * (to.time.value() - from.time.value());
      link.step = {to.cell.first - from.cell.first, to.cell.second - from.cell.second};
      chain.push_back(link);
    }
    std::vector<Recurrence>& list = of_length_[n][least_rotation(boundary_, chain)];
    list.push_back({distance, trajectory, std::move(chain)});
    if (list.size() < 2 * plan_.tries) return;
    const auto last = list.begin() + static_cast<std::ptrdiff_t>(plan_.tries);
    std::nth_element(list.begin(), last, list.end());
    list.erase(last, list.end());
  }

  const Boundary& boundary_;
  const CloseReturnPlan& plan_;
  std::uint64_t ended_ = 0;
  std::vector<std::vector<State>> states_;  ///< by slot
  std::vector<std::map<std::vector<int>, std::vector<Recurrence>>> of_length_;
};

}  // namespace

std::vector<Chain> close_returns(const System& system, const Boundary& boundary,
                                 const CloseReturnPlan& plan,
                                 const std::function<bool()>& stopped) {
  System from_walls = system;
  from_walls.initial = {};
  from_walls.initial.kind = InitialCondition::Kind::boundary;
  from_walls.run.collisions = plan.most_hits;
  from_walls.run.t_max = no_last_time;
  const Sampler sampler(from_walls, stopped);
  DrawnStarts starts(sampler, TrajectoryRange{0, plan.starts});
  Recurrences listener(boundary, plan);
  make_engine(from_walls, {.t_end = no_last_time, .hits = true})->run(starts, listener, stopped);
  return listener.chains();
}

}  // namespace carom::analyses
