// CPU time of a search for periodic orbits, by starts that are tried: chains of two to six hits,
// solved, described and flown by the engine. The orbits that are known must be among what is found.
#include <carom/carom.hpp>
#include <cmath>
#include <string>

#include "measuring.hpp"
#include "table.hpp"

namespace carom::bench {

namespace {

struct Row {
  const char* name;
  const char* toml;
  std::size_t hits;  ///< of an orbit that is known, and its trace
  double length, trace;
};
const Row rows[] = {
    {"periodic orbits, three discs",
     "[table]\nshape = \"discs\"\ncenters = [[0, 0], [6, 0], [3, \"3*sqrt(3)\"]]\nradius = 1\n"
     "[initial]\nkind = \"boundary\"\n",
     2, 8.0, 98.0},
    {"periodic orbits, stadium", "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n", 2,
     8.0, 34.0},
    {"periodic orbits, magnetic square",
     "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[field]\nlarmor_radius = 0.5075\n", 4,
     3.1291513461074326, 1.9965563270095205}};

}  // namespace

void periodic_orbits(Report& report) {
  for (const Row& row : rows) {
    if (!report.wants(row.name)) continue;
    const System system = read_system(row.toml, "bench").system;
    OrbitSearchResult found;
    Best best;
    best.repeat(3, [&] {
      found = find_orbits(system, {.most_hits = 6, .tries = 500, .threads = 1});
      return static_cast<double>(found.words + found.recurrences);
    });
    bool right = false;
    for (const PeriodicOrbit& orbit : found.orbits)
      right =
          right || (orbit.hits.size() == row.hits && std::abs(orbit.length - row.length) < 1e-12 &&
                    std::abs(orbit.trace - row.trace) < 1e-11);
    report.add({row.name, "a start", best.each, best.ratio, "", 0.0,
                std::to_string(found.orbits.size()) + " orbits", right});
  }
}

}  // namespace carom::bench
