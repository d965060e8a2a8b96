// 40 digits for the integrators.
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <string>
#include <string_view>

#include "carom/integrators/arithmetic.hpp"

namespace carom {

using HighPrecision = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<40>,
                                                    boost::multiprecision::et_off>;

template <>
struct Arithmetic<HighPrecision> {
  static HighPrecision parse(std::string_view decimal) {
    return HighPrecision(std::string(decimal));
  }
  static SineCosine<HighPrecision> turn(const HighPrecision& angle) {
    return {sin(angle), cos(angle)};
  }
};

}  // namespace carom
