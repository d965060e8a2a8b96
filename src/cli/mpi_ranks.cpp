#include "cli/mpi_ranks.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <utility>

#include "carom/base/error.hpp"

#ifdef CAROM_MPI
#include <mpi.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#endif

namespace carom::cli {

namespace {

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
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
    if (provided < MPI_THREAD_SERIALIZED)
      throw std::runtime_error("this MPI is not made for threads");
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    refuse_strangers(size_);
  }
  ~MpiRanks() override { MPI_Finalize(); }
  int rank() const override { return rank_; }
  int size() const override { return size_; }
  // If memory runs out here the process ends, and mpirun ends the others.
  Vote vote(Vote mine) noexcept override {
    constexpr int not_done = 1, stop = 2;
    const int own = (mine.done ? 0 : not_done) | (mine.stop ? stop : 0);
    int all = 0;
    MPI_Request request;
    MPI_Iallreduce(&own, &all, 1, MPI_INT, MPI_BOR, MPI_COMM_WORLD, &request);
    wait(request);
    return {(all & not_done) == 0, (all & stop) != 0};
  }
  std::string tell(const std::string& text) noexcept override {
    std::uint64_t size = text.size();
    MPI_Request request;
    MPI_Ibcast(&size, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD, &request);
    wait(request);
    std::string said = rank_ == 0 ? text : std::string(size, '\0');
    MPI_Ibcast(said.data(), static_cast<int>(said.size()), MPI_BYTE, 0, MPI_COMM_WORLD, &request);
    wait(request);
    return said;
  }
  void gather(const std::string& text,
              const std::function<void(int, const std::string&)>& take) noexcept override {
    if (rank_ == 0) {
      take(0, text);
      for (int from = 1; from < size_; ++from) take(from, receive(from));
      return;
    }
    std::uint64_t size = text.size();
    MPI_Request request;
    MPI_Isend(&size, 1, MPI_UINT64_T, 0, 0, MPI_COMM_WORLD, &request);
    wait(request);
    for (std::size_t at = 0; at < text.size(); at += most) {
      MPI_Isend(text.data() + at, length(text.size() - at), MPI_BYTE, 0, 0, MPI_COMM_WORLD,
                &request);
      wait(request);
    }
  }

 private:
  // Long texts go in pieces.
  static constexpr std::size_t most = std::size_t{1} << 30;
  static int length(std::size_t left) { return static_cast<int>(std::min(most, left)); }
  std::string receive(int from) {
    std::uint64_t size = 0;
    MPI_Request request;
    MPI_Irecv(&size, 1, MPI_UINT64_T, from, 0, MPI_COMM_WORLD, &request);
    wait(request);
    std::string text(size, '\0');
    for (std::size_t at = 0; at < text.size(); at += most) {
      MPI_Irecv(text.data() + at, length(text.size() - at), MPI_BYTE, from, 0, MPI_COMM_WORLD,
                &request);
      wait(request);
    }
    return text;
  }
  // MPI's own waiting takes a whole processor, and others compute.
  static void wait(MPI_Request& request) {
    for (;;) {
      int over = 0;
      MPI_Test(&request, &over, MPI_STATUS_IGNORE);
      if (over) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

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
    return ranks.size() > 1 ? &ranks : nullptr;
  }
#endif
  refuse_strangers(1);
  return nullptr;
}

void Meeting::end(bool failed) {
  if (std::exchange(over_, true)) return;
  if (failed) stopped_ = true;
  done_ = true;
  if (thread_.joinable())
    thread_.join();
  else
    vote_until_all_are_done();
}

void Meeting::vote_until_all_are_done() {
  constexpr auto pause = std::chrono::milliseconds(20);
  for (;;) {
    const Ranks::Vote all = ranks_.vote({done_, stopped_ || interrupted_});
    if (all.stop) stopped_ = true;
    if (all.done) return;
    std::this_thread::sleep_for(pause);
  }
}

}  // namespace carom::cli
