// ./dev bench [NAME…]: the rows whose names begin with one of these, or all. --help lists them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "measuring.hpp"
#include "table.hpp"

namespace carom::bench {

Report::Report(Aim aim, std::vector<std::string> wanted) : aim_(aim) {
  if (aim_ == Aim::list) return;
  for (std::string& name : wanted) wanted_.push_back({std::move(name)});
  fmt::print("CPU time, the least of several runs; a link: 1 + 1/sqrt(x), {:.2f} ns here\n\n",
             chain());
  fmt::print("{:<38} {:<10} {:>10} {:>8}  {:<21} {:>8}  {}\n", "what", "path", "ns", "links",
             "against", "times", "check");
}

bool Report::wants(std::string_view what) {
  if (aim_ == Aim::list) {
    if (listed_.emplace(what).second) fmt::print("  {}\n", what);
    return false;
  }
  bool any = wanted_.empty();
  for (Name& name : wanted_)
    if (what.starts_with(name.begin)) any = name.found = true;
  return any;
}

void Report::add(const Line& line) {
  wrong_ = wrong_ || !line.right;
  const std::string against = line.against.empty()
                                  ? fmt::format("{:<30}", "")
                                  : fmt::format("{:<21} {:>8.3g}", line.against, line.ratio);
  fmt::print("{:<38} {:<10} {:>10.4g} {:>8.3g}  {}  {}{}\n", line.what, line.path, line.each,
             line.links, against, line.check, line.right ? "" : "  WRONG");
  std::fflush(stdout);
}

bool Report::failed() const {
  for (const Name& name : wanted_)
    if (!name.found) fmt::print(stderr, "bench: no row begins with '{}'\n", name.begin);
  return wrong_ ||
         std::any_of(wanted_.begin(), wanted_.end(), [](const Name& name) { return !name.found; });
}

}  // namespace carom::bench

int main(int argc, char** argv) {
  using namespace carom::bench;
  const std::vector<std::string> names(argv + 1, argv + argc);
  const bool help = std::any_of(names.begin(), names.end(), [](const std::string& name) {
    return name == "--help" || name == "-h";
  });
  if (help) fmt::print("bench [NAME...]: measures the rows whose names begin so, or all of\n");
  Report report = help ? Report(Report::Aim::list) : Report(Report::Aim::measure, names);
  for (const auto& rows :
       {straight_and_larmor_flights, flights_in_lanes, steps_under_forces, questions_of_resolution,
        groups_at_walls, contacts_of_hard_discs, certified_orbits, periodic_orbits, comparisons,
        whole_ensembles, records_of_runs})
    rows(report);
  return report.failed() ? 1 : 0;
}
