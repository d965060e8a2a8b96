// carom validate: the engine against identities, from a fixed list of systems.
#include "carom/ensemble/validation.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "carom/base/error.hpp"
#include "cli/commands.hpp"
#include "cli/common.hpp"

namespace carom::cli {

namespace {

struct Case {
  const char* name;
  const char* table;     ///< TOML of [table] and [field]
  double no_hit_area;    ///< A0: centres of Larmor circles that meet no wall
  bool soaked;           ///< also run long, for lost trajectories
};

const std::vector<Case>& cases() {
  constexpr double pi = 3.14159265358979323846;
  static const std::vector<Case> all = {
      {"stadium", "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n", 0, true},
      {"mushroom", "[table]\nshape = \"mushroom\"\ncap_radius = 1\nstem_width = 1\nstem_height = 1\n", 0, true},
      {"sinai", "[table]\nshape = \"sinai\"\nside = 1\nradius = 0.4\n", 0, true},
      {"lorentz-triangular",
       "[table]\nshape = \"lorentz\"\nlattice = \"triangular\"\nspacing = 2.2\nradius = 1\n", 0, false},
      {"circle", "[table]\nshape = \"circle\"\nradius = 1\n", 0, false},
      {"ellipse", "[table]\nshape = \"ellipse\"\na = 1\nb = 0.75\n", 0, false},
      {"magnetic-square",
       "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[field]\nlarmor_radius = 0.5075\n", 0, true},
      {"magnetic-square-0.4",
       "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[field]\nlarmor_radius = 0.4\n", 0.2 * 0.2, false},
      {"magnetic-circle-0.5", "[table]\nshape = \"circle\"\nradius = 1\n[field]\nlarmor_radius = 0.5\n", pi / 4,
       false},
      {"ellipse-magnetic", "[table]\nshape = \"ellipse\"\na = 1\nb = 0.75\n[field]\nlarmor_radius = 3\n", 0, true},
  };
  return all;
}

System system_of(const Case& c, const char* initial, std::uint64_t seed, double trajectories, double hits) {
  const std::string text =
      fmt::format("{}[particles]\nspeed = 1\n[initial]\nkind = \"{}\"\n[run]\nt_max = 1e12\ncollisions = {:.0f}\n"
                  "trajectories = {:.0f}\nseed = {}\n",
                  c.table, initial, hits, trajectories, seed);
  return read_system(text, c.name).system;
}

}  // namespace

int validate(const Options& options) {
  const int threads = threads_of(options);
  const double scale = options.soak ? 100.0 : 1.0;
  std::string text;
  Json list = Json::array();
  int passed = 0, failed = 0;
  const auto note = [&](bool ok, const std::string& line, Json entry) {
    ok ? ++passed : ++failed;
    text += fmt::format("{}  {}\n", ok ? "passed" : "FAILED", line);
    list.push(std::move(entry.set("passed", ok)));
  };
  for (const Case& c : cases()) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const System system = system_of(c, "boundary", seed, options.soak ? 1e5 : 1e4, 100);
      const TableMeasure size = measure(*system.table);
      const double expected = size.mean_flight * (1.0 - c.no_hit_area / size.area);
      const Comparison m = mean_flight(system, expected);
      // An integrable orbit may have no scatter at all: then the numbers agree to rounding.
      const bool ok = std::fabs(m.distance()) <= 4.0 || std::fabs(m.value - expected) <= 1e-12 * expected;
      note(ok,
           fmt::format("{:<20} mean flight, seed {}   {:.7f} +- {:.7f}   pi (A - A0)/L = {:.7f}   {:+.1f} sigma",
                       c.name, seed, m.value, m.error, expected, m.distance()),
           Json::object()
               .set("name", std::string(c.name) + ": mean flight")
               .set("seed", seed)
               .set("value", m.value)
               .set("error", m.error)
               .set("expected", expected)
               .set("sigma", m.distance())
               .set("source", "Santalo; pi (A - A0)/L"));
    }
    if (!c.soaked) continue;
    const Soak s = soak(system_of(c, "uniform", 1, 1e3 * scale, 1e4), threads);
    note(s.lost == 0,
         fmt::format("{:<20} seed 1: {} hits, {} lost, {} singular, filter share {:.9f}, digest {:016x}, {:.0f} ns",
                     c.name, s.hits, s.lost, s.singular, s.filter_share, s.digest,
                     1e9 * s.cpu_seconds / static_cast<double>(s.hits)),
         Json::object()
             .set("name", std::string(c.name) + ": nothing is lost")
             .set("seed", 1)
             .set("hits", s.hits)
             .set("lost", s.lost)
             .set("singular", s.singular)
             .set("filter_share", s.filter_share)
             .set("digest", fmt::format("{:016x}", s.digest))
             .set("report", s.report));
  }
  text += fmt::format("\n{} passed, {} failed\n", passed, failed);
  if (options.json) {
    Json json = Json::object();
    const System none;
    add_common_keys(json, none, threads, 0.0, 0.0);
    json.set("passed", passed).set("failed", failed).set("cases", std::move(list));
    print(json.text() + "\n");
  } else {
    print(text);
  }
  return failed ? lost : done;
}

}  // namespace carom::cli
