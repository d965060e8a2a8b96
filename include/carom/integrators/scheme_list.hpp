// What integrators there are, in words: `carom schemes`.
#pragma once

#include <string_view>
#include <vector>

namespace carom {

/// One integrator. A step of order p errs by O(h^(p+1)).
struct SchemeDescription {
  std::string_view name;
  int order = 0;   ///< 0: varies
  int stages = 0;  ///< evaluations of all forces a step, after the first one; 0: varies
  bool adaptive = false, symmetric = false, symplectic = false;
  bool quadratic = false;  ///< Runge–Kutta–Nyström: Scheme::quadratic
  std::string_view kind;   ///< in a few words
  std::string_view source;
};

/// All schemes with fixed steps, by order, then the adaptive ones.
const std::vector<SchemeDescription>& scheme_descriptions();

}  // namespace carom
