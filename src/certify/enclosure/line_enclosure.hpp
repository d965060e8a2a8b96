// A state as the line of its flight, on straight flights among segments and arcs of circles. On
// reflection at a circle the moment about its centre stays, and the velocity is turned by an angle
// that the moment gives: half as many multiplications as for a point, and no error grows but the
// two of the line.
#pragma once

#include <optional>

#include "certify/enclosure/line_table.hpp"
#include "certify/enclosure/turning_box.hpp"

namespace carom::certify {

class LineEnclosure final : public StateEnclosure {
 public:
  LineEnclosure(const Arena&, const LineTable&, const BallState& start);

  std::unique_ptr<StateEnclosure> clone() const override {
    return std::make_unique<LineEnclosure>(*this);
  }
  void fly(const Copy&, bool same, long bits) override;
  BallState state(long bits) const override;
  VectorOf<Interval> position() const override { return interval_of(few_.position); }
  VectorOf<Interval> velocity() const override { return interval_of(few_.velocity); }
  Ball time() const override { return few_.time; }
  Bound position_error() const override { return radius(few_.position); }
  Bound velocity_error() const override { return radius(few_.velocity); }
  Bound time_error() const override { return few_.time.radius(); }
  Bound error() const override { return line_error() + along_; }
  double useful_bits() const override;

 private:
  enum Coordinate : std::size_t { moment = 0, direction = 1 };  // of errors
  /// The reflection at an arc: the velocity is multiplied by cosine + i sine.
  struct Turn {
    Ball room;  ///< size2 - h^2, the square of the velocity's component along the normal times the
                ///< radius
    Ball cosine, sine;
  };
  /// From one anchor to the next, over all states that the true one may be.
  struct Shift {
    Interval along{0.0}, across{0.0};  ///< components by the velocity, in the unit
    Bound rounding;                    ///< of the moment
    Ball passed{0};                    ///< v . shift, to few bits
  };

  Shift move_anchor(const Copy&, bool same);
  Turn turn_at(const LineWall&) const;
  void settle(Bound& turned);
  Bound line_error() const { return box_.size(moment) + box_.size(direction) + stretch_; }
  double moment_unit() const { return arena_->unit * arena_->speed; }
  void read(const Shift&);
  BallState seen(const LineWall&, Ball& ahead) const;

  const Arena* arena_;
  const LineTable* lines_;
  BallVector velocity_;  ///< midpoints
  Ball moment_;
  BallVector anchor_;
  int wall_ = -1;   ///< that it is on; -1: at the start, which is the anchor
  TurningBox box_;  ///< errors of the moment in units of moment_unit, and of the direction
  Bound stretch_;   ///< |log| of the true speed over that of velocity_
  Bound along_;     ///< of the position along the wall, in the unit
  Bound start_error_;
  std::optional<Turn>
      turn_;       ///< of the last arc: again and again the same while the orbit stays there
  BallState few_;  ///< the true state, enclosed in numbers of few bits
  Ball ahead_;     ///< v . (P - anchor), at the same time
  std::uint64_t hits_ = 0;
};

}  // namespace carom::certify
