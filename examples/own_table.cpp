// A table of your own with a hole and an obstacle, and the escape from it.
#include <carom/carom.hpp>
#include <cstdio>

int main() {
  const auto table = carom::polygon({{0, 0}, {2, 0}, {2, 1}, {0, 1}})
                         .hole("side_1", {.center = 1, .width = 0.2})
                         .obstacle(carom::disc({1, 0.5}, 0.2));
  const auto system = carom::make_system(table, {.t_max = 100, .trajectories = 20000});
  const auto result = carom::escape(system);
  for (const carom::SurvivalPoint& point : carom::survival(result.counts))
    std::printf("p(%g) = %g\n", point.t, point.p);
  return result.counts.escaped > 18000 ? 0 : 1;
}
