// Checks of the engine against identities and published values.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "carom/analyses/compare.hpp"
#include "carom/analyses/diffusion/mean_square_displacement.hpp"
#include "carom/system/system.hpp"

namespace carom::validation {

/// A check that has run: what came out, beside what should.
struct Check {
  std::string name;
  std::string source;  ///< where the expected value comes from
  double value = 0.0;
  double error = 0.0;  ///< own standard error (0: none)
  double expected = 0.0;
  double expected_error = 0.0;  ///< standard error of the expected value (0: exact)
  double distance =
      0.0;  ///< (value - expected) / both errors together, or their difference where these are 0
  bool passed = false;
  bool complete = true;  ///< false when interrupted: then it neither passed nor failed
  std::uint64_t seed = 1, hits = 0, unresolved = 0, lost = 0, singular = 0, digest = 0;
  double filter_share = 1.0;  ///< of decisions, by double precision with its bound
  std::string report;         ///< of the first trajectory that failed
  int threads = 1;
  double seconds = 0.0, cpu_seconds = 0.0;
};

/// How to run, without influence on the result.
struct CheckOptions {
  int threads = 0;  ///< 0: as many as OpenMP gives
  const std::atomic<bool>* interrupted = nullptr;
};

/// How far a value may be from what is expected: four standard errors of their difference, and
/// `below` and `above` on top where finite times or lengths leave a known bias.
struct Allowance {
  double below = 0.0, above = 0.0;
};

// Every check fails if a trajectory is lost or unresolved. Each sets all but name and source.

/// Mean time between hits from cosine starts on all walls (the invariant measure of the boundary
/// map), which is pi (A - A0) / L: `no_hit_area` A0 is the area of the centres of Larmor circles
/// that meet no wall (Santalo; Chernov 1997). The error is from the scatter over trajectories,
/// since orbits need not be ergodic. run.collisions and run.trajectories say how much is done.
Check check_mean_flight(const System&, double no_hit_area, const CheckOptions& = {});

/// A closed table loses nothing: `value` is the number of lost trajectories.
Check check_nothing_lost(const System&, const CheckOptions& = {});

/// Of the trajectories with run.collisions - 1 hits, the share that hits once more.
Check check_survival_per_hit(const System&, double expected, const CheckOptions& = {});

/// The escape rate g at which the sum of exp(g t) over those with n hits, t the time of the n-th,
/// is the same for n = run.collisions - 1 and n = run.collisions: without the staircase that the
/// number of survivors is over time.
Check check_escape_rate(const System&, double expected, const CheckOptions& = {});

/// Share of trajectories that survive until t_max or their cap on hits, times `factor`. Its error
/// is that of the starts: independent, or quasi-random.
Check check_survivors(const System&, double factor, Estimate expected, Allowance,
                      const CheckOptions& = {});

/// Mean time from a start on a hole to the escape through it, of a chaotic table with that hole
/// alone. Starts enter by the cosine law, the invariant measure on the hole, so these are times of
/// recurrence to it, and their mean is pi A / (w v) for a hole of width w (Kac 1947).
Check check_recurrence(const System&, double expected, const CheckOptions& = {});

/// Mean square displacement at the last report time.
Check check_displacement(const System&, Estimate expected, const CheckOptions& = {});

/// Mean length of flights from one hit to the next, of all that is flown from uniform starts.
Check check_free_path(const System&, double expected, const CheckOptions& = {});

/// D of Green and Kubo at the last report time.
Check check_green_kubo(const System&, Estimate expected, const CheckOptions& = {});

/// What carom lyapunov tells of a system.
enum class Exponent {
  per_time,
  per_hit,
  regular_share,  ///< 1 - the chaotic share
  entropy         ///< of Kolmogorov and Sinai, by the whole spectrum
};
Check check_exponent(const System&, Exponent, Estimate expected, const CheckOptions& = {});

/// Distance from the origin of the plane at t_max, of trajectory 0. It passes within `allowance`:
/// rounding grows with every hit, so one orbit in double precision has no standard error.
Check check_distance(const System&, double expected, Allowance);

/// The measured orders of schemes with fixed steps on trajectory 0, beside the stated ones.
class Orders {
 public:
  /// Errors are compared until t_max; 0: the time that `carom compare` chooses.
  Orders(System system, std::vector<std::string> schemes, double t_max)
      : system_(std::move(system)), schemes_(std::move(schemes)), t_max_(t_max) {}
  Check check(const std::string& scheme);

 private:
  System system_;
  std::vector<std::string> schemes_;
  double t_max_;
  std::optional<Comparison> result_;
};

}  // namespace carom::validation
