// Coefficients of an explicit Runge–Kutta method with an error estimate.
#pragma once

#include <string_view>
#include <vector>

namespace carom::integrators {

/// Stage i is the derivative at y + h sum_j stage[i][j] k_j, for the time time[i] h; a step is
/// y + h sum_i weight[i] k_i, and its estimated error the difference to the same sum with
/// `embedded`. Decimals with all digits that are known; rows end before the diagonal.
struct EmbeddedTable {
  int order, embedded_order;
  std::vector<std::string_view> time;
  std::vector<std::vector<std::string_view>> stage;
  std::vector<std::string_view> weight, embedded;
  std::string_view source;
};

/// 16 stages, order 9 with an estimate of order 8. The stages that the estimate weighs lie at 0,
/// 0.07, 0.25, 0.48, 0.65, 0.66, 0.82, 0.90 and 1: nowhere is more than a quarter of the step out
/// of sight.
const EmbeddedTable& verner_9_8();

}  // namespace carom::integrators
