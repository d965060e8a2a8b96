// What a comparison of integrators says.
#pragma once

#include <string>

#include "carom/analyses/compare.hpp"
#include "cli/options.hpp"
#include "cli/outcome.hpp"
#include "files/json.hpp"

namespace carom::cli {

/// `verbose`: every run, not the schemes alone. `archive`: its name, "": none.
std::string compare_text(const System&, const Comparison&, const std::string& archive,
                         bool verbose);
files::Json compare_json(const System&, const Comparison&, const std::string& archive);

struct ComparisonOutcome final : Outcome {
  using Outcome::Outcome;
  files::Json json() const override { return compare_json(system(), result, ""); }
  std::string text() const override { return compare_text(system(), result, "", false); }
  void save(const std::string& file, bool force, const std::atomic<bool>& stop) const override;

  Comparison result;
};

/// Throws InputError for steps, tolerances and errors that are none.
ComparePlan compare_plan(const Options&);

}  // namespace carom::cli
