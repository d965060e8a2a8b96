// Where a flight crosses the curve of one piece: the crossing that may be the first, and its
// errors.
#include <algorithm>
#include <cmath>

#include "events/flight/bounded.hpp"
#include "events/flight/crossing.hpp"
#include "events/flight/next_hit.hpp"

namespace carom {

using namespace geometry;

namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

void HitFinder::look_at_cells(const Flight& f) const {
  const double speed_1 = norm_1(f.velocity), omega = std::fabs(f.omega);
  const Lattice& l = *table_.lattice;
  for (std::size_t k = 0; k < offsets_.size(); ++k) {
    const Cell c{f.cell.first + offsets_[k].first, f.cell.second + offsets_[k].second};
    Origin& o = origins_[k];
    o.point = l.seen_from(c, f.start);
    // The start less one multiple, at most |start| + size, and the end; |start| is at most the end
    // and size.
    const double m = std::fabs(static_cast<double>(c.first)),
                 n = std::fabs(static_cast<double>(c.second));
    const double size = m * norm_1(l.first) + n * norm_1(l.second);
    const double rounding = unit_roundoff * 2.1 * (size + norm_1(o.point));
    o.scale.delta = c == Cell{} ? f.start_error : f.start_error + rounding;
    o.scale.speed_1 = speed_1;
    o.scale.omega = omega;
    o.scale.inflation = options_.filter_inflation;
  }
}

HitFinder::Candidate HitFinder::candidate(const Flight& f, int piece, bool stands) const {
  const PieceData& p = data_[at(piece)];
  const PreparedCurve& w = curves_[at(p.curve)];
  const Origin& origin = origins_[at(p.offset)];
  Candidate c;
  c.quadratic = f.omega == 0.0
                    ? quadratic<false>(w, origin.point, f.velocity, f.square_speed, 0.0, stands)
                    : quadratic<true>(w, origin.point, f.velocity, f.square_speed, f.omega, stands);
  c.error = quadratic_error(w, origin.point, origin.scale, stands);
  c.root = rising_root(c.quadratic);
  if (stands && f.omega != 0.0) c.root.kappa = -c.quadratic.c / (2.0 * c.quadratic.b);
  return c;
}

namespace {

/// Does the flight to kappa end on the ellipse to half of the digits? e: its start seen from the
/// centre. Where roots of the quartic cannot be told apart an interval may hold one root and be of
/// no use as a number.
bool ends_on_ellipse(const PreparedCurve& w, Vector e, Vector v, double omega, double kappa) {
  const Vector d = e + displacement(flight_factors(kappa, omega, 0.5), v);
  const geometry::OnEllipse<double> on = geometry::on_ellipse(d, w.first_axis, w.second_axis);
  return std::fabs(on.step) <= 0x1p-26 * norm_1(on.gradient) * (norm_1(e) + norm_1(d));
}

}  // namespace

Sign HitFinder::quartic_candidate(const Flight& f, int piece, double inflation,
                                  Candidate& c) const {
  const bool stands = stands_on_ellipse(f, piece);
  const PieceData& p = data_[at(piece)];
  const PreparedCurve& w = curves_[at(p.curve)];
  FlightScale s = origins_[at(p.offset)].scale;
  s.inflation = inflation;
  const Vector origin = origins_[at(p.offset)].point;
  const Vector e = origin - w.centre, j = right(f.velocity);
  const Vector em{dot(w.first_axis, e), dot(w.second_axis, e)};
  const Vector vm{dot(w.first_axis, f.velocity), dot(w.second_axis, f.velocity)};
  const Vector jm{dot(w.first_axis, j), dot(w.second_axis, j)};
  const double row = std::max(norm_1(w.first_axis), norm_1(w.second_axis));
  QuarticError error = quartic_error(s, norm_1(e), w.centre_error, row, stands);
  // An arc's ellipse on which the start lies to rounding: from there, the square of its image
  // for 1. Who is beyond the arc's chord makes no flight to a larger |kappa| that ends on it.
  const double off = std::fabs(dot(em, em) - 1.0);
  const bool beside = !w.closed && !stands && off <= error.q[4];
  Quartic<double> q =
      ellipse_quartic(em, stands || beside ? dot(em, em) : 1.0, vm, jm, f.omega, 0.5);
  if (w.orientation > 0)
    for (double& x : q.q) x = -x;
  // In the quartic that square stands as it is, times 2 n and times n^2, n = omega^2 / 4; .251 for
  // a quarter is more than what is rounded here.
  if (beside) {
    const double n = 0.251 * f.omega * f.omega;
    error.q[4] += off;
    error.q[2] += 2.0 * n * off;
    error.q[0] += n * n * off;
  }
  const RisingRoots found =
      rising_roots(q, error, stands ? 3 : 4, std::max(0.5 * s.omega, row * s.speed_1),
                   w.closed ? 1 : 4, beside ? kappa_beyond_chord(w, origin, s) : HUGE_VAL);
  for (int i = 0; i < found.count; ++i) {
    c.root.kappa = found.roots[i].kappa;
    c.kappa_error = found.roots[i].error;
    const Sign on = w.closed ? Sign::positive : on_part(f, piece, c, inflation);
    if (on == Sign::positive && !ends_on_ellipse(w, e, f.velocity, f.omega, c.root.kappa))
      return Sign::undecided;
    if (on != Sign::negative) return on;
  }
  return found.decided ? Sign::negative : Sign::undecided;
}

/// Is the crossing of a conic, with its error known, on the arc's side of its chord?
Sign HitFinder::on_part(const Flight& f, int piece, const Candidate& c, double inflation) const {
  const PieceData& p = data_[at(piece)];
  const PreparedCurve& w = curves_[at(p.curve)];
  FlightScale s = origins_[at(p.offset)].scale;
  s.inflation = inflation;
  return side_of_chord(w, origins_[at(p.offset)].point, f.velocity, f.omega, c.root.kappa,
                       c.kappa_error, s)
      .sign();
}

/// Both joints of an arc lie on one side: does the flight leave through it all the same?
Sign HitFinder::crossed_twice(const Flight& f, int piece) const {
  if (!cells_) look_from(f);
  Candidate c = candidate(f, piece, false);
  const Sign cut = sign_within(c.root.discriminant, discriminant_error(c.quadratic, c.error));
  if (cut != Sign::positive) return cut;
  c.kappa_error = kappa_error(c.quadratic, c.error, c.root);
  return on_part(f, piece, c, options_.filter_inflation);
}

double HitFinder::kappa_error_of(const Flight& f, int piece) const {
  if (!cells_) look_from(f);
  Candidate c;
  if (is_quartic(f, piece))
    return quartic_candidate(f, piece, options_.filter_inflation, c) == Sign::positive
               ? c.kappa_error
               : HUGE_VAL;
  c = candidate(f, piece, stands_on(f, piece));
  return kappa_error(c.quadratic, c.error, c.root);
}

}  // namespace carom
