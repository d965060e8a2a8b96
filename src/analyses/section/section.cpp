#include "carom/analyses/section.hpp"

#include <algorithm>

#include "carom/base/digest.hpp"
#include "carom/base/error.hpp"
#include "carom/base/stopwatch.hpp"
#include "carom/engines/engine.hpp"
#include "carom/engines/trajectories.hpp"
#include "carom/results/ensemble_result.hpp"
#include "engines/ordered_output.hpp"
#include "engines/parallel_blocks.hpp"

namespace carom {

namespace {

// Orbits of random starts, unless a number is asked for: more are hard to tell apart in a picture.
constexpr std::uint64_t default_orbits = 50;

using Output = engines::OrderedOutput<SectionPoint>;

/// Adds counts and reports.
void add(SectionResult& sum, const SectionResult& r) {
  sum.orbits += r.orbits;
  sum.points += r.points;
  sum.collisions += r.collisions;
  sum.incomplete += r.incomplete;
  sum.add_fates(r);
  sum.digest += r.digest;
  sum.steps += r.steps;
  sum.energy_error += r.energy_error;
  for (const auto& [index, report] : r.reports) keep_first(sum.reports, index, report);
}

std::uint64_t hash_of(std::uint64_t so_far, const SectionPoint& p) {
  for (const double x : {p.t, p.s, p.v_parallel, p.x, p.y, p.vx, p.vy}) so_far = mix(so_far, x);
  return mix(so_far ^ static_cast<std::uint64_t>(std::int64_t{p.wall} * 4 + p.direction));
}

EngineOptions asked_for(const System& system, const SectionOptions& options, const World& world) {
  EngineOptions asked{
      .t_end = system.run.t_max, .energy = true, .lanes = options.lanes, .like = &world};
  if (system.section.boundary) {
    asked.hits = true;
  } else {
    // One direction takes at least every other crossing.
    const std::uint64_t points = system.section.points;
    asked.surface = &system.section.surface;
    if (points > 0 && points <= SIZE_MAX / 4)
      asked.most_crossings = static_cast<std::size_t>(2 * points + 2);
  }
  // All particles of an orbit stop when the last one has its points.
  if (system.particles.size() > 1) asked.lanes.reset();
  return asked;
}

/// One thread's: flies blocks of orbits, and keeps their points until all of a block are there.
class Follower : public Listener {
 public:
  Follower(const System& system, const Sampler& sampler, const SectionOptions& options,
           const World& world, Output& output, const std::function<void(std::uint64_t)>& done)
      : system_(system),
        sampler_(sampler),
        options_(options),
        frames_(frames_of(*system.table)),
        engine_(make_engine(system, asked_for(system, options, world))),
        writer_(output),
        done_(done) {}
  Follower(const Follower&) = delete;
  Follower& operator=(const Follower&) = delete;

  bool run(std::uint64_t block, std::uint64_t first, std::uint64_t end,
           const std::function<bool()>& stopped) {
    writer_.await_turn(block);
    first_ = first;
    points_.assign(writer_.is_wanted() ? end - first : 0, {});
    DrawnStarts starts(sampler_, TrajectoryRange{first, end});
    if (!engine_->run(starts, *this, stopped)) return false;
    std::vector<SectionPoint> all;
    for (const std::vector<SectionPoint>& points : points_)
      all.insert(all.end(), points.begin(), points.end());
    return writer_.deliver(block, std::move(all));
  }

  void begin(const Trajectory& t) override {
    if (recorders_.size() <= t.slot)
      recorders_.resize(t.slot + 1, {*system_.table, system_.section, frames_});
    recorders_[t.slot].begin(t.number, t.starts);
  }
  void hit(const Trajectory& t, int particle, const State& state, std::uint64_t) override {
    recorders_[t.slot].hit(particle, state);
  }
  void crossing(const Trajectory& t, int particle, const State& state, int direction) override {
    recorders_[t.slot].crossing(particle, state, direction);
  }
  void particle_end(const Trajectory& t, int particle, Fate fate) override {
    recorders_[t.slot].end(particle, fate);
  }
  bool stop(const Trajectory& t) override { return recorders_[t.slot].done(); }
  void end(const Trajectory& t, const TrajectoryEnd& end) override {
    const std::vector<SectionPoint>& points = recorders_[t.slot].points();
    count(t.number, points, end);
    if (writer_.is_wanted()) points_[t.number - first_] = points;
    if (options_.progress) done_(points.size());
  }

  DecisionCounts decisions() const { return engine_->decisions(); }

  SectionResult sum;  ///< counts and reports alone

 private:
  void count(std::uint64_t orbit, const std::vector<SectionPoint>& points,
             const TrajectoryEnd& end) {
    SectionResult& r = sum;
    ++r.orbits;
    r.steps += end.steps;
    r.points += points.size();
    const std::size_t particles = end.particles.size();
    std::vector<std::uint64_t> hashes, counts(particles, 0);
    for (std::size_t p = 0; p < particles; ++p) hashes.push_back(mix(orbit * particles + p));
    for (const SectionPoint& point : points) {
      const auto p = static_cast<std::size_t>(point.particle);
      hashes[p] = hash_of(hashes[p], point);
      ++counts[p];
    }
    for (std::size_t p = 0; p < particles; ++p) {
      const ParticleEnd& particle = end.particles[p];
      r.digest += hashes[p];
      r.incomplete += counts[p] < system_.section.points;
      r.collisions += particle.hits;
      r.count(particle.fate);
      if (is_failure(particle.fate))
        keep_first(r.reports, orbit * particles + p, particle.report);
      else
        r.energy_error += particle.energy.error_at_end(particle.energy.change, 0.0);
    }
  }

  const System& system_;
  const Sampler& sampler_;
  const SectionOptions& options_;
  const std::vector<geometry::CurveFrame> frames_;
  const std::unique_ptr<Engine> engine_;
  Output::Writer writer_;
  const std::function<void(std::uint64_t)>& done_;
  std::vector<SectionRecorder> recorders_;         ///< by slot
  std::uint64_t first_ = 0;                        ///< orbit of the block, …
  std::vector<std::vector<SectionPoint>> points_;  ///< … and the points of each from it on
};

}  // namespace

std::uint64_t section_orbits(const System& system) {
  if (system.section.orbits > 0) return system.section.orbits;
  const std::uint64_t listed = listed_trajectories(system);
  return listed > 0 ? listed : std::min(system.run.trajectories, default_orbits);
}

SectionResult run_section(const System& system, const SectionOptions& options) {
  const Stopwatch watch;
  refuse_injections(system, "sections");
  if (system.section.boundary && system.table->walls.empty())
    throw InputError(Place{{}, 0, 0, "section.on"}, "the table has no walls for this section",
                     "line:x0,y0:x1,y1, segment:x0,y0:x1,y1, circle:x,y,r, x=c, y=c, vx=c or vy=c");
  check_start(system, options.interrupted);
  const Sampler sampler(system, options.interrupted);
  const World world = make_world(system, options.decisions);  // threads share its table
  // Blocks wait for their turn in memory.
  const std::uint64_t each = system.section.points;
  const engines::BlockPlan plan(section_orbits(system), options.threads,
                                each == 0 ? 1 : 50000 / each + 1);
  Output output(options.points, 4 * static_cast<std::uint64_t>(plan.threads));
  std::atomic<std::uint64_t> orbits{0}, points{0};
  std::mutex progress_mutex;
  const std::function<void(std::uint64_t)> report = [&](std::uint64_t new_points) {
    const std::uint64_t all = orbits.fetch_add(1, std::memory_order_relaxed) + 1;
    const std::uint64_t all_points =
        points.fetch_add(new_points, std::memory_order_relaxed) + new_points;
    const std::unique_lock lock(progress_mutex, std::try_to_lock);
    if (lock) options.progress(all, all_points);
  };
  SectionResult result;
  result.complete = engines::run_blocks(
      plan, options.interrupted,
      [&] { return Follower(system, sampler, options, world, output, report); },
      [&](Follower& follower) {
        add(result, follower.sum);
        result.decisions += follower.decisions();
      });
  output.finish();
  result.seconds = watch.seconds();
  result.cpu_seconds = watch.cpu_seconds();
  result.threads = plan.threads;
  return result;
}

}  // namespace carom
