#include "systems.hpp"

#include <map>
#include <utility>

#include "carom/analyses/section.hpp"
#include "carom/base/error.hpp"
#include "carom/engines/trajectories.hpp"

namespace carom::page {

namespace {

std::map<int, std::shared_ptr<OpenSystem>>& open_systems() {
  static std::map<int, std::shared_ptr<OpenSystem>> all;
  return all;
}

// What the program calls a system of this text, in messages and in the command that is shown.
std::string name_of(const std::string& toml) {
  for (const BuiltinSystem& one : builtin_systems())
    if (one.toml == toml) return std::string(one.name);
  return "SYSTEM.toml";
}

System with_starts(System system, InitialCondition::Kind kind) {
  system.initial.kind = kind;
  if (kind == InitialCondition::Kind::birkhoff) {
    system.initial.wall = -1;
    system.initial.s = system.initial.v_parallel = {0.0};
  }
  return system;
}

}  // namespace

Starts::Starts(const System& other, InitialCondition::Kind kind)
    : system(with_starts(other, kind)), sampler(system) {}

OpenSystem::OpenSystem(std::string text)
    : toml(std::move(text)),
      name(name_of(toml)),
      loaded(read_system(toml, name)),
      frames(frames_of(*system().table)),
      offsets{0.0},
      world(make_world(system())),
      as_written(system(), system().initial.kind),
      at_point(system(), InitialCondition::Kind::point),
      on_wall(system(), InitialCondition::Kind::birkhoff) {
  for (const geometry::CurveFrame& frame : frames)
    offsets.push_back(offsets.back() + geometry::length(frame));
}

Json load(const Request& request) {
  static int last = 0;
  auto system = std::make_shared<OpenSystem>(text_of(request, "toml"));
  Json json = Json::object().set("system", ++last);
  json.add(outline(*system));
  open_systems().emplace(last, std::move(system));
  return json;
}

std::shared_ptr<OpenSystem> system_of(const Request& request) {
  const auto found = open_systems().find(request.get("system", 0));
  if (found == open_systems().end()) throw InputError("the page has not loaded this system");
  return found->second;
}

Json unload(const Request& request) {
  open_systems().erase(request.get("system", 0));
  return Json::object();
}

}  // namespace carom::page
