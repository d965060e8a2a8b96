// CPU time of one hit by lanes, on every instruction set of this machine, beside the scalar engine
// and a chain of dependent square roots and divisions in the same run; the digests of all ends must
// be equal, and the mean flight of cosine starts must be what geometry says where it does.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <carom/carom.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "carom/lanes/free_lanes.hpp"
#include "measuring.hpp"
#include "table.hpp"

namespace carom::bench {

namespace {

struct Row {
  const char* name;
  const char* table;         // TOML of [table], [lattice] and [field]
  double mean_flight = 0.0;  // below 0: not all of the table is reached, else pi A / L
};
#define ELLIPTIC_STADIUM                                                                        \
  "[table]\nshape = \"path\"\n[[table.loop]]\nstart = [-2, -1]\npieces = [\n"                   \
  "{line_to = [2, -1]}, {ellipse_via = [\"16/5\", 0], ellipse_to = [2, 1], ellipse_ratio = "    \
  "\"5/6\"},\n"                                                                                 \
  "{line_to = [-2, 1]}, {ellipse_via = [\"-16/5\", 0], ellipse_to = [-2, -1], ellipse_ratio = " \
  "\"5/6\"}]\n"
constexpr Row rows[] = {
    {"square", "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n"},
    {"circle", "[table]\nshape = \"circle\"\nradius = 1\n"},
    {"stadium", "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n"},
    {"sinai", "[table]\nshape = \"sinai\"\nside = 1\nradius = \"1/4\"\ntorus = false\n"},
    {"mushroom",
     "[table]\nshape = \"mushroom\"\ncap_radius = 1\nstem_width = 1\nstem_height = 1\n"},
    {"sinai torus", "[table]\nshape = \"sinai\"\nside = 1\nradius = \"1/4\"\ntorus = true\n"},
    {"lorentz triangular",
     "[table]\nshape = \"lorentz\"\nlattice = \"triangular\"\nspacing = 1\nradius = 0.45\n"},
    {"magnetic lorentz square",
     "[table]\nshape = \"lorentz\"\nlattice = \"square\"\nspacing = 1\nradius = "
     "0.4\n[field]\nlarmor_radius = 0.6\n",
     -1},
    {"ellipse", "[table]\nshape = \"ellipse\"\na = 2\nb = 1\n"},
    {"elliptic stadium", ELLIPTIC_STADIUM},
    {"magnetic square",
     "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[field]\nlarmor_radius = 0.5075\n",
     -1},
    {"magnetic square with hole",
     "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[[table.hole]]\nwall = "
     "\"bottom\"\ncenter = 0.5\nwidth = 1e-6\n"
     "[field]\nlarmor_radius = 0.5075\n",
     -1},
    {"magnetic stadium",
     "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n[field]\nlarmor_radius = 2\n", -1},
    {"magnetic sinai",
     "[table]\nshape = \"sinai\"\nside = 1\nradius = \"1/4\"\ntorus = "
     "false\n[field]\nlarmor_radius = 0.7\n",
     -1},
    {"magnetic ellipse",
     "[table]\nshape = \"ellipse\"\na = 1\nb = \"3/4\"\n[field]\nlarmor_radius = 3\n", -1},
    {"magnetic ellipse with hole",
     "[table]\nshape = \"ellipse\"\na = 1\nb = \"3/4\"\n[[table.hole]]\nwall = \"ellipse\"\ncenter "
     "= 0.5\nwidth = 1e-6\n"
     "[field]\nlarmor_radius = 3\n",
     -1},
    {"magnetic elliptic stadium", ELLIPTIC_STADIUM "[field]\nlarmor_radius = 3\n", -1},
    {"magnetic mushroom",
     "[table]\nshape = \"mushroom\"\ncap_radius = 1\nstem_width = 1\nstem_height = "
     "1\n[field]\nlarmor_radius = 2\n",
     -1},
};

/// What all ends of a run add up to.
struct Ends {
  std::uint64_t digest = 0, hits = 0;
  double time = 0.0;
  void add(std::uint64_t tag, Fate fate, std::uint64_t n, int wall, const Time& t, const State& s) {
    std::uint64_t hash = tag;
    for (const std::uint64_t word :
         {static_cast<std::uint64_t>(fate), n, static_cast<std::uint64_t>(wall + 1),
          std::bit_cast<std::uint64_t>(t.high), std::bit_cast<std::uint64_t>(t.low),
          std::bit_cast<std::uint64_t>(s.position.x), std::bit_cast<std::uint64_t>(s.u),
          std::bit_cast<std::uint64_t>(s.velocity.y), static_cast<std::uint64_t>(s.cell.first)})
      hash = (hash ^ word) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29;
    digest += hash;
    hits += n;
    time += t.value();
  }
};
struct LastEnd : Observer {
  Time time;
  void end(const EndEvent& event) override { time = event.time; }
};

constexpr std::uint64_t trajectories = 512;  // of 1000 hits

void measure_row(Report& report, const Row& row) {
  const std::string text = std::string(row.table) +
                           "[particles]\nspeed = 1\n[initial]\nkind = \"boundary\"\n"
                           "[run]\nt_max = 1e9\ncollisions = 1000\ntrajectories = 1\n";
  const System system = read_system(text, row.name).system;
  std::vector<LaneStart> starts(trajectories);
  World world(*system.table);
  const Sampler sampler(system);
  for (std::uint64_t i = 0; i < trajectories; ++i) {
    starts[i].tag = i;
    starts[i].particle = system.particles[0];
    starts[i].state = sampler.draw_all(world, i)[0];
  }
  world.limit_hits(1000);
  Ends ends;
  Best scalar;
  scalar.repeat(2, [&] {
    ends = {};
    for (const LaneStart& start : starts) {
      LastEnd last;
      world.clear();
      world.add(start.particle, start.state, 0);
      world.run_until(1e9, last);
      ends.add(start.tag, world.fate(0), world.hits(0), world.last_wall(0), last.time,
               world.state(0));
    }
    return static_cast<double>(ends.hits);
  });
  const Ends expected = ends;
  const double mean = ends.time / static_cast<double>(ends.hits);
  const double by_geometry = row.mean_flight < 0.0 ? mean : measure(*system.table).mean_flight;
  const bool right = std::fabs(mean / by_geometry - 1.0) < 0.02;
  for (const InstructionSet set : available_instruction_sets()) {
    FreeLanes lanes(*system.table, system.particles, set);
    lanes.limit_hits(1000);
    Best best;
    best.repeat(5, [&] {
      ends = {};
      std::size_t next = 0;
      lanes.run_until(
          1e9,
          [&](LaneStart& start) {
            if (next == starts.size()) return false;
            start = starts[next++];
            return true;
          },
          [&](const LaneEnd& e) { ends.add(e.tag, e.fate, e.hits, e.last_wall, e.time, e.state); });
      return static_cast<double>(ends.hits);
    });
    const bool same = ends.digest == expected.digest;
    report.add(
        {std::string(row.name) + ", a hit", name_of(set), best.each, best.ratio, "scalar",
         scalar.each / best.each,
         fmt::format(
             "ends {}, mean flight {:.4f}{}; {:.0e} of hits left", same ? "equal" : "DIFFER", mean,
             row.mean_flight < 0.0 ? "" : fmt::format(" of {:.4f}", by_geometry),
             static_cast<double>(lanes.effort().scalar) / static_cast<double>(lanes.effort().hits)),
         same && right});
  }
}

}  // namespace

void flights_in_lanes(Report& report) {
  for (const Row& row : rows)
    if (report.wants(row.name)) measure_row(report, row);
}

}  // namespace carom::bench
