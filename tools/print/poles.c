#include "print/print.h"

#include "base/tolerances.h"

#include <complex.h>

/* Poles of a large component that are listed where nothing is asked for. */
enum { SOME_MODES = 20 };

/* A pole of a larger residual is not to be relied on. */
static const double exact = 1e-6;
/* Growth below this, of |s|, is rounding. */
static const double neutral = 1e-10;

static double hertz_of(double _Complex s)
{
    return cabs(s) / (2.0 * RITZ_PI);
}

static const char *note_of(double _Complex s)
{
    if (creal(s) > neutral * cabs(s))
        return "unstable";
    return cimag(s) == 0.0 ? "real, does not oscillate" : "";
}

/* Keys of a pole, in the object that is open. */
static void set_pole(cli_run *run, double _Complex s)
{
    sink_set(run, "hertz,zeta,real,imaginary", "%g %g %g %g", hertz_of(s),
             ritz_spectrum_ratio(s), creal(s), cimag(s));
}

static void warn_poles(cli_run *run, const ritz_spectrum *spectrum)
{
    int64_t rough = 0;

    for (int64_t j = 0; j < spectrum->count; j++) {
        double _Complex s = spectrum->s[j];

        if (creal(s) > neutral * cabs(s))
            cli_warn(run, "pole %ld, %.6g Hz, is unstable: it grows by %.3g/s",
                     j + 1, hertz_of(s), creal(s));
        rough += spectrum->residual[j] > exact; /* NaN: it has none */
    }
    if (rough > 0)
        cli_warn(run,
                 "%ld poles have a residual above %.0e: they are estimates",
                 rough, exact);
}

/* A table, and a warning for each pole that is unstable or not exact. */
static void say_poles(cli_run *run, const ritz_spectrum *spectrum, bool tsv)
{
    if (tsv)
        cli_say(run, "mode\thertz\trad_per_s\tzeta\treal\timaginary\tresidual");
    else
        cli_say(run, "%5s %13s %13s %12s %13s %13s %9s", "", "|s|/2pi Hz",
                "|s| rad/s", "zeta %", "Re s", "Im s", "residual");
    SINK_ITEMS(run, "poles", j, spectrum->count) {
        double _Complex s = spectrum->s[j];
        double zeta = ritz_spectrum_ratio(s);

        set_pole(run, s);
        sink_set(run, "residual", "%g", spectrum->residual[j]);
        if (tsv)
            cli_say(run, "%ld\t%.12g\t%.12g\t%.12g\t%.12g\t%.12g\t%.3e", j + 1,
                    hertz_of(s), cabs(s), zeta, creal(s), cimag(s),
                    spectrum->residual[j]);
        else
            cli_say(run, "%5ld %13.7g %13.7g %12.6g %13.6g %13.7g %9.1e%s%s",
                    j + 1, hertz_of(s), cabs(s), 100.0 * zeta, creal(s),
                    cimag(s), spectrum->residual[j], *note_of(s) ? "  " : "",
                    note_of(s));
    }
    sink_set(run, "zero,engine", "%ld %s", spectrum->num_zero,
             spectrum->engine);
    if (spectrum->num_zero > 0 && !tsv)
        cli_say(run, "%ld poles at 0 are not listed: rigid-body motion",
                spectrum->num_zero);
    warn_poles(run, spectrum);
}

/* A table, and the best constant. */
static void say_scan(cli_run *run, const ritz_scan *scan, bool tsv)
{
    cli_say(run, tsv ? "%s\t%s\t%s" : "%13s %13s %12s", "c",
            tsv ? "hertz" : "|s|/2pi Hz", tsv ? "zeta" : "zeta %");
    SINK_ITEMS(run, "scan", k, scan->count) {
        double hertz = hertz_of(scan->s[k]);
        double zeta = ritz_spectrum_ratio(scan->s[k]);

        set_pole(run, scan->s[k]);
        if (tsv)
            sink_say(run, "c", "%.12g\t%.12g\t%.12g", scan->c[k], hertz, zeta);
        else
            sink_say(run, "c", "%13g %13.7g %12.6g%s", scan->c[k], hertz,
                     100.0 * zeta, k == scan->best ? "  best" : "");
    }
    json_object_set(run->report, "best",
                    json_array_get(json_object_get(run->report, "scan"),
                                   (size_t)scan->best));
    if (scan->best == 0 || scan->best == scan->count - 1)
        cli_warn(run, "the best c, %g, is at an end of the range",
                 scan->c[scan->best]);
}

/* The names before '=', as indices. */
static ritz_status take_names(char *names, const ritz_dampers *dampers,
                              int64_t *count, int64_t *out)
{
    char *rest = NULL;

    for (char *at = strtok_r(names, ",", &rest); at;
         at = strtok_r(NULL, ",", &rest)) {
        out[*count] = ritz_dampers_find(dampers, at);
        if (out[(*count)++] < 0)
            return RITZ_ERR_ARGUMENT;
    }
    return RITZ_OK;
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

/* "NAME[,NAME]=FROM:TO:STEP"; @p damper is to be freed. */
static ritz_status parse_scan(const char *text, const ritz_dampers *dampers,
                              ritz_scan_request *out, int64_t **damper)
{
    RITZ_OWN_ARRAY char *copy = NULL;
    int64_t size = (int64_t)strlen(text) + 1;
    char *equals = NULL;

    RITZ_CHECK_COPY(copy, text, size);
    RITZ_CHECK_NEW(*damper, size);
    equals = strrchr(copy, '=');
    if (equals)
        *equals = '\0';
    RITZ_REFUSE_IF(!equals || equals == copy || !take_range(equals + 1, out),
                   RITZ_ERR_ARGUMENT,
                   "'%s' is not of the form NAME[,NAME]=FROM:TO:STEP", text);
    RITZ_CHECK(take_names(copy, dampers, &out->count, *damper));
    out->damper = *damper;
    return RITZ_OK;
}

static ritz_status scan_dampers(cli_run *run, model *m,
                                const poles_options *given)
{
    ritz_scan_request request = {0};
    RITZ_OWN_ARRAY int64_t *damper = NULL;
    RITZ_OWN(ritz_scan) found = {0};

    RITZ_CHECK_IN("--scan",
                  parse_scan(given->scan, model_dampers(m), &request, &damper));
    request.mode = given->mode - 1;
    RITZ_CHECK(ritz_scan_of(model_reference(m), &request, &found));
    say_scan(run, &found, given->tsv);
    return RITZ_OK;
}

/* Those that are asked for, of what a small model gives. */
static ritz_status find_poles(cli_run *run, const model *m,
                              const poles_options *given)
{
    RITZ_OWN(ritz_spectrum) found = {0};
    bool by_hertz = given->up_to_hz > 0.0;
    double limit = 2.0 * RITZ_PI * given->up_to_hz * (1.0 + 1e-9);
    ritz_span span = {.modes = given->modes > 0 ? given->modes : SOME_MODES};

    if (by_hertz)
        span = (ritz_span){.modes = -1, .up_to_hz = given->up_to_hz};
    RITZ_CHECK(ritz_spectrum_of(model_reference(m), &span, &found));
    while (m->kind != MODEL_COMPONENT && found.count > 0 &&
           ((given->modes > 0 && found.count > given->modes) ||
            (by_hertz && cabs(found.s[found.count - 1]) > limit)))
        found.count--;
    say_poles(run, &found, given->tsv);
    cli_record(run, "poles", found.count);
    return RITZ_OK;
}

/* The damping that poles are of. */
static void say_damping(cli_run *run, model *m)
{
    char text[RITZ_DAMPING_SIZE] = "";

    ritz_damping_print(&m->damping, text);
    cli_say(run, "%s:", run->operand[0]);
    describe_damping(run, m->kind == MODEL_STATES ? m->states.damping : text);
    if (m->kind != MODEL_STATES)
        describe_dampers(run, model_dampers(m));
}

ritz_status poles_report(cli_run *run, const poles_options *given)
{
    const char *path = run->operand[0];
    RITZ_OWN(model) m = {0};

    RITZ_CHECK(model_read(run, path, MODEL_DYNAMIC, &m));
    RITZ_REFUSE_IF(
        m.kind == MODEL_STATES && (given->model.damping || given->scan ||
                                   given->model.damper.count > 0),
        RITZ_ERR_ARGUMENT,
        "'%s' is a state space, damped as it is: --damping, --damper "
        "and --scan are not for it",
        path);
    RITZ_CHECK(model_settle(&m, path, &given->model));
    if (!given->tsv)
        say_damping(run, &m);
    RITZ_CHECK_IN(path, given->scan ? scan_dampers(run, &m, given)
                                    : find_poles(run, &m, given));
    return run->output ? cli_table_save(&run->said, run->output) : RITZ_OK;
}
