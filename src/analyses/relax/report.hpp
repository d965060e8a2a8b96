// What `carom relax` prints.
#pragma once

#include <string>

#include "carom/analyses/relax.hpp"
#include "cli/options.hpp"
#include "cli/outcome.hpp"
#include "files/json.hpp"

namespace carom::cli {

/// What the command line says of the search (analyses/relax/command.cpp).
RelaxOptions relax_options(const Options&);

/// "minimum", "saddle", "maximum".
const char* kind_of(const Equilibrium&);
files::Json relax_json(const System&, const RelaxResult&, const std::string& output);
std::string relax_text(const System&, const RelaxResult&, const std::string& output, bool verbose);

struct RelaxOutcome final : Outcome {
  using Outcome::Outcome;
  files::Json json() const override { return relax_json(system(), result, ""); }
  std::string text() const override { return relax_text(system(), result, "", false); }
  void save(const std::string& file, bool force, const std::atomic<bool>& stop) const override;

  RelaxResult result;
};

}  // namespace carom::cli
