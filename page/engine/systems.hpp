// The systems that the page has loaded.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "calls.hpp"
#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"
#include "carom/geometry/curve_frame.hpp"
#include "carom/starts/sampler.hpp"

namespace carom::page {

/// A system with starts of one kind. They are read when a state is drawn, so they may change.
struct Starts {
  System system;
  Sampler sampler;

  Starts(const System& other, InitialCondition::Kind kind);
  Starts(const Starts&) = delete;
};

struct OpenSystem {
  std::string toml, name;
  LoadedSystem loaded;
  std::vector<geometry::CurveFrame> frames;
  std::vector<double> offsets;  ///< arc length where each wall begins; last the length of all
  World world;                  ///< without particles
  Starts as_written, at_point, on_wall;

  /// Throws InputError.
  explicit OpenSystem(std::string text);
  OpenSystem(const OpenSystem&) = delete;
  const System& system() const { return loaded.system; }
};

/// Throws InputError where it is not loaded.
std::shared_ptr<OpenSystem> system_of(const Request&);
/// Walls as lines, numbers that a slider can change, and what else the page draws.
Json outline(const OpenSystem&);

}  // namespace carom::page
