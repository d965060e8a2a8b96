// A state as point and velocity with an ErrorSet: for any wall and field.
#pragma once

#include "certify/enclosure/state_enclosure.hpp"
#include "certify/enclosure/tangent.hpp"

namespace carom::certify {

/// At most the least radius of curvature of a circle or ellipse, whichever its numbers are.
double least_radius(const WallOf<Interval>&);

class PointEnclosure final : public StateEnclosure {
 public:
  PointEnclosure(const Arena&, const BallState& start);

  std::unique_ptr<StateEnclosure> clone() const override {
    return std::make_unique<PointEnclosure>(*this);
  }
  void fly(const Copy&, bool same, long bits) override;
  BallState state(long bits) const override;
  VectorOf<Interval> position() const override {
    return interval_of(state_.position, position_error());
  }
  VectorOf<Interval> velocity() const override {
    return interval_of(state_.velocity, velocity_error());
  }
  Ball time() const override { return state_.time.widened(time_error()); }
  Bound position_error() const override { return Bound(arena_->unit) * errors_.of_position(); }
  Bound velocity_error() const override {
    return size_of(length(frame_.velocity)) * errors_.of_velocity();
  }
  Bound time_error() const override { return Bound(arena_->time_unit) * errors_.of_time(); }
  Bound error() const override;
  double useful_bits() const override;

 private:
  bool settles_now(long bits) const;
  Bound settle(LandingOf<Ball>&, const WallOf<Ball>&, bool same) const;

  const Arena* arena_;
  BallState state_;  ///< midpoints
  ErrorSet errors_;
  FrameOf<Interval> frame_;
  std::uint64_t hits_ = 0;
};

}  // namespace carom::certify
