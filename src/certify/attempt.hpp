// One run of an orbit from its exact start at a given precision.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include "carom/certify/certified_orbit.hpp"
#include "certify/enclosure/line_table.hpp"
#include "certify/enclosure/state_enclosure.hpp"
#include "certify/enclosure/trial_run.hpp"
#include "certify/tie.hpp"

namespace carom::certify {

/// The result of a step of an attempt.
struct Outcome {
  enum Kind : unsigned char {
    hit,
    stopped,  ///< t_max comes before the next hit
    escaped,
    unbounded,   ///< no wall follows
    dead_end,    ///< a tie at which the orbit ends (KnownTies::Joint)
    too_far,     ///< no wall within the longest flight that is followed
    undecided,   ///< more bits are needed to end `doubt`
    inaccurate,  ///< `missing_bits` more are needed
  } kind = hit;
  double missing_bits = 0.0;
  Doubt doubt;  ///< of undecided ones
};

class Attempt {
 public:
  static constexpr std::size_t longest_path = 20'000;

  /// `reading`: bits that numbers have besides the digits asked for where they are only read.
  Attempt(const ExactSystem&, const CertifiedTask&, const KnownTies&, long bits, long reading);
  Attempt(const Attempt&) = delete;
  Attempt& operator=(const Attempt&) = delete;

  Outcome step();

  /// The state after the last event (or at t_max), unwrapped, in balls.
  BallState enclosed() const;
  /// How many more are needed until each number of that state is off by less than half a unit of
  /// the last digit.
  double missing_bits(const BallState&) const;
  int wall() const { return now_.wall; }
  int hole() const { return hole_; }
  const geometry::Cell& cell() const { return now_.cell; }
  std::uint64_t hits() const { return now_.hits; }
  /// How many more the orbit may lose, nearly, until the digits asked for are not proven.
  double spare_bits() const;
  /// log2 of the largest error over the first rounding: how much was lost.
  double lost_bits() const;

  /// The direction of the start was longer or shorter than the speed.
  bool rescaled() const { return rescaled_; }
  /// The walls met so far, each copy seen from the last one; of long orbits only the beginning is
  /// kept.
  const std::vector<Copy>& path() const { return path_; }
  /// The doubt in words.
  std::string description(const Doubt&) const;

  const SceneOf<Ball>& scene() const { return arena_.scene; }
  const Whereabouts& whereabouts() const { return where_; }
  /// In the cell of the last hit.
  BallState state() const { return now_.state->state(bits_); }
  int standing() const { return now_.standing; }
  /// Does the flight of the last step end before it touches that wall?
  bool lies_behind(const Copy& touched) const {
    return std::find(behind_.begin(), behind_.end(), touched) != behind_.end();
  }

  /// log2 of the largest number of the table and the motion, not below 0: bits before the point.
  double size_bits() const;
  /// The same of an orbit `more` times as long as a forecast.
  double size_bits(const Forecast&, double more) const;
  /// Bits that roundings cost besides what the tangent map stretches, nearly.
  double rounding_loss(double hits) const;
  /// How many bits the orbit will lose from here on, by a look ahead.
  Forecast look_ahead(const std::function<bool()>& interrupted) const;

 private:
  /// All that the future depends on.
  struct Now {
    std::unique_ptr<StateEnclosure> state;
    int wall = -1;      ///< of the last hit
    int standing = -1;  ///< the wall it lies on: also that of the start
    geometry::Cell cell;
    std::uint64_t hits = 0;

    Now copy() const { return {state->clone(), wall, standing, cell, hits}; }
  };

  void set_arena(BallTable);
  std::unique_ptr<StateEnclosure> start_enclosure(const ExactSystem&);
  void trim_precision();
  Choice choose() const;
  Choice choose(const std::optional<Ball>& last) const;
  Choice choose_at(const KnownTies::Joint&) const;
  BallVector seen(const Copy&, const BallVector& P) const;
  std::optional<Ball> last_time() const;
  Sign order_with_last_time(const Ball& time) const;
  Ball meeting_time(const Copy&) const;
  Ball passing_time(const WallEnd&) const;
  void look_behind(const std::vector<Copy>& touched, const Ball& end);
  void move_to(const Copy&);
  Outcome arrive(const Copy&, const std::optional<Now>& before);
  Outcome landed(const Copy&, const std::optional<Now>& before);
  Passage pass() const;
  Outcome leave(const Now& before);
  Outcome stop_at_last_time();
  double needed_bits() const;
  double linear_bits() const;

  const ExactSystem& system_;
  const CertifiedTask& task_;
  const KnownTies& ties_;
  long first_bits_, bits_, table_bits_, reading_bits_;
  Arena arena_;
  std::optional<LineTable> lines_;  ///< where the state is followed as a line
  Whereabouts where_;
  std::optional<Ball> t_max_;

  Now now_;
  std::vector<Copy> path_, behind_;
  int hole_ = -1;
  bool rescaled_ = false;
  std::optional<BallState> stopped_;  ///< the state at t_max or in a hole
};

}  // namespace carom::certify
