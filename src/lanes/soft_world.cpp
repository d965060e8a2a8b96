#include "carom/lanes/soft_world.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "events/group.hpp"
#include "lanes/soft_engine.hpp"

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

// Every lane has a clock of its own. The times of two step ends differ by the step exactly: k * step is held
// without error in two doubles, and so is the difference of the low ones. So all lanes take the same step.
class SoftWorld::Implementation {
 public:
  Implementation(const Table& table, const Dynamics& dynamics, const Particle& kind, InstructionSet set,
                 DecisionOptions options)
      : engine(table, dynamics, set, options), kind_(kind) {
    engine.set_kind(kind);
  }

  void run_until(double t_end, const std::function<bool(LaneStart&)>& next,
                 const std::function<void(const LaneEnd&)>& ended, const std::function<bool()>& interrupted) {
    begin(t_end, next, ended);
    for (std::uint64_t sweep = 1; busy_ > 0; ++sweep) {
      if (interrupted && sweep % steps_between_questions == 0 && interrupted()) return;
      engine.take_step(engine.step(), pack_);
      engine.find_calls(engine.step(), pack_);
      ++next_;
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

  SoftEngine engine;
  LaneEffort effort;

 private:
  void begin(double t_end, const std::function<bool(LaneStart&)>& next,
             const std::function<void(const LaneEnd&)>& ended) {
    source_ = &next;
    sink_ = &ended;
    t_end_ = t_end;
    const double step = engine.step();
    // Steps that end in time; the one after them may still meet a wall. Nobody makes as many as are counted here.
    double whole = std::fmin(std::floor(t_end / step), 0x1p52);
    while (whole > 0.0 && multiple(whole, step) > Time(t_end)) whole -= 1.0;
    while (whole < 0x1p52 && multiple(whole + 1.0, step) <= Time(t_end)) whole += 1.0;
    whole_ = static_cast<std::uint64_t>(whole);
    next_ = 0;
    soonest_ = never;
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

  /// When the step that the pack has just taken began in a lane.
  Time before(int lane) const {
    return multiple(static_cast<double>(whole_ - (last_step_[lane] + 1 - next_)), engine.step());
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
      if (!alike(start.particle, kind_)) throw std::invalid_argument("a particle that is accelerated otherwise");
      tracks_[lane] = SoftTrack();
      tracks_[lane].state = start.state;
      tracks_[lane].hits = start.hits;
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
    moved_.push_back(lane);
    if (!active_[lane]) ++busy_;
    active_[lane] = true;
    return true;
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
      switch (engine.follow(track, from_lane, t_end_)) {
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

  /// Those whose step ends too late, and meets nothing.
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
    (*sink_)({starts_[lane].tag, t.fate, t.finished ? t.ended : t.state.time, t.state, t.hole, t.hits, t.last_wall,
              t.report, t.counts, engine.kinetic_energy(t)});
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
      for (double* q : {pack_.x, pack_.y, pack_.vx, pack_.vy, pack_.ax, pack_.ay, pack_.fastest}) q[lane] = q[last];
      pack_.resolved[lane] = pack_.resolved[last];
      starts_[lane] = starts_[last];
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
  SoftPack pack_;
  LaneStart starts_[SoftPack::lanes];
  SoftTrack tracks_[SoftPack::lanes];
  bool active_[SoftPack::lanes] = {};
  std::uint64_t next_ = 0;                            ///< number of the pack's next step
  std::uint64_t last_step_[SoftPack::lanes] = {};     ///< the pack's step that ends too late for the lane
  std::uint64_t entered_[SoftPack::lanes] = {};       ///< number of the pack's step that was the lane's first since it began, or came back
  std::uint64_t soonest_ = never;                     ///< the first of them
  int used_ = 0, busy_ = 0;
  bool exhausted_ = false;
  std::vector<int> moved_;  ///< lanes that hold another point than their last step left there
};

std::string SoftWorld::hindrance(const Table& table, const Dynamics& dynamics, const std::vector<Particle>& particles) {
  if (particles.empty()) return "there are no particles";
  const std::string unknown = lanes::unknown_to_steps(table, dynamics);
  if (!unknown.empty()) return unknown;
  const bool all = std::all_of(particles.begin(), particles.end(), [&](const Particle& p) { return alike(p, particles[0]); });
  return all ? "" : "particles of different mass or charge";
}

SoftWorld::SoftWorld(const Table& table, const Dynamics& dynamics, const Particle& kind, InstructionSet set,
                     DecisionOptions options)
    : implementation_(std::make_unique<Implementation>(table, dynamics, kind, set, options)) {}
SoftWorld::~SoftWorld() = default;

void SoftWorld::limit_hits(std::uint64_t hits) { implementation_->engine.limit_hits(hits); }
void SoftWorld::run_until(double t_end, const std::function<bool(LaneStart&)>& next,
                          const std::function<void(const LaneEnd&)>& ended,
                          const std::function<bool()>& interrupted) {
  implementation_->run_until(t_end, next, ended, interrupted);
}
DecisionCounts SoftWorld::decisions() const { return implementation_->engine.decisions(); }
const LaneEffort& SoftWorld::effort() const { return implementation_->effort; }

}  // namespace carom
