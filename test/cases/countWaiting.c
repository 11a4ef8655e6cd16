/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.

Description
    Counts, on each rank, what waits for other ranks: blocking receives (one
    up or down the tree of ranks in each of OpenFOAM's own reductions, so one
    per reduction on two ranks) and the reductions and broadcasts of MPI; apart
    from them all-to-all exchanges; and what is sent without waiting: messages,
    their bytes, and the ranks that get any; and the most memory of the rank.
    Written to the error stream at the end.

        mpicc -shared -fPIC countWaiting.c -o countWaiting.so
        mpirun -np 2 env LD_PRELOAD=countWaiting.so mpmFoam -parallel

\*---------------------------------------------------------------------------*/

#include <mpi.h>
#include <stdio.h>

static long reductions = 0;
static long exchanges = 0;
static long messages = 0;
static long bytes = 0;
static char sentTo[65536];

int MPI_Isend
(
    const void* from, int n, MPI_Datatype type, int rank, int tag,
    MPI_Comm comm, MPI_Request* request
)
{
    int size;
    PMPI_Type_size(type, &size);
    ++messages;
    bytes += (long)n*size;
    sentTo[rank] = 1;
    return PMPI_Isend(from, n, type, rank, tag, comm, request);
}

int MPI_Recv
(
    void* to, int n, MPI_Datatype type, int rank, int tag, MPI_Comm comm,
    MPI_Status* status
)
{
    ++reductions;
    return PMPI_Recv(to, n, type, rank, tag, comm, status);
}

int MPI_Allreduce
(
    const void* from, void* to, int n, MPI_Datatype type, MPI_Op op,
    MPI_Comm comm
)
{
    ++reductions;
    return PMPI_Allreduce(from, to, n, type, op, comm);
}

int MPI_Reduce
(
    const void* from, void* to, int n, MPI_Datatype type, MPI_Op op, int root,
    MPI_Comm comm
)
{
    ++reductions;
    return PMPI_Reduce(from, to, n, type, op, root, comm);
}

int MPI_Bcast(void* data, int n, MPI_Datatype type, int root, MPI_Comm comm)
{
    ++reductions;
    return PMPI_Bcast(data, n, type, root, comm);
}

int MPI_Barrier(MPI_Comm comm)
{
    ++reductions;
    return PMPI_Barrier(comm);
}

int MPI_Allgather
(
    const void* from, int nFrom, MPI_Datatype fromType, void* to, int nTo,
    MPI_Datatype toType, MPI_Comm comm
)
{
    ++reductions;
    return PMPI_Allgather(from, nFrom, fromType, to, nTo, toType, comm);
}

int MPI_Alltoall
(
    const void* from, int nFrom, MPI_Datatype fromType, void* to, int nTo,
    MPI_Datatype toType, MPI_Comm comm
)
{
    ++exchanges;
    return PMPI_Alltoall(from, nFrom, fromType, to, nTo, toType, comm);
}

int MPI_Finalize(void)
{
    int rank, ranks = 0;
    char line[256];
    long memory = 0;
    FILE* status = fopen("/proc/self/status", "r");
    while (status && fgets(line, sizeof(line), status))
    {
        sscanf(line, "VmHWM: %ld kB", &memory);
    }
    if (status) fclose(status);
    for (rank = 0; rank < (int)sizeof(sentTo); ++rank) ranks += sentTo[rank];
    PMPI_Comm_rank(MPI_COMM_WORLD, &rank);

    /* In one piece: ranks share the stream */
    snprintf(line, sizeof(line),
        "waited: %ld reductions, %ld exchanges\n"
        "sent by %d: %ld messages of %ld bytes to %d ranks; memory %ld kB\n",
        reductions, exchanges, rank, messages, bytes, ranks, memory);
    fputs(line, stderr);
    return PMPI_Finalize();
}
