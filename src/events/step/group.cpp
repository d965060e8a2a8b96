#include "events/step/group.hpp"

#include <algorithm>
#include <cmath>

#include "carom/integrators/make_stepper.hpp"
#include "events/step/surroundings.hpp"

namespace carom::events {

using geometry::Cell;
using geometry::Vector;

Time multiple(double k, double step) {
  const double high = k * step;
  return Time(high, std::fma(k, step, -high));
}

namespace {

/// Whole numbers of steps are counted in a double, k + 1 too.
constexpr double most_steps = 0x1p52;
bool too_late(const Time& now, double step) { return !(now.value() / step < most_steps); }

}  // namespace

Time next_multiple(const Time& now, double step) {
  if (too_late(now, step)) return Time(std::numeric_limits<double>::infinity());
  double k = std::floor(now.value() / step);
  while (multiple(k, step) > now) k -= 1.0;
  while (!(multiple(k, step) > now)) k += 1.0;
  return multiple(k, step);
}

Vector centre_of_cell(const geometry::Lattice& lattice) {
  Vector sum{};
  for (const geometry::CellEdge& e : lattice.edges) sum = sum + e.segment.from;
  return (1.0 / static_cast<double>(lattice.edges.size())) * sum;
}

void fold_towards_centre(const geometry::Lattice& lattice, Vector centre, Vector& x, Cell& cell) {
  const auto distance = [&](const Vector& a) { return dot(a - centre, a - centre); };
  // Cell by cell; after 64 rounds by leaps that grow, then shrink. Beyond the longest leap x has no
  // digit left that says where in a cell it is, and stays as it is.
  constexpr std::int64_t longest = std::int64_t{1} << 50;
  std::int64_t leap = 1;
  for (int round = 0;; ++round) {
    bool moved = false;
    for (const geometry::CellEdge& e : lattice.edges) {
      const Cell beyond{leap * e.beyond.first, leap * e.beyond.second};
      const Vector nearer = x - lattice.translation(beyond);
      if (!(distance(nearer) < distance(x))) continue;  // strictly nearer: no going to and fro
      x = nearer;
      cell.first += beyond.first;
      cell.second += beyond.second;
      moved = true;
    }
    if (moved && leap == longest) return;
    if (moved && round >= 64)
      leap *= 2;
    else if (!moved && leap > 1)
      leap /= 2;
    else if (!moved)
      return;
  }
}

void Group::assign(std::vector<int> bodies, std::vector<Particle> particles) {
  const auto alike = [](const Particle& a, const Particle& b) {
    return a.mass == b.mass && a.charge == b.charge && a.omega == b.omega;
  };
  // A stepper may remember accelerations by position: it is kept for particles that are accelerated
  // alike.
  if (!std::equal(particles.begin(), particles.end(), particles_.begin(), particles_.end(), alike))
    stepper_.reset();
  bodies_ = std::move(bodies);
  particles_ = std::move(particles);
  passed_ = nullptr;
  last_energy_.reset();
  external_.position.clear();
  places_.assign(bodies_.size(), {});
  phase_.position.resize(bodies_.size());
  phase_.velocity.resize(bodies_.size());
  make_stepper();
  find_maps();
}

void Group::make_stepper() {
  if (stepper_) return;
  omega_.clear();
  masses_.clear();
  for (const Particle& p : particles_) {
    omega_.push_back(p.omega);
    masses_.push_back(p.mass);
  }
  stepper_ = carom::make_stepper(in_.plan, *this, omega_);
  path_ = std::make_unique<StepPath<double>>(*stepper_, *this, omega_);
}

void Group::accelerations(std::span<const Vector> x, std::span<Vector> a) const {
  std::fill(a.begin(), a.end(), Vector{});
  if (in_.counts) ++in_.counts->force_evaluations;
  if (!in_.forces || interrupted(100.0 * static_cast<double>(x.size()))) return;
  const ForceField& forces = *in_.forces;
  double energy = 0.0;
  if (forces.external())
    for (std::size_t i = 0; i < x.size(); ++i)
      energy += forces.add_external(particles_[i], x[i], a[i]);
  if (in_.remember_energy) {
    external_.position.assign(x.begin(), x.end());
    external_.energy = energy;
  }
  if (forces.interacts())
    forces.add_pairs(particles_, x, in_.lattice, a, listens_ ? in_.interrupt : nullptr);
  for (std::size_t i = 0; i < x.size(); ++i)
    if (particles_[i].mass != 1.0) a[i] = (1.0 / particles_[i].mass) * a[i];
}

double Group::potential_energy(std::span<const Vector> x) const {
  return in_.forces ? in_.forces->potential_energy(particles_, x, in_.lattice) : 0.0;
}

/// Tails end at a 1e-16th of a height. Where bumps overlap, many end in one step; their sums are
/// rounded, too.
double Group::energy_jumps() const {
  return in_.forces ? 64.0 * static_cast<double>(particles_.size()) * in_.forces->tail_bound()
                    : 0.0;
}

/// The time at which the step that begins now ends.
Time Group::step_end(const Time& limit) const {
  return part_ > 0.0 ? std::min(limit, next_multiple(time_, part_)) : limit;
}

void Group::drop_prediction() {
  next_ = {};
  under_way_ = evaluations() - began_at_;
  stepper_.reset();  // and all that it remembers
  checked_.position.clear();
  make_stepper();
}

const Group::Next& Group::predict(const Time& limit) {
  next_ = {};
  between_.duration = -1.0;
  under_way_ = 0;
  began_at_ = evaluations();
  if (in_.plan.step > 0.0 && too_late(time_, in_.plan.step)) {
    whole_step_ = false;
    next_.fault =
        "more than 2^52 steps lie behind it, and the next cannot be counted; a longer step goes "
        "farther";
    return next_;
  }
  listens_ = true;
  find_next(limit);
  listens_ = false;
  return next_;
}

void Group::find_next(const Time& limit) {
  const Barrier<double>* const passed = passed_;
  part_ = in_.plan.step;
  describes_ = !in_.plan.halve_unresolved;
  find_within(limit);
  if (in_.plan.halve_unresolved && !next_.fault.empty()) halve(limit, passed);
}

/// A step fails: the longest part of it that does not. If all fail, the whole one does. `passed`:
/// the edge that the step starts on.
void Group::halve(const Time& limit, const Barrier<double>* passed) {
  constexpr int most_halvings = 40;
  const Time whole_end = step_end(limit);
  for (int k = 1; k <= most_halvings && !interrupted(0.0); ++k) {
    part_ = std::ldexp(in_.plan.step, -k);
    if (too_late(time_, part_)) break;
    // A part that its start forbids need not be tried.
    const double rest = step_end(limit) - time_;
    if (!maps_.empty() &&
        !resolves(phase_, nullptr,
                  forces::resolution::span_of(resolution_radius(rest), largest_omega_)))
      continue;
    next_ = {};
    passed_ = passed;
    find_within(limit);
    if (!next_.fault.empty()) continue;
    next_.in_parts = next_.member < 0 && whole_step_ && path_end_ < whole_end;
    return;
  }
  part_ = in_.plan.step;
  describes_ = true;
  next_ = {};
  passed_ = passed;
  find_within(limit);
}

void Group::find_within(const Time& limit) {
  path_end_ = step_end(limit);
  const double rest = std::clamp(path_end_ - time_, 0.0, std::numeric_limits<double>::max());
  const double way = way_to_hit(rest);
  search(way, rest);
  if (!(way < rest) || next_.member >= 0 || interrupted(0.0)) return;
  next_ = {};  // no hit, though one was expected
  search(rest, rest);
}

/// Takes a step of a length, of what is left of the step under way, and finds what comes first.
void Group::search(double way, double rest) {
  next_.duration = path_->begin(phase_, way);
  whole_step_ = !(next_.duration < rest);
  next_.fault = fault_at(path_->end().phase);
  if (!next_.fault.empty()) return;
  next_.fault = check_resolution();
  next_.unresolved = !next_.fault.empty();
  if (next_.unresolved && !in_.plan.count_unresolved) return;
  next_.fault.clear();
  CrossingSearch<double> search(*path_);
  StepPath<double>::Knot* last = &path_->end();
  const std::vector<Near> near = near_walls(search);
  for (const Near& one : near) {
    if (search.gave_up() || interrupted(10.0)) break;
    path_->keep_few(*last);
    if (last != &path_->end() &&
        stays_off(*one.barrier, PathHull<double>(path_->start(), *last, one.member)))
      continue;
    StepPath<double>::Knot* found =
        is_edge(*one.barrier) ? first_exit(search, *one.barrier, *last)
                              : search.first(*one.barrier, one.member, path_->start(), *last);
    if (!found) continue;
    last = found;
    next_.member = static_cast<int>(one.member);
    next_.barrier = one.barrier;
    next_.duration = found->time;
    next_.slides = search.slides();
  }
  passed_ = nullptr;
  if (in_.interrupt && in_.interrupt->stopped()) return;
  if (search.gave_up())
    next_.fault =
        "the path of this step is too rough to find walls on it; the step is too long, or a "
        "potential has a pole";
  else if (next_.member >= 0)
    next_.fault = fault_at(last->phase);
  // Near a wall the search had to decide: no particle may have slipped through.
  if (!near.empty() && next_.fault.empty()) watch(last->phase);
}

/// Members and barriers that the step does not keep apart. Those of a group that cross first come
/// first: what another one does later need not be looked for.
std::vector<Group::Near> Group::near_walls(const CrossingSearch<double>& search) const {
  std::vector<Near> near;
  for (std::size_t i = 0; i < bodies_.size() && !in_.barriers.empty(); ++i) {
    if (interrupted(10.0 * static_cast<double>(in_.barriers.size()))) break;
    const PathHull<double> hull(path_->start(), path_->end(), i);
    for (const Barrier<double>& barrier : in_.barriers)
      if (!stays_off(barrier, hull)) near.push_back({i, &barrier, 0.0});
  }
  if (bodies_.size() == 1) return near;
  for (Near& one : near)
    one.about = search.guess(*one.barrier, one.member, path_->start(), path_->end());
  std::stable_sort(near.begin(), near.end(),
                   [](const Near& a, const Near& b) { return a.about < b.about; });
  return near;
}

/// The place from which the lone member flies on freely, on the edge. Nothing happens at an edge
/// while others or another support hold it: a step that were cut there would be cut on the way out
/// and not on the way back.
StepPath<double>::Knot* Group::first_exit(CrossingSearch<double>& search,
                                          const Barrier<double>& edge, StepPath<double>::Knot& to) {
  if (bodies_.size() > 1) return nullptr;
  StepPath<double>::Knot* found = search.first_exit(edge, 0, path_->start(), to, &edge == passed_);
  while (found && supported(found->phase.position.front(), &edge))
    found = search.first_exit(edge, 0, *found, to, true);
  return found;
}

void Group::watch(const Phase<double>& end) {
  if (!in_.inside) return;
  const int on_a_wall = next_.member >= 0 && !is_edge(*next_.barrier) ? next_.member : -1;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (static_cast<int>(i) == on_a_wall || in_.inside(end.position[i])) continue;
    next_.outside = static_cast<int>(i);
    next_.fault =
        "it has left the table within this step and no wall was found; the step is too long";
    return;
  }
}

/// Exact decisions are for numbers, and their squares must not overflow.
std::string_view Group::fault_at(const Phase<double>& phase) const {
  constexpr double absurd = 1e100;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Vector &x = phase.position[i], &v = phase.velocity[i];
    const double way =
        std::max(std::fabs(x.x - phase_.position[i].x), std::fabs(x.y - phase_.position[i].y));
    const double size = (std::fabs(x.x) + std::fabs(x.y)) + (std::fabs(v.x) + std::fabs(v.y));
    if (std::isnan(size))
      return stepper_->failure().empty() ? "a force or a state is not a number after this step"
                                         : stepper_->failure();
    if (!(size <= absurd))
      return "it runs away: a position or velocity is beyond 1e100 after this step";
    if (way > in_.longest_way)
      return "the step is too long for these walls: it leads a thousand times through the table, "
             "or beyond the "
             "next cell";
  }
  return {};
}

void Group::advance() {
  if (in_.counts) {
    StepCounts taken{.steps = 1};
    if (next_.unresolved) taken = {.steps = 1, .unresolved = 1, .first_unresolved = time_.value()};
    if (part_ < in_.plan.step) taken = {.steps = 1, .halved = 1, .shortest_part = part_};
    *in_.counts += taken;
  }
  phase_ = next_.member < 0 ? path_->end().phase : path_->at(next_.duration).phase;
  for (Place& at : places_) at.wall = -1;
  time_ = next_time();
}

State Group::state_at(std::size_t member, const Time& time) {
  State s;
  const double duration = time - time_;
  // Not as a knot of the path: samples may be many.
  if (duration > 0.0 && duration != between_.duration) {
    const std::uint64_t before = evaluations();
    listens_ = true;
    path_->move(duration, between_.phase);
    listens_ = false;
    under_way_ += evaluations() - before;
    between_.duration = in_.interrupt && in_.interrupt->stopped() ? -1.0 : duration;
  }
  const Phase<double>& phase = duration > 0.0 ? between_.phase : phase_;
  s.position = phase.position[member];
  s.velocity = phase.velocity[member];
  s.cell = places_[member].cell;
  s.time = time;
  return s;
}

double Group::kinetic_energy() const {
  double sum = 0.0;
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    sum += 0.5 * particles_[i].mass * dot(phase_.velocity[i], phase_.velocity[i]);
  return sum;
}

double Group::energy() {
  double sum = kinetic_energy();
  if (!in_.forces) return sum;
  const ForceField& forces = *in_.forces;
  if (forces.external() && external_.position == phase_.position) {
    sum += external_.energy;
  } else if (forces.external()) {
    Vector unused{};
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      sum += forces.add_external(particles_[i], phase_.position[i], unused);
  }
  return sum + forces.pair_energy(particles_, phase_.position, in_.lattice, in_.interrupt);
}

double Group::change_of_energy() {
  const double now = energy(), before = last_energy_.value_or(now);
  // An interrupted sum is no sum: the change is seen the next time.
  if (in_.interrupt && in_.interrupt->stopped()) return 0.0;
  last_energy_ = now;
  return now - before;
}

void Group::forget() {
  stepper_->forget();
  path_->forget();
}

void Group::remove(std::size_t member) {
  last_energy_.reset();
  external_.position.clear();
  if (bodies_.size() == 1) return bodies_.clear();  // the next member uses the rest again
  const auto i = static_cast<std::ptrdiff_t>(member);
  bodies_.erase(bodies_.begin() + i);
  particles_.erase(particles_.begin() + i);
  places_.erase(places_.begin() + i);
  phase_.position.erase(phase_.position.begin() + i);
  phase_.velocity.erase(phase_.velocity.begin() + i);
  stepper_.reset();
  make_stepper();
  find_maps();
}

void Group::fold(std::size_t member) {
  if (!in_.lattice) return;
  Vector& x = phase_.position[member];
  const Vector before = x;
  // The forces have the lattice's period: what is known of them about a point holds for its copies.
  const bool checked = member < checked_.position.size() && checked_.position[member] == x;
  fold_towards_centre(*in_.lattice, in_.centre, x, places_[member].cell);
  if (checked) checked_.position[member] = x;
  if (member < far_.centre.size()) far_.centre[member] = far_.centre[member] + (x - before);
}

bool Group::supported(Vector x, const Barrier<double>* except) const {
  return in_some_support(in_.supports, x, except);
}

}  // namespace carom::events
