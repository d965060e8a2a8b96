
#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <vector>

#include "analyses/diffusion/report.hpp"
#include "carom/starts/start_measure.hpp"
#include "carom/table/table.hpp"
#include "cli/common.hpp"
#include "cli/reports/aligned.hpp"

namespace carom::cli {

using files::Json;

namespace {

// pi area / perimeter, where every particle can come to a wall, none leaves, and walls keep uniform
// positions. The centres of discs are bounded by other curves than the walls.
std::optional<double> expected_mean(const System& system, const DiffusionResult& result) {
  const double mean = measure(*system.table).mean_flight;
  if (result.pinned > 0 || result.capped > 0 || result.escaped > 0 || result.unbounded > 0 ||
      system.of_discs() || !std::isfinite(mean) || !why_not_uniform(system).empty())
    return std::nullopt;
  return mean;
}

Json distribution_json(const FreePathDistribution& d) {
  Json bins = Json::array();
  for (const FreePathBin& bin : d.bins)
    bins.push(Json::object()
                  .set("from", bin.from)
                  .set("to", bin.to)
                  .set("count", bin.count)
                  .set("density", bin.density.value)
                  .set("density_stderr", bin.density.error)
                  .set("longer", bin.longer.value)
                  .set("longer_stderr", bin.longer.error));
  Json tail;
  if (d.tail)
    tail = Json::object()
               .set("from", d.tail->from)
               .set("to", d.tail->to)
               .set("exponent", estimate_json(d.tail->exponent))
               .set("amplitude", estimate_json(d.tail->amplitude));
  return Json::object()
      .set("flights", d.all)
      .set("longer", d.longer)
      .set("bins", std::move(bins))
      .set("tail", std::move(tail));
}

std::string table_of(const FreePathDistribution& d, const EnsembleContext& context) {
  std::vector<double> lengths;
  std::vector<std::string> density, longer;
  for (const std::size_t row : every_kth(d.bins.size(), context.rows)) {
    const FreePathBin& bin = d.bins[row];
    lengths.push_back(bin.from);
    density.push_back(with_error(bin.density));
    longer.push_back(with_error(bin.longer));
  }
  return fitted({{"length l", times_text(lengths)},
                 {"density in the bin from l", density},
                 {"fraction of l or longer", longer}}) +
         rows_text(d.bins.size(), context);
}

std::string tail_text(const FreePathDistribution& d, const char* amplitude) {
  if (!d.tail) return {};
  return fmt::format(
      "fraction of longer flights ~ l^-a, {:.6g} <= l <= {:.6g}: a = {}\n{} at l = {:.6g}: {}\n",
      d.tail->from, d.tail->to, cli::with_error(d.tail->exponent), amplitude, d.tail->to,
      with_error(d.tail->amplitude));
}

}  // namespace

Json free_paths_json(const System& system, const DiffusionResult& result) {
  if (!result.free_paths.counted()) return {};
  const FreePaths paths = free_paths_of(result.free_paths);
  Json json = Json::object();
  json.set("limit", paths.limit);
  json.set("mean", estimate_json(paths.mean));
  const std::optional<double> expected = expected_mean(system, result);
  json.set("expected_mean", expected ? Json(*expected) : Json());
  json.set("between_hits", distribution_json(paths.between));
  json.set("at_start", distribution_json(paths.at_start));
  return json;
}

std::string free_paths_text(const System& system, const DiffusionResult& result,
                            const Horizon& horizon, const EnsembleContext& context) {
  if (!result.free_paths.counted()) return {};
  const FreePaths paths = free_paths_of(result.free_paths);
  const bool corridors = horizon.kind == Horizon::Kind::infinite;
  std::string text =
      fmt::format("\nFree paths between hits: {} flights, {} of {:.6g} or longer\n",
                  grouped(paths.between.all), grouped(paths.between.longer), paths.limit);
  text += table_of(paths.between, context);
  if (std::isfinite(paths.mean.value))
    text += "mean " + with_error(paths.mean);
  else
    text += "there is no mean: no particle has hit a wall";
  if (const std::optional<double> expected = expected_mean(system, result))
    text += fmt::format("   (pi area / perimeter = {:.6g})", *expected);
  text += "\n";
  if (corridors) text += tail_text(paths.between, "l^2 times the fraction, over the mean,");
  text += fmt::format("\nFree paths from the start: {} flights, {} of {:.6g} or longer\n",
                      grouped(paths.at_start.all), grouped(paths.at_start.longer), paths.limit);
  text += table_of(paths.at_start, context);
  if (corridors) text += tail_text(paths.at_start, "l times the fraction");
  return text;
}

}  // namespace carom::cli
