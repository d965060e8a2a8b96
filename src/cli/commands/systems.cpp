// carom systems: the built-in systems.
#include <fmt/format.h>

#include <algorithm>

#include "carom/base/error.hpp"
#include "cli/commands/commands.hpp"
#include "cli/common.hpp"
#include "cli/reports/aligned.hpp"

namespace carom::cli {

using files::Json;

int systems(const Options& options) {
  const std::vector<BuiltinSystem>& all = builtin_systems();
  if (!options.system.empty()) {
    const auto found = std::find_if(
        all.begin(), all.end(), [&](const BuiltinSystem& s) { return s.name == options.system; });
    if (found == all.end()) {
      std::vector<std::string> names;
      for (const BuiltinSystem& s : all) names.emplace_back(s.name);
      throw InputError(Place{}, fmt::format("there is no built-in system '{}'", options.system),
                       "a name that `carom systems` lists", nearest_name(options.system, names));
    }
    if (!options.json) {
      print(std::string(found->toml));
      return done;
    }
    Json json = Json::object();
    add_common_keys(json, load_system(options.system).system, 1, 0.0, 0.0);
    json.set("toml", found->toml);
    print(json.text() + "\n");
    return done;
  }
  Json list = Json::array();
  std::string text = "Built-in systems (carom systems NAME prints one as TOML):\n";
  for (const BuiltinSystem& s : all) {
    const std::string title = load_system(std::string(s.name)).system.title;
    text += folded(fmt::format("  {:<20} {}", s.name, title), std::string(23, ' ')) + "\n";
    list.push(Json::object().set("name", s.name).set("title", title));
  }
  if (!options.json) {
    print(text);
    return done;
  }
  Json json = Json::object();
  System none;
  add_common_keys(json, none, 1, 0.0, 0.0);
  json.set("systems", std::move(list));
  print(json.text() + "\n");
  return done;
}

}  // namespace carom::cli
