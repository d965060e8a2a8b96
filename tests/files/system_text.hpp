// System files as text, for tests. tests/cli/messages.txt has the messages of faults.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "carom/files/system_file.hpp"

namespace carom::tests {

/// A square and whatever else.
inline std::string square(const std::string& more = "") {
  return "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n" + more;
}

inline System read(const std::string& text, const SystemOverrides& overrides = {}) {
  return read_system(text, "test.toml", overrides).system;
}

/// The InputError that reading gives, or one with the problem "no fault".
inline InputError fault(const std::string& text, const SystemOverrides& overrides = {}) {
  try {
    read(text, overrides);
  } catch (const InputError& error) {
    return error;
  }
  return InputError("no fault");
}

inline SystemOverrides set(const std::string& path, const std::string& value) {
  SystemOverrides overrides;
  overrides.set.emplace_back(path, value);
  return overrides;
}

}  // namespace carom::tests
