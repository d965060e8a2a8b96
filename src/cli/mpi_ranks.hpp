// The processes that mpirun or srun started together.
#pragma once

#include <memory>

#include "carom/ensemble/ranks.hpp"

namespace carom::cli {

/// Number of this process among those started together; 0 where it was started alone. MPI is not started.
int rank_by_environment();
/// Starts MPI and ends it when given back; null where this process was started alone, or built without MPI.
std::unique_ptr<Ranks> start_ranks();

}  // namespace carom::cli
