// Hard discs on a torus: contacts a second, what is conserved, and the compressibility factor
// against the virial series.
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "carom/base/random.hpp"
#include "carom/events/world.hpp"
#include "measuring.hpp"
#include "pair_loop.hpp"
#include "table.hpp"

namespace carom::bench {

using geometry::Vector;

namespace {

constexpr double pi = 3.141592653589793;

struct Virial : Observer {
  double sum = 0.0;
  long contacts = 0;
  void contact(const ContactEvent& c) override {
    sum += c.transfer * std::sqrt(dot(c.separation, c.separation));
    ++contacts;
  }
};

// B_k / B_2^(k-1) of hard discs, k = 2 … 10 (Clisby & McCoy 2006, table 1).
constexpr double b[] = {1.0,       0.78200444, 0.53223180, 0.33355604, 0.1988425,
                        0.1148728, 0.0649930,  0.0362193,  0.0199537};
double virial_series(double eta) {
  double z = 1.0, power = 1.0;
  for (const double c : b) z += c * (power *= 2.0 * eta);
  return z;
}
// What a torus with N discs has: Z - (rho/2N) d/drho log(d(rho Z)/drho),
// docs/physics/hard-discs.md.
double of_discs(double eta, int count) {
  double first = 1.0, second = 0.0, power = 1.0,
         k = 1.0;  // d(rho Z)/drho and rho times its derivative
  for (const double c : b) {
    power *= 2.0 * eta;
    first += (k + 1.0) * c * power;
    second += k * (k + 1.0) * c * power;
    k += 1.0;
  }
  return virial_series(eta) - second / first / (2.0 * count);
}

constexpr int across = 10;
constexpr double eta = 0.3, millions = 1.0;
constexpr std::uint64_t seed = 1;

void measure_discs(Report& report) {
  const int count = across * across;
  const double side = across;
  const double radius = std::sqrt(eta / pi);
  Table table;
  table.extent = Extent::lattice;
  table.lattice = geometry::make_lattice({side, 0}, {0, side}, {0, 0});
  ForceSpec spec;
  spec.interaction = InteractionSpec{};
  spec.interaction->kind = InteractionSpec::Kind::hard_discs;
  spec.interaction->radii.assign(static_cast<std::size_t>(count), radius);
  Dynamics dynamics;
  dynamics.forces = ForceField::build(spec, std::vector<Particle>(static_cast<std::size_t>(count)),
                                      table.lattice);

  RandomStream random(seed, Purpose::initial_state, 0);
  std::vector<Vector> v;
  Vector mean{};
  for (int i = 0; i < count; ++i) {
    v.push_back({random.symmetric() + random.symmetric() + random.symmetric(),
                 random.symmetric() + random.symmetric() + random.symmetric()});
    mean = mean + (1.0 / count) * v.back();
  }
  World world(table, dynamics);
  Particle particle;
  particle.radius = radius;
  for (int i = 0; i < count; ++i) {
    State s;
    s.position = {i % across + 0.5 - 0.5 * side, i / across + 0.5 - 0.5 * side};
    s.velocity = v[static_cast<std::size_t>(i)] - mean;
    world.add(particle, s);
  }
  const auto energy = [&] {
    double e = 0.0;
    for (int i = 0; i < count; ++i)
      e += 0.5 * dot(world.state(i).velocity, world.state(i).velocity);
    return e;
  };
  const auto momentum = [&] {
    Vector p{};
    for (int i = 0; i < count; ++i) p = p + world.state(i).velocity;
    return std::sqrt(dot(p, p));
  };
  const double start = energy(), speed = std::sqrt(2.0 * start / count);
  Virial warm, seen;
  double t = 30.0 / speed;  // forgets the square order
  world.run_until(t, warm);

  // Blocks of equal time: N kT (Z - 1) = sum sigma |J| / (2 t), and E = (N - 1) kT as the momentum
  // is zero.
  std::vector<double> z;
  double worst = 0.0, seconds = 0.0;
  const double block = 20.0 / speed;
  long events = 0;
  while (static_cast<double>(seen.contacts) < millions * 1e6) {
    const double before = seen.sum;
    const double begin = cpu_seconds();
    events += static_cast<long>(world.run_until(t += block, seen));
    seconds += cpu_seconds() - begin;
    z.push_back(1.0 + (seen.sum - before) / (2.0 * start * block) * (count - 1.0) / count);
    const double error = energy() / start - 1.0;
    worst = std::max(worst, std::fabs(error));
  }
  const double n = static_cast<double>(z.size());
  double average = 0.0, square = 0.0;
  for (const double x : z) average += x / n;
  for (const double x : z) square += (x - average) * (x - average);
  const double each = seconds / static_cast<double>(seen.contacts) * 1e9,
               error = std::sqrt(square / (n * (n - 1.0)));
  const double expected = of_discs(eta, count);
  PairLoop loop(side, radius);
  for (int i = 0; i < count; ++i) {
    const State state = world.state(i);
    const Vector there = state.position + table.lattice->translation(state.cell) +
                         (t - state.time.value()) * state.velocity;
    loop.add(there.x, there.y, state.velocity.x, state.velocity.y);
  }
  constexpr long looped = 20'000;
  double virial = 0.0;
  const double begin = cpu_seconds(), flown = loop.run(looped, virial);
  const double other = (cpu_seconds() - begin) / looped * 1e9,
               z_of_loop = 1.0 + virial / (2.0 * start * flown) * (count - 1.0) / count;
  report.add({fmt::format("{} hard discs, a contact", count), "scalar", each, each / chain(),
              "loop over pairs", other / each,
              fmt::format("Z {:.5f}({:.5f}) of {:.5f}, by the loop {:.3f}; energy within {:.0e}, "
                          "momentum {:.0e}; {:.2f} events a contact",
                          average, error, expected, z_of_loop, worst, momentum() / (count * speed),
                          static_cast<double>(events) / static_cast<double>(seen.contacts)),
              std::fabs(average - expected) < 4.0 * error &&
                  std::fabs(z_of_loop - expected) < 0.05 && worst < 1e-12});
}

}  // namespace

void contacts_of_hard_discs(Report& report) {
  if (report.wants("100 hard discs")) measure_discs(report);
}

}  // namespace carom::bench
