#include "events/step/force_regions.hpp"

#include <cmath>

#include "carom/base/error.hpp"
#include "events/step/surroundings.hpp"

namespace carom::events {

namespace {

bool acts(const Dynamics& d) { return d.forces && !d.forces->empty(); }
bool acts_everywhere(const Dynamics& d) {
  const bool far = acts(d) && d.forces->interacts() && !std::isfinite(d.forces->pair_range());
  return d.everywhere || far || (acts(d) && d.forces->everywhere());
}

}  // namespace

Table table_with_supports(const Table& table, const Dynamics& dynamics) {
  Table result;
  if (!acts(dynamics) || acts_everywhere(dynamics)) return result;
  result = table;
  result.crossing = !table.walls.empty();
  for (const Support& support : dynamics.forces->supports()) {
    Wall edge;
    edge.name = "support";
    edge.curve = geometry::Circle{support.center, support.radius, false};
    edge.next = edge.previous = static_cast<int>(result.walls.size());
    result.walls.push_back(edge);
  }
  return result;
}

ForceRegions::ForceRegions(const Table& table, const Table& walls, const Dynamics& dynamics)
    : wall_count_(static_cast<int>(table.walls.size())),
      any_(acts(dynamics) || dynamics.everywhere),
      everywhere_(acts_everywhere(dynamics)) {
  if (acts(dynamics) && dynamics.forces->interacts()) {
    by_range_ = !dynamics.everywhere && std::isfinite(dynamics.forces->pair_range());
    one_group_ = !by_range_;
    if (by_range_ && !(dynamics.integrator.step > 0.0))
      throw InputError(Place{{}, 0, 0, "integrator.step"},
                       "particles that meet within a range need the length of a step",
                       "a time > 0");
  }
  if (!any_) return;
  std::vector<geometry::Curve> curves;  // what is inside a support is integrated
  for (std::size_t i = table.walls.size(); i < walls.walls.size(); ++i)
    curves.push_back(geometry::reversed(walls.walls[i].curve));
  edges_ = barriers_of_edges(curves, table);
  for (Barrier<double>& edge : edges_) edge.wall += wall_count_;
}

bool ForceRegions::hold(geometry::Vector x) const {
  return everywhere_ || in_some_support(edges_, x, nullptr);
}

}  // namespace carom::events
