/* ritz-reduce - a component in the subspace of a basis, with estimates. */
#include "print/dampers.h"
#include "print/describe.h"

#include <ritz/estimate.h>
#include <ritz/probe.h>

#include <stdlib.h>

/* What was asked for beside the names of files. */
typedef struct request {
    bool without_basis;
    const char *damping;
    ritz_estimate_request estimate;
} request;

/* Without T nobody can recover the full mesh, but the file is small. */
static void drop_basis(ritz_reduced *reduced)
{
    ritz_dense_free(&reduced->T);
    ritz_grids_free(&reduced->grids);
    ritz_elements_free(&reduced->elements);
    ritz_recovery_free(&reduced->recovery);
    free(reduced->dof);
    reduced->dof = NULL;
}

static ritz_status report(cli_run *run, const ritz_reduced *reduced)
{
    const ritz_measures *estimates = &reduced->estimates;

    cli_say(run, "%s:", run->output);
    RITZ_CHECK(describe_reduced(run, reduced));
    cli_report_int(run, "vectors", reduced->columns.count);
    cli_report_reals(run, "residuals", reduced->columns.count,
                     reduced->columns.residual);
    cli_record(run, reduced->origin.method, reduced->K.nrow);
    for (int64_t k = 0; k < estimates->count; k++)
        cli_record_error(run, estimates->item[k].name,
                         estimates->item[k].value);
    return RITZ_OK;
}

static ritz_status to_matrices(cli_run *run, const ritz_component *full,
                               const ritz_basis *basis, const request *asked)
{
    ritz_status status = RITZ_OK;
    const char *what = run->operand[1];
    ritz_reduced reduced = {0};
    ritz_stamp stamp = {0};

    RITZ_TRY_IN(what, ritz_reduce(full, basis, &reduced));
    RITZ_TRY_IN(what, ritz_estimate(full, basis, &asked->estimate, &reduced));
    if (asked->without_basis)
        drop_basis(&reduced);
    stamp = cli_stamp(run);
    RITZ_TRY(ritz_container_write_reduced(run->output, &reduced, &stamp));
    RITZ_TRY(report(run, &reduced));
done:
    ritz_reduced_free(&reduced);
    return status;
}

/* A model of either kind, in a basis that makes states of it. */
static ritz_status project(const model *full, const ritz_basis *basis,
                           ritz_state_space *out)
{
    ritz_damping damping = {0};

    if (full->kind == MODEL_STATES)
        return ritz_reduce_space(&full->states, basis, out);
    RITZ_CHECK(ritz_damping_parse(basis->damping, &damping));
    if (basis->states)
        RITZ_CHECK(ritz_reduce_states(&full->component, &damping, basis, out));
    else
        RITZ_CHECK(
            ritz_reduce_companion(&full->component, &damping, basis, out));
    return RITZ_OK;
}

/* Of states it is known whether they are stable and, of some, a bound. */
static ritz_status to_states(cli_run *run, const model *full,
                             const ritz_basis *basis)
{
    ritz_status status = RITZ_OK;
    const char *what = run->operand[1];
    ritz_state_space states = {0};
    ritz_probe probe = {0};
    ritz_stamp stamp = {0};
    char text[2 * RITZ_NAME_SIZE];

    RITZ_TRY_IN(what, project(full, basis, &states));
    RITZ_TRY_IN(what, ritz_probe_states(&states, &probe));
    RITZ_TRY(ritz_probe_record(&probe, &states.estimates));
    stamp = cli_stamp(run);
    RITZ_TRY(ritz_container_write_state_space(run->output, &states, &stamp));
    cli_say(run, "%s:", run->output);
    RITZ_TRY(describe_states(run, &states));
    cli_report_int(run, "vectors", states.columns.count);
    cli_record(run, states.origin.method, states.A.nrow);
    for (int64_t k = 0; k < states.estimates.count; k++)
        cli_record_error(run, states.estimates.item[k].name,
                         states.estimates.item[k].value);
    ritz_probe_print(&probe, text);
    if (probe.verdict == RITZ_UNSTABLE)
        cli_warn(run, "'%s' is unstable: %s", run->output, text);
done:
    ritz_state_space_free(&states);
    return status;
}

/* Whether a basis was made for as many dofs, or states, as there are. */
static ritz_status check_rows(const cli_run *run, const model *full,
                              const ritz_basis *basis)
{
    bool space = full->kind == MODEL_STATES;
    int64_t due = space ? full->states.A.nrow : full->component.num_dofs;
    int64_t rows = basis->T.nrow / (basis->states && !space ? 2 : 1);

    RITZ_REFUSE_IF(space && !basis->states, RITZ_ERR_ARGUMENT,
                   "'%s' is a basis of displacements, '%s' is a state space",
                   run->operand[1], run->operand[0]);
    RITZ_REFUSE_IF(rows != due, RITZ_ERR_ARGUMENT,
                   "'%s' is a basis for %lld %s, '%s' has %lld",
                   run->operand[1], (long long)rows, space ? "states" : "dofs",
                   run->operand[0], (long long)due);
    return RITZ_OK;
}

static ritz_status reduce(cli_run *run, request *asked)
{
    ritz_status status = RITZ_OK;
    const char *what = run->operand[1];
    model full = {0};
    model basis = {0};
    RITZ_TRY(model_read(run, run->operand[0], MODEL_COMPONENT | MODEL_STATES,
                        &full));
    RITZ_TRY(model_read(run, what, MODEL_BASIS, &basis));
    RITZ_TRY(check_rows(run, &full, &basis.basis));
    RITZ_TRY(model_damping(&full, asked->damping, &asked->estimate.damping));
    RITZ_FAIL_IF(asked->without_basis && full.kind == MODEL_STATES,
                 RITZ_ERR_ARGUMENT,
                 "a reduced state space keeps no basis, --without-basis is for "
                 "components");
    if (full.kind == MODEL_STATES || basis.basis.states || basis.basis.W.val)
        RITZ_TRY(to_states(run, &full, &basis.basis));
    else
        RITZ_TRY(to_matrices(run, &full.component, &basis.basis, asked));
done:
    model_free(&basis);
    model_free(&full);
    return status;
}

int main(int argc, char **argv)
{
    request asked = {0};
    const char *band = NULL;
    const cli_option options[] = {
        {CLI_TEXT(&band), .name = "band-hz", .argument = "F,F",
         .help = "where errors are estimated [up to half of what the basis "
                 "knows]"},
        DAMPING_OPTION(&asked.damping),
        {CLI_FLAG(&asked.without_basis), .name = "without-basis",
         .help = "leave out T and the full mesh: a smaller file"},
        {0},
    };
    const cli_program program = {
        .name = "ritz-reduce",
        .operands = {{"COMPONENT", "the full component or state space", false},
                     {"BASIS", "what ritz-basis made of it", false}},
        .summary = "Project a component on a basis; estimate the errors; "
                   "state its mass properties.",
        .example = "ritz-reduce blade.h5 basis.h5 -o blade-reduced.h5",
        .options = options,
        .output = "the reduced component; the state space, of states or of "
                  "vectors on two sides",
        .threads = true,
    };
    cli_run run;

    cli_parse(&program, argc, argv, &run);
    if (band)
        cli_pair(&program, "band-hz", band, asked.estimate.band_hz);
    return cli_finish(&run, reduce(&run, &asked));
}
