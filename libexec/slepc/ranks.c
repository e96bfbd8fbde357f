#define _DEFAULT_SOURCE /* NOLINT: declares usleep */

#include "ranks.h"

#include "base/alloc.h"
#include "cli/cli.h"

#include <fcntl.h>
#include <slepceps.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    SENTENCE = 1024, /* bytes of a message */
    WAIT = 300000,   /* microseconds */
};

int ranks_own(void)
{
    int rank = 0;

    MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
    return rank;
}

int ranks_count(void)
{
    int count = 1;

    MPI_Comm_size(PETSC_COMM_WORLD, &count);
    return count;
}

void ranks_abort(void)
{
    MPI_Abort(MPI_COMM_WORLD, EXIT_FAILURE);
    _exit(EXIT_FAILURE);
}

static PetscErrorCode tolerated; /* 0: none */

void ranks_tolerate(PetscErrorCode code)
{
    tolerated = code;
}

/*
 * PETSc calls this when a function of it fails. If it fails in all ranks, the
 * message is to appear once: ranks above 0 wait a little, and rank 0 prints and
 * aborts the run meanwhile.
 */
/* NOLINTNEXTLINE(readability-function-size): PETSc's parameters */
static PetscErrorCode complain_once(MPI_Comm comm, int line,
                                    const char *function, const char *file,
                                    PetscErrorCode code, PetscErrorType type,
                                    const char *sentence, void *context)
{
    (void)comm;
    if (code == tolerated && code != 0)
        return code;
    (void)line;
    (void)file;
    (void)type;
    if (ranks_own() > 0)
        usleep(WAIT);
    cli_complain("%s: %s: PETSc fails in %s, rank %d: %s\n",
                 (const char *)context,
                 code == PETSC_ERR_MEM ? "no memory" : "engine slepc",
                 function ? function : "a function", ranks_own(),
                 sentence ? sentence : "no reason is given");
    ranks_abort();
}

/* Whether mpirun, which gets standard error of its processes through a pipe or a
   terminal of its own, writes it to a terminal. */
static bool ends_on_terminal(void)
{
    char path[48];
    struct stat own, other;
    bool found = false;
    int file = -1;

    if (!getenv("OMPI_COMM_WORLD_RANK") && !getenv("PMI_RANK"))
        return false;
    if (fstat(STDERR_FILENO, &own) != 0 || S_ISREG(own.st_mode))
        return false; /* sent to a file of its own */
    snprintf(path, sizeof path, "/proc/%ld/fd/%d", (long)getppid(),
             STDERR_FILENO);
    if (stat(path, &other) != 0 || !S_ISCHR(other.st_mode))
        return false;
    file = open(path, O_WRONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (file >= 0) {
        found = isatty(file);
        close(file);
    }
    return found;
}

void ranks_start(const char *tool)
{
    static char name[] = "ritz-slepc";
    static char *names[] = {name, NULL};
    char **arguments = names;
    int count = 1;
    union {
        const char *given;
        void *context; /* PETSc passes it on, and changes nothing */
    } at = {.given = tool};

    if (PetscOptionsSetValue(NULL, "-no_signal_handler", NULL) != 0 ||
        SlepcInitialize(&count, &arguments, NULL, NULL) != 0 ||
        PetscPushErrorHandler(complain_once, at.context) != 0) {
        cli_complain("%s: PETSc and SLEPc do not start\n", tool);
        _exit(EXIT_FAILURE);
    }
    if (ends_on_terminal())
        cli_is_passed_on();
}

void ranks_stop(void)
{
    ranks_expect(PetscPopErrorHandler());
    ranks_expect(SlepcFinalize());
}

void ranks_expect(PetscErrorCode code)
{
    if (code != 0)
        ranks_abort();
}

ritz_status ranks_agree(ritz_status own)
{
    char sentence[SENTENCE] = "";
    int first = own == RITZ_OK ? ranks_count() : ranks_own();
    int status = (int)own;

    MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD);
    if (first == ranks_count())
        return RITZ_OK;
    if (first == ranks_own())
        snprintf(sentence, sizeof sentence, "%s", ritz_error_message());
    MPI_Bcast(sentence, SENTENCE, MPI_CHAR, first, PETSC_COMM_WORLD);
    MPI_Bcast(&status, 1, MPI_INT, first, PETSC_COMM_WORLD);
    if (first != ranks_own())
        ritz_record("%s", sentence);
    return (ritz_status)status;
}

void *ranks_take(int64_t count, size_t size)
{
    void *room = ritz_zalloc(count, size);

    if (!room)
        ranks_abort();
    return room;
}

void ranks_share(void *bytes, int64_t count)
{
    enum { PIECE = 1 << 30 };
    char *at = bytes;

    for (; count > 0; count -= PIECE, at += PIECE)
        MPI_Bcast(at, count < PIECE ? (int)count : PIECE, MPI_BYTE, 0,
                  PETSC_COMM_WORLD);
}

void ranks_sum(double *values, int64_t count)
{
    MPI_Allreduce(MPI_IN_PLACE, values, (int)count, MPI_DOUBLE, MPI_SUM,
                  PETSC_COMM_WORLD);
}

int64_t ranks_total(int64_t own)
{
    int64_t total = own;

    MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPI_INT64_T, MPI_SUM,
                  PETSC_COMM_WORLD);
    return total;
}
