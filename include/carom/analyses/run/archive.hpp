// The archive of a run: hits, samples, contacts and energies as they come.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "carom/analyses/run.hpp"
#include "carom/analyses/run/rows.hpp"
#include "carom/files/archive.hpp"

namespace carom {

/// A run while it happens: hits and samples go to the file in batches, which readers can follow
/// (HDF5's SWMR mode). A file that is not finished is removed, unless the process is killed: then
/// it stays readable, with the attribute `complete` still 0.
class RunArchive : public Observer {
 public:
  static std::unique_ptr<RunArchive> create(const std::string& file, const LoadedSystem&,
                                            const Provenance&, bool force,
                                            std::uint64_t trajectory = 0, ArchiveLock = nullptr);
  /// Goes on with the run stored in `source`: works on a copy aside, which becomes `target`
  /// (often the source itself) when finished.
  static std::unique_ptr<RunArchive> extend(const std::string& source, const std::string& target,
                                            const LoadedSystem&, const Provenance&, bool force,
                                            ArchiveLock = nullptr);
  ~RunArchive() override;

  /// Before anything else.
  void start(const std::vector<SampleRow>&);
  void hit(const HitEvent&) override;
  /// The same of what was kept as rows. Energies are rows only where they are wanted.
  void append(const HitRow&);
  void append(const ContactRow&);
  void append(const SampleRow&);
  void append(const EnergyRow&);
  void contact(const ContactEvent&) override;
  void sample(int particle, Time, const State&) override;
  /// False where the sum over all pairs was interrupted: nothing of this sample is stored.
  bool sampled(Time) override;
  /// Asked while energies are summed, which takes seconds for thousands of particles. True: stop.
  void listen(std::function<bool()> interrupted);
  void finish(const SingleRunResult&, const std::string& status);

 private:
  void append_hits();

  class Implementation;
  explicit RunArchive(std::unique_ptr<Implementation>);
  std::unique_ptr<Implementation> implementation_;
};

/// A run as its archive holds it.
struct StoredRun {
  std::string system_name, system_toml, status;
  std::string engine;  ///< "events", "steps" or "auto"
  std::vector<ParticleProgress> particles;
  StepCounts steps;
  Evaluations evaluations;
  double seconds = 0.0, cpu_seconds = 0.0;
  std::uint64_t trajectory = 0;
};
/// Throws InputError for anything but the archive of a finished or interrupted run.
StoredRun read_run(const std::string& file);

/// The rows of a run's archive. Throw InputError for anything else.
std::vector<HitRow> read_hits(const std::string& file);
std::vector<SampleRow> read_samples(const std::string& file);
/// The starts, a row a particle.
std::vector<SampleRow> read_starts(const std::string& file);
/// None where the archive has no such group: no hard discs; no forces and no hard discs.
std::vector<ContactRow> read_contacts(const std::string& file);
std::vector<EnergyRow> read_energies(const std::string& file);

}  // namespace carom
