/* What SUNDIALS 7 asks of MPI where it was built with it, for programs that hold SUNDIALS themselves (archives.cmake). Carom's
   contexts have no communicator, so none of these is called. Names of data are those of Open MPI. */
#include <stdlib.h>
#define NEVER_CALLED(name) void name(void); void name(void) { abort(); }
NEVER_CALLED(MPI_Abort)
NEVER_CALLED(MPI_Comm_dup)
NEVER_CALLED(MPI_Comm_free)
NEVER_CALLED(MPI_Comm_rank)
NEVER_CALLED(MPI_Comm_size)
NEVER_CALLED(MPI_Op_create)
NEVER_CALLED(MPI_Op_free)
NEVER_CALLED(MPI_Reduce)
NEVER_CALLED(MPI_Type_commit)
NEVER_CALLED(MPI_Type_create_resized)
NEVER_CALLED(MPI_Type_create_struct)
NEVER_CALLED(MPI_Type_free)
NEVER_CALLED(MPI_Type_get_extent)
#define NEVER_READ(name) extern const char name; const char name = 0;
NEVER_READ(ompi_mpi_comm_null)
NEVER_READ(ompi_mpi_double)
NEVER_READ(ompi_mpi_long)
