#include "certify/wall/curve_of_formulas.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <string_view>

#include "base/formula_words.hpp"
#include "certify/number/exact_value.hpp"

namespace carom::certify {
namespace {

using Function = base::Operation;

Ball indeterminate() { return made<Ball>(arb_indeterminate); }

Series without_derivatives(const Ball& value) {
  Series r(value);
  for (slong k = 1; k < Series::terms(); ++k) r.set(k, indeterminate());
  return r;
}

Series power(const Series& a, const Ball& exponent) {
  Series r;
  const slong n = Series::terms(), bits = Precision::bits();
  const bool below = sign(exponent) == Sign::negative;
  if (arb_is_int(exponent.raw()) != 0 && size_of(exponent) < Bound(1000.0)) {
    // Products: of numbers below zero, and about it, too.
    const auto times = static_cast<ulong>(std::fabs(exponent.to_double()));
    arb_poly_pow_ui_trunc_binexp(r.raw(), a.raw(), times, n, bits);
    return below ? Series(1.0) / r : r;
  }
  arb_poly_pow_arb_series(r.raw(), a.raw(), exponent.raw(), n, bits);
  return r;
}

Series of_one(Function function, const Series& a) {
  const slong bits = Precision::bits(), n = Series::terms();
  const Ball about = a[0];
  Series f, g;
  Ball value;
  switch (function) {
    case Function::root:
      arb_poly_sqrt_series(f.raw(), a.raw(), n, bits);
      arb_sqrt(value.raw(), about.raw(), bits);  // the series has a wider one
      f.set(0, value);
      return f;
    case Function::exp:
      arb_poly_exp_series(f.raw(), a.raw(), n, bits);
      return f;
    case Function::log:
      arb_poly_log_series(f.raw(), a.raw(), n, bits);
      return f;
    case Function::sin:
      arb_poly_sin_cos_series(f.raw(), g.raw(), a.raw(), n, bits);
      return f;
    case Function::cos:
      arb_poly_sin_cos_series(f.raw(), g.raw(), a.raw(), n, bits);
      return g;
    case Function::tan:
      arb_poly_tan_series(f.raw(), a.raw(), n, bits);
      return f;
    case Function::sinh:
    case Function::cosh:
    case Function::tanh:
      arb_poly_sinh_cosh_series(f.raw(), g.raw(), a.raw(), n, bits);
      if (function != Function::tanh) return function == Function::sinh ? f : g;
      f = f / g;
      arb_tanh(value.raw(), about.raw(), bits);
      f.set(0, value);
      return f;
    default:  // abs
      if (sign(about) == Sign::positive) return a;
      if (sign(about) == Sign::negative) return -a;
      arb_abs(value.raw(), about.raw());
      return a.is_constant() ? Series(value) : without_derivatives(value);
  }
}

Series of_two(Function function, const Series& a, const Series& b) {
  const slong bits = Precision::bits(), n = Series::terms();
  if (function != Function::atan2) {
    const Sign order = sign(a[0] - b[0]);
    if (order == Sign::undecided || order == Sign::zero)
      return without_derivatives(indeterminate());
    return (order == Sign::negative) == (function == Function::least) ? a : b;
  }
  // Of y = a and x = b. It jumps where y = 0 > x.
  const Ball y = a[0], x = b[0];
  if (sign(x) != Sign::positive && sign(y) != Sign::positive && sign(y) != Sign::negative)
    return without_derivatives(indeterminate());
  Series r = a, s = b;
  arb_poly_derivative(r.raw(), r.raw(), bits);
  arb_poly_derivative(s.raw(), s.raw(), bits);
  r = (b * r - a * s) / (a * a + b * b);
  arb_poly_integral(r.raw(), r.raw(), bits);
  arb_poly_truncate(r.raw(), n);
  Ball value;
  arb_atan2(value.raw(), y.raw(), x.raw(), bits);
  r.set(0, value);
  return r;
}

/// What a formula's text means (base/expression_grammar.hpp). It has been read before, so that
/// nothing here is wrong.
class InBalls {
 public:
  using Value = Series;
  static constexpr const base::Dialect& dialect = base::formula_dialect;

  explicit InBalls(const std::map<std::string, Series>& numbers) : numbers_(numbers) {}

  static std::string empty() { return {}; }
  static void check_exponent(const Series&) {}
  static Series operate(char what, const Series& a, const Series& b) {
    return what == '+' ? a + b : what == '-' ? a - b : what == '*' ? a * b : a / b;
  }
  static Series negative(const Series& a) { return -a; }
  static Series power(const Series& a, const Series& b) {
    if (b.is_constant()) return certify::power(a, b[0]);
    return of_one(Function::exp, b * of_one(Function::log, a));
  }
  static Series decimal(std::string_view text) { return {value_of(ExactNumber(text))}; }
  Series named(const std::string& word, bool) const {
    if (const auto found = numbers_.find(word); found != numbers_.end()) return found->second;
    Ball r;
    if (word == "pi")
      arb_const_pi(r.raw(), Precision::bits());
    else
      arb_const_e(r.raw(), Precision::bits());
    return r;
  }
  static int arguments_of(const std::string& word) { return base::arguments_of_formula_word(word); }
  static Series call(const std::string& word, const std::vector<Series>& of) {
    const Function function = base::formula_word(word)->operation;
    return of.size() == 1 ? of_one(function, of[0]) : of_two(function, of[0], of[1]);
  }

 private:
  const std::map<std::string, Series>& numbers_;
};

/// What is seen from a formula's text of how it repeats.
struct Repetition {
  enum Kind { constant, multiple, periodic, unknown } kind = constant;
  double whole = NAN;  ///< of a constant: its value if that is whole; of k t + constant: k
};

class Repeats {
 public:
  using Value = Repetition;
  static constexpr const base::Dialect& dialect = base::formula_dialect;

  Repeats(const char* name, const std::map<std::string, ExactNumber>& numbers)
      : name_(name), numbers_(numbers) {}

  static std::string empty() { return {}; }
  static void check_exponent(const Repetition&) {}
  static Repetition negative(const Repetition& a) { return {a.kind, -a.whole}; }
  static Repetition operate(char what, const Repetition& a, const Repetition& b) {
    if (what == '-') return operate('+', a, negative(b));
    if (a.kind != Repetition::multiple && b.kind != Repetition::multiple) return together(a, b);
    if (what == '+' && a.kind == b.kind) return multiple(a.whole + b.whole);
    const Repetition &t = a.kind == Repetition::multiple ? a : b, &other = &t == &a ? b : a;
    if (other.kind != Repetition::constant || what == '/') return {Repetition::unknown};
    return multiple(what == '+' ? t.whole : t.whole * other.whole);
  }
  static Repetition power(const Repetition& a, const Repetition& b) { return together(a, b); }
  static Repetition decimal(std::string_view text) { return number(ExactNumber(text)); }
  Repetition named(const std::string& word, bool) const {
    if (word == name_) return multiple(1.0);
    const auto found = numbers_.find(word);
    return found == numbers_.end() ? Repetition{} : number(found->second);
  }
  static int arguments_of(const std::string& word) { return base::arguments_of_formula_word(word); }
  static Repetition call(const std::string& word, const std::vector<Repetition>& of) {
    const bool turns = word == "sin" || word == "cos" || word == "tan";
    if (turns && of[0].kind == Repetition::multiple) return {Repetition::periodic};
    return of.size() == 1 ? together(of[0], of[0]) : together(of[0], of[1]);
  }

 private:
  static Repetition multiple(double k) {
    return {std::isnan(k) ? Repetition::unknown : Repetition::multiple, k};
  }
  static Repetition number(const ExactNumber& x) {
    const double value = x.to_double();
    const bool whole = value == std::floor(value) && x.to_rational().has_value() &&
                       x.to_rational()->denominator == "1";
    return {Repetition::constant, whole ? value : NAN};
  }
  /// Of a function of both that is no sum.
  static Repetition together(const Repetition& a, const Repetition& b) {
    if (a.kind == Repetition::constant && b.kind == Repetition::constant) return {};
    const auto repeats = [](const Repetition& r) {
      return r.kind == Repetition::constant || r.kind == Repetition::periodic;
    };
    return {repeats(a) && repeats(b) ? Repetition::periodic : Repetition::unknown};
  }

  std::string name_;
  const std::map<std::string, ExactNumber>& numbers_;
};

bool repeats(const table::shapes::CurveFormulas& curve) {
  Repeats meaning(curve.polar ? "phi" : "t", curve.numbers);
  const auto kind = [&](const WrittenFormula& formula) {
    return base::Grammar(formula.text, formula.place, meaning).parse().kind;
  };
  const auto goes_round = [](Repetition::Kind k) {
    return k == Repetition::constant || k == Repetition::periodic;
  };
  return curve.from.text() == "0" && curve.to.text() == "2*pi" && goes_round(kind(curve.first)) &&
         (curve.polar || goes_round(kind(curve.second)));
}

}  // namespace

CurveOfFormulas::CurveOfFormulas(table::shapes::CurveFormulas written)
    : written_(std::move(written)),
      centre_{value_of(written_.centre.x), value_of(written_.centre.y)} {
  for (const auto& [name, number] : written_.numbers) numbers_.emplace(name, value_of(number));
  periodic = repeats(written_);
  from = value_of(written_.from);
  length = value_of(written_.to) - from;
}

VectorOf<Series> CurveOfFormulas::about(const Ball& t) const {
  const Series parameter = Series::variable(t);
  std::map<std::string, Series> numbers = numbers_;
  numbers[written_.polar ? "phi" : "t"] = parameter;
  InBalls meaning(numbers);
  const auto value = [&](const WrittenFormula& formula) {
    return base::Grammar(formula.text, formula.place, meaning).parse();
  };
  const Series first = value(written_.first);
  if (!written_.polar) return {first, value(written_.second)};
  return {centre_.x + first * of_one(Function::cos, parameter),
          centre_.y + first * of_one(Function::sin, parameter)};
}

namespace {
geometry::Vector normal_at_start(const geometry::Bezier& curve) {
  const geometry::Vector way = curve.control(1) - curve.from;
  return (1.0 / length(way)) * left(way);
}
}  // namespace

ImplicitPiece::ImplicitPiece(const WrittenFormula& equation, const geometry::Bezier& beside,
                             const geometry::Bezier& next)
    : equation_(equation),
      beside_(beside),
      first_(normal_at_start(beside)),
      last_(normal_at_start(next)),
      off_(Ball(0).widened(Bound(0x1p-36 * geometry::length(beside.to - beside.from)))) {
  if (!is_beside(lowest, highest, 14))
    throw InputError(equation.place, "the curve is not proven to lie beside its Bézier curves",
                     "r(phi), or x(t) and y(t)");
}

Series ImplicitPiece::equation(const VectorOf<Series>& at) const {
  const std::map<std::string, Series> numbers{{"x", at.x}, {"y", at.y}};
  InBalls meaning(numbers);
  return base::Grammar(equation_.text, equation_.place, meaning).parse();
}
VectorOf<Series> ImplicitPiece::normal(const Ball& t) const {
  const Series share = Series::variable(t);
  const geometry::Vector more = last_ - first_;
  return {Series(first_.x) + share * more.x, Series(first_.y) + share * more.y};
}
Series ImplicitPiece::across(const Ball& t, const Ball& s) const {
  const Series::Terms two(2);
  const VectorOf<Series> base = beside_.about(t), n = normal(t);
  const Series way = Series::variable(s);
  return equation({base.x[0] + way * n.x[0], base.y[0] + way * n.y[0]});
}

/// The equation has opposite signs on both sides, and only rises or falls between them.
bool ImplicitPiece::is_beside(double low, double high, int depth) const {
  const Precision precision(128);
  const Series::Terms nine(9);
  const Ball middle(0.5 * (low + high)), half = Ball(0).widened(Bound(0.5 * (high - low)));
  // Taylor's series about the middle; the coefficient of its last term is that of somewhere.
  Series along = equation(beside_.about(middle));
  along.set(8, equation(beside_.about(middle + half))[8]);
  const Ball value = along.shifted(half)[0], slope = across(middle + half, off_)[1],
             end = slope * Ball(off_.radius().to_double());
  const Sign rises = sign(slope);
  if ((rises == Sign::positive || rises == Sign::negative) && sign(end - value) == rises &&
      sign(end + value) == rises)
    return true;
  const double there = 0.5 * (low + high);
  return depth > 0 && is_beside(low, there, depth - 1) && is_beside(there, high, depth - 1);
}

VectorOf<Series> ImplicitPiece::about(const Ball& t) const {
  if (!(sign(t - Ball(lowest)) == Sign::positive && sign(Ball(highest) - t) == Sign::positive))
    return {without_derivatives(indeterminate()), without_derivatives(indeterminate())};
  Ball off = off_, slope = across(t, off)[1];
  for (;;) {  // Newton's steps, as long as they help
    const Ball middle = off.midpoint(), nearer = middle - across(t, middle)[0] / slope;
    if (!(nearer.radius() * Bound(2.0) < off.radius())) break;
    off = nearer;
    slope = across(t, off)[1];
  }
  const VectorOf<Series> base = beside_.about(t), n = normal(t);
  Series way(off);
  for (slong k = 1, terms = Series::terms(); k < terms; ++k) {
    const Series::Terms some(k + 1);
    way.set(k, -(equation(base + way * n)[k] / slope));
  }
  return base + way * n;
}

}  // namespace carom::certify
