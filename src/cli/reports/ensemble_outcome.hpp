// Ensembles as outcomes.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "carom/files/ensembles.hpp"
#include "cli/outcome.hpp"
#include "cli/reports/ensemble_context.hpp"

namespace carom::cli {

class EnsembleOutcome : public Outcome {
 public:
  using Outcome::Outcome;
  std::string status;
  std::optional<std::vector<TrajectoryRecord>> records;  ///< in order of index; none: not asked for
  mutable std::shared_ptr<const void> rows;              ///< the same for Python, once it has asked
};

template <class Result>
class OutcomeOf final : public EnsembleOutcome {
 public:
  using EnsembleOutcome::EnsembleOutcome;
  files::Json json() const override { return result_json(system(), result, {status, "", {}}); }
  std::string text() const override { return result_text(system(), result, {status, "", {}}); }
  std::vector<std::string> doubts() const override { return doubts_of(system(), result).lines; }
  void save(const std::string& file, bool force, const std::atomic<bool>& stop) const override;

  Result result;
};

}  // namespace carom::cli
