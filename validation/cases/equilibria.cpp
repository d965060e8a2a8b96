// Equilibria against published and closed values.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "carom/analyses/relax.hpp"
#include "carom/files/system_file.hpp"
#include "validation/cases/cases.hpp"

namespace carom::validation {

namespace {

System wigner(int count) {
  SystemOverrides set;
  set.set = {{"particles.count", fmt::format("{}", count)}, {"particles.energy", "100"}};
  return load_system("wigner", set).system;
}

System ring(int count) {
  return read_system(
             fmt::format("[table]\nshape = \"circle\"\nradius = 1\n[interaction]\nkind = "
                         "\"coulomb\"\n[particles]\ncount = {}\nenergy = 20\n[integrator]\nstep = "
                         "0.001\n[initial]\nkind = \"uniform\"\n",
                         count),
             "ring")
      .system;
}

/// What a value of the lowest equilibrium is, beside what it should be.
template <class Value>
Check lowest(const System& system, double expected, double expected_error, Value value,
             const CheckOptions& options) {
  RelaxOptions how;
  how.starts = 20;
  how.threads = options.threads;
  how.interrupted = options.interrupted;
  const RelaxResult found = run_relax(system, how);
  Check c;
  c.complete = found.complete;
  c.seed = system.run.seed;
  c.threads = found.threads;
  c.seconds = found.seconds;
  c.cpu_seconds = found.cpu_seconds;
  c.expected = expected;
  c.expected_error = expected_error;
  if (found.equilibria.empty()) return c;
  std::tie(c.value, c.error) = value(found.equilibria.front());
  c.distance =
      (c.value - expected) / std::sqrt(c.error * c.error + expected_error * expected_error);
  c.passed = c.complete && std::fabs(c.distance) <= 4.0;
  return c;
}

}  // namespace

void add_equilibria(std::vector<Case>& cases) {
  // Eleven published digits: rounded, so uniform within half of the last.
  const double published = 0.5e-10 / std::numbers::sqrt3;
  const double energies[] = {0.75, 1.3103706971, 1.8354456111, 2.3384453805};
  for (int n = 2; n <= 5; ++n)
    cases.push_back(
        {fmt::format("wigner: energy a particle of {}", n),
         "ground states of E = sum r^2 + sum 1/r",
         {},
         [n, expected = energies[n - 2], published](const CheckOptions& options) {
           return lowest(
               wigner(n), expected, n == 2 ? 0.0 : published,
               [n](const Equilibrium& e) { return std::pair(e.energy / n, e.energy_error / n); },
               options);
         }});
  // In a harmonic well pairs change neither the motion of the centre of mass nor the breathing.
  const std::tuple<const char*, const char*, double> modes[] = {
      {"wigner: breathing mode", "sqrt(3) omega, omega^2 = 2", std::sqrt(6.0)},
      {"wigner: centre of mass", "omega, omega^2 = 2", std::sqrt(2.0)}};
  for (const auto& [name, source, value] : modes)
    cases.push_back({name, source, {}, [expected = value](const CheckOptions& options) {
                       return lowest(
                           wigner(5), expected, 0.0,
                           [&](const Equilibrium& e) {
                             double nearest = 0.0;
                             for (const NormalMode& m : e.modes)
                               if (std::fabs(m.frequency - expected) <
                                   std::fabs(nearest - expected))
                                 nearest = m.frequency;
                             return std::pair(nearest, e.position_error);
                           },
                           options);
                     }});
  double on_ring = 0.0;
  for (int k = 1; k < 7; ++k) on_ring += 7 / 4.0 / std::sin(std::numbers::pi * k / 7);
  cases.push_back({"seven charges in a circle: energy",
                   "(N/4) sum of 1/sin(pi k/N), all on the wall",
                   {},
                   [on_ring](const CheckOptions& options) {
                     return lowest(
                         ring(7), on_ring, 0.0,
                         [](const Equilibrium& e) { return std::pair(e.energy, e.energy_error); },
                         options);
                   }});
}

}  // namespace carom::validation
