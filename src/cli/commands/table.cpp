// carom table: checks, measures and draws a table.
#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>

#include "carom/base/error.hpp"
#include "carom/ensemble/stopwatch.hpp"
#include "cli/commands/commands.hpp"
#include "cli/common.hpp"
#include "cli/reports/table_report.hpp"
#include "cli/reports/table_svg.hpp"
#include "io/checkpoint/work_folder.hpp"
#include "io/progress.hpp"

namespace carom::cli {

namespace {

// Aside, then renamed: a drawing is there whole or not at all.
void write_file(const std::string& name, const std::string& text) {
  const std::string part = aside_of(name);
  errno = 0;
  std::FILE* file = std::fopen(part.c_str(), "w");
  bool ok = file && std::fwrite(text.data(), 1, text.size(), file) == text.size();
  ok = file && std::fclose(file) == 0 && ok;
  ok = ok && std::rename(part.c_str(), name.c_str()) == 0;
  if (ok) return;
  throw InputError(fmt::format("cannot write '{}': {}", name, std::strerror(errno)));
}

}  // namespace

int table(const Options& options) {
  const Stopwatch watch;
  ArchiveLock lock;
  if (!options.output.empty()) {
    if (!options.output.ends_with(".svg"))
      throw InputError(Place{options.output, 0, 0, ""}, "a table is drawn as SVG",
                       "a name ending in .svg");
    lock = lock_output(options.output);
    refuse_existing(options.output, options.force);
  }
  std::optional<Progress> preparing(std::in_place, !options.quiet);
  const LoadedSystem loaded = load_system(options.system, options.overrides);
  const System& system = loaded.system;
  const TableMeasure measured = measure(*system.table);
  preparing.reset();
  if (!options.output.empty()) write_file(options.output, table_svg(*system.table, system.title));
  if (!options.json) {
    print(table_text(system, measured, options.output, options.verbose));
    return done;
  }
  print(table_json(system, measured, options.output, watch).text() + "\n");
  return done;
}

}  // namespace carom::cli
