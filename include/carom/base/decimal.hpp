// Doubles of decimal texts.
#pragma once

#include <optional>
#include <string_view>

namespace carom {

/// The double nearest to a decimal number as "-1.5e3", whatever the locale; "inf" and "nan" too.
/// Nothing where the whole text is no number, or none of a double's range.
std::optional<double> nearest_double(std::string_view decimal);

}  // namespace carom
