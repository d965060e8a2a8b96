#include <filesystem>
#include <limits>
#include <utility>

#include "analyses/run/trust_columns.hpp"
#include "carom/analyses/run/archive.hpp"
#include "carom/analyses/run/rows.hpp"
#include "carom/base/error.hpp"
#include "carom/starts/injection.hpp"
#include "carom/starts/sampler.hpp"
#include "files/checkpoint/ensemble_columns.hpp"
#include "files/checkpoint/work_folder.hpp"
#include "files/hdf5/archive_file.hpp"
#include "files/hdf5/fields.hpp"

namespace carom {

using namespace files;
using namespace analyses;
using hdf5::Handle;

namespace {

double expected_hits(const System& system) {
  return static_cast<double>(system.run.collisions) * static_cast<double>(system.particles.size());
}
double expected_samples(const System& system) {
  const double each = system.run.sample > 0.0 ? system.run.t_max / system.run.sample : 0.0;
  return each * static_cast<double>(system.particles.size());
}

}  // namespace

class RunArchive::Implementation {
 public:
  Implementation(ArchiveFile opened, const LoadedSystem& loaded)
      : file(std::move(opened)),
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

  void create(const LoadedSystem& loaded, const Provenance& origin, std::uint64_t trajectory);
  void reopen(const LoadedSystem& loaded, const Provenance& origin);
  void write_steps(const StepCounts& steps, const Evaluations& evaluations);

  ArchiveLock lock;  // first: it lets go last
  ArchiveFile file;
  std::shared_ptr<const Table> table;
  HitRows hits_now;
  Rows<HitRow> hits;
  Rows<SampleRow> samples, starts;
  Rows<ContactRow> contacts;
  bool of_discs, with_energies;
  Rows<EnergyRow> energies;
  std::vector<SampleRow>
      rows_now;  ///< of the sample under way: stored with its energy or not at all
  System system;
  EnergyRows energies_now;
  double sampled_until = -std::numeric_limits<double>::infinity();
};

void RunArchive::Implementation::create(const LoadedSystem& loaded, const Provenance& origin,
                                        std::uint64_t trajectory) {
  file.write_head(run_archive_kind, loaded, origin);
  file.write_seconds({});
  hdf5::write_attribute(file.open_group("provenance").get(), trajectory_key, trajectory,
                        file.name());
  std::vector<std::string> walls;
  for (const Wall& wall : table->walls) walls.push_back(wall.name);
  {
    const Handle group = file.group("collisions", "Reflections in order of time");
    hits.create(group.get());
    hdf5::write_attribute(hits.column("wall"), "names", walls, file.name());
  }
  {
    const Handle group = file.group("trajectory", "Samples at even times (run.sample)");
    samples.create(group.get());
  }
  {
    const Handle group = file.group("start", "The start of each particle");
    starts.create(group.get());
  }
  if (of_discs) {
    const Handle group = file.group("contacts", "Contacts of hard discs in order of time");
    contacts.create(group.get());
  }
  if (with_energies) {
    const Handle group = file.group("energy", "Sums over the particles at each sample's time");
    energies.create(group.get());
  }
  if (loaded.system.is_integrated()) {
    const Handle group = file.group("steps", "What integration has cost");
    create_columns<StepCounts>(group.get(), 1, file.name());
    create_columns<Evaluations>(group.get(), 1, file.name());
  }
  const std::size_t particles =
      loaded.system.particles.size() + injected_count(loaded.system, trajectory);
  {
    const Handle group = file.group(
        "state",
        "The exact state after the last event of each particle, from which a run continues");
    create_columns<ParticleProgress>(group.get(), particles, file.name());
    const Handle fate = hdf5::open_column(group.get(), "fate", file.name());
    hdf5::write_attribute(fate.get(), "names", fate_names(), file.name());
  }
  if (estimates_trust(loaded.system))
    create_trust(file.group("trust", "How far each particle can be trusted").get(), particles,
                 file.name());
}

void RunArchive::Implementation::reopen(const LoadedSystem& loaded, const Provenance& origin) {
  file.extend_head(loaded, origin);
  const Handle provenance = file.open_group("provenance");
  file.write_seconds(ArchiveFile::read_seconds(provenance.get(), file.name()));
  hits.open(file.open_group("collisions").get());
  const Handle group = file.open_group("trajectory");
  const std::vector<double> times = hdf5::read_column<double>(group.get(), "t", file.name());
  if (!times.empty()) sampled_until = times.back();
  samples.open(group.get());
  if (of_discs) contacts.open(file.open_group("contacts").get());
  if (with_energies) energies.open(file.open_group("energy").get());
}

void RunArchive::Implementation::write_steps(const StepCounts& steps,
                                             const Evaluations& evaluations) {
  if (!hdf5::has(file.id(), "steps")) return;
  const Handle group = file.open_group("steps");
  overwrite_columns(group.get(), std::span(&steps, 1), file.name());
  overwrite_columns(group.get(), std::span(&evaluations, 1), file.name());
}

RunArchive::RunArchive(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
RunArchive::~RunArchive() = default;

std::unique_ptr<RunArchive> RunArchive::create(const std::string& file, const LoadedSystem& loaded,
                                               const Provenance& origin, bool force,
                                               std::uint64_t trajectory, ArchiveLock lock) {
  hdf5::silence();
  if (!lock) lock = lock_archive(file);
  refuse_existing(file, force);
  auto made = std::make_unique<Implementation>(ArchiveFile::create(file, file), loaded);
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
    auto made = std::make_unique<Implementation>(ArchiveFile::open(copy, target), loaded);
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
  for (const SampleRow& row : rows) implementation_->starts.add(row);
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

void RunArchive::append(const HitRow& row) { implementation_->hits.add(row); }

void RunArchive::contact(const ContactEvent& event) {
  append(contact_row(event, *implementation_->table));
}
void RunArchive::append(const ContactRow& row) { implementation_->contacts.add(row); }
void RunArchive::append(const SampleRow& row) { implementation_->samples.add(row); }
void RunArchive::append(const EnergyRow& row) { implementation_->energies.add(row); }

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
  std::vector<ParticleProgress> states;
  for (const RunEnd& particle : result.particles) states.push_back(particle.progress);
  overwrite_columns(a.file.open_group("state").get(), std::span<const ParticleProgress>(states),
                    a.file.name());
  a.write_steps(result.steps, result.evaluations);
  if (result.particles.front().trust.known)
    write_trust(a.file.open_group("trust").get(), result.particles, a.file.name());
  a.file.write_seconds({result.seconds, result.cpu_seconds});
  a.file.add_decisions(result.decisions);
  a.file.finish(status, !result.interrupted);
  a.lock.reset();
}

}  // namespace carom
