#include "carom/lanes/soft_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <utility>

#include "events/step/group.hpp"
#include "lanes/soft/soft_engine.hpp"

namespace carom {

using lanes::SoftEngine;
using lanes::SoftPack;
using lanes::SoftTrack;
using Outcome = SoftEngine::Outcome;

namespace {

constexpr int steps_between_questions = 64;

bool alike(const Particle& a, const Particle& b) {
  return a.mass == b.mass && a.charge == b.charge && a.omega == b.omega;
}

}  // namespace

// Every lane has a clock of its own. The times of two step ends differ by the step exactly: k *
// step is held without error in two doubles, and so is the difference of the low ones. So all lanes
// take the same step.
class SoftLanes::Implementation {
 public:
  Implementation(const Table& table, const Dynamics& dynamics, const Particle& kind,
                 InstructionSet set, DecisionOptions options)
      : engine(table, dynamics, set, options), kind_(kind) {
    engine.set_kind(kind);
  }

  void run_until(double t_end, const std::function<bool(LaneStart&)>& next,
                 const std::function<void(const LaneEnd&)>& ended,
                 const std::function<bool()>& interrupted) {
    begin(t_end, next, ended);
    for (std::uint64_t sweep = 1; busy_ > 0; ++sweep) {
      if (interrupted && sweep % steps_between_questions == 0 && interrupted()) return;
      const bool samples = soonest_sample_ <= next_;
      if (samples) start_ = pack_;
      engine.take_step(engine.step(), pack_);
      engine.find_calls(engine.step(), pack_);
      ++next_;
      if (samples) sample();
      effort.steps += static_cast<std::uint64_t>(pack_.count);
      effort.idle += static_cast<std::uint64_t>(pack_.count - busy_);
      effort.hits += static_cast<std::uint64_t>(busy_);
      moved_.clear();
      for (int i = 0; i < pack_.calls; ++i) {
        const int lane = pack_.lane[i];
        if (!active_[lane]) continue;
        if (pack_.undecided[lane])
          leave_to_scalar(lane);
        else if (last_step_[lane] >= next_)
          fold(lane);
      }
      if (soonest_ < next_) end_in_time();
      if (exhausted_ && busy_ < used_) close_ranks();
      engine.refresh(pack_, moved_);
    }
  }

  /// Increasing times.
  void sample_at(std::vector<double> times, Sampled sampled) {
    times_ = std::move(times);
    sampled_ = std::move(sampled);
  }
  void report_hits(Hit hit) {
    engine.report_hits([this, hit = std::move(hit)](const SoftTrack& track) {
      return hit(starts_[&track - tracks_].tag, track.state, track.hits);
    });
  }

  SoftEngine engine;
  LaneEffort effort;

 private:
  void begin(double t_end, const std::function<bool(LaneStart&)>& next,
             const std::function<void(const LaneEnd&)>& ended) {
    source_ = &next;
    sink_ = &ended;
    t_end_ = t_end;
    // Steps that end in time; the one after them may still meet a wall. The count is capped far
    // beyond what any run takes.
    whole_ = step_with(Time(t_end));
    step_of_.clear();
    for (const double t : times_) step_of_.push_back(step_with(Time(t)));
    next_ = 0;
    soonest_ = soonest_sample_ = never;
    exhausted_ = false;
    busy_ = 0;
    pack_.fresh = false;
    used_ = SoftPack::lanes;
    for (int lane = 0; lane < SoftPack::lanes; ++lane) {
      active_[lane] = false;
      fill(lane);
    }
    close_ranks();
  }

  /// The step of a trajectory that is under way at a time, or begins then.
  std::uint64_t step_with(const Time& t) const {
    double number = std::fmin(std::floor(t.value() / engine.step()), 0x1p52);
    while (number > 0.0 && events::multiple(number, engine.step()) > t) number -= 1.0;
    while (number < 0x1p52 && events::multiple(number + 1.0, engine.step()) <= t) number += 1.0;
    return static_cast<std::uint64_t>(number);
  }
  /// When the step that the pack has just taken began in a lane.
  Time before(int lane) const {
    return events::multiple(static_cast<double>(whole_ - (last_step_[lane] + 1 - next_)),
                            engine.step());
  }

  /// Begins the next trajectory that lanes can go on with.
  void fill(int lane) {
    leave(lane);
    while (!exhausted_) {
      LaneStart& start = starts_[lane];
      if (!(*source_)(start)) {
        exhausted_ = true;
        return;
      }
      if (!alike(start.particle, kind_))
        throw std::invalid_argument("a particle that is accelerated otherwise");
      tracks_[lane] = SoftTrack();
      tracks_[lane].state = start.state;
      tracks_[lane].hits = start.hits;
      reported_[lane] = 0;
      if (start.state.wall >= 0) {
        if (follow(lane, false)) return;
        continue;
      }
      engine.count_start(tracks_[lane]);
      resume(lane, 0.0);
      return;
    }
  }

  /// Goes on in its lane from the track's state after that many steps.
  bool resume(int lane, double steps) {
    pack_.resolved[lane] = false;
    entered_[lane] = next_;
    pack_.fastest[lane] = 0.0;
    engine.put(tracks_[lane].state, pack_, lane);
    last_step_[lane] = next_ + (whole_ - static_cast<std::uint64_t>(steps));
    soonest_ = std::min(soonest_, last_step_[lane]);
    await_sample(lane);
    moved_.push_back(lane);
    if (!active_[lane]) ++busy_;
    active_[lane] = true;
    return true;
  }

  /// The pack's step that is under way in a lane at its next report time.
  std::uint64_t sample_step(int lane) const {
    const std::size_t next = reported_[lane];
    return next < times_.size() && times_[next] <= t_end_
               ? last_step_[lane] - whole_ + step_of_[next]
               : never;
  }
  void await_sample(int lane) { soonest_sample_ = std::min(soonest_sample_, sample_step(lane)); }

  /// Reports all that the step just taken has decided in lanes. Lanes that are together in time are
  /// stepped to it together.
  void sample() {
    soonest_sample_ = never;
    for (int first = 0; first < used_; ++first) {
      while (is_due(first)) {
        const double since = Time(times_[reported_[first]]) - before(first);
        SoftPack there;
        there.fresh = start_.fresh;
        int lanes[SoftPack::lanes], count = 0;
        for (int lane = first; lane < used_; ++lane)
          if (is_due(lane) && Time(times_[reported_[lane]]) - before(lane) == since)
            lanes[count++] = lane;
        there.count = (count + 7) / 8 * 8;
        for (int i = 0; i < there.count; ++i)
          SoftEngine::copy(start_, lanes[i < count ? i : 0], there, i);
        if (since > 0.0) engine.take_step(since, there);
        for (int i = 0; i < count; ++i) {
          const int lane = lanes[i];
          State s;
          SoftEngine::read(there, i, times_[reported_[lane]], s);
          s.cell = tracks_[lane].state.cell;
          if (since > 0.0) engine.count_sample(tracks_[lane]);
          sampled_(starts_[lane].tag, reported_[lane]++, s);
        }
      }
      if (active_[first] && !pack_.undecided[first]) await_sample(first);
    }
  }
  bool is_due(int lane) const {
    return active_[lane] && !pack_.undecided[lane] && sample_step(lane) < next_;
  }

  void leave_to_scalar(int lane) {
    --effort.hits;
    SoftTrack& track = tracks_[lane];
    SoftEngine::read_start(pack_, lane, before(lane), track.state);
    const std::uint64_t steps = next_ - 1 - entered_[lane];
    if (steps > 0) track.arc_known = false;
    engine.count_lane(track, steps, false, pack_.fastest[lane]);
    if (!follow(lane, true)) fill(lane);
  }

  /// The scalar engine's steps, until lanes can go on; false if the trajectory ends.
  bool follow(int lane, bool from_lane) {
    SoftTrack& track = tracks_[lane];
    for (;; from_lane = false) {
      ++effort.scalar;
      // Those until its step ends.
      const std::uint64_t step = step_with(track.state.time);
      std::size_t due = reported_[lane];
      while (due < times_.size() && step_of_[due] <= step && times_[due] <= t_end_) ++due;
      const auto sample = [&](std::size_t, const State& s) {
        sampled_(starts_[lane].tag, reported_[lane]++, s);
      };
      switch (engine.follow(track, from_lane, t_end_,
                            std::span(times_).subspan(reported_[lane], due - reported_[lane]),
                            sample)) {
        case Outcome::at_step_end:
          return resume(lane, std::nearbyint(track.state.time.value() / engine.step()));
        case Outcome::on_a_wall:
          continue;
        case Outcome::over:
        case Outcome::ended:
          break;
      }
      report(lane);
      return false;
    }
  }

  /// Ends the lanes whose step ends too late and meets nothing.
  void end_in_time() {
    for (int lane = 0; lane < used_; ++lane) {
      if (!active_[lane] || last_step_[lane] >= next_) continue;
      SoftEngine::read_start(pack_, lane, before(lane), tracks_[lane].state);
      engine.count_lane(tracks_[lane], next_ - entered_[lane], true, pack_.fastest[lane]);
      report(lane);
      fill(lane);
    }
    soonest_ = never;
    for (int lane = 0; lane < used_; ++lane)
      if (active_[lane]) soonest_ = std::min(soonest_, last_step_[lane]);
  }

  void report(int lane) {
    const SoftTrack& t = tracks_[lane];
    (*sink_)({starts_[lane].tag, t.fate, t.finished ? t.ended : t.state.time, t.state, t.hole,
              t.hits, t.last_wall, t.report, t.counts, engine.kinetic_energy(t)});
  }

  void leave(int lane) {
    if (active_[lane]) --busy_;
    active_[lane] = false;
  }

  void fold(int lane) {
    State& s = tracks_[lane].state;
    SoftEngine::read(pack_, lane, s.time, s);
    engine.put(s, pack_, lane);
    engine.count_start(tracks_[lane]);
    moved_.push_back(lane);
  }

  /// The last trajectories side by side, so that lanes without any need not be stepped.
  void close_ranks() {
    for (int lane = 0; lane < used_; ++lane) {
      if (active_[lane]) continue;
      while (used_ > lane && !active_[used_ - 1]) --used_;
      if (used_ <= lane) break;
      const int last = --used_;
      for (double* q : {pack_.x, pack_.y, pack_.vx, pack_.vy, pack_.ax, pack_.ay, pack_.fastest})
        q[lane] = q[last];
      pack_.resolved[lane] = pack_.resolved[last];
      starts_[lane] = starts_[last];
      reported_[lane] = reported_[last];
      tracks_[lane] = std::move(tracks_[last]);
      last_step_[lane] = last_step_[last];
      entered_[lane] = entered_[last];
      active_[lane] = true;
      active_[last] = false;
      for (int& moved : moved_)
        if (moved == last) moved = lane;
    }
    pack_.count = (used_ + 7) / 8 * 8;
    for (int lane = used_; lane < pack_.count; ++lane) pack_.resolved[lane] = pack_.resolved[0];
    for (int lane = used_; lane < pack_.count; ++lane)
      for (double* q : {pack_.x, pack_.y, pack_.vx, pack_.vy, pack_.ax, pack_.ay}) q[lane] = q[0];
  }

  static constexpr std::uint64_t never = ~std::uint64_t{0};

  Particle kind_;
  const std::function<bool(LaneStart&)>* source_ = nullptr;
  const std::function<void(const LaneEnd&)>* sink_ = nullptr;
  double t_end_ = 0.0;
  std::uint64_t whole_ = 0;  ///< steps of a trajectory that ends in time
  SoftPack pack_, start_;
  std::vector<double> times_;           ///< to report at
  std::vector<std::uint64_t> step_of_;  ///< of each, by the trajectory's own steps
  Sampled sampled_;
  std::size_t reported_[SoftPack::lanes] = {};  ///< times
  std::uint64_t soonest_sample_ = never;        ///< the first of the pack's steps that holds one
  LaneStart starts_[SoftPack::lanes];
  SoftTrack tracks_[SoftPack::lanes];
  bool active_[SoftPack::lanes] = {};
  std::uint64_t next_ = 0;  ///< number of the pack's next step
  std::uint64_t last_step_[SoftPack::lanes] =
      {};  ///< the pack's step that ends too late for the lane
  std::uint64_t entered_[SoftPack::lanes] =
      {};  ///< number of the pack's step that was the lane's first since it began, or came back
  std::uint64_t soonest_ = never;  ///< the first of them
  int used_ = 0, busy_ = 0;
  bool exhausted_ = false;
  std::vector<int> moved_;  ///< lanes that hold another point than their last step left there
};

std::string SoftLanes::hindrance(const Table& table, const Dynamics& dynamics,
                                 const std::vector<Particle>& particles) {
  if (particles.empty()) return "there are no particles";
  const std::string unknown = lanes::unknown_to_steps(table, dynamics);
  if (!unknown.empty()) return unknown;
  const bool all = std::all_of(particles.begin(), particles.end(),
                               [&](const Particle& p) { return alike(p, particles[0]); });
  return all ? "" : "particles of different mass or charge";
}

SoftLanes::SoftLanes(const Table& table, const Dynamics& dynamics, const Particle& kind,
                     InstructionSet set, DecisionOptions options)
    : implementation_(std::make_unique<Implementation>(table, dynamics, kind, set, options)) {}
SoftLanes::~SoftLanes() = default;

void SoftLanes::limit_hits(std::uint64_t hits) { implementation_->engine.limit_hits(hits); }
void SoftLanes::sample_at(std::vector<double> times, Sampled sampled) {
  implementation_->sample_at(std::move(times), std::move(sampled));
}
void SoftLanes::report_hits(Hit hit) { implementation_->report_hits(std::move(hit)); }
void SoftLanes::run_until(double t_end, const std::function<bool(LaneStart&)>& next,
                          const std::function<void(const LaneEnd&)>& ended,
                          const std::function<bool()>& interrupted) {
  implementation_->run_until(t_end, next, ended, interrupted);
}
DecisionCounts SoftLanes::decisions() const { return implementation_->engine.decisions(); }
const LaneEffort& SoftLanes::effort() const { return implementation_->effort; }

}  // namespace carom
