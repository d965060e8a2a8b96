/* What SUNDIALS 7 asks of MPI where it was built with it, for programs that hold SUNDIALS themselves (archives.cmake). Carom's
   contexts have no communicator: nobody calls these. Names of data are those of Open MPI. */
#include <stdlib.h>
#define NOBODY_CALLS(name) void name(void); void name(void) { abort(); }
NOBODY_CALLS(MPI_Abort)
NOBODY_CALLS(MPI_Comm_dup)
NOBODY_CALLS(MPI_Comm_free)
NOBODY_CALLS(MPI_Comm_rank)
NOBODY_CALLS(MPI_Comm_size)
NOBODY_CALLS(MPI_Op_create)
NOBODY_CALLS(MPI_Op_free)
NOBODY_CALLS(MPI_Reduce)
NOBODY_CALLS(MPI_Type_commit)
NOBODY_CALLS(MPI_Type_create_resized)
NOBODY_CALLS(MPI_Type_create_struct)
NOBODY_CALLS(MPI_Type_free)
NOBODY_CALLS(MPI_Type_get_extent)
#define NOBODY_READS(name) extern const char name; const char name = 0;
NOBODY_READS(ompi_mpi_comm_null)
NOBODY_READS(ompi_mpi_double)
NOBODY_READS(ompi_mpi_long)
