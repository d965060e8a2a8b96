// One trajectory, followed closely; sections of many orbits.
#include <pybind11/stl.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "analyses/run/report.hpp"
#include "analyses/run/stored_run.hpp"
#include "analyses/section/report.hpp"
#include "arrays.hpp"
#include "carom/analyses/run.hpp"
#include "carom/analyses/run/archive.hpp"
#include "carom/analyses/run/rows.hpp"
#include "carom/analyses/section.hpp"
#include "carom/analyses/section/archive.hpp"
#include "carom/base/error.hpp"
#include "carom/events/world.hpp"
#include "carom/files/archive.hpp"
#include "carom/files/ensembles.hpp"
#include "carom/starts/sampler.hpp"
#include "carom/system/section.hpp"
#include "cli/common.hpp"
#include "cli/reports/doubts.hpp"
#include "loaded.hpp"
#include "run_in_background.hpp"

namespace py = pybind11;

namespace carom::python {

namespace {

// What a run tells, kept: rows for arrays, events for an archive.
class Recording : public Observer {
 public:
  Recording(const System& system, Course& course)
      : system_(system), frames_(frames_of(*system.table)), energies_(system), course_(course) {
    energies_.listen([&course] { return course.stop.load(std::memory_order_relaxed); });
  }

  void hit(const HitEvent& event) override {
    hits->push_back(hit_row(event, *system_.table, frames_));
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

  std::shared_ptr<std::vector<HitRow>> hits = std::make_shared<std::vector<HitRow>>();
  std::shared_ptr<std::vector<SampleRow>> samples = std::make_shared<std::vector<SampleRow>>();
  std::shared_ptr<std::vector<ContactRow>> contacts = std::make_shared<std::vector<ContactRow>>();
  std::shared_ptr<std::vector<EnergyRow>> energies = std::make_shared<std::vector<EnergyRow>>();

 private:
  const System& system_;
  std::vector<geometry::CurveFrame> frames_;
  EnergyRows energies_;
  std::size_t samples_before_ = 0;
  Course& course_;
};

// Rows that were computed, or that an archive holds: those are read when they are asked for.
template <class Row>
class Rows {
 public:
  Rows() = default;
  Rows(std::shared_ptr<const std::vector<Row>> rows) : rows_(std::move(rows)) {}
  explicit Rows(std::function<std::vector<Row>()> read) : read_(std::move(read)) {}
  const std::shared_ptr<const std::vector<Row>>& get() const {
    if (!rows_) rows_ = std::make_shared<const std::vector<Row>>(read_());
    return rows_;
  }

 private:
  mutable std::shared_ptr<const std::vector<Row>> rows_;
  std::function<std::vector<Row>()> read_;
};

// The file that was opened, as long as it is the same.
class OpenedFile {
 public:
  explicit OpenedFile(std::string name) : name_(std::move(name)), at_first_(now()) {}
  template <class Row>
  Rows<Row> rows(std::vector<Row> (*read)(const std::string&)) const {
    return Rows<Row>([file = *this, read] {
      if (file.now() != file.at_first_)
        throw InputError(Place{file.name_, 0, 0, ""}, "was changed since it was opened",
                         "the same archive, or carom.open once more");
      return read(file.name_);
    });
  }

 private:
  using State = std::pair<std::filesystem::file_time_type, std::uintmax_t>;
  State now() const {
    std::error_code time, size;
    return {std::filesystem::last_write_time(name_, time), std::filesystem::file_size(name_, size)};
  }
  std::string name_;
  State at_first_;
};

struct RunOutcome {
  LoadedPointer system;
  SingleRunResult result;
  std::string status;
  std::optional<std::uint64_t> trajectory = 0;  ///< none: of an archive of an earlier build
  Rows<HitRow> hits;
  Rows<SampleRow> samples;
  Rows<ContactRow> contacts;
  Rows<EnergyRow> energies;
  std::vector<SampleRow> starts;
};

// Of an archive of an earlier build, which has no starts: trajectory 0 is drawn again.
std::vector<SampleRow> drawn_starts(const System& system) {
  World world(*system.table, system.dynamics);
  add_starts(world, Sampler(system), 0);
  return start_rows(world, *system.table);
}

py::tuple run(const std::shared_ptr<Loaded>& loaded, bool state_error, const py::object& progress) {
  const System& system = loaded->system();
  const cli::Options& options = loaded->options;
  RunOutcome outcome;
  outcome.system = loaded;
  if (!options.trajectory.empty())
    outcome.trajectory = cli::whole_number(options.trajectory, "--trajectory", 0);
  Course course;
  Recording recording(system, course);
  SingleRunOptions how;
  how.trajectory = outcome.trajectory;
  how.estimate_state_error = state_error;
  how.interrupted = [&] { return course.stop.load(std::memory_order_relaxed); };
  const std::exception_ptr interruption = run_in_background(course, progress, [&] {
    if (estimates_trust(system)) how.written = written_system(loaded->loaded);
    how.started = [&](const World& world) { outcome.starts = start_rows(world, *system.table); };
    outcome.result = run_single(system, recording, how);
  });
  if (interruption && outcome.result.particles.empty()) std::rethrow_exception(interruption);
  outcome.status = cli::run_status(outcome.result);
  outcome.hits = {recording.hits};
  outcome.samples = {recording.samples};
  outcome.contacts = {recording.contacts};
  outcome.energies = {recording.energies};
  return py::make_tuple(std::move(outcome), error_of(interruption));
}

// Ctrl-C leaves no file.
void save(const RunOutcome& self, const std::string& file, bool force) {
  Course course;
  const std::exception_ptr interruption = run_in_background(course, py::none(), [&] {
    const LoadedSystem& loaded = self.system->loaded;
    const auto archive = RunArchive::create(
        followed(file), loaded, cli::provenance_of(self.system->options, loaded.system, 1), force,
        self.trajectory);
    const auto append = [&](const auto& rows) {
      for (const auto& row : rows) {
        if (course.stop.load(std::memory_order_relaxed)) return false;
        archive->append(row);
      }
      return true;
    };
    archive->start(self.starts);
    if (append(*self.hits.get()) && append(*self.contacts.get()) && append(*self.samples.get()) &&
        append(*self.energies.get()))
      archive->finish(self.result, self.status);
  });
  if (interruption) std::rethrow_exception(interruption);
}

// Sees whether a run that has ended goes on all the same.
struct Ended : Observer {
  bool goes_on = false;
  void hit(const HitEvent&) override { goes_on = true; }
  void contact(const ContactEvent&) override { goes_on = true; }
};

// A stored run is asked to go on where it has ended: no event comes, and the end is told again.
RunOutcome open_run(const std::string& file) {
  const OpenedFile opened(file);
  const StoredRun stored = read_run(file);
  auto loaded = std::make_shared<Loaded>();
  loaded->loaded = read_system(stored.system_toml, file + ": /system");
  System& system = loaded->loaded.system;
  system.name = stored.system_name;
  loaded->options.command = "run";
  cli::choose_engine(stored.engine == "steps" ? "steps" : "auto", system);
  analyses::check_stored(stored, system, file);
  Ended ended;
  SingleRunOptions how;
  how.resume = stored.particles;
  how.interrupted = [&] { return ended.goes_on; };
  how.steps = stored.steps;
  how.evaluations = stored.evaluations;
  how.trajectory = stored.trajectory;
  double end = 0.0;
  for (const ParticleProgress& p : stored.particles) end = std::max(end, p.end.value());
  system.run.t_max = end;
  RunOutcome outcome;
  outcome.result = run_single(system, ended, how);
  if (ended.goes_on)
    throw InputError(Place{file, 0, 0, ""}, "'/state' is not where the run ended",
                     "an archive as carom wrote it");
  outcome.result.seconds = stored.seconds;
  outcome.result.cpu_seconds = stored.cpu_seconds;
  if (system.dynamics.forces && !system.dynamics.forces->empty())
    outcome.result.no_state_error = "archives do not hold it";
  outcome.starts = read_starts(file);
  if (outcome.starts.empty()) outcome.starts = drawn_starts(system);
  outcome.status = stored.status;
  outcome.trajectory = stored.trajectory;
  outcome.hits = opened.rows(read_hits);
  outcome.samples = opened.rows(read_samples);
  outcome.contacts = opened.rows(read_contacts);
  outcome.energies = opened.rows(read_energies);
  outcome.system = std::move(loaded);
  return outcome;
}

struct SectionOutcome {
  LoadedPointer system;
  SectionResult result;
  std::shared_ptr<std::vector<SectionPoint>> points = std::make_shared<std::vector<SectionPoint>>();
  const char* status() const { return result.complete ? "completed" : "interrupted"; }
};

py::tuple section(const std::shared_ptr<Loaded>& loaded, const py::object& progress) {
  const System& system = loaded->system();
  SectionOutcome outcome;
  outcome.system = loaded;
  SectionOptions how;
  how.threads = cli::threads_of(loaded->options);
  Course course;
  how.interrupted = &course.stop;
  how.points = [&](const std::vector<SectionPoint>& points) {
    outcome.points->insert(outcome.points->end(), points.begin(), points.end());
  };
  const double all = static_cast<double>(section_orbits(system));
  how.progress = [&](std::uint64_t orbits, std::uint64_t) {
    course.done = orbits;
    course.share = static_cast<double>(orbits) / all;
  };
  const std::exception_ptr interruption =
      run_in_background(course, progress, [&] { outcome.result = run_section(system, how); });
  return py::make_tuple(std::move(outcome), error_of(interruption));
}

SectionOutcome open_section(const std::string& file) {
  StoredSection stored = read_section(file);
  auto loaded = std::make_shared<Loaded>();
  loaded->loaded = read_system(stored.system_toml, file + ": /system");
  loaded->loaded.system.name = stored.system_name;
  loaded->options.command = "section";
  cli::choose_engine(stored.engine == "steps" ? "steps" : "auto", loaded->loaded.system);
  SectionOutcome outcome;
  outcome.system = std::move(loaded);
  outcome.result = stored.result;
  *outcome.points = std::move(stored.points);
  return outcome;
}

void save_section(const SectionOutcome& self, const std::string& file, bool force) {
  const LoadedSystem& loaded = self.system->loaded;
  SectionArchive archive(
      followed(file), loaded,
      cli::provenance_of(self.system->options, loaded.system, self.result.threads), force);
  archive.append(*self.points);
  archive.finish(self.result, self.status());
}

std::shared_ptr<Loaded> system_of(const LoadedPointer& system) {
  return std::const_pointer_cast<Loaded>(system);
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
  py::class_<RunOutcome>(module, "RunOutcome")
      .def_property_readonly("system",
                             [](const RunOutcome& self) { return system_of(self.system); })
      .def_property_readonly("trajectory", [](const RunOutcome& self) { return self.trajectory; })
      .def("json",
           [](const RunOutcome& self) {
             return cli::run_json(self.system->system(), self.result, self.status, "").text();
           })
      .def("text",
           [](const RunOutcome& self) {
             return cli::run_text(self.system->system(), self.result, self.status, "");
           })
      .def("doubts",
           [](const RunOutcome& self) {
             return cli::doubts_of(self.system->system(), self.result).lines;
           })
      .def("hits", [](const RunOutcome& self) { return array_of<HitRow>(self.hits.get()); })
      .def("samples",
           [](const RunOutcome& self) { return array_of<SampleRow>(self.samples.get()); })
      .def("contacts",
           [](const RunOutcome& self) { return array_of<ContactRow>(self.contacts.get()); })
      .def("energies",
           [](const RunOutcome& self) { return array_of<EnergyRow>(self.energies.get()); })
      .def("starts",
           [](const RunOutcome& self) { return array_of(std::vector<SampleRow>(self.starts)); })
      .def("save", &save, py::arg("file"), py::arg("force"));
  module.def("run", &run, py::arg("system"), py::arg("state_error"), py::arg("progress"));
  py::class_<SectionOutcome>(module, "SectionOutcome")
      .def_property_readonly("system",
                             [](const SectionOutcome& self) { return system_of(self.system); })
      .def("json",
           [](const SectionOutcome& self) {
             return cli::section_json(self.system->system(), self.result, self.status(), "").text();
           })
      .def("text",
           [](const SectionOutcome& self) {
             cli::OrbitLines lines;
             lines.add(*self.points);
             return cli::section_text(self.system->system(), self.result, lines, "");
           })
      .def("doubts",
           [](const SectionOutcome& self) {
             return cli::doubts_of(self.system->system(), self.result).lines;
           })
      .def("points", [](const SectionOutcome& self) { return array_of<SectionPoint>(self.points); })
      .def("save", &save_section, py::call_guard<py::gil_scoped_release>(), py::arg("file"),
           py::arg("force"));
  module.def("open_run", &open_run, py::call_guard<py::gil_scoped_release>(), py::arg("file"));
  module.def("open_section", &open_section, py::call_guard<py::gil_scoped_release>(),
             py::arg("file"));
  module.def("kind_of_archive", &kind_of_archive, py::call_guard<py::gil_scoped_release>(),
             py::arg("file"));
  module.def("section", &section, py::arg("system"), py::arg("progress"));
}

}  // namespace carom::python
