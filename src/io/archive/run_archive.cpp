#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "carom/base/error.hpp"
#include "carom/ensemble/injection.hpp"
#include "carom/ensemble/run_rows.hpp"
#include "carom/ensemble/sampler.hpp"
#include "carom/geometry/curve_frame.hpp"
#include "io/archive/archive_file.hpp"
#include "io/archive/checksums.hpp"
#include "io/archive/columns.hpp"
#include "io/archive/contact_columns.hpp"
#include "io/archive/ensemble_columns.hpp"
#include "io/archive/state_fields.hpp"
#include "io/archive/step_numbers.hpp"
#include "io/archive/trust_columns.hpp"
#include "io/checkpoint/ensemble_files.hpp"

namespace carom {

using namespace io;
using hdf5::Description;
using hdf5::Handle;

namespace {

// One value a particle.
template <class T, class Get>
std::vector<T> collect(const std::vector<RunEnd>& particles, Get get) {
  std::vector<T> values;
  for (const RunEnd& particle : particles) values.push_back(static_cast<T>(get(particle)));
  return values;
}

const std::pair<const char*, Description> energy_fields[] = {
    {"t", {"time", "Time of the sample"}},
    {"kinetic", {"energy", "Sum of m v^2 / 2"}},
    {"external", {"energy", "Sum of the external potentials"}},
    {"pair", {"energy", "Sum of the interactions, each pair once"}},
    {"total", {"energy", "Their sum"}},
    {"px", {"momentum", "Sum of m v"}},
    {"py", {"momentum", "Sum of m v"}},
    {"angular_momentum",
     {"angular momentum", "Sum of m (x cross v + omega r^2 / 2), about the origin"}},
};

void add_sample_columns(hdf5::Columns& columns, hid_t to) {
  columns.add<std::int32_t>(to, "particle", {"1", "Index of the particle"});
  columns.add<double>(to, "t", {"time", "Time of the sample"});
  columns.add<double>(to, "x", {"length", "Position, unwrapped"});
  columns.add<double>(to, "y", {"length", "Position, unwrapped"});
  columns.add<double>(to, "vx", {"length/time", "Velocity"});
  columns.add<double>(to, "vy", {"length/time", "Velocity"});
  columns.add<std::int64_t>(to, "cell_first", {"1", "Cell of the lattice"});
  columns.add<std::int64_t>(to, "cell_second", {"1", "Cell of the lattice"});
}
void add_row(hdf5::Columns& columns, const SampleRow& row) {
  columns.row(row.particle, row.t, row.x, row.y, row.vx, row.vy, row.cell_first, row.cell_second);
}

double expected_hits(const System& system) {
  return static_cast<double>(system.run.collisions) * static_cast<double>(system.particles.size());
}
double expected_samples(const System& system) {
  const double each = system.run.sample > 0.0 ? system.run.t_max / system.run.sample : 0.0;
  return each * static_cast<double>(system.particles.size());
}

std::vector<std::string> fate_names() {
  std::vector<std::string> names;
  for (int i = 0; i <= static_cast<int>(last_fate); ++i)
    names.push_back(name_of(static_cast<Fate>(i)));
  return names;
}

}  // namespace

class RunArchive::Implementation {
 public:
  Implementation(ArchiveFile opened, std::string final_path, const LoadedSystem& loaded)
      : file(std::move(opened)),
        target(std::move(final_path)),
        table(loaded.system.table),
        hits_now(*table),
        hits(file.name(), expected_hits(loaded.system)),
        samples(file.name(), expected_samples(loaded.system)),
        starts(file.name()),
        contacts(file.name()),
        of_discs(loaded.system.of_discs()),
        with_energies(EnergyRows(loaded.system).wanted()),
        energies(file.name()),
        system(loaded.system),
        energies_now(system) {}

  void create(const LoadedSystem& loaded, const Provenance& origin,
              std::optional<std::uint64_t> trajectory);
  void reopen(const LoadedSystem& loaded, const Provenance& origin);
  void create_state(std::size_t particles);
  void write_state(const std::vector<RunEnd>& particles);
  void create_steps();
  void write_steps(const StepCounts& steps, const Evaluations& evaluations);

  ArchiveLock lock;  // first: it lets go last
  ArchiveFile file;
  std::string target;
  std::shared_ptr<const Table> table;
  HitRows hits_now;
  hdf5::Columns hits, samples, starts;
  ContactColumns contacts;
  bool of_discs, with_energies;
  hdf5::Columns energies;
  std::vector<SampleRow>
      rows_now;  ///< of the sample under way: stored with its energy or not at all
  System system;
  EnergyRows energies_now;
  double sampled_until = -std::numeric_limits<double>::infinity();
};

void RunArchive::Implementation::create(const LoadedSystem& loaded, const Provenance& origin,
                                        std::optional<std::uint64_t> trajectory) {
  file.write_head(run_archive_kind, loaded, origin);
  file.write_seconds({});
  if (trajectory)
    hdf5::write_attribute(file.open_group("provenance").get(), trajectory_key, *trajectory,
                          file.name());
  std::vector<std::string> walls;
  for (const Wall& wall : table->walls) walls.push_back(wall.name);
  {
    const Handle group = file.group("collisions", "Reflections in order of time");
    const hid_t to = group.get();
    hits.add<std::int32_t>(to, "particle", {"1", "Index of the particle"});
    const hid_t wall =
        hits.add<std::int32_t>(to, "wall", {"1", "Index into the attribute `names`"});
    hdf5::write_attribute(wall, "names", walls, file.name());
    hits.add<double>(to, "s", {"length", "Arc length along the wall from its start"});
    hits.add<double>(
        to, "v_parallel",
        {"length/time", "Tangential velocity after the hit, positive in the direction of s"});
    hits.add<double>(to, "t", {"time", "Time of the hit"});
    hits.add<double>(to, "x", {"length", "Position, unwrapped"});
    hits.add<double>(to, "y", {"length", "Position, unwrapped"});
    hits.add<double>(to, "vx", {"length/time", "Velocity after the hit"});
    hits.add<double>(to, "vy", {"length/time", "Velocity after the hit"});
    hits.add<std::int64_t>(to, "cell_first", {"1", "Cell of the lattice"});
    hits.add<std::int64_t>(to, "cell_second", {"1", "Cell of the lattice"});
    hits.add<std::int32_t>(to, "reflections",
                           {"1", "Reflections counted: n at a corner of angle pi/n"}, 1);
  }
  {
    const Handle group = file.group("trajectory", "Samples at even times (run.sample)");
    add_sample_columns(samples, group.get());
  }
  {
    const Handle group = file.group("start", "The start of each particle");
    add_sample_columns(starts, group.get());
  }
  if (of_discs) {
    const Handle group = file.group("contacts", "Contacts of hard discs in order of time");
    contacts.create(group.get());
  }
  if (with_energies) {
    const Handle group = file.group("energy", "Sums over the particles at each sample's time");
    for (const auto& [name, description] : energy_fields)
      energies.add<double>(group.get(), name, description);
  }
  if (is_integrated(loaded.system)) create_steps();
  const std::size_t particles =
      loaded.system.particles.size() + injected_count(loaded.system, trajectory.value_or(0));
  create_state(particles);
  if (estimates_trust(loaded.system))
    create_trust(file.group("trust", "How far each particle can be trusted").get(), particles,
                 file.name());
}

void RunArchive::Implementation::create_state(std::size_t particles) {
  const Handle group = file.group(
      "state", "The exact state after the last event of each particle; a run goes on from it");
  for (const StateField& field : state_fields) {
    const hid_t type = field.real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64;
    const Handle dataset = hdf5::create_fixed(group.get(), field.name, type, particles,
                                              field.description, file.name());
    if (std::string_view(field.name) == "fate")
      hdf5::write_attribute(dataset.get(), "names", fate_names(), file.name());
  }
}

void RunArchive::Implementation::reopen(const LoadedSystem& loaded, const Provenance& origin) {
  if (hdf5::has(file.open_group("collisions").get(), "u"))
    throw InputError(Place{file.name(), 0, 0, ""},
                     "was begun by an earlier build, whose hits have a column 'u'",
                     "an archive of this one: run it again");
  file.extend_head(loaded, origin);
  const Handle provenance = file.open_group("provenance");
  file.write_seconds(ArchiveFile::read_seconds(provenance.get(), file.name()));
  {
    const Handle group = file.open_group("collisions");
    const hid_t from = group.get();
    hits.open<std::int32_t>(from, "particle");
    hits.open<std::int32_t>(from, "wall");
    for (const char* name : {"s", "v_parallel", "t", "x", "y", "vx", "vy"})
      hits.open<double>(from, name);
    hits.open<std::int64_t>(from, "cell_first");
    hits.open<std::int64_t>(from, "cell_second");
    hits.open<std::int32_t>(from, "reflections", 1);
  }
  const Handle group = file.open_group("trajectory");
  const hid_t from = group.get();
  const std::vector<double> times = hdf5::read_column<double>(from, "t", file.name());
  if (!times.empty()) sampled_until = times.back();
  samples.open<std::int32_t>(from, "particle");
  for (const char* name : {"t", "x", "y", "vx", "vy"}) samples.open<double>(from, name);
  samples.open<std::int64_t>(from, "cell_first");
  samples.open<std::int64_t>(from, "cell_second");
  if (of_discs) contacts.open(file.open_group("contacts").get());
  if (with_energies) {
    const Handle energy = file.open_group("energy");
    for (const auto& [name, description] : energy_fields) energies.open<double>(energy.get(), name);
  }
}

void RunArchive::Implementation::write_state(const std::vector<RunEnd>& particles) {
  const Handle group = file.open_group("state");
  for (const StateField& field : state_fields) {
    if (!hdf5::has(group.get(), field.name)) continue;  // of an archive of an earlier build
    Handle dataset =
        hdf5::checked(H5Dopen2(group.get(), field.name, H5P_DEFAULT), H5Dclose, file.name());
    herr_t written = -1;
    if (field.real) {
      const auto values =
          collect<double>(particles, [&](const RunEnd& p) { return field.real_of(p.progress); });
      written =
          H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    } else {
      const auto values = collect<std::int64_t>(
          particles, [&](const RunEnd& p) { return field.integer_of(p.progress); });
      written =
          H5Dwrite(dataset.get(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    }
    hdf5::check(written >= 0, file.name());
    hdf5::check(dataset.close(), file.name());
  }
}

void RunArchive::Implementation::create_steps() {
  const Handle group = file.group("steps", "What integration has cost");
  const auto create = [&](const char* name, hid_t type, Description description) {
    hdf5::create_fixed(group.get(), name, type, 1, description, file.name());
  };
  for (const StepNumber& number : step_numbers)
    create(number.name, H5T_NATIVE_UINT64, {"1", number.text});
  create(first_unresolved, H5T_NATIVE_DOUBLE,
         {"time", "When the earliest step that was counted as unresolved began"});
  create(shortest_part, H5T_NATIVE_DOUBLE,
         {"time", "The shortest part of a step that was halved; 0: none"});
  create(going_on, H5T_NATIVE_UINT64,
         {"1",
          "Evaluations from which a run that goes on counts: but those for states within the "
          "steps under way"});
  create(predicted, H5T_NATIVE_UINT64,
         {"1", "1: those of the steps under way are among them; 0: an interrupt dropped them"});
}

void RunArchive::Implementation::write_steps(const StepCounts& steps,
                                             const Evaluations& evaluations) {
  if (!hdf5::has(file.id(), "steps")) return;
  const Handle group = file.open_group("steps");
  const auto write = [&](const char* name, hid_t type, const void* value) {
    if (!hdf5::has(group.get(), name)) return;  // an earlier version began the archive
    Handle dataset = hdf5::checked(H5Dopen2(group.get(), name, H5P_DEFAULT), H5Dclose, file.name());
    hdf5::check(H5Dwrite(dataset.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0,
                file.name());
    hdf5::check(dataset.close(), file.name());
  };
  for (const StepNumber& number : step_numbers)
    write(number.name, H5T_NATIVE_UINT64, &(steps.*number.value));
  write(first_unresolved, H5T_NATIVE_DOUBLE, &steps.first_unresolved);
  write(shortest_part, H5T_NATIVE_DOUBLE, &steps.shortest_part);
  const std::uint64_t are_predicted = evaluations.predicted;
  write(going_on, H5T_NATIVE_UINT64, &evaluations.count);
  write(predicted, H5T_NATIVE_UINT64, &are_predicted);
}

RunArchive::RunArchive(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
RunArchive::~RunArchive() = default;

std::unique_ptr<RunArchive> RunArchive::create(const std::string& file, const LoadedSystem& loaded,
                                               const Provenance& origin, bool force,
                                               std::optional<std::uint64_t> trajectory,
                                               ArchiveLock lock) {
  hdf5::silence();
  if (!lock) lock = lock_archive(file);
  refuse_existing(file, force);
  auto made = std::make_unique<Implementation>(ArchiveFile::create(file, file), file, loaded);
  made->lock = std::move(lock);
  made->create(loaded, origin, trajectory);
  made->file.start_swmr();
  return std::unique_ptr<RunArchive>(new RunArchive(std::move(made)));
}

std::unique_ptr<RunArchive> RunArchive::extend(const std::string& source, const std::string& target,
                                               const LoadedSystem& loaded, const Provenance& origin,
                                               bool force, ArchiveLock lock) {
  if (!lock) lock = lock_archive(target);
  std::error_code error;
  if (!std::filesystem::equivalent(source, target, error)) refuse_existing(target, force);
  const std::string copy = aside_of(target);
  std::filesystem::remove(copy, error);  // never through a link: the copy is a new file
  if (!std::filesystem::copy_file(source, copy, std::filesystem::copy_options::none, error)) {
    const std::string reason = error.message();
    std::filesystem::remove(copy, error);
    throw InputError("cannot write '" + copy + "': " + reason);
  }
  try {
    auto made = std::make_unique<Implementation>(ArchiveFile::open(copy, target), target, loaded);
    made->lock = std::move(lock);
    made->reopen(loaded, origin);
    made->file.start_swmr();
    return std::unique_ptr<RunArchive>(new RunArchive(std::move(made)));
  } catch (const hdf5::Damaged& damage) {  // the copy is as the source is
    std::filesystem::remove(copy, error);
    throw InputError(Place{source, 0, 0, ""}, damage.problem(), damage.expected());
  }
}

void RunArchive::start(const std::vector<SampleRow>& rows) {
  for (const SampleRow& row : rows) add_row(implementation_->starts, row);
  implementation_->starts.close();
}

void RunArchive::hit(const HitEvent& event) {
  HitRows& rows = implementation_->hits_now;
  rows.add(event);
  if (rows.full()) append_hits();
}

void RunArchive::append_hits() {
  for (const HitRow& row : implementation_->hits_now.take()) append(row);
}

void RunArchive::append(const HitRow& row) {
  implementation_->hits.row(row.particle, row.wall, row.s, row.v_parallel, row.t, row.x, row.y,
                            row.vx, row.vy, row.cell_first, row.cell_second, row.reflections);
}

void RunArchive::contact(const ContactEvent& event) {
  append(contact_row(event, *implementation_->table));
}
void RunArchive::append(const ContactRow& row) { implementation_->contacts.add(row); }
void RunArchive::append(const SampleRow& row) { add_row(implementation_->samples, row); }
void RunArchive::append(const EnergyRow& row) {
  implementation_->energies.row(row.t, row.kinetic, row.external, row.pair, row.total, row.px,
                                row.py, row.angular_momentum);
}

void RunArchive::sample(int particle, Time time, const State& state) {
  Implementation& a = *implementation_;
  // A run that goes on is asked for its samples from the beginning.
  if (!(time.value() > a.sampled_until)) return;
  a.rows_now.push_back(sample_row(particle, time, state, *a.table));
  a.energies_now.sample(particle, state);
}

bool RunArchive::sampled(Time time) {
  Implementation& a = *implementation_;
  std::optional<EnergyRow> energy;
  const bool complete = a.energies_now.sampled(time, energy);
  if (complete)
    for (const SampleRow& row : a.rows_now) append(row);
  if (energy) append(*energy);
  a.rows_now.clear();
  return complete;
}

void RunArchive::listen(std::function<bool()> interrupted) {
  implementation_->energies_now.listen(std::move(interrupted));
}

void RunArchive::finish(const SingleRunResult& result, const std::string& status) {
  Implementation& a = *implementation_;
  append_hits();
  a.hits.close(a.file.sums());
  a.samples.close(a.file.sums());
  a.starts.close();
  a.contacts.close();
  a.energies.close();
  a.write_state(result.particles);
  a.write_steps(result.steps, result.evaluations);
  if (result.particles.front().trust.known)
    write_trust(a.file.open_group("trust").get(), result.particles, a.file.name());
  a.file.write_seconds({result.seconds, result.cpu_seconds});
  a.file.add_decisions(result.decisions);
  a.file.set_status(status, !result.interrupted);
  a.file.keep_as(a.target);
  give_up_checkpoint(a.target);
  a.lock.reset();
}

}  // namespace carom
