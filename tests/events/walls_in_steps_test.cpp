// Walls inside steps: every scheme keeps its order through collisions, in 34 digits.
//
// With CAROM_SOAK set all schemes are measured and printed, else a few.
// The loop below is the plainest one that steps, finds the first wall, reflects and goes on. The
// wells are off the centre: a centred one hides errors by symmetry.
#if __has_include(<quadmath.h>)  // GCC on x86-64
#include <gtest/gtest.h>

#include <boost/multiprecision/float128.hpp>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "carom/integrators/scheme.hpp"
#include "events/step/barriers_of.hpp"
#include "events/step/crossing_in_step.hpp"
#include "integrators/steppers.hpp"
#include "soak.hpp"
#include "tables_by_hand.hpp"

namespace carom {

using namespace events;

template <>
struct Arithmetic<boost::multiprecision::float128> {
  using Number = boost::multiprecision::float128;
  static Number parse(std::string_view decimal) { return Number(std::string(decimal)); }
  static SineCosine<Number> turn(const Number& angle) { return {sin(angle), cos(angle)}; }
};

namespace {

using Real = boost::multiprecision::float128;
using Vector = geometry::BasicVector<Real>;

struct HarmonicWell : ForceLaw<Real> {
  void accelerations(std::span<const Vector> x, std::span<Vector> a) const override {
    a[0] = {Real("-1.3") * (x[0].x - Real("0.21")), Real("-0.7") * (x[0].y + Real("0.13"))};
  }
};

struct HenonHeiles : ForceLaw<Real> {
  void accelerations(std::span<const Vector> x, std::span<Vector> a) const override {
    const Real &p = x[0].x, &q = x[0].y;
    a[0] = {-p - Real(2) * p * q, -q - p * p + q * q};
  }
};

std::vector<Barrier<Real>> circular_wall() {
  return barriers_of<Real>(geometry::Circle{{0.0, 0.0}, 0.5, true}, Vector{});
}
std::vector<Barrier<Real>> walls_of(const Table& table) {
  std::vector<Barrier<Real>> walls;
  for (int i = 0; i < static_cast<int>(table.walls.size()); ++i)
    for (Barrier<Real>& b : barriers_of<Real>(table, i, Vector{})) walls.push_back(std::move(b));
  return walls;
}
std::vector<Barrier<Real>> rectangular_wall() {
  return walls_of(tests::polygon({{-0.5, -0.375}, {0.5, -0.375}, {0.5, 0.375}, {-0.5, 0.375}}));
}
/// Nearly a circle: in others orbits are chaotic.
std::vector<Barrier<Real>> curved_wall() {
  const double r = 0.5, k = 0.276142375;
  const geometry::Vector corners[] = {{r, 0.0}, {0.0, r}, {-r, 0.0}, {0.0, -r}};
  std::vector<geometry::Curve> quarters;
  for (int i = 0; i < 4; ++i) {
    const geometry::Vector from = corners[i], to = corners[(i + 1) % 4];
    quarters.push_back(
        geometry::Bezier{from, to, {{from + (k / r) * left(from), to - (k / r) * left(to)}}, 3});
  }
  return walls_of(tests::loop(quarters));
}

struct Orbit {
  Phase<Real> end;
  int hits = 0;
};

Orbit follow(Stepper<Real>& stepper, const ForceLaw<Real>& law, const Real& omega,
             const std::vector<Barrier<Real>>& walls, Phase<Real> phase, const Real& duration,
             int steps) {
  const std::vector<Real> omegas = {omega};
  StepPath<Real> path(stepper, law, omegas);
  CrossingSearch<Real> search(path);
  Orbit orbit;
  const Real h = duration / steps;
  for (int k = 0; k < steps; ++k) {
    for (Real rest = h; rest > 0;) {
      path.begin(phase, rest);
      auto* last = &path.end();
      const Barrier<Real>* wall = nullptr;
      const PathHull<Real> hull(path.start(), path.end(), 0);
      for (const Barrier<Real>& barrier : walls) {
        if (stays_off(barrier, hull)) continue;
        if (auto* found = search.first(barrier, 0, path.start(), *last)) {
          last = found;
          wall = &barrier;
        }
      }
      phase = last->phase;
      rest = wall ? Real(rest - last->time) : Real(0);
      if (!wall) break;
      const Vector n = wall->normal(phase.position[0]), v = phase.velocity[0];
      phase.velocity[0] = v - (2 * dot(v, n) / dot(n, n)) * n;
      ++orbit.hits;
    }
  }
  orbit.end = phase;
  return orbit;
}

double error_of(const Phase<Real>& a, const Phase<Real>& b) {
  return static_cast<double>(distance(a, b));
}

struct Setting {
  const char* name;
  bool harmonic;
  std::vector<Barrier<Real>> (*walls)();
  double omega;
  Vector position, velocity;  ///< starts whose orbits are not chaotic: else no step is small enough
};

const Setting settings[] = {
    {"well in a circle", true, circular_wall, 0.0, {0.0, 0.125}, {0.75, -0.25}},
    {"well in a circle, with B", true, circular_wall, 1.0, {0.125, 0.0625}, {0.75, 0.5}},
    {"well in a rectangle", true, rectangular_wall, 0.0, {0.125, 0.0625}, {0.75, 0.5}},
    {"well in a rectangle, with B", true, rectangular_wall, 1.0, {0.125, 0.0625}, {0.75, 0.1875}},
    {"Henon-Heiles in a circle", false, circular_wall, 0.0, {0.125, 0.0625}, {0.75, 0.5}},
    {"Henon-Heiles in a circle, with B", false, circular_wall, 1.0, {0.125, 0.0625}, {0.75, 0.5}},
    {"Henon-Heiles in a rectangle", false, rectangular_wall, 0.0, {0.125, 0.0625}, {0.75, 0.5}},
    {"Henon-Heiles in a rectangle, with B",
     false,
     rectangular_wall,
     1.0,
     {0.125, 0.0625},
     {0.75, 0.5}},
    {"well in curves", true, curved_wall, 0.0, {0.0, 0.125}, {0.75, -0.25}},
    {"well in curves, with B", true, curved_wall, 1.0, {0.25, 0.0}, {0.0, 0.875}},
};

class WallsInSteps : public testing::TestWithParam<Setting> {};

TEST_P(WallsInSteps, KeepTheOrder) {
  const Setting& s = GetParam();
  const HarmonicWell well;
  const HenonHeiles henon_heiles;
  const ForceLaw<Real>& law = s.harmonic ? static_cast<const ForceLaw<Real>&>(well) : henon_heiles;
  const std::vector<Barrier<Real>> walls = s.walls();
  const Real omega(s.omega), duration(76);
  const Phase<Real> start{{s.position}, {s.velocity}};
  const auto run = [&](const Scheme& scheme, int steps) {
    const std::vector<Real> omegas = {omega};
    return follow(*stepper_of<Real>(scheme, law, omegas), law, omega, walls, start, duration,
                  steps);
  };
  const Orbit exact = run(find_scheme("kahan-li-8"), 40000);
  EXPECT_GE(exact.hits, 50);
  for (const Scheme& scheme : schemes()) {
    const bool picked =
        scheme.name == "mclachlan-2" || scheme.name == "ruth-3" || scheme.name == "he-4" ||
        scheme.name == "blanes-moan-srkn6b" || scheme.name == "mclachlan-atela-5" ||
        scheme.name == "blanes-moan-srkn11b" || scheme.form == Scheme::Form::spreiter_walter;
    if (!tests::soak() && !picked) continue;
    const int steps = scheme.order < 4   ? 64000
                      : scheme.order < 6 ? 12000
                      : tests::soak()    ? 10000
                                         : 6000;
    const double coarse = error_of(run(scheme, steps).end, exact.end);
    const double fine = error_of(run(scheme, 2 * steps).end, exact.end);
    const double order = std::log2(coarse / fine);
    if (tests::soak())
      std::printf("%-36s %-24s order %d  measured %.3f  error %.2g\n", s.name,
                  std::string(scheme.name).c_str(), scheme.order, order, fine);
    EXPECT_NEAR(order, scheme.order, 0.15) << scheme.name << " errors " << coarse << " " << fine;
  }
}

INSTANTIATE_TEST_SUITE_P(Settings, WallsInSteps, testing::ValuesIn(settings),
                         [](const auto& setting) {
                           return "Setting" + std::to_string(setting.index);
                         });

}  // namespace
}  // namespace carom
#endif
