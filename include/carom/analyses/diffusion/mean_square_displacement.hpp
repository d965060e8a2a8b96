// Mean square displacement and its growth, velocity autocorrelation, diffusion coefficient.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "carom/base/exact_sum.hpp"
#include "carom/base/fields.hpp"
#include "carom/results/estimate.hpp"

namespace carom {

/// What a particle says at a report time.
struct DisplacementSample {
  double square = 0.0;      ///< |r(t) - r(0)|^2
  double velocities = 0.0;  ///< v(t) . v(0)
  double along = 0.0;       ///< v(0) . (r(t) - r(0)), the integral of v(t) . v(0) from 0 to t
};

/// Sums of these, and of |r(t) - r(0)|^4, at given times. Sums are exact and kept apart by
/// group of trajectories (index modulo the number of groups), so that neither threads nor the order
/// of merging change a bit.
class DisplacementSums {
 public:
  /// Enough for an error of 6 % in every standard error.
  static constexpr std::size_t groups = 128;

  DisplacementSums() = default;
  /// `times` increase.
  explicit DisplacementSums(std::vector<double> times);

  /// A particle of a trajectory at t_k.
  void add(std::uint64_t trajectory, std::size_t k, const DisplacementSample&);
  void merge(const DisplacementSums& other);

  const std::vector<double>& times() const { return times_; }
  /// Particles of the group that were there at t_k, and their sums.
  struct Sum {
    std::uint64_t count = 0;
    ExactSum square, fourth, velocities, along;
    void operator+=(const Sum&);
  };
  const Sum& of(std::size_t group, std::size_t k) const { return sums_[group * times_.size() + k]; }
  /// Adds what was kept of one group at t_k.
  void merge(std::size_t group, std::size_t k, const Sum& other);

 private:
  std::vector<double> times_;
  std::vector<Sum> sums_;
};

/// Moments of the displacement at a time, over the particles that were there.
struct MomentPoint {
  double t = 0.0;
  std::uint64_t count = 0;
  Estimate square, fourth;
  Estimate correlation;  ///< C(t) = <v(t) . v(0)>
  /// Half of <v(0) . (r(t) - r(0))>, which is half the integral of C from 0 to t, without
  /// quadrature: tends to D.
  Estimate green_kubo;
  /// d ln MSD / d ln t from the report time before to this one, at their geometric mean; NaN for
  /// the first and for t = 0.
  double middle = 0.0;
  Estimate exponent;
};

template <>
struct Fields<MomentPoint> {
  using P = MomentPoint;
  static constexpr const char* error = "Its standard error";
  static constexpr std::tuple list{
      field("t", "time", "Time", &P::t),
      field("count", "1", "Particles still inside at t", &P::count),
      field_as<double>(
          "value", "length^2", "Mean square displacement",
          [](auto& p) -> auto& { return p.square.value; }),
      field_as<double>(
          "stderr", "length^2", error, [](auto& p) -> auto& { return p.square.error; }),
      field_as<double>(
          "fourth", "length^4", "Mean fourth power of the displacement",
          [](auto& p) -> auto& { return p.fourth.value; }),
      field_as<double>(
          "fourth_stderr", "length^4", error, [](auto& p) -> auto& { return p.fourth.error; }),
      field_as<double>(
          "correlation", "length^2/time^2", "Velocity autocorrelation <v(t).v(0)>",
          [](auto& p) -> auto& { return p.correlation.value; }),
      field_as<double>(
          "correlation_stderr", "length^2/time^2", error,
          [](auto& p) -> auto& { return p.correlation.error; }),
      field_as<double>(
          "green_kubo", "length^2/time",
          "Half the integral of the velocity autocorrelation from 0 to t",
          [](auto& p) -> auto& { return p.green_kubo.value; }),
      field_as<double>(
          "green_kubo_stderr", "length^2/time", error,
          [](auto& p) -> auto& { return p.green_kubo.error; }),
      field_as<double>(
          "exponent", "1", "d ln MSD / d ln t since the time before; NaN where there is none",
          [](auto& p) -> auto& { return p.exponent.value; }),
      field_as<double>(
          "exponent_stderr", "1", error, [](auto& p) -> auto& { return p.exponent.error; })};
};

/// What the moments say together. Fits are weighted by the inverse variance of each point; points
/// of one trajectory are correlated, so errors are not those of the fit but the jackknife's over
/// groups.
struct DiffusionFit {
  TimeWindow window;
  std::size_t points = 0;
  Estimate D;       ///< quarter of the slope of MSD = 4 D t + c
  Estimate offset;  ///< c
  /// a of MSD = A t^a + c: the constant that all diffusion starts with does not count. NaN with
  /// fewer than four points, and where the best a is not inside of what is searched, 0.05 to 4.
  Estimate exponent;
  Estimate local_exponent;  ///< slope of ln MSD against ln t; approaches `exponent` as -c/MSD
};

/// Moments of the displacement with their errors, and what follows from them: D and exponents.
class DisplacementMoments {
 public:
  /// `particles` of each trajectory. Where there are several they need not be independent: then all
  /// errors are the jackknife's over groups of trajectories.
  explicit DisplacementMoments(const DisplacementSums& sums, std::size_t particles = 1);

  std::vector<MomentPoint> points() const;
  /// From the first report time that is at least a tenth of the last one, to the last; from the
  /// first time > 0 where these are fewer than three.
  TimeWindow default_window() const;
  /// None with fewer than two times > 0 in the window, or without any displacement there.
  std::optional<DiffusionFit> fit(const TimeWindow&) const;

 private:
  struct Rounded;
  struct Means {
    std::vector<double> square, fourth, velocities, along;
    void add(const Rounded& all, const Rounded& out);
  };
  double error_of(auto, double whole) const;

  std::vector<double> times_;
  std::size_t particles_;
  std::vector<std::uint64_t> counts_;
  Means whole_;
  std::vector<Means> without_;  ///< one group left out; empty groups have no entry
};

}  // namespace carom
