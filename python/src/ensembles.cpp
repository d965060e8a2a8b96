// Escape, diffusion and Lyapunov exponents.
#include <pybind11/stl.h>

#include <functional>
#include <type_traits>
#include <utility>
#include <vector>

#include "analyses/diffusion/report.hpp"
#include "analyses/escape/report.hpp"
#include "analyses/lyapunov/report.hpp"
#include "arrays.hpp"
#include "beside.hpp"
#include "carom/analyses/kinds.hpp"
#include "carom/analyses/diffusion.hpp"
#include "carom/analyses/escape.hpp"
#include "carom/analyses/lyapunov.hpp"
#include "carom/files/archive.hpp"
#include "carom/files/ensembles.hpp"
#include "cli/common.hpp"
#include "cli/reports/doubts.hpp"
#include "loaded.hpp"

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
using RowOf = std::conditional_t<std::is_same_v<Result, LyapunovResult>, ExponentRow, ParticleRow>;

template <class Result>
struct EnsembleOutcome {
  LoadedPointer system;
  Result result;
  std::string status;
  std::shared_ptr<std::vector<TrajectoryRecord>> records;  ///< null: not asked for
  std::shared_ptr<const std::vector<RowOf<Result>>> rows;  ///< the same, as Python has them

  void make_rows() {
    if (!records) return;
    auto made = std::make_shared<std::vector<RowOf<Result>>>();
    made->reserve(records->size());
    for (const TrajectoryRecord& r : *records) {
      const auto fate = static_cast<std::int8_t>(r.fate);
      if constexpr (std::is_same_v<Result, LyapunovResult>)
        made->push_back({r.index, r.x, r.y, r.vx, r.vy, fate, r.hole, r.time, r.hits, r.wall, r.s,
                         r.v_parallel, r.lambda, r.sali, static_cast<std::int8_t>(r.regularity)});
      else
        made->push_back({r.index, r.x, r.y, r.vx, r.vy, fate, r.hole, r.time, r.hits, r.wall, r.s,
                         r.v_parallel});
    }
    rows = std::move(made);
  }
};

const char* status_of(bool complete) { return complete ? "completed" : "interrupted"; }

// Keeps the records of blocks as they come.
template <class Result>
class Records : public EnsembleJournal<Result> {
 public:
  explicit Records(std::vector<TrajectoryRecord>& all) : all_(all) {}
  bool wants_records() const override { return true; }
  void block(TrajectoryRange, std::vector<TrajectoryRecord>&& records) override {
    all_.insert(all_.end(), records.begin(), records.end());
  }
  void save(const Result&) override {}

 private:
  std::vector<TrajectoryRecord>& all_;
};

EscapeResult run(const System& system, const EnsembleOptions<EscapeResult>& how) {
  return run_escape(system, {how, {}});
}
DiffusionResult run(const System& system, const EnsembleOptions<DiffusionResult>& how) {
  return run_diffusion(system, how);
}
LyapunovResult run(const System& system, const EnsembleOptions<LyapunovResult>& how) {
  return run_lyapunov(system, how);
}

// The outcome, and what ended it early or None.
template <class Result>
py::tuple fly(const std::shared_ptr<Loaded>& loaded, const py::object& progress) {
  EnsembleOutcome<Result> outcome{loaded, {}, {}, nullptr, nullptr};
  const System& system = loaded->system();
  EnsembleOptions<Result> how;
  how.threads = cli::threads_of(loaded->options);
  how.lanes = cli::instruction_set_of(loaded->options);
  std::optional<Records<Result>> records;
  if (loaded->options.per_trajectory) {
    outcome.records = std::make_shared<std::vector<TrajectoryRecord>>();
    how.journal = &records.emplace(*outcome.records);
  }
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
      run_beside(course, progress, [&] { outcome.result = run(system, how); });
  outcome.status = status_of(outcome.result.complete);
  if (outcome.records)
    std::sort(outcome.records->begin(), outcome.records->end(),
              [](const auto& a, const auto& b) { return a.index < b.index; });
  outcome.make_rows();
  return py::make_tuple(std::move(outcome), error_of(interruption));
}

template <class Result>
void save(const EnsembleOutcome<Result>& self, const std::string& file, bool force) {
  const auto& [loaded, options] = *self.system;
  typename EnsembleArchive<Result>::Plan plan;
  plan.force = force;
  plan.per_trajectory = self.records != nullptr;
  Provenance origin = cli::provenance_of(options, loaded.system, self.result.threads);
  refuse_existing(file, force);
  EnsembleArchive<Result> archive(followed(file), loaded, origin, plan);
  if (self.records)
    archive.block({0, loaded.system.run.trajectories},
                  std::vector<TrajectoryRecord>(*self.records));
  archive.mark();
  archive.finish(self.result, self.status);
}

template <class Result>
EnsembleOutcome<Result> open(const std::string& file) {
  Stored<Result> stored = read_ensemble<Result>(file);
  auto loaded = std::make_shared<Loaded>();
  loaded->loaded = system_of(stored);
  loaded->options.command = kind_of(stored.result);
  cli::choose_engine(stored.everywhere ? "steps" : "auto", loaded->loaded.system);
  check_stored(stored, loaded->system());
  EnsembleOutcome<Result> outcome{loaded, std::move(stored.result), stored.status, nullptr,
                                  nullptr};
  if (stored.per_trajectory && stored.file == file) {
    outcome.records =
        std::make_shared<std::vector<TrajectoryRecord>>(read_trajectories(stored.file));
    outcome.make_rows();
  }
  return outcome;
}

template <class Result>
void add(py::module_& module, const char* name, const char* function) {
  using Outcome = EnsembleOutcome<Result>;
  py::class_<Outcome> outcome(module, name);
  outcome
      .def_property_readonly(
          "system",
          [](const Outcome& self) { return std::const_pointer_cast<Loaded>(self.system); })
      .def("json",
           [](const Outcome& self) {
             return cli::result_json(self.system->system(), self.result, {self.status, "", {}})
                 .text();
           })
      .def("text",
           [](const Outcome& self) {
             return cli::result_text(self.system->system(), self.result, {self.status, "", {}});
           })
      .def("doubts",
           [](const Outcome& self) {
             return cli::doubts_of(self.system->system(), self.result).lines;
           })
      .def("trajectories",
           [](const Outcome& self) -> py::object {
             if (!self.rows) return py::none();
             return array_of<RowOf<Result>>(self.rows);
           })
      .def("save", &save<Result>, py::call_guard<py::gil_scoped_release>(), py::arg("file"),
           py::arg("force"));
  if constexpr (std::is_same_v<Result, LyapunovResult>)
    outcome.def("check", [](const Outcome& self) {
      if (const auto error = why_nothing(self.system->system(), self.result)) throw *error;
    });
  module.def(function, &fly<Result>, py::arg("system"), py::arg("progress"));
  module.def((std::string("open_") + function).c_str(), &open<Result>,
             py::call_guard<py::gil_scoped_release>(), py::arg("file"));
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
  add<EscapeResult>(module, "EscapeOutcome", "escape");
  add<DiffusionResult>(module, "DiffusionOutcome", "diffusion");
  add<LyapunovResult>(module, "LyapunovOutcome", "lyapunov");
}

}  // namespace carom::python
