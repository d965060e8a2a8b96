// Straight flights among discs in a convex table, and where the joints tell the exit.
#include "events/flight/next_hit.hpp"

#include <cmath>

#include "base/index.hpp"

namespace carom::events {

using namespace geometry;

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
