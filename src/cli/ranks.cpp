#include "cli/ranks.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>

#include "carom/base/error.hpp"
#include "files/platform.hpp"

namespace carom::cli {

namespace {

int real_errors = -1;  // standard error of a process that keeps silent
Ranks& (*starter)() = nullptr;

// The rank that Open MPI, PMIx (srun) or MPICH gave this process; null if none of them started it.
const char* rank_in_environment() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"})
    if (const char* text = std::getenv(name)) return text;
  return nullptr;
}

int number_in_environment() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* text = std::getenv(name)) return std::atoi(text);
  return 1;
}

}  // namespace

void refuse_strangers(int known) {
  if (number_in_environment() > known)
    throw InputError(fmt::format(
        "{} processes were started together, but this carom knows {} of them (expected the mpirun "
        "that it was built with, or one process)",
        number_in_environment(), known));
}

int rank_by_environment() {
  const char* text = rank_in_environment();
  return text ? std::atoi(text) : 0;
}

void hand_over_to_mpi(char** arguments) {
  if (!rank_in_environment()) return;
  const std::filesystem::path self = files::path_of_program();
  for (const char* other : {"carom-mpi", "../libexec/carom/carom-mpi"})
    ::execv((self.parent_path() / other).c_str(), arguments);
}

bool keep_silent() {
  real_errors = ::fcntl(2, F_DUPFD_CLOEXEC, 3);
  return std::freopen("/dev/null", "w", stdout) && std::freopen("/dev/null", "w", stderr);
}

void speak() {
  if (real_errors >= 0) ::dup2(real_errors, 2);
}

std::string word_of_first(Ranks* ranks, const std::function<std::string()>& prepare) {
  if (!ranks) return prepare();
  std::string word;
  std::exception_ptr problem;
  try {
    if (ranks->rank() == 0) word = prepare();
  } catch (...) {
    problem = std::current_exception();
  }
  word = ranks->tell(word);
  if (problem) std::rethrow_exception(problem);
  return word;
}

void start_ranks_by(Ranks& (*start)()) { starter = start; }

Ranks* start_ranks() {
  // Without this, a process that was started alone would look for partners for a third of a second.
  if (starter && rank_in_environment()) {
    Ranks& ranks = starter();
    return ranks.size() > 1 ? &ranks : nullptr;
  }
  refuse_strangers(1);
  return nullptr;
}

}  // namespace carom::cli
