/* ritz-simulate --sweep: a joint turns while the system vibrates. The run has
   one of several bases, and may be compared with that of another one. */
#include "print/simulation.h"

#include "base/alloc.h"
#include "base/text.h"
#include "base/tolerances.h"

#include <ritz/swept.h>

#include <inttypes.h>

/* A basis of --sweep-basis. */
typedef struct sweep_basis {
    const char *name;
    bool cut;   /* it has some modes at each setting, not all */
    bool terms; /* the rates of the basis are included */
    bool one;   /* bodies are those of the second stage of COMPARE */
} sweep_basis;

static const sweep_basis bases[] = {
    {.name = "switched", .cut = true, .terms = true},
    {.name = "without-terms", .cut = true},
    {.name = "one", .terms = true, .one = true},
    {.name = "full", .terms = true},
};

static const sweep_basis *find_basis(const char *name)
{
    size_t k = 0;

    while (strcmp(bases[k].name, name) != 0)
        k++;
    return &bases[k];
}

bool simulation_sweep_asked(const simulation_options *given)
{
    return given->sweeps.count > 0;
}

/* Read the path after JOINT=. */
static ritz_status parse_path(const char *text, ritz_path *out)
{
    const char *equals = strchr(text, '=');

    RITZ_REFUSE_IF(!equals || equals == text, RITZ_ERR_ARGUMENT,
                   "'%s' is not JOINT=FROM:TO:TIME", text);
    return ritz_path_parse(equals + 1, out);
}

/* Refuse a setting of --at for the joint that moves. */
static void check_at(const cli_run *run, const char *sweep, const char *at)
{
    const size_t length = (size_t)(strchr(sweep, '=') - sweep) + 1;

    while (at) {
        const char *comma = strchr(at, ',');

        if (strncmp(at, sweep, length) == 0)
            cli_refuse(run->program,
                       "'%.*s' moves by --sweep, and --at sets it too",
                       (int)length - 1, sweep);
        at = comma ? comma + 1 : NULL;
    }
}

/* Refuse a number of modes, or their highest, that no basis of the run is cut
   to. */
static void check_modes(const cli_run *run, const simulation_options *given)
{
    const char *against = given->sweep_against;

    if ((given->sweep_modes > 0 || given->up_to_hz > 0.0) &&
        !find_basis(given->sweep_basis)->cut &&
        !(against && find_basis(against)->cut))
        cli_refuse(run->program, "--%s has no effect on a basis of all modes",
                   given->sweep_modes > 0 ? "sweep-modes" : "up-to-hz");
}

ritz_status simulation_sweep_prepare(cli_run *run, simulation_options *given)
{
    const char *at = given->model.at ? given->model.at : "";
    RITZ_OWN(ritz_path) path = {0};
    int length = 0;

    if (given->sweeps.count > 1)
        cli_refuse(run->program, "--sweep is given twice: one joint moves");
    if (given->sweeps.count > 0)
        given->sweep = given->sweeps.text[0];
    if (!given->sweep)
        return RITZ_OK;
    check_modes(run, given);
    RITZ_REFUSE_IF(ritz_container_seems(run->operand[0]), RITZ_ERR_ARGUMENT,
                   "'%s' is not a scene: joints of a scene move",
                   run->operand[0]);
    RITZ_CHECK(parse_path(given->sweep, &path));
    check_at(run, given->sweep, at);
    if (path.kind == RITZ_PATH_TABLE)
        RITZ_CHECK(cli_input(run, strchr(given->sweep, '=') + 1));
    length = snprintf(given->sweep_at, sizeof given->sweep_at, "%.*s=%.17g%s%s",
                      (int)(strchr(given->sweep, '=') - given->sweep),
                      given->sweep, path.from, *at ? "," : "", at);
    RITZ_REFUSE_IF(length < 0 || (size_t)length >= sizeof given->sweep_at,
                   RITZ_ERR_ARGUMENT, "'%s' is too long", given->sweep);
    given->model.at = given->sweep_at;
    if (given->seconds == 0.0)
        given->seconds = path.seconds;
    if (!cli_given(run, "method"))
        given->method = "trapezoidal"; /* the default of other runs */
    return RITZ_OK;
}

/* The sweep of the scene that --sweep names. */
static ritz_status find_joint(const simulation_task *d, int64_t *out)
{
    const char *text = d->given->sweep;
    char joint[RITZ_NAME_SIZE] = "";

    (void)snprintf(joint, sizeof joint, "%.*s", (int)(strchr(text, '=') - text),
                   text);
    return ritz_scene_sweep(&d->scene, joint, out);
}

ritz_status simulation_sweep_check(const simulation_task *d)
{
    int64_t sweep = 0;

    if (!d->given->sweep)
        return RITZ_OK;
    return ritz_context(find_joint(d, &sweep), "--sweep");
}

/* The sweep of the scene, and the range of its path. */
static ritz_status ask_range(const simulation_task *d, const ritz_path *path,
                             ritz_sweep_request *out)
{
    RITZ_CHECK(find_joint(d, &out->sweep));
    out->setting = d->setting;
    out->damping = d->subject.damping;
    ritz_path_range(path, out->range);
    return RITZ_OK;
}

/* The number of modes of a cut basis. */
static ritz_status ask_modes(const simulation_task *d, ritz_sweep_request *out)
{
    const simulation_options *given = d->given;

    out->modes = given->sweep_modes;
    if (out->modes == 0)
        out->up_to_hz =
            given->up_to_hz > 0.0 ? given->up_to_hz : d->scene.band_hz[1];
    RITZ_REFUSE_IF(
        out->modes == 0 && !(out->up_to_hz > 0.0), RITZ_ERR_ARGUMENT,
        "how many modes? give --sweep-modes, --up-to-hz, or a band in "
        "the scene");
    return RITZ_OK;
}

static ritz_status make_model(const simulation_task *d, const ritz_path *path,
                              const sweep_basis *basis, ritz_swept_model *out)
{
    ritz_sweep_request asked = {0};
    RITZ_OWN(ritz_comparison) comparison = {0};

    RITZ_CHECK(ask_range(d, path, &asked));
    if (basis->cut)
        RITZ_CHECK(ask_modes(d, &asked));
    if (!basis->one)
        return ritz_stage_sweep(&d->stage, &asked, out);
    RITZ_CHECK_IN("one basis", ritz_compare(&d->stage, &comparison));
    asked.origin = &d->stage;
    asked.V = comparison.V;
    return ritz_stage_sweep(&comparison.second, &asked, out);
}

/* The largest rate of the setting, in x per second. */
static double fastest_rate(const ritz_swept_model *m, const ritz_path *path)
{
    double fastest = 0.0;

    for (int k = 0; k <= 1000; k++) {
        double at[3];

        ritz_path_at(path, path->seconds * k / 1001.0, at);
        fastest = fmax(fastest, fabs(m->unit * at[1]));
    }
    return fastest;
}

/* Print how the joint moves, and how fast. */
static void say_path(const simulation_task *d, const ritz_swept_model *m,
                     const ritz_path *path, const char *unit)
{
    const bool turns = m->unit != 1.0;
    const double fastest = fastest_rate(m, path);
    const double lowest = 2.0 * RITZ_PI * m->start_hz[0];

    sink_field(d->run, "sweep", "sweep,from,to,,sweep_seconds",
               "%s from %g to %g %s in %g s", m->sweep, path->from, path->to,
               unit, path->seconds);
    if (!turns) {
        sink_field(d->run, "rate", "rate", "%.3g %s/s", fastest, unit);
        return;
    }
    if (lowest > 0.0)
        sink_field(d->run, "rate", "rate,rate_ratio",
                   "%.3g rad/s, %.3g times the lowest frequency", fastest,
                   fastest / lowest);
    if (lowest > 0.0 && fastest >= lowest)
        cli_warn(d->run,
                 "the joint turns at %.3g times the lowest frequency: the "
                 "forces that are left out grow with the square of this ratio",
                 fastest / lowest);
}

/* Print the size of the model, and the error of its interpolation; in the
   record only for the main run. */
static void say_basis(cli_run *run, bool main, const sweep_basis *basis,
                      const ritz_swept_model *m)
{
    sink_field(run, "basis", main ? "basis,modes,settings,,interpolation" : "",
               "%s: %" PRId64 " modes, computed at %" PRId64
               " settings of %s, interpolated to %.1e",
               basis->name, m->order, m->count, m->sweep, m->error);
}

/* Warn of what the basis leaves out of the initial state. */
static ritz_status say_lost_state(const simulation_task *d,
                                  const ritz_swept_model *m)
{
    ritz_swept_lost lost = {0};

    if (!d->x0)
        return RITZ_OK;
    RITZ_CHECK(ritz_swept_lost_state(m, d->x0, d->v0, &lost));
    sink_field(d->run, "left out",
               "lost_displacement,lost_strain,lost_velocity",
               "%.2g of the initial displacement, by mass, %.2g of its strain "
               "energy, %.2g of the velocity",
               lost.displacement, lost.strain, lost.velocity);
    if (!lost.all && fmax(lost.displacement, fmax(lost.strain, lost.velocity)) >
                         RITZ_SWEPT_LOST)
        cli_warn(d->run,
                 "the basis of %" PRId64 " modes leaves out %.3g %% of the "
                 "initial displacement, %.3g %% of its strain energy and %.3g "
                 "%% of the initial velocity: keep more --sweep-modes",
                 m->order, 100.0 * lost.displacement, 100.0 * lost.strain,
                 100.0 * lost.velocity);
    return RITZ_OK;
}

/* Warn of inputs that hardly act through the basis. */
static ritz_status say_lost_forces(const simulation_task *d,
                                   const ritz_swept_model *m)
{
    for (int64_t j = 0; j < m->io.num_inputs; j++) {
        double lost = 0.0;

        if (d->signal[j].kind == RITZ_SIGNAL_ZERO)
            continue;
        RITZ_CHECK(ritz_swept_lost_force(m, j, &lost));
        if (lost > RITZ_SWEPT_LOST_FORCE)
            cli_warn(d->run,
                     "the basis of %" PRId64 " modes leaves out %.3g %% of the "
                     "static response to '%s': keep more --sweep-modes",
                     m->order, 100.0 * lost, m->io.input[j]);
    }
    return RITZ_OK;
}

/* Print how the joint moves, and what the basis leaves out. */
static ritz_status say_start(const simulation_task *d, const ritz_path *path,
                             const sweep_basis *basis,
                             const ritz_swept_model *m)
{
    int64_t sweep = 0;
    char unit[RITZ_NAME_SIZE];

    RITZ_CHECK(find_joint(d, &sweep));
    settings_unit(&d->scene.sweep[sweep], d->m.system.units, unit);
    say_path(d, m, path, unit);
    if (basis->terms && m->G.val)
        RITZ_CHECK(spin_warn_of_loss(d->run, &d->stage, m->turns, "turning"));
    RITZ_CHECK(say_lost_state(d, m));
    return basis->cut ? say_lost_forces(d, m) : RITZ_OK;
}

/* Largest difference of the mechanical energy, relative to its largest
   value. */
static double compare_energies(const ritz_simulation *exact,
                               const ritz_simulation *other)
{
    double size = 0.0, off = 0.0;

    for (int64_t k = 0; k < exact->count; k++) {
        double right = exact->kinetic[k] + exact->potential[k];

        size = fmax(size, right);
        off = fmax(off, fabs(other->kinetic[k] + other->potential[k] - right));
    }
    return size > 0.0 ? off / size : 0.0;
}

static ritz_status run_basis(const simulation_task *d, bool main,
                             const ritz_path *path, const sweep_basis *basis,
                             const ritz_simulation_request *request,
                             ritz_simulation *out)
{
    RITZ_OWN(ritz_swept_model) made = {0};

    RITZ_CHECK(make_model(d, path, basis, &made));
    if (!request->from)
        say_basis(d->run, main, basis, &made);
    if (!request->from && main)
        RITZ_CHECK(say_start(d, path, basis, &made));
    RITZ_CHECK(ritz_simulate_swept(&made, path, basis->terms, request, out));
    return simulation_name_bodies(d, basis->terms ? made.turns : NULL, out);
}

/* Repeat the run with the other basis, and print how much they differ. */
static ritz_status compare_bases(simulation_task *d, const ritz_path *path,
                                 const ritz_simulation_request *request,
                                 const ritz_simulation *s)
{
    const sweep_basis *basis = find_basis(d->given->sweep_against);
    ritz_simulation_request again = *request;
    RITZ_OWN(ritz_simulation) other = {0};
    double response = 0.0;

    again.stop = NULL;
    again.from = NULL;
    again.coordinates = false;
    RITZ_CHECK(run_basis(d, false, path, basis, &again, &other));
    RITZ_CHECK(ritz_simulation_difference(&other, s, &response));
    sink_field(d->run, "against", "against,response_error,energy_error",
               "%s: outputs off by %.2e of their largest, energy by %.2e",
               basis->name, response, compare_energies(&other, s));
    return RITZ_OK;
}

/* Warn of rigid motions: they have no frequency compared with which the
   rate of the joint is small. */
static void warn_of_rigid(const simulation_task *d)
{
    const int64_t count = d->m.system.configuration[0].num_rigid;

    if (count > 0)
        cli_warn(
            d->run,
            "%" PRId64 " rigid motions: forces of the commanded motion "
            "that turn with the bodies are left out, so that the error of "
            "rigid motions is about the square of the angle in radians, and "
            "grows exponentially over whole turns",
            count);
}

ritz_status simulation_sweep(simulation_task *d,
                             const ritz_simulation_request *request,
                             ritz_simulation *out)
{
    RITZ_OWN(ritz_path) path = {0};
    RITZ_OWN(ritz_simulation) s = {0};

    RITZ_CHECK(parse_path(d->given->sweep, &path));
    RITZ_CHECK(run_basis(d, true, &path, find_basis(d->given->sweep_basis),
                         request, &s));
    if (d->subject.damping)
        ritz_damping_print(d->subject.damping, s.damping);
    if (s.num_state == 0)
        warn_of_rigid(d);
    if (d->given->sweep_against && s.num_state == 0)
        RITZ_CHECK(compare_bases(d, &path, request, &s));
    RITZ_MOVE(*out, s);
    return RITZ_OK;
}
