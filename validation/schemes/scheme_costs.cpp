// What each scheme costs: force evaluations per unit of time until the error at the end is below a
// bound.
//
//   scheme_costs            a Markdown table of costs; the last column is the mean (of logarithms)
//   of
//                           what a scheme needs against the one that needs least
//   scheme_costs errors     error against cost, for a figure
//   scheme_costs tables     the same for Runge–Kutta tables with error control; built-in ones of
//   ARKODE beside its own
#include <cstdio>  // for the headers of ARKODE, which use FILE

#include <arkode/arkode_butcher_erk.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "carom/integrators/make_stepper.hpp"
#include "carom/integrators/scheme.hpp"
#include "integrators/arkode_stepper.hpp"
#include "problems.hpp"

namespace {

using namespace carom;
using problems::Problem;

/// Discs with a soft edge on a square lattice, E = 1/2: V = sum of 2/(1 + exp((r - 0.35)/0.02)).
class SoftLorentz final : public Problem<double> {
 public:
  SoftLorentz() {
    name = "soft Lorentz gas";
    omega = {0.0};
    start.position = {{0.5, 0.45}};
    start.velocity = {{0.8, 0.6}};
  }
  double potential(std::span<const Vector> x) const override {
    double sum = 0.0;
    near(x[0], [&](Vector, double, double e) { sum += height / (1.0 + e); });
    return sum;
  }

 private:
  static constexpr double height = 2.0, disc = 0.35, softness = 0.02;
  /// Visits the nearest disc and its neighbours: the rest is below 1e-14.
  template <class Visit>
  static void near(Vector x, const Visit& visit) {
    const Vector origin{std::round(x.x), std::round(x.y)};
    for (const double i : {-1.0, 0.0, 1.0}) {
      for (const double j : {-1.0, 0.0, 1.0}) {
        const Vector d = x - origin - Vector{i, j};
        const double r = std::sqrt(dot(d, d));
        visit(d, r, std::exp((r - disc) / softness));
      }
    }
  }
  void compute(std::span<const Vector> x, std::span<Vector> a) const override {
    a[0] = {};
    near(x[0], [&](Vector d, double r, double e) {
      a[0] = a[0] + (height / softness * e / ((1.0 + e) * (1.0 + e)) / r) * d;
    });
  }
};

struct Case {
  std::string title;
  std::unique_ptr<Problem<double>> problem;
  double time;       ///< of the walk
  double most_work;  ///< force evaluations per unit of time
  Phase<double> end{};
};

struct Point {
  double work, error, energy_error;
};

double distance(const Phase<double>& a, const Phase<double>& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.position.size(); ++i) {
    const auto dx = a.position[i] - b.position[i], dv = a.velocity[i] - b.velocity[i];
    most = std::max({most, std::fabs(dx.x), std::fabs(dx.y), std::fabs(dv.x), std::fabs(dv.y)});
  }
  return most;
}

/// Walks to the end of the case with `steps` equal steps, or as the error control wants (0).
Point walk(Case& c, Stepper<double>& stepper, long steps, Phase<double>* end = nullptr) {
  const Problem<double>& problem = *c.problem;
  problem.evaluations = 0;
  Phase<double> phase = problem.start, next;
  const double energy = problem.energy(phase);
  double energy_error = 0.0;
  double t = 0.0;
  for (long k = 0; steps > 0 ? k < steps : t < c.time; ++k) {
    t += stepper.step(phase, steps > 0 ? c.time / static_cast<double>(steps) : c.time - t, next);
    std::swap(phase, next);
    energy_error = std::max(energy_error, std::fabs(problem.energy(phase) - energy));
  }
  if (end) *end = phase;
  const double error = distance(phase, c.end);
  return {static_cast<double>(problem.evaluations) / c.time, std::isfinite(error) ? error : 1e9,
          energy_error};
}

Point walk(Case& c, const IntegratorPlan& plan, long steps, Phase<double>* end = nullptr) {
  return walk(c, *make_stepper(plan, *c.problem, c.problem->omega), steps, end);
}

std::vector<Point> curve(Case& c, const std::string& scheme) {
  std::vector<Point> points;
  if (is_adaptive(scheme)) {
    for (double tolerance = 1e-3; tolerance > 2e-15; tolerance /= std::sqrt(10.0)) {
      points.push_back(walk(c, {.scheme = scheme, .tolerance = tolerance}, 0));
    }
    return points;
  }
  const double kicks =
      std::round(walk(c, {.scheme = scheme, .step = 1.0}, 1000).work * c.time / 1000.0);
  for (double work = 4.0; work < c.most_work; work *= std::pow(2.0, 0.25)) {
    const long steps = std::max(1L, std::lround(work * c.time / kicks));
    points.push_back(walk(c, {.scheme = scheme, .step = 1.0}, steps));
  }
  return points;
}

/// Least work from which on the error stays below the bound, between two points by logarithms; 0:
/// never.
double work_for(const std::vector<Point>& points, double bound) {
  std::size_t k = points.size();
  while (k > 0 && points[k - 1].error < bound) --k;
  if (k == points.size()) return 0.0;
  if (k == 0) return points[0].work;
  const Point &a = points[k - 1], &b = points[k];
  const double share =
      (std::log(a.error) - std::log(bound)) / (std::log(a.error) - std::log(b.error));
  return a.work * std::pow(b.work / a.work, share);
}

std::vector<Case> make_cases() {
  std::vector<Case> cases;
  cases.push_back(
      {"Hénon–Heiles, B = 0", std::make_unique<problems::HenonHeiles<double>>("0"), 50.0, 2000.0});
  cases.push_back({"Hénon–Heiles, B = 1.5", std::make_unique<problems::HenonHeiles<double>>("1.5"),
                   50.0, 2000.0});
  cases.push_back(
      {"Coulomb, B = 0", std::make_unique<problems::CoulombParticles<double>>("0"), 20.0, 4000.0});
  cases.push_back({"Coulomb, ω = 1.5, −0.75, 0",
                   std::make_unique<problems::CoulombParticles<double>>("1.5"), 20.0, 4000.0});
  cases.push_back({"soft Lorentz gas", std::make_unique<SoftLorentz>(), 4.0, 40000.0});
  for (Case& c : cases) {
    walk(c, {.scheme = "kahan-li-8", .step = 1.0}, std::lround(c.most_work * c.time / 8.0), &c.end);
  }
  return cases;
}

const double bounds[] = {1e-3, 1e-6, 1e-9};

void print_tables(std::vector<Case>& cases) {
  const struct {
    const char* name;
    ARKodeButcherTable table;
  } tables[] = {{"Verner 9(8)", nullptr},
                {"Fehlberg 7(8)", ARKodeButcherTable_LoadERK(ARKODE_FEHLBERG_13_7_8)},
                {"Verner 6(5)", ARKodeButcherTable_LoadERK(ARKODE_VERNER_8_5_6)},
                {"Dormand–Prince 5(4)", ARKodeButcherTable_LoadERK(ARKODE_DORMAND_PRINCE_7_4_5)}};
  for (const auto& [name, table] : tables) {
    std::printf("| %s |", name);
    for (Case& c : cases) {
      std::vector<Point> points;
      for (double tolerance = 1e-3; tolerance > 2e-15; tolerance /= std::sqrt(10.0)) {
        integrators::ArkodeStepper stepper(*c.problem, c.problem->omega, tolerance, table);
        points.push_back(walk(c, stepper, 0));
      }
      for (const double bound : {1e-5, 1e-7, 1e-9, 1e-11}) {
        const double work = work_for(points, bound);
        if (work > 0.0)
          std::printf(" %.0f |", work);
        else
          std::printf(" – |");
      }
    }
    std::printf("\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  const bool errors = argc > 1 && std::strcmp(argv[1], "errors") == 0;
  std::vector<Case> cases = make_cases();
  if (argc > 1 && std::strcmp(argv[1], "tables") == 0) {
    print_tables(cases);
    return 0;
  }
  std::vector<std::pair<std::string, int>> names;
  for (const Scheme& scheme : schemes()) names.emplace_back(scheme.name, scheme.order);
  names.emplace_back("arkode", 9);
  names.emplace_back("cvode", 0);

  std::map<std::string, std::vector<double>> table;
  for (const auto& [name, order] : names) {
    for (Case& c : cases) {
      const std::vector<Point> points = curve(c, name);
      for (const double bound : bounds) table[name].push_back(work_for(points, bound));
      for (const Point& p : points) {
        if (errors)
          std::printf("%s\t%s\t%.6g\t%.3g\t%.3g\n", name.c_str(), c.title.c_str(), p.work, p.error,
                      p.energy_error);
      }
    }
  }
  if (errors) return 0;

  std::printf("| scheme | order |");
  std::string rule = "|---|---|";
  for (const Case& c : cases) {
    for (const double bound : bounds) {
      std::printf(" %s%.0e |", bound == bounds[0] ? (c.title + ": ").c_str() : "", bound);
      rule += "---|";
    }
  }
  std::printf(" times the least |\n%s---|\n", rule.c_str());
  std::vector<double> best(table.begin()->second.size(), 1e300);
  for (const auto& [name, work] : table)
    for (std::size_t k = 0; k < work.size(); ++k)
      if (work[k] > 0.0) best[k] = std::min(best[k], work[k]);
  for (const auto& [name, order] : names) {
    std::printf("| %s | %s |", name.c_str(), order > 0 ? std::to_string(order).c_str() : "1 to 12");
    double sum = 0.0;
    bool always = true;
    for (std::size_t k = 0; k < best.size(); ++k) {
      const double work = table[name][k];
      always = always && work > 0.0;
      if (work > 0.0) {
        std::printf(" %.0f |", work);
        sum += std::log(work / best[k]);
      } else {
        std::printf(" – |");
      }
    }
    if (always) std::printf(" %.2f |\n", std::exp(sum / static_cast<double>(best.size())));
    if (!always) std::printf(" – |\n");
  }
}
