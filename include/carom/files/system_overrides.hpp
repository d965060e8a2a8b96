// What the command line changes in a system: text alone, so that parsing a command line needs no
// system.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace carom {

/// Options of the command line that change a system. Values are text; one parser reads them.
struct SystemOverrides {
  std::vector<std::pair<std::string, std::string>> set;  ///< --set path.to.key=value
  std::string seed, trajectories, t_max, collisions, times, position, velocity, trust_tolerance,
      window;  ///< "" : not given
  /// Does a system under forces without a step get one? Nothing is integrated with one that does
  /// not.
  bool choose_step = true;
};

}  // namespace carom
