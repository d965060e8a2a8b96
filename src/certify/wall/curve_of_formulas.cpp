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

using Function = base::FormulaFunction;

Ball indeterminate() {
  Ball r;
  arb_indeterminate(r.raw());
  return r;
}

/// A function of the parameter at all its values of a ball: value and two derivatives.
struct Jet {
  Ball value, first = 0, second = 0;
  bool constant = true;
};
Jet variable(const Ball& t) { return {t, 1, 0, false}; }

/// f(a), of the values and derivatives of f at a.
Jet chain(const Jet& a, const Ball& f, const Ball& f1, const Ball& f2) {
  if (a.constant) return {f};
  return {f, f1 * a.first, f2 * square(a.first) + f1 * a.second, false};
}
Jet operator+(const Jet& a, const Jet& b) {
  return {a.value + b.value, a.first + b.first, a.second + b.second, a.constant && b.constant};
}
Jet operator-(const Jet& a) { return {-a.value, -a.first, -a.second, a.constant}; }
Jet operator*(const Jet& a, const Jet& b) {
  return {a.value * b.value, a.first * b.value + a.value * b.first,
          a.second * b.value + Ball(2) * (a.first * b.first) + a.value * b.second,
          a.constant && b.constant};
}
Jet inverse(const Jet& a) {
  const Ball f = Ball(1) / a.value, f1 = -square(f);
  return chain(a, f, f1, Ball(-2) * (f * f1));
}
Jet without_derivatives(const Ball& value) {
  return {value, indeterminate(), indeterminate(), false};
}

Ball power_of(const Ball& a, const Ball& exponent) {
  Ball r;
  if (arb_is_int(exponent.raw()) != 0) {  // products: of numbers below zero, and about it, too
    fmpz_t n;
    fmpz_init(n);
    arf_get_fmpz(n, arb_midref(exponent.raw()), ARF_RND_NEAR);
    arb_pow_fmpz(r.raw(), a.raw(), n, Precision::bits());
    fmpz_clear(n);
  } else {
    arb_pow(r.raw(), a.raw(), exponent.raw(), Precision::bits());
  }
  return r;
}
/// Factors that vanish are left out: a negative power of zero has no value.
Jet power(const Jet& a, const Ball& exponent) {
  const Ball less = exponent - Ball(1), slope = exponent, bend = exponent * less;
  const auto term = [&](const Ball& factor, const Ball& at) {
    return sign(factor) == Sign::zero ? Ball(0) : factor * power_of(a.value, at);
  };
  return chain(a, term(1, exponent), term(slope, less), term(bend, less - Ball(1)));
}

Jet of_one(Function function, const Jet& a) {
  const slong bits = Precision::bits();
  Ball f, g;
  switch (function) {
    case Function::root:
      arb_sqrt(f.raw(), a.value.raw(), bits);
      g = Ball(1) / (Ball(2) * f);
      return chain(a, f, g, -(g / (Ball(2) * a.value)));
    case Function::exp:
      arb_exp(f.raw(), a.value.raw(), bits);
      return chain(a, f, f, f);
    case Function::log:
      arb_log(f.raw(), a.value.raw(), bits);
      g = Ball(1) / a.value;
      return chain(a, f, g, -square(g));
    case Function::sin:
      arb_sin_cos(f.raw(), g.raw(), a.value.raw(), bits);
      return chain(a, f, g, -f);
    case Function::cos:
      arb_sin_cos(f.raw(), g.raw(), a.value.raw(), bits);
      return chain(a, g, -f, -g);
    case Function::tan:
      arb_tan(f.raw(), a.value.raw(), bits);
      g = Ball(1) + square(f);
      return chain(a, f, g, Ball(2) * (f * g));
    case Function::sinh:
      arb_sinh_cosh(f.raw(), g.raw(), a.value.raw(), bits);
      return chain(a, f, g, f);
    case Function::cosh:
      arb_sinh_cosh(f.raw(), g.raw(), a.value.raw(), bits);
      return chain(a, g, f, g);
    case Function::tanh:
      arb_tanh(f.raw(), a.value.raw(), bits);
      g = Ball(1) - square(f);
      return chain(a, f, g, Ball(-2) * (f * g));
    default:  // abs
      if (sign(a.value) == Sign::positive) return a;
      if (sign(a.value) == Sign::negative) return -a;
      arb_abs(f.raw(), a.value.raw());
      return without_derivatives(f);
  }
}

Jet of_two(Function function, const Jet& a, const Jet& b) {
  if (function != Function::atan2) {
    const Sign order = sign(a.value - b.value);
    if (order == Sign::undecided || order == Sign::zero)
      return without_derivatives(indeterminate());
    return (order == Sign::negative) == (function == Function::least) ? a : b;
  }
  // Of y = a and x = b. It jumps where y = 0 > x.
  if (sign(b.value) != Sign::positive && sign(a.value) != Sign::positive &&
      sign(a.value) != Sign::negative)
    return without_derivatives(indeterminate());
  Jet r;
  arb_atan2(r.value.raw(), a.value.raw(), b.value.raw(), Precision::bits());
  const Ball distance2 = square(a.value) + square(b.value);
  r.first = (b.value * a.first - a.value * b.first) / distance2;
  r.second = (b.value * a.second - a.value * b.second -
              Ball(2) * (r.first * (a.value * a.first + b.value * b.first))) /
             distance2;
  r.constant = a.constant && b.constant;
  return r;
}

/// What a formula's text means (base/expression_grammar.hpp). It has been read before, so that
/// nothing here is wrong.
class InBalls {
 public:
  using Value = Jet;
  static constexpr const base::Dialect& dialect = base::formula_dialect;

  InBalls(const char* name, const Jet& variable, const std::map<std::string, ExactNumber>& numbers)
      : name_(name), variable_(variable), numbers_(numbers) {}

  static std::string empty() { return {}; }
  static void check_exponent(const Jet&) {}
  static Jet operate(char what, const Jet& a, const Jet& b) {
    return what == '+' ? a + b : what == '-' ? a + -b : what == '*' ? a * b : a * inverse(b);
  }
  static Jet negative(const Jet& a) { return -a; }
  static Jet power(const Jet& a, const Jet& b) {
    if (b.constant) return certify::power(a, b.value);
    return of_one(Function::exp, b * of_one(Function::log, a));
  }
  static Jet decimal(std::string_view text) { return {value_of(ExactNumber(text))}; }
  Jet named(const std::string& word, bool) const {
    if (word == name_) return variable_;
    if (const auto found = numbers_.find(word); found != numbers_.end())
      return {value_of(found->second)};
    Jet r;
    if (word == "pi")
      arb_const_pi(r.value.raw(), Precision::bits());
    else
      arb_const_e(r.value.raw(), Precision::bits());
    return r;
  }
  static int arguments_of(const std::string& word) { return base::arguments_of_formula_word(word); }
  static Jet call(const std::string& word, const std::vector<Jet>& of) {
    const Function function = base::formula_word(word)->function;
    return of.size() == 1 ? of_one(function, of[0]) : of_two(function, of[0], of[1]);
  }

 private:
  std::string name_;
  const Jet& variable_;
  const std::map<std::string, ExactNumber>& numbers_;
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
      periodic_(repeats(written_)),
      parts_(table::shapes::drawn(written_, {}).parameters) {}

std::optional<CurveOfFormulas> CurveOfFormulas::of(const TableSpec& spec) {
  if (!spec.obstacles.empty() || spec.lattice) return {};
  std::optional<table::shapes::CurveFormulas> written = table::shapes::formulas_of(spec);
  if (!written) return {};
  return CurveOfFormulas(std::move(*written));
}

CurvePlace CurveOfFormulas::at(const Ball& t) const {
  const Jet parameter = variable(t);
  InBalls meaning(written_.polar ? "phi" : "t", parameter, written_.numbers);
  const auto value = [&](const WrittenFormula& formula) {
    return base::Grammar(formula.text, formula.place, meaning).parse();
  };
  Jet x, y;
  if (written_.polar) {
    const Jet radius = value(written_.first);
    x = radius * of_one(Function::cos, parameter);
    y = radius * of_one(Function::sin, parameter);
  } else {
    x = value(written_.first);
    y = value(written_.second);
  }
  return {{x.value, y.value}, {x.first, y.first}, {x.second, y.second}};
}

std::pair<int, double> CurveOfFormulas::wall_at(double parameter) const {
  const double begin = from().to_double(), round = length().to_double();
  const double t = parameter - round * std::floor((parameter - begin) / round);
  const auto found = std::find_if(parts_.begin(), parts_.end(), [&](const auto& part) {
    return std::min(part.first, part.second) <= t && t <= std::max(part.first, part.second);
  });
  if (found == parts_.end()) return {0, 0.0};  // by rounding, at the joint of both ends
  return {static_cast<int>(found - parts_.begin()),
          (t - found->first) / (found->second - found->first)};
}

Ball CurveOfFormulas::from() const { return value_of(written_.from); }
Ball CurveOfFormulas::length() const { return value_of(written_.to) - from(); }

}  // namespace carom::certify
