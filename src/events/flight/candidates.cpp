// Where a flight crosses the curve of one piece: the crossing that may be the first, and its
// errors.
#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "carom/geometry/quartic.hpp"
#include "events/flight/bounded.hpp"
#include "events/flight/crossing.hpp"
#include "events/flight/piece_table.hpp"

namespace carom::events {

using namespace geometry;

namespace {

using base::at;

}  // namespace

Crossing PieceTable::crossing_of(const Flight& f, int piece, const Origin& o, bool on_wall) const {
  const PreparedCurve& w = *data[at(piece)].shape;
  Crossing c;
  c.quadratic = f.omega == 0.0
                    ? quadratic<false>(w, o.point, f.velocity, f.square_speed, 0.0, on_wall)
                    : quadratic<true>(w, o.point, f.velocity, f.square_speed, f.omega, on_wall);
  c.root = rising_root(c.quadratic);
  if (on_wall && f.omega != 0.0) c.root.kappa = -c.quadratic.c / (2.0 * c.quadratic.b);
  return c;
}

namespace {

/// Does the flight to kappa end on the ellipse to half of the digits? e: its start seen from the
/// centre. If two roots of the quartic nearly coincide, the interval that isolates one
/// may be too wide to serve as its value.
bool ends_on_ellipse(const PreparedCurve& w, Vector e, Vector v, double omega, double kappa) {
  const Vector d = e + displacement(flight_factors(kappa, omega, 0.5), v);
  const geometry::OnEllipse<double> on = geometry::on_ellipse(d, w.first_axis, w.second_axis);
  return std::fabs(on.step) <= 0x1p-26 * norm_1(on.gradient) * (norm_1(e) + norm_1(d));
}

}  // namespace

bool PieceTable::is_on_ellipse(const Flight& f, int piece) const {
  const PieceData& p = data[at(piece)];
  const auto begins_on = [&](int start) {
    if (start < 0) return false;
    const PieceData& s = data[at(start)];
    return start == piece || (p.ellipse >= 0 && s.ellipse == p.ellipse && s.offset == p.offset);
  };
  return begins_on(f.start_piece) || begins_on(f.start_previous);
}

Sign PieceTable::first_exit(const Flight& f, int piece, const Origin& seen, double inflation,
                            Crossing& c) const {
  const bool on_wall = is_on_ellipse(f, piece);
  const PreparedCurve& w = *data[at(piece)].shape;
  FlightScale s = seen.scale;
  s.inflation = inflation;
  const Vector origin = seen.point;
  const Vector e = origin - w.centre, j = right(f.velocity);
  const Vector em{dot(w.first_axis, e), dot(w.second_axis, e)};
  const Vector vm{dot(w.first_axis, f.velocity), dot(w.second_axis, f.velocity)};
  const Vector jm{dot(w.first_axis, j), dot(w.second_axis, j)};
  const double row = std::max(norm_1(w.first_axis), norm_1(w.second_axis));
  QuarticError error = quartic_error(s, norm_1(e), w.centre_error, row, on_wall);
  // An arc's ellipse on which the start lies to rounding: from there, the square of its image
  // for 1. From beyond the arc's chord no flight to a larger |kappa| ends on it.
  const double off = std::fabs(dot(em, em) - 1.0);
  const bool beside = !w.closed && !on_wall && off <= error.q[4];
  Quartic<double> q =
      ellipse_quartic(em, on_wall || beside ? dot(em, em) : 1.0, vm, jm, f.omega, 0.5);
  if (w.orientation > 0)
    for (double& x : q.q) x = -x;
  // In the quartic that square is as written, times 2 n and times n^2, n = omega^2 / 4; .251 for
  // a quarter is more than what is rounded here.
  if (beside) {
    const double n = 0.251 * f.omega * f.omega;
    error.q[4] += off;
    error.q[2] += 2.0 * n * off;
    error.q[0] += n * n * off;
  }
  const RisingRoots found =
      rising_roots(q, error, on_wall ? 3 : 4, std::max(0.5 * s.omega, row * s.speed_1),
                   w.closed ? 1 : 4, beside ? kappa_beyond_chord(w, origin, s) : HUGE_VAL);
  for (int i = 0; i < found.count; ++i) {
    c.root.kappa = found.roots[i].kappa;
    c.error = found.roots[i].error;
    const Sign on = w.closed ? Sign::positive : on_part(f, piece, seen, c, inflation);
    if (on == Sign::positive && !ends_on_ellipse(w, e, f.velocity, f.omega, c.root.kappa))
      return Sign::undecided;
    if (on != Sign::negative) return on;
  }
  return found.decided ? Sign::negative : Sign::undecided;
}

/// Is the crossing of a conic, with its error known, on the arc's side of its chord?
Sign PieceTable::on_part(const Flight& f, int piece, const Origin& o, const Crossing& c,
                         double inflation) const {
  FlightScale s = o.scale;
  s.inflation = inflation;
  return side_of_chord(*data[at(piece)].shape, o.point, f.velocity, f.omega, c.root.kappa, c.error,
                       s)
      .sign();
}

Sign PieceTable::crossed_twice(const Flight& f, int piece, const Origin& o) const {
  Crossing c = crossing_of(f, piece, o, false);
  const QuadraticError error = quadratic_error(*data[at(piece)].shape, o.point, o.scale, false);
  const Sign cut = sign_within(c.root.discriminant, discriminant_error(c.quadratic, error));
  if (cut != Sign::positive) return cut;
  c.error = kappa_error(c.quadratic, error, c.root);
  return on_part(f, piece, o, c, options.filter_inflation);
}

double PieceTable::error_of(const Flight& f, const Ahead& ahead) const {
  const PieceData& p = data[at(ahead.piece)];
  const Origin o = origin_of(f, p.offset);
  if (is_rough(f, ahead.piece))  // the exact one, rounded; and the quotient that is a duration
    return 4.0 * options.filter_inflation * unit_roundoff * std::fabs(ahead.kappa);
  if (p.kind == CurveKind::bezier) {
    Crossing c;
    return bezier_exit(f, ahead.piece, o, options.filter_inflation, c) == Sign::positive ? c.error
                                                                                         : HUGE_VAL;
  }
  if (is_quartic(f, ahead.piece)) {
    Crossing c;
    return first_exit(f, ahead.piece, o, options.filter_inflation, c) == Sign::positive ? c.error
                                                                                        : HUGE_VAL;
  }
  const bool on_wall = is_on(f, ahead.piece);
  const Crossing c = crossing_of(f, ahead.piece, o, on_wall);
  return kappa_error(c.quadratic, quadratic_error(*p.shape, o.point, o.scale, on_wall), c.root);
}

ExactFlight PieceTable::exact_flight(const Flight& f) const {
  return ExactFlight(*exact, f.wall, f.u, f.start, f.velocity, f.omega);
}

}  // namespace carom::events
