// Ensembles of every kind.
#include <pybind11/stl.h>

#include <functional>
#include <type_traits>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "carom/analyses/kinds.hpp"
#include "carom/files/archive.hpp"
#include "carom/files/ensembles.hpp"
#include "cli/commands/run_ensemble.hpp"
#include "cli/common.hpp"
#include "cli/reports/ensemble_reports.hpp"
#include "loaded.hpp"
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
template <class Result>
constexpr bool has_exponents = std::is_same_v<typename Result::RecordFields, ExponentFields>;

// A result of any kind, as Python has it.
class EnsembleOutcome {
 public:
  virtual ~EnsembleOutcome() = default;
  virtual std::string json() const = 0;
  virtual std::string text() const = 0;
  virtual std::vector<std::string> doubts() const = 0;
  virtual py::object trajectories() const = 0;
  virtual void save(const std::string& file, bool force) const = 0;
  /// Throws InputError where nothing could be measured.
  virtual void check() const = 0;

  LoadedPointer system;
  std::string status;
};
using OutcomePointer = std::shared_ptr<EnsembleOutcome>;

template <class Result>
class OutcomeOf final : public EnsembleOutcome {
 public:
  std::string json() const override {
    return cli::result_json(system->system(), result, {status, "", {}}).text();
  }
  std::string text() const override {
    return cli::result_text(system->system(), result, {status, "", {}});
  }
  std::vector<std::string> doubts() const override {
    return cli::doubts_of(system->system(), result).lines;
  }
  py::object trajectories() const override {
    if (!rows_) return py::none();
    return array_of<Row>(rows_);
  }
  void save(const std::string& file, bool force) const override;
  void check() const override { cli::refuse_nothing(system->options, system->system(), result); }

  /// One row a particle, from records that are in order.
  void keep(std::vector<TrajectoryRecord>&& records) {
    auto made = std::make_shared<std::vector<Row>>();
    made->reserve(records.size());
    for (const TrajectoryRecord& r : records) {
      const auto fate = static_cast<std::int8_t>(r.fate);
      if constexpr (has_exponents<Result>)
        made->push_back({r.index, r.x, r.y, r.vx, r.vy, fate, r.hole, r.time, r.hits, r.wall, r.s,
                         r.v_parallel, r.lambda, r.sali, static_cast<std::int8_t>(r.regularity)});
      else
        made->push_back({r.index, r.x, r.y, r.vx, r.vy, fate, r.hole, r.time, r.hits, r.wall, r.s,
                         r.v_parallel});
    }
    records_ = std::move(records);
    rows_ = std::move(made);
  }

  Result result;

 private:
  using Row = std::conditional_t<has_exponents<Result>, ExponentRow, ParticleRow>;
  std::vector<TrajectoryRecord> records_;
  std::shared_ptr<const std::vector<Row>> rows_;  ///< null: not asked for
};

// Keeps the records of blocks as they come.
template <class Result>
class Records : public EnsembleJournal<Result> {
 public:
  bool wants_records() const override { return true; }
  void block(TrajectoryRange, std::vector<TrajectoryRecord>&& records) override {
    all.insert(all.end(), records.begin(), records.end());
  }
  void save(const Result&) override {}

  std::vector<TrajectoryRecord> all;
};

// The outcome, and what ended it early or None.
template <class Result>
std::pair<OutcomePointer, std::exception_ptr> fly(const std::shared_ptr<Loaded>& loaded,
                                                  const py::object& progress) {
  auto outcome = std::make_shared<OutcomeOf<Result>>();
  outcome->system = loaded;
  const System& system = loaded->system();
  EnsembleOptions<Result> how;
  how.threads = cli::threads_of(loaded->options);
  how.lanes = cli::instruction_set_of(loaded->options);
  Records<Result> records;
  if (loaded->options.per_trajectory) how.journal = &records;
  Course course;
  how.interrupted = &course.stop;
  // A tenth of the time of short trajectories goes into telling of each.
  if (!progress.is_none())
    how.progress = [&](std::uint64_t trajectories, std::uint64_t) {
      course.done = trajectories;
      course.share =
          static_cast<double>(trajectories) / static_cast<double>(system.run.trajectories);
    };
  const std::exception_ptr interruption =
      run_in_background(course, progress, [&] { outcome->result = flown(system, how); });
  outcome->status = cli::status_of(outcome->result.complete);
  std::sort(records.all.begin(), records.all.end(),
            [](const auto& a, const auto& b) { return a.index < b.index; });
  if (how.journal) outcome->keep(std::move(records.all));
  return {std::move(outcome), interruption};
}

template <class Result>
void OutcomeOf<Result>::save(const std::string& file, bool force) const {
  const auto& [loaded, options] = *system;
  typename EnsembleArchive<Result>::Plan plan;
  plan.force = force;
  plan.per_trajectory = rows_ != nullptr;
  Provenance origin = cli::provenance_of(options, loaded.system, result.threads);
  refuse_existing(file, force);
  EnsembleArchive<Result> archive(followed(file), loaded, origin, plan);
  if (rows_) archive.block({0, loaded.system.run.trajectories}, std::vector(records_));
  archive.mark();
  archive.finish(result, status);
}

template <class Result>
OutcomePointer open(const std::string& file) {
  Stored<Result> stored = read_ensemble<Result>(file);
  auto loaded = std::make_shared<Loaded>();
  loaded->loaded = system_of(stored);
  loaded->options.command = kind_of(stored.result);
  cli::choose_engine(stored.everywhere ? "steps" : "auto", loaded->loaded.system);
  check_stored(stored, loaded->system());
  auto outcome = std::make_shared<OutcomeOf<Result>>();
  outcome->system = loaded;
  outcome->status = stored.status;
  outcome->result = std::move(stored.result);
  if (stored.per_trajectory && stored.file == file) outcome->keep(read_trajectories(stored.file));
  return outcome;
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
  py::class_<EnsembleOutcome, OutcomePointer>(module, "EnsembleOutcome")
      .def_property_readonly(
          "system",
          [](const EnsembleOutcome& self) { return std::const_pointer_cast<Loaded>(self.system); })
      .def("json", &EnsembleOutcome::json)
      .def("text", &EnsembleOutcome::text)
      .def("doubts", &EnsembleOutcome::doubts)
      .def("trajectories", &EnsembleOutcome::trajectories)
      .def("check", &EnsembleOutcome::check)
      .def("save", &EnsembleOutcome::save, py::call_guard<py::gil_scoped_release>(),
           py::arg("file"), py::arg("force"));
  module.def(
      "ensemble",
      [](const std::shared_ptr<Loaded>& loaded, const py::object& progress) {
        std::pair<OutcomePointer, std::exception_ptr> flown;
        for_kind(loaded->options.command, [&]<class Result>(std::type_identity<Result>) {
          flown = fly<Result>(loaded, progress);
        });
        return py::make_tuple(std::move(flown.first), error_of(flown.second));
      },
      py::arg("system"), py::arg("progress"));
  module.def(
      "open_ensemble",
      [](const std::string& file) {
        OutcomePointer opened;
        for_kind(kind_of_archive(file),
                 [&]<class Result>(std::type_identity<Result>) { opened = open<Result>(file); });
        return opened;
      },
      py::call_guard<py::gil_scoped_release>(), py::arg("file"));
}

}  // namespace carom::python
