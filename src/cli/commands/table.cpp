// carom table: checks, measures and draws a table.
#include <optional>
#include <string>

#include "carom/base/error.hpp"
#include "carom/base/stopwatch.hpp"
#include "cli/commands/commands.hpp"
#include "cli/common.hpp"
#include "cli/picture.hpp"
#include "cli/reports/table_report.hpp"
#include "files/checkpoint/work_folder.hpp"
#include "files/progress.hpp"
#include "files/toml/value.hpp"

namespace carom::cli {

namespace {

// The system as it is drawn: a file without a title is known by its name.
std::string with_title(const LoadedSystem& loaded) {
  if (!loaded.system.title.empty()) return loaded.resolved_toml;
  files::Value root = files::parse_document(loaded.resolved_toml, loaded.system.name);
  root.set("title", files::text_value(loaded.system.name, root.place));
  return files::print_document(root);
}

}  // namespace

int table(const Options& options) {
  const Stopwatch watch;
  if (!options.output.empty()) {
    refuse_other_endings(options.output);
    refuse_existing(options.output, options.force);
  }
  std::optional<files::Progress> preparing(std::in_place, !options.quiet);
  const LoadedSystem loaded = load_system(options.system, options.overrides);
  const System& system = loaded.system;
  const TableMeasure measured = measure(*system.table);
  preparing.reset();
  if (!options.output.empty()) {
    const TemporaryFolder folder;
    const std::string file = folder.file("table.toml");
    if (!files::write_new_file(file, with_title(loaded)))
      throw InputError("cannot write '" + file + "'");
    if (const int status = draw(file, options.output, options.force); status != done) return status;
  }
  if (!options.json) {
    print(table_text(system, measured, options.output, options.verbose));
    return done;
  }
  print(table_json(loaded, measured, options.output, watch.seconds(), watch.cpu_seconds()).text() +
        "\n");
  return done;
}

}  // namespace carom::cli
