// Flights among many walls: only those are looked at whose cells the flight passes.
#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "carom/geometry/hull.hpp"
#include "events/flight/chain_tree.hpp"
#include "events/flight/crossing.hpp"
#include "events/flight/next_hit.hpp"

namespace carom::events {

using namespace geometry;

namespace {

using base::at;

/// Asks for an object's memory that is needed soon: the answer comes while other work goes on.
template <class Object>
[[gnu::always_inline]] inline void fetch(const Object& object) {
  constexpr std::size_t line = 64;
  const char* const begin = reinterpret_cast<const char*>(&object);
  for (std::size_t i = 0; i < sizeof object; i += line) __builtin_prefetch(begin + i);
}

}  // namespace

/// Does a line enter a disc from outside? Negative: it does not, or cannot leave the domain there.
/// Positive: it does, and `first` has been compared with it. Undecided: this is for the filter to
/// tell.
template <bool cells>
[[gnu::always_inline]] inline Sign HitFinder::meets_disc(const Flight& f,
                                                         const PieceTable::Near& disc,
                                                         FirstDisc& first) const {
  const bool on_wall = disc.piece == f.start_piece;
  if (on_wall)
    return disc.domain_outside ? Sign::negative : Sign::undecided;  // a line leaves a disc for good
  const Origin& origin = origins_[cells ? at(disc.offset) : 0];
  const Vector e = origin.point - Vector{disc.x, disc.y};
  const Quadratic<double> q = circle_quadratic(e, disc.r2, f.velocity, f.square_speed);
  const QuadraticError error = circle_error(origin.scale, norm_1(e), disc.centre_error, disc.r2);
  // Going away: the distance from the centre grows from here on, and a disc is not entered.
  if (q.b > error.b && (disc.domain_outside || q.a > error.a)) return Sign::negative;
  const double discriminant = discriminant_of(q), margin = discriminant_error(q, error);
  if (discriminant < -margin) return Sign::negative;
  if (!(disc.domain_outside && q.b < -error.b && q.a > error.a && discriminant > margin))
    return Sign::undecided;
  if (disc.piece == first.piece) return Sign::positive;  // again, in another cell
  const double root = std::sqrt(discriminant), unit = root - q.b, kappa = unit / q.a;
  const double kappa_spread = kappa_error(q, error, {discriminant, root, kappa});
  if (first.piece >= 0) {
    const double gap = kappa - first.kappa;
    if (!(std::fabs(gap) > kappa_spread + first.error)) return Sign::undecided;
    if (gap < 0.0) return Sign::positive;
  }
  // The first so far: where it is hit, all of its curve is needed.
  fetch(t_.curves[at(disc.curve)]);
  fetch(t_.data[at(disc.piece)]);
  first = {disc.piece, q.a, unit, kappa, kappa_spread};
  return Sign::positive;
}

/// Is a Larmor circle certain to miss a disc? With its radius R and the distance D of the centres
/// that is so where |D^2 - R^2| > 2 R r + r^2; omega (D^2 - R^2) is the side of the disc's centre.
bool HitFinder::misses_disc(const Flight& f, const PieceTable::Near& disc,
                            const Origin& origin) const {
  const Vector d = Vector{disc.x, disc.y} - origin.point;
  FlightScale scale = origin.scale;
  scale.delta += disc.centre_error;
  // 1.01 and 4.01: roundings, and what the energy shell leaves of |v|^2.
  const double side = std::fabs(side_of_flight(f.velocity, d, f.omega)),
               beyond = side - side_error(scale, norm_1(d)) - 1.01 * scale.omega * disc.r2;
  return beyond > 0.0 && beyond * beyond > 4.01 * f.square_speed * disc.r2;
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
  const auto visit = [&](int cell) {
    const std::size_t end = t_.grid->first_entry(cell + 1);
    for (std::size_t i = t_.grid->first_entry(cell); i < end; ++i) {
      const PieceTable::Near& near = t_.near[i];
      if (near.disc) {
        if constexpr (larmor) {
          if (misses_disc(f, near, origins_[cells ? at(near.offset) : 0])) continue;
        } else if (meets_disc<cells>(f, near, disc) != Sign::undecided) {
          continue;
        }
      }
      if (seen_[at(near.piece)] == flights_) continue;
      seen_[at(near.piece)] = flights_;
      list_.push_back(near.piece);
    }
  };
  const auto passed = [&](double kappa) {
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
  follow(f, visit, passed);
  return decided && !(ahead.piece >= 0 && t_.is_rough(f, ahead.piece));
}

template <bool larmor>
bool HitFinder::filtered_in_tree(const Flight& f, Ahead& ahead) {
  const Origin& own = origins_[0];
  list_.clear();
  bool crossed = false;
  const auto add = [&](int piece, bool surely) {
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
