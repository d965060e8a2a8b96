#include "validation/cases/cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include "carom/analyses/compare.hpp"
#include "carom/analyses/lyapunov/repeller.hpp"
#include "carom/base/error.hpp"
#include "carom/files/system_file.hpp"
#include "carom/integrators/scheme.hpp"
#include "validation/cases/orbit_cases.hpp"

namespace carom::validation {

namespace {

constexpr double pi = 3.14159265358979323846;

struct ClosedTable {
  const char* name;
  const char* toml;    ///< [table] and [field]
  double no_hit_area;  ///< A0: centres of Larmor circles that meet no wall
  bool soaked;         ///< also run long, for lost trajectories
};

const ClosedTable closed_tables[] = {
    {"stadium", "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n", 0, true},
    {"mushroom", "[table]\nshape = \"mushroom\"\ncap_radius = 1\nstem_width = 1\nstem_height = 1\n",
     0, true},
    {"sinai", "[table]\nshape = \"sinai\"\nside = 1\nradius = 0.4\n", 0, true},
    {"sinai-in-walls", "[table]\nshape = \"sinai\"\nside = 1\nradius = 0.4\ntorus = false\n", 0,
     false},
    {"lorentz-triangular",
     "[table]\nshape = \"lorentz\"\nlattice = \"triangular\"\nspacing = 2.2\nradius = 1\n", 0,
     false},
    {"circle", "[table]\nshape = \"circle\"\nradius = 1\n", 0, false},
    {"ellipse", "[table]\nshape = \"ellipse\"\na = 1\nb = 0.75\n", 0, false},
    {"square", "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n", 0, false},
    {"magnetic-square",
     "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[field]\nlarmor_radius = 0.5075\n", 0,
     true},
    {"magnetic-square-0.4",
     "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[field]\nlarmor_radius = 0.4\n",
     0.2 * 0.2, false},
    {"magnetic-circle-0.5",
     "[table]\nshape = \"circle\"\nradius = 1\n[field]\nlarmor_radius = 0.5\n", pi / 4, false},
    {"magnetic-circle-3", "[table]\nshape = \"circle\"\nradius = 1\n[field]\nlarmor_radius = 3\n",
     0, false},
    {"ellipse-magnetic",
     "[table]\nshape = \"ellipse\"\na = 1\nb = 0.75\n[field]\nlarmor_radius = 3\n", 0, true},
};

// Particles that enter the stem escape.
const char* open_mushroom =
    "[table]\nshape = \"mushroom\"\ncap_radius = 1\nstem_width = 1\nstem_height = 1\n"
    "[[table.hole]]\nwall = \"stem_bottom\"\ncenter = 0.5\nwidth = 1\n"
    "[[table.hole]]\nwall = \"stem_right\"\ncenter = 0.5\nwidth = 1\n"
    "[[table.hole]]\nwall = \"stem_left\"\ncenter = 0.5\nwidth = 1\n[initial]\nkind = "
    "\"uniform\"\n";

const char* open_square =
    "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n"
    "[[table.hole]]\nwall = \"right\"\ncenter = 0.5\nwidth = 1\n";

// Fronts of parallel flights from halfway between two discs, as wide as orbits are that come back
// from the second one: all meet it, and from the third hit on the share that is left falls as it
// does for ever, within 2 in 10^4 (the rates within 1 in 10^4).
const char* two_disc_front =
    "[initial]\nkind = \"line\"\nfrom = [3, -0.1]\nto = [3, 0.1]\nangle = 0\n";
const char* three_disc_front =
    "[initial]\nkind = \"line\"\nfrom = [3, -0.1]\nto = [3, 0.65]\nangle = 0\n";
const char* two_discs = "[table]\nshape = \"discs\"\ncenters = [[0, 0], [6, 0]]\nradius = 1\n";
const char* three_discs =
    "[table]\nshape = \"discs\"\ncenters = [[0, 0], [6, 0], [3, \"3*sqrt(3)\"]]\nradius = 1\n";

std::string table_of(const std::string& name) {
  if (name == "square torus")
    return "[table]\nshape = \"lorentz\"\nlattice = \"square\"\nspacing = 1\nradius = 0.4\n";
  for (const ClosedTable& table : closed_tables)
    if (table.name == name) return table.toml;
  throw InternalError("no such table: " + name);
}

struct Size {
  double trajectories, hits;  ///< hits: cap of a trajectory
  std::uint64_t seed = 1;
};

class Planner {
 public:
  Planner(bool soak, double scale) : soak_(soak), scale_(scale) {}

  template <class Run>
  void add(std::string name, std::string source, Allowance allowance, Run run) {
    cases_.push_back({std::move(name), std::move(source), allowance, std::move(run)});
  }
  bool quick() const { return scale_ < 1.0; }
  double pick(double usual, double in_soak) const { return soak_ ? in_soak : usual; }
  double scaled(double trajectories) const {
    return std::max(100.0, std::round(trajectories * scale_));
  }

  /// Without a last time: until the cap on hits.
  System closed(const std::string& name, const std::string& toml, Size size) const {
    return read_system(
               fmt::format("{}[particles]\nspeed = 1\n[run]\nt_max = 1e12\ncollisions = {:.0f}\n"
                           "trajectories = {:.0f}\nseed = {}\n",
                           toml, size.hits, scaled(size.trajectories), size.seed),
               name)
        .system;
  }
  /// Until a last time, from the invariant measure.
  System timed(const std::string& name, const std::string& table, double trajectories,
               double t_max) const {
    return read_system(fmt::format("{}[initial]\nkind = \"uniform\"\n[particles]\nspeed = 1\n"
                                   "[run]\nt_max = {}\ntrajectories = {:.0f}\n",
                                   table, t_max, scaled(trajectories)),
                       name)
        .system;
  }
  System builtin(const char* name, double trajectories,
                 std::vector<std::pair<std::string, std::string>> set = {}) const {
    SystemOverrides overrides;
    overrides.set = std::move(set);
    overrides.trajectories =
        fmt::format("{:.0f}", trajectories > 1 ? scaled(trajectories) : trajectories);
    return load_system(name, overrides).system;
  }
  std::vector<Case> take() { return std::move(cases_); }

 private:
  bool soak_;
  double scale_;
  std::vector<Case> cases_;
};

void add_closed_tables(Planner& plan) {
  for (const ClosedTable& table : closed_tables) {
    const std::string name = table.name, toml = table.toml;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const System system = plan.closed(name, toml + "[initial]\nkind = \"boundary\"\n",
                                        {plan.pick(1e4, 1e5), 100, seed});
      plan.add(name + ": mean flight", "pi (A - A0)/L (Santalo; Chernov 1997)", {},
               [system, area = table.no_hit_area](const CheckOptions& options) {
                 return check_mean_flight(system, area, options);
               });
    }
    if (!table.soaked) continue;
    const System system =
        plan.closed(name, toml + "[initial]\nkind = \"uniform\"\n", {plan.pick(1e3, 1e5), 1e4});
    plan.add(name + ": nothing lost", "a closed table", {},
             [system](const CheckOptions& options) { return check_nothing_lost(system, options); });
  }
}

void add_survivors(Planner& plan, std::string name, std::string source, System system,
                   double factor, Estimate expected, Allowance allowance) {
  plan.add(std::move(name), std::move(source), allowance,
           [system = std::move(system), factor, expected, allowance](const CheckOptions& options) {
             return check_survivors(system, factor, expected, allowance, options);
           });
}

void add_published(Planner& plan) {
  // Orbits of the cap's ergodic part that graze the opening for long: a share of about 0.2/n after
  // n hits.
  const double hits = plan.pick(1e3, 1e4);
  add_survivors(plan, "mushroom: regular share",
                "(acos k - k sqrt(1 - k^2))/(pi/2 + 1), k = 1/2 (Bunimovich 2001)",
                plan.closed("mushroom", open_mushroom, {plan.pick(2e5, 1e6), hits}), 1.0,
                {0.2389084047}, {0.0, 0.3 / hits});
  System quasi_random = plan.closed("mushroom", open_mushroom, {plan.pick(1 << 17, 1 << 20), hits});
  quasi_random.initial.kind = InitialCondition::Kind::sobol;
  add_survivors(plan, "mushroom: regular share, quasi-random starts",
                "(acos k - k sqrt(1 - k^2))/(pi/2 + 1), k = 1/2 (Bunimovich 2001)", quasi_random,
                1.0, {0.2389084047}, {0.0, 0.3 / hits});
  // Flights that reach the open side: a share E[max(0, t cos)] = t/pi of all.
  System square = plan.timed("open-square", open_square, plan.pick(1 << 20, 1 << 24), 0.5);
  square.initial.kind = InitialCondition::Kind::sobol;
  add_survivors(plan, "open square: survival, quasi-random starts", "1 - t/pi, t = 1/2", square,
                1.0, {1.0 - 0.5 / pi}, {});

  const double walkers = plan.pick(4e6, 5e7);
  const System three =
      plan.closed("three-disc", std::string(three_discs) + three_disc_front, {walkers, 4});
  plan.add("three-disc: survival per bounce", "cycle expansion (Gaspard & Rice 1989)", {},
           [three](const CheckOptions& options) {
             return check_survival_per_hit(three, 0.183029795396354243674, options);
           });
  plan.add("three-disc: escape rate", "cycle expansion (Gaspard & Rice 1989)", {},
           [three](const CheckOptions& options) {
             return check_escape_rate(three, 0.41033840776934648933846130782, options);
           });
  // R = 6: ln(5 + sqrt(24))/4.
  const System two = plan.closed("two-disc", std::string(two_discs) + two_disc_front, {walkers, 4});
  plan.add("two-disc: escape rate", "ln(R - 1 + sqrt(R (R - 2)))/(R - 2), R = 6", {},
           [two](const CheckOptions& options) {
             return check_escape_rate(two, 0.57310791771781968, options);
           });

  add_survivors(plan, "stadium: t P(t), t = 1600", "limit of Dettmann & Georgiou 2009",
                plan.builtin("stadium", plan.pick(1.5e6, 3e7)), 1600.0, {0.827494}, {0.01, 0.01});
  add_survivors(plan, "circle: t P(t), t = 400",
                "limit of Bunimovich & Dettmann 2005; about 1 % more at t = 400",
                plan.builtin("circle", plan.pick(2e6, 1e8)), 400.0, {1.328601}, {0.0, 0.027});
  const System recurring =
      read_system(
          fmt::format("{}[[table.hole]]\nwall = \"bottom\"\ncenter = 0.5\nwidth = 0.2\n"
                      "[initial]\nkind = \"hole\"\nhole = \"hole_1\"\n[particles]\nspeed = 1\n"
                      "[run]\nt_max = 1e6\ntrajectories = {:.0f}\n",
                      table_of("sinai-in-walls"), plan.scaled(plan.pick(1e5, 1e7))),
          "sinai-in-walls")
          .system;
  plan.add("sinai-in-walls: mean time of recurrence", "pi A/(w v) (Kac 1947)", {},
           [recurring](const CheckOptions& options) {
             return check_recurrence(recurring, pi * (1.0 - pi * 0.4 * 0.4) / 0.2, options);
           });
  const struct {
    const char* t;
    double usual, soak;
    Estimate expected;
  } survivals[] = {{"1", 1e6, 5e7, {0.905108, 6e-6}},
                   {"2", 1e6, 5e7, {0.810311, 5e-6}},
                   {"5", 1e6, 2e7, {0.63667, 2e-5}},
                   {"1000", 1e5, 2e6, {0.044705, 4.6e-5}}};
  for (const auto& one : survivals)
    add_survivors(
        plan, fmt::format("magnetic-square: P({})", one.t),
        "independent simulation of fig. 5 of Solanpaa et al. 2016",
        plan.builtin("magnetic-square", plan.pick(one.usual, one.soak), {{"run.t_max", one.t}}),
        1.0, one.expected, {});
  const struct {
    const char* t;
    double usual, soak;
    Estimate expected;
  } displacements[] = {
      {"1", 2e4, 2e6, {0.620587, 2e-6}},
      {"10", 4e3, 2e5, {33.28, 0.05}},
      {"100", 500, 2e4, {2173, 9}},
      {"1000", 0, 2e3, {1.79e5, 4e3}}};  // in the soak alone: few trajectories say nothing
  for (const auto& one : displacements) {
    if (plan.pick(one.usual, one.soak) == 0) continue;
    const System system =
        plan.builtin("soft-lorentz", plan.pick(one.usual, one.soak),
                     {{"run.t_max", one.t}, {"run.times", fmt::format("[{}]", one.t)}});
    plan.add(fmt::format("soft-lorentz: MSD({})", one.t),
             "independent simulation of fig. 6 of Solanpaa et al. 2016", {},
             [system, expected = one.expected](const CheckOptions& options) {
               return check_displacement(system, expected, options);
             });
  }
  const System gas = plan.builtin("lorentz-triangular", plan.pick(1e6, 2e7),
                                  {{"run.t_max", "8"}, {"run.times", "[8]"}});
  plan.add("lorentz-triangular: Green-Kubo D(8)",
           "independent simulation, from the slope of the MSD", {},
           [gas](const CheckOptions& options) {
             return check_green_kubo(gas, {0.1699, 3e-4}, options);
           });
  System torus = plan.timed("square torus", table_of("square torus"), plan.pick(5e4, 1e6), 20);
  torus.run.free_paths = true;
  plan.add("square torus: mean free path", "(1 - pi R^2)/(2 R), R = 2/5 (Santalo)", {},
           [torus](const CheckOptions& options) {
             return check_free_path(torus, (1.0 - 0.16 * 3.141592653589793) / 0.8, options);
           });
  const System photon = load_system("siam-photon").system;
  // Rounding grows by about exp(2.07) a hit (Dahlqvist's exponent), to some 10^-3 after 14 hits.
  const Allowance rounding{0.02, 0.02};
  plan.add("siam-photon: distance at t = 10",
           "SIAM 100-Digit Challenge, problem 2; rounding grows to 1e-3", rounding,
           [photon, rounding](const CheckOptions&) {
             return check_distance(photon, 0.995262919443354160891, rounding);
           });
}

void add_exponents(Planner& plan) {
  const struct {
    const char* name;
    double t_max, usual, soak;
    Exponent what;
    Estimate expected;
  } exponents[] = {{"stadium", 1000, 1e5, 1e6, Exponent::per_time, {0.4297, 2e-4}},
                   {"square torus", 200, 1e5, 1e6, Exponent::per_time, {2.73845, 4e-4}},
                   {"square torus", 200, 1e5, 1e6, Exponent::per_hit, {1.7026, 3e-4}},
                   {"lorentz-triangular", 200, 1e5, 1e6, Exponent::per_time, {2.1046, 1e-4}},
                   {"mushroom", 2000, 1e5, 5e6, Exponent::regular_share, {0.2389084047}}};
  for (const auto& one : exponents) {
    const System system =
        plan.timed(one.name, table_of(one.name), plan.pick(one.usual, one.soak), one.t_max);
    const char* const what = one.what == Exponent::per_time  ? "Lyapunov exponent"
                             : one.what == Exponent::per_hit ? "Lyapunov exponent per hit"
                                                             : "regular share by SALI";
    plan.add(fmt::format("{}: {}", one.name, what),
             one.what == Exponent::regular_share
                 ? "(acos k - k sqrt(1 - k^2))/(pi/2 + 1), k = 1/2 (Bunimovich 2001)"
                 : "independent simulation",
             {}, [system, one](const CheckOptions& options) {
               return check_exponent(system, one.what, one.expected, options);
             });
  }
  // In their relative motion, of speed 1, two discs on a torus are one particle on the square
  // torus.
  const System pair =
      read_system(fmt::format("[lattice]\nvectors = [[1, 0], [0, 1]]\n"
                              "[interaction]\nkind = \"hard-discs\"\nradius = 0.2\n"
                              "[particles]\ncount = 2\n[initial]\nkind = \"list\"\n"
                              "starts = [[0.1, 0.2, 0.3, 0.4], [0.6, 0.7, -0.3, -0.4]]\n"
                              "[run]\nt_max = {:.0f}\nspectrum = true\n",
                              plan.pick(2e5, 1e7)),
                  "two discs on a torus")
          .system;
  plan.add("two discs on a torus: entropy", "independent simulation of their relative motion", {},
           [pair](const CheckOptions& options) {
             return check_exponent(pair, Exponent::entropy, {2.73845, 4e-4}, options);
           });
  System three_disc = plan.builtin("three-disc", plan.pick(1e5, 1e6));
  three_disc.run.trajectories = std::max(three_disc.run.trajectories, least_of_repeller());
  plan.add("three-disc: Lyapunov exponent", "cycle expansion, 18 digits (ChaosBook)", {},
           [three_disc](const CheckOptions& options) {
             return check_exponent(three_disc, Exponent::per_time, {0.577552578771878598}, options);
           });
  // One orbit, which stays near islands for some 10^4 at a time: shorter runs say little.
  if (plan.pick(0, 1) == 0) return;
  const System henon_heiles = plan.builtin("henon-heiles", 1, {{"run.t_max", "2e6"}});
  plan.add("henon-heiles: Lyapunov exponent", "independent simulation from (0, -1/4, 0)", {},
           [henon_heiles](const CheckOptions& options) {
             return check_exponent(henon_heiles, Exponent::per_time, {0.044, 0.001}, options);
           });
}

// Stated orders by slopes of errors, with and without a field. A quick look has a shorter orbit:
// the reference in 34 digits takes most of the time, and the slopes are the same.
void add_orders(Planner& plan) {
  for (const char* field : {"0", "1.5"}) {
    SystemOverrides overrides;
    overrides.set = {{"field.B", field}};
    const System system = load_system("henon-heiles", overrides).system;
    std::vector<std::string> schemes = default_comparison(system);
    std::erase_if(schemes, [](const std::string& name) { return is_adaptive(name); });
    const auto orders = std::make_shared<Orders>(system, schemes, plan.quick() ? 5.0 : 0.0);
    for (const std::string& scheme : schemes)
      plan.add(fmt::format("order of {}, B = {}", scheme, field),
               "the scheme's order conditions, on the Hénon–Heiles potential", {},
               [orders, scheme](const CheckOptions&) { return orders->check(scheme); });
  }
}

}  // namespace

std::vector<Case> all_cases(bool soak, double scale) {
  Planner plan(soak, scale);
  add_closed_tables(plan);
  add_published(plan);
  add_exponents(plan);
  add_orders(plan);
  std::vector<Case> cases = plan.take();
  add_equilibria(cases);
  add_orbit_cases(cases);
  return cases;
}

}  // namespace carom::validation
