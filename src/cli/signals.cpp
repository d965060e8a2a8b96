#include "cli/signals.hpp"

#include <time.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>

#include "cli/options.hpp"

namespace carom::cli {

namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

// Nanoseconds of CLOCK_MONOTONIC at the first signal; 0: none came.
std::atomic<std::int64_t> first_signal{0};
static_assert(std::atomic<std::int64_t>::is_always_lock_free);

// While a system is read no loop looks at the flag: if that takes a second more, the signal ends
// the program. A sweep has what it has finished on the disk by then, and goes on with it.
std::atomic<bool> reading{false};
std::atomic<int> signal_while_reading{0};

extern "C" void on_patience_ended(int) {
  if (!reading) return;
  std::signal(signal_while_reading, SIG_DFL);
  std::raise(signal_while_reading);
}

// timeout and mpirun send a signal to the process and then to its group: the second one, at once,
// does not ask for an end without delay.
extern "C" void on_interrupt(int number) {
  if (reading) {
    signal_while_reading = number;
    std::signal(SIGALRM, on_patience_ended);
    ::alarm(1);
  }
  constexpr std::int64_t patience = 500'000'000;  // ns
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  const std::int64_t now = std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
  std::int64_t first = 0;
  if (!first_signal.compare_exchange_strong(first, now) && now - first > patience) _exit(stopped);
  interrupted = true;
}

// The system sends SIGXCPU every second from the soft limit of CPU time to the hard one, so a
// repetition is not a second signal.
extern "C" void on_limit(int) { interrupted = true; }

}  // namespace

Reading::Reading() { reading = true; }
Reading::~Reading() { reading = false; }

const std::atomic<bool>& catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction before {};
  const bool no_hangup =
      sigaction(SIGHUP, nullptr, &before) == 0 && before.sa_handler == SIG_IGN;  // nohup
  if (!no_hangup) sigaction(SIGHUP, &action, nullptr);
  action.sa_handler = on_limit;
  sigaction(SIGXCPU, &action, nullptr);
  return interrupted;
}

}  // namespace carom::cli
