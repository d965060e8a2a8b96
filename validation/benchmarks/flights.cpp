// CPU time of one hit by the scalar event engine, each beside a physical identity: the mean flight
// of cosine starts is pi (A - A0) / L, where A0 is the area of the centres of Larmor circles that
// fit into the table (docs/physics). Beside it a time-stepper of the same system, and a plain loop
// over obstacles in doubles.
#include <fmt/format.h>

#include <algorithm>
#include <carom/carom.hpp>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "measuring.hpp"
#include "obstacle_loop.hpp"
#include "table.hpp"
#include "time_stepper.hpp"

namespace carom::bench {

namespace {

struct Flights : Observer {
  double sum = 0.0;
  std::uint64_t hits = 0;
  void hit(const HitEvent& event) override {
    sum += event.flight_time;
    ++hits;
  }
};

struct Row {
  const char* name;
  const char* table;  // TOML of [table] and [field]
  double omega;
  Level (*stepped)(double, double) = nullptr;  // null: no time-stepper
  Obstacles (*loop)() = nullptr;               // null: no loop over obstacles
  double loop_flight = 0.0;                    // mean flight of its one orbit; 0: that of the table
  const char* fewer = nullptr;  // a row before: the same gas or polygon, of fewer walls
};

constexpr std::uint64_t trajectories = 200;  // of 1000 hits

// Mean flights of many trajectories are independent: their mean has an error.
struct MeanFlight {
  double sum = 0.0, squares = 0.0, n = 0.0;
  void add(double flight) { sum += flight, squares += flight * flight, n += 1.0; }
  double mean() const { return sum / n; }
  double error() const { return std::sqrt((squares / n - mean() * mean()) / (n - 1.0)); }
};

/// Of others of the same kind: what more walls cost.
using Costs = std::map<std::string, double>;

void measure_row(Report& report, const Row& row, Costs& costs) {
  const std::string text = std::string(row.table) +
                           "[particles]\nspeed = 1\n[initial]\nkind = \"boundary\"\n"
                           "[run]\nt_max = 1e9\ncollisions = 1000\ntrajectories = 1\n";
  const System system = read_system(text, row.name).system;
  const double expected = measure(*system.table).mean_flight;
  World world(*system.table);
  const Sampler sampler(system);
  world.limit_hits(1000);
  MeanFlight flight;
  Best best;
  std::uint64_t index = 0;
  best.repeat(5, [&] {
    std::uint64_t hits = 0;
    for (std::uint64_t i = 0; i < trajectories; ++i) {
      Flights flights;
      world.clear();
      add_start(world, sampler, index++, 0);
      world.run_until(1e9, flights);
      flight.add(flights.sum / static_cast<double>(flights.hits));
      hits += flights.hits;
    }
    return static_cast<double>(hits);
  });
  costs[row.name] = best.each;
  const double off = (flight.mean() - expected) / flight.error();
  Line line{std::string(row.name) + ", a hit",
            "scalar",
            best.each,
            best.ratio,
            "",
            0.0,
            fmt::format("mean flight {:.5f}, {:+.1f} errors off pi A/L = {:.5f}; {} of {:.0e} "
                        "decisions beyond doubles",
                        flight.mean(), off, expected, world.decisions().exact,
                        static_cast<double>(world.decisions().filter)),
            std::fabs(off) < 5.0};
  if (row.fewer && costs.contains(row.fewer)) {
    line.against = row.fewer;
    line.ratio = costs[row.fewer] / best.each;
  }
  if (row.stepped) {
    line.against = "steps in time of 1e-4";
    const double start = cpu_seconds();
    const auto stepped = step_in_time(row.stepped, row.omega, 1e-4, 300);
    line.ratio = (cpu_seconds() - start) / static_cast<double>(stepped.hits) * 1e9 / best.each +
                 0.0 * stepped.checksum;
  }
  report.add(line);
  if (!row.loop) return;
  const auto obstacles = row.loop();
  const double start = cpu_seconds();
  const auto flown = fly_among(obstacles, row.omega, 100'000);
  const double each = (cpu_seconds() - start) / static_cast<double>(flown.hits) * 1e9;
  const double mean = flown.time / static_cast<double>(flown.hits),
               wanted = row.loop_flight > 0 ? row.loop_flight : expected;
  report.add(
      {std::string(row.name) + ", a hit", "peer's way", each, each * best.ratio / best.each,
       "scalar", best.each / each,
       fmt::format(
           "mean flight of one orbit {:.4f}, expected {:.4f}; DynamicalBilliards.jl reports {} ns",
           mean, wanted, row.omega == 0.0 ? "45.6" : "294.5"),
       !flown.left && std::fabs(mean / wanted - 1.0) < 0.02});
}

const Row rows[] = {
    {"square", "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n", 0, square, unit_square,
     0.723733},  // 1 / (cos 1 + sin 1)
    {"stadium", "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n", 0, stadium,
     unit_stadium},
    {"mushroom", "[table]\nshape = \"mushroom\"\ncap_radius = 1\nstem_width = 1\nstem_height = 1\n",
     0},
    {"sinai torus", "[table]\nshape = \"sinai\"\nside = 1\nradius = 0.4\ntorus = true\n", 0},
    {"lorentz triangular",
     "[table]\nshape = \"lorentz\"\nlattice = \"triangular\"\nspacing = 2.2\nradius = 1\n", 0},
    {"random lorentz 10",
     "[table]\nshape = \"random-discs\"\nside = \"sqrt(102.4)\"\nradius = 1\ncount = 10\n", 0},
    {"random lorentz 100000",
     "[table]\nshape = \"random-discs\"\nside = \"sqrt(1024000)\"\nradius = 1\ncount = 100000\n", 0,
     nullptr, nullptr, 0.0, "random lorentz 10"},
    {"regular 100", "[table]\nshape = \"regular\"\nsides = 100\nradius = 1\n", 0},
    {"regular 10000", "[table]\nshape = \"regular\"\nsides = 10000\nradius = 1\n", 0, nullptr,
     nullptr, 0.0, "regular 100"},
    {"ellipse", "[table]\nshape = \"ellipse\"\na = 1\nb = 0.75\n", 0, ellipse},
    {"curve of 512 pieces", "[table]\nshape = \"polar\"\nradius = \"1 + 0.5*cos(phi)\"\n", 0},
    {"magnetic square",
     "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[field]\nlarmor_radius = 0.5075\n",
     1 / 0.5075, square, unit_square},
    {"magnetic stadium",
     "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n[field]\nlarmor_radius = 3\n",
     1 / 3.0, stadium, unit_stadium},
    {"magnetic ellipse",
     "[table]\nshape = \"ellipse\"\na = 1\nb = 0.75\n[field]\nlarmor_radius = 3\n", 1 / 3.0,
     ellipse},
    {"magnetic curve of 512 pieces",
     "[table]\nshape = \"polar\"\nradius = \"1 + 0.5*cos(phi)\"\n[field]\nlarmor_radius = 3\n",
     1 / 3.0},
};

}  // namespace

void straight_and_larmor_flights(Report& report) {
  Costs costs;
  for (const Row& row : rows)
    if (report.wants(row.name)) measure_row(report, row, costs);
}

}  // namespace carom::bench
