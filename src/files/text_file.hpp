// Texts that users name, read up to a size: /dev/zero has no end.
#pragma once

#include <cstddef>
#include <string>

#include "carom/base/error.hpp"

namespace carom::files {

/// Of a system file: a million starts of four numbers with all their digits.
inline constexpr std::size_t most_of_system_file = std::size_t{128} << 20;
/// Of a file that a `path` names: twice a million lines of four numbers with all their digits.
inline constexpr std::size_t most_of_number_file = std::size_t{256} << 20;

/// That a text has more than `most` bytes. `subject` begins the message: "" or "'NAME' ".
inline InputError too_long(const Place& place, std::size_t most, const std::string& subject = "",
                           const std::string& expected = "") {
  return InputError(place, subject + "is longer than " + std::to_string(most >> 20) + " MB",
                    expected);
}

/// The text of a file or a pipe. Throws InputError with `place` and `expected` where it cannot be
/// read, is a folder, or is longer than `most` bytes. A pipe that nothing writes to is empty after
/// a second.
std::string text_of_file(const std::string& name, std::size_t most, const Place& place,
                         const std::string& subject, const std::string& expected);

}  // namespace carom::files
