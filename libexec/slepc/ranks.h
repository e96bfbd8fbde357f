/*
 * Ranks: the processes of MPI that work on one component. Rank 0 is the tool,
 * with its command line, its messages and its output; the others compute with
 * it.
 *
 * A step that can fail in one rank alone ends with ranks_agree(), so that all
 * ranks continue or all return the failure. If PETSc reports an error, other
 * ranks may be waiting for this one within PETSc: the run is ended by
 * MPI_Abort.
 */
#ifndef RITZ_LIBEXEC_SLEPC_RANKS_H
#define RITZ_LIBEXEC_SLEPC_RANKS_H

#include <ritz/base.h>

#include <petscsys.h>
#include <stdint.h>

/** Start MPI, PETSc and SLEPc. PETSc installs no signal handlers, and its
 * errors are reported in one line, which begins with @p tool. Options are read
 * from the environment variable PETSC_OPTIONS. */
void ranks_start(const char *tool);

/** End MPI, PETSc and SLEPc. To be called in every rank. */
void ranks_stop(void);

/** End all ranks at once, with status 1. */
_Noreturn void ranks_abort(void);

/** The number of this process, from 0. */
int ranks_own(void);
/** The number of processes. */
int ranks_count(void);

/** Abort the run if a call of PETSc has failed; its error handler has printed
 * the reason. */
void ranks_expect(PetscErrorCode code);

/** From now on PETSc returns this error, which is one that all ranks have at once,
 * instead of ending the run; 0: none. */
void ranks_tolerate(PetscErrorCode code);

/**
 * The common status of all ranks: RITZ_OK if @p own is RITZ_OK in each of them,
 * otherwise the status and the message of the lowest rank that failed.
 * Collective.
 */
ritz_status ranks_agree(ritz_status own);

/* Return from all ranks if the call failed in one of them. */
#define RANKS_CHECK(call) RITZ_CHECK(ranks_agree(call))

/* Allocate in every rank; return from all ranks if one has no memory. */
#define RANKS_CHECK_NEW(pointer, count)                                        \
    do {                                                                       \
        (pointer) = ritz_zalloc((count), sizeof *(pointer));                   \
        RANKS_CHECK((pointer) ? RITZ_OK : RITZ_ERR_MEMORY);                    \
        if (!(pointer))                                                        \
            return RITZ_ERR_MEMORY;                                            \
    } while (0)

/** Broadcast @p count bytes from rank 0 to every rank. Collective. */
void ranks_share(void *bytes, int64_t count);

/**
 * Allocate zeros, to receive what another rank sends next. That rank sends
 * without asking whether this one has memory: if not, the run is aborted.
 */
void *ranks_take(int64_t count, size_t size);

/** Replace each value by its sum over all ranks. Collective. */
void ranks_sum(double *values, int64_t count);
/** The sum of @p own over all ranks. Collective. */
int64_t ranks_total(int64_t own);

#endif
