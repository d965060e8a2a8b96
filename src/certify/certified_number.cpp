// What certified orbits give out: numbers with their balls, and the names of fates.
#include <memory>
#include <utility>

#include "certify/enclosure_of.hpp"

namespace carom {

struct CertifiedNumber::Enclosure {
  certify::Ball ball;
};

namespace certify {

const Ball& ball_of(const CertifiedNumber& number) { return number.enclosure().ball; }

CertifiedNumber number_of(Ball ball) {
  return CertifiedNumber(std::make_shared<const CertifiedNumber::Enclosure>(CertifiedNumber::Enclosure{std::move(ball)}));
}

}  // namespace certify

std::string CertifiedNumber::text(int digits) const { return value_->ball.decimals(digits); }
double CertifiedNumber::to_double() const { return value_->ball.to_double(); }
double CertifiedNumber::log2_error() const { return value_->ball.radius().log2(); }

const char* name_of(CertifiedFate fate) {
  switch (fate) {
    case CertifiedFate::completed:
      return "completed";
    case CertifiedFate::escaped:
      return "escaped";
    case CertifiedFate::unbounded:
      return "unbounded";
    case CertifiedFate::pinned:
      return "pinned";
    case CertifiedFate::singular:
      return "singular";
    case CertifiedFate::interrupted:
      return "interrupted";
    case CertifiedFate::undecided:
      break;
  }
  return "undecided";
}

}  // namespace carom
