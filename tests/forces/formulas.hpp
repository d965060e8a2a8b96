// Formulas for the tests.
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "carom/forces/typed_expression.hpp"

namespace carom {

using FortyDigits = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<40>,
                                                  boost::multiprecision::et_off>;

inline TypedExpression formula(const std::string& text,
                               const std::map<std::string, double>& parameters = {}) {
  static const std::vector<std::string> variables = {"x", "y"};
  return TypedExpression::parse(text, variables, parameters,
                                Place{"a.toml", 7, 15, "potential[0].expression"});
}

inline double value_at(const TypedExpression& f, double x, double y) {
  const double at[] = {x, y};
  return f.value(at);
}

struct ValueAndGradient {
  double value, x, y;
};

inline ValueAndGradient gradient_at(const TypedExpression& f, double x, double y) {
  const double at[] = {x, y};
  double slopes[2];
  const double value = f.value_and_gradient(at, slopes);
  return {value, slopes[0], slopes[1]};
}

}  // namespace carom
