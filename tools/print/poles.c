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

/* Whether a pole belongs to an interface force: such poles grow without
   oscillation, and at most @p squares poles grow at all. */
static bool is_force(const ritz_spectrum *spectrum, int64_t squares, int64_t j)
{
    int64_t growing = 0;

    for (int64_t k = 0; squares > 0 && k < spectrum->count; k++)
        growing += creal(spectrum->s[k]) > neutral * cabs(spectrum->s[k]);
    return growing > 0 && growing <= squares && cimag(spectrum->s[j]) == 0.0 &&
           creal(spectrum->s[j]) > 0.0;
}

static const char *note_of(const ritz_spectrum *spectrum, int64_t squares,
                           int64_t j)
{
    double _Complex s = spectrum->s[j];

    if (is_force(spectrum, squares, j))
        return "unstable: negative square of a force";
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

/* Warn of all poles of interface forces in one line. */
static void warn_of_forces(cli_run *run, const ritz_spectrum *spectrum,
                           int64_t squares)
{
    int64_t count = 0;
    double slowest = HUGE_VAL, fastest = 0.0;

    for (int64_t j = 0; j < spectrum->count; j++)
        if (is_force(spectrum, squares, j)) {
            count++;
            slowest = fmin(slowest, creal(spectrum->s[j]));
            fastest = fmax(fastest, creal(spectrum->s[j]));
        }
    if (count > 0)
        cli_warn(
            run,
            "%ld poles are negative squares of the forces that join bodies "
            "of dual-craig-bampton, and of no motion of these: they grow "
            "by %.3g to %.3g/s; macneal-rubin has the same columns",
            count, slowest, fastest);
}

static void warn_poles(cli_run *run, const ritz_spectrum *spectrum,
                       int64_t squares)
{
    int64_t rough = 0;

    warn_of_forces(run, spectrum, squares);

    for (int64_t j = 0; j < spectrum->count; j++) {
        double _Complex s = spectrum->s[j];

        if (creal(s) > neutral * cabs(s) && !is_force(spectrum, squares, j))
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
static void say_poles(cli_run *run, const ritz_spectrum *spectrum,
                      int64_t squares, bool tsv)
{
    if (tsv)
        cli_say(run, "mode\thertz\trad_per_s\tzeta\treal\timaginary\tresidual");
    else
        cli_say(run, "%5s %13s %13s %12s %13s %13s %9s", "", "|s|/2pi Hz",
                "|s| rad/s", "zeta %", "Re s", "Im s", "residual");
    SINK_ITEMS(run, "poles", j, spectrum->count) {
        double _Complex s = spectrum->s[j];
        double zeta = ritz_spectrum_ratio(s);
        const char *note = note_of(spectrum, squares, j);

        set_pole(run, s);
        sink_set(run, "residual", "%g", spectrum->residual[j]);
        if (tsv)
            cli_say(run, "%ld\t%.12g\t%.12g\t%.12g\t%.12g\t%.12g\t%.3e", j + 1,
                    hertz_of(s), cabs(s), zeta, creal(s), cimag(s),
                    spectrum->residual[j]);
        else
            cli_say(run, "%5ld %13.7g %13.7g %12.6g %13.6g %13.7g %9.1e%s%s",
                    j + 1, hertz_of(s), cabs(s), 100.0 * zeta, creal(s),
                    cimag(s), spectrum->residual[j], *note ? "  " : "", note);
    }
    sink_set(run, "zero,engine", "%ld %s", spectrum->num_zero,
             spectrum->engine);
    if (spectrum->num_zero > 0 && !tsv)
        cli_say(run, "%ld poles at 0 are not listed: rigid-body motion",
                spectrum->num_zero);
    warn_poles(run, spectrum, squares);
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
    RITZ_REFUSE_IF(!isnan(given->near_hz) && m->kind != MODEL_STATES,
                   RITZ_ERR_ARGUMENT, "--near-hz is for state spaces");
    RITZ_CHECK(isnan(given->near_hz)
                   ? ritz_spectrum_of(model_reference(m), &span, &found)
                   : ritz_spectrum_near(&m->states, given->near_hz, span.modes,
                                        &found));
    while (m->kind != MODEL_COMPONENT && found.count > 0 &&
           ((given->modes > 0 && found.count > given->modes) ||
            (by_hertz && cabs(found.s[found.count - 1]) > limit)))
        found.count--;
    say_poles(run, &found, model_negative_squares(m->at, NULL), given->tsv);
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
        m.kind == MODEL_STATES &&
            (given->model.damping || given->scan.count > 0 ||
             given->tune.count > 0 || given->model.damper.count > 0),
        RITZ_ERR_ARGUMENT,
        "'%s' is a state space, damped as it is: --damping, --damper, --scan "
        "and --tune are not for it",
        path);
    RITZ_CHECK(model_settle(&m, path, &given->model));
    if (!given->tsv)
        say_damping(run, &m);
    RITZ_CHECK_IN(path, given->scan.count > 0   ? dampers_scan(run, &m, given)
                        : given->tune.count > 0 ? dampers_tune(run, &m, given)
                        : given->norm           ? dampers_norm(run, &m, given)
                                                : find_poles(run, &m, given));
    return run->output ? cli_table_save(&run->said, run->output) : RITZ_OK;
}
