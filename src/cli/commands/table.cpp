// carom table: checks, measures and draws a table.
#include <optional>

#include "carom/base/error.hpp"
#include "carom/ensemble/stopwatch.hpp"
#include "cli/commands/commands.hpp"
#include "cli/common.hpp"
#include "cli/reports/table_report.hpp"
#include "cli/reports/table_svg.hpp"
#include "io/progress.hpp"

namespace carom::cli {

int table(const Options& options) {
  const Stopwatch watch;
  ArchiveLock lock;
  if (!options.output.empty()) {
    if (!options.output.ends_with(".svg"))
      throw InputError(Place{options.output, 0, 0, ""}, "a table is drawn as SVG",
                       "a name ending in .svg");
    lock = lock_output(options, options.output);
    refuse_existing(options.output, options.force);
  }
  std::optional<io::Progress> preparing(std::in_place, !options.quiet);
  const LoadedSystem loaded = load_system(options.system, options.overrides);
  const System& system = loaded.system;
  const TableMeasure measured = measure(*system.table);
  preparing.reset();
  if (!options.output.empty()) write_file(options.output, table_svg(*system.table, system.title));
  if (!options.json) {
    print(table_text(system, measured, options.output, options.verbose));
    return done;
  }
  print(table_json(loaded, measured, options.output, watch.seconds(), watch.cpu_seconds()).text() +
        "\n");
  return done;
}

}  // namespace carom::cli
