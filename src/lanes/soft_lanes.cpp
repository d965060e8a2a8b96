#include "carom/lanes/soft_lanes.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "events/group.hpp"
#include "lanes/soft_engine.hpp"

namespace carom {

using lanes::SoftEngine;
using lanes::SoftPack;
using lanes::SoftTrack;
using Outcome = SoftEngine::Outcome;

namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
constexpr int steps_between_questions = 64;

}  // namespace

class SoftLanes::Implementation {
 public:
  Implementation(const Table& table, const Dynamics& dynamics, InstructionSet set, DecisionOptions options)
      : engine_(table, dynamics, set, options) {}

  bool run(const Particle& kind, std::span<Walk> walks, double t_end, std::span<const double> times,
           const Sample& sample, const std::function<bool()>& interrupted) {
    if (!(next_multiple(Time(t_end), engine_.step()) < Time(std::numeric_limits<double>::infinity())))
      throw std::invalid_argument("a last time beyond 2^52 steps");
    engine_.set_kind(kind);
    for (std::size_t first = 0; first < walks.size(); first += SoftPack::lanes) {
      const std::size_t count = std::min<std::size_t>(SoftPack::lanes, walks.size() - first);
      if (!run_pack(walks.subspan(first, count), first, t_end, times, sample, interrupted)) return false;
    }
    return true;
  }

  SoftEngine& engine() { return engine_; }

 private:
  /// Where a walk is.
  enum class Place { in_lane, on_wall, gone };

  bool run_pack(std::span<Walk> walks, std::size_t first, double t_end, std::span<const double> times,
                const Sample& sample, const std::function<bool()>& interrupted) {
    steps_ = 0;
    fill(walks);
    now_ = Time();
    std::size_t next = 0;
    for (int steps = 1;; ++steps) {
      if (interrupted && steps % steps_between_questions == 0 && interrupted()) return false;
      const Time end = next_multiple(now_, engine_.step());
      const bool last = !(end <= Time(t_end));
      const std::size_t from = next;
      while (next < times.size() && (last ? Time(times[next]) <= Time(t_end) : Time(times[next]) < end)) ++next;
      const std::span<const double> due = times.subspan(from, next - from);
      if (!due.empty()) start_ = pack_;
      // The step that ends too late is taken as well: it may meet a wall in time, or fail.
      const double duration = std::clamp(end - now_, 0.0, std::numeric_limits<double>::max());
      engine_.take_step(duration, pack_);
      engine_.find_calls(duration, pack_);
      ++steps_;
      for (std::size_t i = 0; i < due.size(); ++i) emit(walks.size(), first, from + i, due[i], sample);
      moved_.clear();
      for (std::size_t k = 0; k < walks.size(); ++k)
        if (place_[k] == Place::on_wall || (place_[k] == Place::in_lane && pack_.undecided[k]))
          leave_to_scalar(k, t_end, due,
                         [&](std::size_t i, const State& state) { sample(first + k, from + i, state); });
      if (last) break;
      for (int i = 0; i < pack_.calls; ++i) {
        const int lane = pack_.lane[i];
        if (place_[lane] == Place::in_lane && !pack_.undecided[lane]) fold(lane);
      }
      engine_.refresh(pack_, moved_);
      now_ = end;
    }
    finish(walks);
    return true;
  }

  void fill(std::span<Walk> walks) {
    pack_.count = (static_cast<int>(walks.size()) + 7) / 8 * 8;
    pack_.fresh = false;
    for (int lane = 0; lane < pack_.count; ++lane) {
      // Lanes that are left over repeat the first.
      State s = walks[at(lane) < walks.size() ? at(lane) : 0].state;
      place_[lane] = s.wall < 0 ? Place::in_lane : Place::on_wall;
      pack_.resolved[lane] = false;
      if (s.wall < 0) engine_.put(s, pack_, lane);
      tracks_[lane] = SoftTrack();
      tracks_[lane].state = s;
      if (s.wall < 0) engine_.count_start(tracks_[lane]);
      enter(lane);
    }
  }

  /// A sample of all that are decided in lanes, from where the step began.
  void emit(std::size_t count, std::size_t first, std::size_t number, double time, const Sample& sample) {
    const double since = Time(time) - now_;
    SoftPack copy = start_;
    if (since > 0.0) engine_.take_step(since, copy);
    for (std::size_t k = 0; k < count; ++k) {
      if (place_[k] != Place::in_lane || pack_.undecided[k]) continue;
      State s;
      SoftEngine::read(copy, static_cast<int>(k), time, s);
      s.cell = tracks_[k].state.cell;
      if (since > 0.0) engine_.count_sample(tracks_[k]);
      sample(first + k, number, s);
    }
  }

  void leave_to_scalar(std::size_t k, double t_end, std::span<const double> times,
                       const SoftEngine::Sample& sample) {
    const int lane = static_cast<int>(k);
    SoftTrack& track = tracks_[k];
    const bool from_lane = place_[k] == Place::in_lane;
    if (from_lane) {
      SoftEngine::read_start(pack_, lane, now_, track.state);
      const std::uint64_t steps = steps_ - 1 - entered_[lane];
      if (steps > 0) track.arc_known = false;
      engine_.count_lane(track, steps, false, pack_.fastest[lane]);
    }
    place_[k] = Place::gone;
    switch (engine_.follow(track, from_lane, t_end, times, sample)) {
      case Outcome::at_step_end:
        place_[k] = Place::in_lane;
        pack_.resolved[lane] = false;
        enter(lane);
        engine_.put(track.state, pack_, lane);
        moved_.push_back(lane);
        break;
      case Outcome::on_a_wall:
        place_[k] = Place::on_wall;
        break;
      case Outcome::over:
      case Outcome::ended:
        break;
    }
  }

  void fold(int lane) {
    State& s = tracks_[lane].state;
    SoftEngine::read(pack_, lane, now_, s);
    engine_.put(s, pack_, lane);
    engine_.count_start(tracks_[lane]);
    moved_.push_back(lane);
  }

  /// Its next step is the pack's next one.
  void enter(int lane) {
    entered_[lane] = steps_;
    pack_.fastest[lane] = 0.0;
  }

  void finish(std::span<Walk> walks) {
    for (std::size_t k = 0; k < walks.size(); ++k) {
      Walk& walk = walks[k];
      SoftTrack& track = tracks_[k];
      // The last step was tried, and is not made.
      if (place_[k] == Place::in_lane) {
        SoftEngine::read_start(pack_, static_cast<int>(k), now_, track.state);
        engine_.count_lane(track, steps_ - entered_[k], true, pack_.fastest[k]);
      }
      walk.state = track.state;
      walk.fate = track.fate;
      walk.ended = track.ended;
      walk.hits = track.hits;
      walk.last_wall = track.last_wall;
      walk.report = std::move(track.report);
      walk.steps = track.counts;
      walk.kinetic = engine_.kinetic_energy(track);
    }
  }

  SoftEngine engine_;
  SoftPack pack_, start_;
  Place place_[SoftPack::lanes] = {};
  SoftTrack tracks_[SoftPack::lanes];
  Time now_;
  std::uint64_t steps_ = 0;                      ///< that the pack has taken
  std::uint64_t entered_[SoftPack::lanes] = {};  ///< how many it had taken when the lane's own began
  std::vector<int> moved_;  ///< lanes that hold another point than their last step left there
};

std::string SoftLanes::hindrance(const Table& table, const Dynamics& dynamics) { return lanes::unknown_to_steps(table, dynamics); }

SoftLanes::SoftLanes(const Table& table, const Dynamics& dynamics, InstructionSet set, DecisionOptions options)
    : implementation_(std::make_unique<Implementation>(table, dynamics, set, options)) {}
SoftLanes::~SoftLanes() = default;
SoftLanes::SoftLanes(SoftLanes&&) noexcept = default;

void SoftLanes::limit_hits(std::uint64_t hits) { implementation_->engine().limit_hits(hits); }
DecisionCounts SoftLanes::decisions() const { return implementation_->engine().decisions(); }

bool SoftLanes::run(const Particle& kind, std::span<Walk> walks, double t_end, std::span<const double> times,
                    const Sample& sample, const std::function<bool()>& interrupted) {
  return implementation_->run(kind, walks, t_end, times, sample, interrupted);
}

}  // namespace carom
