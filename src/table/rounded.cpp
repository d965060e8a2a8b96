// Written curves in doubles: each number is rounded once.
#include <stdexcept>

#include "carom/geometry/curve_frame.hpp"
#include "table/direction.hpp"
#include "table/numbers.hpp"
#include "table/shapes.hpp"

namespace carom::table::shapes {
namespace {

using geometry::Vector;

struct Rounding {
  static Vector at(const WrittenPoint& p) {
    if (const auto* corner = std::get_if<RegularCorner>(&p))
      return direction(corner->angle, corner->part, corner->whole, corner->radius.to_double());
    return point(std::get<ExactPoint>(p));
  }

  geometry::Curve operator()(const WrittenSegment& s) const {
    return geometry::Segment{at(s.from), at(s.to)};
  }
  geometry::Curve operator()(const WrittenArc& s) const {
    return geometry::CircularArc{point(s.from), point(s.to), s.offset.to_double(), true};
  }
  geometry::Curve operator()(const WrittenCircle& s) const {
    return geometry::Circle{point(s.centre), size_of(s.radius, "radius"), s.counterclockwise};
  }
  geometry::Curve operator()(const WrittenEllipse& s) const {
    return geometry::Ellipse{point(s.centre), direction(s.angle, 0, 1, size_of(s.a, "a")),
                             size_of(derived(quoted(s.b) + "/" + quoted(s.a), s.b), "b/a"),
                             s.counterclockwise};
  }
  geometry::Curve operator()(const geometry::Bezier& s) const { return s; }
  geometry::Curve operator()(const WrittenPiece& s) const {
    return curve_of(s.piece, point(s.from), point(s.piece.to));
  }

 private:
  static geometry::Curve curve_of(const PieceSpec& piece, Vector from, Vector to) {
    switch (piece.kind) {
      case PieceSpec::Kind::line:
        return geometry::Segment{from, to};
      case PieceSpec::Kind::arc:
        try {
          return geometry::arc_through(from, point(piece.via), to);
        } catch (const std::invalid_argument&) {
          throw InputError(piece.place, "no circular arc leads through these three points",
                           "arc_via beside the straight line to arc_to");
        }
      case PieceSpec::Kind::bezier: {
        geometry::Bezier curve{from, to, {}, static_cast<int>(piece.control.size()) + 1};
        for (std::size_t i = 0; i < piece.control.size(); ++i)
          curve.inner[i] = point(piece.control[i]);
        try {
          geometry::frame_of(curve);
        } catch (const std::invalid_argument& fault) {
          throw InputError(piece.place, fault.what(), "control points that differ, no cusp");
        }
        return curve;
      }
      case PieceSpec::Kind::ellipse:
        break;
    }
    try {
      const double ratio = size_of(piece.ratio, "ellipse_ratio");
      return geometry::elliptic_arc_through(from, point(piece.via), to, direction(piece.angle),
                                            ratio);
    } catch (const std::invalid_argument&) {
      throw InputError(piece.place, "no elliptic arc leads through these three points",
                       "ellipse_via beside the straight line to ellipse_to");
    }
  }
};

}  // namespace

geometry::Curve rounded(const WrittenCurve& curve) { return std::visit(Rounding{}, curve); }

}  // namespace carom::table::shapes
