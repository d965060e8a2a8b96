#include "carom/starts/sampler.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "carom/base/elementary.hpp"
#include "carom/base/error.hpp"
#include "carom/base/random.hpp"
#include "carom/events/world.hpp"
#include "carom/geometry/hull.hpp"
#include "starts/start_formulas.hpp"

namespace carom {

namespace {

using geometry::Vector;
using starts::impossible;
using starts::put_off_walls;
using starts::unit;
using Kind = InitialCondition::Kind;

// A box of which the domain fills less than about 1e-5, or a line of which 5e-4, is reported as
// missed: within seconds even if each of the points needs exact arithmetic. A single point is drawn
// once.
constexpr std::int64_t most_tries = 1'000'000, most_tries_of_a_line = 30'000;

std::int64_t tries_in(Vector low, Vector high) {
  const bool no_width = low.x == high.x, no_height = low.y == high.y;
  return no_width && no_height ? 1 : no_width || no_height ? most_tries_of_a_line : most_tries;
}

InputError none_inside(const InitialCondition& initial, const char* where, const char* expected) {
  return impossible(initial, fmt::format("no point of {} was found inside the table", where),
                    expected);
}

InputError missed_rectangle(const InitialCondition& initial, const char* where = "the rectangle") {
  return none_inside(initial, where, "a region that overlaps the table");
}

InputError missed_line(const InitialCondition& initial) {
  return none_inside(initial, "the line", "a line that crosses the table");
}

geometry::Box domain_box(const Table& table) {
  if (table.extent == Extent::lattice) {
    const auto& edges = table.lattice->edges;
    geometry::Box box{edges.front().segment.from, edges.front().segment.from};
    for (const auto& edge : edges) box = hull(box, edge.segment.to);
    return box;
  }
  return geometry::hull_of(table.walls,
                           [](const Wall& wall) { return geometry::bounding_box(wall.curve); });
}

// Is all of a box outside or on the edge of that around a bounded table? Domains are open.
bool beside(const Table& table, Vector low, Vector high) {
  if (table.extent != Extent::bounded) return false;
  const geometry::Box box = domain_box(table);
  return !(low.x < box.high.x && high.x > box.low.x && low.y < box.high.y && high.y > box.low.y);
}

}  // namespace

Sampler::Sampler(const System& system, const std::atomic<bool>* interrupted)
    : Sampler(system, interrupted
                          ? [interrupted] { return interrupted->load(std::memory_order_relaxed); }
                          : std::function<bool()>()) {}

Sampler::Sampler(const System& system, std::function<bool()> stopped)
    : system_(system), stopped_(std::move(stopped)) {
  const Table& table = *system.table;
  const InitialCondition& initial = system.initial;
  for (const Wall& wall : table.walls) frames_.push_back(geometry::frame_of(wall.curve));
  walls_ = initial.walls;
  if (walls_.empty()) {
    walls_.resize(table.walls.size());
    std::iota(walls_.begin(), walls_.end(), 0);
  }
  const bool on_a_wall = initial.kind == Kind::boundary || initial.kind == Kind::hole ||
                         initial.kind == Kind::birkhoff;
  if (on_a_wall && system.of_discs())
    throw impossible(initial, "a hard disc cannot start on a wall",
                     "\"uniform\", \"rectangle\", \"line\", \"point\" or \"list\"");
  switch (initial.kind) {
    case Kind::uniform:
    case Kind::sobol: {
      if (table.extent == Extent::open_plane)
        throw impossible(initial, "a uniform start needs a bounded table or a lattice",
                         "\"rectangle\", \"line\", \"point\" or \"boundary\"");
      const geometry::Box box = domain_box(table);
      low_ = box.low;
      high_ = box.high;
      if (initial.kind == Kind::sobol) prepare_quasi_random();
      break;
    }
    case Kind::boundary:
      if (initial.hole >= 0) add_holes(initial.hole);
      for (const int wall : walls_)
        if (initial.hole < 0) add_source(wall, 0.0, frames_[static_cast<std::size_t>(wall)].end);
      if (sources_.empty()) throw impossible(initial, "the table has no wall to start from");
      break;
    case Kind::hole:
      add_holes(initial.hole);
      if (sources_.empty()) throw impossible(initial, "the table has no hole to start from");
      break;
    case Kind::birkhoff:
      if (initial.s.empty() || initial.s.size() != initial.v_parallel.size())
        throw impossible(initial, "s and v_parallel must be given in pairs");
      if (walls_.empty()) throw impossible(initial, "the table has no wall to start from");
      break;
    case Kind::rectangle:
      if (beside(table, initial.low, initial.high)) throw missed_rectangle(initial);
      break;
    case Kind::line:
      if (beside(table,
                 {std::min(initial.from.x, initial.to.x), std::min(initial.from.y, initial.to.y)},
                 {std::max(initial.from.x, initial.to.x), std::max(initial.from.y, initial.to.y)}))
        throw missed_line(initial);
      break;
    case Kind::point:
    case Kind::list:
      break;
  }
}

/// One hole or all (-1). A hole across the parameter 0 of a closed wall is stored as two of one
/// name.
void Sampler::add_holes(int hole) {
  const std::vector<Hole>& holes = system_.table->holes;
  for (const Hole& one : holes)
    if (hole < 0 || one.name == holes.at(static_cast<std::size_t>(hole)).name)
      add_source(one.wall, one.from, one.to);
}

void Sampler::add_source(int wall, double from, double to) {
  const geometry::CurveFrame& frame = frames_[static_cast<std::size_t>(wall)];
  // Segment: |dr/du| is its length. Conic: |dr/dw| = 2 |dr/dphi| / (1 + w^2) <= 2 major semi-axis;
  // the few ulps of rounding only shave the acceptance probability's top, where it is 1 anyway.
  const double bound = frame.kind == geometry::CurveFrame::Kind::segment
                           ? std::sqrt(dot(frame.a, frame.a))
                       : frame.bezier ? 1.5 * frame.bezier->speed
                                      : 2.0 * std::max(frame.major, frame.minor);
  const double before = sources_.empty() ? 0.0 : sources_.back().weight;
  sources_.push_back({wall, from, to, bound, before + bound * (to - from)});
}

/// Whether a start is possible is the first trajectory's to say (check_start). With its limit, one
/// of a great many later ones would fail by chance.
std::int64_t Sampler::patience(std::int64_t of_the_first, std::uint64_t trajectory) {
  return trajectory == 0 ? of_the_first : 1000 * of_the_first;
}

bool Sampler::draws_free_points() const {
  const Dynamics& dynamics = system_.dynamics;
  return (system_.initial.kind == Kind::uniform || system_.initial.kind == Kind::rectangle) &&
         system_.particles.size() == 1 && system_.particles[0].speed != 0.0 &&
         !system_.of_discs() && !(dynamics.forces && dynamics.forces->external());
}

void Sampler::draw_several(const World& world, std::uint64_t first, std::span<State> states) const {
  if (!draws_free_points()) {
    for (State& state : states) state = draw(world, first++, 0);
    return;
  }
  const auto random = [&](std::uint64_t trajectory, std::uint64_t block) {
    return RandomStream(system_.run.seed, Purpose::initial_state, trajectory, 0, block);
  };
  const bool of_table = system_.initial.kind == Kind::uniform;
  const Vector low = of_table ? low_ : system_.initial.low,
               high = of_table ? high_ : system_.initial.high;
  const double speed = system_.particles[0].speed;
  constexpr std::size_t most = 64;
  std::array<RandomStream::Block, most> words;
  std::array<Vector, most> positions, directions;
  while (!states.empty()) {
    const std::size_t count = std::min(most, states.size());
    // One thing for all starts, then the next: rounds of a loop do not need each other, so that the
    // processor works on several at once.
    for (std::size_t i = 0; i < count; ++i)
      RandomStream::block(system_.run.seed, Purpose::initial_state, first + i, 0, 0, words[i]);
    for (std::size_t i = 0; i < count; ++i) {
      const auto& [right, up, x, y] = words[i];
      positions[i] =
          starts::point_of_box(low, high, RandomStream::uniform(right), RandomStream::uniform(up));
      directions[i] = {RandomStream::symmetric(x), RandomStream::symmetric(y)};
    }
    for (std::size_t i = 0; i < count; ++i)
      if (!RandomStream::in_disc(directions[i].x, directions[i].y))
        random(first + i, 1).point_in_disc(directions[i].x, directions[i].y);
    for (std::size_t i = 0; i < count; ++i) directions[i] = speed * starts::unit(directions[i]);
    for (std::size_t i = 0; i < count; ++i) {
      starts::put_off_walls(states[i], *system_.table, positions[i], directions[i]);
      // With another point the direction is another, too.
      if (!admits(world, states[i])) states[i] = draw(world, first + i, 0);
    }
    first += count;
    states = states.subspan(count);
  }
}

State Sampler::draw(const World& world, std::uint64_t trajectory, int particle) const {
  const Dynamics& dynamics = system_.dynamics;
  if (dynamics.forces && (dynamics.forces->interacts() || system_.of_discs()) &&
      system_.particles.size() > 1)
    return draw_all(world, trajectory)[static_cast<std::size_t>(particle)];
  if (dynamics.forces && dynamics.forces->external())
    return draw_external(world, trajectory, particle);
  RandomStream random(system_.run.seed, Purpose::initial_state, trajectory,
                      static_cast<std::uint64_t>(particle));
  return draw_free(world, random, trajectory, particle);
}

/// The start of a particle on which nothing acts, at its own speed.
State Sampler::draw_free(const World& world, RandomStream& random, std::uint64_t trajectory,
                         int particle, bool again) const {
  const InitialCondition& initial = system_.initial;
  const double speed = system_.particles.at(static_cast<std::size_t>(particle)).speed;
  // Listed starts go to one particle after the other.
  const std::uint64_t number =
      trajectory * system_.particles.size() + static_cast<std::uint64_t>(particle);
  switch (initial.kind) {
    case Kind::uniform:
      return in_box(world, random, trajectory, low_, high_, speed, "the box around the table");
    case Kind::sobol:
      return quasi_random(world, random, trajectory, speed, again);
    case Kind::rectangle:
      return in_box(world, random, trajectory, initial.low, initial.high, speed, "the rectangle");
    case Kind::line:
      return on_line(world, random, trajectory, speed);
    case Kind::point:
      return at_point(world, initial.position, initial.velocity, speed);
    case Kind::list: {
      const auto i = static_cast<std::size_t>(number % initial.positions.size());
      return at_point(world, initial.positions[i], initial.velocities[i], speed);
    }
    case Kind::boundary:
    case Kind::hole:
      return cosine_law(random, speed);
    case Kind::birkhoff:
      return birkhoff(number, speed);
  }
  throw InternalError("unknown kind of initial condition");
}

State Sampler::in_box(const World& world, RandomStream& random, std::uint64_t trajectory,
                      Vector low, Vector high, double speed, const char* where) const {
  const std::int64_t most = low == high ? 1 : patience(tries_in(low, high), trajectory);
  for (std::int64_t tries = 0; tries < most; ++tries) {
    stop_if_asked(tries);
    const double right = random.uniform(), up = random.uniform();
    State state;
    put_off_walls(state, *system_.table, starts::point_of_box(low, high, right, up), {});
    if (!admits(world, state)) continue;
    Vector direction;
    random.point_in_disc(direction.x, direction.y);
    if (speed != 0.0) state.velocity = speed * unit(direction);
    return state;
  }
  throw missed_rectangle(system_.initial, where);
}

/// The box of a lattice's cell overlaps its neighbours: what lies there is drawn again, or points
/// near the edges would be too frequent.
bool Sampler::admits(const World& world, const State& state) const {
  const bool own_cell = system_.initial.kind != Kind::uniform || state.cell == geometry::Cell{};
  return own_cell && world.contains(state.position);
}

State Sampler::on_line(const World& world, RandomStream& random, std::uint64_t trajectory,
                       double speed) const {
  const InitialCondition& initial = system_.initial;
  Vector direction = initial.velocity;
  if (direction == Vector{}) {
    const elementary::SinCos turned = elementary::sincos(initial.angle);
    direction = {turned.cos, turned.sin};
  }
  const Vector velocity = speed == 0.0 ? Vector{} : speed * unit(direction);
  const std::int64_t most =
      initial.from == initial.to ? 1 : patience(most_tries_of_a_line, trajectory);
  for (std::int64_t tries = 0; tries < most; ++tries) {
    stop_if_asked(tries);
    const Vector point = initial.from + random.uniform() * (initial.to - initial.from);
    State state;
    put_off_walls(state, *system_.table, point, velocity);
    if (world.contains(state.position)) return state;
  }
  throw missed_line(initial);
}

State Sampler::at_point(const World& world, Vector position, Vector given, double speed) const {
  const InitialCondition& initial = system_.initial;
  if (given == Vector{} && speed != 0.0) throw impossible(initial, "the velocity is zero");
  // A disc may rest, and a particle under forces; a velocity that already has the speed is taken as
  // it is, digit for digit.
  Vector velocity = std::sqrt(dot(given, given)) == speed ? given : speed * unit(given);
  if (speed == 0.0) velocity = {};
  State state;
  put_off_walls(state, *system_.table, position, velocity);
  if (!world.contains(state.position))
    throw impossible(
        initial, fmt::format("the start ({}, {}) is not inside the table", position.x, position.y),
        system_.of_discs() ? "a point farther from the walls than the disc's radius"
                           : "a point inside, off the walls; kind = \"birkhoff\" starts on a wall");
  return state;
}

State Sampler::cosine_law(RandomStream& random, double speed) const {
  for (;;) {
    const double target = random.uniform() * sources_.back().weight;
    const auto source =
        std::upper_bound(sources_.begin(), sources_.end() - 1, target,
                         [](double value, const Source& s) { return value < s.weight; });
    const geometry::CurveFrame& frame = frames_[static_cast<std::size_t>(source->wall)];
    double u = source->from + random.uniform() * (source->to - source->from);
    u = std::clamp(u, std::max(source->from, geometry::first_parameter), frame.last);
    if (frame.kind != geometry::CurveFrame::Kind::segment) {
      // Uniform in arc length: accept in proportion to |dr/du|.
      const double w = u - std::floor(u);
      const Vector tangent = geometry::direction_at(frame, u);
      const double rate = frame.bezier ? frame.bezier->rate(u)
                                       : 2.0 * std::sqrt(dot(tangent, tangent)) / (1.0 + w * w);
      if (random.uniform() * source->bound >= rate) continue;
    }
    const double sine = random.symmetric();
    const double cosine = std::sqrt((1.0 - sine) * (1.0 + sine));
    return on_wall(source->wall, u, sine, cosine, speed);
  }
}

State Sampler::birkhoff(std::uint64_t number, double speed) const {
  const InitialCondition& initial = system_.initial;
  const std::size_t i = static_cast<std::size_t>(number % initial.s.size());
  double s = initial.s[i];
  const double tangential = initial.v_parallel[i];
  if (!(std::abs(tangential) < speed))
    throw impossible(initial,
                     fmt::format("v_parallel = {} is not below the speed {}", tangential, speed),
                     "-speed < v_parallel < speed");
  // Along several walls s runs on from one to the next.
  auto at = walls_.begin();
  const auto index = [&] { return static_cast<std::size_t>(*at); };
  while (at + 1 != walls_.end() && s >= geometry::length(frames_[index()])) {
    s -= geometry::length(frames_[index()]);
    ++at;
  }
  const std::size_t wall = index();
  const double length = geometry::length(frames_[wall]);
  if (!(s >= 0.0 && s < length))
    throw impossible(initial, fmt::format("s = {} is not on the wall '{}' of length {}",
                                          initial.s[i], system_.table->walls[wall].name, length));
  const double u = std::clamp(geometry::parameter_at_length(frames_[wall], s),
                              geometry::first_parameter, frames_[wall].last);
  const double normal = std::sqrt((speed - tangential) * (speed + tangential));
  return on_wall(static_cast<int>(wall), u, tangential, normal, speed);
}

State Sampler::on_wall(int wall, double u, double tangential, double normal, double speed) const {
  const geometry::CurveFrame& frame = frames_[static_cast<std::size_t>(wall)];
  State state;
  state.wall = wall;
  state.u = u;
  state.position = geometry::point_at(frame, u);
  const Vector inward = geometry::normal_at(frame, u);
  state.velocity = speed * unit(tangential * right(inward) + normal * inward);
  return state;
}

}  // namespace carom
