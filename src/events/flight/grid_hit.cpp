// Flights among many walls: only those are looked at whose cells the flight passes.
#include <algorithm>
#include <bit>
#include <cmath>

#include "base/index.hpp"
#include "events/flight/cell_walk.hpp"
#include "events/flight/chain_tree.hpp"
#include "events/flight/crossing.hpp"
#include "events/flight/next_hit.hpp"

namespace carom::events {

using namespace geometry;

namespace {

using base::at;

/// Asks for the first lines of an object's memory, which are needed soon: they come while other
/// work goes on.
template <class Object>
[[gnu::always_inline]] inline void fetch(const Object& object, std::size_t lines) {
  constexpr std::size_t line = 64;
  const char* const begin = reinterpret_cast<const char*>(&object);
  for (std::size_t i = 0; i < lines; ++i) __builtin_prefetch(begin + i * line);
}

}  // namespace

/// What a flight asks of the discs about two pieces.
struct HitFinder::NearFlight {
  base::Pair x, y, vx, vy, omega;
  base::Pair bound;   ///< of the error of v x d and v . d; in a field, of the side
  base::Pair square;  ///< more than |v|^2, by what is rounded; in a field, four times that
  base::Pair bend;    ///< in a field: more than its omega
};

template <bool larmor>
[[gnu::always_inline]] inline HitFinder::NearFlight HitFinder::near_flight(const Flight& f) const {
  const Origin& own = origins_[0];
  FlightScale scale = own.scale;
  scale.delta += t_.near_error;
  const double bound = side_error(scale, t_.near_reach + norm_1(own.point));
  return {base::both(own.point.x),
          base::both(own.point.y),
          base::both(f.velocity.x),
          base::both(f.velocity.y),
          base::both(f.omega),
          base::both(larmor ? bound : 0.5 * bound),
          base::both((larmor ? 4.01 : 1.01) * f.square_speed),
          base::both(1.01 * scale.omega)};
}

/// Bit k: the flight is not certain to miss piece k of two.
///
/// A line misses a disc that it passes at a distance of more than the radius, or that lies behind;
/// one that is an obstacle also where it goes away from the centre. A Larmor circle of radius R
/// misses it where the distance D of the centres is |D^2 - R^2| > 2 R r + r^2; omega (D^2 - R^2) is
/// the side of the disc's centre.
template <bool larmor>
[[gnu::always_inline]] inline unsigned HitFinder::not_missed(const NearFlight& f,
                                                             const PieceTable::Near& two) {
  using base::magnitude, base::signs;
  const base::Pair x = two.x - f.x, y = two.y - f.y, r2 = magnitude(two.r2),
                   across = f.vx * y - f.vy * x;
  if constexpr (larmor) {
    const base::Pair side = base::both(2.0) * across + f.omega * (x * x + y * y),
                     beyond = magnitude(side) - f.bound - f.bend * r2;
    return ~(signs(beyond * beyond > f.square * r2) & ~signs(beyond)) & 3u;
  }
  const base::Pair back = -(f.vx * x + f.vy * y),
                   beyond = larger(magnitude(across), back) - f.bound;
  const unsigned off = signs(beyond * beyond > f.square * r2) & ~signs(beyond),
                 leaving = signs(back > f.bound) & ~signs(two.r2);
  return ~(off | leaving) & 3u;
}

/// Does a line enter an obstacle, a disc? Negative: it does not. Positive: it does, and `first` has
/// been compared with it. Undecided: this is for the filter to tell.
[[gnu::always_inline]] inline Sign HitFinder::meets_disc(const Flight& f,
                                                         const PieceTable::Near& two,
                                                         std::size_t which, FirstDisc& first) {
  const int piece = two.piece[which], offset = two.offset[which];
  if (piece == f.start_piece) return Sign::negative;  // a line leaves a disc for good
  if (piece == first.piece) return Sign::positive;    // again, in another cell
  const int curve = offset == 0 ? piece : t_.data[at(piece)].curve;
  const Origin& origin = offset == 0 ? origins_[0] : seen_from(f, offset);
  const Vector centre =
      offset == 0 ? Vector{two.x[which], two.y[which]} : t_.curves[at(curve)].centre;
  const double r2 = two.r2[which];
  const Vector e = origin.point - centre;
  const Quadratic<double> q = circle_quadratic(e, r2, f.velocity, f.square_speed);
  const QuadraticError error = circle_error(origin.scale, norm_1(e), t_.near_error, r2);
  // Going away: the distance from the centre grows from here on, and a disc is not entered.
  if (q.b > error.b) return Sign::negative;
  const double discriminant = discriminant_of(q), margin = discriminant_error(q, error);
  if (discriminant < -margin) return Sign::negative;
  if (!(q.b < -error.b && q.a > error.a && discriminant > margin)) return Sign::undecided;
  const double root = std::sqrt(discriminant), unit = root - q.b, kappa = unit / q.a;
  const double kappa_spread = kappa_error(q, error, {discriminant, root, kappa});
  if (first.piece >= 0) {
    const double gap = kappa - first.kappa;
    if (!(std::fabs(gap) > kappa_spread + first.error)) return Sign::undecided;
    if (gap < 0.0) return Sign::positive;
  }
  // The first so far: what a hit on it needs.
  fetch(t_.curves[at(curve)], 3);
  fetch(t_.data[at(piece)], 1);
  first = {piece, q.a, unit, kappa, kappa_spread};
  return Sign::positive;
}

/// On which side of the flight are the joints of some pieces?
template <bool larmor, bool cells>
bool HitFinder::see_joints(const Flight& f, std::span<const int> list) {
  for (const int piece : list) {
    const PieceTable::PieceData& p = t_.data[at(piece)];
    if (p.closed) continue;
    const Origin& origin = origins_[cells ? at(p.offset) : 0];
    for (const int joint : {piece, p.next}) {
      const Vector d = t_.joints[at(joint)] - origin.point;
      const double side =
          larmor ? side_of_flight(f.velocity, d, f.omega) : 2.0 * geometry::cross(f.velocity, d);
      left_[at(joint)] = side > 0.0;
      if (!(std::fabs(side) > side_error(origin.scale, norm_1(d)))) return false;
    }
  }
  return true;
}

template bool HitFinder::see_joints<false, false>(const Flight&, std::span<const int>);
template bool HitFinder::see_joints<false, true>(const Flight&, std::span<const int>);
template bool HitFinder::see_joints<true, false>(const Flight&, std::span<const int>);
template bool HitFinder::see_joints<true, true>(const Flight&, std::span<const int>);

template <class Visit, class Passed>
void HitFinder::follow(const Flight& f, const Visit& visit, const Passed& passed) const {
  const Origin& own = origins_[0];
  const double delta = own.scale.delta * t_.options.filter_inflation;
  if (f.omega == 0.0)
    t_.grid->along_line(own.point, delta, f.velocity, visit, passed);
  else
    t_.grid->along_circle(own.point, delta, f.velocity, f.omega, std::sqrt(f.square_speed), visit,
                          passed);
}

/// All pieces that the whole flight may meet, in their order.
const std::vector<int>& HitFinder::pieces_on_way(const Flight& f) {
  list_.clear();
  if (t_.tree) {
    const Origin& own = origins_[0];
    const auto add = [&](int piece, bool) { list_.push_back(piece); };
    if (f.omega == 0.0)
      t_.tree->along_line(own.point, f.velocity, own.scale, add);
    else
      t_.tree->along_circle(own.point, f.velocity, f.omega, own.scale, add);
    return list_;
  }
  ++flights_;
  follow(
      f,
      [&](int cell) {
        for (const int piece : t_.grid->pieces(cell)) {
          if (seen_[at(piece)] == flights_) continue;
          seen_[at(piece)] = flights_;
          list_.push_back(piece);
        }
      },
      [](double) { return false; });
  std::sort(list_.begin(), list_.end());
  return list_;
}

template <bool larmor, bool cells>
bool HitFinder::filtered_in_grid(const Flight& f, Ahead& ahead) {
  if (f.start_previous >= 0) return false;  // from a joint: by algebra
  ++flights_;
  list_.clear();
  bool decided = true;
  double error = 0.0;
  FirstDisc disc;
  ahead = Ahead();
  const NearFlight near = near_flight<larmor>(f);
  const auto visit = [&](int cell) __attribute__((always_inline)) {
    const std::size_t end = t_.grid->first_pair(cell + 1);
    for (std::size_t i = t_.grid->first_pair(cell); i < end; ++i) {
      const PieceTable::Near& two = t_.near[i];
      for (unsigned open = not_missed<larmor>(near, two); open != 0; open &= open - 1) {
        const auto which = static_cast<std::size_t>(std::countr_zero(open));
        if (!larmor && two.r2[which] > 0.0 && meets_disc(f, two, which, disc) != Sign::undecided)
          continue;
        const int piece = two.piece[which];
        if (seen_[at(piece)] == flights_) continue;
        seen_[at(piece)] = flights_;
        if (cells && two.offset[which] != 0) seen_from(f, two.offset[which]);
        list_.push_back(piece);
      }
    }
  };
  const auto passed = [&](double kappa) __attribute__((always_inline)) {
    if (!list_.empty()) {
      // The first of those so far, against those that are new.
      if (disc.piece >= 0) list_.push_back(disc.piece);
      if (ahead.piece >= 0 && ahead.piece != disc.piece) list_.push_back(ahead.piece);
      decided = filtered_of<larmor, cells, true>(f, ahead, list_, error);
      if (!decided) return true;
      list_.clear();
      if (ahead.piece != disc.piece) disc = FirstDisc();
    } else if (disc.piece != ahead.piece && disc.piece >= 0) {
      if (ahead.piece >= 0) {
        const double gap = disc.kappa - ahead.kappa;
        decided = std::fabs(gap) > disc.error + error;
        if (!decided) return true;
        if (gap < 0.0) disc = FirstDisc();
      }
      if (disc.piece >= 0) {
        ahead.kind = Ahead::Kind::wall;
        ahead.piece = disc.piece;
        ahead.kappa = disc.unit / disc.time;
        ahead.duration = disc.time / disc.unit;
        error = disc.error;
      }
    }
    return ahead.kind != Ahead::Kind::none && ahead.kappa - error > kappa;
  };
  const Origin& own = origins_[0];
  if (larmor || !t_.grid->walk_line(own.point, own.scale.delta * t_.options.filter_inflation,
                                    f.velocity, visit, passed))
    follow(f, visit, passed);
  return decided && !(ahead.piece >= 0 && t_.is_rough(f, ahead.piece));
}

template <bool larmor>
bool HitFinder::filtered_in_tree(const Flight& f, Ahead& ahead) {
  const Origin& own = origins_[0];
  list_.clear();
  bool crossed = false;
  const auto add = [&](int piece, bool surely) {
    // Needed soon, one after the other. Without a lattice every piece is a wall, with its number.
    fetch(t_.data[at(piece)], 1);
    fetch(t_.curves[at(piece)], 5);
    list_.push_back(piece);
    crossed = surely;
  };
  if constexpr (larmor)
    t_.tree->exits_of_circle(own.point, f.velocity, f.omega, own.scale, add);
  else
    t_.tree->exits_of_line(own.point, f.velocity, own.scale, add);
  if (crossed && list_.size() == 1 && filtered_alone<larmor>(f, list_.front(), ahead)) return true;
  double error = 0.0;
  ahead = Ahead();
  return filtered_of<larmor, false, true>(f, ahead, list_, error);
}

bool HitFinder::filtered_among_many(const Flight& f, Ahead& ahead) {
  const bool larmor = f.omega != 0.0;
  if (t_.tree) return larmor ? filtered_in_tree<true>(f, ahead) : filtered_in_tree<false>(f, ahead);
  if (t_.cells)
    return larmor ? filtered_in_grid<true, true>(f, ahead)
                  : filtered_in_grid<false, true>(f, ahead);
  return larmor ? filtered_in_grid<true, false>(f, ahead)
                : filtered_in_grid<false, false>(f, ahead);
}

void HitFinder::next_in_grid(const Flight& f, Ahead& ahead, DecisionCounts& counts) {
  look_from(f);
  if (flights_ > 0xfffffff0u) {  // the counter of flights begins again
    std::fill(seen_.begin(), seen_.end(), 0);
    std::fill(seen_offsets_.begin(), seen_offsets_.end(), 0);
    flights_ = 0;
  }
  if (filtered_among_many(f, ahead)) {
    ++counts.filter;
  } else {
    ++counts.exact;
    ahead = exact_next(f, pieces_on_way(f));
  }
  if (ahead.kind == Ahead::Kind::none) ahead.duration = 0.0;
}

}  // namespace carom::events
