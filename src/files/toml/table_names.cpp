#include "files/toml/read.hpp"

#include <algorithm>
#include <vector>

#include "files/toml/toml_section.hpp"

namespace carom::files {

int hole_named(const Table& table, const std::string& name, const Place& place) {
  const int hole = table.hole_index(name);
  if (hole >= 0) return hole;
  std::vector<std::string> names;  // each once: a hole over a wall's start has two entries
  for (const Hole& h : table.holes)
    if (std::find(names.begin(), names.end(), h.name) == names.end()) names.push_back(h.name);
  throw InputError(place, "unknown hole '" + name + "'",
                   names.empty() ? "a table with [[table.hole]]" : "one of " + listed(names),
                   nearest_name(name, names));
}

}  // namespace carom::files
