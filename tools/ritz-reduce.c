/* ritz-reduce - a component in the subspace of a basis, with estimates. */
#include "describe.h"

#include <stdlib.h>

/* Without T nobody can recover the full mesh, but the file is small. */
static void drop_basis(ritz_reduced *reduced)
{
    ritz_dense_free(&reduced->T);
    ritz_grids_free(&reduced->grids);
    free(reduced->dof);
    reduced->dof = NULL;
}

static ritz_status report(cli_run *run, const ritz_reduced *reduced)
{
    ritz_status status = RITZ_OK;
    const ritz_measures *estimates = &reduced->estimates;

    cli_say(run, "%s:", run->output);
    RITZ_TRY(describe_reduced(run, run->report, reduced));
    cli_report_int(run, "vectors", reduced->columns.count);
    cli_report_reals(run, "residuals", reduced->columns.count,
                     reduced->columns.residual);
    cli_record(run, reduced->origin.method, reduced->K.nrow);
    for (int64_t k = 0; k < estimates->count; k++)
        cli_record_error(run, estimates->item[k].name,
                         estimates->item[k].value);
done:
    return status;
}

static ritz_status reduce(cli_run *run, bool without_basis)
{
    ritz_status status = RITZ_OK;
    const char *what = run->operand[1];
    model full = {0};
    model basis = {0};
    ritz_reduced reduced = {0};
    ritz_stamp stamp = {0};

    RITZ_TRY(model_read(run, run->operand[0], MODEL_COMPONENT, &full));
    RITZ_TRY(model_read(run, what, MODEL_BASIS, &basis));
    RITZ_FAIL_IF(basis.basis.T.nrow != full.component.num_dofs,
                 RITZ_ERR_ARGUMENT,
                 "'%s' is a basis for %lld dofs, '%s' has %lld", what,
                 (long long)basis.basis.T.nrow, run->operand[0],
                 (long long)full.component.num_dofs);
    RITZ_TRY_IN(what, ritz_reduce(&full.component, &basis.basis, &reduced));
    RITZ_TRY_IN(what, ritz_estimate(&full.component, &basis.basis, &reduced));
    if (without_basis)
        drop_basis(&reduced);
    stamp = cli_stamp(run);
    RITZ_TRY(ritz_container_write_reduced(run->output, &reduced, &stamp));
    RITZ_TRY(report(run, &reduced));
done:
    ritz_reduced_free(&reduced);
    model_free(&basis);
    model_free(&full);
    return status;
}

int main(int argc, char **argv)
{
    bool without_basis = false;
    const cli_option options[] = {
        {CLI_FLAG(&without_basis), .name = "without-basis",
         .help = "leave out T and the full mesh: a smaller file"},
        {0},
    };
    const cli_program program = {
        .name = "ritz-reduce",
        .operands = {{"COMPONENT", "the full component", false},
                     {"BASIS", "what ritz-basis made of it", false}},
        .summary = "Project a component on a basis; estimate the errors; "
                   "state its mass properties.",
        .example = "ritz-reduce blade.h5 basis.h5 -o blade-reduced.h5",
        .options = options,
        .output = "the reduced component",
        .threads = true,
    };
    cli_run run;

    cli_parse(&program, argc, argv, &run);
    return cli_finish(&run, reduce(&run, without_basis));
}
