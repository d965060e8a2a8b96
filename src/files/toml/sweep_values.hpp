// The values that --sweep asks for, as numbers that are written.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace carom::files {

/// A key of the system file and the values that it takes, in their order.
struct SweptKey {
  std::string key;                  ///< "field.B"
  std::vector<std::string> values;  ///< numbers as they are written: "0.2", "1/3"
};

/// Most values of a key, and most points of a plane.
inline constexpr std::size_t most_swept = 10'000;

/// "field.B=lin:0:4:20", "…=log:1:1000:4" or "…=list:1/3,0.5,pi/4". Values between FROM and TO are
/// exact where they are rational. Throws InputError for what is no number, for a value that is
/// given twice and for a key that --sweep cannot read.
SweptKey swept_key(const std::string& typed);

}  // namespace carom::files
