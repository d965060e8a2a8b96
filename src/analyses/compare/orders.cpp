#include "analyses/compare/orders.hpp"

#include <algorithm>
#include <cmath>

#include "carom/base/elementary.hpp"

namespace carom::analyses {

namespace {

/// An error counts where it is this many times what rounding may have made of it: the slope between
/// two steps then errs by less than 2/(ln 2 * 16), a sixth.
constexpr double above_noise = 16.0;
constexpr std::size_t fewest_steps = 3;
/// Two slopes that differ by more belong to no power law.
constexpr double settled = 0.5;
/// The window goes on to longer steps as long as slopes change by no more than this.
constexpr double alike = 0.1;
/// Slopes that differ by d between two pairs of steps differ from their limit by d (first powers
/// of the step) or d/3 (second), and the slope through both pairs by half of d more.
constexpr double beyond_the_last = 1.5;

struct Point {
  double step, log_step, log_error, noise;
};

double slope(const Point& a, const Point& b) {
  return (a.log_error - b.log_error) / (a.log_step - b.log_step);
}

}  // namespace

MeasuredOrder measured_order(const std::vector<ComparedRun>& runs,
                             const std::vector<double>& noise) {
  MeasuredOrder order;
  std::vector<Point> points;
  bool rounded = false;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const ComparedRun& run = runs[k];
    if (run.failed() || !(run.step > 0.0)) continue;
    if (run.error_state <= above_noise * noise[k]) {  // both may be 0
      rounded = true;
      break;
    }
    if (!(run.error_state < largest_error)) {
      points.clear();
      continue;
    }
    points.push_back({run.step, elementary::log(run.step), elementary::log(run.error_state),
                      noise[k] / run.error_state});
  }
  if (points.size() < fewest_steps) {
    order.reason = !rounded         ? "too few steps have errors below a twentieth"
                   : points.empty() ? "its errors are those of rounding"
                                    : "rounding hides the errors of shorter steps";
    return order;
  }
  std::size_t first = points.size() - fewest_steps;
  double last_slope = slope(points[points.size() - 2], points.back());
  if (std::fabs(slope(points[first], points[first + 1]) - last_slope) > settled) {
    order.reason = "the slope has not settled at the shortest steps";
    return order;
  }
  while (first > 0 && std::fabs(slope(points[first - 1], points[first]) - last_slope) < alike)
    --first;
  const double count = static_cast<double>(points.size() - first);
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, low = last_slope, high = last_slope;
  for (std::size_t k = first; k < points.size(); ++k) {
    x += points[k].log_step / count;
    y += points[k].log_error / count;
  }
  for (std::size_t k = first; k < points.size(); ++k) {
    xx += (points[k].log_step - x) * (points[k].log_step - x);
    xy += (points[k].log_step - x) * (points[k].log_error - y);
    if (k + 1 == points.size()) break;
    const double one = slope(points[k], points[k + 1]);
    low = std::min(low, one);
    high = std::max(high, one);
  }
  if (!(xy > 0.0)) {
    order.reason = "its errors do not fall with the step";
    return order;
  }
  const double span = points[first].log_step - points.back().log_step;
  order.slope = MeasuredNumber{
      xy / xx, beyond_the_last * (high - low) + (points[first].noise + points.back().noise) / span};
  order.longest = points[first].step;
  order.shortest = points.back().step;
  order.steps = static_cast<int>(points.size() - first);
  return order;
}

std::optional<WorkForError> work_for(const std::vector<ComparedRun>& runs, double error) {
  std::size_t k = runs.size();
  while (k > 0 && !runs[k - 1].failed() && runs[k - 1].error_state <= error) --k;
  if (k == runs.size()) return {};
  const ComparedRun& good = runs[k];
  WorkForError work{good.step, good.tolerance, static_cast<double>(good.force_evaluations),
                    good.cpu_seconds};
  if (k == 0 || runs[k - 1].failed() || !std::isfinite(runs[k - 1].error_state) ||
      !(good.error_state > 0.0))
    return work;
  const ComparedRun& poor = runs[k - 1];
  const double wanted = elementary::log(error), from = elementary::log(poor.error_state);
  const double share = (from - wanted) / (from - elementary::log(good.error_state));
  const auto between = [share](double a, double b) {
    if (!(a > 0.0 && b > 0.0)) return b;
    return elementary::exp(elementary::log(a) + share * (elementary::log(b) - elementary::log(a)));
  };
  work.step = between(poor.step, good.step);
  work.tolerance = between(poor.tolerance, good.tolerance);
  work.force_evaluations = between(static_cast<double>(poor.force_evaluations),
                                   static_cast<double>(good.force_evaluations));
  work.cpu_seconds = between(poor.cpu_seconds, good.cpu_seconds);
  return work;
}

}  // namespace carom::analyses
