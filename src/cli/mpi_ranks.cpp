#include "cli/mpi_ranks.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "carom/base/error.hpp"

#ifdef CAROM_MPI
#include <mpi.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <vector>
#endif

namespace carom::cli {

namespace {

// As Open MPI, PMIx (srun) and MPICH with its kin say it; null where none of them started this process.
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
    throw InputError(fmt::format("{} processes were started together, but this carom knows {} of them (expected the mpirun "
                                 "that it was built with, or one process)",
                                 number_in_environment(), known));
}

#ifdef CAROM_MPI

class MpiRanks : public Ranks {
 public:
  MpiRanks() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
    if (provided < MPI_THREAD_SERIALIZED) throw std::runtime_error("this MPI is not made for threads");
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    refuse_strangers(size_);
  }
  ~MpiRanks() override { MPI_Finalize(); }
  int rank() const override { return rank_; }
  int size() const override { return size_; }
  void send(int to, const std::vector<std::byte>& bytes) override {
    // A long message goes in pieces, of which only the last is shorter than the others.
    std::size_t at = 0;
    for (;;) {
      const std::size_t piece = std::min(most, bytes.size() - at);
      MPI_Send(bytes.data() + at, static_cast<int>(piece), MPI_BYTE, to, 0, MPI_COMM_WORLD);
      at += piece;
      if (piece < most) return;
    }
  }
  std::optional<Message> receive() override {
    int there = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, 0, MPI_COMM_WORLD, &there, &status);
    if (!there) return {};
    Message message;
    message.from = status.MPI_SOURCE;
    for (;;) {
      int size = 0;
      MPI_Probe(message.from, 0, MPI_COMM_WORLD, &status);
      MPI_Get_count(&status, MPI_BYTE, &size);
      const std::size_t at = message.bytes.size();
      message.bytes.resize(at + static_cast<std::size_t>(size));
      MPI_Recv(message.bytes.data() + at, size, MPI_BYTE, message.from, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
      if (static_cast<std::size_t>(size) < most) return message;
    }
  }

 private:
  static constexpr std::size_t most = std::size_t{1} << 30;
  int rank_ = 0, size_ = 1;
};

#endif

}  // namespace

int rank_by_environment() {
  const char* text = rank_in_environment();
  return text ? std::atoi(text) : 0;
}

Ranks* start_ranks() {
#ifdef CAROM_MPI
  // Without this, a process that was started alone would look for partners for a third of a second.
  if (rank_in_environment()) {
    static MpiRanks ranks;
    return &ranks;
  }
#endif
  refuse_strangers(1);
  return nullptr;
}

}  // namespace carom::cli
