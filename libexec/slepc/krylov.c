#include "krylov.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "blocks.h"
#include "ranks.h"
#include "rows.h"

#include <math.h>
#include <slepceps.h>
#include <string.h>

/* The preconditioner that SLEPc solves with: the factor of K - sigma M. */
static PetscErrorCode apply_factor(PC pc, Vec x, Vec y)
{
    void *context = NULL;

    PetscCall(PCShellGetContext(pc, &context));
    if (rank_pencil_solve_vector(context, x, y) != RITZ_OK)
        SETERRQ(PETSC_COMM_WORLD, PETSC_ERR_LIB, "%s", ritz_error_message());
    return 0;
}

/* A start vector that does not depend on the number of ranks. It is in the
   range of (K - sigma M)^-1 M, which is not the whole space if M is
   singular. */
static ritz_status set_start(EPS eps, const rank_pencil *p)
{
    ritz_status status = RITZ_OK;
    Vec start = NULL;
    Vec noise = NULL;

    ranks_expect(MatCreateVecs(p->M, &noise, &start));
    rows_fill(noise, 0);
    ranks_expect(MatMult(p->M, noise, start));
    status = rank_pencil_solve_vector(p, start, noise);
    ranks_expect(EPSSetInitialSpace(eps, 1, &noise));
    ranks_expect(VecDestroy(&start));
    ranks_expect(VecDestroy(&noise));
    return status;
}

/* Shift-and-invert with the factor that exists, so that SLEPc neither forms nor
   factors a matrix of its own. */
static void set_transformation(EPS eps, rank_pencil *p)
{
    ST st = NULL;
    KSP solver = NULL;
    PC pc = NULL;

    ranks_expect(EPSGetST(eps, &st));
    ranks_expect(STSetType(st, STSINVERT));
    ranks_expect(STSetMatMode(st, ST_MATMODE_SHELL));
    ranks_expect(STGetKSP(st, &solver));
    ranks_expect(KSPSetType(solver, KSPPREONLY));
    ranks_expect(KSPGetPC(solver, &pc));
    ranks_expect(PCSetType(pc, PCSHELL));
    ranks_expect(PCShellSetContext(pc, p));
    ranks_expect(PCShellSetApply(pc, apply_factor));
}

static ritz_status set_up(EPS eps, rank_pencil *p, int64_t ask, int64_t room)
{
    ranks_expect(EPSSetOperators(eps, p->K, p->M));
    ranks_expect(EPSSetProblemType(eps, EPS_GHEP));
    ranks_expect(EPSSetType(eps, EPSKRYLOVSCHUR));
    ranks_expect(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE));
    ranks_expect(EPSSetTarget(eps, p->sigma));
    ranks_expect(
        EPSSetDimensions(eps, (PetscInt)ask, (PetscInt)room, PETSC_DEFAULT));
    ranks_expect(EPSSetTolerances(eps, RITZ_KRYLOV_SETTLED, PETSC_DEFAULT));
    /* block_polish() does what purification would, for all vectors at once */
    ranks_expect(EPSSetPurify(eps, PETSC_FALSE));
    set_transformation(eps, p);
    RITZ_CHECK(set_start(eps, p));
    ranks_expect(EPSSetFromOptions(eps));
    return RITZ_OK;
}

static void take_pairs(EPS eps, int64_t count, Mat X, double *lambda)
{
    for (int64_t k = 0; k < count; k++) {
        Vec x = NULL;
        PetscScalar value = 0.0;

        ranks_expect(MatDenseGetColumnVecWrite(X, (PetscInt)k, &x));
        ranks_expect(EPSGetEigenpair(eps, (PetscInt)k, &value, NULL, x, NULL));
        ranks_expect(MatDenseRestoreColumnVecWrite(X, (PetscInt)k, &x));
        lambda[k] = value;
    }
}

/* SLEPc fails, in all ranks, if an x'M x is negative. */
static ritz_status solve_pencil(EPS eps)
{
    PetscErrorCode code = 0;

    ritz_monitor_step("eigenvectors", 0, 0);
    ranks_tolerate(PETSC_ERR_USER_INPUT);
    code = EPSSolve(eps);
    ranks_tolerate(0);
    RITZ_REFUSE_IF(code == PETSC_ERR_USER_INPUT, RITZ_ERR_SINGULAR,
                   "mass is not positive definite");
    ranks_expect(code);
    return RITZ_OK;
}

ritz_status krylov_lowest(rank_pencil *p, int64_t ask, int64_t room, Mat *X,
                          double **lambda, int64_t *found)
{
    ritz_status status = RITZ_OK;
    EPS eps = NULL;
    PetscInt converged = 0;

    RANKS_CHECK_NEW(*lambda, ask);
    ranks_expect(EPSCreate(PETSC_COMM_WORLD, &eps));
    status = set_up(eps, p, ask, room);
    if (status == RITZ_OK)
        status = solve_pencil(eps);
    if (status == RITZ_OK)
        ranks_expect(EPSGetConverged(eps, &converged));
    *found = converged < ask ? converged : ask;
    block_new(p->K, *found, X);
    take_pairs(eps, *found, *X, *lambda);
    ranks_expect(EPSDestroy(&eps));
    return status;
}
