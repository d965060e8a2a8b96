// Numbers as a user writes them: "0.1" is one tenth, "sqrt(3)/2" is that.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "carom/base/error.hpp"

namespace carom {

/// A rational number as text, numerator and denominator > 0 in lowest terms (any length).
struct RationalText {
  std::string numerator;
  std::string denominator;
};

/// A number that means exactly what is written.
///
/// Grammar: decimals ("0.1", "1e-3"), pi, sqrt(...), + - * / ^ (integer powers), unary minus and
/// parentheses. Division by zero, the root of a negative number, nan, inf and anything else are an
/// InputError whose message points at the character.
class ExactNumber {
 public:
  ExactNumber() = default;                               ///< zero
  ExactNumber(double value);                             ///< exactly that double; NOLINT
  ExactNumber(std::string_view text, Place place = {});  ///< parses; throws InputError; NOLINT

  /// The nearest double (correctly rounded, ties to even). Throws InputError on overflow.
  double to_double() const;
  /// The exact value where the expression is rational.
  std::optional<RationalText> to_rational() const;
  const std::string& text() const { return text_; }
  const Place& place() const { return place_; }

  struct Node;  ///< the parsed expression; certified runs evaluate it to any precision
  const std::shared_ptr<const Node>& expression() const { return expression_; }

 private:
  std::string text_ = "0";
  Place place_;
  std::shared_ptr<const Node> expression_;  // null: zero
  std::optional<double> rounded_;           // empty: beyond the range of doubles
};

inline namespace literals {
/// "1/3"_exact
inline ExactNumber operator""_exact(const char* text, std::size_t length) {
  return ExactNumber(std::string_view(text, length));
}
}  // namespace literals

}  // namespace carom
