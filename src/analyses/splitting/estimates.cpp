// What independent populations say together.
#include <algorithm>
#include <cmath>
#include <functional>

#include "analyses/splitting/means.hpp"
#include "base/student.hpp"
#include "carom/analyses/escape/survival.hpp"
#include "carom/analyses/splitting.hpp"
#include "carom/base/elementary.hpp"

namespace carom {

using namespace analyses;

namespace {

// Intercept of the least-squares line in delta^2 through the values at delta, delta / 2, delta / 4:
// -a/6 + b/2 + 2c/3, written so that equal values have themselves as their limit.
double intercept(double a, double b, double c) { return c + (b - c) / 2 - (a - c) / 6; }

Mean mean_of(const std::vector<double>& values) {
  const double n = static_cast<double>(values.size());
  if (values.size() < 2) return {values.empty() ? std::nan("") : values.front(), std::nan("")};
  double sum = 0.0, squares = 0.0;
  for (const double value : values) sum += value - values.front();
  const double mean = values.front() + sum / n;  // of equal values it is their own
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {mean, std::sqrt(squares / (n * (n - 1.0)))};
}

}  // namespace

Extrapolated analyses::extrapolated(const SplittingResult& result,
                                    const std::function<double(std::size_t, std::size_t)>& of) {
  Extrapolated out;
  std::size_t common = result.runs[0].size();
  for (std::size_t k = 0; k < kick_sizes; ++k) {
    std::vector<double> values;
    for (std::size_t r = 0; r < result.runs[k].size(); ++r) values.push_back(of(k, r));
    out.at_kick[k] = mean_of(values);
    common = std::min(common, result.runs[k].size());
  }
  // The populations of one repetition start from the same states: their line is drawn before the
  // mean.
  std::vector<double> limits;
  for (std::size_t r = 0; r < common; ++r)
    limits.push_back(intercept(of(0, r), of(1, r), of(2, r)));
  out.limit = mean_of(limits);
  out.repetitions = common;
  out.extrapolation = std::fabs(out.limit.value - out.at_kick.back().value);
  return out;
}

namespace {

// Upper limit of the share that goes, where none of the trajectories has gone. Populations at the
// three kicks share their starts, which count once.
double unseen_share(const SplittingResult& result) {
  const auto starts =
      static_cast<std::uint64_t>(result.runs.front().size()) * result.plan.population;
  return wilson_interval(0, starts).high;
}

bool all_are(const Extrapolated& value, double number) {
  return value.limit.error == 0.0 &&
         std::all_of(value.at_kick.begin(), value.at_kick.end(),
                     [&](const Mean& mean) { return mean.value == number && mean.error == 0.0; });
}

}  // namespace

Mean cost_of_kicks(const std::vector<PopulationRun>& runs, std::size_t stages) {
  std::vector<double> costs(runs.size(), 0.0);
  for (std::size_t k = 0; k < stages; ++k) {
    double followed = 0.0, stayed = 0.0;
    for (const PopulationRun& run : runs)
      if (k < run.copies.size()) {
        followed +=
            static_cast<double>(run.copies[k].first.followed + run.copies[k].kicked.followed);
        stayed += static_cast<double>(run.copies[k].first.stayed + run.copies[k].kicked.stayed);
      }
    // Divided by what all of them say: by a population's own share it would be off where few stay.
    for (std::size_t r = 0; r < runs.size() && stayed > 0.0; ++r) {
      if (!(k < runs[r].copies.size())) continue;
      const auto share = [](const Staying& s) {
        return static_cast<double>(s.stayed) / static_cast<double>(s.followed);
      };
      const CopiesOfStage& copies = runs[r].copies[k];
      if (copies.first.followed == 0 || copies.kicked.followed == 0) continue;
      const double of_all = static_cast<double>(copies.kicked.followed) /
                            static_cast<double>(copies.first.followed + copies.kicked.followed);
      costs[r] += of_all * (share(copies.kicked) - share(copies.first)) / (stayed / followed);
    }
  }
  return mean_of(costs);
}

Mean cost_of_kicks(const SplittingResult& result, std::size_t report) {
  const bool by_time = result.plan.by == SplittingPlan::Level::time;
  const std::vector<double>& levels = result.plan.levels;
  // Stage k begins at level k - 1.
  std::size_t stages = report + 1;
  if (by_time)
    stages =
        static_cast<std::size_t>(std::lower_bound(levels.begin(), levels.end(), result.at[report]) -
                                 levels.begin()) +
        1;
  return cost_of_kicks(result.runs.back(), stages);
}

namespace {

bool exceeds(const Mean& cost, std::size_t repetitions, double quantile) {
  return repetitions >= 2 &&
         std::fabs(cost.value) >
             base::student_quantile(quantile, static_cast<double>(repetitions - 1)) * cost.error;
}

}  // namespace

bool is_likely(const Mean& cost, std::size_t repetitions) {
  return exceeds(cost, repetitions, 0.975);
}

bool is_certain(const Mean& cost, std::size_t repetitions) {
  return exceeds(cost, repetitions, 0.999);
}

double analyses::kick_error(const SplittingResult& result, std::size_t from, std::size_t to) {
  const Mean cost = cost_of_kicks(result, to);
  if (!is_certain(cost, result.runs.back().size())) return 0.0;
  return 2.0 * std::fabs(cost.value - (from < to ? cost_of_kicks(result, from).value : 0.0));
}

double Extrapolated::band() const {
  if (repetitions < 2) return std::nan("");
  return base::student_quantile(0.975, static_cast<double>(repetitions - 1)) * limit.error +
         extrapolation + kick_error + unseen;
}

double Extrapolated::low() const {
  const double v = limit.value;
  const bool by_logarithm = least == 0.0 && v > 0.0 && limit.error > 0.0;
  return std::max(least, by_logarithm ? v * elementary::exp(-band() / v) : v - band());
}

double Extrapolated::high() const {
  const double v = limit.value;
  const bool by_logarithm = least == 0.0 && v > 0.0 && limit.error > 0.0;
  return std::min(most,
                  by_logarithm ? v * elementary::exp(band() / v) : std::max(v, least) + band());
}

std::vector<SplitPoint> survival(const SplittingResult& result) {
  std::vector<SplitPoint> points;
  for (std::size_t i = 0; i < result.at.size(); ++i) {
    SplitPoint point;
    point.at = result.at[i];
    point.p = extrapolated(
        result, [&](std::size_t k, std::size_t r) { return result.runs[k][r].survival[i]; });
    point.p.least = 0.0;
    point.p.most = 1.0;
    point.p.kick_error = kick_error(result, i, i) * point.p.limit.value;
    const Mean& p = point.p.limit;
    point.equivalent = p.error > 0.0 ? p.value * (1.0 - p.value) / (p.error * p.error) : 0.0;
    if (all_are(point.p, 1.0)) {
      point.p.unseen = unseen_share(result);
      point.equivalent = static_cast<double>(result.runs.front().size()) *
                         static_cast<double>(result.plan.population);
    }
    points.push_back(point);
  }
  return points;
}

std::vector<SplitRate> escape_rate(const SplittingResult& result) {
  std::vector<SplitRate> points;
  if (result.plan.by != SplittingPlan::Level::time) return points;
  const std::vector<SplitPoint> shares = survival(result);
  double from = 0.0, there = 1.0;
  for (std::size_t i = 0; i < result.at.size(); ++i) {
    const double to = result.at[i];
    if (to > from) {
      SplitRate point;
      point.from = from;
      point.to = to;
      point.t = from > 0.0 ? std::sqrt(from) * std::sqrt(to) : to / 2;
      point.value = extrapolated(result, [&](std::size_t k, std::size_t r) {
        return result.runs[k][r].gone[i] / (to - from);
      });
      point.value.least = 0.0;
      point.value.most = 1.0 / (to - from);
      point.value.kick_error = kick_error(result, i, i) * point.value.limit.value;
      if (all_are(point.value, 0.0))
        point.value.unseen = there * unseen_share(result) / (to - from);
      points.push_back(point);
    }
    from = to;
    there = shares[i].p.limit.value;
  }
  return points;
}

}  // namespace carom
