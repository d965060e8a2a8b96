// Archives (HDF5): what a run or an ensemble leaves on disk. docs/guide/archive.md is the schema.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "carom/ensemble/diffusion.hpp"
#include "carom/ensemble/escape.hpp"
#include "carom/ensemble/section_run.hpp"
#include "carom/ensemble/single_run.hpp"
#include "carom/io/system_file.hpp"

namespace carom {

/// Once, before anything else happens in the program.
void prepare_archives();

/// Throws InputError where `file` exists and `force` is not set.
void refuse_existing(const std::string& file, bool force);

/// Where a result comes from. Everything else of /provenance is known to the archive.
struct Provenance {
  std::string command;  ///< as typed
  std::string engine, isa;
  int threads = 1;
};

/// A run while it happens: hits and samples go to the file in batches, which readers can follow
/// (HDF5's SWMR mode). A file that is not finished is removed, unless the process is killed: then it
/// stays readable, with the attribute `complete` still 0.
class RunArchive : public Observer {
 public:
  static std::unique_ptr<RunArchive> create(const std::string& file, const LoadedSystem&, const Provenance&,
                                            bool force, std::uint64_t trajectory = 0);
  /// Goes on with the run stored in `source`: works on a copy TARGET.part, which becomes `target`
  /// (often the source itself) when finished.
  static std::unique_ptr<RunArchive> extend(const std::string& source, const std::string& target,
                                            const LoadedSystem&, const Provenance&, bool force);
  ~RunArchive() override;

  void hit(const HitEvent&) override;
  void contact(const ContactEvent&) override;
  void sample(int particle, Time, const State&) override;
  void sampled(Time) override;
  void finish(const SingleRunResult&, const std::string& status);

 private:
  class Implementation;
  explicit RunArchive(std::unique_ptr<Implementation>);
  std::unique_ptr<Implementation> implementation_;
};

/// A run as its archive holds it.
struct StoredRun {
  std::string system_name, system_toml, status;
  std::string engine;  ///< "events", "steps" or "auto"
  std::vector<ParticleProgress> particles;
};
/// Throws InputError for anything but the archive of a finished or interrupted run.
StoredRun read_run(const std::string& file);

/// An ensemble's result: written to FILE.part, synced, renamed. Removed unless finished.
class EscapeArchive {
 public:
  EscapeArchive(const std::string& file, const LoadedSystem&, const Provenance&, bool force,
                bool per_trajectory);
  EscapeArchive(const EscapeArchive&) = delete;
  ~EscapeArchive();

  void append(const std::vector<TrajectoryRecord>&);
  void finish(const EscapeResult&, const std::string& status);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// The points of a section, orbit after orbit; written like an EscapeArchive.
class SectionArchive {
 public:
  SectionArchive(const std::string& file, const LoadedSystem&, const Provenance&, bool force);
  SectionArchive(const SectionArchive&) = delete;
  ~SectionArchive();

  void append(const std::vector<SectionPoint>&);
  void finish(const SectionResult&, const std::string& status);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// The moments of a diffusing ensemble, written like an EscapeArchive.
class DiffusionArchive {
 public:
  DiffusionArchive(const std::string& file, const LoadedSystem&, const Provenance&, bool force);
  DiffusionArchive(const DiffusionArchive&) = delete;
  ~DiffusionArchive();

  void finish(const DiffusionResult&, const std::vector<MomentPoint>&, const std::string& status);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace carom
