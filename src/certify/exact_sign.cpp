#include "certify/exact_sign.hpp"

#include "certify/with_pi.hpp"

namespace carom::certify {

Sign sign_of(const ExactNumber& number) {
  return sign_by([&] { return value_of(number); },
                 [&]() -> std::optional<Sign> {
                   if (is_zero(WithPi(number))) return Sign::zero;
                   return std::nullopt;
                 });
}

}  // namespace carom::certify
