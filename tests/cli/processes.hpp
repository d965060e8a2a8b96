// Several processes of one program under mpirun, for tests.
#pragma once

#include <cstdlib>
#include <string>

namespace carom {

/// Does the program know of ranks, and is mpirun there?
inline bool has_mpi() {
  return CAROM_HAS_MPI && std::system("mpirun --version >/dev/null 2>&1") == 0;
}

/// Goes before a command; 0: without mpirun.
inline std::string ranks(int n) {
  return n == 0 ? ""
                : "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
                  "OMPI_MCA_btl_tcp_if_include=lo ASAN_OPTIONS=detect_leaks=0 mpirun "
                  "--oversubscribe --bind-to none -n " +
                      std::to_string(n) + " ";
}

}  // namespace carom
