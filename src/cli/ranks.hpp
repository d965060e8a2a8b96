// The processes that mpirun or srun started together.
#pragma once

#include <functional>
#include <string>

namespace carom::cli {

/// Processes that share a run, numbered from 0. Each of them makes every call, in the same order. A
/// call waits, asleep, until all have made it; where one of them dies, mpirun ends the others.
class Ranks {
 public:
  virtual ~Ranks() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  /// The text that rank 0 gives.
  virtual std::string tell(const std::string& text) = 0;
  /// Until all are here.
  virtual void meet() = 0;
  /// This process ends before its share is done: as it does, mpirun ends the others.
  virtual void give_up() = 0;
};

/// Number of this process among those started together; 0 where it was started alone. MPI is not
/// started.
int rank_by_environment();
/// Only the first of the processes that mpirun starts prints, until speak(): what the others then
/// say on standard error is seen. False: their streams cannot be closed.
bool keep_silent();
void speak();
/// Where mpirun has started this process with others, carom-mpi beside the program, the same
/// program linked with MPI, takes its place: MPI's libraries cost every other start a fifth of its
/// time. Returns where there is no need, or no such program.
void hand_over_to_mpi(char** arguments);
/// Called once by carom-mpi: what starts MPI.
void start_ranks_by(Ranks& (*start)());
/// Starts MPI; null where this process was started alone, or built without MPI. MPI ends with the
/// process, after its last word: mpirun ends all processes as soon as one of them has ended with an
/// error.
Ranks* start_ranks();

/// Rank 0 calls `prepare`; all return the word that it gives. Where it throws, rank 0 does, and the
/// others return "". `ranks` null: this process is alone.
std::string word_of_first(Ranks* ranks, const std::function<std::string()>& prepare);

/// Throws InputError where more processes were started together than `known` ones: each would run
/// the whole by itself, into one file.
void refuse_strangers(int known);
/// The ranks that MPI has started (mpi_ranks.cpp).
Ranks& mpi_ranks();

}  // namespace carom::cli
