#include "carom/lanes/lane_world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "events/next_hit.hpp"
#include "lanes/kernels.hpp"
#include "lanes/make_lane_table.hpp"

namespace carom {

using geometry::Vector;
using lanes::Call;
using lanes::LanePack;
using lanes::LaneTable;

namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
// Hits are counted in doubles.
constexpr std::uint64_t most_hits = std::uint64_t{1} << 53;

lanes::Advance kernel_for(InstructionSet set, const LaneTable& table) {
#if defined(CAROM_WIDE_LANES)
  if (set == InstructionSet::avx512) return lanes::avx512_kernel(table);
  if (set == InstructionSet::avx2) return lanes::avx2_kernel(table);
#endif
  (void)set;
  return lanes::baseline_kernel(table);
}

class LastEnd : public Observer {
 public:
  void end(const EndEvent& event) override { time = event.time; }
  Time time;
};

}  // namespace

class LaneWorld::Implementation {
 public:
  Implementation(const Table& the_table, InstructionSet set, DecisionOptions options)
      : table(the_table),
        scalar(the_table, options),
        finder(the_table, options),
        pieces(lanes::make_lane_table(finder)),
        advance(kernel_for(set, pieces)) {
    if (!available(set)) throw std::invalid_argument("this machine does not have the instruction set");
  }

  void run_until(double t_end, const std::function<bool(LaneStart&)>& next, const std::function<void(const LaneEnd&)>& ended,
                 const std::function<bool()>& interrupted) {
    source = &next;
    sink = &ended;
    pack.end = t_end;
    pack.limit = static_cast<double>(std::min(limit, most_hits));
    exhausted = false;
    busy = 0;
    for (int lane = 0; lane < LanePack::lanes; ++lane) pack.active[lane] = 0.0;
    for (int lane = 0; lane < LanePack::lanes; ++lane) fill(lane);
    for (std::uint64_t sweep = 1; busy > 0; ++sweep) {
      if (interrupted && sweep % 64 == 0 && interrupted()) return;
      advance(pieces, pack);
      effort.idle += static_cast<std::uint64_t>(LanePack::lanes - busy);
      for (int i = 0; i < pack.calls; ++i) answer(pack.lane[i], pack.call[i], pack.met[i]);
    }
  }

  DecisionCounts decisions() const {
    DecisionCounts sum = scalar.decisions();
    sum.filter += filter;
    return sum;
  }

  const Table& table;
  World scalar;
  HitFinder finder;
  LaneTable pieces;
  lanes::Advance advance;
  LanePack pack;
  std::uint64_t limit = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t filter = 0;
  Effort effort;

 private:
  /// What a lane's trajectory needs besides its numbers in the pack.
  struct Trajectory {
    LaneStart start;              ///< or where the scalar engine left it
    std::uint64_t first_hits = 0; ///< when it began
  };

  /// Puts the next trajectory into a lane.
  void fill(int lane) {
    for (;;) {
      Trajectory& mine = trajectories[lane];
      if (exhausted || !(*source)(mine.start)) {
        exhausted = true;
        return;
      }
      mine.first_hits = mine.start.hits;
      if (can_start(mine.start.state)) return enter(lane);
      if (go_on(lane)) return;
    }
  }

  /// Is the state one that lanes may start from? Not at a joint, nor along a wall.
  bool can_start(State& s) const {
    if (s.wall < 0) return true;
    const geometry::PreparedCurve& w = finder.curve(s.wall);
    if (!(s.u > geometry::first_parameter && s.u < w.last())) return false;
    const auto frame = w.frame(s.u);
    if (w.parameter(s.position) != s.u) s.position = frame.point;  // as World::add
    return dot(frame.normal, s.velocity) > 0x1p-36 * pieces.size * std::fabs(s.velocity.x + s.velocity.y);
  }

  void enter(int lane) {
    const Trajectory& mine = trajectories[lane];
    const State& s = mine.start.state;
    const double square = mine.start.particle.speed * mine.start.particle.speed;
    pack.x[lane] = s.position.x;
    pack.y[lane] = s.position.y;
    pack.vx[lane] = s.velocity.x;
    pack.vy[lane] = s.velocity.y;
    pack.high[lane] = s.time.high;
    pack.low[lane] = s.time.low;
    pack.piece[lane] = s.wall < 0 ? -1.0 : lanes::piece_at(pieces, s.wall, s.u);
    pack.hits[lane] = static_cast<double>(mine.start.hits);
    pack.speed[lane] = mine.start.particle.speed;
    pack.square_speed[lane] = square;
    pack.energy_weight[lane] = 0.75 / square;
    if (pack.active[lane] == 0.0) ++busy;
    pack.active[lane] = 1.0;
  }

  void leave(int lane) {
    if (pack.active[lane] != 0.0) --busy;
    pack.active[lane] = 0.0;
  }

  /// The lane's numbers as a state.
  void take_out(int lane) {
    Trajectory& mine = trajectories[lane];
    const auto hits = static_cast<std::uint64_t>(pack.hits[lane]);
    effort.hits += hits - mine.start.hits;
    filter += 2 * (hits - mine.start.hits);  // which wall, and which way the velocity points
    if (hits == mine.start.hits) return;
    State& s = mine.start.state;
    mine.start.hits = hits;
    s.wall = static_cast<int>(pieces.wall[static_cast<int>(pack.piece[lane])]);
    s.position = {pack.x[lane], pack.y[lane]};
    s.velocity = {pack.vx[lane], pack.vy[lane]};
    s.time = {pack.high[lane], pack.low[lane]};
    s.u = finder.curve(s.wall).parameter(s.position);
  }

  void answer(int lane, Call call, const LanePack::Met& met) {
    take_out(lane);
    const Trajectory& mine = trajectories[lane];
    const State& s = mine.start.state;
    if (call == Call::undecided) {
      if (go_on(lane)) return;
    } else {
      ++filter;
      LaneEnd end{mine.start.tag, Fate::survived, s.time, s, -1, mine.start.hits, last_wall(mine), {}};
      if (call == Call::escaped) {
        end.fate = Fate::escaped;
        end.time = {met.high, met.low};
        end.hole = static_cast<int>(pieces.hole[static_cast<int>(met.piece)]);
      } else if (call != Call::over) {
        end.fate = call == Call::capped ? Fate::capped : Fate::unbounded;
      }
      leave(lane);
      (*sink)(end);
    }
    fill(lane);
  }

  static int last_wall(const Trajectory& t) { return t.start.hits > t.first_hits ? t.start.state.wall : -1; }

  /// One event by the scalar engine; false if it ends the trajectory.
  bool go_on(int lane) {
    Trajectory& mine = trajectories[lane];
    ++effort.scalar;
    LastEnd last;
    last.time = mine.start.state.time;
    scalar.clear();
    scalar.limit_hits(std::min(limit, mine.start.hits + 1));
    scalar.add(mine.start.particle, mine.start.state, mine.start.hits);
    scalar.run_until(pack.end, last);
    mine.start.hits = scalar.hits(0);
    mine.start.state = scalar.state(0);
    if (scalar.fate(0) == Fate::capped && mine.start.hits < limit) {
      if (mine.start.state.u > geometry::first_parameter) {
        enter(lane);
        return true;
      }
      return go_on(lane);  // from a joint
    }
    leave(lane);
    (*sink)({mine.start.tag, scalar.fate(0), scalar.finished(0) ? last.time : scalar.state(0).time, mine.start.state, scalar.hole(0), mine.start.hits,
             last_wall(mine), scalar.report(0)});
    return false;
  }

  const std::function<bool(LaneStart&)>* source = nullptr;
  const std::function<void(const LaneEnd&)>* sink = nullptr;
  Trajectory trajectories[LanePack::lanes];
  bool exhausted = false;
  int busy = 0;
};

bool LaneWorld::suits(const Table& table, const std::vector<Particle>& particles) {
  for (const Particle& p : particles)
    if (p.omega != 0.0 || p.radius != 0.0 || !(p.speed > 0.0)) return false;
  return lanes::fits(table);
}

LaneWorld::LaneWorld(const Table& table, InstructionSet set, DecisionOptions options)
    : implementation_(std::make_unique<Implementation>(table, set, options)) {}
LaneWorld::~LaneWorld() = default;

void LaneWorld::limit_hits(std::uint64_t hits) { implementation_->limit = hits; }
void LaneWorld::run_until(double t_end, const std::function<bool(LaneStart&)>& next,
                          const std::function<void(const LaneEnd&)>& ended, const std::function<bool()>& interrupted) {
  implementation_->run_until(t_end, next, ended, interrupted);
}
DecisionCounts LaneWorld::decisions() const { return implementation_->decisions(); }
const LaneWorld::Effort& LaneWorld::effort() const { return implementation_->effort; }

}  // namespace carom
