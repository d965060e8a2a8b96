// One trajectory, followed closely; sections of many orbits.
#include <pybind11/stl.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "analyses/run/report.hpp"
#include "analyses/run/report_outcome.hpp"
#include "analyses/section/report.hpp"
#include "arrays.hpp"
#include "carom/analyses/run.hpp"
#include "carom/analyses/run/rows.hpp"
#include "carom/analyses/section.hpp"
#include "carom/events/world.hpp"
#include "carom/files/ensembles.hpp"
#include "carom/system/section.hpp"
#include "cli/common.hpp"
#include "loaded.hpp"
#include "own_step.hpp"
#include "run_in_background.hpp"

namespace py = pybind11;

namespace carom::python {

namespace {

using cli::RunOutcome;
using cli::SectionOutcome;

// Hits on their way to a function of Python's, which is called by another thread than that of the
// run.
class HitQueue {
 public:
  void add(const std::vector<HitRow>& rows) {
    const std::lock_guard lock(mutex_);
    rows_.insert(rows_.end(), rows.begin(), rows.end());
  }
  std::vector<HitRow> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(rows_, {});
  }

 private:
  std::mutex mutex_;
  std::vector<HitRow> rows_;
};

// What a run tells, kept: rows for arrays, events for an archive.
class Recording : public Observer {
 public:
  // `queue`: gets the hits, too; null: Python asks for none.
  Recording(const System& system, Course& course, HitQueue* queue)
      : system_(system),
        frames_(frames_of(*system.table)),
        energies_(system),
        course_(course),
        queue_(queue) {
    energies_.listen([&course] { return course.stop.load(std::memory_order_relaxed); });
  }

  void hit(const HitEvent& event) override {
    hits->push_back(hit_row(event, *system_.table, frames_));
    if (queue_ != nullptr && hits->size() - queued_ >= 512) queue();
    course_.done.store(hits->size(), std::memory_order_relaxed);
    const double by_hits =
        system_.run.collisions == 0
            ? 0.0
            : static_cast<double>(hits->size()) /
                  static_cast<double>(system_.run.collisions * system_.particles.size());
    course_.share.store(std::max(by_hits, event.time.value() / system_.run.t_max),
                        std::memory_order_relaxed);
  }
  void contact(const ContactEvent& event) override {
    contacts->push_back(contact_row(event, *system_.table));
  }
  void sample(int particle, Time time, const State& state) override {
    samples->push_back(sample_row(particle, time, state, *system_.table));
    energies_.sample(particle, state);
  }
  bool sampled(Time time) override {
    std::optional<EnergyRow> row;
    const bool complete = energies_.sampled(time, row);
    if (row) energies->push_back(*row);
    if (!complete) samples->resize(samples_before_);  // a sample is kept with its energy
    samples_before_ = samples->size();
    return complete;
  }

  // The hits since the last call are for the queue.
  void queue() {
    if (queue_ == nullptr) return;
    queue_->add({hits->begin() + static_cast<std::ptrdiff_t>(queued_), hits->end()});
    queued_ = hits->size();
  }

  std::shared_ptr<std::vector<HitRow>> hits = std::make_shared<std::vector<HitRow>>();
  std::shared_ptr<std::vector<SampleRow>> samples = std::make_shared<std::vector<SampleRow>>();
  std::shared_ptr<std::vector<ContactRow>> contacts = std::make_shared<std::vector<ContactRow>>();
  std::shared_ptr<std::vector<EnergyRow>> energies = std::make_shared<std::vector<EnergyRow>>();

 private:
  const System& system_;
  std::vector<geometry::CurveFrame> frames_;
  EnergyRows energies_;
  std::size_t samples_before_ = 0, queued_ = 0;
  Course& course_;
  HitQueue* const queue_;
};

py::tuple run(const LoadedPointer& loaded, bool state_error, const py::object& on_hit,
              const py::object& progress) {
  const cli::Options& options = loaded->options;
  const auto made = std::make_shared<RunOutcome>(loaded);
  RunOutcome& outcome = *made;
  if (!options.trajectory.empty())
    outcome.trajectory = cli::whole_number(options.trajectory, "--trajectory", 0);
  Course course;
  HitQueue queue;
  const bool asked = !on_hit.is_none();
  const auto hand_over = [&] {
    std::vector<HitRow> rows = queue.take();
    if (!rows.empty()) on_hit(array_of(std::move(rows)));
  };
  py::object told = progress;
  if (asked)
    told = py::cpp_function([&](double share, std::uint64_t done) {
      hand_over();
      if (!progress.is_none()) progress(share, done);
    });
  std::optional<Recording> recording;
  SingleRunOptions how;
  how.trajectory = outcome.trajectory;
  how.estimate_state_error = state_error;
  how.interrupted = [&] { return course.stop.load(std::memory_order_relaxed); };
  std::exception_ptr interruption =
      fly_with_own_step(outcome, course, told, [&]() -> std::optional<EnergyError> {
        const System& system = outcome.system();
        recording.emplace(system, course, asked ? &queue : nullptr);
        if (estimates_trust(system)) how.written = written_system(outcome.loaded->loaded);
        how.started = [&](const World& world) {
          outcome.starts = start_rows(world, *system.table);
        };
        outcome.result = run_single(system, *recording, how);
        recording->queue();
        // Hits that Python's function has had cannot be taken back.
        if (asked || outcome.result.interrupted) return std::nullopt;
        return energy_error_of(outcome.result);
      });
  if (!interruption) try {
      hand_over();
    } catch (py::error_already_set&) {
      interruption = std::current_exception();
    }
  if (interruption && outcome.result.particles.empty()) std::rethrow_exception(interruption);
  outcome.status = cli::run_status(outcome.result);
  outcome.hits = {recording->hits};
  outcome.samples = {recording->samples};
  outcome.contacts = {recording->contacts};
  outcome.energies = {recording->energies};
  return py::make_tuple(made, error_of(interruption));
}

py::tuple section(const LoadedPointer& loaded, const py::object& progress) {
  const auto outcome = std::make_shared<SectionOutcome>(loaded);
  SectionOptions how;
  how.threads = cli::threads_of(loaded->options);
  Course course;
  how.interrupted = &course.stop;
  how.points = [&](const std::vector<SectionPoint>& points) {
    outcome->points->insert(outcome->points->end(), points.begin(), points.end());
  };
  const double all = static_cast<double>(section_orbits(loaded->system()));
  how.progress = [&](std::uint64_t orbits, std::uint64_t) {
    course.done = orbits;
    course.share = static_cast<double>(orbits) / all;
  };
  const std::exception_ptr interruption =
      fly_with_own_step(*outcome, course, progress, [&]() -> std::optional<EnergyError> {
        outcome->points->clear();
        outcome->result = run_section(outcome->system(), how);
        if (!outcome->result.complete) return std::nullopt;
        return outcome->result.energy_error;
      });
  return py::make_tuple(outcome, error_of(interruption));
}

}  // namespace

void add_runs(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(HitRow, particle, wall, s, v_parallel, t, x, y, vx, vy, cell_first,
                       cell_second, reflections);
  PYBIND11_NUMPY_DTYPE(SampleRow, particle, t, x, y, vx, vy, cell_first, cell_second);
  PYBIND11_NUMPY_DTYPE(ContactRow, first, second, t, first_x, first_y, second_x, second_y, dx, dy,
                       first_vx, first_vy, second_vx, second_vy, transfer);
  PYBIND11_NUMPY_DTYPE(EnergyRow, t, kinetic, external, pair, total, px, py, angular_momentum);
  PYBIND11_NUMPY_DTYPE(SectionPoint, orbit, index, particle, wall, direction, t, s, v_parallel, x,
                       y, vx, vy);
  py::class_<RunOutcome, Outcome, std::shared_ptr<RunOutcome>>(module, "RunOutcome")
      .def_property_readonly("trajectory", [](const RunOutcome& self) { return self.trajectory; })
      .def("hits", [](const RunOutcome& self) { return array_of<HitRow>(self.hits.get()); })
      .def("samples",
           [](const RunOutcome& self) { return array_of<SampleRow>(self.samples.get()); })
      .def("contacts",
           [](const RunOutcome& self) { return array_of<ContactRow>(self.contacts.get()); })
      .def("energies",
           [](const RunOutcome& self) { return array_of<EnergyRow>(self.energies.get()); })
      .def("starts",
           [](const RunOutcome& self) { return array_of(std::vector<SampleRow>(self.starts)); });
  module.def("run", &run, py::arg("system"), py::arg("state_error"), py::arg("on_hit"),
             py::arg("progress"));
  py::class_<SectionOutcome, Outcome, std::shared_ptr<SectionOutcome>>(module, "SectionOutcome")
      .def("points",
           [](const SectionOutcome& self) { return array_of<SectionPoint>(self.points); });
  module.def("section", &section, py::arg("system"), py::arg("progress"));
}

}  // namespace carom::python
