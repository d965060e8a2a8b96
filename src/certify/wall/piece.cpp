#include "certify/wall/piece.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "carom/base/elementary.hpp"
#include "certify/wall/curve_of_formulas.hpp"
#include "certify/wall/hole.hpp"
#include "certify/wall/table_builder.hpp"
#include "motion/point_on_conic.hpp"
#include "table/spline.hpp"

namespace carom::certify {
namespace {

using namespace table::shapes;

/// Of a circle or an ellipse, by the angle from its start in the frame where it is a circle.
class ConicPiece final : public Piece {
 public:
  explicit ConicPiece(const WallOf<Ball>& w) : centre_(w.centre), a_(w.from - w.centre) {
    const BallVector b =
        w.form == Form::ellipse ? motion::quarter_turn(a_, w.along, w.across) : left(a_);
    b_ = w.turn < 0 ? -b : b;
    length = angle_of(w);
    periodic = w.closed;
  }
  VectorOf<Series> about(const Ball& t) const override {
    const Series parameter = Series::variable(t);
    Series s, c;
    arb_poly_sin_cos_series(s.raw(), c.raw(), parameter.raw(), Series::terms(), Precision::bits());
    return {centre_.x + c * a_.x + s * b_.x, centre_.y + c * a_.y + s * b_.y};
  }
  Ball parameter(double u) const override {
    const double quarter = std::floor(u);
    Ball pi, half;
    arb_const_pi(pi.raw(), Precision::bits());
    arb_atan(half.raw(), Ball(u - quarter).raw(), Precision::bits());
    return Ball(quarter) * pi / 2 + Ball(2) * half;
  }
  double u_of(double t) const override {
    const double quarter = std::floor(t / quarter_turn);
    const elementary::SinCos half = elementary::sincos(0.5 * (t - quarter * quarter_turn));
    return quarter + half.sin / half.cos;
  }

 private:
  static constexpr double quarter_turn = 1.5707963267948966;
  BallVector centre_, a_, b_;
};

std::unique_ptr<Piece> piece_of(const WrittenCurve& curve) {
  using Build = WallBuilder<Ball>;
  if (const auto* written = std::get_if<WrittenPiece>(&curve);
      written != nullptr && written->piece.kind == PieceSpec::Kind::bezier) {
    std::vector<BallVector> control{Build::point(written->from)};
    for (const ExactPoint& p : written->piece.control) control.push_back(Build::point(p));
    control.push_back(Build::point(written->piece.to));
    return std::make_unique<PolynomialPiece>(std::move(control));
  }
  const WallOf<Ball> wall = std::visit(Build{}, curve);
  if (wall.form == Form::segment)
    return std::make_unique<PolynomialPiece>(std::vector{wall.from, wall.to});
  return std::make_unique<ConicPiece>(wall);
}

std::vector<BallVector> control_of(const geometry::Bezier& curve) {
  std::vector<BallVector> control;
  for (int i = 0; i <= curve.degree; ++i)
    control.push_back({curve.control(i).x, curve.control(i).y});
  return control;
}

}  // namespace

PolynomialPiece::PolynomialPiece(std::vector<BallVector> control) {
  // Of u^k: the differences of the k-th order, times the binomial.
  Ball binomial(1);
  for (slong k = 0, n = static_cast<slong>(control.size()) - 1; !control.empty(); ++k) {
    x_.set(k, binomial * control.front().x);
    y_.set(k, binomial * control.front().y);
    binomial = binomial * Ball(static_cast<int>(n - k)) / Ball(static_cast<int>(k + 1));
    for (std::size_t i = 0; i + 1 < control.size(); ++i) control[i] = control[i + 1] - control[i];
    control.pop_back();
  }
}
PolynomialPiece::PolynomialPiece(const geometry::Bezier& curve)
    : PolynomialPiece(control_of(curve)) {}

VectorOf<Series> PolynomialPiece::about(const Ball& t) const {
  // Formulas of small numbers are narrower.
  const Ball middle = t.midpoint(), rest = t - middle;
  return {x_.shifted(middle).shifted(rest), y_.shifted(middle).shifted(rest)};
}

Pieces::Pieces(const TableSpec& spec, const Shape& shape) {
  const std::size_t own = shape.loops.size() - spec.obstacles.size();
  for (std::size_t l = 0; l < shape.loops.size(); ++l) {
    const ObstacleSpec* const obstacle = l < own ? nullptr : &spec.obstacles[l - own];
    const Chain& chain = shape.loops[l];
    if (!std::holds_alternative<geometry::Bezier>(chain.front().curve)) {
      for (const NamedCurve& wall : chain) add(piece_of(wall.curve), 1);
    } else if (auto formulas = obstacle ? formulas_of(*obstacle) : formulas_of(spec)) {
      auto curve = std::make_unique<CurveOfFormulas>(std::move(*formulas));
      curve->turn = chain.front().from < chain.front().to ? 1.0 : -1.0;
      add(std::move(curve), chain.size());
      for (std::size_t k = 0; k < chain.size(); ++k)
        parts_[parts_.size() - chain.size() + k] = {pieces_.size() - 1, chain[k].from, chain[k].to};
    } else if (!obstacle && spec.shape == "implicit") {
      for (std::size_t k = 0; k < chain.size(); ++k)
        add(std::make_unique<ImplicitPiece>(
                spec.formulas.at("equation"), std::get<geometry::Bezier>(chain[k].curve),
                std::get<geometry::Bezier>(chain[(k + 1) % chain.size()].curve)),
            1);
    } else {
      std::vector<BallVector> points;
      for (const SplinePoint& p : points_in_order(
               obstacle ? obstacle->points : spec.points.at("points"), obstacle != nullptr))
        points.push_back(WallBuilder<Ball>::point(p.at));
      for (std::vector<BallVector>& control : spline_pieces(points))
        add(std::make_unique<PolynomialPiece>(std::move(control)), 1);
    }
  }
}

void Pieces::add(std::unique_ptr<Piece> piece, std::size_t walls) {
  pieces_.push_back({std::move(piece), parts_.size(), walls});
  parts_.resize(parts_.size() + walls, {pieces_.size() - 1, 0.0, 1.0});
}

Pieces::Spot Pieces::spot(int wall, double u) const {
  const Part& part = parts_[static_cast<std::size_t>(wall)];
  return {part.piece, (*this)[part.piece].parameter(part.from + u * (part.to - part.from))};
}

Pieces::Ends Pieces::ends(int wall) const {
  const auto index = static_cast<std::size_t>(wall);
  const Part& part = parts_[index];
  const Walls& walls = pieces_[part.piece];
  const Piece& piece = *walls.piece;
  const Ball end = piece.from + piece.length;
  const bool forwards = piece.turn > 0.0;
  return {part.piece,
          index > walls.first ? Ball(part.from)
          : forwards          ? piece.from
                              : end,
          index + 1 < walls.first + walls.count ? Ball(part.to)
          : forwards                            ? end
                                                : piece.from,
          walls.count};
}

std::pair<int, double> Pieces::wall_at(const Spot& spot) const {
  const Walls& walls = pieces_[spot.piece];
  const double begin = walls.piece->from.to_double(), round = walls.piece->length.to_double();
  double t = spot.t.to_double();
  t -= round * std::floor((t - begin) / round);
  const auto first = parts_.begin() + static_cast<std::ptrdiff_t>(walls.first),
             last = first + static_cast<std::ptrdiff_t>(walls.count);
  if (walls.count == 1) return {static_cast<int>(walls.first), walls.piece->u_of(t)};
  const auto found = std::find_if(first, last, [&](const Part& part) {
    return std::min(part.from, part.to) <= t && t <= std::max(part.from, part.to);
  });
  if (found == last)  // by rounding, at the joint of both ends
    return {static_cast<int>(walls.first), 0.0};
  return {static_cast<int>(found - parts_.begin()), (t - found->from) / (found->to - found->from)};
}

}  // namespace carom::certify
