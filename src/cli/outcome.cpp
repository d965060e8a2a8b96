#include "cli/outcome.hpp"

#include <fmt/format.h>

#include <utility>

#include "carom/analyses/kinds.hpp"
#include "carom/base/error.hpp"
#include "carom/files/archive.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/ensemble_job.hpp"
#include "cli/common.hpp"
#include "cli/loading.hpp"

namespace carom::cli {

void Outcome::save(const std::string&, bool, const std::atomic<bool>&) const {
  throw InputError(Place{}, "no archive holds such a result", "its report");
}

OutcomePointer open_outcome(const std::string& file) {
  const std::string kind = kind_of_archive(file);
  if (is_ensemble(kind)) return open_ensemble(file);
  static constexpr std::pair<const char*, OutcomePointer (*)(const std::string&)> others[] = {
      {"run", open_run},     {"certified", open_certified}, {"section", open_section},
      {"relax", open_relax}, {"orbit", open_orbits},        {"compare", open_comparison}};
  for (const auto& [name, open] : others)
    if (kind == name) return open(file);
  throw InputError(Place{file, 0, 0, ""}, fmt::format("'{}' holds a {}", file, kind),
                   "the archive of a result");
}

LoadedPointer loaded_again(const std::string& command, const std::string& toml,
                           const std::string& name, const std::string& file,
                           const std::string& engine) {
  auto loaded = std::make_shared<Loaded>();
  loaded->options.command = command;
  loaded->options.system = file + ": /system";
  loaded->options.system_text = toml;
  loaded->options.engine = engine == "steps" ? "steps" : "auto";
  loaded->loaded = system_of_command(loaded->options);
  loaded->loaded.system.name = name;
  return loaded;
}

LoadedSystem system_of_command(const Options& options) {
  const std::string& command = options.command;
  if (command == "escape") check_escape_options(options);
  if (is_ensemble(command)) return load_ensemble(options);
  if (command == "run") return system_of_run(options);
  if (command == "section") return system_of_section(options);
  if (command == "compare") return system_of_compare(options);
  return load_typed(options);
}

}  // namespace carom::cli
