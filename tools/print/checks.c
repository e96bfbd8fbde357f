#include "print/print.h"

static int64_t count_checks(const ritz_audit *audit, ritz_verdict verdict)
{
    int64_t count = 0;

    for (int64_t k = 0; k < audit->count; k++)
        count += audit->check[k].verdict == verdict;
    return count;
}

void checks_say(cli_run *run, const char *key, const ritz_audit *audit)
{
    cli_say(run, "%-28s %12s %12s  %-7s  %s", "check", "measured", "limit",
            "verdict", "where");
    SINK_ITEMS(run, key, k, audit->count) {
        const ritz_check *c = &audit->check[k];
        const char *verdict = ritz_verdict_name(c->verdict);

        sink_say(run, "name,value,limit,,where",
                 "%-28s %12.4g %12.4g  %-7s  %s", c->name, c->value, c->limit,
                 c->verdict == RITZ_FAIL ? "FAIL" : verdict, c->where);
        sink_set(run, "verdict,says", "%s %s", verdict, c->says);
        if (*c->says)
            cli_say(run, "    %s", c->says);
    }
    cli_say(run, "%ld pass, %ld warn, %ld fail", count_checks(audit, RITZ_PASS),
            count_checks(audit, RITZ_WARN), count_checks(audit, RITZ_FAIL));
}

const ritz_check *checks_first(const ritz_audit *audit)
{
    for (int64_t k = 0; k < audit->count; k++)
        if (audit->check[k].verdict == RITZ_FAIL)
            return &audit->check[k];
    return NULL;
}

ritz_status checks_run(cli_run *run, const model_options *given)
{
    const char *path = run->operand[0];
    const ritz_check *first = NULL;
    RITZ_OWN(model) m = {0};
    RITZ_OWN(ritz_audit) audit = {0};

    RITZ_CHECK(model_read(run, path, MODEL_DYNAMIC, &m));
    RITZ_CHECK(model_as_reduced(&m, path, given));
    cli_record(run, m.kind == MODEL_COMPONENT ? "audit" : "probe",
               ritz_model_order(model_reference(&m)));
    RITZ_CHECK_IN(path, m.kind == MODEL_COMPONENT
                            ? ritz_audit_component(&m.component, &audit)
                        : m.kind == MODEL_STATES
                            ? ritz_audit_states(&m.states, &audit)
                            : ritz_audit_reduced(&m.reduced, &audit));
    checks_say(run, "checks", &audit);
    for (int64_t k = 0; k < audit.count; k++)
        cli_record_error(run, audit.check[k].name, audit.check[k].value);
    if (run->output)
        RITZ_CHECK(cli_table_save(&run->said, run->output));
    cli_keep_outputs(run);
    first = checks_first(&audit);
    RITZ_REFUSE_IF(first, RITZ_ERR_FORMAT,
                   "'%s': %ld of %ld checks fail, first '%s'%s%s", path,
                   count_checks(&audit, RITZ_FAIL), audit.count, first->name,
                   *first->where ? " at " : "", first->where);
    return RITZ_OK;
}
