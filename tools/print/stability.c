#include "print/stability.h"

#include "print/checks.h"

#include <ritz/probe.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* K, M, D and K4. */
enum { NUM_MATRICES = 4 };
enum { SUM_SIZE = 2 * RITZ_WHERE_SIZE + RITZ_NAME_SIZE + 8 };

/* What a file of few digits holds is what its reader integrates. */
static void round_matrix(int64_t digits, ritz_dense *A)
{
    char text[40];

    for (int64_t k = 0; A->val && k < A->nrow * A->ncol; k++) {
        snprintf(text, sizeof text, "%.*e", (int)digits - 1, A->val[k]);
        A->val[k] = strtod(text, NULL);
    }
}

/* Digits that are left of what is written; 17: all. */
static int64_t digits_of(const ritz_export_request *request)
{
    return request->text && request->digits > 0 ? request->digits : 17;
}

ritz_status stability_of_reduced(const ritz_reduced *reduced,
                                 const ritz_export_request *request,
                                 ritz_audit *out)
{
    ritz_status status = RITZ_OK;
    int64_t digits = digits_of(request);
    ritz_reduced rounded = *reduced; /* borrowed but for its matrices */
    const ritz_dense *from[NUM_MATRICES] = {&reduced->K, &reduced->M,
                                            &reduced->D, &reduced->K4};
    ritz_dense *to[NUM_MATRICES] = {&rounded.K, &rounded.M, &rounded.D,
                                    &rounded.K4};

    if (digits > 16)
        return ritz_probe_audit_reduced(reduced, out);
    for (int k = 0; k < NUM_MATRICES; k++)
        *to[k] = (ritz_dense){0};
    for (int k = 0; k < NUM_MATRICES; k++) {
        if (from[k]->val)
            RITZ_TRY(ritz_dense_copy(from[k], to[k]));
        round_matrix(digits, to[k]);
    }
    RITZ_TRY(ritz_probe_audit_reduced(&rounded, out));
done:
    for (int k = 0; k < NUM_MATRICES; k++)
        ritz_dense_free(to[k]);
    return status;
}

ritz_status stability_of_states(const ritz_state_space *states,
                                const ritz_export_request *request,
                                ritz_audit *out)
{
    ritz_status status = RITZ_OK;
    int64_t digits = digits_of(request);
    ritz_state_space rounded = *states;

    if (digits > 16)
        return ritz_probe_audit_states(states, out);
    rounded.A = rounded.E = (ritz_dense){0};
    RITZ_TRY(ritz_dense_copy(&states->A, &rounded.A));
    if (states->E.val)
        RITZ_TRY(ritz_dense_copy(&states->E, &rounded.E));
    round_matrix(digits, &rounded.A);
    round_matrix(digits, &rounded.E);
    RITZ_TRY(ritz_probe_audit_states(&rounded, out));
done:
    ritz_dense_free(&rounded.A);
    ritz_dense_free(&rounded.E);
    return status;
}

/* "stable: pole at ...", or the first check that fails. */
static void sum_up(const ritz_audit *audit, const char **verdict,
                   char text[SUM_SIZE])
{
    const ritz_check *first = checks_first(audit);

    *verdict = first ? "unstable" : "stable";
    text[0] = '\0';
    if (first)
        snprintf(text, SUM_SIZE, "%s (%s%s%s)", first->says, first->name,
                 *first->where ? ", " : "", first->where);
    for (int64_t k = 0; !first && k < audit->count; k++)
        if (strcmp(audit->check[k].name, "poles") == 0) {
            snprintf(text, SUM_SIZE, "%s", audit->check[k].where);
            /* on the axis to rounding */
            if (fabs(audit->check[k].value) <= audit->check[k].limit)
                *verdict = "marginal";
        }
}

ritz_status stability_check(cli_run *run, const ritz_audit *audit,
                            const char *method, bool force)
{
    static const char unproven[] = "lanczos-two-sided";
    bool fails = checks_first(audit) != NULL;
    const char *verdict = NULL;
    char text[SUM_SIZE];

    sum_up(audit, &verdict, text);
    cli_report_text(run, "stability", verdict);
    json_object_set_new(run->report, "probe", checks_json(audit));
    checks_say(run, audit);
    RITZ_REFUSE_IF(fails && !force, RITZ_ERR_ARGUMENT,
                   "'%s' is unstable: %s; export it all the same with --force",
                   run->operand[0], text);
    RITZ_REFUSE_IF(strcmp(method, unproven) == 0 && !force, RITZ_ERR_ARGUMENT,
                   "'%s' was made by %s, which promises no stability (now %s: "
                   "%s); export it all the same with --force",
                   run->operand[0], method, verdict, text);
    if (fails)
        cli_warn(run, "'%s' is unstable: %s", run->operand[0], text);
    else
        cli_say(run, "%s: %s", verdict, text);
    for (int64_t k = 0; k < audit->count; k++)
        if (audit->check[k].verdict == RITZ_WARN)
            cli_warn(run, "%s (%s, %s)", audit->check[k].says,
                     audit->check[k].name, audit->check[k].where);
    return RITZ_OK;
}
