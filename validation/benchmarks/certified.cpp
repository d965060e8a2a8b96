// CPU time of certified orbits with 20 digits from several directions, all attempts counted, beside
// plain MPFR of a somewhat higher precision, without guarantee, from the same starts. The last hits
// of both must agree, and the mean flight of the orbits of a table must be what geometry says.
#include <fmt/format.h>

#include <carom/carom.hpp>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "measuring.hpp"
#include "plain_orbit.hpp"
#include "table.hpp"

namespace carom::bench {

namespace {

struct Row {
  const char* name;
  const char* shape;
  std::vector<std::pair<const char*, const char*>> numbers;
  bool torus;
  const char* omega;
  const char *x, *y;
  bool mixing = true;  ///< orbits go everywhere
};
const Row rows[] = {
    {"stadium", "stadium", {{"half_length", "1"}, {"radius", "1"}}, true, "0", "1/10", "11/50"},
    {"disc in a square", "sinai", {{"side", "1"}, {"radius", "0.4"}}, false, "0", "0.05", "0.07"},
    {"disc on a torus", "sinai", {{"side", "1"}, {"radius", "0.4"}}, true, "0", "0.05", "0.07"},
    {"magnetic square",
     "rectangle",
     {{"width", "1"}, {"height", "1"}},
     true,
     "4000/2030",
     "0.3",
     "0.2"},
    {"mushroom",
     "mushroom",
     {{"cap_radius", "1"}, {"stem_width", "1"}, {"stem_height", "1"}},
     true,
     "0",
     "0.1",
     "0.3",
     false},
    {"ellipse", "ellipse", {{"a", "2"}, {"b", "1"}}, true, "0", "1/10", "11/50", false},
    {"circle", "circle", {{"radius", "1"}}, true, "0", "1/10", "11/50", false},
};

ExactNumber written(const std::string& text) { return {text, Place{}}; }

ExactSystem system_of(const Row& row) {
  TableSpec spec;
  spec.shape = row.shape;
  spec.torus = row.torus;
  for (const auto& [key, text] : row.numbers) spec.numbers[key] = written(text);
  ExactSystem system;
  system.spec = std::make_shared<const TableSpec>(spec);
  system.table = std::make_shared<const Table>(build_table(spec));
  system.omega = written(row.omega);
  system.start.position = {written(row.x), written(row.y)};
  return system;
}

/// Of decimals that are right to their last digit and others that are hoped to be.
bool agree(const std::string& right, const std::string& hoped) {
  const double a = std::strtod(right.c_str(), nullptr), b = std::strtod(hoped.c_str(), nullptr);
  return std::fabs(a - b) <= 1e-12 * (1.0 + std::fabs(a));
}

constexpr std::uint64_t hits = 1000;
constexpr int starts = 10;

void measure_row(Report& report, const Row& row) {
  ExactSystem system = system_of(row);
  double sum = 0.0, longest = 0.0, plain = 0.0, stretched = 0.0, bits = 0.0, flown = 0.0;
  int attempts = 0;
  bool same = true;
  for (int i = 0; i < starts; ++i) {
    system.start.direction = {written("1"),
                              written(fmt::format("7/10 + {}/{}", i, 3 * starts + 1))};
    const double start = cpu_seconds();
    CertifiedOrbit orbit = certified_orbit(system, hits, 20);
    const CertifiedEnd end = orbit.finish();
    const double seconds = cpu_seconds() - start;
    sum += seconds;
    longest = std::max(longest, seconds);
    attempts += orbit.effort().attempts;
    bits += static_cast<double>(orbit.effort().bits);
    stretched += orbit.effort().tangent_bits;
    const long plain_bits =
        orbit.effort().bits + orbit.effort().bits / 16 + 64;  // its roundings do feed each other
    const double before = cpu_seconds();
    const PlainEnd hoped = plain_orbit(system, hits, plain_bits);
    plain += cpu_seconds() - before;
    same = same && end.fate == CertifiedFate::completed && end.wall == hoped.wall &&
           end.cell == hoped.cell && agree(end.x.text(20), hoped.x) &&
           agree(end.vy.text(20), hoped.vy);
    flown += end.t.to_double();
  }
  const double all = static_cast<double>(starts) * static_cast<double>(hits);
  const double mean = flown / all, geometry_mean = measure(*system.table).mean_flight;
  // Chords of hyperbolic tables vary by about their mean and forget each other within a few hits.
  const bool geometric = row.mixing && row.omega[0] == '0';
  const bool right = !geometric || std::fabs(mean / geometry_mean - 1.0) < 6.0 / std::sqrt(all);
  const double each = sum / starts * 1e9;
  report.add({fmt::format("certified {}, {} hits", row.name, hits), "balls", each, each / chain(),
              "plain MPFR", plain / sum,
              fmt::format("last digits {}, mean flight {:.4f}{}; longest {:.1f} ms, {:.2f} "
                          "attempts, {:.0f} bits, {:.3f} of them lost a hit",
                          same ? "agree" : "DIFFER", mean,
                          geometric ? fmt::format(" of {:.4f}", geometry_mean) : "", 1e3 * longest,
                          static_cast<double>(attempts) / starts, bits / starts, stretched / all),
              same && right});
}

}  // namespace

void certified_orbits(Report& report) {
  for (const Row& row : rows)
    if (report.wants(fmt::format("certified {}", row.name))) measure_row(report, row);
}

}  // namespace carom::bench
