// Lanes of free particles, which go from hit to hit.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "carom/events/world.hpp"
#include "carom/lanes/lanes.hpp"
#include "carom/table/table.hpp"

namespace carom {

class FreeLanes : public Lanes {
 public:
  /// What keeps such particles out of lanes, as a phrase ("more than 64 walls…"); "" where nothing
  /// does: straight flights, or Larmor circles that all turn the same way, between segments,
  /// circles and ellipses: at most 64 pieces. On a lattice among discs that lie inside the cell;
  /// Larmor circles there that come to at most 64 pieces.
  static std::string hindrance(const Table&, const std::vector<Particle>&);

  /// `particles` suit, and every start is one of them. Keeps a reference to the table, which must
  /// live as long.
  FreeLanes(const Table& table, const std::vector<Particle>& particles, InstructionSet set,
            DecisionOptions options = {});
  /// The same in the table of a world of free particles, sharing what was prepared of it.
  FreeLanes(const World& like, const std::vector<Particle>& particles, InstructionSet set);
  FreeLanes(Table&&, const std::vector<Particle>&, InstructionSet, DecisionOptions = {}) = delete;
  ~FreeLanes() override;

  void limit_hits(std::uint64_t hits) override;
  void sample_at(std::vector<double> times, Sampled sampled) override;
  void report_hits(Hit) override;
  void follow_deviations(std::vector<double> times, double unit_length, Stretched) override;
  void run_until(double t_end, const std::function<bool(LaneStart&)>& next,
                 const std::function<void(const LaneEnd&)>& ended,
                 const std::function<bool()>& interrupted = {}) override;
  void omit_end_states() override;
  DecisionCounts decisions() const override;
  const LaneEffort& effort() const override;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace carom
