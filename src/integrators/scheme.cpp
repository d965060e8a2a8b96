#include "carom/integrators/scheme.hpp"

namespace carom {

const Scheme& default_scheme() { return find_scheme("blanes-moan-srkn11b"); }

bool is_adaptive(std::string_view name) { return name == "arkode" || name == "cvode"; }

const Scheme& find_scheme(const std::string& name) { return find_scheme(name, Place{}); }

const Scheme& find_scheme(const std::string& name, const Place& place) {
  if (name.empty()) return default_scheme();
  std::vector<std::string> names;
  std::string list;
  for (const Scheme& scheme : schemes()) {
    if (scheme.name == name) return scheme;
    names.emplace_back(scheme.name);
    list += names.back() + ", ";
  }
  for (const char* adaptive : {"arkode", "cvode"}) names.emplace_back(adaptive);
  throw InputError(place, "unknown scheme '" + name + "'", "one of " + list + "arkode, cvode",
                   nearest_name(name, names));
}

}  // namespace carom
