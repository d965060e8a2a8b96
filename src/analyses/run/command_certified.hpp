// carom run --precision certified.
#pragma once

#include <string>
#include <vector>

#include "carom/certify/certified_orbit.hpp"
#include "cli/outcome.hpp"

namespace carom::cli {

/// The system's options with those that belong to a run.
SystemOverrides run_overrides(const Options&);

/// Throws InputError for a system whose motion only doubles follow.
void check_form(const System&, const char* option);
/// A start that was drawn: its doubles, taken exactly.
ExactStart exact_start(const State&);

/// What the options ask for; draws the start into the system. Throws InputError where a system or
/// an option has no certified form.
CertifiedTask certified_task(const Options&, LoadedSystem&);
files::Json certified_json(const System&, const CertifiedEnd&, const CertifiedTask&,
                           const CertifiedEffort&, const std::string& output, double seconds,
                           double cpu_seconds);
std::string certified_text(const System&, const CertifiedEnd&, const CertifiedTask&,
                           const CertifiedEffort&, const std::string& output, double seconds);

int run_certified(const Options&);

struct CertifiedOutcome final : Outcome {
  using Outcome::Outcome;
  files::Json json() const override {
    return certified_json(system(), end, task, effort, "", seconds, cpu_seconds);
  }
  std::string text() const override {
    return certified_text(system(), end, task, effort, "", seconds);
  }
  void save(const std::string& file, bool force, const std::atomic<bool>& stop) const override;

  CertifiedTask task;
  CertifiedEnd end;
  CertifiedEffort effort;
  std::vector<CertifiedHit> hits;
  double seconds = 0, cpu_seconds = 0;
};

}  // namespace carom::cli
