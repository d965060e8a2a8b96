// A step that the program chose and that keeps the energy too badly is halved.
#pragma once

#include <string>

#include "carom/events/energy.hpp"
#include "cli/common.hpp"
#include "cli/options.hpp"
#include "files/json.hpp"

namespace carom {
struct LoadedSystem;
}

namespace carom::cli {

/// The step of a command that flies its system from the start. A step of the user's stays, and so
/// does that of a part: of a shard, of what goes on.
class OwnStep {
 public:
  using Say = void (*)(const std::string&);
  /// `say`: where it says that it halves.
  explicit OwnStep(const Options&, Say say = warn);

  /// Is all to begin again, as the energy changed by more than integrator.energy_tolerance and half
  /// the step may help? Then it halves the step, and says so. It helps no more where the last half
  /// has not halved the error.
  bool halve(LoadedSystem&, const EnergyError&);

  /// A report with the key `step_halvings`, and a line of a text; nothing where there were none.
  files::Json with_halvings(files::Json report) const;
  std::string text() const;

 private:
  bool may_;
  Say say_;
  int halvings_ = 0;
  double error_ = 0.0;  ///< with the step before
};

}  // namespace carom::cli
