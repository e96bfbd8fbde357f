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

/* "NAME=X" of --load. */
static ritz_status parse_load(const char *text, ritz_applied *out)
{
    const char *mark = strrchr(text, '=');
    char *end = NULL;

    RITZ_REFUSE_IF(!mark || mark - text >= RITZ_NAME_SIZE, RITZ_ERR_ARGUMENT,
                   "--load: '%s' is not of the form NAME=X", text);
    snprintf(out->name, sizeof out->name, "%.*s", (int)(mark - text), text);
    out->amount = strtod(mark + 1, &end);
    RITZ_REFUSE_IF(!*out->name || end == mark + 1 || *end, RITZ_ERR_ARGUMENT,
                   "--load: '%s' is not of the form NAME=X", text);
    return RITZ_OK;
}

static ritz_status audit_model(const model *m, const cli_list *loads,
                               ritz_audit *out)
{
    RITZ_OWN_ARRAY ritz_applied *applied = NULL;

    RITZ_REFUSE_IF(m->kind == MODEL_STATES && loads->count > 0,
                   RITZ_ERR_ARGUMENT,
                   "a state space has no geometric stiffness: --load is not "
                   "for it");
    if (m->kind == MODEL_STATES)
        return ritz_audit_states(&m->states, out);
    RITZ_CHECK_NEW(applied, loads->count);
    for (int64_t k = 0; k < loads->count; k++)
        RITZ_CHECK(parse_load(loads->text[k], &applied[k]));
    return m->kind == MODEL_COMPONENT
               ? ritz_audit_component_under(&m->component, loads->count,
                                            applied, out)
               : ritz_audit_reduced_under(&m->reduced, loads->count, applied,
                                          out);
}

ritz_status checks_run(cli_run *run, const model_options *given,
                       const cli_list *loads)
{
    const char *path = run->operand[0];
    const ritz_check *first = NULL;
    RITZ_OWN(model) m = {0};
    RITZ_OWN(ritz_audit) audit = {0};

    RITZ_CHECK(model_read(run, path, MODEL_DYNAMIC, &m));
    RITZ_CHECK(model_as_reduced(&m, path, given));
    cli_record(run, m.kind == MODEL_COMPONENT ? "audit" : "probe",
               ritz_model_order(model_reference(&m)));
    RITZ_CHECK_IN(path, audit_model(&m, loads, &audit));
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
