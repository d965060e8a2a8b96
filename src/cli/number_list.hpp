// Lists of numbers as options take them.
#pragma once

#include <string>
#include <vector>

namespace carom::cli {

/// Reads "a,b,c", "lin:from:to:count" or "log:from:to:count" (from < to), at most 10^6 of them.
/// Throws InputError naming the option, what it takes ("levels"), and where it is no such list
/// `expected`.
std::vector<double> numbers_of(
    const std::string& text, const char* option, const char* what,
    const char* expected = "a,b,c or log:from:to:count or lin:from:to:count");

}  // namespace carom::cli
