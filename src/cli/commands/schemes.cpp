// carom schemes: the integrators.
#include "cli/commands/commands.hpp"
#include "cli/common.hpp"
#include "cli/reports/scheme_report.hpp"

namespace carom::cli {

int schemes(const Options& options) {
  if (!options.json) {
    print(schemes_text());
    return done;
  }
  print(schemes_json().text() + "\n");
  return done;
}

}  // namespace carom::cli
