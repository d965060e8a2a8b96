// carom run --precision BITS: many digits, none of them guaranteed.
#include <fmt/format.h>

#include "carom/base/error.hpp"
#include "carom/certify/plain_orbit.hpp"
#include "carom/ensemble/stopwatch.hpp"
#include "cli/exact_run.hpp"

namespace carom::cli {

namespace {

constexpr const char* warning = "none: plain arithmetic does not know how much it has lost";

long bits_of(const Options& options) {
  const Place place{"command line", 0, 0, "--precision"};
  const char* expected = "double, certified, or a number of bits from 53 to 10000000";
  if (options.precision.empty() || options.precision.find_first_not_of("0123456789.e+") != std::string::npos)
    throw InputError(place, "'" + options.precision + "' is no precision", expected);
  const std::uint64_t bits = whole_number(options.precision, "--precision", 1);
  if (bits < 53 || bits > 10'000'000)
    throw InputError(place, fmt::format("{} bits are too few or too many", bits), expected);
  return static_cast<long>(bits);
}

PrintedEnd printed(const PlainEnd& end, const std::string& status) {
  return {status, end.collisions, end.wall, end.hole, end.cell, end.t, end.x, end.y, end.vx, end.vy, "", {}};
}

}  // namespace

int run_in_plain_numbers(const Options& options) {
  PlainTask task;
  task.bits = bits_of(options);
  if (!options.digits.empty())
    throw InputError(Place{"command line", 0, 0, "--digits"}, "digits in plain arithmetic are not guaranteed",
                     "--precision certified beside --digits");
  if (!options.output.empty())
    throw InputError(Place{"command line", 0, 0, "-o"},
                     "archives hold runs in double precision and certified ones only",
                     "no archive, or --precision certified");
  const LoadedSystem loaded = load_exact_run(options);
  task.collisions = loaded.system.run.collisions;
  if (loaded.system.run.t_max < no_last_time) task.t_max = loaded.t_max;
  const std::atomic<bool>& interrupts = catch_interrupts();
  bool interrupted = false;
  const Stopwatch watch;
  const PlainEnd end = plain_orbit(loaded.exact, task,
                                   [&] { return interrupted = interrupts.load(std::memory_order_relaxed); });
  const double seconds = watch.seconds(), cpu_seconds = watch.cpu_seconds();
  const std::string status = interrupted ? "interrupted" : name_of(end.fate);
  const PrintedEnd result = printed(end, status);
  if (options.json) {
    Json json = end_json(loaded.system, result, seconds, cpu_seconds);
    print(json.set("guarantee", false).set("bits", task.bits).text() + "\n");
  } else {
    print(end_text(loaded.system, result) + fmt::format("  guarantee     {}\n", warning) +
          fmt::format("  computed in   {:.3g} s, by {} bits\n", seconds, task.bits));
  }
  if (end.fate == PlainEnd::lost) return untrusted;
  return interrupted ? stopped : done;
}

}  // namespace carom::cli
