#include <algorithm>
#include <cmath>
#include <numeric>

#include "files/toml/read.hpp"
#include "table/direction.hpp"
#include "table/shapes.hpp"

namespace carom::files {
namespace {

using Kind = InitialCondition::Kind;

constexpr std::uint64_t most_values = 10000000;

const std::vector<std::pair<std::string, Kind>>& kinds() {
  static const std::vector<std::pair<std::string, Kind>> list{
      {"uniform", Kind::uniform},     {"sobol", Kind::sobol}, {"boundary", Kind::boundary},
      {"hole", Kind::hole},           {"point", Kind::point}, {"birkhoff", Kind::birkhoff},
      {"rectangle", Kind::rectangle}, {"line", Kind::line},   {"list", Kind::list}};
  return list;
}

/// One coordinate of a Birkhoff start: a number, a list, or a grid.
struct Axis {
  std::vector<double> values;
  bool grid = false;
  bool list = false;
};

Axis read_axis(Value& value) {
  Axis axis;
  if (value.kind == Value::Kind::table) {
    TomlSection section(value, "initial.grid");
    section.check_keys();
    const double from = as_double(section.get("from")), to = as_double(section.get("to"));
    axis.values = spaced(from, to, as_count(section.get("count"), 2, most_values), false);
    axis.grid = true;
  } else if (value.kind == Value::Kind::list) {
    for (const Value& item : value.items) axis.values.push_back(as_double(item));
    axis.list = true;
    if (axis.values.empty())
      throw InputError(value.place, "the list is empty", "at least one number");
  } else {
    axis.values.push_back(as_double(value));
  }
  return axis;
}

// Lists go in pairs, grids with everything; s runs fastest.
void combine(const Axis& s, const Axis& v, const Place& place, InitialCondition& initial) {
  if (s.list && v.list) {
    if (s.values.size() != v.values.size()) {
      throw InputError(place, "the lists s and v_parallel differ in length",
                       "lists of equal length, or a grid");
    }
    initial.s = s.values;
    initial.v_parallel = v.values;
    return;
  }
  if (s.values.size() * v.values.size() > most_values) {
    throw InputError(place, "too many starts", "at most " + std::to_string(most_values));
  }
  for (const double v_parallel : v.values) {
    for (const double arc_length : s.values) {
      initial.s.push_back(arc_length);
      initial.v_parallel.push_back(v_parallel);
    }
  }
}

void read_birkhoff(TomlSection& section, const Table& table, const std::vector<Particle>& particles,
                   InitialCondition& initial) {
  const Value& wall = section.get("wall");
  initial.walls = table::shapes::stretch_named(as_text(wall), wall.place, table);
  Value& s = section.get("s");
  const Axis s_axis = read_axis(s);
  Value& v = section.get("v_parallel");
  const Axis v_axis = read_axis(v);
  double length = 0.0;
  for (const int k : initial.walls) length += geometry::length(table.wall(k).curve);
  for (const double value : s_axis.values) {
    if (value >= 0 && value < length) continue;
    throw InputError(s.place, "the wall has no arc length " + shown(value),
                     "0 <= s < " + shown(length) + ", the length of the wall");
  }
  double speed = particles.front().speed;
  for (const Particle& p : particles) speed = std::min(speed, p.speed);
  for (const double value : v_axis.values) {
    if (std::fabs(value) < speed) continue;
    throw InputError(v.place, "v_parallel " + shown(value) + " leaves no speed normal to the wall",
                     "|v_parallel| < " + shown(speed) + ", the speed");
  }
  combine(s_axis, v_axis, v.place, initial);
}

/// Under forces a particle of speed 0 may start so.
void check_not_zero(const geometry::Vector& velocity, const Place& place, bool rests) {
  if (velocity == geometry::Vector{} && !rests)
    throw InputError(place, "the velocity is zero", "a velocity that is not zero");
}

/// A start of zero velocity gives its particle the speed 0, unless another speed is set.
bool rests(const Particle& p) { return p.speed == 0.0; }

void read_point(TomlSection& section, const std::vector<Particle>& particles,
                InitialCondition& initial) {
  const Value& position = section.get("position");
  initial.position = as_vector(position);
  initial.place = position.place;
  section.exclude("velocity", "angle");
  if (const Value* angle = section.find("angle")) {
    initial.velocity = table::direction(as_angle(*angle));
    return;
  }
  if (!section.has("velocity")) {
    throw InputError(section.place_of("velocity"), "neither velocity nor angle is given",
                     "one of them");
  }
  const Value& velocity = section.get("velocity");
  initial.velocity = as_vector(velocity);
  check_not_zero(initial.velocity, velocity.place,
                 std::all_of(particles.begin(), particles.end(), rests));
}

void read_list(TomlSection& section, const std::vector<Particle>& particles,
               InitialCondition& initial) {
  const Value& starts = section.get("starts");
  initial.place = starts.place;
  // Trajectory after trajectory, a particle comes to each start that is a multiple of this away
  // from its first one.
  const std::size_t apart = std::gcd(particles.size(), as_list(starts).items.size());
  for (const Value& row : as_list(starts).items) {
    bool all_rest = true;
    for (std::size_t p = initial.positions.size() % apart; p < particles.size(); p += apart)
      all_rest = all_rest && rests(particles[p]);
    const std::vector<ExactNumber> numbers = as_numbers(row);
    if (numbers.size() != 4)
      throw InputError(row.place, "a start has four numbers", "[x, y, vx, vy]");
    initial.positions.push_back({numbers[0].to_double(), numbers[1].to_double()});
    initial.velocities.push_back({numbers[2].to_double(), numbers[3].to_double()});
    check_not_zero(initial.velocities.back(), row.place, all_rest);
  }
  if (initial.positions.empty())
    throw InputError(starts.place, "the list is empty", "at least one start");
}

void read_rectangle(TomlSection& section, InitialCondition& initial) {
  const Value& min = section.get("min");
  initial.low = as_vector(min);
  initial.place = min.place;
  const Value& max = section.get("max");
  initial.high = as_vector(max);
  if (initial.low.x <= initial.high.x && initial.low.y <= initial.high.y) return;
  throw InputError(max.place, "max lies below min", "max.x >= min.x and max.y >= min.y");
}

}  // namespace

InitialCondition read_initial(Value& root, const Table& table,
                              const std::vector<Particle>& particles) {
  Value& value = *root.find("initial");
  take_starts_from_file(value);
  std::vector<std::string> names;
  for (const auto& [name, kind] : kinds()) names.push_back(name);
  names.push_back("file");
  const std::string name = read_kind(value, "initial", "kind", names);
  TomlSection section(value, "initial", name);
  section.check_keys();
  InitialCondition initial;
  initial.place = value.place;
  for (const auto& [known, kind] : kinds()) {
    if (known == name) initial.kind = kind;
  }
  if ((initial.kind == Kind::boundary || initial.kind == Kind::hole) &&
      std::any_of(particles.begin(), particles.end(), rests))
    throw InputError(section.get("kind").place, "a particle at rest cannot start on a wall",
                     "a speed > 0, or a start inside");
  switch (initial.kind) {
    case Kind::uniform:
    case Kind::sobol:
      // Where nothing was written, only what flies needs starts (Sampler).
      if (table.extent == Extent::open_plane && section.get("kind").place.line > 0) {
        throw InputError(section.get("kind").place, "the open plane has no uniform distribution",
                         "kind = \"boundary\", \"rectangle\" or another");
      }
      break;
    case Kind::boundary:
      section.exclude("wall", "hole");
      if (const Value* wall = section.find("wall"))
        initial.walls = table::shapes::walls_named(as_text(*wall), wall->place, table);
      if (const Value* hole = section.find("hole"))
        initial.hole = hole_named(table, as_text(*hole), hole->place);
      break;
    case Kind::hole: {
      const Value& hole = section.get("hole");
      initial.hole = hole_named(table, as_text(hole), hole.place);
      break;
    }
    case Kind::point:
      read_point(section, particles, initial);
      break;
    case Kind::birkhoff:
      read_birkhoff(section, table, particles, initial);
      break;
    case Kind::list:
      read_list(section, particles, initial);
      break;
    case Kind::rectangle:
      read_rectangle(section, initial);
      break;
    case Kind::line:
      initial.place = section.get("from").place;
      initial.from = as_vector(section.get("from"));
      initial.to = as_vector(section.get("to"));
      const ExactNumber angle = as_angle(section.get("angle"));
      initial.angle = angle.to_double();
      initial.velocity = table::direction(angle);
      break;
  }
  return initial;
}

}  // namespace carom::files
