// The program. Exceptions become exit codes here and nowhere else.
#include <fcntl.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <functional>
#include <new>
#include <string>
#include <system_error>
#include <utility>

#include "carom/base/error.hpp"
#include "carom/files/archive.hpp"
#include "carom/starts/sampler.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/ensemble_job.hpp"
#include "cli/commands/sweep.hpp"
#include "cli/common.hpp"
#include "cli/picture.hpp"
#include "cli/ranks.hpp"
#include "cli/reports/aligned.hpp"

namespace {

// Where a standard stream is closed, the next file that is opened gets its number, and messages go
// into it. Standard output is opened for reading, so that writing results to it is an error.
void reserve_standard_streams() {
  for (const int stream : {0, 1, 2})
    if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF &&
        ::open("/dev/null", stream == 2 ? O_WRONLY : O_RDONLY) < 0)
      return;
}

// What hang-ups do, seen before any library begins: one below MPI (UCX) takes the signal for
// itself, also from nohup. Debian 13's SUNDIALS brings MPI.
struct sigaction hangup {};
void see_hangup(int, char**, char**) { ::sigaction(SIGHUP, nullptr, &hangup); }
[[gnu::section(".preinit_array"), gnu::used]] void (*const before_libraries)(int, char**,
                                                                             char**) = see_hangup;

using carom::cli::Options;

// As a program that knows nothing of pipes: silently, by the signal.
int end_by_closed_pipe() {
  std::signal(SIGPIPE, SIG_DFL);
  std::raise(SIGPIPE);
  return 128 + SIGPIPE;
}

// Each is in commands/, or in the command.cpp of its analysis.
int (*command_of(const std::string& name))(const Options&) {
  using namespace carom::cli;
  static const std::pair<const char*, int (*)(const Options&)> commands[] = {
      {"escape", escape}, {"run", run},           {"section", section}, {"orbit", orbit},
      {"relax", relax},   {"compare", compare},   {"schemes", schemes}, {"merge", merge},
      {"table", table},   {"validate", validate}, {"plot", plot},       {"animate", animate},
      {"page", page},     {"systems", systems}};
  for (const auto& [known, command] : commands)
    if (name == known) return command;
  return ensemble;
}

int call(const Options& options) {
  using namespace carom::cli;
  const auto command = command_of(options.command);
  return is_sweep(options) ? sweep(options, command) : command(options);
}

// Runs a command, or what follows it. Its text comes last: if its reader is gone, all else is done.
int status_of(const std::function<int()>& run, bool& closed) {
  try {
    return run();
  } catch (const carom::cli::OutputClosed&) {
    closed = true;
    return carom::cli::done;
  }
}

}  // namespace

int main(int argc, char** argv) {
  using namespace carom::cli;
  ::sigaction(SIGHUP, &hangup, nullptr);
  reserve_standard_streams();
  try {
#ifdef CAROM_MPI
    start_ranks_by(mpi_ranks);
#else
    hand_over_to_mpi(argv);
#endif
    const bool silent = rank_by_environment() > 0;
    if (silent && !keep_silent()) return bad_input;
    std::signal(SIGPIPE, SIG_IGN);  // a closed pipe shows where it is written to
    Parsed parsed = parse(argc, argv);
    if (parsed.exit) return *parsed.exit;
    carom::prepare_archives();
    const Options& options = parsed.options;
    follow_links(parsed.options);
    if (silent && !is_plain_ensemble(options)) return done;
    const PictureOfResult picture(parsed.options);
    bool closed = false;
    int status = status_of([&] { return call(options); }, closed);
    status = status_of([&] { return picture.finish(status); }, closed);
    return closed ? end_by_closed_pipe() : status;
  } catch (const carom::SamplingStopped&) {
    std::fputs("carom: interrupted before there was anything to show\n", stderr);
    return stopped;
  } catch (const carom::InputError& error) {
    std::string message = std::string("carom: ") + error.what();
    if (width_of(message) > 4 * line_width) message = folded(message, "  ");  // a list of names
    std::fprintf(stderr, "%s\n", message.c_str());
    return bad_input;
  } catch (const std::bad_alloc&) {
    std::fputs("carom: out of memory\n", stderr);
    return bad_input;
  } catch (const std::system_error& error) {
    std::fprintf(stderr, "carom: the system does not give what is needed: %s\n", error.what());
    return bad_input;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "carom: internal error, please report it: %s\n", error.what());
    return untrusted;
  }
}
