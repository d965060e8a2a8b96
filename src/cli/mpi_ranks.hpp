// The processes that mpirun or srun started together.
#pragma once

#include "carom/ensemble/ranks.hpp"

namespace carom::cli {

/// Number of this process among those started together; 0 where it was started alone. MPI is not started.
int rank_by_environment();
/// Starts MPI; null where this process was started alone, or built without MPI. MPI ends with the process, after its
/// last word: mpirun ends all processes as soon as one of them has ended with an error.
Ranks* start_ranks();

}  // namespace carom::cli
