// carom validate: the engine against identities and published values.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "files/json.hpp"
#include "validation/cases/cases.hpp"

namespace carom::cli {

/// The cases that were run, each with what came out.
struct Validation {
  struct Done {
    validation::Case of;
    validation::Check check;
  };
  std::vector<Done> cases;
  bool complete = true;
  int passed() const;
  int failed() const;
};
/// Runs what `soak` and `scale` ask for. `before` is called with each case and the share of the
/// cases done, `after` when it has run.
Validation run_validation(const Options&, const validation::CheckOptions&,
                          const std::function<void(double share, const std::string& name)>& before,
                          const std::function<void(const Validation::Done&)>& after);
files::Json validation_json(const Validation&);
/// `verbose`: with the seed and the digest.
std::string text_of(const Validation::Done&, bool verbose = false);
/// The last line.
std::string summary_of(const Validation&);

}  // namespace carom::cli
