#include "lanes/soft/soft_engine.hpp"

#include <algorithm>
#include <stdexcept>

#include "base/index.hpp"
#include "carom/base/elementary.hpp"
#include "carom/events/report.hpp"
#include "carom/integrators/scheme.hpp"
#include "events/step/group_hit.hpp"
#include "events/step/surroundings.hpp"
#include "forces/potential.hpp"

namespace carom::lanes {

using events::Group;
using geometry::Vector;
using integrators::Stage;

namespace {

constexpr Time never{std::numeric_limits<double>::infinity()};
using base::at;

SoftKernel kernel_for(InstructionSet set) {
  if (!available(set))
    throw std::invalid_argument("this machine does not have the instruction set");
#if defined(CAROM_WIDE_LANES)
  if (set == InstructionSet::avx512) return soft_kernel<InstructionSet::avx512>();
  if (set == InstructionSet::avx2) return soft_kernel<InstructionSet::avx2>();
#endif
  return soft_kernel<InstructionSet::baseline>();
}

SoftStage::Kind kind_of(Stage<double>::Kind kind) {
  switch (kind) {
    case Stage<double>::Kind::drift:
      return SoftStage::Kind::drift;
    case Stage<double>::Kind::kick:
      return SoftStage::Kind::kick;
    case Stage<double>::Kind::straight:
      return SoftStage::Kind::straight;
    case Stage<double>::Kind::turn:
      break;
  }
  return SoftStage::Kind::turn;
}

Group::Surroundings surroundings_of(const Table& table, const Dynamics& dynamics) {
  Group::Surroundings in;
  in.forces = dynamics.forces.get();
  in.plan = dynamics.integrator;
  in.maps = std::make_shared<forces::ForceMaps>(*dynamics.forces);
  if (table.lattice) {
    in.lattice = &*table.lattice;
    in.centre = events::centre_of_cell(*table.lattice);
  }
  in.barriers = events::barriers_of(table);
  if (!table.walls.empty()) in.longest_way = events::longest_way(table);
  return in;
}

/// Evaluations of the force in a step; `known`: that at its start is known.
std::uint64_t evaluations(const std::vector<Stage<double>>& stages, bool known) {
  std::uint64_t count = 0;
  for (const Stage<double>& s : stages) {
    if (s.kind == Stage<double>::Kind::kick && !known) ++count, known = true;
    if (s.kind == Stage<double>::Kind::drift || s.kind == Stage<double>::Kind::straight)
      known = false;
  }
  return count;
}
bool is_kick(const Stage<double>& stage) { return stage.kind == Stage<double>::Kind::kick; }

}  // namespace

std::string unknown_to_steps(const Table& table, const Dynamics& dynamics) {
  const IntegratorPlan& plan = dynamics.integrator;
  const ForceField* const forces = dynamics.forces.get();
  if (forces && !forces->disc_radii().empty()) return "particles are discs";
  if (forces && forces->interacts()) return "particles interact";
  if (!forces || !forces->external()) return "steps without a force";
  if (!(dynamics.everywhere || forces->everywhere()))
    return "forces that act in parts of the plane only";
  if (forces->potentials().size() > SoftForces::most)
    return "more than " + std::to_string(SoftForces::most) + " potentials";
  if (table.lattice && table.lattice->edges.size() > SoftForces::most_edges)
    return "a lattice cell of many edges";
  if (is_adaptive(plan.scheme) || !(plan.step > 0.0)) return "a scheme without a fixed step";
  if (find_scheme(plan.scheme).form == Scheme::Form::spreiter_walter)
    return "the scheme " + plan.scheme;
  return {};
}

SoftEngine::SoftEngine(const Table& table, const Dynamics& dynamics, InstructionSet set,
                       DecisionOptions options)
    : table_(table),
      field_(*dynamics.forces),
      step_(dynamics.integrator.step),
      stages_(integrators::stages_of<double>(find_scheme(dynamics.integrator.scheme))),
      keeps_forces_(is_kick(stages_.front()) && is_kick(stages_.back())),
      step_cost_(evaluations(stages_, keeps_forces_)),
      sample_cost_(evaluations(stages_, is_kick(stages_.front()))),
      surroundings_(surroundings_of(table, dynamics)),
      kernel_(kernel_for(set)),
      walls_(table, options),
      group_(surroundings_) {
  if (table_.extent == Extent::bounded)
    surroundings_.inside = [this](Vector x) { return inside(x); };
  surroundings_.counts = &steps_;
  forces_.exp = elementary::exp_by(8);
  forces_.other = add_other;
  forces_.context = this;
  forces_.barriers = surroundings_.barriers.data();
  forces_.walls = static_cast<int>(surroundings_.barriers.size());
  forces_.longest_way = surroundings_.longest_way;
  for (const auto& potential : field_.potentials())
    forces_.lattice[forces_.potentials++] = potential->lattice_field();
  if (!table_.lattice) return;
  for (const geometry::CellEdge& e : table_.lattice->edges) {
    const Vector across = table_.lattice->translation(e.beyond);
    forces_.across_x[forces_.edges] = across.x;
    forces_.across_y[forces_.edges++] = across.y;
  }
  forces_.centre_x = surroundings_.centre.x;
  forces_.centre_y = surroundings_.centre.y;
}

void SoftEngine::set_kind(const Particle& kind) {
  particle_ = kind;
  forces_.unit_mass = kind.mass == 1.0;
  forces_.inverse_mass = 1.0 / kind.mass;
  group_.assign({0}, {kind});
  map_ = &surroundings_.maps->of(kind);
  span_ = {};
}

void SoftEngine::put(State& s, SoftPack& pack, int lane) const {
  if (table_.lattice)
    events::fold_towards_centre(*table_.lattice, surroundings_.centre, s.position, s.cell);
  pack.x[lane] = s.position.x;
  pack.y[lane] = s.position.y;
  pack.vx[lane] = s.velocity.x;
  pack.vy[lane] = s.velocity.y;
}

/// As Group::check_resolution. What lanes do not know to be resolved the scalar engine judges.
void SoftEngine::find_calls(double duration, SoftPack& pack) {
  kernel_.find_calls(forces_, duration / 3.0, pack);
  if (span_.time != duration / forces::resolution::steps_a_radius)
    span_ =
        forces::resolution::span_of(duration / forces::resolution::steps_a_radius, particle_.omega);
  forces::ForceMap::Motions ends;
  ends.count = pack.count;
  ends.x = pack.x;
  ends.y = pack.y;
  for (int lane = 0; lane < pack.count; ++lane) {
    const Vector way{0.5 * (pack.x[lane] - pack.from_x[lane]),
                     0.5 * (pack.y[lane] - pack.from_y[lane])};
    ends.square_speed[lane] = pack.vx[lane] * pack.vx[lane] + pack.vy[lane] * pack.vy[lane];
    ends.square_way[lane] = way.x * way.x + way.y * way.y;
  }
  bool known[SoftPack::lanes];
  map_->resolve_known(ends, span_, known);
  for (int lane = 0; lane < pack.count; ++lane) {
    if (pack.undecided[lane] || (pack.resolved[lane] & known[lane])) continue;
    const Vector from{pack.from_x[lane], pack.from_y[lane]}, to{pack.x[lane], pack.y[lane]};
    const Vector before{pack.from_vx[lane], pack.from_vy[lane]},
        after{pack.vx[lane], pack.vy[lane]};
    const Vector way = 0.5 * (to - from);
    const bool from_start =
        pack.resolved[lane] || map_->resolves(from, dot(before, before), dot(way, way), span_);
    pack.resolved[lane] = from_start && map_->resolves(to, dot(after, after), dot(way, way), span_);
    if (pack.resolved[lane]) [[likely]]
      continue;
    pack.undecided[lane] = true;
    if (std::find(pack.lane, pack.lane + pack.calls, lane) == pack.lane + pack.calls)
      pack.lane[pack.calls++] = lane;
  }
}

/// As SplittingStepper.
void SoftEngine::take_step(double duration, SoftPack& pack) {
  if (duration != made_for_ || particle_.omega != made_with_) {
    made_.clear();
    for (const Stage<double>& s : stages_)
      made_.push_back(
          {kind_of(s.kind), s.coefficient * duration,
           integrators::LarmorDrift<double>(particle_.omega, s.coefficient * duration)});
    made_for_ = duration;
    made_with_ = particle_.omega;
  }
  kernel_.step(forces_, made_.data(), static_cast<int>(made_.size()), pack);
}

void SoftEngine::refresh(SoftPack& pack, std::span<const int> which) {
  if (!pack.fresh || which.empty()) return;
  SoftPack some;
  int count = 0;
  for (const int lane : which) {
    some.x[count] = pack.x[lane];
    some.y[count++] = pack.y[lane];
  }
  some.count = (count + 7) / 8 * 8;
  for (int lane = count; lane < some.count; ++lane) {
    some.x[lane] = some.x[0];
    some.y[lane] = some.y[0];
  }
  kernel_.evaluate(forces_, some);
  count = 0;
  for (const int lane : which) {
    pack.ax[lane] = some.ax[count];
    pack.ay[lane] = some.ay[count++];
  }
}

void SoftEngine::copy(const SoftPack& from, int lane, SoftPack& to, int there) {
  to.x[there] = from.x[lane];
  to.y[there] = from.y[lane];
  to.vx[there] = from.vx[lane];
  to.vy[there] = from.vy[lane];
  to.ax[there] = from.ax[lane];
  to.ay[there] = from.ay[lane];
}

void SoftEngine::read(const SoftPack& pack, int lane, const Time& time, State& s) {
  s.wall = -1;
  s.position = {pack.x[lane], pack.y[lane]};
  s.velocity = {pack.vx[lane], pack.vy[lane]};
  s.time = time;
}
void SoftEngine::read_start(const SoftPack& pack, int lane, const Time& time, State& s) {
  s.wall = -1;
  s.position = {pack.from_x[lane], pack.from_y[lane]};
  s.velocity = {pack.from_vx[lane], pack.from_vy[lane]};
  s.time = time;
}

/// As World does it with a group of one.
SoftEngine::Outcome SoftEngine::follow(SoftTrack& track, bool from_lane, double t_end,
                                       std::span<const double> times, const Sample& sample) {
  // What this group knows is of another particle. A World knows the forces at the ends of this
  // one's latest step.
  group_.forget();
  steps_ = {};
  const bool arc_known = std::exchange(track.arc_known, false);
  bool first = true;
  const auto count = [&](Outcome outcome) {
    track.counts += steps_;
    if (from_lane) track.counts.force_evaluations -= keeps_forces_;
    return outcome;
  };
  State& s = track.state;
  const Time end = events::next_multiple(s.time, step_);
  std::size_t sampled = 0;
  const auto emit_while = [&](auto due) {
    for (; sampled < times.size() && due(Time(times[sampled])); ++sampled)
      sample(sampled, group_.state_at(0, times[sampled]));
  };
  for (;;) {
    group_.set_state(0, s);
    group_.set_time(s.time);
    track.fastest = std::max(track.fastest, dot(s.velocity, s.velocity));
    const Group::Next next = group_.predict(never);
    if (std::exchange(first, false) && arc_known && group_.arc_at_start())
      --steps_.force_evaluations;
    const Time when = group_.next_time();
    const bool over = when > Time(t_end);
    if (!next.fault.empty()) {
      // There are no states within a step that fails.
      emit_while([&](const Time& t) { return !(t > s.time); });
      return count(s.time < Time(t_end) ? this->end(track, Fate::unresolved, next.fault)
                                        : Outcome::over);
    }
    emit_while([&](const Time& t) { return over || t < when; });
    if (over) return count(Outcome::over);
    group_.advance();
    if (next.in_parts) {
      s = group_.state(0);
      continue;
    }
    if (next.member < 0) return count(end_step(track));
    if (hit(track, *next.barrier)) return count(Outcome::ended);
    if (!(s.time < end)) return count(Outcome::on_a_wall);
  }
}

SoftEngine::Outcome SoftEngine::end_step(SoftTrack& track) {
  const geometry::Cell cell = group_.state(0).cell;
  group_.fold(0);
  track.state = group_.state(0);
  track.arc_known = track.state.cell == cell && group_.arc_at_end();
  if (track.state.cell != cell) count_start(track);
  return Outcome::at_step_end;
}

void SoftEngine::count_lane(SoftTrack& track, std::uint64_t steps, bool tried,
                            double fastest) const {
  track.counts.steps += steps - tried;
  track.counts.force_evaluations += steps * step_cost_;
  track.fastest = std::max(track.fastest, fastest);
}

bool SoftEngine::inside(Vector x) {
  if (events::on_some_wall(surroundings_.barriers, static_cast<int>(table_.walls.size()), x))
    return true;
  if (!locator_) locator_ = std::make_unique<events::Locator>(table_);
  return locator_->contains(x);
}

/// Does it end there?
bool SoftEngine::hit(SoftTrack& track, const events::Barrier<double>& barrier) {
  const events::GroupHit hit = events::hit_of(walls_, table_, group_, 0, barrier, counts_);
  track.state = hit.state;
  track.last_wall = barrier.wall;
  track.hole = hit.hole;
  if (hit.hole < 0) ++track.hits;
  const bool enough = hit.hole < 0 && reported_hit_ && !reported_hit_(track);
  if (hit.hole >= 0)
    end(track, Fate::escaped, {});
  else if (!hit.inward)
    end(track, Fate::singular, {});
  else if (track.hits >= limit_)
    end(track, Fate::capped, {});
  else if (enough)
    end(track, Fate::survived, {});
  return track.finished;
}

SoftEngine::Outcome SoftEngine::end(SoftTrack& track, Fate fate, std::string_view fault) const {
  track.finished = true;
  track.fate = fate;
  track.ended = track.state.time;
  if (fate == Fate::lost || fate == Fate::singular || fate == Fate::unresolved)
    track.report = report_of(particle_, track.state, fate, fault);
  return Outcome::ended;
}

void SoftEngine::add_other(const SoftForces& forces, int potential, SoftPack& pack) {
  const auto& self = *static_cast<const SoftEngine*>(forces.context);
  self.field_.potentials()[at(potential)]->add_forces(self.particle_, pack.count, pack.x, pack.y,
                                                      pack.ax, pack.ay);
}

}  // namespace carom::lanes
