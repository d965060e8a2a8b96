// [[injection]].
#include "files/toml/read.hpp"

namespace carom::files {
namespace {

std::vector<double> read_times(const Value& list, double t_max) {
  std::vector<double> times;
  for (const Value& item : as_list(list).items) {
    const double t = as_double(item);
    if (t < 0)
      throw InputError(item.place, "must not be negative, but is " + item.text, "a time >= 0");
    if (!times.empty() && !(t > times.back()))
      throw InputError(item.place, "the times do not increase at " + item.text,
                       "times in increasing order");
    if (t > t_max)
      throw InputError(item.place, "the time " + item.text + " comes after t_max = " + shown(t_max),
                       "times up to run.t_max");
    times.push_back(t);
  }
  if (times.empty()) throw InputError(list.place, "the list is empty", "at least one time");
  return times;
}

Injection read_injection(Value& value, const Table& table, const Particle& first, double t_max) {
  TomlSection section(value, "injection");
  section.check_keys();
  section.exclude("times", "rate");
  Injection injection;
  injection.place = value.place;
  const Value& hole = section.get("hole");
  injection.hole = hole_named(table, as_text(hole), hole.place);
  if (const Value* rate = section.find("rate")) {
    injection.rate = as_positive(*rate);
  } else if (const Value* times = section.find("times")) {
    injection.times = read_times(*times, t_max);
  } else {
    throw InputError(section.place_of("times"), "neither times nor rate is given", "one of them");
  }
  injection.particle = first;
  if (const Value* speed = section.find("speed")) injection.particle.speed = as_positive(*speed);
  return injection;
}

}  // namespace

std::vector<Injection> read_injections(Value& root, const Table& table,
                                       const std::vector<Particle>& particles, double t_max) {
  std::vector<Injection> injections;
  Value* list = root.find("injection");
  if (list == nullptr) return injections;
  as_sections(*list, "hole = \"hole_1\"");
  double expected = static_cast<double>(particles.size());
  for (Value& one : list->items) {
    injections.push_back(read_injection(one, table, particles.front(), t_max));
    const Injection& injection = injections.back();
    expected +=
        injection.rate > 0.0 ? injection.rate * t_max : static_cast<double>(injection.times.size());
    if (!(expected <= static_cast<double>(most_particles)))
      throw InputError(
          one.place,
          "too many particles enter: " + shown(expected) + " until t_max = " + shown(t_max),
          "at most 1000000 particles in a trajectory");
  }
  return injections;
}

}  // namespace carom::files
