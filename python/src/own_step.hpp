// Results whose system is flown again with half the step that was chosen for it, as the program
// does.
#pragma once

#include <exception>
#include <memory>
#include <optional>

#include "cli/commands/own_step.hpp"
#include "loaded.hpp"
#include "run_in_background.hpp"

namespace carom::python {

/// Calls `fly` in the background until the energy holds or half the step helps no more. `fly` flies
/// `outcome.system()` from the start and returns the error of the energy; none: it was stopped.
/// The outcome's system has the last step.
template <class Fly>
std::exception_ptr fly_with_own_step(Outcome& outcome, Course& course,
                                     const pybind11::object& progress, Fly fly) {
  outcome.own_step.emplace(outcome.loaded->options, [](const std::string&) {});
  for (;;) {
    std::optional<EnergyError> error;
    const std::exception_ptr interruption =
        run_in_background(course, progress, [&] { error = fly(); });
    if (interruption || !error) return interruption;
    const auto next = std::make_shared<Loaded>(*outcome.loaded);
    if (!outcome.own_step->halve(next->loaded, *error)) return nullptr;
    outcome.loaded = next;
  }
}

}  // namespace carom::python
