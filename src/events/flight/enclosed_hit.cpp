// Straight flights among the discs of a convex table, or of the cell of a lattice, that holds
// nothing else.
#include <cmath>

#include "base/index.hpp"
#include "events/flight/crossing.hpp"
#include "events/flight/next_hit.hpp"

namespace carom::events {

using namespace geometry;

/// The disc that a line meets. Undecided: the bounds do not tell, or it meets two.
[[gnu::always_inline]] inline Sign HitFinder::meets_one_disc(const Flight& f, const Origin& o,
                                                             int& met, Quotient& at) const {
  Sign meets = Sign::negative;
  for (const int disc : t_.discs) {
    if (disc == f.start_piece) continue;  // a line leaves a disc for good
    const PreparedCurve& w = *t_.data[base::at(disc)].shape;
    const Vector e = o.point - w.centre;
    const Quadratic<double> q = circle_quadratic(e, w.r2, f.velocity, f.square_speed);
    const double discriminant = discriminant_of(q);
    const QuadraticError error = circle_error(o.scale, norm_1(e), w.centre_error, w.r2);
    const double margin = discriminant_error(q, error);
    // Outside the disc, as the particle is, the line's crossings are ahead exactly when b < 0.
    if ((q.b < 0.0) & (discriminant > 0.0)) {
      if (!((q.b < -error.b) & (discriminant > margin))) return Sign::undecided;
      if (meets == Sign::positive) return Sign::undecided;  // two: by comparing them
      meets = Sign::positive;
      met = disc;
      at = {q.a, std::sqrt(discriminant) - q.b};
    } else if (!((q.b > error.b) | (discriminant < -margin))) {
      return Sign::undecided;
    }
  }
  return meets;
}

/// A line leaves a convex region once: between a joint on its right and the next one on its left,
/// or, with all joints on one side, through the arc that it is on. -1: not decided.
[[gnu::always_inline]] inline int HitFinder::exit_of_enclosure(const Flight& f,
                                                               const Origin& o) const {
  const Enclosure& loop = t_.enclosure;
  if (loop.size() == 1) return t_.enclosure_first;
  const double bound = 0.5 * side_error(o.scale, t_.reach + norm_1(o.point));
  const int exit = loop.exit_of_line(o.point, f.velocity, bound);
  if (exit < 0) return -1;
  if (exit < loop.size()) return t_.enclosure_first + exit;
  const int start = f.start_piece - t_.enclosure_first;
  return start >= 0 && start < loop.size() && loop.bent(start) ? f.start_piece : -1;
}

/// The same on any piece, at a fraction of time.
[[gnu::always_inline]] inline bool HitFinder::put(int piece, Ahead::Kind kind, const Quotient& at,
                                                  Ahead& ahead) {
  if (!put(piece, at.time / at.unit, at.unit / at.time, ahead)) return false;
  ahead.kind = kind;
  return true;
}

/// A disc that the line meets comes before the walls around it.
bool HitFinder::filtered_among_discs(const Flight& f, Ahead& ahead) const {
  if (f.start_previous >= 0) return false;  // from a joint: by algebra
  const Origin o = t_.origin_of(f, 0);
  int piece = -1;
  Quotient at{0.0, 1.0};
  const Sign disc = meets_one_disc(f, o, piece, at);
  if (disc == Sign::undecided) return false;
  if (disc == Sign::positive) return put(piece, Ahead::Kind::wall, at, ahead);
  piece = exit_of_enclosure(f, o);
  if (piece < 0) return false;
  const PieceTable::PieceData& p = t_.data[base::at(piece)];
  const PreparedCurve& w = *p.shape;
  if (w.kind == CurveKind::segment) {
    at = {geometry::fused_cross(w.tangent, o.point - w.from),
          -geometry::fused_cross(w.tangent, f.velocity)};
  } else {
    const bool on_wall = piece == f.start_piece;
    const Quadratic<double> q =
        quadratic<false>(w, o.point, f.velocity, f.square_speed, 0.0, on_wall);
    at = straight_time(q, on_wall ? std::fabs(q.b) : std::sqrt(discriminant_of(q)));
  }
  return put(piece, p.edge ? Ahead::Kind::edge : Ahead::Kind::wall, at, ahead);
}

/// From cell to cell: nothing is asked of an edge but that the line leaves through it.
bool HitFinder::over_edges(Flight& f, Ahead& ahead, DecisionCounts& counts) const {
  constexpr int most_edges = 16;
  for (int edges = 0; edges < most_edges; ++edges) {
    const Origin o = t_.origin_of(f, 0);
    int piece = -1;
    Quotient at{0.0, 1.0};
    const Sign disc = meets_one_disc(f, o, piece, at);
    if (disc == Sign::undecided) return false;
    if (disc == Sign::positive) {
      if (!put(piece, Ahead::Kind::wall, at, ahead)) return false;
      ++counts.filter;
      return true;
    }
    piece = exit_of_enclosure(f, o);
    if (piece < 0) return false;
    ++counts.filter;
    t_.cross_edge(f, piece);
    f.start_piece = -1;  // its disc is in the cell behind
  }
  return false;
}

void HitFinder::next_over_edges(Flight& f, Ahead& ahead, DecisionCounts& counts) {
  if (f.omega != 0.0 || !over_edges(f, ahead, counts)) next_in_any(f, ahead, counts);
}

/// A line from a wall where the joints on its right tell its exit, once a flight has shown which.
/// False: none has, or it is from elsewhere, or the bounds do not tell.
void HitFinder::next_by_signs(const Flight& f, Ahead& ahead, DecisionCounts& counts) {
  const Enclosure& loop = t_.signs;
  std::size_t entry = exits_.size();
  if (f.start_piece >= 0 && f.start_previous < 0) {
    // Four times what is half of side_error: see PieceTable::Preparation::find_signs.
    const FlightScale scale{f.start_error, norm_1(f.velocity), 0.0, t_.options.filter_inflation};
    const double bound = 2.0 * side_error(scale, t_.reach + norm_1(f.start));
    const auto [right, decided] = loop.right_of_line(f.start, f.velocity, bound);
    if (decided) entry = static_cast<std::size_t>(f.start_piece) << loop.size() | right;
  }
  if (entry < exits_.size() && exits_[entry] != unknown_exit && line_to(f, exits_[entry], ahead)) {
    ++counts.filter;
    return;
  }
  next_of_all(f, ahead, counts);
  if (entry < exits_.size() && ahead.kind == Ahead::Kind::wall)
    exits_[entry] = static_cast<unsigned char>(ahead.piece);
}

void HitFinder::next_in_any(const Flight& f, Ahead& ahead, DecisionCounts& counts) {
  if (t_.grid) return next_in_grid(f, ahead, counts);
  if (t_.signs.size() > 0 && f.omega == 0.0) return next_by_signs(f, ahead, counts);
  if (!t_.convex && f.omega == 0.0 && t_.enclosure.size() > 0 && filtered_among_discs(f, ahead))
    ++counts.filter;
  else
    next_of_all(f, ahead, counts);
}

}  // namespace carom::events
