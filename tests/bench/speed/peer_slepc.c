/*
 * peer_slepc: the costly part of Craig-Bampton by SLEPc's Krylov-Schur
 * iteration and MUMPS, to compare speed with. Reads K and M of the interior,
 * computes the lowest modes by shift-invert at zero, and solves for as many
 * random right-hand sides as the interface has dofs; nothing is projected or
 * written. Prints one JSON object: seconds of each phase, size of the factor,
 * peak memory of all ranks.
 *
 *   -stiffness FILE -mass FILE   PETSc binary
 *   -modes N -columns N          50 and 48
 *   -vectors FILE                write eigenvalues and vectors, on one rank
 *   -check FILE                  only print the largest |lambda K^-1 M x - x| /
 *                                |x| of the pairs in such a file, on one rank
 *
 * A file of pairs holds two 64-bit integers, rows and pairs, the eigenvalues,
 * and the vectors one after the other.
 */
#include <petsctime.h>
#include <slepceps.h>
#include <stdint.h>
#include <sys/resource.h>

typedef struct job {
    char stiffness[PETSC_MAX_PATH_LEN], mass[PETSC_MAX_PATH_LEN];
    char vectors[PETSC_MAX_PATH_LEN], check[PETSC_MAX_PATH_LEN];
    PetscInt modes, columns;
    Mat K, M;
    EPS eps;
    PC pc;
    PetscLogDouble read, factor, iterate, solve; /* seconds */
} job;

static PetscErrorCode read_options(job *j)
{
    const size_t longest = PETSC_MAX_PATH_LEN;
    PetscBool stiffness, mass;

    j->modes = 50;
    j->columns = 48;
    PetscCall(PetscOptionsGetInt(NULL, NULL, "-modes", &j->modes, NULL));
    PetscCall(PetscOptionsGetInt(NULL, NULL, "-columns", &j->columns, NULL));
    PetscCall(PetscOptionsGetString(NULL, NULL, "-stiffness", j->stiffness,
                                    longest, &stiffness));
    PetscCall(
        PetscOptionsGetString(NULL, NULL, "-mass", j->mass, longest, &mass));
    PetscCall(PetscOptionsGetString(NULL, NULL, "-vectors", j->vectors, longest,
                                    NULL));
    PetscCall(
        PetscOptionsGetString(NULL, NULL, "-check", j->check, longest, NULL));
    PetscCheck(stiffness && mass, PETSC_COMM_WORLD, PETSC_ERR_USER_INPUT,
               "-stiffness FILE and -mass FILE are needed");
    return 0;
}

static PetscErrorCode load(const char *path, Mat *A)
{
    PetscViewer file;

    PetscCall(
        PetscViewerBinaryOpen(PETSC_COMM_WORLD, path, FILE_MODE_READ, &file));
    PetscCall(MatCreate(PETSC_COMM_WORLD, A));
    PetscCall(MatSetType(*A, MATAIJ));
    PetscCall(MatLoad(*A, file));
    PetscCall(MatSetOption(*A, MAT_SYMMETRIC, PETSC_TRUE));
    PetscCall(MatSetOption(*A, MAT_SPD, PETSC_TRUE));
    PetscCall(PetscViewerDestroy(&file));
    return 0;
}

/* Make ksp solve with one Cholesky factor by MUMPS. */
static PetscErrorCode choose_factor(KSP ksp, PC *pc)
{
    PetscCall(KSPSetType(ksp, KSPPREONLY));
    PetscCall(KSPGetPC(ksp, pc));
    PetscCall(PCSetType(*pc, PCCHOLESKY));
    PetscCall(PCFactorSetMatSolverType(*pc, MATSOLVERMUMPS));
    return 0;
}

static PetscErrorCode find_modes(job *j)
{
    PetscLogDouble began, factored, done;
    ST st;
    KSP ksp;

    PetscCall(EPSCreate(PETSC_COMM_WORLD, &j->eps));
    PetscCall(EPSSetOperators(j->eps, j->K, j->M));
    PetscCall(EPSSetProblemType(j->eps, EPS_GHEP));
    PetscCall(EPSSetWhichEigenpairs(j->eps, EPS_TARGET_MAGNITUDE));
    PetscCall(EPSSetTarget(j->eps, 0.0));
    PetscCall(EPSSetDimensions(j->eps, j->modes, PETSC_DEFAULT, PETSC_DEFAULT));
    PetscCall(EPSSetTolerances(j->eps, 1e-10, PETSC_DEFAULT));
    PetscCall(EPSGetST(j->eps, &st));
    PetscCall(STSetType(st, STSINVERT));
    PetscCall(STGetKSP(st, &ksp));
    PetscCall(choose_factor(ksp, &j->pc));
    PetscCall(EPSSetFromOptions(j->eps));
    PetscCall(PetscTime(&began));
    PetscCall(EPSSetUp(j->eps));
    PetscCall(STSetUp(st));
    PetscCall(PetscTime(&factored));
    PetscCall(EPSSolve(j->eps));
    PetscCall(PetscTime(&done));
    j->factor = factored - began;
    j->iterate = done - factored;
    return 0;
}

/* Solve as often as constraint modes take, for random right-hand sides. */
static PetscErrorCode solve_columns(job *j)
{
    PetscLogDouble began, done;
    Mat F, B, X;
    PetscInt rows;

    PetscCall(MatGetSize(j->K, &rows, NULL));
    PetscCall(PCFactorGetMatrix(j->pc, &F));
    PetscCall(MatCreateDense(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, rows,
                             j->columns, NULL, &B));
    PetscCall(MatSetRandom(B, NULL));
    PetscCall(MatDuplicate(B, MAT_DO_NOT_COPY_VALUES, &X));
    PetscCall(PetscTime(&began));
    PetscCall(MatMatSolve(F, B, X));
    PetscCall(PetscTime(&done));
    j->solve = done - began;
    PetscCall(MatDestroy(&B));
    PetscCall(MatDestroy(&X));
    return 0;
}

static PetscErrorCode report(const job *j)
{
    struct rusage used;
    PetscInt rows, iterations, converged, solves, entries;
    PetscReal flops;
    double bytes, all;
    ST st;
    KSP ksp;
    Mat F;

    PetscCall(MatGetSize(j->K, &rows, NULL));
    PetscCall(EPSGetIterationNumber(j->eps, &iterations));
    PetscCall(EPSGetConverged(j->eps, &converged));
    PetscCall(EPSGetST(j->eps, &st));
    PetscCall(STGetKSP(st, &ksp));
    PetscCall(KSPGetTotalIterations(ksp, &solves));
    PetscCall(PCFactorGetMatrix(j->pc, &F));
    /* of all ranks; MUMPS returns more than 2^31 as minus so many millions */
    PetscCall(MatMumpsGetInfog(F, 29, &entries));
    PetscCall(MatMumpsGetRinfog(F, 3, &flops));
    getrusage(RUSAGE_SELF, &used);
    bytes = 1024.0 * (double)used.ru_maxrss;
    PetscCallMPI(
        MPI_Reduce(&bytes, &all, 1, MPI_DOUBLE, MPI_SUM, 0, PETSC_COMM_WORLD));
    PetscCall(PetscPrintf(
        PETSC_COMM_WORLD,
        "{\"rows\": %d, \"phases\": {\"read\": %.4f, \"factor\": %.4f, "
        "\"modes\": %.4f, \"columns\": %.4f}, \"restarts\": %d, "
        "\"converged\": %d, \"solves\": %d, \"factor_entries\": %.0f, "
        "\"factor_flops\": %.6g, \"peak_bytes\": %.0f}\n",
        (int)rows, j->read, j->factor, j->iterate, j->solve, (int)iterations,
        (int)converged, (int)solves,
        entries < 0 ? -1e6 * (double)entries : (double)entries, (double)flops,
        all));
    return 0;
}

static PetscErrorCode write_pairs(const job *j)
{
    PetscInt rows, converged;
    int64_t head[2];
    FILE *file = fopen(j->vectors, "wb");
    PetscScalar value;
    const PetscScalar *entries;
    size_t written = 0;
    Vec x;

    PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s", j->vectors);
    PetscCall(EPSGetConverged(j->eps, &converged));
    PetscCall(MatGetSize(j->K, &rows, NULL));
    head[0] = rows;
    head[1] = PetscMin(converged, j->modes);
    PetscCall(MatCreateVecs(j->K, &x, NULL));
    written += fwrite(head, sizeof *head, 2, file);
    for (PetscInt k = 0; k < head[1]; k++) {
        PetscCall(EPSGetEigenvalue(j->eps, k, &value, NULL));
        written += fwrite(&value, sizeof value, 1, file);
    }
    for (PetscInt k = 0; k < head[1]; k++) {
        PetscCall(EPSGetEigenvector(j->eps, k, x, NULL));
        PetscCall(VecGetArrayRead(x, &entries));
        written += fwrite(entries, sizeof *entries, (size_t)rows, file);
        PetscCall(VecRestoreArrayRead(x, &entries));
    }
    PetscCall(VecDestroy(&x));
    PetscCheck(fclose(file) == 0 &&
                   written == 2 + (size_t)(head[1] * (1 + head[0])),
               PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s", j->vectors);
    return 0;
}

static PetscErrorCode find_residual(KSP ksp, Mat M, PetscScalar value, Vec x,
                                    PetscReal *residual)
{
    Vec y, z;
    PetscReal size;

    PetscCall(VecDuplicate(x, &y));
    PetscCall(VecDuplicate(x, &z));
    PetscCall(MatMult(M, x, y));
    PetscCall(KSPSolve(ksp, y, z));
    PetscCall(VecAYPX(z, -value, x));
    PetscCall(VecNorm(z, NORM_2, residual));
    PetscCall(VecNorm(x, NORM_2, &size));
    *residual /= size;
    PetscCall(VecDestroy(&y));
    PetscCall(VecDestroy(&z));
    return 0;
}

/* Residuals of the pairs in a file, with a factor that is made for this. */
static PetscErrorCode check_pairs(const job *j)
{
    FILE *file = fopen(j->check, "rb");
    int64_t head[2] = {0, 0};
    PetscInt rows;
    PetscScalar *values, *entries;
    PetscReal residual, largest = 0.0;
    size_t length;
    KSP ksp;
    PC pc;
    Vec x;

    PetscCheck(file && fread(head, sizeof *head, 2, file) == 2, PETSC_COMM_SELF,
               PETSC_ERR_FILE_READ, "%s", j->check);
    PetscCall(MatGetSize(j->K, &rows, NULL));
    PetscCheck(head[0] == rows, PETSC_COMM_SELF, PETSC_ERR_ARG_SIZ,
               "%s is of other matrices", j->check);
    length = (size_t)head[1];
    PetscCall(PetscMalloc1(length, &values));
    PetscCheck(fread(values, sizeof *values, length, file) == length,
               PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "%s", j->check);
    PetscCall(KSPCreate(PETSC_COMM_SELF, &ksp));
    PetscCall(KSPSetOperators(ksp, j->K, j->K));
    PetscCall(choose_factor(ksp, &pc));
    PetscCall(KSPSetFromOptions(ksp));
    PetscCall(MatCreateVecs(j->K, &x, NULL));
    for (size_t k = 0; k < length; k++) {
        PetscCall(VecGetArray(x, &entries));
        PetscCheck(fread(entries, sizeof *entries, (size_t)rows, file) ==
                       (size_t)rows,
                   PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "%s", j->check);
        PetscCall(VecRestoreArray(x, &entries));
        PetscCall(find_residual(ksp, j->M, values[k], x, &residual));
        largest = PetscMax(largest, residual);
    }
    PetscCall(PetscPrintf(PETSC_COMM_SELF, "{\"residual\": %.3g}\n", largest));
    PetscCall(PetscFree(values));
    PetscCall(VecDestroy(&x));
    PetscCall(KSPDestroy(&ksp));
    fclose(file);
    return 0;
}

int main(int argc, char **argv)
{
    job j = {.modes = 0};
    PetscLogDouble began, done;
    PetscMPIInt ranks;

    PetscCall(SlepcInitialize(&argc, &argv, NULL, NULL));
    PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &ranks));
    PetscCall(read_options(&j));
    PetscCheck(ranks == 1 || (!j.vectors[0] && !j.check[0]), PETSC_COMM_WORLD,
               PETSC_ERR_SUP, "-vectors and -check are for one rank");
    PetscCall(PetscTime(&began));
    PetscCall(load(j.stiffness, &j.K));
    PetscCall(load(j.mass, &j.M));
    PetscCall(PetscTime(&done));
    j.read = done - began;
    if (j.check[0]) {
        PetscCall(check_pairs(&j));
    } else {
        PetscCall(find_modes(&j));
        PetscCall(solve_columns(&j));
        PetscCall(report(&j));
        if (j.vectors[0])
            PetscCall(write_pairs(&j));
        PetscCall(EPSDestroy(&j.eps));
    }
    PetscCall(MatDestroy(&j.K));
    PetscCall(MatDestroy(&j.M));
    PetscCall(SlepcFinalize());
    return 0;
}
