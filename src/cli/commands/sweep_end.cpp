// What becomes of a sweep that was computed: its archive, its report. Python uses it without ranks.
#include "carom/files/archive.hpp"
#include "cli/commands/sweep.hpp"
#include "cli/common.hpp"
#include "files/checkpoint/sweep_archive.hpp"

namespace carom::cli {

namespace {

// What is written of a sweep needs no step.
SystemOverrides without_step() {
  SystemOverrides overrides;
  overrides.choose_step = false;
  return overrides;
}

}  // namespace

void print_sweep(const Options& options, SweepResult& result, const std::string& file) {
  const System base =
      read_system(result.plan.system_toml, result.plan.system_name, without_step()).system;
  result.title = base.title.empty() ? base.name : base.title;
  result.archive = named_archive(options, file);
  print_report(
      options, [&] { return sweep_json(result); }, [&] { return sweep_text(result); });
}

void keep_sweep(const Options& options, const SweepResult& result, const std::string& file,
                const std::vector<Origin>& before) {
  LoadedSystem base = read_system(result.plan.system_toml, result.plan.system_name, without_step());
  if (options.command != "relax") choose_engine(options.engine, base.system);
  Provenance origin = provenance_of(options, base.system, threads_of(options));
  origin.before = before;
  files::write_sweep(file, base, result.plan, sweep_numbers(result), origin, result.status,
                     result.status == "completed");
}

void end_sweep(const Options& options, SweepResult& result, const std::string& file,
               const std::vector<Origin>& before) {
  if (!file.empty()) keep_sweep(options, result, file, before);
  print_sweep(options, result, file);
}

}  // namespace carom::cli
