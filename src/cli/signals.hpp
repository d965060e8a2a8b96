// What a signal does.
#pragma once

#include <atomic>

namespace carom::cli {

/// From now on Ctrl-C, SIGTERM and SIGHUP (unless it was ignored) set a flag; a second one ends the
/// program at once. So does SIGXCPU, however often it comes.
const std::atomic<bool>& catch_interrupts();

/// While one lives, no loop looks at the flag: a second after a signal the program ends.
struct Reading {
  Reading();
  Reading(const Reading&) = delete;
  ~Reading();
};

}  // namespace carom::cli
