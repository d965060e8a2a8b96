#include "analyses/run/report_outcome.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "analyses/run/report.hpp"
#include "analyses/run/stored_run.hpp"
#include "carom/analyses/run/archive.hpp"
#include "carom/base/error.hpp"
#include "carom/events/world.hpp"
#include "carom/files/archive.hpp"
#include "carom/starts/sampler.hpp"
#include "cli/common.hpp"
#include "cli/reports/doubts.hpp"

namespace carom::cli {

files::Json RunOutcome::json() const { return run_json(system(), result, status, ""); }
std::string RunOutcome::text() const { return run_text(system(), result, status, ""); }
std::vector<std::string> RunOutcome::doubts() const { return doubts_of(system(), result).lines; }

void RunOutcome::save(const std::string& file, bool force, const std::atomic<bool>& stop) const {
  const auto archive =
      RunArchive::create(followed(file), loaded->loaded,
                         provenance_of(loaded->options, system(), 1), force, trajectory);
  const auto append = [&](const auto& rows) {
    for (const auto& row : rows) {
      if (stop.load(std::memory_order_relaxed)) return false;
      archive->append(row);
    }
    return true;
  };
  archive->start(starts);
  if (append(*hits.get()) && append(*contacts.get()) && append(*samples.get()) &&
      append(*energies.get()))
    archive->finish(result, status);
}

namespace {

// The file that was opened, as long as it is the same.
class OpenedFile {
 public:
  explicit OpenedFile(std::string name) : name_(std::move(name)), at_first_(now()) {}
  template <class Row>
  Rows<Row> rows(std::vector<Row> (*read)(const std::string&)) const {
    return Rows<Row>([file = *this, read] {
      if (file.now() != file.at_first_)
        throw InputError(Place{file.name_, 0, 0, ""}, "changed since it was opened",
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

// Sees whether a run that has ended goes on all the same.
struct Ended : Observer {
  bool goes_on = false;
  void hit(const HitEvent&) override { goes_on = true; }
  void contact(const ContactEvent&) override { goes_on = true; }
};

}  // namespace

// A stored run is asked to go on where it has ended: no event comes, and the end is reported again.
OutcomePointer open_run(const std::string& file) {
  const OpenedFile opened(file);
  const StoredRun stored = read_run(file);
  auto outcome = std::make_shared<RunOutcome>(
      loaded_again("run", stored.system_toml, stored.system_name, file, stored.engine));
  System& system = outcome->loaded->loaded.system;
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
  outcome->result = run_single(system, ended, how);
  if (ended.goes_on)
    throw InputError(Place{file, 0, 0, ""}, "'/state' is not where the run ended",
                     "an archive as carom wrote it");
  outcome->result.seconds = stored.seconds;
  outcome->result.cpu_seconds = stored.cpu_seconds;
  if (system.has_forces()) outcome->result.no_state_error = "archives do not store it";
  outcome->starts = read_starts(file);
  outcome->status = stored.status;
  outcome->trajectory = stored.trajectory;
  outcome->hits = opened.rows(read_hits);
  outcome->samples = opened.rows(read_samples);
  outcome->contacts = opened.rows(read_contacts);
  outcome->energies = opened.rows(read_energies);
  return outcome;
}

}  // namespace carom::cli
