// CPU time of one hit by lanes, on every instruction set of this machine, beside the scalar engine and a chain of
// dependent square roots and divisions in the same run; the digests of all ends must be equal, and the mean
// flight of cosine starts must be what geometry says where it does.
#include <time.h>

#include <algorithm>
#include <bit>
#include <carom/carom.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "carom/lanes/lane_world.hpp"

namespace {

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Nanoseconds of one link of x -> 1 + 1/sqrt(x).
double chain() {
  static double x = 1.5;
  const double start = cpu_seconds();
  for (int i = 0; i < 100'000; ++i) x = 1.0 + 1.0 / std::sqrt(x);
  return (cpu_seconds() - start) / 1e5 * 1e9 + (x < 0.0 ? 1.0 : 0.0);
}

struct Row {
  const char* name;
  const char* table;  // TOML of [table], [lattice] and [field]
  double mean_flight = 0.0;  // expected; 0: pi A / L, below 0: not known
};
#define ELLIPTIC_STADIUM                                                                                             \
  "[table]\nshape = \"path\"\n[[table.loop]]\nstart = [-2, -1]\npieces = [\n"                                           \
  "{line_to = [2, -1]}, {ellipse_via = [\"16/5\", 0], ellipse_to = [2, 1], ellipse_ratio = \"5/6\"},\n"                 \
  "{line_to = [-2, 1]}, {ellipse_via = [\"-16/5\", 0], ellipse_to = [-2, -1], ellipse_ratio = \"5/6\"}]\n"
constexpr Row rows[] = {
    {"square", "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n"},
    {"circle", "[table]\nshape = \"circle\"\nradius = 1\n"},
    {"stadium", "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n"},
    {"sinai", "[table]\nshape = \"sinai\"\nside = 1\nradius = \"1/4\"\ntorus = false\n"},
    {"mushroom", "[table]\nshape = \"mushroom\"\ncap_radius = 1\nstem_width = 1\nstem_height = 1\n"},
    {"sinai torus", "[table]\nshape = \"sinai\"\nside = 1\nradius = \"1/4\"\ntorus = true\n"},
    {"lorentz triangular", "[table]\nshape = \"lorentz\"\nlattice = \"triangular\"\nspacing = 1\nradius = 0.45\n"},
    {"ellipse", "[table]\nshape = \"ellipse\"\na = 2\nb = 1\n"},
    {"elliptic stadium", ELLIPTIC_STADIUM},
    {"magnetic square", "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[field]\nlarmor_radius = 0.5075\n", -1},
    {"magnetic square with hole",
     "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[[table.hole]]\nwall = \"bottom\"\ncenter = 0.5\nwidth = 1e-6\n"
     "[field]\nlarmor_radius = 0.5075\n",
     -1},
    {"magnetic stadium", "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n[field]\nlarmor_radius = 2\n", -1},
    {"magnetic sinai", "[table]\nshape = \"sinai\"\nside = 1\nradius = \"1/4\"\ntorus = false\n[field]\nlarmor_radius = 0.7\n", -1},
    {"magnetic ellipse", "[table]\nshape = \"ellipse\"\na = 1\nb = \"3/4\"\n[field]\nlarmor_radius = 3\n", -1},
    {"magnetic ellipse with hole",
     "[table]\nshape = \"ellipse\"\na = 1\nb = \"3/4\"\n[[table.hole]]\nwall = \"ellipse\"\ncenter = 0.5\nwidth = 1e-6\n"
     "[field]\nlarmor_radius = 3\n",
     -1},
    {"magnetic elliptic stadium", ELLIPTIC_STADIUM "[field]\nlarmor_radius = 3\n", -1},
    {"magnetic mushroom",
     "[table]\nshape = \"mushroom\"\ncap_radius = 1\nstem_width = 1\nstem_height = 1\n[field]\nlarmor_radius = 2\n", -1},
};

/// What all ends of a run add up to.
struct Ends {
  std::uint64_t digest = 0, hits = 0;
  double time = 0.0;
  void add(std::uint64_t tag, carom::Fate fate, std::uint64_t n, int wall, const carom::Time& t, const carom::State& s) {
    std::uint64_t hash = tag;
    for (const std::uint64_t word :
         {static_cast<std::uint64_t>(fate), n, static_cast<std::uint64_t>(wall + 1), std::bit_cast<std::uint64_t>(t.high),
          std::bit_cast<std::uint64_t>(t.low), std::bit_cast<std::uint64_t>(s.position.x), std::bit_cast<std::uint64_t>(s.u),
          std::bit_cast<std::uint64_t>(s.velocity.y), static_cast<std::uint64_t>(s.cell.first)})
      hash = (hash ^ word) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29;
    digest += hash;
    hits += n;
    time += t.value();
  }
};
struct LastEnd : carom::Observer {
  carom::Time time;
  void end(const carom::EndEvent& event) override { time = event.time; }
};

struct Measured {
  Ends ends;
  double best = 1e300, ratio = 1e300;  // ns a hit; in links
  template <class Run>
  void repeat(int times, const Run& run) {
    for (int i = 0; i < times; ++i) {
      const double link = chain();
      const double start = cpu_seconds();
      ends = run();
      const double each = (cpu_seconds() - start) / static_cast<double>(ends.hits) * 1e9;
      best = std::min(best, each);
      ratio = std::min(ratio, each / std::min(link, chain()));
    }
  }
};

bool measure_row(const Row& row, std::uint64_t trajectories, int times) {
  const std::string text = std::string(row.table) +
                           "[particles]\nspeed = 1\n[initial]\nkind = \"boundary\"\n"
                           "[run]\nt_max = 1e9\ncollisions = 1000\ntrajectories = 1\n";
  const carom::System system = carom::read_system(text, row.name).system;
  std::vector<carom::LaneStart> starts(trajectories);
  carom::World world(*system.table);
  const carom::Sampler sampler(system);
  for (std::uint64_t i = 0; i < trajectories; ++i) {
    starts[i].tag = i;
    starts[i].particle = system.particles[0];
    starts[i].state = sampler.draw_all(world, i)[0];
  }
  world.limit_hits(1000);
  Measured scalar;
  scalar.repeat(2, [&] {
    Ends ends;
    for (const carom::LaneStart& start : starts) {
      LastEnd last;
      world.clear();
      world.add(start.particle, start.state, 0);
      world.run_until(1e9, last);
      ends.add(start.tag, world.fate(0), world.hits(0), world.last_wall(0), last.time, world.state(0));
    }
    return ends;
  });
  std::printf("%-26s scalar %6.1f (%5.2f)", row.name, scalar.best, scalar.ratio);
  bool same = true;
  if (carom::LaneWorld::suits(*system.table, system.particles)) {
    for (const carom::InstructionSet set : carom::available_instruction_sets()) {
      carom::LaneWorld lanes(*system.table, system.particles, set);
      lanes.limit_hits(1000);
      Measured measured;
      measured.repeat(times, [&] {
        Ends ends;
        std::size_t next = 0;
        lanes.run_until(
            1e9,
            [&](carom::LaneStart& start) {
              if (next == starts.size()) return false;
              start = starts[next++];
              return true;
            },
            [&](const carom::LaneEnd& e) { ends.add(e.tag, e.fate, e.hits, e.last_wall, e.time, e.state); });
        return ends;
      });
      same = same && measured.ends.digest == scalar.ends.digest;
      std::printf("  %s %6.2f (%4.2f)", carom::name_of(set), measured.best, measured.ratio);
      if (set == carom::widest_instruction_set())
        std::printf("  left %.1e", static_cast<double>(lanes.effort().scalar) / static_cast<double>(lanes.effort().hits));
    }
  }
  const double expected = row.mean_flight != 0.0 ? row.mean_flight : carom::measure(*system.table).mean_flight;
  const double mean = scalar.ends.time / static_cast<double>(scalar.ends.hits);
  const bool right = expected < 0.0 || std::fabs(mean / expected - 1.0) < 0.02;
  std::printf("  flight %.4f%s  digests %s\n", mean, expected < 0.0 ? "" : right ? " right" : " WRONG", same ? "equal" : "DIFFER");
  return same && right;
}

}  // namespace

/// Arguments: trajectories of 1000 hits each, repetitions, a name's beginning.
int main(int argc, char** argv) {
  const std::uint64_t trajectories = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 512;
  const int times = argc > 2 ? std::atoi(argv[2]) : 9;
  std::printf("CPU ns a hit, best of %d (in links of 1 + 1/sqrt x)\n", times);
  bool good = true;
  for (const Row& row : rows)
    if (argc < 4 || std::string(row.name).starts_with(argv[3])) good &= measure_row(row, trajectories, times);
  return good ? 0 : 1;
}
