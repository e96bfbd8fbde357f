/* What damps a model, for people and as JSON. */
#include "print/describe.h"

#include <math.h>

/* What rounding leaves of an antisymmetric part. */
static const double rounding = 1e-12;

void describe_damping(const cli_run *run, json_t *keys, const char *text)
{
    ritz_damping damping = {0};
    int64_t at = 0;
    double worst = 0.0;
    json_t *fit = json_object();

    json_object_set_new(keys, "damping", cli_string(text));
    if (*text)
        cli_say(run, "  %-14s %s", "damping", text);
    if (ritz_damping_parse(text, &damping) == RITZ_OK &&
        damping.kind == RITZ_DAMPING_FIT) {
        worst = ritz_damping_misfit(&damping, &at);
        cli_say(run,
                "  %-14s a = %.6g, b = %.6g, off by %.2g of %.2g at most, at "
                "%g Hz",
                "", damping.a, damping.b, worst, damping.point[at][1],
                damping.point[at][0]);
        json_object_set_new(fit, "a", cli_real(damping.a));
        json_object_set_new(fit, "b", cli_real(damping.b));
        json_object_set_new(fit, "residual", cli_real(worst));
        json_object_set(keys, "rayleigh_fit", fit);
    }
    json_decref(fit);
}

void describe_dampers(const cli_run *run, json_t *keys,
                      const ritz_dampers *dampers)
{
    json_t *array = json_array();

    for (int64_t j = 0; j < dampers->count; j++) {
        bool held = dampers->held_c[j] == dampers->c[j] &&
                    dampers->held_k[j] == dampers->k[j];
        json_t *item = json_object();

        cli_say(run, "  %-14s %s, c = %g, k = %g%s", j > 0 ? "" : "dampers",
                dampers->name[j], dampers->c[j], dampers->k[j],
                held ? "" : ", not in D and K");
        json_object_set_new(item, "name", cli_string(dampers->name[j]));
        json_object_set_new(item, "c", cli_real(dampers->c[j]));
        json_object_set_new(item, "k", cli_real(dampers->k[j]));
        json_array_append_new(array, item);
    }
    json_object_set_new(keys, "dampers", array);
}

void describe_skew(const cli_run *run, json_t *keys, double share)
{
    json_object_set_new(keys, "gyroscopic", cli_real(share));
    if (share > rounding)
        cli_say(run,
                "  %-14s unsymmetric: a gyroscopic part of %.3g %% is kept", "",
                100.0 * share);
}

double describe_skew_dense(const ritz_dense *D)
{
    double all = 0.0;
    double skew = 0.0;

    for (int64_t j = 0; j < D->ncol; j++)
        for (int64_t i = 0; i < D->nrow; i++) {
            double d = ritz_dense_col(D, j)[i];

            all = hypot(all, d);
            skew = hypot(skew, 0.5 * (d - ritz_dense_col(D, i)[j]));
        }
    return all > 0.0 ? skew / all : 0.0;
}
