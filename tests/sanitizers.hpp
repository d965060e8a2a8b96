// Is this program built with a sanitizer? Tests of limits that a sanitizer breaks skip themselves.
#pragma once

namespace carom {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool watched_for_addresses = true;
#elif defined(__has_feature)
constexpr bool watched_for_addresses = __has_feature(address_sanitizer);
#else
constexpr bool watched_for_addresses = false;
#endif

#if defined(__SANITIZE_THREAD__)
constexpr bool watched_for_races = true;
#elif defined(__has_feature)
constexpr bool watched_for_races = __has_feature(thread_sanitizer);
#else
constexpr bool watched_for_races = false;
#endif

/// Both keep shadows of all addresses: `ulimit -v` ends such a program at its start.
constexpr bool shadows_of_memory = watched_for_addresses || watched_for_races;

}  // namespace carom
