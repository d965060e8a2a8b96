// Long chains of walls: a binary tree over pieces that follow each other, in which a flight finds
// those that it may meet, or those through which it may leave. docs/developer/many-walls.md.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/pair.hpp"
#include "carom/geometry/curve.hpp"
#include "carom/geometry/filter.hpp"

namespace carom::events {

using base::Pair, base::both, base::smaller, base::larger, base::between, base::pair_at;

class ChainTree {
 public:
  explicit ChainTree(const std::vector<geometry::Curve>& pieces);

  /// Calls visit(piece, crossed), ascending, for all but pieces that a flight surely misses.
  /// `crossed`: the side of the flight rises along the piece, and surely from below zero to above.
  template <class Visit>
  void along_line(geometry::Vector start, geometry::Vector velocity,
                  const geometry::FlightScale& scale, const Visit& visit) const {
    look(Line(*this, start, velocity, scale), visit);
  }
  template <class Visit>
  void along_circle(geometry::Vector start, geometry::Vector velocity, double omega,
                    const geometry::FlightScale& scale, const Visit& visit) const {
    look(Circle(*this, start, velocity, omega, scale), visit);
  }
  /// The same for all but pieces through which a flight surely does not leave the domain.
  template <class Visit>
  void exits_of_line(geometry::Vector start, geometry::Vector velocity,
                     const geometry::FlightScale& scale, const Visit& visit) const {
    look_for_exits(Line(*this, start, velocity, scale), visit);
  }
  template <class Visit>
  void exits_of_circle(geometry::Vector start, geometry::Vector velocity, double omega,
                       const geometry::FlightScale& scale, const Visit& visit) const {
    look_for_exits(Circle(*this, start, velocity, omega, scale), visit);
  }

 private:
  /// Pieces that follow each other lie within `bulge` of the chord from their start to their end;
  /// `quarter` of its square.
  struct Bounds {
    double bulge = 0.0, quarter = 0.0;
  };
  /// Tangents lie between these directions, counter-clockwise and less than half a turn from the
  /// first to the last; both are zero if there is no such pair.
  struct Cone {
    geometry::Vector first, last;
  };
  struct alignas(64) Node : Bounds {
    Cone tangents;
    geometry::Vector middle;  ///< the joint of its halves
  };
  // Of two roots at once.
  using TwoVectors = geometry::BasicVector<Pair>;
  static TwoVectors both_of(geometry::Vector a) { return {both(a.x), both(a.y)}; }
  template <std::size_t size>
  static TwoVectors pairs_at(const std::array<double, size>& x, const std::array<double, size>& y,
                             std::size_t i) {
    return {pair_at(x, i), pair_at(y, i)};
  }
  /// Bits 0 and 1: the ends are not both beyond `near` on one side, and the side does not fall (it
  /// rises by `rise` at most).
  static unsigned open_pair(Pair from, Pair to, Pair near, Pair rise) {
    const Pair beyond = larger(smaller(from, to), -larger(from, to)) - near,
               out = larger(beyond, -rise);
    return ~base::signs(out > both(0.0)) & 3u;
  }
  /// The nodes that flights begin with, number by number.
  struct Roots {
    static constexpr std::size_t most = 8;
    std::array<double, most> first_x{}, first_y{}, last_x{}, last_y{};  ///< tangents
    std::array<double, most> bulge{}, quarter{};
    std::array<double, most + 2> x{}, y{};  ///< joints before, between and behind; one for pairs
  };
  struct Piece : Bounds {
    int number = -1;  ///< -1: none, or the way from one loop to the next
  };
  /// A joint as a flight sees it: from its start, and on which side.
  struct Seen {
    geometry::Vector d;
    double side;
  };
  /// The side of the flight along some pieces.
  struct Trend {
    bool rises, falls;
  };

  class Line {
   public:
    Line(const ChainTree& tree, geometry::Vector start, geometry::Vector velocity,
         const geometry::FlightScale& scale)
        : start_(start),
          velocity_(velocity),
          error_(tree.error_of(start, scale)),
          speed_(1.0001 * length(velocity)) {}
    double error() const { return error_; }
    Seen see(const geometry::Vector& joint) const {
      const geometry::Vector d = joint - start_;
      return {d, cross(velocity_, d)};
    }
    /// Beyond this no point of the pieces is on the other side.
    double near(const Bounds& b) const { return speed_ * b.bulge + error_; }
    bool behind(const Seen& from, const Seen& to, double near) const {
      return std::max(dot(velocity_, from.d), dot(velocity_, to.d)) < -near;
    }
    Trend trend(const Node& node, const Seen&, const Seen&) const {
      const double a = cross(velocity_, node.tangents.first),
                   b = cross(velocity_, node.tangents.last);
      return {std::min(a, b) > 0.0, std::max(a, b) < 0.0};
    }

    /// Bit k: a flight may leave through root k.
    unsigned open(const Roots& roots) const {
      const TwoVectors start = both_of(start_), v = both_of(velocity_);
      // Sides stay in registers: a pair from memory would wait for both of those that it is of.
      Pair from = cross(v, pairs_at(roots.x, roots.y, 0) - start);
      unsigned found = 0;
      for (std::size_t i = 0; i < Roots::most; i += 2) {
        const Pair after = cross(v, pairs_at(roots.x, roots.y, i + 2) - start);
        const Pair a = cross(v, pairs_at(roots.first_x, roots.first_y, i)),
                   b = cross(v, pairs_at(roots.last_x, roots.last_y, i)), error = both(error_),
                   wide = both(speed_) * pair_at(roots.bulge, i) + error,
                   near = smaller(a, b) > both(0.0) ? error : wide;
        found |= open_pair(from, between(from, after), near, larger(a, b)) << i;
        from = after;
      }
      return found;
    }

   private:
    geometry::Vector start_, velocity_;
    double error_, speed_;
  };

  class Circle {
   public:
    Circle(const ChainTree& tree, geometry::Vector start, geometry::Vector velocity, double omega,
           const geometry::FlightScale& scale)
        : start_(start),
          velocity_(velocity),
          omega_(omega),
          error_(tree.error_of(start, scale)),
          speed_(2.0002 * length(velocity)),
          w_(1.0001 * scale.omega),
          turn_error_(tree.turn_error_of(start, scale)) {}
    double error() const { return error_; }
    Seen see(const geometry::Vector& joint) const {
      const geometry::Vector d = joint - start_;
      return {d, geometry::side_of_flight(velocity_, d, omega_)};
    }
    double near(const Bounds& b) const {
      return b.bulge * (speed_ + w_ * b.bulge) + w_ * b.quarter + error_;
    }
    static bool behind(const Seen&, const Seen&, double) { return false; }
    Trend trend(const Node& node, const Seen& from, const Seen& to) const {
      const geometry::Vector a = along(from), b = along(to);
      const double p = cross(a, node.tangents.first), q = cross(a, node.tangents.last),
                   r = cross(b, node.tangents.first), s = cross(b, node.tangents.last);
      const double least = w_ * node.bulge + turn_error_;
      return {std::min(std::min(p, q), std::min(r, s)) > least,
              std::max(std::max(p, q), std::max(r, s)) < -least};
    }

    unsigned open(const Roots& roots) const {
      const TwoVectors start = both_of(start_), v = both_of(velocity_);
      const Pair omega = both(omega_), w = both(w_);
      struct {
        Pair side;
        TwoVectors along;
      } at, after;
      const auto see = [&](std::size_t i, auto& joints) {
        const auto d = pairs_at(roots.x, roots.y, i) - start;
        joints = {both(2.0) * cross(v, d) + omega * dot(d, d),
                  {v.x + omega * d.y, v.y - omega * d.x}};
      };
      see(0, at);
      unsigned found = 0;
      for (std::size_t i = 0; i < Roots::most; i += 2, at = after) {
        see(i + 2, after);
        const auto first = pairs_at(roots.first_x, roots.first_y, i),
                   last = pairs_at(roots.last_x, roots.last_y, i), from = at.along;
        const TwoVectors to{between(from.x, after.along.x), between(from.y, after.along.y)};
        const Pair a = cross(from, first), b = cross(from, last), c = cross(to, first),
                   d = cross(to, last), bulge = pair_at(roots.bulge, i),
                   turned = w * bulge + both(turn_error_), error = both(error_),
                   wide =
                       bulge * (both(speed_) + w * bulge) + w * pair_at(roots.quarter, i) + error,
                   near = smaller(smaller(a, b), smaller(c, d)) > turned ? error : wide;
        found |= open_pair(at.side, between(at.side, after.side), near,
                           larger(larger(a, b), larger(c, d)) + turned)
                 << i;
      }
      return found;
    }

   private:
    geometry::Vector along(const Seen& x) const {
      return velocity_ + omega_ * geometry::right(x.d);
    }
    geometry::Vector start_, velocity_;
    double omega_, error_, speed_, w_, turn_error_;
  };

  /// Are both on one side, farther off than `near`?
  static bool beside(const Seen& from, const Seen& to, double near) {
    return std::min(from.side, to.side) > near || std::max(from.side, to.side) < -near;
  }
  static double length(geometry::Vector v) { return std::sqrt(dot(v, v)); }
  double reach_from(geometry::Vector start) const {
    return reach_ + std::fabs(start.x) + std::fabs(start.y);
  }
  /// Of the side of a joint.
  double error_of(geometry::Vector start, const geometry::FlightScale& scale) const {
    return side_error(scale, reach_from(start));
  }
  /// Of v + omega J d times a direction: d errs by delta and u of itself, product and sum by 2u,
  /// the direction by far less than its cone is wider than need be.
  double turn_error_of(geometry::Vector start, const geometry::FlightScale& scale) const {
    constexpr double u = geometry::unit_roundoff;
    return scale.inflation * 1.5 *
           (scale.omega * (scale.delta + 6.0 * u * reach_from(start)) + 6.0 * u * scale.speed_1);
  }

  template <class Flight>
  static bool missed(const Flight& flight, const Bounds& b, const Seen& from, const Seen& to) {
    const double near = flight.near(b);
    return beside(from, to, near) || flight.behind(from, to, near);
  }
  /// Surely no flight leaves the domain through it.
  template <class Flight>
  static bool without_exit(const Flight& flight, const Node& node, const Seen& from,
                           const Seen& to) {
    const Trend trend = flight.trend(node, from, to);
    const double near = flight.near(node);
    return trend.falls || beside(from, to, trend.rises ? flight.error() : near) ||
           flight.behind(from, to, near);
  }

  /// A node, and its ends.
  struct Open {
    std::size_t node;
    Seen from, to;
  };

  template <class Flight, class Visit>
  void look(const Flight flight, const Visit& visit) const {
    for (std::size_t k = 0; k < roots_; ++k) {
      const Open root = root_of(flight, k);
      if (!missed(flight, nodes_[root.node], root.from, root.to))
        descend<false>(flight, root, visit);
    }
  }
  template <class Flight, class Visit>
  void look_for_exits(const Flight flight, const Visit& visit) const {
    for (unsigned open = flight.open(first_) & ((1u << roots_) - 1u); open != 0; open &= open - 1u)
      look_for_exits(flight, root_of(flight, static_cast<std::size_t>(std::countr_zero(open))),
                     visit);
  }
  template <class Flight, class Visit>
  void look_for_exits(const Flight& flight, const Open& root, const Visit& visit) const {
    const Node& node = nodes_[root.node];
    if (flight.behind(root.from, root.to, flight.near(node))) return;
    if (flight.trend(node, root.from, root.to).rises)
      cross_once(flight, root.node, visit);
    else
      descend<true>(flight, root, visit);
  }
  template <class Flight>
  Open root_of(const Flight& flight, std::size_t k) const {
    return {roots_ + k, flight.see(joints_[k * root_step_]),
            flight.see(joints_[(k + 1) * root_step_])};
  }

  /// Through a node that is not left out, down to the leaves.
  template <bool exits, class Flight, class Visit>
  void descend(const Flight& flight, Open at, const Visit& visit) const {
    const auto left_out = [&](std::size_t k, const Seen& from, const Seen& to) {
      return exits ? without_exit(flight, nodes_[k], from, to)
                   : missed(flight, nodes_[k], from, to);
    };
    for (;;) {
      if (exits && flight.trend(nodes_[at.node], at.from, at.to).rises)
        return cross_once(flight, at.node, visit);
      if (at.node >= leaves_) return look_at_leaf(flight, at.node, at.from, visit);
      const Seen middle = flight.see(nodes_[at.node].middle);
      const std::size_t half = 2 * at.node;
      const bool second = !left_out(half + 1, middle, at.to);
      if (!left_out(half, at.from, middle)) {
        if (!second) {
          at.node = half;
          at.to = middle;
          continue;
        }
        descend<exits>(flight, {half, at.from, middle}, visit);
      }
      if (!second) return;
      at.node = half + 1;
      at.from = middle;
    }
  }

  template <class Flight, class Visit>
  void look_at_leaf(const Flight& flight, std::size_t leaf, Seen from, const Visit& visit) const {
    const std::size_t first = (leaf - leaves_) * in_leaf_;
    for (std::size_t i = first; i < first + in_leaf_; ++i) {
      const Seen after = flight.see(joints_[i + 1]);
      if (!missed(flight, pieces_[i], from, after) && pieces_[i].number >= 0)
        visit(pieces_[i].number, false);
      from = after;
    }
  }

  /// Along a node's pieces the side rises from one that is not surely positive to one that is not
  /// surely negative: where it crosses, by halving.
  template <class Flight, class Visit>
  void cross_once(const Flight& flight, std::size_t node, const Visit& visit) const {
    const std::size_t level = std::bit_floor(node),
                      count = in_leaf_ << (std::bit_width(leaves_) - std::bit_width(node));
    const std::size_t least = (node - level) * count, most = least + count;
    const geometry::Vector* const joints = joints_.data();
    const auto negative = [&](std::size_t i) -> std::size_t {
      return flight.see(joints[i]).side < 0.0;
    };
    std::size_t first = least, left = count;
    // In four at once: none of three joints waits for another.
    for (; left > 3; left -= 3 * (left / 4)) {
      const std::size_t part = left / 4;
      first +=
          part * (negative(first + part) + negative(first + 2 * part) + negative(first + 3 * part));
    }
    for (; left > 1; --left) first += negative(first + 1);
    // One piece, or those with a joint whose side is not certain.
    std::size_t end = first + 1;
    Seen from = flight.see(joints[first]);
    const Seen to = flight.see(joints[end]);
    double last_side = to.side;
    while (!(from.side < -flight.error()) && first > least) from = flight.see(joints[--first]);
    while (!(last_side > flight.error()) && end < most) last_side = flight.see(joints[++end]).side;
    const bool certain = from.side < -flight.error() && last_side > flight.error(),
               crossed = certain && end == first + 1;
    if (crossed && flight.behind(from, to, flight.near(pieces_[first]))) return;
    for (; first < end; ++first)
      if (pieces_[first].number >= 0) visit(pieces_[first].number, crossed);
  }

  /// Around all of these directions (zeros point nowhere), with a margin beyond all rounding.
  static Cone cone_around(const std::vector<geometry::Vector>& directions);
  static Cone cone_of(const geometry::Curve& curve);

  static constexpr std::size_t least_in_leaf = 4;
  std::size_t leaves_ = 1, roots_ = 1, in_leaf_ = least_in_leaf;
  std::size_t root_step_ = 1;  ///< pieces of a root
  /// Numbered by levels: the children of k are 2k and 2k + 1, the leaves come last. Flights begin
  /// with those of a level whose number is roots_.
  std::vector<Node> nodes_;
  Roots first_;
  std::vector<Piece> pieces_;             ///< those of leaf k from in_leaf_ k on
  std::vector<geometry::Vector> joints_;  ///< before, between and behind them
  double reach_ = 0.0;                    ///< bounds the l1 norm of all joints
};

}  // namespace carom::events
