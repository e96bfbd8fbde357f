#include "print/poles.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double two_pi = 6.28318530717958647692;
/* A pole of a larger residual is not to be relied on. */
static const double exact = 1e-6;
/* Growth below this, of |s|, is rounding. */
static const double neutral = 1e-10;

static double hertz_of(double _Complex s)
{
    return cabs(s) / two_pi;
}

static const char *note_of(double _Complex s)
{
    if (creal(s) > neutral * cabs(s))
        return "unstable";
    return cimag(s) == 0.0 ? "real, does not oscillate" : "";
}

static json_t *pole_json(double _Complex s)
{
    json_t *item = json_object();

    json_object_set_new(item, "hertz", cli_real(hertz_of(s)));
    json_object_set_new(item, "zeta", cli_real(ritz_spectrum_ratio(s)));
    json_object_set_new(item, "real", cli_real(creal(s)));
    json_object_set_new(item, "imaginary", cli_real(cimag(s)));
    return item;
}

static void judge(cli_run *run, const ritz_spectrum *spectrum)
{
    int64_t rough = 0;

    for (int64_t j = 0; j < spectrum->count; j++) {
        double _Complex s = spectrum->s[j];

        if (creal(s) > neutral * cabs(s))
            cli_warn(run, "pole %lld, %.6g Hz, is unstable: it grows by %.3g/s",
                     (long long)j + 1, hertz_of(s), creal(s));
        rough += spectrum->residual[j] > exact; /* NaN: it has none */
    }
    if (rough > 0)
        cli_warn(run,
                 "%lld poles have a residual above %.0e: they are estimates",
                 (long long)rough, exact);
}

void poles_say(cli_run *run, const ritz_spectrum *spectrum, bool tsv)
{
    json_t *array = json_array();

    if (tsv)
        cli_say(run, "mode\thertz\trad_per_s\tzeta\treal\timaginary\tresidual");
    else
        cli_say(run, "%5s %13s %13s %12s %13s %13s %9s", "", "|s|/2pi Hz",
                "|s| rad/s", "zeta %", "Re s", "Im s", "residual");
    for (int64_t j = 0; j < spectrum->count; j++) {
        double _Complex s = spectrum->s[j];
        json_t *item = pole_json(s);
        char residual[32] = "-";

        if (!isnan(spectrum->residual[j]))
            snprintf(residual, sizeof residual, "%.1e", spectrum->residual[j]);
        json_object_set_new(item, "residual", cli_real(spectrum->residual[j]));
        json_array_append_new(array, item);
        if (tsv)
            cli_say(run, "%lld\t%.12g\t%.12g\t%.12g\t%.12g\t%.12g\t%.3e",
                    (long long)j + 1, hertz_of(s), cabs(s),
                    ritz_spectrum_ratio(s), creal(s), cimag(s),
                    spectrum->residual[j]);
        else
            cli_say(run, "%5lld %13.7g %13.7g %12.6g %13.6g %13.7g %9s%s%s",
                    (long long)j + 1, hertz_of(s), cabs(s),
                    100.0 * ritz_spectrum_ratio(s), creal(s), cimag(s),
                    residual, *note_of(s) ? "  " : "", note_of(s));
    }
    if (spectrum->num_zero > 0 && !tsv)
        cli_say(run, "%lld poles at 0 are not listed: rigid-body motion",
                (long long)spectrum->num_zero);
    json_object_set_new(run->report, "poles", array);
    cli_report_int(run, "zero", spectrum->num_zero);
    cli_report_text(run, "engine", spectrum->engine);
    judge(run, spectrum);
}

void poles_say_scan(cli_run *run, const ritz_scan *scan, bool tsv)
{
    json_t *array = json_array();
    json_t *best = NULL;

    cli_say(run, tsv ? "c\thertz\tzeta" : "%13s %13s %12s", "c", "|s|/2pi Hz",
            "zeta %");
    for (int64_t k = 0; k < scan->count; k++) {
        double zeta = ritz_spectrum_ratio(scan->s[k]);
        json_t *item = pole_json(scan->s[k]);

        json_object_set_new(item, "c", cli_real(scan->c[k]));
        json_array_append(array, item);
        if (k == scan->best)
            best = json_incref(item);
        json_decref(item);
        if (tsv)
            cli_say(run, "%.12g\t%.12g\t%.12g", scan->c[k],
                    hertz_of(scan->s[k]), zeta);
        else
            cli_say(run, "%13g %13.7g %12.6g%s", scan->c[k],
                    hertz_of(scan->s[k]), 100.0 * zeta,
                    k == scan->best ? "  best" : "");
    }
    json_object_set_new(run->report, "scan", array);
    json_object_set_new(run->report, "best", best);
    if (scan->best == 0 || scan->best == scan->count - 1)
        cli_warn(run, "the best c, %g, is at an end of the range",
                 scan->c[scan->best]);
}

/* The names before '=', as indices. */
static ritz_status take_names(char *names, const ritz_dampers *dampers,
                              poles_scan *out)
{
    ritz_status status = RITZ_OK;
    char *rest = NULL;
    int64_t count = 0;

    out->damper = calloc(strlen(names) + 1, sizeof *out->damper);
    RITZ_FAIL_IF(!out->damper, RITZ_ERR_MEMORY, "no memory for a scan");
    for (char *at = strtok_r(names, ",", &rest); at;
         at = strtok_r(NULL, ",", &rest)) {
        int64_t j = ritz_dampers_find(dampers, at);

        if (j < 0) {
            status = RITZ_ERR_ARGUMENT;
            goto done;
        }
        out->damper[count++] = j;
    }
    out->request.count = count;
    out->request.damper = out->damper;
done:
    return status;
}

/* "FROM:TO:STEP". */
static bool take_range(char *text, ritz_scan_request *request)
{
    char *rest = NULL;
    const char *from = strtok_r(text, ":", &rest);
    const char *to = strtok_r(NULL, ":", &rest);
    const char *step = strtok_r(NULL, ":", &rest);

    return from && to && step && !*rest &&
           ritz_text_real(from, &request->from) &&
           ritz_text_real(to, &request->to) &&
           ritz_text_real(step, &request->step);
}

ritz_status poles_scan_parse(const char *text, const ritz_dampers *dampers,
                             poles_scan *out)
{
    ritz_status status = RITZ_OK;
    char *copy = strdup(text);
    char *equals = copy ? strrchr(copy, '=') : NULL;

    RITZ_FAIL_IF(!copy, RITZ_ERR_MEMORY, "no memory for a scan");
    if (equals)
        *equals = '\0';
    RITZ_FAIL_IF(!equals || equals == copy ||
                     !take_range(equals + 1, &out->request),
                 RITZ_ERR_ARGUMENT,
                 "'%s' is not of the form NAME[,NAME]=FROM:TO:STEP", text);
    RITZ_TRY(take_names(copy, dampers, out));
done:
    free(copy);
    return ritz_context(status, "--scan");
}
