// Closed chains of pieces, and splines.
#include "table/closed_curves.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "carom/geometry/curve_frame.hpp"
#include "table/numbers.hpp"
#include "table/quintic.hpp"

namespace carom::table::shapes {
namespace {

using geometry::Bezier;
using geometry::Vector;

/// Solves l[k] x[k-1] + d[k] x[k] + u[k] x[k+1] = r[k] around a circle: Thomas' algorithm with the
/// corners as a correction of rank one. Diagonally dominant, so without pivots.
std::vector<Vector> solve_around(const std::vector<double>& l, std::vector<double> d,
                                 const std::vector<double>& u, std::vector<Vector> r) {
  const std::size_t n = d.size();
  const double corner = -d[0];
  std::vector<double> z(n, 0.0);
  z[0] = corner;
  z[n - 1] = u[n - 1];
  d[0] -= corner;
  d[n - 1] -= l[0] * u[n - 1] / corner;
  for (std::size_t k = 1; k < n; ++k) {
    const double share = l[k] / d[k - 1];
    d[k] -= share * u[k - 1];
    r[k] = r[k] - share * r[k - 1];
    z[k] -= share * z[k - 1];
  }
  for (std::size_t k = n; k-- > 0;) {
    const bool last = k + 1 == n;
    r[k] = (1.0 / d[k]) * (last ? r[k] : r[k] - u[k] * r[k + 1]);
    z[k] = (last ? z[k] : z[k] - u[k] * z[k + 1]) / d[k];
  }
  const double back = l[0] / corner, weight = 1.0 + z[0] + back * z[n - 1];
  const Vector share = (1.0 / weight) * (r[0] + back * r[n - 1]);
  for (std::size_t k = 0; k < n; ++k) r[k] = r[k] - z[k] * share;
  return r;
}

/// The derivatives at the points of the periodic cubic spline whose parameter grows by the length
/// of the chords.
std::vector<Vector> slopes_at(const std::vector<Vector>& points, const std::vector<double>& chord) {
  const std::size_t n = points.size();
  std::vector<double> l(n), d(n), u(n);
  std::vector<Vector> r(n);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t before = (k + n - 1) % n, next = (k + 1) % n;
    const double a = chord[before], b = chord[k];
    l[k] = b;
    d[k] = 2.0 * (a + b);
    u[k] = a;
    r[k] =
        (3.0 * b / a) * (points[k] - points[before]) + (3.0 * a / b) * (points[next] - points[k]);
  }
  return solve_around(l, d, u, r);
}

WrittenCurve reversed(const WrittenCurve& curve) {
  if (const auto* bezier = std::get_if<Bezier>(&curve))
    return std::get<Bezier>(geometry::reversed(*bezier));
  auto piece = std::get<WrittenPiece>(curve);
  std::swap(piece.from, piece.piece.to);
  std::reverse(piece.piece.control.begin(), piece.piece.control.end());
  return piece;
}

}  // namespace

CurveErrors errors_of(const Bezier& piece, double distance) {
  const geometry::CurveFrame frame = geometry::frame_of(piece);
  const geometry::BezierForm& form = *frame.bezier;
  if (form.rests_at_start || form.rests_at_end) return {distance};
  double bend = 0.0;  // the largest |x''| of the control points
  for (int i = 0; i + 2 <= piece.degree; ++i) {
    const Vector second = piece.control(i + 2) - 2.0 * piece.control(i + 1) + piece.control(i);
    bend = std::max(bend, piece.degree * (piece.degree - 1) * std::sqrt(dot(second, second)));
  }
  const double speed = form.least_tangent, square = speed * speed;
  return {distance, 3.5 * distance / speed,
          24.1 * distance / square + 10.5 * bend * distance / (square * speed)};
}

double area_of(const Chain& chain) {
  double area = 0.0;
  for (const NamedCurve& wall : chain) area += geometry::area_integral(rounded(wall.curve));
  return area;
}

Chain reversed(Chain chain) {
  Chain round;
  for (std::size_t k = chain.size(); k-- > 0;)
    round.push_back(
        {std::move(chain[k].name), reversed(chain[k].curve), chain[(k + 1) % chain.size()].corner});
  return round;
}

Chain turned(Chain chain, bool clockwise) {
  const double area = area_of(chain);
  return (clockwise ? area <= 0.0 : area >= 0.0) ? chain : reversed(std::move(chain));
}

Chain chain_of_pieces(const LoopSpec& loop, const std::function<std::string(std::size_t)>& name) {
  if (loop.pieces.empty())
    throw InputError(loop.place, "the loop has no pieces", "a list of pieces");
  Vector from = point(loop.start);
  ExactPoint written_from = loop.start;
  Chain chain;
  for (const PieceSpec& piece : loop.pieces) {
    const Vector to = point(piece.to);
    if (to == from && piece.kind != PieceSpec::Kind::bezier) {
      throw InputError(piece.place, "the piece ends where it begins", "two different points");
    }
    chain.push_back(
        {piece.name.empty() ? name(chain.size()) : piece.name, WrittenPiece{written_from, piece}});
    from = to;
    written_from = piece.to;
  }
  return chain;
}

Chain loop_of_pieces(const LoopSpec& loop, const std::function<std::string(std::size_t)>& name) {
  Chain chain = chain_of_pieces(loop, name);
  if (!(point(loop.pieces.back().to) == point(loop.start))) {
    throw InputError(loop.pieces.back().place,
                     "the path is open: it ends at (" + loop.pieces.back().to.x.text() + ", " +
                         loop.pieces.back().to.y.text() + ")",
                     "a last piece that ends at the start (" + loop.start.x.text() + ", " +
                         loop.start.y.text() + ")");
  }
  return chain;
}

Chain spline(const std::vector<ExactPoint>& written, const Place& place, const Layout& layout) {
  if (written.size() < 3)
    throw InputError(place, "the shape 'spline' needs at least three points",
                     "a list of points [x, y]");
  std::vector<Vector> points;
  for (const ExactPoint& p : written) points.push_back(point(p));
  double area = 0.0;
  for (std::size_t k = 0; k < points.size(); ++k)
    area += cross(points[k], points[(k + 1) % points.size()]);
  std::vector<std::size_t> side;  // the number of the piece after each point, as it was written
  for (std::size_t k = 0; k < points.size(); ++k) side.push_back(k);
  if (layout.clockwise ? area > 0.0 : area < 0.0) {
    std::reverse(points.begin() + 1, points.end());
    std::reverse(side.begin(), side.end());
  }
  std::vector<double> chord;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vector d = points[(k + 1) % points.size()] - points[k];
    chord.push_back(std::sqrt(dot(d, d)));
    if (!(chord.back() > 0.0))
      throw InputError(written[side[k]].x.place(), "the same point twice in a row",
                       "different points; the curve closes automatically");
  }
  const std::vector<Vector> slope = slopes_at(points, chord);
  const std::vector<std::string> names = numbered(layout.stem, points.size());
  Chain chain;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::size_t next = (k + 1) % points.size();
    const double third = chord[k] / 3.0;
    chain.push_back({names[side[k]],
                     Bezier{points[k],
                            points[next],
                            {points[k] + third * slope[k], points[next] - third * slope[next]},
                            3},
                     smooth});
  }
  return chain;
}

Shape spline_curve(const TableSpec& spec) {
  const auto found = spec.points.find("points");
  Shape shape;
  shape.loops.push_back(
      spline(found == spec.points.end() ? std::vector<ExactPoint>{} : found->second,
             place_of(spec, "points"), {}));
  return shape;
}

}  // namespace carom::table::shapes
