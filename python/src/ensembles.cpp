// Ensembles of every kind.
#include <pybind11/stl.h>

#include <functional>
#include <mutex>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "carom/analyses/kinds.hpp"
#include "carom/files/ensembles.hpp"
#include "cli/commands/run_ensemble.hpp"
#include "cli/common.hpp"
#include "cli/reports/ensemble_outcome.hpp"
#include "loaded.hpp"
#include "own_step.hpp"
#include "run_in_background.hpp"

namespace py = pybind11;

namespace carom::python {

namespace {

// A particle of a trajectory, with its fate as a number: their names are `fates`.
struct ParticleRow {
  std::uint64_t index;
  double x, y, vx, vy;
  std::int8_t fate;
  std::int32_t hole;
  double time;
  std::uint64_t hits;
  std::int32_t wall;
  double s, v_parallel;
};
// With its exponent.
struct ExponentRow {
  std::uint64_t index;
  double x, y, vx, vy;
  std::int8_t fate;
  std::int32_t hole;
  double time;
  std::uint64_t hits;
  std::int32_t wall;
  double s, v_parallel, lambda, sali;
  std::int8_t regularity;
};
using cli::EnsembleOutcome;
using cli::OutcomeOf;

// Keeps the records of blocks as they come, if they are wanted, and the result so far.
template <class Result>
class Kept : public EnsembleJournal<Result> {
 public:
  explicit Kept(bool records) : records_(records) {}
  bool wants_records() const override { return records_; }
  void block(TrajectoryRange, std::vector<TrajectoryRecord>&& records) override {
    all.insert(all.end(), records.begin(), records.end());
  }
  void save(const Result& so_far) override {
    const std::lock_guard lock(mutex_);
    so_far_ = so_far;
  }
  /// The result so far, once.
  std::optional<Result> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(so_far_, std::nullopt);
  }

  std::vector<TrajectoryRecord> all;

 private:
  const bool records_;
  std::mutex mutex_;
  std::optional<Result> so_far_;
};

// The outcome, and what ended it early or None.
template <class Result>
py::tuple fly(const LoadedPointer& loaded, const py::object& progress) {
  const auto outcome = std::make_shared<OutcomeOf<Result>>(loaded);
  EnsembleOptions<Result> how;
  how.threads = cli::threads_of(loaded->options);
  how.lanes = cli::instruction_set_of(loaded->options);
  const bool records = loaded->options.per_trajectory;
  const bool grows = !progress.is_none() && py::hasattr(progress, "so_far");
  Kept<Result> kept(records);
  if (records || grows) how.journal = &kept;
  how.save_every = 1.0;
  Course course;
  how.interrupted = &course.stop;
  // A tenth of the time of short trajectories goes into telling of each.
  if (!progress.is_none())
    how.progress = [&](std::uint64_t trajectories, std::uint64_t) {
      course.done = trajectories;
      course.share = static_cast<double>(trajectories) /
                     static_cast<double>(loaded->system().run.trajectories);
    };
  py::object told = progress;
  if (grows)
    told = py::cpp_function([&](double share, std::uint64_t done) {
      progress(share, done);
      std::optional<Result> so_far = kept.take();
      if (!so_far || so_far->done.size() == 0) return;
      const auto part = std::make_shared<OutcomeOf<Result>>(outcome->loaded);
      part->result = std::move(*so_far);
      part->status = cli::status_of(false);
      progress.attr("so_far")(part);
    });
  const std::exception_ptr interruption =
      fly_with_own_step(*outcome, course, told, [&]() -> std::optional<EnergyError> {
        kept.all.clear();
        outcome->result = flown(outcome->system(), how);
        if (!outcome->result.complete) return std::nullopt;
        return outcome->result.energy_error;
      });
  outcome->status = cli::status_of(outcome->result.complete);
  std::sort(kept.all.begin(), kept.all.end(),
            [](const auto& a, const auto& b) { return a.index < b.index; });
  if (records) outcome->records = std::move(kept.all);
  return py::make_tuple(outcome, error_of(interruption));
}

void set(ParticleRow& row, const TrajectoryRecord& r) {
  row = {r.index, r.x,    r.y,    r.vx,   r.vy, static_cast<std::int8_t>(r.fate),
         r.hole,  r.time, r.hits, r.wall, r.s,  r.v_parallel};
}
void set(ExponentRow& row, const TrajectoryRecord& r) {
  row = {r.index,  r.x,    r.y,
         r.vx,     r.vy,   static_cast<std::int8_t>(r.fate),
         r.hole,   r.time, r.hits,
         r.wall,   r.s,    r.v_parallel,
         r.lambda, r.sali, static_cast<std::int8_t>(r.regularity)};
}

template <class Row>
py::object rows_of(const EnsembleOutcome& self) {
  if (!self.rows) {
    auto made = std::make_shared<std::vector<Row>>(self.records->size());
    for (std::size_t i = 0; i < made->size(); ++i) set((*made)[i], (*self.records)[i]);
    self.rows = std::move(made);
  }
  return array_of<Row>(std::static_pointer_cast<const std::vector<Row>>(self.rows));
}

py::object trajectories(const EnsembleOutcome& self) {
  if (!self.records) return py::none();
  const bool exponents = dynamic_cast<const OutcomeOf<LyapunovResult>*>(&self) != nullptr;
  return exponents ? rows_of<ExponentRow>(self) : rows_of<ParticleRow>(self);
}

// Throws InputError where nothing could be measured.
void check(const EnsembleOutcome& self) {
  if (const auto* lyapunov = dynamic_cast<const OutcomeOf<LyapunovResult>*>(&self))
    cli::refuse_nothing(self.loaded->options, self.system(), lyapunov->result);
}

}  // namespace

void add_ensembles(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(ParticleRow, index, x, y, vx, vy, fate, hole, time, hits, wall, s,
                       v_parallel);
  PYBIND11_NUMPY_DTYPE(ExponentRow, index, x, y, vx, vy, fate, hole, time, hits, wall, s,
                       v_parallel, lambda, sali, regularity);
  py::list fates;
  for (int i = 0; i <= static_cast<int>(last_fate); ++i)
    fates.append(name_of(static_cast<Fate>(i)));
  module.attr("fates") = fates;
  py::class_<EnsembleOutcome, Outcome, std::shared_ptr<EnsembleOutcome>>(module, "EnsembleOutcome")
      .def("trajectories", &trajectories)
      .def("check", &check);
#define CAROM_CLASS(Result)                                                                  \
  py::class_<OutcomeOf<Result>, EnsembleOutcome, std::shared_ptr<OutcomeOf<Result>>>(module, \
                                                                                     #Result);
  CAROM_FOR_ENSEMBLES(CAROM_CLASS)
#undef CAROM_CLASS
  module.def(
      "ensemble",
      [](const LoadedPointer& loaded, const py::object& progress) {
        py::tuple flown;
        for_kind(loaded->options.command, [&]<class Result>(std::type_identity<Result>) {
          flown = fly<Result>(loaded, progress);
        });
        return flown;
      },
      py::arg("system"), py::arg("progress"));
}

}  // namespace carom::python
