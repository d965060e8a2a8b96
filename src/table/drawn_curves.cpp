// Curves that are written as formulas, as Bézier curves.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "carom/base/elementary.hpp"
#include "carom/base/whole_number.hpp"
#include "carom/geometry/curve_frame.hpp"
#include "carom/geometry/prepared_curve.hpp"
#include "forces/formula_series.hpp"
#include "table/closed_curves.hpp"
#include "table/numbers.hpp"
#include "table/quintic.hpp"

namespace carom::table::shapes {
namespace {

using geometry::Bezier;
using geometry::Vector;

constexpr double two_pi = 6.283185307179586;

using Formula = TypedExpression;
using forces::complex_box::Range;

/// An upper bound: the factor is above what its three roundings can change.
double length_of(Range x, Range y) {
  const double a = largest(x), b = largest(y);
  return 1.0001 * std::sqrt(a * a + b * b);
}

using Numbers = std::map<std::string, double>;

/// `numbers`: by the names that the formula has for them.
Formula parsed(const WrittenFormula& written, const char* variable, const Numbers& numbers = {}) {
  const std::vector<std::string> variables{variable};
  return Formula::parse(written.text, variables, numbers, written.place);
}

/// r(phi) about a centre.
struct Polar {
  static constexpr const char* variable = "phi";
  static constexpr const char* expected =
      "a radius that is positive, smooth and has the period 2 pi";
  Place place;
  Formula radius;
  Vector centre{};
  double from = 0.0, to = two_pi;

  Jet jet(double phi) const {
    double slope = 0.0, bend = 0.0;
    const double r = radius.value_gradient_and_hessian({&phi, 1}, {&slope, 1}, {&bend, 1});
    const elementary::SinCos t = elementary::sincos(phi);
    const Vector out{t.cos, t.sin}, across{-t.sin, t.cos};
    // Nothing where the radius is negative, too.
    return {phi, (r > 0.0 ? r : NAN) * out, slope * out + r * across,
            (bend - r) * out + (2.0 * slope) * across};
  }
  /// The sixth derivative over 6! of r e^(i phi), turned back by e^(-i phi), between two angles.
  double sixth(double low, double high) const {
    const forces::SeriesOfRanges phi{Range{low, high}, Range{1.0, 1.0}};
    const forces::SeriesOfRanges r = forces::series_along(radius, {&phi, 1});
    return length_of(r[6] - 0.5 * r[4] + (1.0 / 24.0) * r[2] - (1.0 / 720.0) * r[0],
                     r[5] - (1.0 / 6.0) * r[3] + (1.0 / 120.0) * r[1]);
  }
};

/// x(t), y(t).
struct Parametric {
  static constexpr const char* variable = "t";
  static constexpr const char* expected = "x and y that are smooth, and end as they begin";
  Place place;
  Formula x, y;
  double from, to;

  Jet jet(double t) const {
    Jet j{t, {}, {}, {}};
    j.x.x = x.value_gradient_and_hessian({&t, 1}, {&j.first.x, 1}, {&j.second.x, 1});
    j.x.y = y.value_gradient_and_hessian({&t, 1}, {&j.first.y, 1}, {&j.second.y, 1});
    return j;
  }
  /// The sixth derivative over 6! between two parameters.
  double sixth(double low, double high) const {
    const forces::SeriesOfRanges t{Range{low, high}, Range{1.0, 1.0}};
    return length_of(forces::series_along(x, {&t, 1})[6], forces::series_along(y, {&t, 1})[6]);
  }
};

/// A closed curve given by formulas, as Bézier curves.
template <class Curve>
class Drawing {
 public:
  explicit Drawing(Curve curve) : curve_(std::move(curve)) {}

  ClosedCurve walls(const Layout& layout) {
    // Four parts at least, so that no piece of a simple curve turns by more than a right angle.
    constexpr std::size_t parts = 4;
    std::array<Jet, parts + 1> jets;
    const double length = curve_.to - curve_.from;
    for (std::size_t k = 0; k < parts; ++k) {
      jets[k] = jet(curve_.from + length * (0.25 * static_cast<double>(k)));
      size_ = std::max(size_, length_of(jets[k].x));
    }
    jets[parts] = closing(jets[0]);
    for (std::size_t k = 0; k < parts; ++k) cut(jets[k], jets[k + 1], 0);
    // Where both derivatives of the first order vanish, at its start, the curve turns back.
    const bool cusp = jets[0].first == Vector{};
    Chain chain;
    for (const auto& [piece, from, to] : pieces_)
      chain.push_back({"", piece, chain.empty() && cusp ? 0 : smooth, from, to});
    if ((area_of(chain) < 0.0) != layout.clockwise) chain = reversed(std::move(chain));
    const std::vector<std::string> names = numbered(layout.stem, chain.size());
    for (std::size_t k = 0; k < chain.size(); ++k) chain[k].name = names[k];
    return {std::move(chain), errors_};
  }

 private:
  static constexpr int deepest = 12;  ///< halvings of a quarter of the curve

  static double length_of(Vector v) { return std::sqrt(dot(v, v)); }
  [[noreturn]] void refuse(const std::string& problem, double at) const {
    throw InputError(curve_.place,
                     problem + " near " + Curve::variable + " = " + std::to_string(at),
                     Curve::expected);
  }

  Jet jet(double at) const {
    const Jet j = curve_.jet(at);
    for (const Vector& v : {j.x, j.first, j.second})
      if (!std::isfinite(v.x) || !std::isfinite(v.y))
        refuse("the curve or one of its first two derivatives has no value", at);
    return j;
  }
  /// The end is the start. By how much the formulas miss it moves the last piece, and counts in
  /// its distance from the curve (`missed`); what no piece is short enough for is refused.
  Jet closing(const Jet& start) {
    Jet end = jet(curve_.to);
    gap_ = {curve_.to, end.x - start.x, end.first - start.first, end.second - start.second};
    if (missed(std::ldexp(0.25 * (curve_.to - curve_.from), -deepest)) > most_distance * size_)
      refuse(
          "the curve does not close smoothly: it ends elsewhere, in another direction, or with "
          "another curvature",
          curve_.to);
    end = start;
    end.at = curve_.to;
    return end;
  }
  /// A piece of that length whose end is displaced by the gap moves by no more: the polynomials
  /// that it is multiplied by are below 1, the length, and its square.
  double missed(double length) const {
    return length_of(gap_.x) + length * (length_of(gap_.first) + length * length_of(gap_.second));
  }

  void cut(const Jet& a, const Jet& b, int depth) {
    // How far the quintic is from the curve at most: docs/physics/exactness.md, Bézier curves.
    const double h = 0.5 * (b.at - a.at), h3 = h * h * h;
    const double off =
        h3 * h3 * curve_.sixth(a.at, b.at) + (b.at == curve_.to ? missed(b.at - a.at) : 0.0);
    if (off <= most_distance * size_) {
      const Bezier piece = quintic(a, b);
      const CurveErrors errors = errors_between(a, piece, off);
      if (as_promised(errors, size_)) {
        pieces_.push_back({piece, a.at, b.at});
        include(errors_, errors);
        return;
      }
    }
    const Jet middle = jet(0.5 * (a.at + b.at));
    if (depth == deepest) refuse("the curve is too wild for Bézier curves", middle.at);
    cut(a, middle, depth + 1);
    cut(middle, b, depth + 1);
  }

  CurveErrors errors_between(const Jet& a, const Bezier& piece, double off) const {
    try {
      return errors_of(piece, off);
    } catch (const std::invalid_argument&) {
      if (a.at == curve_.from)
        refuse("the curve has a cusp beside its start, where its derivative is not 0 in doubles,",
               a.at);
      refuse("the curve has a cusp, which only its start can be,", a.at);
    }
  }

  Curve curve_;
  double size_ = 0.0;
  CurveErrors errors_;
  Jet gap_{};  ///< between the formulas' end and their start
  struct Part {
    Bezier piece;
    double from, to;
  };
  std::vector<Part> pieces_;
};

CurveFormulas parametric_with(const WrittenFormula& x, const WrittenFormula& y,
                              const std::optional<ExactNumber>& from,
                              const std::optional<ExactNumber>& to) {
  CurveFormulas curve{false, x, y};
  if (from) curve.from = *from;
  if (to || from) curve.to = to ? *to : ExactNumber("2*pi", from->place());
  return curve;
}

const WrittenFormula& formula(const TableSpec& spec, const char* key, const char* example) {
  const auto found = spec.formulas.find(key);
  if (found != spec.formulas.end()) return found->second;
  throw InputError(place_of(spec, key), "the shape '" + spec.shape + "' needs '" + key + "'",
                   std::string("a formula, as in ") + example);
}

std::optional<ExactNumber> given(const TableSpec& spec, const char* key) {
  const auto found = spec.numbers.find(key);
  if (found == spec.numbers.end()) return std::nullopt;
  return found->second;
}

}  // namespace

ClosedCurve drawn(const CurveFormulas& written, const Layout& layout) {
  Numbers numbers;
  for (const auto& [name, value] : written.numbers) numbers.emplace(name, value.to_double());
  const Place& place = written.first.place;
  if (!written.polar) {
    const double from = written.from.to_double(), to = written.to.to_double();
    if (!(to > from))
      throw InputError(written.to.place(), "'to' is not larger than 'from'", "from < to");
    return Drawing(Parametric{place, parsed(written.first, "t", numbers),
                              parsed(written.second, "t", numbers), from, to})
        .walls(layout);
  }
  ClosedCurve curve = Drawing(Polar{place, parsed(written.first, "phi", numbers)}).walls(layout);
  const Vector centre = point(written.centre);
  if (centre == Vector{}) return curve;
  CurveErrors moved;
  for (NamedCurve& wall : curve.chain) {
    auto& piece = std::get<Bezier>(wall.curve);
    piece.from = piece.from + centre;
    piece.to = piece.to + centre;
    for (Vector& control : piece.inner) control = control + centre;
    // Rounding moves control points by r at most, and the derivatives of a quintic by 10 r and 80
    // r: no more than errors_of() takes for a distance of 3.4 r.
    double farthest = 0.0;
    for (int i = 0; i <= piece.degree; ++i)
      farthest = std::max({farthest, std::fabs(piece.control(i).x), std::fabs(piece.control(i).y)});
    try {
      include(moved, errors_of(piece, 3.4 * 1.415 * geometry::unit_roundoff * farthest));
    } catch (const std::invalid_argument&) {
      throw InputError(place, "the curve is too small for its distance from the origin",
                       "a larger curve, or one nearer to the origin");
    }
  }
  curve.errors.distance += moved.distance;
  curve.errors.normal += moved.normal;
  curve.errors.curvature += moved.curvature;
  return curve;
}

namespace {
/// A number whose absolute value is below a bound, which is written as `text`.
const ExactNumber& below(const TableSpec& spec, const char* key, double bound, const char* text) {
  const ExactNumber& value = number(spec, key);
  if (std::fabs(value.to_double()) < bound) return value;
  throw InputError(value.place(),
                   std::string("'") + key + "' is " + value.text() +
                       ", from where on the curve has a cusp or crosses itself",
                   std::string("a number above -") + text + " and below " + text);
}
std::uint64_t whole(const TableSpec& spec, const char* key, std::uint64_t low, std::uint64_t high,
                    std::uint64_t step) {
  const ExactNumber& value = number(spec, key);
  const auto n = whole_number(value, low, high);
  if (n && *n % step == 0) return *n;
  throw InputError(value.place(), std::string("'") + key + "' is " + value.text(),
                   std::string(step == 2 ? "an even" : "a whole") + " number from " +
                       std::to_string(low) + " to " + std::to_string(high));
}

/// A length that has been checked.
ExactNumber length(const TableSpec& spec, const char* key) {
  size(spec, key);
  return number(spec, key);
}

CurveFormulas cardioid(const TableSpec& spec) {
  // From cusp to cusp.
  return {false,
          {"R*(cos(t) - 1)*cos(t)", spec.shape_place},
          {"R*(cos(t) - 1)*sin(t)", spec.shape_place},
          {{"R", length(spec, "radius")}}};
}
CurveFormulas limacon(const TableSpec& spec) {
  return {true,
          {"R*(1 + eps*cos(phi))", spec.shape_place},
          {},
          {{"R", length(spec, "radius")}, {"eps", below(spec, "epsilon", 1.0, "1")}}};
}
CurveFormulas flower(const TableSpec& spec) {
  return {true,
          {"R*(1 + eps*cos(n*phi))", spec.shape_place},
          {},
          {{"R", length(spec, "radius")},
           {"eps", below(spec, "epsilon", 1.0, "1")},
           {"n", static_cast<double>(whole(spec, "petals", 1, 100, 1))}}};
}
CurveFormulas superellipse(const TableSpec& spec) {
  // An exponent that is a number in the formula is a product, which a negative number has, too.
  const std::string n = std::to_string(whole(spec, "exponent", 2, 20, 2));
  return {true,
          {"((cos(phi)/a)^" + n + " + (sin(phi)/b)^" + n + ")^(-1/" + n + ")", spec.shape_place},
          {},
          {{"a", length(spec, "a")}, {"b", length(spec, "b")}}};
}
CurveFormulas robnik(const TableSpec& spec) {
  return {false,
          {"R*(cos(t) + k*cos(2*t))", spec.shape_place},
          {"R*(sin(t) + k*sin(2*t))", spec.shape_place},
          {{"R", length(spec, "radius")}, {"k", below(spec, "lambda", 0.5, "1/2")}}};
}
CurveFormulas egg(const TableSpec& spec) {
  return {false,
          {"a*cos(t)", spec.shape_place},
          {"b*sin(t)*(1 + eps*cos(t))", spec.shape_place},
          {{"a", length(spec, "a")},
           {"b", length(spec, "b")},
           {"eps", below(spec, "epsilon", 1.0, "1")}}};
}
CurveFormulas typed_radius(const TableSpec& spec) {
  return {true, formula(spec, "radius", "\"1 + 0.5*cos(phi)\"")};
}
CurveFormulas typed_coordinates(const TableSpec& spec) {
  return parametric_with(formula(spec, "x", "\"2*cos(t)\""),
                         formula(spec, "y", "\"sin(t) + 0.3*cos(2*t)\""), given(spec, "from"),
                         given(spec, "to"));
}

const std::pair<const char*, CurveFormulas (*)(const TableSpec&)> curves[] = {
    {"polar", typed_radius}, {"parametric", typed_coordinates},
    {"cardioid", cardioid},  {"limacon", limacon},
    {"flower", flower},      {"superellipse", superellipse},
    {"robnik", robnik},      {"egg", egg}};

}  // namespace

std::optional<CurveFormulas> formulas_of(const TableSpec& spec) {
  for (const auto& [name, curve] : curves)
    if (spec.shape == name) return curve(spec);
  return {};
}

std::optional<CurveFormulas> formulas_of(const ObstacleSpec& o) {
  if (o.shape == ObstacleSpec::Shape::parametric) return parametric_with(o.x, o.y, o.from, o.to);
  if (o.shape != ObstacleSpec::Shape::polar) return {};
  CurveFormulas curve{true, o.radius_formula};
  curve.centre = o.center;
  return curve;
}

Shape curve_of_formulas(const TableSpec& spec) {
  ClosedCurve curve = drawn(*formulas_of(spec), {});
  Shape shape;
  shape.loops.push_back(std::move(curve.chain));
  shape.curve_errors = curve.errors;
  return shape;
}

}  // namespace carom::table::shapes
