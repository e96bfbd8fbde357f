/*
 * ritz-basis-slepc - the program that ritz-basis executes for --engine slepc:
 * the same tool, but matrices, factors and modes are distributed over the
 * processes of MPI. It is linked with PETSc, SLEPc and the parallel MUMPS. The
 * sequential MUMPS has the same symbols, so that mumps.c of the library is
 * replaced by a copy that is compiled for the parallel one.
 *
 * Rank 0 reads the command line, prints and writes the basis. The other ranks
 * wait in fixed_help() for their part of the computation, and print nothing.
 */
#include "bases/columns.h"
#include "cli/cli.h"
#include "container/slab.h"
#include "print/print.h"
#include "slepc/fixed.h"
#include "slepc/ranks.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Path of the component. A method's make() has no parameter for it. */
static const char *file;

/* --- options that this engine does not have ------------------------------- */

static void refuse_options(const cli_run *run, const basis_options *given)
{
    const ritz_choice *choice = &given->request.choice;
    const struct {
        const char *option;
        bool given;
    } others[] = {
        {"--neighbour", given->neighbours.count > 0},
        {"--at", given->model.at != NULL},
        {"--order", given->model.order > 0},
        {"--interface-modes", choice->interface_modes > 0},
    };

    for (size_t k = 0; k < sizeof others / sizeof *others; k++)
        if (others[k].given)
            cli_refuse(run->program, "engine slepc takes no %s",
                       others[k].option);
}

/* Refuse normal modes that would have static vectors. */
static ritz_status refuse_loads(const ritz_request *request)
{
    const bool asked = request->choice.given & RITZ_USES_LOADS;
    const int loads =
        asked ? request->choice.loads : RITZ_LOADS_DAMPERS | RITZ_LOADS_INPUTS;

    RITZ_REFUSE_IF((asked && loads) || ritz_loads_count(request, loads) > 0,
                   RITZ_ERR_ARGUMENT,
                   "engine slepc makes no static vectors of inputs, outputs "
                   "or dampers for a free component");
    return RITZ_OK;
}

/* --- methods -------------------------------------------------------------- */

static ritz_status make_held(const ritz_request *request, ritz_basis *out)
{
    int loads = 0;

    RITZ_CHECK_IN("static vectors",
                  ritz_loads_beside(request, RITZ_LOADS_DAMPERS, &loads));
    return fixed_make(file, request, true, loads, out);
}

static ritz_status make_free(const ritz_request *request, ritz_basis *out)
{
    RITZ_CHECK(refuse_loads(request));
    return fixed_make(file, request, false, 0, out);
}

static const struct {
    const ritz_method *method;
    ritz_status (*make)(const ritz_request *request, ritz_basis *out);
} methods[] = {
    {&ritz_method_craig_bampton, make_held},
    {&ritz_method_normal_modes, make_free},
};

static void choose_method(const cli_run *run, const ritz_method *method,
                          ritz_method *out)
{
    for (size_t k = 0; k < sizeof methods / sizeof *methods; k++)
        if (methods[k].method == method) {
            *out = *method;
            out->make = methods[k].make;
            out->by_ranks = true;
            return;
        }
    cli_refuse(run->program,
               "engine slepc finds bases of craig-bampton and normal-modes, "
               "not of %s",
               method->name);
}

/* --- the tool ------------------------------------------------------------- */

/* Read a component without its matrices; of these each rank reads its part. */
static ritz_status read_frame(cli_run *run, const char *path, model *out)
{
    ritz_status status = RITZ_OK;

    RITZ_CHECK(cli_input(run, path));
    RITZ_CHECK(ritz_container_keep(path));
    status = ritz_slab_frame(path, &out->component);
    ritz_container_release();
    out->kind = MODEL_COMPONENT;
    file = path;
    return status;
}

static ritz_status run_in_ranks(cli_run *run, basis_options *given)
{
    ritz_method method;

    refuse_options(run, given);
    choose_method(run, given->method, &method);
    given->method = &method;
    given->read = read_frame;
    return basis_run(run, given);
}

/* Called when rank 0 exits, after main() or a usage error. If the other ranks
   wait, they are told to end; if they are in a computation that rank 0 has
   left, the whole run is aborted. */
static void end_others(void)
{
    if (!fixed_is_idle())
        ranks_abort();
    fixed_dismiss();
    ranks_stop();
}

int main(int argc, char **argv)
{
    /* if it is not set, the tool sets it and executes itself again, which a
       process of MPI must not do */
    if (setenv("OMP_THREAD_LIMIT", "1", 0) != 0)
        return EXIT_FAILURE;
    ranks_start("ritz-basis");
    if (ranks_own() > 0) {
        fixed_help();
        ranks_stop();
        return EXIT_SUCCESS;
    }
    atexit(end_others);
    return basis_main(argc, argv, run_in_ranks);
}
