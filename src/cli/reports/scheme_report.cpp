#include "cli/reports/scheme_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "carom/integrators/scheme.hpp"
#include "cli/commands/commands.hpp"
#include "cli/common.hpp"
#include "cli/reports/aligned.hpp"

namespace carom::cli {

using files::Json;

namespace {

Json number_or_null(int number) { return number > 0 ? Json(number) : Json(); }

}  // namespace

std::string schemes_text() {
  std::vector<Column> columns{
      {"scheme", {}, true}, {"order", {}}, {"forces\na step", {}}, {"kind", {}, true}};
  std::size_t width = 0;
  for (const SchemeDescription& scheme : scheme_descriptions()) {
    const auto number = [](int n) { return n > 0 ? fmt::format("{}", n) : std::string("-"); };
    columns[0].cells.emplace_back(scheme.name);
    columns[1].cells.push_back(number(scheme.order));
    columns[2].cells.push_back(number(scheme.stages));
    columns[3].cells.emplace_back(scheme.kind);
    width = std::max(width, columns[0].cells.back().size());
  }
  std::string sources = "\nSources\n";
  for (const SchemeDescription& scheme : scheme_descriptions())
    sources += folded(fmt::format("  {:<{}}  {}", scheme.name, width, scheme.source),
                      std::string(width + 4, ' ')) +
               '\n';
  return aligned(columns) + sources;
}

Json schemes_json() {
  Json list = Json::array();
  for (const SchemeDescription& scheme : scheme_descriptions())
    list.push(Json::object()
                  .set("name", scheme.name)
                  .set("order", number_or_null(scheme.order))
                  .set("stages", number_or_null(scheme.stages))
                  .set("kind", scheme.kind)
                  .set("adaptive", scheme.adaptive)
                  .set("symmetric", scheme.symmetric)
                  .set("symplectic", scheme.symplectic)
                  .set("quadratic", scheme.quadratic)
                  .set("source", scheme.source));
  Json json = Json::object();
  add_common_keys(json, System{}, 1, 0.0, 0.0);
  return json.set("schemes", std::move(list));
}

int schemes(const Options& options) {
  print_report(options, schemes_json, schemes_text);
  return done;
}

}  // namespace carom::cli
