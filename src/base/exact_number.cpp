#include "carom/base/exact_number.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "expression.hpp"

namespace carom {

using namespace base;

ExactNumber::ExactNumber(double value) {
  if (!std::isfinite(value)) throw InputError("a number must be finite");
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  text_.assign(buffer.data(), end);
  expression_ = expression::leaf({mpq_class(value), 1, 0});
  rounded_ = value;
}

// Rounding here and not when asked keeps const access free of writes, so that threads may share it.
ExactNumber::ExactNumber(std::string_view text, Place place)
    : text_(text), place_(std::move(place)) {
  expression_ = expression::parse(text_, place_);
  try {
    rounded_ = expression::nearest_double(*expression_);
  } catch (const expression::NoValue& reason) {
    throw InputError(place_, reason.what());
  }
}

double ExactNumber::to_double() const {
  if (!expression_) return 0.0;
  if (rounded_) return *rounded_;
  throw InputError(place_, "the number is too large", "at most 1.7976931348623157e308 in size");
}

std::optional<RationalText> ExactNumber::to_rational() const {
  if (!expression_) return RationalText{"0", "1"};
  const bool leaf = expression_->operation == Node::Operation::leaf;
  if (!leaf || !expression_->closed.is_rational()) return std::nullopt;
  const mpq_class& value = expression_->closed.coefficient;
  return RationalText{value.get_num().get_str(), value.get_den().get_str()};
}

}  // namespace carom
