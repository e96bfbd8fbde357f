/* ritz-check - audit a component before it is reduced. */
#include "model.h"

#include <ritz/audit.h>

#include <math.h>

static void say_check(const cli_run *run, const ritz_check *check)
{
    char value[24] = "-";
    char limit[24] = "-";

    if (!isnan(check->value))
        snprintf(value, sizeof value, "%.4g", check->value);
    if (!isnan(check->limit))
        snprintf(limit, sizeof limit, "%.4g", check->limit);
    cli_say(run, "%-28s %12s %12s  %-7s  %s", check->name, value, limit,
            check->verdict == RITZ_FAIL ? "FAIL"
                                        : ritz_verdict_name(check->verdict),
            check->where);
    if (*check->says)
        cli_say(run, "    %s", check->says);
}

static json_t *check_json(const ritz_check *check)
{
    json_t *item = json_object();

    json_object_set_new(item, "name", cli_string(check->name));
    json_object_set_new(item, "value", cli_real(check->value));
    json_object_set_new(item, "limit", cli_real(check->limit));
    json_object_set_new(item, "verdict",
                        json_string(ritz_verdict_name(check->verdict)));
    json_object_set_new(item, "where", cli_string(check->where));
    json_object_set_new(item, "says", cli_string(check->says));
    return item;
}

/* Say all; the sentence of the failure names the first check that fails. */
static ritz_status judge(cli_run *run, const ritz_audit *audit)
{
    ritz_status status = RITZ_OK;
    json_t *checks = json_array();
    int64_t count[RITZ_FAIL + 1] = {0};
    const ritz_check *first = NULL;

    json_object_set_new(run->report, "checks", checks);
    cli_say(run, "%-28s %12s %12s  %-7s  %s", "check", "measured", "limit",
            "verdict", "where");
    for (int64_t k = 0; k < audit->count; k++) {
        const ritz_check *check = &audit->check[k];

        say_check(run, check);
        json_array_append_new(checks, check_json(check));
        count[check->verdict]++;
        if (check->verdict == RITZ_FAIL && !first)
            first = check;
        cli_record_error(run, check->name, check->value);
    }
    cli_say(run, "%lld pass, %lld warn, %lld fail", (long long)count[RITZ_PASS],
            (long long)count[RITZ_WARN], (long long)count[RITZ_FAIL]);
    if (run->output)
        RITZ_TRY(cli_save(run, run->output));
    RITZ_FAIL_IF(first, RITZ_ERR_FORMAT,
                 "'%s': %lld of %lld checks fail, first '%s'%s%s",
                 run->operand[0], (long long)count[RITZ_FAIL],
                 (long long)audit->count, first->name,
                 *first->where ? " at " : "", first->where);
done:
    return status;
}

static ritz_status check(cli_run *run)
{
    ritz_status status = RITZ_OK;
    model m = {0};
    ritz_audit audit = {0};

    RITZ_TRY(model_read(run, run->operand[0], MODEL_COMPONENT, &m));
    cli_record(run, "audit", m.component.num_dofs);
    RITZ_TRY_IN(run->operand[0], ritz_audit_component(&m.component, &audit));
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
        .operands = {{"COMPONENT", "the component to audit", false}},
        .summary = "Audit a component before it is reduced: symmetry, "
                   "definiteness, rigid-body modes,\ngrounding, mass "
                   "properties, massless and unconnected dofs, digits, ports. "
                   "Status 1 if\none check fails; warnings do not fail.",
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
