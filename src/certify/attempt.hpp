// One run of an orbit from its exact start at a given precision.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "carom/certify/certified_orbit.hpp"
#include "certify/pilot.hpp"
#include "certify/tangent.hpp"
#include "certify/tie.hpp"

namespace carom::certify {

/// A state in balls that contain the true one.
struct BallState {
  BallVector position, velocity;
  Ball time;
};

/// What a step of an attempt came to.
struct Outcome {
  enum Kind : unsigned char {
    hit,
    stopped,     ///< t_max comes before the next hit
    escaped,
    unbounded,   ///< no wall follows
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

  Attempt(const ExactSystem&, const CertifiedTask&, const KnownTies&, long bits);

  Outcome step();

  /// The state after the last event (or at t_max), unwrapped, in balls.
  BallState enclosed() const;
  int wall() const { return now_.wall; }
  int hole() const { return hole_; }
  const geometry::Cell& cell() const { return now_.cell; }
  std::uint64_t hits() const { return now_.hits; }
  /// log2 of the largest error over the first rounding: how much was lost.
  double lost_bits() const;

  /// The direction of the start was longer or shorter than the speed.
  bool rescaled() const { return rescaled_; }
  /// The walls met so far, each copy seen from the last one; of long orbits only the beginning is kept.
  const std::vector<Copy>& path() const { return path_; }
  /// What cannot be told, with the enclosures that overlap.
  std::string description(const Doubt&);

  const SceneOf<Ball>& scene() const { return scene_; }
  const Whereabouts& whereabouts() const { return where_; }
  /// Midpoints, in the cell of the last hit.
  const BallState& state() const { return now_.state; }
  int standing() const { return now_.standing; }

  /// How many bits the orbit will lose from here on, by a look ahead.
  Forecast look_ahead(const std::function<bool()>& interrupted) const;

 private:
  /// All that the future depends on.
  struct Now {
    BallState state;  ///< midpoints
    ErrorSet errors;
    FrameOf<Interval> frame;
    int wall = -1;     ///< of the last hit
    int standing = -1; ///< the wall it lies on: also that of the start
    geometry::Cell cell;
    std::uint64_t hits = 0;
  };

  void place_start(const ExactSystem&);
  void set_interval_table();
  void trim_precision();
  Choice choose() const;
  Choice choose_at(const KnownTies::Joint&) const;
  void move_to(const Copy&);
  bool settles_now() const;
  static Bound settle(LandingOf<Ball>&, const SceneOf<Ball>&, const WallOf<Ball>&, bool same, double unit);
  Outcome arrive(const Copy&, const std::optional<Now>& before);
  Outcome landed(const Copy&, const std::optional<Now>& before);
  Passage pass() const;
  Outcome leave(const Now& before);
  Outcome stop_at_last_time();
  double needed_bits() const;
  Bound error_of_state() const;
  Bound position_error() const { return Bound(unit_) * now_.errors.of_position(); }
  Bound velocity_error() const { return Bound(speed_) * now_.errors.of_velocity(); }
  Bound time_error() const { return Bound(time_unit_) * now_.errors.of_time(); }
  std::string name(const Copy&) const;
  std::string described(const Doubt&) const;

  const ExactSystem& system_;
  const CertifiedTask& task_;
  const KnownTies& ties_;
  long first_bits_, bits_, table_bits_;
  double unit_ = 1.0, speed_ = 1.0, time_unit_ = 1.0;  ///< at least the size of each
  SceneOf<Ball> scene_;
  SceneOf<Interval> fast_;
  Whereabouts where_;
  std::optional<Ball> t_max_;

  Now now_;
  std::vector<Copy> path_;
  int hole_ = -1;
  bool rescaled_ = false;
  std::optional<BallState> stopped_;  ///< the state at t_max or in a hole
};

}  // namespace carom::certify
