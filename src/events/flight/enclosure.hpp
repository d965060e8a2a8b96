// A loop of walls, and if it is convex through which of them a flight leaves it: by signs of
// joints, two joints at a time and without a branch, for which wall comes next is what a processor
// guesses worst. docs/physics/exactness.md derives the rules and the bounds.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/fused_pair.hpp"
#include "carom/geometry/filter.hpp"

namespace carom::events {

class Enclosure {
 public:
  static constexpr int undecided = -1;
  static constexpr int most = 32;  ///< walls
  static constexpr int few = 8;    ///< walls, for which some things are quicker

  /// Adds the wall that starts at `from`; a bent one has no tangent.
  void add(geometry::Vector from, geometry::Vector tangent, double length, bool bent) {
    const std::size_t i = static_cast<std::size_t>(size_);
    // A last wall without a neighbour is there twice.
    if (i % 2 == 0)
      walls_.push_back({{base::both(from.x), base::both(from.y)},
                        {base::both(tangent.x), base::both(tangent.y)},
                        base::both(length)});
    Two& w = walls_.back();
    w.from.x[i % 2] = from.x;
    w.from.y[i % 2] = from.y;
    w.tangent.x[i % 2] = tangent.x;
    w.tangent.y[i % 2] = tangent.y;
    w.length[i % 2] = length;
    if (bent) bent_ |= std::uint64_t{1} << i;
    ++size_;
    all_ = (std::uint64_t{1} << size_) - 1;
    for (std::uint64_t right = 0; size_ <= few && right <= all_; ++right)
      exits_[right] = static_cast<unsigned char>(exit_between(right));
    meets_all_ = bent_ == 0 && 1 < size_ && size_ <= few;
  }
  /// Bounds the l1 distance between two points of the loop.
  void set_diameter(double d) { diameter_ = d; }
  double diameter() const { return diameter_; }
  int size() const { return size_; }
  bool bent(int wall) const { return (bent_ >> wall & 1) != 0; }

  /// The joints on the right of a line, as bits: joint i is where wall i starts.
  struct Right {
    std::uint64_t joints = 0;
    bool decided = false;
  };
  [[gnu::always_inline]] Right right_of_line(geometry::Vector origin, geometry::Vector v,
                                             double bound) const {
    const Vectors from = in_both(origin), velocity = in_both(v);
    base::Pair least = base::both(HUGE_VAL);
    std::uint64_t right = 0;
    int shift = 0;
    for (const Two& w : walls_) {
      const base::Pair side = cross(velocity, w.from - from);
      least = base::smaller(base::magnitude(side), least);
      right |= static_cast<std::uint64_t>(base::signs(side)) << shift;
      shift += 2;
    }
    return {right & all_, all_beyond(bound, least)};
  }
  /// A line leaves a convex loop between a joint on its right and the next one on its left; size():
  /// all lie on one side.
  [[gnu::always_inline]] int exit_of_line(geometry::Vector origin, geometry::Vector v,
                                          double bound) const {
    const auto [right, decided] = right_of_line(origin, v, bound);
    return decided ? exit_of(right) : undecided;
  }

  /// Are all walls segments, and so few that to meet all of them takes less long than to wait until
  /// it is known which is the exit?
  bool meets_all() const { return meets_all_ && base::fuses(); }
  /// As exit_of_line, of a loop that meets_all, and the time until the line meets the exit's.
  [[gnu::always_inline]] int exit_of_line(geometry::Vector origin, geometry::Vector v, double bound,
                                          double& duration) const {
    const Vectors from = in_both(origin), velocity = in_both(v);
    base::Pair durations[few / 2], least = base::both(HUGE_VAL);
    std::uint64_t right = 0;
    for (std::size_t i = 0; i < walls_.size(); ++i) {
      const Meeting here = meet(walls_[i], from, velocity);
      durations[i] = here.duration;
      least = base::smaller(base::magnitude(here.side), least);
      right |= static_cast<std::uint64_t>(base::signs(here.side)) << 2 * i;
    }
    if (!all_beyond(bound, least)) return undecided;
    const int exit = exits_[right & all_];
    if (exit != size_) duration = reinterpret_cast<const double*>(durations)[exit];
    return exit;
  }
  /// Has it three or four walls, and meets_all?
  bool meets_four() const { return meets_all() && walls_.size() == 2; }
  /// The same of such a loop. By masks: a number that was just stored in a pair is waited for.
  [[gnu::always_inline]] int exit_of_four(geometry::Vector origin, geometry::Vector v, double bound,
                                          double& duration) const {
    const Vectors from = in_both(origin), velocity = in_both(v);
    const Meeting one = meet(walls_[0], from, velocity), two = meet(walls_[1], from, velocity);
    const base::PairMask in_one = (one.side < 0.0) & (base::between(one.side, two.side) > 0.0),
                         in_two = (two.side < 0.0) & (base::between(two.side, one.side) > 0.0);
    const base::Pair exit =
        base::either_bits(base::keep_if(in_one, one.duration), base::keep_if(in_two, two.duration));
    duration = base::either_bits(exit, base::between(exit, exit))[0];
    if (!all_beyond(bound, base::smaller(base::magnitude(one.side), base::magnitude(two.side))))
      return undecided;
    return exits_[(base::signs(one.side) | base::signs(two.side) << 2) & all_];
  }

  /// The walls that may be the first through which a Larmor circle leaves that starts on the wall
  /// `start`, as bits; first_of tells in which order they come into question. If none is left
  /// through, it is `start`.
  struct Order {
    std::uint64_t walls = 0;   ///< may be left through
    std::uint64_t surely = 0;  ///< are, if none before
    bool decided = false;
  };
  [[gnu::always_inline]] Order exits_of_circle(int start, geometry::Vector origin,
                                               geometry::Vector v, double omega,
                                               double square_speed,
                                               const geometry::CentreError& error) const {
    // Run through the other way it is the same circle: with its disc on the right.
    const double turn = omega > 0.0 ? 1.0 : -1.0;
    const Vectors from{base::both(origin.x), base::both(origin.y)},
        velocity{base::both(turn * v.x), base::both(turn * v.y)};
    const base::Pair w0 = base::both(turn * omega), square = base::both(square_speed),
                     radius = base::both(std::sqrt(square_speed));
    const base::Pair bound = base::both(error.segment);
    base::Pair least = base::both(HUGE_VAL);
    std::uint64_t inside = 0, missed = 0, open = 0;
    int shift = 0;
    for (const Two& w : walls_) {
      const Vectors centre = geometry::centre_of_circle(from - w.from, velocity, w0);
      const base::Pair side = dot(centre, centre) - square;
      least = base::smaller(base::magnitude(side), least);
      inside |= static_cast<std::uint64_t>(base::signs(side)) << shift;
      // The circle cuts the wall twice if its centre is nearer to the line than the radius, and its
      // foot lies between the ends.
      const base::Pair height = cross(w.tangent, centre), foot = dot(w.tangent, centre);
      const base::Pair cut = base::smaller(base::smaller(foot, w0 * w.length - foot),
                                           radius - base::magnitude(height));
      missed |= static_cast<std::uint64_t>(base::signs(cut)) << shift;
      open |= static_cast<std::uint64_t>(base::signs(base::magnitude(cut) <= bound)) << shift;
      shift += 2;
    }
    inside &= all_;
    // A joint inside the circle ends the outer stretch of the boundary that begins at the start:
    // behind it (omega > 0) or ahead of it.
    const std::uint64_t next = rotated(inside, 1), joint = omega > 0.0 ? inside : next;
    const std::uint64_t outside = all_ & ~(inside | next | std::uint64_t{1} << start);
    Order order;
    order.decided =
        (least[0] > error.joint) & (least[1] > error.joint) & ((open & outside & ~bent_) == 0);
    order.surely = joint | (outside & ~bent_ & ~missed);
    order.walls = order.surely | (outside & bent_);
    return order;
  }
  /// The first of the walls in question on the way from `start`: backwards for omega > 0; size():
  /// there is none.
  [[gnu::always_inline]] int first_of(std::uint64_t walls, int start, double omega) const {
    if (walls == 0) return size_;
    if (omega > 0.0) {
      const std::uint64_t here = walls & ((std::uint64_t{2} << start) - 1);
      return 63 - std::countl_zero(here != 0 ? here : walls);
    }
    const std::uint64_t here = walls & ~((std::uint64_t{1} << start) - 1);
    return std::countr_zero(here != 0 ? here : walls);
  }

 private:
  using Vectors = geometry::BasicVector<base::Pair>;
  struct Two {
    Vectors from, tangent;
    base::Pair length;
  };

  int exit_between(std::uint64_t right) const {
    return std::countr_zero((right & ~(right >> 1 | right << (size_ - 1))) | std::uint64_t{1}
                                                                                 << size_);
  }
  static Vectors in_both(geometry::Vector x) { return {base::both(x.x), base::both(x.y)}; }
  struct Meeting {
    base::Pair duration, side;
  };
  [[gnu::always_inline]] static Meeting meet(const Two& walls, Vectors from, Vectors velocity) {
    const Vectors way = walls.from - from;
    base::fuses_surely();
    return {
        geometry::fused_cross(walls.tangent, way) / geometry::fused_cross(walls.tangent, velocity),
        cross(velocity, way)};
  }
  static bool all_beyond(double bound, base::Pair x) {
    return base::signs(x > base::both(bound)) == 3;
  }
  [[gnu::always_inline]] int exit_of(std::uint64_t right) const {
    return size_ <= few ? exits_[right] : exit_between(right);
  }
  /// Bit i of the result is bit i + by.
  std::uint64_t rotated(std::uint64_t bits, int by) const {
    return (bits >> by | bits << (size_ - by)) & all_;
  }
  std::vector<Two> walls_;
  std::array<unsigned char, 1 << few> exits_{};  ///< of few walls: exit_between, by the joints
  std::uint64_t bent_ = 0, all_ = 0;
  int size_ = 0;
  bool meets_all_ = false;
  double diameter_ = 0.0;
};

}  // namespace carom::events
