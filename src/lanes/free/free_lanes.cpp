#include "carom/lanes/free_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "lanes/free/filled_pack.hpp"
#include "lanes/free/kernels.hpp"
#include "lanes/free/lane_start.hpp"
#include "lanes/free/lane_tangents.hpp"
#include "lanes/free/make_lane_table.hpp"
#include "lanes/free/next_disc_table.hpp"
#include "lanes/free/scalar_event.hpp"
#include "motion/free_motion.hpp"
#include "motion/take_state.hpp"

namespace carom {

using geometry::Vector;
using lanes::Call;
using lanes::FilledPack;
using lanes::LanePack;
using lanes::LaneTable;
using lanes::LaneTrajectory;
using lanes::Turn;
using lanes::turn_of;

namespace {

// Hits are counted in doubles.
constexpr std::uint64_t most_hits = std::uint64_t{1} << 53;
// After this many the cells of hits, a signed byte each, are taken out of 32 bits.
constexpr std::uint64_t most_sweeps = std::uint64_t{1} << 23;

/// Flights along circles get no farther than the diameter; straight ones as far as you like.
double reach_of(const std::vector<Particle>& particles) {
  double reach = 0.0;
  for (const Particle& p : particles)
    reach = std::max(reach, p.omega == 0.0 ? HUGE_VAL : 2.0 * p.speed / std::fabs(p.omega));
  return reach;
}

}  // namespace

class FreeLanes::Implementation {
 public:
  Implementation(World world, const std::vector<Particle>& particles, InstructionSet set)
      : turn(turn_of(particles.at(0).omega)),
        pieces(lanes::make_lane_table(world.pieces(), reach_of(particles))),
        scalar(std::move(world), pieces, turn),
        walls(scalar.walls()),
        next_discs(lanes::make_next_discs(pieces)),
        kernels(lanes::kernels_for(set, pieces, turn)),
        tangents(walls.table, pieces, lanes::tangent_kernels_for(set, pieces, turn)) {
    pieces.clockwise = turn == Turn::clockwise;
    if (turn != Turn::straight) lanes::leave_short_arcs(pieces);
    for (FilledPack* l : {&main, &entrance}) l->pack.search_pack = &search_pack;
    if (!available(set))
      throw std::invalid_argument("this machine does not have the instruction set");
  }

  void run_until(double t_end, const std::function<bool(LaneStart&)>& next,
                 const std::function<void(const LaneEnd&)>& ended,
                 const std::function<bool()>& interrupted) {
    source = &next;
    sink = &ended;
    stop = &interrupted;
    stopped = false;
    for (FilledPack* l : {&main, &entrance}) {
      l->pack.end = t_end;
      l->pack.limit = static_cast<double>(std::min(limit, most_hits));
      l->pack.next_cap = HUGE_VAL;
      l->pack.used = LanePack::lanes;
      l->clear();
    }
    exhausted = false;
    waiting = 0;
    for (int lane = 0; lane < LanePack::lanes; ++lane) fill(lane);
    for (std::uint64_t sweep = 1; main.busy > 0; ++sweep) {
      if (stopped || (sweep % 64 == 0 && asked_to_stop())) return;
      if (sweep % most_sweeps == 0) main.add_cells();
      kernels.on_walls(pieces, main.pack);  // a hit of each lane: lanes/kernel/kernel.hpp
      if (tangents.any()) tangents.sweep(main);
      main.cap();  // calls where a lane has all its hits
      effort.steps += static_cast<std::uint64_t>(rounded_up(main.pack.used));
      effort.idle += static_cast<std::uint64_t>(rounded_up(main.pack.used) - main.busy);
      const std::vector<int> enough = report_hits(main);
      for (int i = 0; i < main.pack.calls; ++i)
        if (!answer(main, i)) fill(main.pack.lane[i]);
      for (const int lane : enough) {
        take_out(main, lane);
        end_after_hit(main, lane);
        fill(lane);
      }
      if (exhausted && main.busy < main.pack.used) close_ranks();
    }
  }

  DecisionCounts decisions() const {
    DecisionCounts sum = scalar.decisions();
    sum.filter += filter;
    return sum;
  }

  Turn turn;
  LaneTable pieces;
  lanes::ScalarEvent scalar;
  const events::PieceTable& walls;
  std::vector<std::uint32_t> next_discs;
  lanes::Kernels kernels;
  lanes::LaneTangents tangents;
  std::uint64_t limit = std::numeric_limits<std::uint64_t>::max();
  std::vector<double> times;  ///< to report at
  Sampled sampled;
  Hit hit;
  bool end_states = true;
  std::uint64_t filter = 0;
  LaneEffort effort;

 private:
  bool asked_to_stop() {
    stopped = stopped || (*stop && (*stop)());
    return stopped;
  }
  /// Lanes that a sweep touches.
  int rounded_up(int used) const {
    return (used + kernels.width - 1) / kernels.width * kernels.width;
  }

  /// Puts the next trajectory into a lane. The kernel `on_walls` may fly only particles that are on
  /// a wall: then others make their first hit in the entrance, by the kernel `anywhere`.
  void fill(int lane) {
    if (kernels.on_walls == kernels.anywhere) {
      begin(main, lane);
      return;
    }
    while (waiting < LanePack::lanes || !exhausted) {
      if (waiting == LanePack::lanes || entrance.busy == 0) enter_several();
      for (; waiting < LanePack::lanes; ++waiting) {
        if (entrance.pack.active[waiting] == 0.0) continue;
        std::swap(main.of_lane[lane], entrance.of_lane[waiting]);
        entrance.leave(waiting);
        if (moves_on())
          lanes::move_into(main.pack, lane, pieces, main.trajectory(lane).start.particle,
                           entrance.pack, waiting);
        else
          lanes::put_into(main.pack, lane, pieces, main.trajectory(lane).start);
        ++waiting;
        return activate(main, lane);
      }
    }
  }

  /// The last trajectories side by side, so that packs without any need not be swept.
  void close_ranks() {
    LanePack& p = main.pack;
    int& used = p.used;
    for (int lane = 0; lane < used; ++lane) {
      if (p.active[lane] != 0.0) continue;
      while (used > lane && p.active[used - 1] == 0.0) --used;
      if (used <= lane) return;
      const int last = --used;
      take_out(main, last);
      std::swap(main.of_lane[lane], main.of_lane[last]);
      main.leave(last);
      resume(main, lane);
    }
  }

  /// First flights, which may start anywhere. A particle that has made its first one waits for a
  /// lane.
  void enter_several() {
    entrance.clear();
    for (int lane = 0; lane < LanePack::lanes && begin(entrance, lane);) ++lane;
    waiting = 0;
    if (entrance.busy == 0) return;
    kernels.anywhere(pieces, entrance.pack);
    if (tangents.any()) tangents.sweep(entrance);
    entrance.cap();
    effort.steps += LanePack::lanes;
    effort.idle += static_cast<std::uint64_t>(LanePack::lanes - entrance.busy);
    for (int lane = 0; lane < LanePack::lanes && !times.empty(); ++lane) {
      LaneTrajectory& mine = entrance.trajectory(lane);
      const bool has_hit = entrance.pack.active[lane] != 0.0 &&
                           entrance.pack.hits(lane) != static_cast<double>(mine.start.hits);
      if (has_hit)
        report(mine, mine.start.state, {entrance.pack.high[lane], entrance.pack.low[lane]});
    }
    const std::vector<int> enough = report_hits(entrance);
    const int calls = entrance.pack.calls;
    for (int i = 0; i < calls; ++i) answer(entrance, i);
    for (const int lane : enough) {
      take_out(entrance, lane);
      end_after_hit(entrance, lane);
    }
    for (int lane = 0; lane < LanePack::lanes && !moves_on(); ++lane)
      if (entrance.pack.active[lane] != 0.0) take_out(entrance, lane);
  }
  /// From the entrance into a lane without being taken out between.
  bool moves_on() const { return pieces.edges == 0 && !tangents.any(); }

  /// Begins the next trajectory that lasts; false if there is none.
  bool begin(FilledPack& lanes, int lane) {
    for (;;) {
      LaneTrajectory& mine = lanes.trajectory(lane);
      if (exhausted || stopped || !(*source)(mine.start)) {
        exhausted = true;
        return false;
      }
      if (turn_of(mine.start.particle.omega) != turn)
        throw std::invalid_argument("a particle that turns another way");
      mine.first_hits = mine.start.hits;
      mine.reported = 0;
      mine.heard = mine.start.hits;
      if (tangents.any()) tangents.begin(mine);
      while (mine.reported < times.size() && Time(times[mine.reported]) < mine.start.state.time)
        ++mine.reported;
      if (!(mine.start.state.time > Time(main.pack.end)) &&
          lanes::can_start(pieces, walls, mine.start)) {
        resume(lanes, lane);
        return true;
      }
      if (go_on(lanes, lane)) return true;
    }
  }

  /// The numbers of a lane's trajectory.
  void resume(FilledPack& lanes, int lane) {
    lanes::put_into(lanes.pack, lane, pieces, lanes.trajectory(lane).start);
    activate(lanes, lane);
  }
  void activate(FilledPack& lanes, int lane) {
    if (tangents.any()) tangents.put(lanes, lane);
    lanes.pack.until[lane] = until(lanes, lane);
    if (lanes.pack.active[lane] == 0.0) ++lanes.busy;
    lanes.pack.active[lane] = 1.0;
  }

  /// When a lane is to be looked at. First flights are looked at once they are made.
  double until(const FilledPack& lanes, int lane) const {
    const std::size_t next = lanes.trajectory(lane).reported;
    return &lanes == &main && next < times.size() ? std::min(times[next], lanes.pack.end)
                                                  : lanes.pack.end;
  }
  /// Reports a trajectory that flies on from its last event, at times before `t` or, if that
  /// counts, at it.
  void report(LaneTrajectory& mine, const State& last, Time t, bool counts = false) {
    for (; mine.reported < times.size(); ++mine.reported) {
      const Time next = times[mine.reported];
      if (counts ? next > t : !(next < t)) return;
      sampled(mine.start.tag, mine.reported, motion::flown(last, mine.start.particle.omega, next));
    }
  }
  /// Reports the hits of a sweep if asked to; returns the lanes whose hits are enough.
  std::vector<int> report_hits(FilledPack& lanes) {
    std::vector<int> enough;
    if (!hit) return enough;
    for (int lane = 0; lane < lanes.pack.used; ++lane) {
      if (lanes.pack.active[lane] == 0.0) continue;
      LaneTrajectory& mine = lanes.trajectory(lane);
      const auto hits = static_cast<std::uint64_t>(lanes.pack.hits(lane));
      if (hits == mine.heard) continue;
      mine.heard = hits;
      // A call reports its last one.
      State state;
      on_wall(lanes, lane, state);
      if (!hit(mine.start.tag, state, hits) && hits < limit) enough.push_back(lane);
    }
    return enough;
  }
  /// Ends a trajectory at the hit that its state tells.
  void end_after_hit(FilledPack& lanes, int lane) {
    lanes.leave(lane);
    const LaneTrajectory& mine = lanes.trajectory(lane);
    const auto& [tag, particle, state, hits] = mine.start;
    (*sink)({tag, Fate::survived, state.time, state, -1, hits, mine.last_wall(), {}});
  }
  void deliver(LaneTrajectory& mine, const LaneEnd& end) {
    if (tangents.any() && (end.fate == Fate::survived || end.fate == Fate::pinned))
      tangents.finish(mine);
    (*sink)(end);
  }
  /// A lane's last event on its wall.
  void on_wall(const FilledPack& lanes, int lane, State& s) const {
    lanes.last_event(lane, s);
    s.wall = wall_of(lanes, lane);
    s.u = walls.curve(s.wall).parameter(s.position);
  }
  int wall_of(const FilledPack& lanes, int lane) const {
    return static_cast<int>(pieces.wall[static_cast<int>(lanes.pack.piece[lane])]);
  }
  /// A lane's hits; false: it has made none.
  bool take_hits(FilledPack& lanes, int lane) {
    LaneTrajectory& mine = lanes.trajectory(lane);
    const auto hits = static_cast<std::uint64_t>(lanes.pack.hits(lane));
    effort.hits += hits - mine.start.hits;
    filter += 2 * (hits - mine.start.hits);  // which wall, and which way the velocity points
    return std::exchange(mine.start.hits, hits) != hits;
  }
  /// The lane's numbers as a state.
  void take_out(FilledPack& lanes, int lane) {
    if (!take_hits(lanes, lane)) return;
    on_wall(lanes, lane, lanes.trajectory(lane).start.state);
    if (tangents.any()) tangents.take(lanes, lane);
  }

  /// Answers a call; false if the trajectory has ended.
  bool answer(FilledPack& lanes, int number) {
    const int lane = lanes.pack.lane[number];
    const Call call = lanes.pack.call[number];
    const LanePack::Met met = lanes.pack.met[number];
    const Time there{met.high, met.low}, last(lanes.pack.end);
    const bool survives = call == Call::over && there > last;
    LaneTrajectory& mine = lanes.trajectory(lane);
    if ((call == Call::over || call == Call::escaped) && mine.reported < times.size()) {
      const std::size_t before = mine.reported;
      State state;
      lanes.last_event(lane, state);
      report(mine, state, survives ? last : there, survives);
      lanes.pack.until[lane] = until(lanes, lane);
      // A first flight that ends when the run does must not be flown by the kernel of particles
      // that are on walls.
      if (&lanes == &main && call == Call::over && !survives && mine.reported > before) {
        // On a lattice a particle that began off the discs must find its first one again.
        if (lanes.pack.hits(lane) == static_cast<double>(mine.start.hits))
          resume(lanes, lane);
        else
          lanes::look_again(lanes.pack, lane);
        return true;
      }
    }
    // A hit at exactly the awaited time is decided by the scalar engine.
    if (call == Call::undecided || (call == Call::over && !survives)) {
      take_out(lanes, lane);
      return go_on(lanes, lane);
    }
    LaneEnd& end = end_in_lanes;  // used again: it has no report and no steps
    if (end_states || tangents.any()) {
      take_out(lanes, lane);
      motion::take(end.state, mine.start.state);
    } else if (take_hits(lanes, lane)) {
      mine.start.state.wall = wall_of(lanes, lane);
    }
    ++filter;
    end.tag = mine.start.tag;
    end.fate = Fate::survived;
    end.time.high = lanes.pack.high[lane];
    end.time.low = lanes.pack.low[lane];
    end.hole = -1;
    end.hits = mine.start.hits;
    end.last_wall = mine.last_wall();
    if (call == Call::escaped) {
      end.fate = Fate::escaped;
      end.time = {met.high, met.low};
      end.hole = static_cast<int>(pieces.hole[static_cast<int>(met.piece)]);
    } else if (call != Call::over) {
      end.fate = call == Call::capped ? Fate::capped : Fate::unbounded;
    }
    lanes.leave(lane);
    deliver(mine, end);
    return false;
  }

  /// One event by the scalar engine; false if it ends the trajectory.
  bool go_on(FilledPack& lanes, int lane) {
    LaneTrajectory& mine = lanes.trajectory(lane);
    ++effort.scalar;
    // A single flight may take long: so this is asked meanwhile.
    scalar.fly(
        mine.start, {times.begin() + static_cast<std::ptrdiff_t>(mine.reported), times.end()},
        std::min(limit, mine.start.hits + 1), lanes.pack.end, [this] { return asked_to_stop(); });
    if (stopped) {
      lanes.leave(lane);
      return false;
    }
    for (const State& state : scalar.samples()) sampled(mine.start.tag, mine.reported++, state);
    scalar.learn();
    const bool has_hit = scalar.hits() > mine.start.hits;
    if (has_hit && tangents.any()) tangents.hit(mine, scalar.state());
    mine.start.hits = mine.heard = scalar.hits();
    mine.start.state = scalar.state();
    if (has_hit && hit && !hit(mine.start.tag, mine.start.state, mine.start.hits) &&
        mine.start.hits < limit) {
      end_after_hit(lanes, lane);
      return false;
    }
    if (scalar.fate() == Fate::capped && mine.start.hits < limit) {  // it has made its one hit
      if (mine.start.state.u > geometry::first_parameter) {
        resume(lanes, lane);
        return true;
      }
      return go_on(lanes, lane);  // from a joint
    }
    lanes.leave(lane);
    deliver(mine, {mine.start.tag, scalar.fate(), scalar.time(), mine.start.state, scalar.hole(),
                   mine.start.hits, mine.last_wall(), scalar.report()});
    return false;
  }

  const std::function<bool(LaneStart&)>* source = nullptr;
  const std::function<void(const LaneEnd&)>* sink = nullptr;
  const std::function<bool()>* stop = nullptr;
  bool stopped = false;
  FilledPack main;
  FilledPack entrance;  ///< see fill
  LanePack search_pack;
  LaneEnd end_in_lanes;  ///< of the latest trajectory that did not end by the scalar engine
  int waiting = 0;       ///< the next lane of the entrance that may wait
  bool exhausted = false;
};

std::string FreeLanes::hindrance(const Table& table, const std::vector<Particle>& particles) {
  if (particles.empty()) return "there are no particles";
  for (const Particle& p : particles) {
    if (p.radius != 0.0) return "particles are discs";
    if (turn_of(p.omega) != turn_of(particles[0].omega))
      return "particles do not all turn the same way";
    if (!lanes::moderate(p.speed) || (p.omega != 0.0 && !lanes::moderate(std::fabs(p.omega))))
      return "a speed or cyclotron frequency that is not between 1e-30 and 1e30";
  }
  return lanes::misfit(table, reach_of(particles));
}

FreeLanes::FreeLanes(const Table& table, const std::vector<Particle>& particles, InstructionSet set,
                     DecisionOptions options)
    : implementation_(std::make_unique<Implementation>(World(table, options), particles, set)) {}
FreeLanes::FreeLanes(const World& like, const std::vector<Particle>& particles, InstructionSet set)
    : implementation_(std::make_unique<Implementation>(like.empty_copy(), particles, set)) {}
FreeLanes::~FreeLanes() = default;

void FreeLanes::limit_hits(std::uint64_t hits) { implementation_->limit = hits; }
void FreeLanes::sample_at(std::vector<double> times, Sampled sampled) {
  implementation_->times = std::move(times);
  implementation_->sampled = std::move(sampled);
}
void FreeLanes::report_hits(Hit hit) { implementation_->hit = std::move(hit); }
void FreeLanes::follow_deviations(std::vector<double> times, double unit_length,
                                  Stretched stretched) {
  implementation_->tangents.follow(std::move(times), unit_length, std::move(stretched));
}
void FreeLanes::run_until(double t_end, const std::function<bool(LaneStart&)>& next,
                          const std::function<void(const LaneEnd&)>& ended,
                          const std::function<bool()>& interrupted) {
  implementation_->run_until(t_end, next, ended, interrupted);
}
void FreeLanes::omit_end_states() { implementation_->end_states = false; }
DecisionCounts FreeLanes::decisions() const { return implementation_->decisions(); }
const LaneEffort& FreeLanes::effort() const { return implementation_->effort; }

}  // namespace carom
