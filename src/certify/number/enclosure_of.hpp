// The ball behind a certified number.
#pragma once

#include "carom/certify/certified_orbit.hpp"
#include "certify/number/ball.hpp"

namespace carom::certify {

const Ball& ball_of(const CertifiedNumber&);
CertifiedNumber number_of(Ball);

}  // namespace carom::certify
