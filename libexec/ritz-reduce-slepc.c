/*
 * ritz-reduce-slepc - the program that ritz-reduce executes for --engine slepc:
 * the same tool, but the matrices of the component are distributed over the
 * processes of MPI.
 *
 * Rank 0 reads the command line and the basis, prints and writes the reduced
 * component. The other ranks wait in projection_help() for their part of the
 * computation, and print nothing.
 */
#include "print/print.h"
#include "slepc/projection.h"
#include "slepc/ranks.h"

#include "container/slab.h"

#include <stdlib.h>
#include <string.h>

/* Path of the component, which reduce_run() does not pass on to the
   projection. */
static const char *file;

/* Read a component without its matrices; of these each rank reads its part. */
static ritz_status read_frame(cli_run *run, const char *path, model *out)
{
    ritz_status status = RITZ_OK;

    RITZ_CHECK(cli_input(run, path));
    RITZ_CHECK(ritz_container_keep(path));
    status = ritz_slab_frame(path, &out->component);
    ritz_container_release();
    RITZ_CHECK(status);
    out->kind = MODEL_COMPONENT;
    file = path;
    return RITZ_OK;
}

static ritz_status project(const ritz_component *component,
                           const ritz_basis *basis, ritz_reduced *out)
{
    return projection_make(file, component, basis, out);
}

/* Refuse estimates, and options that change matrices or damping: rank 0 has no
   matrices of the component. */
static void refuse_options(const cli_run *run, const reduce_options *given)
{
    const struct {
        const char *option;
        bool given;
    } others[] = {
        {"--at", given->model.at != NULL},
        {"--order", given->model.order > 0},
        {"--damping", given->model.damping != NULL},
        {"--band-hz", given->estimate.band_hz[1] > 0.0},
        {"--memory", run->memory != NULL},
    };

    for (size_t k = 0; k < sizeof others / sizeof *others; k++)
        if (others[k].given)
            cli_refuse(run->program, "engine slepc takes no %s",
                       others[k].option);
    if (!given->estimates || strcmp(given->estimates, "none") != 0)
        cli_refuse(run->program,
                   "engine slepc makes no estimates: say --estimates none");
}

static ritz_status run_in_ranks(cli_run *run, reduce_options *given)
{
    refuse_options(run, given);
    given->read = read_frame;
    given->project = project;
    return reduce_run(run, given);
}

/* Called when rank 0 exits, after main() or a usage error. If the other ranks
   wait, they are told to end; if they are in a computation that rank 0 has
   left, the whole run is aborted. */
static void end_others(void)
{
    if (!projection_is_idle())
        ranks_abort();
    projection_dismiss();
    ranks_stop();
}

int main(int argc, char **argv)
{
    /* if it is not set, the tool sets it and executes itself again, which a
       process of MPI must not do */
    if (setenv("OMP_THREAD_LIMIT", "1", 0) != 0)
        return EXIT_FAILURE;
    ranks_start("ritz-reduce");
    if (ranks_own() > 0) {
        projection_help();
        ranks_stop();
        return EXIT_SUCCESS;
    }
    atexit(end_others);
    return reduce_main(argc, argv, run_in_ranks);
}
