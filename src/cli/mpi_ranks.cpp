#include "cli/mpi_ranks.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "carom/base/error.hpp"

#ifdef CAROM_MPI
#include <mpi.h>

#include <chrono>
#include <cstddef>
#include <thread>
#endif

namespace carom::cli {

namespace {

int real_errors = -1;  // standard error of a process that keeps silent

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
// Otherwise each process would run the whole by itself, into one file.
void refuse_strangers(int known) {
  if (number_in_environment() > known)
    throw InputError(fmt::format(
        "{} processes were started together, but this carom knows {} of them (expected the mpirun "
        "that it was built with, or one process)",
        number_in_environment(), known));
}

#ifdef CAROM_MPI

class MpiRanks : public Ranks {
 public:
  MpiRanks() {
    MPI_Init(nullptr, nullptr);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    refuse_strangers(size_);
  }
  // MPI_Abort would lose what was said. mpirun ends the others where one has ended with an error.
  ~MpiRanks() override {
    if (gives_up_) std::fflush(nullptr), ::_exit(1);
    MPI_Finalize();
  }
  int rank() const override { return rank_; }
  int size() const override { return size_; }
  // If memory runs out in one of these the process ends, and mpirun ends the others.
  std::string tell(const std::string& text) noexcept override {
    meet();
    int size = static_cast<int>(text.size());
    MPI_Bcast(&size, 1, MPI_INT, 0, MPI_COMM_WORLD);
    std::string said = text;
    said.resize(static_cast<std::size_t>(size));
    MPI_Bcast(said.data(), size, MPI_CHAR, 0, MPI_COMM_WORLD);
    return said;
  }
  // MPI's own waiting takes a whole processor, and others compute.
  void meet() noexcept override {
    MPI_Request request;
    MPI_Ibarrier(MPI_COMM_WORLD, &request);
    for (int all = 0;;) {
      MPI_Test(&request, &all, MPI_STATUS_IGNORE);
      if (all) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  void give_up() override { gives_up_ = true; }

 private:
  int rank_ = 0, size_ = 1;
  bool gives_up_ = false;
};

#endif

}  // namespace

int rank_by_environment() {
  const char* text = rank_in_environment();
  return text ? std::atoi(text) : 0;
}

bool keep_silent() {
  real_errors = ::fcntl(2, F_DUPFD_CLOEXEC, 3);
  return std::freopen("/dev/null", "w", stdout) && std::freopen("/dev/null", "w", stderr);
}

void speak() {
  if (real_errors >= 0) ::dup2(real_errors, 2);
}

Ranks* start_ranks() {
#ifdef CAROM_MPI
  // Without this, a process that was started alone would look for partners for a third of a second.
  if (rank_in_environment()) {
    static MpiRanks ranks;
    return ranks.size() > 1 ? &ranks : nullptr;
  }
#endif
  refuse_strangers(1);
  return nullptr;
}

}  // namespace carom::cli
