// What the system file asks of the integration ([integrator], CONTRACT §1).
#pragma once

#include <string>

namespace carom {

struct IntegratorPlan {
  std::string scheme;      ///< a name of schemes(), a magnetic scheme, "arkode" or "cvode"; "": the default
  double step = 0.0;       ///< > 0: time between two ends of steps; 0: not given
  double tolerance = 0.0;  ///< > 0: relative tolerance of an adaptive scheme; 0: not given
  bool split_walls = false;  ///< walls = "split": walls inside the drift, for comparison only
};

}  // namespace carom
