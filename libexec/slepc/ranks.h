/*
 * Ranks: the processes of MPI that work on one component. Rank 0 is the tool,
 * with its command line, its messages and its output; the others help.
 *
 * A step that can fail in one rank alone ends with ranks_agree, so that all go
 * on or all give up. Where PETSc itself reports an error, the other ranks may
 * wait for this one within PETSc: then the whole run is ended, by MPI_Abort.
 */
#ifndef RITZ_LIBEXEC_SLEPC_RANKS_H
#define RITZ_LIBEXEC_SLEPC_RANKS_H

#include <ritz/base.h>

#include <petscsys.h>
#include <stdint.h>

/** Start MPI, PETSc and SLEPc, none of which prints, or heeds signals, from now
 * on. They read the options of the environment PETSC_OPTIONS. */
void ranks_start(void);

/** End them, in every rank. */
void ranks_stop(void);

/** End all ranks at once, with status 1. */
_Noreturn void ranks_abort(void);

int ranks_own(void);
int ranks_count(void);

/** End the run if PETSc has failed; its sentence was printed. */
void ranks_expect(PetscErrorCode code);

/**
 * The status of all ranks: RITZ_OK if that is what each gives, otherwise that
 * of the first which failed, with its sentence. Collective.
 */
ritz_status ranks_agree(ritz_status own);

/* Return at the first failure, in all ranks together. */
#define RANKS_CHECK(call) RITZ_CHECK(ranks_agree(call))

/* RITZ_CHECK_NEW in all ranks together. */
#define RANKS_CHECK_NEW(pointer, count)                                        \
    do {                                                                       \
        (pointer) = ritz_zalloc((count), sizeof *(pointer));                   \
        RANKS_CHECK((pointer) ? RITZ_OK : RITZ_ERR_MEMORY);                    \
        if (!(pointer))                                                        \
            return RITZ_ERR_MEMORY;                                            \
    } while (0)

/** Rank 0's bytes become those of every rank. Collective. */
void ranks_share(void *bytes, int64_t count);

/** Sums over all ranks, the same in each. Collective. */
void ranks_sum(double *values, int64_t count);
int64_t ranks_total(int64_t own);

#endif
