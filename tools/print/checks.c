#include "print/checks.h"

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

void checks_say(const cli_run *run, const ritz_audit *audit)
{
    cli_say(run, "%-28s %12s %12s  %-7s  %s", "check", "measured", "limit",
            "verdict", "where");
    for (int64_t k = 0; k < audit->count; k++)
        say_check(run, &audit->check[k]);
    cli_say(run, "%lld pass, %lld warn, %lld fail",
            (long long)checks_count(audit, RITZ_PASS),
            (long long)checks_count(audit, RITZ_WARN),
            (long long)checks_count(audit, RITZ_FAIL));
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

json_t *checks_json(const ritz_audit *audit)
{
    json_t *checks = json_array();

    for (int64_t k = 0; k < audit->count; k++)
        json_array_append_new(checks, check_json(&audit->check[k]));
    return checks;
}

const ritz_check *checks_first(const ritz_audit *audit)
{
    for (int64_t k = 0; k < audit->count; k++)
        if (audit->check[k].verdict == RITZ_FAIL)
            return &audit->check[k];
    return NULL;
}

int64_t checks_count(const ritz_audit *audit, ritz_verdict verdict)
{
    int64_t count = 0;

    for (int64_t k = 0; k < audit->count; k++)
        count += audit->check[k].verdict == verdict;
    return count;
}
