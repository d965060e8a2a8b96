// Blocks of hits and of trajectories for analyses that are written in Python: the engines fly, the
// rows are arrays.
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "carom/analyses/run/rows.hpp"
#include "carom/engines/engine.hpp"
#include "carom/engines/trajectories.hpp"
#include "carom/geometry/arc_lengths.hpp"
#include "carom/starts/injection.hpp"
#include "carom/starts/sampler.hpp"
#include "cli/common.hpp"
#include "engines/ordered_output.hpp"
#include "engines/parallel_blocks.hpp"
#include "engines/record_of.hpp"
#include "loaded.hpp"
#include "stream.hpp"

namespace py = pybind11;

namespace carom::python {

namespace {

using geometry::Vector;

// The columns of carom.Run.hits after the trajectory.
struct TrajectoryHit {
  std::uint64_t trajectory;
  std::int32_t particle, wall;
  double s, v_parallel, t, x, y, vx, vy;
  std::int64_t cell_first, cell_second;
  std::int32_t reflections;
};

// The columns of carom.Escape.per_trajectory, and the end.
struct TrajectoryRow {
  std::uint64_t index;
  double x, y, vx, vy;
  std::int8_t fate;
  std::int32_t hole;
  double time;
  std::uint64_t hits;
  std::int32_t wall;
  double s, v_parallel, end_x, end_y, end_vx, end_vy;
  std::int32_t end_wall;
};

Vector in_plane(const System& system, const State& state) {
  const Table& table = *system.table;
  return table.lattice ? state.position + table.lattice->translation(state.cell) : state.position;
}

// The rows of some trajectories, and their order: one trajectory after the other.
template <class Row>
struct Block {
  std::vector<Row> rows;
  std::vector<std::uint32_t> order;
};

// Collects rows of trajectories that are under way at once.
template <class Row>
class Collected {
 public:
  explicit Collected(TrajectoryRange range) : range_(range) {}

  void add(std::uint64_t trajectory, const Row& row) {
    rows.push_back(row);
    numbers_.push_back(static_cast<std::uint32_t>(trajectory - range_.first));
  }
  // What there is; those of another range come next.
  Block<Row> take(TrajectoryRange next) {
    std::vector<std::uint32_t> places(range_.last - range_.first + 1, 0);
    for (const std::uint32_t number : numbers_) ++places[number + 1];
    std::partial_sum(places.begin(), places.end(), places.begin());
    Block<Row> block{{}, std::vector<std::uint32_t>(rows.size())};
    for (std::uint32_t i = 0; i < numbers_.size(); ++i) block.order[places[numbers_[i]]++] = i;
    block.rows.reserve(rows.size() + rows.size() / 4);
    std::swap(block.rows, rows);
    numbers_.clear();
    range_ = next;
    return block;
  }

  std::vector<Row> rows;

 private:
  TrajectoryRange range_;
  std::vector<std::uint32_t> numbers_;  ///< of the trajectory of each row, from the first one on
};

// Hits, of each trajectory in order of time.
class Hits : public Listener {
 public:
  using Row = TrajectoryHit;

  Hits(const System& system, TrajectoryRange range)
      : system_(system), frames_(frames_of(*system.table)), collected_(range) {}

  static EngineOptions asked_for(const System& system) {
    return {.t_end = system.run.t_max, .hits = true};
  }
  // About so many a trajectory; infinity where that is not known.
  static double rows_each(const System& system) {
    double hits = system.run.collisions > 0 ? static_cast<double>(system.run.collisions)
                                            : std::numeric_limits<double>::infinity();
    const double mean_flight = measure(*system.table).mean_flight;
    if (std::isfinite(mean_flight) && mean_flight > 0.0 && !system.particles.empty())
      hits = std::min(hits, system.run.t_max * system.particles.front().speed / mean_flight);
    return hits * static_cast<double>(system.particles.size());
  }

  // Rows go to the stream as they come: of one trajectory.
  void pass_on(Stream<Row>& stream) { stream_ = &stream; }
  Block<Row> take(TrajectoryRange next) {
    set_lengths();
    return collected_.take(next);
  }

  void begin(const Trajectory& t) override {
    if (hits_.size() <= t.slot) hits_.resize(t.slot + 1);
    hits_[t.slot].assign(t.starts.size(), 0);
  }
  void hit(const Trajectory& t, int particle, const State& state, std::uint64_t hits) override {
    const Vector x = in_plane(system_, state), v = state.velocity;
    const geometry::CurveFrame& frame = frames_[static_cast<std::size_t>(state.wall)];
    std::uint64_t& before = hits_[t.slot][static_cast<std::size_t>(particle)];
    collected_.add(t.number, {t.number, particle, state.wall, state.u,
                              dot(v, geometry::tangent_at(frame, state.u)), state.time.value(), x.x,
                              x.y, v.x, v.y, state.cell.first, state.cell.second,
                              static_cast<std::int32_t>(hits - before)});
    before = hits;
    if (stream_ != nullptr && collected_.rows.size() == some) flush(t);
  }
  bool stop(const Trajectory&) override { return stop_; }
  void end(const Trajectory& t, const TrajectoryEnd&) override {
    if (stream_ != nullptr) flush(t);
  }

 private:
  static constexpr std::size_t some = 512;

  void flush(const Trajectory& t) {
    const Block<Row> block = take({t.number, t.number + 1});
    stop_ = !stream_->push(block.rows.size(), [&](std::size_t i) { return block.rows[i]; });
  }
  // Rows have the parameter of the place until their lengths are computed together.
  void set_lengths() {
    std::vector<std::int32_t> walls(some);
    std::vector<double> places(some);
    std::vector<Row>& rows = collected_.rows;
    for (std::size_t from = 0; from < rows.size(); from += some) {
      const std::size_t many = std::min(some, rows.size() - from);
      for (std::size_t i = 0; i < many; ++i) {
        walls[i] = rows[from + i].wall;
        places[i] = rows[from + i].s;
      }
      const std::vector<double> lengths = geometry::arc_lengths_at(
          frames_, std::span(walls).first(many), std::span(places).first(many));
      for (std::size_t i = 0; i < many; ++i) rows[from + i].s = lengths[i];
    }
  }

  const System& system_;
  const std::vector<geometry::CurveFrame> frames_;
  Collected<Row> collected_;
  std::vector<std::vector<std::uint64_t>> hits_;  ///< of each particle, by slot
  Stream<Row>* stream_ = nullptr;
  bool stop_ = false;
};

// Starts and ends.
class Ends : public Listener {
 public:
  using Row = TrajectoryRow;

  Ends(const System& system, TrajectoryRange range)
      : system_(system), record_of_(system), collected_(range) {}

  static EngineOptions asked_for(const System& system) {
    return {.t_end = system.run.t_max, .times = {system.run.t_max}};
  }
  static double rows_each(const System& system) {
    return static_cast<double>(system.particles.size());
  }
  Block<Row> take(TrajectoryRange next) { return collected_.take(next); }

  void begin(const Trajectory& t) override {
    if (last_.size() <= t.slot) last_.resize(t.slot + 1);
    last_[t.slot].assign(t.starts.size(), std::nullopt);
  }
  void sample(const Trajectory& t, int particle, std::size_t, const State& state) override {
    last_[t.slot][static_cast<std::size_t>(particle)] = state;
  }
  void end(const Trajectory& t, const TrajectoryEnd& end) override {
    for (std::size_t p = 0; p < end.particles.size(); ++p) {
      const ParticleEnd& particle = end.particles[p];
      const TrajectoryRecord r =
          record_of_(particle_index(system_, t.number, p), t.starts[p], particle);
      const State last = last_[t.slot][p].value_or(particle.state);
      const Vector x = in_plane(system_, last), v = last.velocity;
      collected_.add(t.number, {r.index, r.x, r.y, r.vx, r.vy, static_cast<std::int8_t>(r.fate),
                                r.hole, r.time, r.hits, r.wall, r.s, r.v_parallel, x.x, x.y, v.x,
                                v.y, particle.last_wall});
    }
  }

 private:
  const System& system_;
  const engines::RecordMaker record_of_;
  Collected<Row> collected_;
  std::vector<std::vector<std::optional<State>>> last_;  ///< at t_max, by slot
};

// One thread's: flies some trajectories after the others.
template <class Rows>
class Flyer {
 public:
  using Output = engines::OrderedOutput<Block<typename Rows::Row>>;

  Flyer(const System& system, const Sampler& sampler, const EngineOptions& how, Output& output)
      : sampler_(sampler),
        listener_(system, {}),
        engine_(make_engine(system, how)),
        writer_(output) {}
  Flyer(const Flyer&) = delete;
  Flyer& operator=(const Flyer&) = delete;

  bool run(std::uint64_t block, std::uint64_t first, std::uint64_t end,
           const std::function<bool()>& stopped) {
    const TrajectoryRange range{first, end};
    writer_.await_turn(block);
    listener_.take(range);
    DrawnStarts starts(sampler_, range);
    if (!engine_->run(starts, listener_, stopped)) return false;
    return writer_.deliver(block, {listener_.take(range)});
  }

 private:
  const Sampler& sampler_;
  Rows listener_;
  const std::unique_ptr<Engine> engine_;
  typename Output::Writer writer_;
};

// Flies some trajectories together, so many that they have about 2 MB of rows, which caches hold.
template <class Rows>
void fly(const System& system, int threads, std::optional<InstructionSet> lanes,
         Stream<typename Rows::Row>& stream) {
  constexpr double rows_together = 20'000, trajectories_together = 2048, worth_lanes = 32;
  check_start(system, &stream.stopped());
  const Sampler sampler(system, &stream.stopped());
  const World world = make_world(system);  // threads share its table
  EngineOptions how = Rows::asked_for(system);
  how.like = &world;
  const double together =
      std::clamp(rows_together / Rows::rows_each(system), 1.0, trajectories_together);
  how.lanes = together < worth_lanes ? std::nullopt : lanes;
  const engines::BlockPlan plan(system.run.trajectories, threads,
                                static_cast<std::uint64_t>(together));
  using Output = typename Flyer<Rows>::Output;
  const typename Output::Sink sink = [&](const typename Output::Block& blocks) {
    for (const Block<typename Rows::Row>& block : blocks)
      stream.push(block.order.size(), [&](std::size_t i) { return block.rows[block.order[i]]; });
  };
  Output output(sink, 4 * static_cast<std::uint64_t>(plan.threads));
  engines::run_blocks(
      plan, &stream.stopped(), [&] { return Flyer<Rows>(system, sampler, how, output); },
      [](auto&) {});
}

// One trajectory, whose hits are passed on as they come.
void fly_one(const System& system, std::uint64_t trajectory, Stream<TrajectoryHit>& stream) {
  check_start(system, &stream.stopped());
  const Sampler sampler(system, &stream.stopped());
  EngineOptions how = Hits::asked_for(system);
  how.lanes.reset();
  const TrajectoryRange range{trajectory, trajectory + 1};
  Hits hits(system, range);
  hits.pass_on(stream);
  DrawnStarts starts(sampler, range);
  make_engine(system, how)->run(starts, hits, [&] { return stream.stopped().load(); });
}

using HitStream = Stream<TrajectoryHit>;
using TrajectoryStream = Stream<TrajectoryRow>;

std::unique_ptr<HitStream> hits(const LoadedPointer& loaded, bool of_all, std::size_t block) {
  const cli::Options& options = loaded->options;
  if (!of_all) {
    const std::uint64_t trajectory =
        options.trajectory.empty() ? 0 : cli::whole_number(options.trajectory, "--trajectory", 0);
    return std::make_unique<HitStream>(block, [loaded, trajectory](HitStream& stream) {
      fly_one(loaded->system(), trajectory, stream);
    });
  }
  return std::make_unique<HitStream>(
      block, [loaded, threads = cli::threads_of(options), lanes = cli::instruction_set_of(options)](
                 HitStream& stream) { fly<Hits>(loaded->system(), threads, lanes, stream); });
}

std::unique_ptr<TrajectoryStream> trajectories(const LoadedPointer& loaded, std::size_t block) {
  const cli::Options& options = loaded->options;
  return std::make_unique<TrajectoryStream>(
      block,
      [loaded, threads = cli::threads_of(options), lanes = cli::instruction_set_of(options)](
          TrajectoryStream& stream) { fly<Ends>(loaded->system(), threads, lanes, stream); });
}

template <class Row>
void add_stream(py::module_& module, const char* name) {
  py::class_<Stream<Row>>(module, name)
      .def("next", &Stream<Row>::next)
      .def("close", &Stream<Row>::close);
}

}  // namespace

void add_streams(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(TrajectoryHit, trajectory, particle, wall, s, v_parallel, t, x, y, vx, vy,
                       cell_first, cell_second, reflections);
  PYBIND11_NUMPY_DTYPE(TrajectoryRow, index, x, y, vx, vy, fate, hole, time, hits, wall, s,
                       v_parallel, end_x, end_y, end_vx, end_vy, end_wall);
  add_stream<TrajectoryHit>(module, "HitStream");
  add_stream<TrajectoryRow>(module, "TrajectoryStream");
  module.def("hits", &hits, py::arg("system"), py::arg("of_all"), py::arg("block"));
  module.def("trajectories", &trajectories, py::arg("system"), py::arg("block"));
}

}  // namespace carom::python
