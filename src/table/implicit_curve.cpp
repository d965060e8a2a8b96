// The closed curve on which a formula of x and y vanishes, as Bézier curves.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "carom/base/elementary.hpp"
#include "carom/forces/typed_expression.hpp"
#include "forces/formula_bound.hpp"
#include "forces/formula_series.hpp"
#include "table/numbers.hpp"
#include "table/quintic.hpp"
#include "table/shapes.hpp"

namespace carom::table::shapes {
namespace {

using geometry::Bezier;
using geometry::Box;
using geometry::Vector;

double length_of(Vector v) { return std::sqrt(dot(v, v)); }

/// A place on the curve, with the domain on the left: its curvature is that of the way along it.
struct Spot {
  Vector x, tangent;
  double curvature = 0.0;
};

/// The numbers of the two searches below (shortest and longest steps, how many, how near Newton's
/// method ends) decide what is tried and when it is given up, with the place. What is accepted is
/// decided by enclosures alone: an interval without or with one root, a piece within `distance`.
class ImplicitCurve {
 public:
  ImplicitCurve(const WrittenFormula& equation, const ExactPoint& inside)
      : place_(equation.place),
        f_(TypedExpression::parse(equation.text, std::vector<std::string>{"x", "y"}, {},
                                  equation.place)),
        inside_place_(inside.x.place()),
        inside_(point(inside)) {}

  Shape shape() {
    const double value = f_.value(std::array{inside_.x, inside_.y});
    if (!(value != 0.0 && std::isfinite(value)))
      throw InputError(inside_place_, "the equation is fulfilled, or has no value, at 'inside'",
                       "a point of the domain");
    side_ = value > 0.0 ? 1.0 : -1.0;
    const Spot start = to_the_right();
    // Once roughly, for how large it is.
    size_ = length_of(start.x - inside_);
    pieces_of(start, 0x1p-10);
    for (const Bezier& piece : pieces_)
      size_ = std::max(size_, 0.5 * length_of(piece.from - pieces_[0].from));
    pieces_of(start, most_distance);
    double area = 0.0;
    for (const Bezier& piece : pieces_) area += geometry::area_integral(piece);
    if (area < 0.0)
      refuse("the curve on the right of 'inside' does not go around it", start.x,
             "a point between which and the table's wall nothing lies in the direction of +x");
    Shape shape;
    shape.curve_errors = errors_;
    Chain chain;
    const std::vector<std::string> names = numbered("curve", pieces_.size());
    for (std::size_t k = 0; k < pieces_.size(); ++k)
      chain.push_back({names[k], pieces_[k], smooth});
    shape.loops.push_back(std::move(chain));
    return shape;
  }

 private:
  [[noreturn]] void refuse(const std::string& problem, Vector at,
                           const char* expected = "a smooth closed curve around 'inside'") const {
    throw InputError(place_, fmt::format("{} near ({:.4g}, {:.4g})", problem, at.x, at.y),
                     expected);
  }

  /// The first wall on the way from `inside` along +x: intervals in which the equation surely has
  /// no solution are passed over, until one has exactly one.
  Spot to_the_right() const {
    double x = inside_.x, step = 1.0;
    const auto over = [&](double high) {
      return forces::values_over(f_, {{x, inside_.y}, {high, inside_.y}});
    };
    for (;;) {
      const double high = x + step, smallest = 0x1p-40 * std::max(std::fabs(x), step);
      if (!(high < 0x1p60))
        throw InputError(inside_place_, "no wall on the right of 'inside'",
                         "a closed curve around it");
      const forces::ValuesOverBox here = over(high);
      if (!has_zero(here.value)) {
        x = high;
        step *= 2.0;
      } else if (!has_zero(here.slope_x) && value_at({high, inside_.y}) < 0.0) {
        return onto_curve({root(x, high), inside_.y}, step).value();
      } else if (high - x > smallest && step > 0x1p-60) {
        step *= 0.5;
      } else {
        refuse("the curve touches the line from 'inside' along +x", {x, inside_.y},
               "an 'inside' from which that line crosses the curve");
      }
    }
  }
  /// Positive in the domain.
  double value_at(Vector at) const { return side_ * f_.value(std::array{at.x, at.y}); }
  double root(double low, double high) const {
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (low + high);
      if (middle == low || middle == high) break;
      (value_at({middle, inside_.y}) < 0.0 ? high : low) = middle;
    }
    return low;
  }

  struct Local {
    double value;
    Vector slope;
    std::array<double, 4> second;
  };
  Local local(Vector at) const {
    Local l{};
    std::array<double, 2> slope{};
    l.value = side_ * f_.value_gradient_and_hessian(std::array{at.x, at.y}, slope, l.second);
    l.slope = {side_ * slope[0], side_ * slope[1]};
    return l;
  }
  /// Newton's method along the slope, to the rounding of the formula, which no bound counts; none
  /// where it does not converge, or not within `near`.
  std::optional<Spot> onto_curve(Vector x, double near) const {
    const Vector start = x;
    double last = HUGE_VAL;
    Local here = local(x);
    for (int i = 0; i < 30; ++i) {
      const double square = dot(here.slope, here.slope);
      const Vector step = (here.value / square) * here.slope;
      const double size = length_of(step);
      // Until rounding is all that moves it.
      if (!(size < last)) break;
      last = size;
      x = x - step;
      here = local(x);
    }
    const double steep = length_of(here.slope);
    if (!(last < 0x1p-40 * (length_of(x) + near)) || !(length_of(x - start) <= near) ||
        !(steep > 0.0 && steep < HUGE_VAL))
      return std::nullopt;
    Spot spot{x, (1.0 / steep) * right(here.slope), 0.0};
    const auto& [xx, xy, yx, yy] = here.second;
    const Vector t = spot.tangent;
    spot.curvature = -side_ * (t.x * (xx * t.x + xy * t.y) + t.y * (yx * t.x + yy * t.y)) / steep;
    if (!std::isfinite(spot.curvature)) return std::nullopt;
    return spot;
  }

  /// By how much a piece may be off the curve: docs/physics/exactness.md, Bézier curves.
  double distance(const Bezier& b) const {
    // x(u) and its derivatives lie in the hulls of their control points.
    forces::SeriesOfRanges x, y;
    std::array<Vector, 6> d;
    for (int i = 0; i < 6; ++i) d[static_cast<std::size_t>(i)] = b.control(i);
    double binomial = 1.0;
    for (std::size_t k = 0; k < 6; ++k) {
      x[k] = y[k] = {HUGE_VAL, -HUGE_VAL};
      for (std::size_t i = 0; i + k < 6; ++i) {
        const Vector p = binomial * d[i];
        x[k] = hull(x[k], {p.x, p.x});
        y[k] = hull(y[k], {p.y, p.y});
        if (i + k < 5) d[i] = d[i + 1] - d[i];
      }
      binomial = binomial * static_cast<double>(5 - k) / static_cast<double>(k + 1);
    }
    // The equation along it vanishes at both ends with its first two derivatives.
    const double most = 0x1p-6 * largest(forces::series_along(f_, std::array{x, y})[6]);
    // From a point of it the curve is met along the normal of its chord, within `most` over the
    // slope of the equation there.
    const Vector way = b.to - b.from, n = (1.0 / length_of(way)) * left(way);
    const double beside = 0x1p-10 * length_of(way);
    const forces::ValuesOverBox v = forces::values_over(
        f_, {{x[0].low - beside, y[0].low - beside}, {x[0].high + beside, y[0].high + beside}});
    const double slope = (side_ * (n.x * v.slope_x + n.y * v.slope_y)).low;
    return slope > 0.0 ? most / slope : HUGE_VAL;
  }

  static Bezier piece(const Spot& a, const Spot& b) {
    // The speed at which it is run through is the same at both ends, and such that the coefficient
    // of u^5 has no part along the chord: then it is nearly even.
    const Vector way = b.x - a.x;
    const double chord = length_of(way), along = dot(way, a.tangent + b.tangent),
                 bend = dot(way, b.curvature * left(b.tangent) - a.curvature * left(a.tangent)),
                 length = 4.0 * chord * chord /
                          (along + std::sqrt(along * along - (4.0 / 3.0) * bend * chord * chord));
    const auto jet = [&](double at, const Spot& s) {
      return Jet{at, s.x, length * s.tangent, (length * length * s.curvature) * left(s.tangent)};
    };
    return quintic(jet(0.0, a), jet(1.0, b));
  }

  /// The pieces from `start` around to it, each within `share` of the size off the curve.
  void pieces_of(const Spot& start, double share) {
    constexpr std::size_t most_pieces = 1 << 14;
    pieces_.clear();
    errors_ = {};
    Spot here = start;
    double step = 0.25 * size_;
    const double shortest = 0x1p-20 * size_;
    for (;;) {
      if (pieces_.size() == most_pieces || !(step > shortest))
        refuse("the curve has a corner, crosses itself or is too wild", here.x);
      if (length_of(here.x - inside_) > 0x1p20 * size_) refuse("the curve does not close", here.x);
      const Vector home = start.x - here.x;
      const bool closes = pieces_.size() > 2 && length_of(home) <= 1.5 * step &&
                          dot(home, here.tangent) > 0.0 && dot(start.tangent, here.tangent) > 0.0;
      const std::optional<Spot> next =
          closes ? start
                 : onto_curve(here.x + step * here.tangent +
                                  (0.5 * step * step * here.curvature) * left(here.tangent),
                              0.5 * step);
      // A piece turns by less than 45 degrees.
      double factor = 0.5;
      if (next && dot(next->tangent, here.tangent) > 0.7072) {
        const Bezier b = piece(here, *next);
        const double off = distance(b);
        // It grows with the sixth power of the step.
        if (off > 0.0 && off < HUGE_VAL)
          factor = std::clamp(0.9 * elementary::exp(elementary::log(share * size_ / off) / 6.0),
                              0.25, 2.0);
        const bool near = off <= share * size_;
        const CurveErrors errors = near ? errors_of(b, off) : CurveErrors{};
        if (near && (share > most_distance || as_promised(errors, size_))) {
          pieces_.push_back(b);
          include(errors_, errors);
          if (closes) return;
          here = *next;
        } else {
          factor = std::min(factor, 0.75);
        }
      }
      step *= factor;
    }
  }

  Place place_;
  TypedExpression f_;
  Place inside_place_;
  Vector inside_;
  double side_ = 1.0, size_ = 0.0;
  CurveErrors errors_;
  std::vector<Bezier> pieces_;
};

}  // namespace

Shape implicit_curve(const TableSpec& spec) {
  const auto equation = spec.formulas.find("equation");
  if (equation == spec.formulas.end())
    throw InputError(place_of(spec, "equation"), "the shape 'implicit' needs 'equation'",
                     "a formula of x and y, as in \"x^4 + y^4 - 1\"");
  const auto inside = spec.points.find("inside");
  if (inside == spec.points.end() || inside->second.size() != 1)
    throw InputError(place_of(spec, "inside"), "the shape 'implicit' needs 'inside'",
                     "a point of the domain, [x, y]");
  return ImplicitCurve(equation->second, inside->second[0]).shape();
}

}  // namespace carom::table::shapes
