/* What is in a model in first-order form: matrices, poles, verdict. */
#include "print/describe.h"

#include "base/tolerances.h"

#include "print/checksum.h"

#include <ritz/probe.h>

#include <complex.h>
#include <math.h>
#include <stdlib.h>

enum { SHOWN = 40 };

static void matrices(const cli_run *run, json_t *keys,
                     const ritz_state_space *s)
{
    const struct {
        const char *name;
        const ritz_dense *A;
    } all[] = {
        {"A", &s->A}, {"B", &s->B}, {"C", &s->C}, {"D", &s->D}, {"E", &s->E}};
    json_t *sums = json_object();
    char sum[RITZ_DIGEST_SIZE];

    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        if (!all[k].A->val)
            continue;
        checksum_dense(all[k].A, sum);
        json_object_set_new(sums, all[k].name, cli_string(sum));
        cli_say(run, "  %-14s %lld x %lld, dense, sha256 %.12s...", all[k].name,
                (long long)all[k].A->nrow, (long long)all[k].A->ncol, sum);
    }
    json_object_set_new(keys, "checksums", sums);
}

static json_t *names(int64_t count, char (*name)[RITZ_NAME_SIZE])
{
    json_t *array = json_array();

    for (int64_t k = 0; k < count; k++)
        json_array_append_new(array, cli_string(name[k]));
    return array;
}

static void ends(const cli_run *run, json_t *keys, const ritz_state_space *s)
{
    for (int64_t k = 0; k < s->num_inputs; k++)
        cli_say(run, "  %-14s %s", k > 0 ? "" : "inputs", s->input[k]);
    for (int64_t k = 0; k < s->num_outputs; k++) {
        if (isnan(s->limit[k]))
            cli_say(run, "  %-14s %s", k > 0 ? "" : "outputs", s->output[k]);
        else
            cli_say(run, "  %-14s %s, limit %g", k > 0 ? "" : "outputs",
                    s->output[k], s->limit[k]);
    }
    json_object_set_new(keys, "inputs", names(s->num_inputs, s->input));
    json_object_set_new(keys, "outputs", names(s->num_outputs, s->output));
}

/* The slowest first, of a pair one line. */
static void poles(const cli_run *run, json_t *keys, int64_t count,
                  const double _Complex *pole)
{
    json_t *array = json_array();
    int64_t shown = 0;

    cli_say(run, "  %-14s %14s %14s %12s %10s", "poles", "real, rad/s",
            "imaginary", "Hz", "damping");
    for (int64_t k = 0; k < count; k++) {
        double re = creal(pole[k]);
        double im = cimag(pole[k]);
        double w = hypot(re, im);
        json_t *pair = json_array();

        json_array_append_new(pair, cli_real(re));
        json_array_append_new(pair, cli_real(im));
        json_array_append_new(array, pair);
        if (im < 0.0 || shown++ >= SHOWN)
            continue;
        cli_say(run, "  %-14s %14.6g %14.6g %12.6g %10.4g", "", re, im,
                w / (2.0 * RITZ_PI), w > 0.0 ? -re / w : 0.0);
    }
    if (shown > SHOWN)
        cli_say(run, "  %-14s and %lld faster ones", "",
                (long long)(shown - SHOWN));
    json_object_set_new(keys, "poles", array);
}

ritz_status describe_states(const cli_run *run, json_t *keys,
                            const ritz_state_space *states)
{
    ritz_status status = RITZ_OK;
    ritz_probe probe = {0};
    double _Complex *pole = NULL;
    int64_t count = 0;
    char text[2 * RITZ_NAME_SIZE];

    RITZ_TRY(ritz_probe_states(states, &probe));
    RITZ_TRY(ritz_state_space_poles(states, &count, &pole));
    cli_say(run, "  %-14s state space, %lld states", "kind",
            (long long)states->A.nrow);
    cli_say(run, "  %-14s %s", "units",
            *states->units ? states->units : "not stated");
    if (*states->origin.method)
        describe_origin(run, keys, &states->origin);
    describe_columns(run, keys, &states->columns);
    matrices(run, keys, states);
    describe_damping(run, keys, states->damping);
    ends(run, keys, states);
    poles(run, keys, count, pole);
    ritz_probe_print(&probe, text);
    cli_say(run, "  %-14s %s: %s", "stability",
            ritz_stability_name(probe.verdict), text);
    json_object_set_new(keys, "kind", cli_string("state-space"));
    json_object_set_new(keys, "states", json_integer(states->A.nrow));
    json_object_set_new(keys, "units", cli_string(states->units));
    json_object_set_new(keys, "stability",
                        cli_string(ritz_stability_name(probe.verdict)));
    describe_measures(run, keys, "estimates", &states->estimates);
    describe_measures(run, keys, "errors", &states->errors);
done:
    free(pole);
    return status;
}
