#include "cli/reports/ensemble_context.hpp"

#include "cli/common.hpp"

namespace carom::cli {

Json ensemble_json(const System& system, const EnsembleResult& result,
                   const EnsembleContext& context) {
  Json json = Json::object();
  add_common_keys(json, system, result.threads, result.seconds, result.cpu_seconds,
                  result.lanes ? name_of(*result.lanes) : "baseline");
  json.set("ranks", result.ranks).set("status", context.status);
  if (context.shard.of > 1) json.set("shard", text_of(context.shard));
  return json;
}

}  // namespace carom::cli
