#include "validation/cases/checks.hpp"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <functional>
#include <mutex>
#include <vector>

#include "carom/analyses/compare.hpp"
#include "carom/analyses/diffusion.hpp"
#include "carom/analyses/escape.hpp"
#include "carom/analyses/lyapunov.hpp"
#include "carom/analyses/run.hpp"
#include "carom/base/elementary.hpp"
#include "carom/base/error.hpp"
#include "carom/base/exact_sum.hpp"
#include "carom/base/stopwatch.hpp"
#include "carom/events/world.hpp"
#include "carom/starts/sampler.hpp"

namespace carom::validation {

namespace {

constexpr double most_errors = 4.0;

// An integrable orbit may have no scatter at all: then the numbers agree to rounding.
bool agrees(const Check& c, double error, Allowance allowance) {
  const double rounding = 1e-12 * std::fabs(c.expected);
  const double reach = most_errors * error + rounding;
  return c.value >= c.expected - reach - allowance.below &&
         c.value <= c.expected + reach + allowance.above;
}

void judge(Check& c, Allowance allowance) {
  const double error = std::sqrt(c.error * c.error + c.expected_error * c.expected_error);
  c.distance = error > 0.0 ? (c.value - c.expected) / error : c.value - c.expected;
  c.passed = c.complete && c.lost == 0 && c.unresolved == 0 && agrees(c, error, allowance);
}

// Runs the ensemble and fills in everything but the value.
EscapeResult run(const System& system, const CheckOptions& options, Check& c,
                 EscapeJournal* journal = nullptr) {
  EscapeOptions how;
  how.journal = journal;
  how.threads = options.threads;
  how.interrupted = options.interrupted;
  EscapeResult result = run_escape(system, how);
  c.complete = result.complete;
  c.seed = system.run.seed;
  c.hits = result.counts.collisions;
  c.unresolved = result.counts.unresolved;
  c.lost = result.counts.lost;
  c.seconds = result.seconds;
  c.cpu_seconds = result.cpu_seconds;
  c.singular = result.counts.singular;
  c.digest = result.digest;
  c.threads = result.threads;
  const double filter = static_cast<double>(result.decisions.filter);
  c.filter_share = filter / (filter + static_cast<double>(result.decisions.exact));
  if (!result.reports.empty()) c.report = result.reports.front().second;
  return result;
}

// Standard error of k / n, not 0 at the ends of [0, 1].
double binomial_error(double k, double n) {
  const double p = (k + 1.0) / (n + 2.0);
  return std::sqrt(p * (1.0 - p) / n);
}

// Follows the trajectories by themselves: what one of them is does not depend on the thread that
// runs it. A probe observes one trajectory after the other; at the end of its thread it hands in
// what it has kept.
template <class Probe>
class Follower {
 public:
  Follower(const System& system, const CheckOptions& options, Check& c)
      : system_(system), options_(options), sampler_(system, options.interrupted), case_(c) {
    c.seed = system.run.seed;
    c.threads = options.threads > 0 ? options.threads : std::max(1, omp_get_max_threads());
#pragma omp parallel num_threads(c.threads)
    work();
    if (error_) std::rethrow_exception(error_);
    c.complete = !interrupted();
    c.seconds = watch_.seconds();
    c.cpu_seconds = watch_.cpu_seconds();
    // In the order of the trajectories, so that threads change no bit of a sum.
    std::sort(kept_.begin(), kept_.end(),
              [](const auto& a, const auto& b) { return a.index < b.index; });
  }
  const std::vector<typename Probe::Kept>& kept() const { return kept_; }

 private:
  // No exception may leave it: it runs inside an OpenMP region.
  void work() noexcept {
    try {
      Probe probe(system_);
      World world(*system_.table, system_.dynamics);
      world.limit_hits(system_.run.collisions);
      std::uint64_t unresolved = 0, lost = 0, singular = 0;
      const auto stopped = [&] { return failed_ || interrupted(); };
      for (std::uint64_t i = next_++; i < system_.run.trajectories && !stopped(); i = next_++) {
        probe.begin(i);
        world.clear();
        add_start(world, sampler_, i, 0);
        world.run_until(system_.run.t_max, probe);
        probe.finish();
        unresolved += world.fate(0) == Fate::unresolved;
        lost += world.fate(0) == Fate::lost;
        singular += world.fate(0) == Fate::singular;
      }
      const std::lock_guard lock(mutex_);
      case_.hits += probe.hits;
      case_.unresolved += unresolved;
      case_.lost += lost;
      case_.singular += singular;
      kept_.insert(kept_.end(), probe.kept.begin(), probe.kept.end());
    } catch (const SamplingStopped&) {  // the case is over
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
      failed_ = true;
    }
  }
  bool interrupted() const { return options_.interrupted && *options_.interrupted; }

  const Stopwatch watch_;
  const System& system_;
  const CheckOptions& options_;
  const Sampler sampler_;
  Check& case_;
  std::vector<typename Probe::Kept> kept_;
  std::atomic<std::uint64_t> next_{0};
  std::atomic<bool> failed_{false};
  std::mutex mutex_;
  std::exception_ptr error_;
};

// The mean flight of each trajectory.
struct Flights : Observer {
  struct Kept {
    std::uint64_t index;
    double mean;
  };
  explicit Flights(const System&) {}
  void begin(std::uint64_t i) {
    index = i;
    sum = 0.0;
    own = 0;
  }
  void hit(const HitEvent& event) override {
    sum += event.flight_time;
    ++own;
    ++hits;
  }
  void finish() {
    if (own > 0) kept.push_back({index, sum / static_cast<double>(own)});
  }
  std::uint64_t index = 0, own = 0, hits = 0;
  double sum = 0.0;
  std::vector<Kept> kept;
};

// The times of the last two hits before the cap, of those that came so far.
struct LastHits : Observer {
  struct Kept {
    std::uint64_t index;
    double before, last;
    bool reached;  ///< the last one
  };
  explicit LastHits(const System& system) : cap(system.run.collisions) {}
  void begin(std::uint64_t i) {
    own = 0;
    one = {i, 0.0, 0.0, false};
  }
  void hit(const HitEvent& event) override {
    ++own;
    ++hits;
    if (own + 1 == cap) one.before = event.time.value();
    if (own == cap) one.last = event.time.value();
  }
  void finish() {
    one.reached = own == cap;
    if (own + 1 >= cap) kept.push_back(one);
  }
  std::uint64_t own = 0, hits = 0, cap;
  Kept one{};
  std::vector<Kept> kept;
};

}  // namespace

Check check_mean_flight(const System& system, double no_hit_area, const CheckOptions& options) {
  if (system.run.trajectories < 2 || system.run.collisions == 0)
    throw InternalError("a mean flight needs trajectories and a number of hits");
  const TableMeasure size = measure(*system.table);
  Check c;
  c.expected = size.mean_flight * (1.0 - no_hit_area / size.area);
  const Follower<Flights> flights(system, options, c);
  double sum = 0.0, squares = 0.0;
  for (const Flights::Kept& one : flights.kept()) {
    sum += one.mean - c.expected;
    squares += (one.mean - c.expected) * (one.mean - c.expected);
  }
  const double n = static_cast<double>(flights.kept().size());
  const double mean = sum / n;
  c.value = c.expected + mean;
  c.error = std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1.0));
  judge(c, {});
  return c;
}

Check check_nothing_lost(const System& system, const CheckOptions& options) {
  Check c;
  run(system, options, c);
  c.value = static_cast<double>(c.lost);
  judge(c, {});
  return c;
}

Check check_survival_per_hit(const System& system, double expected, const CheckOptions& options) {
  Check c;
  c.expected = expected;
  const Follower<LastHits> walkers(system, options, c);
  double reached = 0.0;
  for (const LastHits::Kept& one : walkers.kept()) reached += one.reached;
  const double n = static_cast<double>(walkers.kept().size());
  c.value = reached / n;
  c.error = binomial_error(reached, n);
  judge(c, {});
  return c;
}

Check check_escape_rate(const System& system, double expected, const CheckOptions& options) {
  Check c;
  c.expected = expected;
  const Follower<LastHits> walkers(system, options, c);
  double rate = 0.0, step = 1.0;
  for (int i = 0; i < 50 && std::fabs(step) > 1e-13; ++i) {
    // Newton's method for the logarithm of the ratio of the two sums.
    double before = 0.0, last = 0.0, before_time = 0.0, last_time = 0.0, squares = 0.0;
    for (const LastHits::Kept& one : walkers.kept()) {
      const double a = elementary::exp(rate * one.before);
      const double b = one.reached ? elementary::exp(rate * one.last) : 0.0;
      before += a;
      last += b;
      before_time += a * one.before;
      last_time += b * one.last;
      squares += (b - a) * (b - a);
    }
    const double slope = last_time / last - before_time / before;
    step = -elementary::log(last / before) / slope;
    rate += step;
    // At the root the terms b - a have the mean 0; their sum's error is that of the logarithm,
    // times `before`.
    c.error = std::sqrt(squares) / (before * slope);
  }
  c.value = rate;
  judge(c, {});
  return c;
}

Check check_survivors(const System& system, double factor, Estimate expected, Allowance allowance,
                      const CheckOptions& options) {
  Check c;
  c.expected = expected.value;
  c.expected_error = expected.error;
  const EscapeResult result = run(system, options, c);
  const double n = static_cast<double>(result.counts.followed());
  const double survived = static_cast<double>(result.counts.survived);
  c.value = factor * survived / n;
  c.error = factor * binomial_error(survived, n);
  if (system.quasi_random() && c.complete) {
    const SurvivalPoint last = survival(result.counts).back();
    c.error = factor * 0.5 * (last.high - last.low) / replicates_quantile;
  }
  judge(c, allowance);
  return c;
}

namespace {

// What an ensemble says of itself beside its estimate.
template <class Result>
void note_run(Check& c, const Result& result) {
  c.complete = result.complete;
  c.hits = result.collisions;
  c.unresolved = result.unresolved;
  c.lost = result.lost;
  c.singular = result.singular;
  c.digest = result.digest;
  c.threads = result.threads;
  c.seconds = result.seconds;
  c.cpu_seconds = result.cpu_seconds;
  if (!result.reports.empty()) c.report = result.reports.front().second;
}

// What `found` reads off a run of diffusion.
template <class Found>
Check check_diffusion(const System& system, Estimate expected, const CheckOptions& options,
                      Found found) {
  Check c;
  c.expected = expected.value;
  c.expected_error = expected.error;
  c.seed = system.run.seed;
  DiffusionOptions how;
  how.threads = options.threads;
  how.interrupted = options.interrupted;
  const DiffusionResult result = run_diffusion(system, how);
  note_run(c, result);
  if (c.complete) {
    const Estimate number = found(result);
    c.value = number.value;
    c.error = number.error;
  }
  judge(c, {});
  return c;
}

MomentPoint last_point(const DiffusionResult& result) {
  return DisplacementMoments(result.sums).points().back();
}

}  // namespace

Check check_recurrence(const System& system, double expected, const CheckOptions& options) {
  Check c;
  c.expected = expected;
  struct Times : EscapeJournal {
    bool wants_records() const override { return true; }
    void block(TrajectoryRange, std::vector<TrajectoryRecord>&& records) override {
      for (const TrajectoryRecord& one : records) {
        sum.add(one.time);
        squares.add(one.time * one.time);
      }
    }
    void save(const EscapeResult&) override {}
    ExactSum sum, squares;
  } times;
  run(system, options, c, &times);
  const double n = static_cast<double>(system.run.trajectories);
  c.value = times.sum.value() / n;
  c.error = std::sqrt((times.squares.value() / n - c.value * c.value) / n);
  judge(c, {});
  return c;
}

Check check_displacement(const System& system, Estimate expected, const CheckOptions& options) {
  return check_diffusion(system, expected, options,
                         [](const DiffusionResult& r) { return last_point(r).square; });
}

Check check_green_kubo(const System& system, Estimate expected, const CheckOptions& options) {
  return check_diffusion(system, expected, options,
                         [](const DiffusionResult& r) { return last_point(r).green_kubo; });
}

Check check_free_path(const System& system, double expected, const CheckOptions& options) {
  return check_diffusion(system, {expected, 0.0}, options,
                         [](const DiffusionResult& r) { return free_paths_of(r.free_paths).mean; });
}

Check check_exponent(const System& system, Exponent what, Estimate expected,
                     const CheckOptions& options) {
  Check c;
  c.expected = expected.value;
  c.expected_error = expected.error;
  c.seed = system.run.seed;
  LyapunovOptions how;
  how.threads = options.threads;
  how.interrupted = options.interrupted;
  const LyapunovResult result = run_lyapunov(system, how);
  note_run(c, result);
  if (c.complete) {
    const LyapunovEstimate e = estimate_of(system, result);
    const Estimate found = what == Exponent::per_time  ? e.per_time
                           : what == Exponent::per_hit ? e.per_hit
                                                       : e.chaotic_share;
    c.value = what == Exponent::regular_share ? 1.0 - found.value : found.value;
    c.error = found.error;
    if (what == Exponent::entropy) {
      const Estimate entropy = estimate_of(result.spectrum).entropy;
      c.value = entropy.value;
      c.error = entropy.error;
    }
    if (result.repeller) {
      c.value = result.repeller->estimate().value;
      c.error = result.repeller->estimate().error;
    }
  }
  judge(c, {});
  return c;
}

Check check_distance(const System& system, double expected, Allowance allowance) {
  Check c;
  c.expected = expected;
  c.seed = system.run.seed;
  Observer nothing;
  const SingleRunResult result = run_single(system, nothing);
  const RunEnd& end = result.particles.front();
  c.value = std::sqrt(end.x * end.x + end.y * end.y);
  c.hits = end.progress.hits;
  c.unresolved = end.progress.fate == Fate::unresolved;
  c.lost = end.progress.fate == Fate::lost;
  c.report = end.report;
  c.seconds = result.seconds;
  c.cpu_seconds = result.cpu_seconds;
  judge(c, allowance);
  return c;
}

Check Orders::check(const std::string& scheme) {
  // All at once: they share the orbit that they are compared with.
  if (!result_) result_ = compare(system_, {.schemes = schemes_, .t_max = t_max_});
  Check c;
  c.seed = system_.run.seed;
  const auto number = std::find(schemes_.begin(), schemes_.end(), scheme) - schemes_.begin();
  const ComparedScheme& one = result_->schemes[static_cast<std::size_t>(number)];
  c.expected = one.order;
  c.seconds = result_->seconds / static_cast<double>(schemes_.size());
  c.cpu_seconds = result_->cpu_seconds / static_cast<double>(schemes_.size());
  if (one.measured.slope) {
    c.value = one.measured.slope->value;
    c.error = one.measured.slope->error;
  } else {
    c.report = one.measured.reason;
  }
  judge(c, {});
  return c;
}

}  // namespace carom::validation
