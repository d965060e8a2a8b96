// The engine beside the maps: tables by name, and orbits as lists of hits.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "carom/events/world.hpp"
#include "carom/table/table.hpp"

namespace carom::witness {

inline Table table(const std::string& shape,
                   std::initializer_list<std::pair<std::string, std::string>> numbers,
                   std::vector<HoleSpec> holes = {}) {
  TableSpec spec;
  spec.shape = shape;
  for (const auto& [name, text] : numbers) spec.numbers.emplace(name, ExactNumber(text, Place{}));
  spec.holes = std::move(holes);
  return build_table(spec);
}

/// Keeps every hit of one particle.
class Recorder : public Observer {
 public:
  void hit(const HitEvent& event) override { hits.push_back(event); }
  void end(const EndEvent& event) override { ended.push_back(event); }
  std::vector<HitEvent> hits;
  std::vector<EndEvent> ended;
};

/// The first `count` hits from a state.
inline std::vector<HitEvent> orbit(const Table& table, const Particle& particle, const State& start,
                                   std::uint64_t count) {
  World world(table);
  world.add(particle, start);
  world.limit_hits(count);
  Recorder recorder;
  recorder.hits.reserve(count);
  world.run_until(1e300, recorder);
  return std::move(recorder.hits);
}

}  // namespace carom::witness
