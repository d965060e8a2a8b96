// Ranks by MPI: a part of carom-mpi alone.
#include <mpi.h>
#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <thread>

#include "cli/ranks.hpp"

namespace carom::cli {

namespace {

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

}  // namespace

Ranks& mpi_ranks() {
  static MpiRanks ranks;
  return ranks;
}

}  // namespace carom::cli
