#include "cli/picture.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "carom/base/error.hpp"
#include "carom/io/archive.hpp"

extern char** environ;

namespace carom::cli {

namespace {

constexpr const char* needed =
    "Python with the module carom and matplotlib: ./dev python, or the Debian packages "
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
    "import sys\n"
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
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  std::string path;
  for (const char* folder : {"python", "../lib/python3/dist-packages"})
    path += (path.empty() ? "" : ":") + (self.parent_path() / folder).string();
  const char* const before = ::getenv("PYTHONPATH");
  return before && *before ? path + ":" + before : path;
}

int run_and_wait(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  ::setenv("PYTHONPATH", module_path().c_str(), 1);
  pid_t child = 0;
  if (::posix_spawnp(&child, arguments[0], nullptr, nullptr, arguments.data(), environ) != 0)
    return -1;
  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

int call_module(const std::string& picture, const std::vector<std::string>& arguments) {
  std::vector<std::string> words{interpreter(), "-c", start_of_module};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const int status = run_and_wait(words);
  if (status < 0 || status == no_module)
    throw InputError(Place{picture, 0, 0, ""}, "there is nothing to draw the picture with", needed);
  return status;
}

}  // namespace

bool is_picture(const std::string& file) {
  const std::string ending = ending_of(file);
  return ending == ".png" || ending == ".svg" || ending == ".pdf";
}

int draw(const std::string& source, const std::string& picture, bool force,
         const std::string& what) {
  std::vector<std::string> words{source, "-o", picture};
  if (!what.empty()) words.insert(words.end(), {"--what", what});
  if (force) words.emplace_back("--force");
  return call_module(picture, words) == 0 ? done : bad_input;  // Python has said what is wrong
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
  call_module(options.output, {});  // before anything is computed
  picture_ = std::exchange(options.output, {});
  force_ = options.force;
  options.output = folder_.emplace().file("result.h5");
  options.hidden_archive = true;
}

int PictureOfResult::finish(int status) const {
  if (picture_.empty() || status == bad_input || status == usage) return status;
  const int drawn = draw(folder_->file("result.h5"), picture_, force_);
  return drawn == done ? status : drawn;
}

}  // namespace carom::cli
