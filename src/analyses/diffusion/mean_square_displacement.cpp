#include "carom/analyses/diffusion/mean_square_displacement.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "carom/base/elementary.hpp"
#include "carom/base/error.hpp"
#include "results/numbers.hpp"

namespace carom {

namespace {

using results::nan;

struct Line {
  double slope, offset;
};

// Weighted least squares about the weighted means, which keeps the digits.
Line line_through(const std::vector<double>& x, const std::vector<double>& y,
                  const std::vector<double>& w) {
  double sum = 0, mean_x = 0, mean_y = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum += w[i];
    mean_x += w[i] * x[i];
    mean_y += w[i] * y[i];
  }
  mean_x /= sum;
  mean_y /= sum;
  double xx = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += w[i] * (x[i] - mean_x) * (x[i] - mean_x);
    xy += w[i] * (x[i] - mean_x) * (y[i] - mean_y);
  }
  const double slope = xy / xx;
  return {slope, mean_y - slope * mean_x};
}

// Exponent a of the best y = A t^a + c: for each a the best A and c are a line in t^a. NaN where
// the best lies at the edge of what is searched: then this form does not describe the points.
double exponent_beyond_offset(const std::vector<double>& log_t, const std::vector<double>& y,
                              const std::vector<double>& w) {
  std::vector<double> power(log_t.size());
  const auto misfit = [&](double a) {
    for (std::size_t i = 0; i < power.size(); ++i)
      power[i] = elementary::exp(a * (log_t[i] - log_t.back()));
    const Line line = line_through(power, y, w);
    double sum = 0;
    for (std::size_t i = 0; i < power.size(); ++i) {
      const double off = y[i] - line.offset - line.slope * power[i];
      sum += w[i] * off * off;
    }
    return sum;
  };
  // The lowest of a row, then its neighbourhood by the golden section.
  constexpr double step = 0.05, last = 4.0, golden = 0.6180339887498949;
  double best = step, least = misfit(step);
  for (double a = 2 * step; a <= last; a += step) {
    const double here = misfit(a);
    if (here < least) best = a, least = here;
  }
  if (best == step || best + step > last) return nan;
  double low = best - step, high = best + step;
  double x = high - golden * (high - low), z = low + golden * (high - low);
  double at_x = misfit(x), at_z = misfit(z);
  for (int i = 0; i < 40; ++i) {
    if (at_x < at_z) {
      high = z, z = x, at_z = at_x;
      at_x = misfit(x = high - golden * (high - low));
    } else {
      low = x, x = z, at_x = at_z;
      at_z = misfit(z = low + golden * (high - low));
    }
  }
  return (low + high) / 2;
}

}  // namespace

DisplacementSums::DisplacementSums(std::vector<double> times)
    : times_(std::move(times)), sums_(groups * times_.size()) {}

void DisplacementSums::add(std::uint64_t trajectory, std::size_t k,
                           const DisplacementSample& sample) {
  Sum& sum = sums_[static_cast<std::size_t>(trajectory % groups) * times_.size() + k];
  ++sum.count;
  sum.square.add(sample.square);
  sum.fourth.add(sample.square * sample.square);
  sum.velocities.add(sample.velocities);
  sum.along.add(sample.along);
}

void DisplacementSums::merge(const DisplacementSums& other) {
  if (other.times_ != times_) throw InternalError("merged ensembles differ in their times");
  for (std::size_t group = 0; group < groups && !times_.empty(); ++group)
    for (std::size_t k = 0; k < times_.size(); ++k) merge(group, k, other.of(group, k));
}

void DisplacementSums::merge(std::size_t group, std::size_t k, const Sum& other) {
  if (other.count > 0) sums_[group * times_.size() + k] += other;
}

void DisplacementSums::Sum::operator+=(const Sum& other) {
  count += other.count;
  square.merge(other.square);
  fourth.merge(other.fourth);
  velocities.merge(other.velocities);
  along.merge(other.along);
}

// Sums as doubles.
struct DisplacementMoments::Rounded {
  Rounded() = default;
  explicit Rounded(const DisplacementSums::Sum& sum)
      : count(sum.count),
        square(sum.square.value()),
        fourth(sum.fourth.value()),
        velocities(sum.velocities.value()),
        along(sum.along.value()) {}
  std::uint64_t count = 0;
  double square = 0, fourth = 0, velocities = 0, along = 0;
};

// The means of all but `out` at a further time.
void DisplacementMoments::Means::add(const Rounded& all, const Rounded& out) {
  const auto rest = static_cast<double>(all.count - out.count);
  square.push_back((all.square - out.square) / rest);
  fourth.push_back((all.fourth - out.fourth) / rest);
  velocities.push_back((all.velocities - out.velocities) / rest);
  along.push_back((all.along - out.along) / rest);
}

DisplacementMoments::DisplacementMoments(const DisplacementSums& sums, std::size_t particles)
    : times_(sums.times()), particles_(particles) {
  const std::size_t n = times_.size();
  std::vector<Rounded> all(n);
  for (std::size_t k = 0; k < n; ++k) {
    DisplacementSums::Sum sum;
    for (std::size_t g = 0; g < DisplacementSums::groups; ++g) sum += sums.of(g, k);
    counts_.push_back(sum.count);
    all[k] = Rounded(sum);
    whole_.add(all[k], Rounded());
  }
  for (std::size_t g = 0; g < DisplacementSums::groups; ++g) {
    if (n == 0 || sums.of(g, 0).count == 0) continue;
    Means means;
    for (std::size_t k = 0; k < n; ++k) means.add(all[k], Rounded(sums.of(g, k)));
    without_.push_back(std::move(means));
  }
}

// Delete-one jackknife over groups of (nearly) equal size.
double DisplacementMoments::error_of(auto statistic, double whole) const {
  if (without_.size() < 2) return nan;
  double sum = 0;
  for (const Means& means : without_) {
    const double off = statistic(means) - whole;
    sum += off * off;
  }
  const auto n = static_cast<double>(without_.size());
  return std::sqrt(sum * (n - 1) / n);
}

std::vector<MomentPoint> DisplacementMoments::points() const {
  std::vector<MomentPoint> points;
  for (std::size_t k = 0; k < times_.size(); ++k) {
    MomentPoint point;
    point.t = times_[k];
    point.count = counts_[k];
    // The exact variance of the squares is at hand; that of the fourth powers is not. It makes an
    // error where all that was summed is independent, which particles of one trajectory are not.
    const auto count = static_cast<double>(counts_[k]);
    const double square = whole_.square[k], fourth = whole_.fourth[k];
    const double variance = std::max(0.0, fourth - square * square);
    point.square.value = square;
    point.square.error = particles_ > 1
                             ? error_of([k](const Means& m) { return m.square[k]; }, square)
                         : counts_[k] > 1 ? std::sqrt(variance / (count - 1))
                                          : nan;
    const auto estimate = [&](auto statistic) {
      const double value = statistic(whole_);
      return Estimate{value, error_of(statistic, value)};
    };
    point.fourth = estimate([k](const Means& m) { return m.fourth[k]; });
    point.correlation = estimate([k](const Means& m) { return m.velocities[k]; });
    point.green_kubo = estimate([k](const Means& m) { return m.along[k] / 2; });
    point.middle = nan;
    point.exponent = {nan, nan};
    if (k > 0 && times_[k - 1] > 0) {
      const double step = elementary::log(times_[k] / times_[k - 1]);
      const auto exponent = [k, step](const Means& m) {
        return elementary::log(m.square[k] / m.square[k - 1]) / step;
      };
      point.middle = std::sqrt(times_[k - 1]) * std::sqrt(times_[k]);
      point.exponent.value = exponent(whole_);
      point.exponent.error = error_of(exponent, point.exponent.value);
    }
    points.push_back(point);
  }
  return points;
}

TimeWindow DisplacementMoments::default_window() const {
  const double last = times_.empty() ? 0.0 : times_.back();
  TimeWindow window{last, last};
  std::size_t inside = 0;
  for (std::size_t k = times_.size(); k-- > 0;) {
    // A tenth, with room for the rounding of a grid of times.
    const bool wanted = times_[k] >= 0.0999999 * last || inside < 3;
    if (!wanted || !(times_[k] > 0)) break;
    window.from = times_[k];
    ++inside;
  }
  return window;
}

std::optional<DiffusionFit> DisplacementMoments::fit(const TimeWindow& window) const {
  std::vector<std::size_t> inside;
  std::vector<double> t, log_t, weight, log_weight;
  for (std::size_t k = 0; k < times_.size(); ++k) {
    if (!window.holds(times_[k]) || counts_[k] == 0) continue;
    const double square = whole_.square[k], variance = whole_.fourth[k] - square * square;
    if (!(square > 0)) return std::nullopt;
    inside.push_back(k);
    t.push_back(times_[k]);
    log_t.push_back(elementary::log(times_[k]));
    // A single trajectory has no variance: weights as for a Gaussian displacement.
    const double spread = variance > 0 ? variance : square * square;
    weight.push_back(1 / spread);
    log_weight.push_back(square * square / spread);
  }
  if (inside.size() < 2) return std::nullopt;
  const auto line = [&](const Means& m) {
    std::vector<double> y;
    for (const std::size_t k : inside) y.push_back(m.square[k]);
    return line_through(t, y, weight);
  };
  const auto local_exponent = [&](const Means& m) {
    std::vector<double> y;
    for (const std::size_t k : inside) y.push_back(elementary::log(m.square[k]));
    return line_through(log_t, y, log_weight).slope;
  };
  const auto exponent = [&](const Means& m) {
    std::vector<double> y;
    for (const std::size_t k : inside) y.push_back(m.square[k]);
    return exponent_beyond_offset(log_t, y, weight);
  };
  DiffusionFit fit;
  fit.window = {t.front(), t.back()};
  fit.points = inside.size();
  const Line whole = line(whole_);
  const auto coefficient = [&](const Means& m) { return line(m).slope / 4; };
  fit.D = {whole.slope / 4, error_of(coefficient, whole.slope / 4)};
  fit.offset = {whole.offset,
                error_of([&](const Means& m) { return line(m).offset; }, whole.offset)};
  fit.local_exponent.value = local_exponent(whole_);
  fit.local_exponent.error = error_of(local_exponent, fit.local_exponent.value);
  fit.exponent = {nan, nan};
  if (inside.size() < 4) return fit;
  fit.exponent.value = exponent(whole_);
  fit.exponent.error = error_of(exponent, fit.exponent.value);
  return fit;
}

}  // namespace carom
