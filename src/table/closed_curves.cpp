// Closed chains of pieces, and splines.
#include "table/closed_curves.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "carom/geometry/curve_frame.hpp"
#include "table/numbers.hpp"
#include "table/quintic.hpp"
#include "table/spline.hpp"

namespace carom::table::shapes {
namespace {

using geometry::Bezier;
using geometry::Vector;

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
    round.push_back({std::move(chain[k].name), reversed(chain[k].curve),
                     chain[(k + 1) % chain.size()].corner, chain[k].to, chain[k].from});
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

std::vector<SplinePoint> points_in_order(const std::vector<ExactPoint>& written, bool clockwise) {
  std::vector<SplinePoint> points;
  double area = 0.0;
  for (std::size_t k = 0; k < written.size(); ++k) {
    area += cross(point(written[k]), point(written[(k + 1) % written.size()]));
    points.push_back({written[k], k});
  }
  if (clockwise ? area > 0.0 : area < 0.0) {
    std::reverse(points.begin() + 1, points.end());
    for (std::size_t k = 0; k < points.size(); ++k) points[k].side = points.size() - 1 - k;
  }
  return points;
}

Chain spline(const std::vector<ExactPoint>& written, const Place& place, const Layout& layout) {
  if (written.size() < 3)
    throw InputError(place, "the shape 'spline' needs at least three points",
                     "a list of points [x, y]");
  const std::vector<SplinePoint> in_order = points_in_order(written, layout.clockwise);
  std::vector<Vector> points;
  for (const SplinePoint& p : in_order) points.push_back(point(p.at));
  for (std::size_t k = 0; k < points.size(); ++k)
    if (const Vector d = points[(k + 1) % points.size()] - points[k]; !(dot(d, d) > 0.0))
      throw InputError(written[in_order[k].side].x.place(), "the same point twice in a row",
                       "different points; the curve closes automatically");
  const std::vector<std::vector<Vector>> pieces = spline_pieces(points);
  const std::vector<std::string> names = numbered(layout.stem, points.size());
  Chain chain;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::vector<Vector>& control = pieces[k];
    chain.push_back({names[in_order[k].side],
                     Bezier{control[0], control[3], {control[1], control[2]}, 3}, smooth});
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
