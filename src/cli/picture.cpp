#include "cli/picture.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <thread>
#include <utility>

#include "carom/base/error.hpp"
#include "carom/files/archive.hpp"
#include "carom/starts/sampler.hpp"
#include "cli/common.hpp"
#include "files/platform.hpp"

extern char** environ;

namespace carom::cli {

namespace {

constexpr const char* needed =
    "Python with the module carom and matplotlib: ./dev python, the wheel, or the Debian packages "
    "python3-carom and python3-matplotlib";

// CAROM_PYTHON names another one.
std::string interpreter() {
  const char* const named = ::getenv("CAROM_PYTHON");
  if (named && *named) return named;
#ifdef CAROM_SYSTEM_PYTHON
  return CAROM_SYSTEM_PYTHON;
#else
  return "python3";
#endif
}

// Its exit status says that the module is missing, without Python's own report of that.
constexpr int no_module = 64;
constexpr const char* start_of_module =
    "import signal, sys\n"
    "signals = signal.SIGINT, signal.SIGTERM, signal.SIGHUP\n"
    "def stop(*_):\n"
    "  for one in signals: signal.signal(one, signal.SIG_IGN)\n"
    "  sys.exit(130)\n"
    "def again(ignored):\n"  // Python drops what is raised in some of its own callbacks
    "  if ignored.exc_type is not SystemExit: return sys.__unraisablehook__(ignored)\n"
    "  signal.signal(signal.SIGALRM, stop)\n"
    "  signal.setitimer(signal.ITIMER_REAL, 0.01)\n"
    "sys.unraisablehook = again\n"
    "for one in signals:\n"
    "  if signal.getsignal(one) is not signal.SIG_IGN: signal.signal(one, stop)\n"
    "signal.pthread_sigmask(signal.SIG_UNBLOCK, signals)\n"
    "try:\n"
    "  import matplotlib, carom.picture\n"
    "except Exception:\n"
    "  sys.exit(64)\n"
    "if len(sys.argv) > 1: carom.picture.main()\n";

std::string ending_of(const std::string& file) {
  return std::filesystem::path(file).extension().string();
}

// Where the module is, seen from the program: in a build, or where both are installed.
std::string module_path() {
  const std::filesystem::path self = files::path_of_program();
  std::string path;
  for (const char* folder : {"python", "../lib/python3/dist-packages"})
    path += (path.empty() ? "" : ":") + (self.parent_path() / folder).string();
  const char* const before = ::getenv("PYTHONPATH");
  return before && *before ? path + ":" + before : path;
}

// The process that draws; 0: none. Signals that end the program are passed on to it.
std::atomic<pid_t> painter{0};
std::atomic<bool> signalled{false};
static_assert(std::atomic<pid_t>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

extern "C" void pass_on(int number) {
  signalled = true;
  if (const pid_t child = painter) ::kill(child, number);
}

// While it lives, signals are passed on. Those that are ignored, as by nohup, stay so.
class Passing {
 public:
  Passing() {
    signalled = false;
    struct sigaction action {};
    action.sa_handler = pass_on;
    sigemptyset(&action.sa_mask);
    for (std::size_t i = 0; i < before_.size(); ++i)
      if (::sigaction(numbers[i], nullptr, &before_[i]) == 0 && before_[i].sa_handler != SIG_IGN)
        ::sigaction(numbers[i], &action, nullptr);
  }
  Passing(const Passing&) = delete;
  ~Passing() {
    painter = 0;
    for (std::size_t i = 0; i < before_.size(); ++i) ::sigaction(numbers[i], &before_[i], nullptr);
  }

  static constexpr std::array numbers{SIGINT, SIGTERM, SIGHUP};

 private:
  std::array<struct sigaction, numbers.size()> before_{};
};

// How Python ended: its exit status, or the signal that ended it.
struct Drawn {
  int status = -1, by_signal = 0;
  bool interrupted = false;
};

// A process that does not end after a signal is killed: what it has begun is removed all the same.
Drawn wait_for(pid_t child) {
  constexpr int patience = 2000, pause = 10;  // ms
  Drawn drawn;
  int status = 0, waited = 0;
  for (;;) {
    const pid_t ended = ::waitpid(child, &status, WNOHANG);
    if (ended < 0 && errno != EINTR) return drawn;
    if (ended == child) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(pause));
    if (signalled && (waited += pause) == patience) ::kill(child, SIGKILL);
  }
  if (WIFEXITED(status)) drawn.status = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) drawn.by_signal = WTERMSIG(status);
  drawn.interrupted = signalled && drawn.status != 0;
  return drawn;
}

Drawn run_and_wait(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  ::setenv("PYTHONPATH", module_path().c_str(), 1);
  const Passing passing;
  // Python itself would report them while it starts: they wait until it can deal with them.
  sigset_t held;
  sigemptyset(&held);
  for (const int number : Passing::numbers) sigaddset(&held, number);
  posix_spawnattr_t how;
  ::posix_spawnattr_init(&how);
  ::posix_spawnattr_setsigmask(&how, &held);
  ::posix_spawnattr_setflags(&how, POSIX_SPAWN_SETSIGMASK);
  pid_t child = 0;
  const int failed = ::posix_spawnp(&child, arguments[0], nullptr, &how, arguments.data(), environ);
  ::posix_spawnattr_destroy(&how);
  if (failed != 0) return {};
  painter = child;
  if (signalled) ::kill(child, SIGTERM);  // it came before there was a process
  return wait_for(child);
}

int call_module(const std::string& picture, const std::vector<std::string>& arguments) {
  std::vector<std::string> words{interpreter(), "-c", start_of_module};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const Drawn drawn = run_and_wait(words);
  if (drawn.interrupted || drawn.status == stopped) return stopped;
  if (drawn.by_signal != 0)
    throw InputError(Place{picture, 0, 0, ""},
                     fmt::format("Python, which draws it, was ended by signal {} ({})",
                                 drawn.by_signal, ::strsignal(drawn.by_signal)));
  if (drawn.status < 0 || drawn.status == no_module)
    throw InputError(Place{picture, 0, 0, ""}, "there is nothing to draw the picture with", needed);
  return drawn.status == 0 ? done : bad_input;  // Python has said what is wrong
}

}  // namespace

bool is_picture(const std::string& file) {
  const std::string ending = ending_of(file);
  return ending == ".png" || ending == ".svg" || ending == ".pdf";
}

void refuse_other_endings(const std::string& file) {
  if (!is_picture(file))
    throw InputError(Place{"command line", 0, 0, "-o"}, "'" + file + "' is not a picture",
                     "a name ending in .png, .svg or .pdf");
}

int draw(const std::string& source, const std::string& picture, bool force,
         const std::vector<std::string>& options) {
  refuse_existing(picture, force);
  const TemporaryFolder folder(picture);
  const std::string made = folder.file("picture" + ending_of(picture));
  std::vector<std::string> words{"--output=" + picture, "--into=" + made};
  words.insert(words.end(), options.begin(), options.end());
  words.insert(words.end(), {"--", source});
  const int status = call_module(picture, words);
  if (status != done) return status;
  if (std::rename(made.c_str(), picture.c_str()) != 0)
    throw InputError(fmt::format("cannot write '{}': {}", picture, std::strerror(errno)));
  return done;
}

PictureOfResult::PictureOfResult(Options& options) {
  const std::string ending = ending_of(options.output);
  if (options.output.empty() || options.command == "table" || options.command == "plot" ||
      options.command == "animate")
    return;
  if (ending.empty() || ending == ".h5" || ending == ".hdf5" || ending == ".part") return;
  if (!is_picture(options.output))
    throw InputError(
        Place{"command line", 0, 0, "-o"},
        fmt::format("'{}' ends neither as an archive nor as a picture", options.output),
        ".h5, .hdf5, .png, .svg or .pdf");
  refuse_existing(options.output, options.force);
  // Before anything is computed.
  if (call_module(options.output, {}) == stopped) throw SamplingStopped();
  picture_ = std::exchange(options.output, {});
  force_ = options.force;
  json_ = options.json;
  options.output = folder_.emplace().file("result.h5");
  options.hidden_archive = true;
}

int PictureOfResult::finish(int status) const {
  if (picture_.empty() || status == bad_input || status == usage) return status;
  const int drawn = draw(folder_->file("result.h5"), picture_, force_);
  if (drawn != done) return drawn;
  if (!json_) print(fmt::format("picture: {}\n", picture_));
  return status;
}

}  // namespace carom::cli
