#include "validation/cases/orbit_cases.hpp"

#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "carom/analyses/orbits.hpp"
#include "carom/files/system_file.hpp"

namespace carom::validation {

namespace {

const char* three_discs =
    "[table]\nshape = \"discs\"\ncenters = [[0, 0], [6, 0], [3, \"3*sqrt(3)\"]]\nradius = "
    "1\n[initial]\nkind = \"boundary\"\n";
const char* stadium = "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n";
const char* ellipse = "[table]\nshape = \"ellipse\"\na = 1\nb = \"3/4\"\n";
const char* sinai = "[table]\nshape = \"sinai\"\nside = 1\nradius = 0.4\n";
const char* magnetic_square =
    "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[field]\nlarmor_radius = 0.5075\n";

// The number that a case looks at, with a bound of its error; NaN: the orbit was not found.
struct Number {
  double value = NAN, error = 0.0;
};
using Look = std::function<Number(const OrbitSearchResult&)>;

// Doubles carry twelve digits of these numbers.
constexpr double digits = 1e-12;

Check check(const std::string& toml, std::uint64_t hits, bool zeta, double expected,
            const Look& look, const CheckOptions& options) {
  const System system = read_system(toml, "orbits").system;
  const OrbitSearchResult found = find_orbits(system, {.most_hits = hits,
                                                       .starts = 2000,
                                                       .tries = 200,
                                                       .expand_cycles = zeta,
                                                       .threads = options.threads,
                                                       .interrupted = options.interrupted});
  const Number number = look(found);
  Check result;
  result.value = number.value;
  result.error = number.error;
  result.expected = expected;
  result.distance = (number.value - expected) / (number.error > 0.0 ? number.error : 1.0);
  result.complete = found.complete;
  result.passed = found.complete &&
                  std::abs(number.value - expected) <= digits * std::max(1.0, std::abs(expected));
  result.threads = found.threads;
  result.seconds = found.seconds;
  result.cpu_seconds = found.cpu_seconds;
  return result;
}

// The orbit with this many hits and this length.
const PeriodicOrbit* orbit_of(const OrbitSearchResult& found, std::size_t hits, double length) {
  for (const PeriodicOrbit& orbit : found.orbits)
    if (orbit.hits.size() == hits && std::abs(orbit.length - length) < 1e-9) return &orbit;
  return nullptr;
}
Look trace_of(std::size_t hits, double length) {
  return [=](const OrbitSearchResult& found) {
    const PeriodicOrbit* orbit = orbit_of(found, hits, length);
    return orbit ? Number{orbit->trace, orbit->trace_error} : Number{};
  };
}
Look index_of(std::size_t hits, double length) {
  return [=](const OrbitSearchResult& found) {
    const PeriodicOrbit* orbit = orbit_of(found, hits, length);
    return orbit && orbit->maslov ? Number{static_cast<double>(*orbit->maslov), 0.0} : Number{};
  };
}

// The orbit of three discs of which the symmetry leaves this many hits and this period.
const PeriodicOrbit* reduced_of(const OrbitSearchResult& found, std::size_t hits, double period) {
  for (const PeriodicOrbit& orbit : found.orbits)
    if (orbit.hits.size() == hits * static_cast<std::size_t>(orbit.reduced.order) &&
        std::abs(orbit.reduced.period - period) < 1e-9)
      return &orbit;
  return nullptr;
}

}  // namespace

void add_orbit_cases(std::vector<Case>& cases) {
  const auto add = [&](const std::string& name, const char* source, const char* toml,
                       std::uint64_t hits, double expected, Look look, bool zeta = false) {
    cases.push_back({"orbits: " + name, source, Allowance{}, [=](const CheckOptions& options) {
                       return check(toml, hits, zeta, expected, look, options);
                     }});
  };
  const struct {
    const char* word;
    std::size_t hits;
    double period, multiplier;
  } cycles[] = {{"0", 1, 4.0, 9.898979485566356},
                {"1", 1, 4.26794919243112271, -11.77145519638556},
                {"01", 2, 8.316529485168301740, -124.0948019921975},
                {"001", 3, 12.32174661618262242, -1240.542557041512},
                {"011", 3, 12.58080774103251844, 1449.545074956036}};
  for (const auto& cycle : cycles) {
    const std::string name = std::string("three-disc ") + cycle.word;
    const char* source = "fundamental cycles of three discs at distance 6 (ChaosBook), 16 digits";
    add(name + ", period", source, three_discs, 9, cycle.period,
        [=](const OrbitSearchResult& found) {
          const PeriodicOrbit* orbit = reduced_of(found, cycle.hits, cycle.period);
          return orbit ? Number{orbit->reduced.period, orbit->length_error} : Number{};
        });
    add(name + ", multiplier", source, three_discs, 9, cycle.multiplier,
        [=](const OrbitSearchResult& found) {
          const PeriodicOrbit* orbit = reduced_of(found, cycle.hits, cycle.period);
          const double share = orbit ? orbit->trace_error / std::abs(orbit->trace) : 0.0;
          return orbit ? Number{orbit->reduced.multiplier, share * std::abs(cycle.multiplier)}
                       : Number{};
        });
  }
  add("three-disc, prime cycles up to 6 hits", "necklaces of three colours: 3 + 2 + 3 + 6 + 9",
      three_discs, 6, 23.0, [](const OrbitSearchResult& found) {
        int all = 0;
        for (const PeriodicOrbit& orbit : found.orbits) all += orbit.copies;
        return Number{static_cast<double>(all), 0.0};
      });
  add(
      "three-disc, escape rate", "cycle expansion, 26 digits (ChaosBook)", three_discs, 11,
      0.41033840776934648,
      [](const OrbitSearchResult& found) {
        return Number{found.cycles->escape_rate, found.cycles->error};
      },
      true);
  add(
      "three-disc, Lyapunov exponent", "cycle expansion, 18 digits (ChaosBook)", three_discs, 11,
      0.577552578771878598,
      [](const OrbitSearchResult& found) {
        return Number{found.cycles->lambda, found.cycles->lambda_error};
      },
      true);
  const char* two_bounces = "trace 4g^2 - 2, g = 1 - L/R, of two hits between equal walls";
  add("stadium, long axis", two_bounces, stadium, 2, 34.0, trace_of(2, 8.0));
  add("stadium, bouncing balls", two_bounces, stadium, 2, 2.0, trace_of(2, 4.0));
  add("ellipse, long axis", two_bounces, ellipse, 2, 4.0 * std::pow(1.0 - 32.0 / 9.0, 2) - 2.0,
      trace_of(2, 4.0));
  add("ellipse, short axis", two_bounces, ellipse, 2, -1.9375, trace_of(2, 3.0));
  add("ellipse, Maslov index of the short axis", "a beam between mirrors: 2 a reflection, and 1",
      ellipse, 2, 5.0, index_of(2, 3.0));
  add("ellipse, Maslov index of the long axis", "2 a reflection, and 1 at each focus", ellipse, 2,
      6.0, index_of(2, 4.0));
  add("sinai, along the side", two_bounces, sinai, 2, 7.0, trace_of(2, 0.4));
  const double diagonal = std::sqrt(2.0) - 0.8;
  add("sinai, along the diagonal", two_bounces, sinai, 2,
      4.0 * std::pow(1.0 + diagonal / 0.4, 2) - 2.0, trace_of(2, 2.0 * diagonal));
  // By symmetry: through the middles of the sides.
  const double radius = 0.5075,
               through_middles = 8.0 * radius * std::asin(std::sqrt(2.0) / (4.0 * radius));
  add("magnetic square, through the middles", "four Larmor arcs over chords of 1/sqrt(2)",
      magnetic_square, 4, through_middles, [=](const OrbitSearchResult& found) {
        const PeriodicOrbit* orbit = orbit_of(found, 4, through_middles);
        return orbit ? Number{orbit->length, orbit->length_error} : Number{};
      });
}

}  // namespace carom::validation
