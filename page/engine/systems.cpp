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

}  // namespace

OpenSystem::OpenSystem(std::string text)
    : toml(std::move(text)),
      name(name_of(toml)),
      loaded(read_system(toml, name)),
      frames(frames_of(*system().table)),
      offsets{0.0},
      world(make_world(system())) {
  for (const geometry::CurveFrame& frame : frames)
    offsets.push_back(offsets.back() + geometry::length(frame));
}

Starts& OpenSystem::starts() {
  if (!starts_) starts_.emplace(system());
  return *starts_;
}

Starts& OpenSystem::starts_at(InitialCondition::Kind kind) {
  if (const auto found = others_.find(kind); found != others_.end()) return found->second;
  System other = system();
  other.initial = {.kind = kind, .s = {0.0}, .v_parallel = {0.0}, .place = other.initial.place};
  return others_.try_emplace(kind, std::move(other)).first->second;
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
