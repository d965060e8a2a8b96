// The systems that the page has loaded.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calls.hpp"
#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"
#include "carom/geometry/curve_frame.hpp"
#include "carom/starts/sampler.hpp"

namespace carom::page {

/// Starts of one kind. They are read when a state is drawn, so they may change.
struct Starts {
  System system;
  Sampler sampler;

  /// Throws InputError where the particles cannot start so.
  explicit Starts(System with) : system(std::move(with)), sampler(system) {}
  Starts(const Starts&) = delete;
};

struct OpenSystem {
  std::string toml, name;
  LoadedSystem loaded;
  std::vector<geometry::CurveFrame> frames;
  std::vector<double> offsets;  ///< arc length where each wall begins; last the length of all
  World world;                  ///< without particles

  /// Throws InputError.
  explicit OpenSystem(std::string text);
  OpenSystem(const OpenSystem&) = delete;
  const System& system() const { return loaded.system; }
  /// Those of the file, and others in their place: a point, or a place of the boundary.
  Starts& starts();
  Starts& starts_at(InitialCondition::Kind);

 private:
  std::optional<Starts> starts_;
  std::map<InitialCondition::Kind, Starts> others_;
};

/// Throws InputError where it is not loaded.
std::shared_ptr<OpenSystem> system_of(const Request&);
/// Walls as lines, numbers that a slider can change, and what else the page draws.
Json outline(const OpenSystem&);

}  // namespace carom::page
