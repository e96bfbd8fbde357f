/* ritz-check - audit a component before it is reduced, or probe a small model. */
#include "print/checks.h"

#include <ritz/probe.h>

/* Say all; the sentence of the failure names the first check that fails. */
static ritz_status judge(cli_run *run, const ritz_audit *audit)
{
    const ritz_check *first = checks_first(audit);

    json_object_set_new(run->report, "checks", checks_json(audit));
    checks_say(run, audit);
    for (int64_t k = 0; k < audit->count; k++)
        cli_record_error(run, audit->check[k].name, audit->check[k].value);
    if (run->output)
        RITZ_CHECK(cli_save(run, run->output));
    RITZ_REFUSE_IF(first, RITZ_ERR_FORMAT,
                   "'%s': %lld of %lld checks fail, first '%s'%s%s",
                   run->operand[0], (long long)checks_count(audit, RITZ_FAIL),
                   (long long)audit->count, first->name,
                   *first->where ? " at " : "", first->where);
    return RITZ_OK;
}

/* A full component is audited, what is small and dense is probed. */
static ritz_status check(cli_run *run)
{
    ritz_status status = RITZ_OK;
    const char *path = run->operand[0];
    model m = {0};
    ritz_audit audit = {0};

    RITZ_TRY(model_read(run, path,
                        MODEL_COMPONENT | MODEL_REDUCED | MODEL_STATES, &m));
    if (m.kind == MODEL_COMPONENT) {
        cli_record(run, "audit", m.component.num_dofs);
        RITZ_TRY_IN(path, ritz_audit_component(&m.component, &audit));
    } else if (m.kind == MODEL_REDUCED) {
        cli_record(run, "probe", m.reduced.K.nrow);
        RITZ_TRY_IN(path, ritz_probe_audit_reduced(&m.reduced, &audit));
    } else {
        cli_record(run, "probe", m.states.A.nrow);
        RITZ_TRY_IN(path, ritz_probe_audit_states(&m.states, &audit));
    }
    RITZ_TRY(judge(run, &audit));
done:
    ritz_audit_free(&audit);
    model_free(&m);
    return status;
}

int main(int argc, char **argv)
{
    const cli_option options[] = {{0}};
    const cli_program program = {
        .name = "ritz-check",
        .operands = {{"MODEL",
                      "a component to audit, or a reduced component or state "
                      "space to probe",
                      false}},
        .summary = "Audit a component before it is reduced: symmetry, "
                   "definiteness, rigid-body modes,\ngrounding, mass "
                   "properties, massless and unconnected dofs, digits, ports. "
                   "Probe a small model\nfor stability: definiteness, poles, "
                   "energy growth, passivity, its interface locked\nand on "
                   "springs. Status 1 if one check fails; warnings do not "
                   "fail.",
        .example = "ritz-check blade.h5",
        .options = options,
        .output = "write the table there too",
        .output_optional = true,
        .threads = true,
    };
    cli_run run;

    cli_parse(&program, argc, argv, &run);
    return cli_finish(&run, check(&run));
}
