#include "validation/rounding/paired_escape.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "carom/base/error.hpp"
#include "carom/base/stopwatch.hpp"
#include "carom/engines/engine.hpp"
#include "carom/engines/trajectories.hpp"
#include "carom/table/hole_names.hpp"
#include "carom/trust/trust.hpp"
#include "engines/parallel_blocks.hpp"

namespace carom {

using namespace engines;

namespace {

struct Pair {
  PairedEnd first, second;
  enum class State : unsigned char {
    open,
    known,
    singular,
    unresolved,
    lost,
    other_singular,
    unknown
  } state = State::open;
};

/// One thread's: flies the trajectories of a block, and each one in the other way as it ends.
class Worker : public Listener {
 public:
  Worker(const System& system, const Sampler& sampler, const World& world, OtherFlight other,
         std::vector<Pair>& pairs, const std::function<void(std::uint64_t)>& report)
      : sampler_(sampler),
        holes_(hole_numbers(*system.table)),
        engine_(make_engine(system, {.t_end = system.run.t_max, .like = &world})),
        other_(std::move(other)),
        pairs_(pairs),
        report_(report) {}
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  bool run(std::uint64_t, std::uint64_t first, std::uint64_t end,
           const std::function<bool()>& stopped) {
    stopped_ = &stopped;
    DrawnStarts starts(sampler_, TrajectoryRange{first, end});
    if (!engine_->run(starts, *this, stopped)) return false;
    for (std::uint64_t i = first; i < end; ++i)
      if (pairs_[i].state == Pair::State::open) return false;
    report_(end - first);
    return true;
  }

  // A pair that is stopped on the way stays open.
  void end(const Trajectory& t, const TrajectoryEnd& ends) override {
    const ParticleEnd& end = ends.particles.front();
    Pair& pair = pairs_[static_cast<std::size_t>(t.number)];
    if (end.fate == Fate::singular || is_failure(end.fate)) {
      pair.state = end.fate == Fate::singular     ? Pair::State::singular
                   : end.fate == Fate::unresolved ? Pair::State::unresolved
                                                  : Pair::State::lost;
      return;
    }
    if (end.fate == Fate::escaped || end.fate == Fate::unbounded) pair.first.time = end.time;
    pair.first.hole = number_of(end.hole);
    pair.first.hits = end.hits;
    const OtherEnd other = other_(t.starts.front());
    if (other.kind == OtherEnd::unknown && (*stopped_)()) return;
    pair.state = other.kind == OtherEnd::known      ? Pair::State::known
                 : other.kind == OtherEnd::singular ? Pair::State::other_singular
                                                    : Pair::State::unknown;
    if (other.kind != OtherEnd::known) return;
    pair.second = other.end;
    pair.second.hole = number_of(other.end.hole);
  }

 private:
  int number_of(int hole) const { return hole < 0 ? hole : holes_[static_cast<std::size_t>(hole)]; }

  const Sampler& sampler_;
  const std::vector<int> holes_;
  const std::unique_ptr<Engine> engine_;
  const OtherFlight other_;
  std::vector<Pair>& pairs_;
  const std::function<void(std::uint64_t)>& report_;
  const std::function<bool()>* stopped_ = nullptr;
};

}  // namespace

PairedEscapeResult compare_escapes(const System& system, const std::function<OtherFlight()>& make,
                                   const PairedEscapeOptions& options) {
  if (system.particles.size() != 1 || !system.injections.empty())
    throw InputError("pairs are of single particles");
  refuse_quasi_random(system, "a certified sample");
  const Stopwatch watch;
  const Sampler sampler(system, options.interrupted);
  const World world = make_world(system);  // threads share its table
  std::vector<Pair> pairs(static_cast<std::size_t>(options.sample));
  std::uint64_t done = 0;
  // Small blocks: a long orbit takes many times as long as a short one.
  const BlockPlan plan(options.sample, options.threads, 16);
  std::mutex mutex;
  const std::function<void(std::uint64_t)> report = [&](std::uint64_t more) {
    const std::lock_guard lock(mutex);
    done += more;
    if (options.progress) options.progress(done);
  };
  PairedEscapeResult result;
  result.threads = plan.threads;
  result.complete = run_blocks(
      plan, options.interrupted,
      [&] { return Worker(system, sampler, world, make(), pairs, report); }, [](const Worker&) {});

  // In the order of trajectories: the sum does not depend on the threads that flew them.
  PairedSurvival survival(system.run.times, options.tolerance * size_of(*system.table) /
                                                system.particles.front().speed);
  for (const Pair& pair : pairs) {
    if (pair.state == Pair::State::known) survival.add(pair.first, pair.second);
    if (pair.state == Pair::State::singular) ++result.singular;
    if (pair.state == Pair::State::unresolved) ++result.unresolved;
    if (pair.state == Pair::State::lost) ++result.lost;
    if (pair.state == Pair::State::other_singular) ++result.other_singular;
    if (pair.state == Pair::State::unknown) ++result.unknown;
  }
  result.pairs = survival.result(system.run.seed, options.swaps);
  result.seconds = watch.seconds();
  result.cpu_seconds = watch.cpu_seconds();
  return result;
}

}  // namespace carom
