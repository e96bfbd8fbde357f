/* Which signals of a plant and of a controller are connected. */
#include "base/alloc.h"

#include "base/text.h"
#include "base/tolerances.h"
#include "linear/search.h"
#include "response/responder.h"

#include <ritz/response.h>

#include <complex.h>
#include <inttypes.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

ritz_status ritz_loop_check(const ritz_loop *loop, const ritz_io *plant,
                            const ritz_io *controller)
{
    RITZ_REFUSE_IF(loop->num_measured != controller->num_inputs ||
                       loop->num_driven != controller->num_outputs,
                   RITZ_ERR_ARGUMENT,
                   "a loop of %" PRId64 " measured and %" PRId64
                   " driven signals is not of this controller",
                   loop->num_measured, loop->num_driven);
    for (int64_t k = 0; k < loop->num_measured; k++)
        RITZ_REFUSE_IF(loop->measured[k] < 0 ||
                           loop->measured[k] >= plant->num_outputs,
                       RITZ_ERR_ARGUMENT, "the plant has no output %" PRId64,
                       loop->measured[k] + 1);
    for (int64_t k = 0; k < loop->num_driven; k++)
        RITZ_REFUSE_IF(loop->driven[k] < 0 ||
                           loop->driven[k] >= plant->num_inputs,
                       RITZ_ERR_ARGUMENT, "the plant has no input %" PRId64,
                       loop->driven[k] + 1);
    return RITZ_OK;
}

static const char give_names[] =
    "name the signals of one of them otherwise: --input-names and "
    "--output-names of ritz-import, |OUT/IN| in the head of a table";

/* Connect a signal, which is possible once only. */
static ritz_status connect_signal(int64_t *place, int64_t index,
                                  const char *name)
{
    RITZ_REFUSE_IF(*place >= 0, RITZ_ERR_ARGUMENT,
                   "'%s' of the controller is connected twice", name);
    *place = index;
    return RITZ_OK;
}

/* Whether signals have the names that they get where nobody names them. */
static bool is_unnamed(const ritz_io *io)
{
    return io->num_inputs > 0 && io->num_outputs > 0 &&
           strcmp(io->input[0], "u1") == 0 && strcmp(io->output[0], "y1") == 0;
}

static bool is_single(const ritz_io *io)
{
    return io->num_inputs == 1 && io->num_outputs == 1;
}

/* Whether there is one way to join both, and no names that say otherwise. */
static bool is_obvious(const ritz_io *plant, const ritz_io *controller)
{
    return is_single(plant) && is_single(controller) &&
           (is_unnamed(plant) || is_unnamed(controller));
}

/*
 * "OUT=IN", from plant to controller or from controller to plant, whichever has
 * such names.
 */
static ritz_status connect_pair(const ritz_io *plant, const ritz_io *control,
                                const char *pair, ritz_loop *loop)
{
    const char *equals = strchr(pair, '=');
    const char *in = equals ? equals + 1 : "";
    char out[RITZ_NAME_SIZE] = "";
    int64_t from = -1, to = -1, back_from = -1, back_to = -1;
    bool both = false;

    RITZ_REFUSE_IF(
        !equals || equals == pair || !*in || equals - pair >= RITZ_NAME_SIZE,
        RITZ_ERR_ARGUMENT, "'%.80s' is not of the form OUT=IN", pair);
    memcpy(out, pair, (size_t)(equals - pair));
    from = ritz_name_index(plant->num_outputs, plant->output, out);
    to = ritz_name_index(control->num_inputs, control->input, in);
    back_from = ritz_name_index(control->num_outputs, control->output, out);
    back_to = ritz_name_index(plant->num_inputs, plant->input, in);
    both = from >= 0 && to >= 0 && back_from >= 0 && back_to >= 0;
    if (both && is_obvious(plant, control)) {
        loop->measured[0] = loop->driven[0] = 0;
        return RITZ_OK;
    }
    RITZ_REFUSE_IF(both, RITZ_ERR_ARGUMENT,
                   "'%s' can be read both ways: plant and controller have both "
                   "names; %s",
                   pair, give_names);
    if (from >= 0 && to >= 0)
        return connect_signal(&loop->measured[to], from, control->input[to]);
    if (back_from >= 0 && back_to >= 0)
        return connect_signal(&loop->driven[back_from], back_to,
                              control->output[back_from]);
    return ritz_fail(
        RITZ_ERR_ARGUMENT,
        "'%s' joins no output of the plant to an input of the controller, "
        "nor one of the controller to one of the plant",
        pair);
}

/* Connect the signals that no pair names by equal names. */
static ritz_status connect_equal_names(int64_t count,
                                       char (*name)[RITZ_NAME_SIZE],
                                       int64_t others,
                                       char (*other)[RITZ_NAME_SIZE],
                                       const char *what, int64_t *place)
{
    const char *near = NULL;

    for (int64_t k = 0; k < count; k++) {
        if (place[k] >= 0)
            continue;
        place[k] = ritz_name_index(others, other, name[k]);
        if (place[k] >= 0)
            continue;
        near = others > 0 ? ritz_text_nearest(name[k], others, other[0],
                                              RITZ_NAME_SIZE)
                          : NULL;
        return ritz_fail(RITZ_ERR_ARGUMENT,
                         "the plant has no %s '%s' for the controller%s%s%s",
                         what, name[k], near ? ", is '" : "", near ? near : "",
                         near ? "' meant?" : "");
    }
    return RITZ_OK;
}

ritz_status ritz_loop_match(const ritz_io *plant, const ritz_io *controller,
                            int64_t num_pairs, const char *const *pair,
                            ritz_loop *out)
{
    RITZ_OWN(ritz_loop)
    loop = {.num_measured = controller->num_inputs,
            .num_driven = controller->num_outputs};

    RITZ_REFUSE_IF(loop.num_measured == 0 || loop.num_driven == 0,
                   RITZ_ERR_ARGUMENT, "the controller has no %s: it is none",
                   loop.num_measured == 0 ? "inputs" : "outputs");
    RITZ_CHECK_NEW(loop.measured, loop.num_measured);
    RITZ_CHECK_NEW(loop.driven, loop.num_driven);
    for (int64_t k = 0; k < loop.num_measured; k++)
        loop.measured[k] = -1;
    for (int64_t k = 0; k < loop.num_driven; k++)
        loop.driven[k] = -1;
    if (num_pairs == 0 && is_obvious(plant, controller))
        loop.measured[0] = loop.driven[0] = 0;
    for (int64_t k = 0; k < num_pairs; k++)
        RITZ_CHECK(connect_pair(plant, controller, pair[k], &loop));
    RITZ_REFUSE_IF(num_pairs == 0 && is_unnamed(plant) &&
                       is_unnamed(controller) && !is_obvious(plant, controller),
                   RITZ_ERR_ARGUMENT,
                   "which signals of plant and controller are joined is not "
                   "known, both are u1, ... and y1, ...; %s, and --connect "
                   "OUT=IN joins them",
                   give_names);
    RITZ_CHECK(connect_equal_names(loop.num_measured, controller->input,
                                   plant->num_outputs, plant->output, "output",
                                   loop.measured));
    RITZ_CHECK(connect_equal_names(loop.num_driven, controller->output,
                                   plant->num_inputs, plant->input, "input",
                                   loop.driven));
    RITZ_MOVE(*out, loop);
    return RITZ_OK;
}

void ritz_loop_free(ritz_loop *loop)
{
    RITZ_FREE(loop->measured, loop->driven);
    *loop = (ritz_loop){0};
}

/*
 * Margins of a loop: for L = F G of one signal, the gain factors -1 / L where L
 * is real and negative, and the angle from L to -1 where |L| = 1; for any loop
 * the largest |L| and the largest |(I + L)^-1|.
 */

enum { MOST_HALVES = 60 };

/* A plant and a controller that respond. */
typedef struct respondents {
    const ritz_loop *loop;
    ritz_responder *plant, *controller;
    double _Complex *G, *F; /* of both, to work in */
} respondents;

static ritz_status respondents_new(const ritz_loop *loop, ritz_responder *plant,
                                   ritz_responder *controller, respondents *out)
{
    const ritz_io *io = &plant->poles->io;

    out->loop = loop;
    out->plant = plant;
    out->controller = controller;
    RITZ_CHECK_NEW(out->G, io->num_outputs * io->num_inputs);
    RITZ_CHECK_NEW(out->F, loop->num_driven * loop->num_measured);
    return RITZ_OK;
}

static void respondents_free(respondents *s)
{
    RITZ_FREE(s->G, s->F);
}

/* @param[out] H  of the closed loop; NULL: not wanted */
static ritz_status evaluate_loop(respondents *s, double hertz,
                                 double _Complex *H, ritz_loop_values *values)
{
    const ritz_io *io = &s->plant->poles->io;

    RITZ_CHECK_IN("plant", ritz_responder_at(s->plant, hertz, s->G));
    RITZ_CHECK_IN("controller", ritz_responder_at(s->controller, hertz, s->F));
    return ritz_loop_at(s->loop, io->num_outputs, io->num_inputs, s->G, s->F, H,
                        values);
}

typedef enum which { GAIN, SENSITIVITY } which;

typedef struct prober {
    respondents of;
    which want;
    double *largest, *sensitivity; /* at the points */
    double _Complex *gain;
} prober;

static void prober_free(prober *s)
{
    respondents_free(&s->of);
    RITZ_FREE(s->largest, s->sensitivity, s->gain);
}

static ritz_status evaluate_size(void *state, double hertz, double *value)
{
    prober *s = state;
    ritz_loop_values values = {0};

    RITZ_CHECK(evaluate_loop(&s->of, hertz, NULL, &values));
    *value = s->want == GAIN ? values.largest_gain : values.sensitivity;
    return RITZ_OK;
}

static double size_crossing(double _Complex L)
{
    return cabs(L) - 1.0;
}

static ritz_status bisect_crossing(prober *s, double (*zero)(double _Complex),
                                   double low, double high,
                                   double _Complex at_low, double *hertz,
                                   double _Complex *L)
{
    ritz_loop_values values = {.gain = at_low};
    double middle = low;

    for (int k = 0; k < MOST_HALVES && high - low > RITZ_BISECTION_END * high;
         k++) {
        middle = low + (high - low) / 2.0;
        RITZ_CHECK(evaluate_loop(&s->of, middle, NULL, &values));
        if (zero(values.gain) * zero(at_low) > 0.0)
            low = middle;
        else
            high = middle;
    }
    *hertz = middle;
    *L = values.gain;
    return RITZ_OK;
}

static void update_gain_margin(double hertz, double _Complex L,
                               ritz_margins *out)
{
    double factor = -1.0 / creal(L);

    if (!(creal(L) < 0.0) ||
        fabs(cimag(L)) > RITZ_REAL_CROSSING * fabs(creal(L)))
        return;
    if (factor >= 1.0 && !(factor >= out->gain_up)) {
        out->gain_up = factor;
        out->gain_up_hz = hertz;
    }
    if (factor <= 1.0 && !(factor <= out->gain_down)) {
        out->gain_down = factor;
        out->gain_down_hz = hertz;
    }
}

static void update_phase_margin(double hertz, double _Complex L,
                                ritz_margins *out)
{
    double angle = fabs(carg(-L)) * 180.0 / RITZ_PI;

    if (fabs(cabs(L) - 1.0) > RITZ_REAL_CROSSING || angle >= out->phase)
        return;
    out->phase = angle;
    out->phase_hz = hertz;
}

/* The closed loop as a responder. */
typedef struct closed {
    respondents of;
    ritz_poles poles; /* of all three, and the names */
} closed;

static ritz_status closed_at(void *state, double hertz, double _Complex *H)
{
    closed *s = state;
    ritz_loop_values values = {0};

    return evaluate_loop(&s->of, hertz, H, &values);
}

static ritz_status find_crossings(prober *s, int64_t count, const double *hertz,
                                  ritz_margins *out)
{
    /* gain margins are at zeros of Im L, phase margins at those of |L| - 1 */
    static const struct {
        double (*zero)(double _Complex L);
        void (*update)(double hertz, double _Complex L, ritz_margins *out);
    } kinds[] = {{cimag, update_gain_margin},
                 {size_crossing, update_phase_margin}};
    double at = 0.0;
    double _Complex L = 0.0;

    for (int64_t k = 0; k + 1 < count; k++)
        for (int t = 0; t < 2; t++) {
            double _Complex a = s->gain[k], b = s->gain[k + 1];

            if (!(kinds[t].zero(a) * kinds[t].zero(b) < 0.0))
                continue;
            RITZ_CHECK(bisect_crossing(s, kinds[t].zero, hertz[k], hertz[k + 1],
                                       a, &at, &L));
            kinds[t].update(at, L, out);
        }
    return RITZ_OK;
}

static ritz_status find_peaks(prober *s, int64_t count, const double *hertz,
                              ritz_margins *out)
{
    const ritz_curve curve = {evaluate_size, s};

    s->want = GAIN;
    RITZ_CHECK(ritz_curve_peak(count, hertz, s->largest, &curve, &out->gain_hz,
                               &out->gain));
    s->want = SENSITIVITY;
    return ritz_curve_peak(count, hertz, s->sensitivity, &curve,
                           &out->sensitivity_hz, &out->sensitivity);
}

ritz_status ritz_loop_margins(const ritz_loop *loop, ritz_responder *plant,
                              ritz_responder *controller, int64_t count,
                              const double *hertz, ritz_margins *out)
{
    const double none = nan("");
    ritz_margins m = {none, none, none, none, HUGE_VAL,
                      none, none, none, none, none};
    RITZ_OWN(prober) s = {0};

    RITZ_CHECK(respondents_new(loop, plant, controller, &s.of));
    RITZ_CHECK_NEW(s.largest, count);
    RITZ_CHECK_NEW(s.sensitivity, count);
    RITZ_CHECK_NEW(s.gain, count);
    for (int64_t k = 0; k < count; k++) {
        ritz_loop_values values = {0};

        RITZ_CHECK(evaluate_loop(&s.of, hertz[k], NULL, &values));
        s.gain[k] = values.gain;
        s.largest[k] = values.largest_gain;
        s.sensitivity[k] = values.sensitivity;
    }
    if (count > 0)
        RITZ_CHECK(find_peaks(&s, count, hertz, &m));
    if (loop->num_driven == 1 && loop->num_measured == 1)
        RITZ_CHECK(find_crossings(&s, count, hertz, &m));
    if (isinf(m.phase))
        m.phase = none;
    *out = m;
    return RITZ_OK;
}

/*
 * A loop closed in frequency. With G_yu from the inputs that the controller
 * drives to the outputs that it measures, L = F G_yu (its sign turned by
 * positive feedback), and F_u, F_y wider by rows and columns of zeros,
 *
 *     y = G w + G_u v',   v' = -F e,   e = G_y w + G_yu v',
 *
 *     H = G - G_u (I + L)^-1 F G_y
 *
 * which solves only a system of the size of the loop's signals [Sirlin1992].
 */

/* (F S_y G)(i, j) with the sign of negative feedback. */
static double _Complex filter_entry(const ritz_loop *loop, int64_t inputs,
                                    const double _Complex *G,
                                    const double _Complex *F, int64_t i,
                                    int64_t j)
{
    int64_t m = loop->num_measured;
    double _Complex sum = 0.0;

    for (int64_t k = 0; k < m; k++)
        sum += F[i * m + k] * G[loop->measured[k] * inputs + j];
    return loop->positive ? -sum : sum;
}

ritz_status ritz_loop_at(const ritz_loop *loop, int64_t num_outputs,
                         int64_t num_inputs, const double _Complex *G,
                         const double _Complex *F, double _Complex *H,
                         ritz_loop_values *values)
{
    int64_t q = num_inputs, c = loop->num_driven;
    RITZ_OWN_ARRAY double _Complex *L = NULL; /* c x c, then I + L */
    RITZ_OWN_ARRAY double _Complex *X = NULL; /* c x (q + c): F G_y and I, then
                                                 (I + L)^-1 times them */
    RITZ_OWN_ARRAY double *sigma = NULL;
    RITZ_OWN_ARRAY lapack_int *pivot = NULL;
    int info = 0;

    RITZ_CHECK_NEW(L, c * c);
    RITZ_CHECK_NEW(X, c * (q + c));
    RITZ_CHECK_NEW(sigma, c);
    RITZ_CHECK_NEW(pivot, c);
    for (int64_t i = 0; i < c; i++) {
        for (int64_t j = 0; j < q; j++)
            X[i + j * c] = filter_entry(loop, q, G, F, i, j);
        for (int64_t j = 0; j < c; j++)
            L[i + j * c] = X[i + loop->driven[j] * c];
        X[i + (q + i) * c] = 1.0;
    }
    values->gain = c == 1 && loop->num_measured == 1
                       ? L[0]
                       : ritz_complex(nan(""), nan(""));
    RITZ_CHECK(ritz_singular_values(c, c, L, NULL, sigma));
    values->largest_gain = sigma[0];
    for (int64_t i = 0; i < c; i++)
        L[i + i * c] += 1.0;
    info = LAPACKE_zgesv(LAPACK_COL_MAJOR, (int)c, (int)(q + c), L, (int)c,
                         pivot, X, (int)c);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_SINGULAR,
                   "the closed loop has a pole there: I + F G is singular");
    RITZ_CHECK(ritz_singular_values(c, c, X + q * c, NULL, sigma));
    values->sensitivity = sigma[0];
    for (int64_t i = 0; H && i < num_outputs; i++)
        for (int64_t j = 0; j < q; j++) {
            double _Complex sum = G[i * q + j];

            for (int64_t k = 0; k < c; k++)
                sum -= G[i * q + loop->driven[k]] * X[k + j * c];
            H[i * q + j] = sum;
        }
    return RITZ_OK;
}

static void free_closed(void *state)
{
    closed *s = state;

    ritz_poles_free(&s->poles);
    respondents_free(&s->of);
}

/*
 * Append the poles on or above the axis, as s^2 + rate s + lambda. Undamped
 * poles of the open loops are not poles of the closed one.
 */
static void add_poles(int64_t count, const double _Complex *pole,
                      ritz_poles *out)
{
    for (int64_t k = 0; k < count; k++) {
        if (cimag(pole[k]) < 0.0)
            continue;
        out->lambda[out->count] =
            creal(pole[k]) * creal(pole[k]) + cimag(pole[k]) * cimag(pole[k]);
        out->rate[out->count++] = fabs(2.0 * creal(pole[k]));
    }
}

static ritz_status list_open_poles(const ritz_responder *of, int64_t *count,
                                   double _Complex **out)
{
    const ritz_poles *p = of->poles;
    double _Complex *s = NULL;
    int64_t n = 0;

    if (p->coupled)
        return ritz_responder_poles(of, count, out);
    RITZ_CHECK_NEW(s, p->count);
    for (int64_t k = 0; k < p->count; k++) {
        double half = 0.5 * p->rate[k];

        if (p->rate[k] > 0.0)
            s[n++] = ritz_complex(-half,
                                  sqrt(fmax(p->lambda[k] - half * half, 0.0)));
    }
    *count = n;
    *out = s;
    return RITZ_OK;
}

static ritz_status gather_ends(closed *s, int64_t num_poles,
                               const double _Complex *pole)
{
    RITZ_OWN_ARRAY double _Complex *plant = NULL, *controller = NULL;
    int64_t n = 0, m = 0;

    RITZ_CHECK(list_open_poles(s->of.plant, &n, &plant));
    RITZ_CHECK(list_open_poles(s->of.controller, &m, &controller));
    RITZ_CHECK_NEW(s->poles.lambda, num_poles + n + m);
    RITZ_CHECK_NEW(s->poles.rate, num_poles + n + m);
    add_poles(num_poles, pole, &s->poles);
    add_poles(n, plant, &s->poles);
    add_poles(m, controller, &s->poles);
    return ritz_poles_name(&s->of.plant->poles->io, &s->poles);
}

static const ritz_response_engine closed_loop_engine = {
    .name = "closed loop",
    .summary = "a plant and a controller, closed at each frequency",
    .reference = "Sirlin1992",
};

ritz_status ritz_loop_responder(const ritz_loop *loop, ritz_responder *plant,
                                ritz_responder *controller, int64_t num_poles,
                                const double _Complex *pole,
                                ritz_responder **out)
{
    RITZ_OWN(ritz_responder) *r = NULL;
    closed *s = NULL;

    RITZ_CHECK(
        ritz_loop_check(loop, &plant->poles->io, &controller->poles->io));
    RITZ_CHECK_NEW(r, 1);
    RITZ_CHECK_NEW(s, 1);
    r->state = s;
    r->free = free_closed;
    RITZ_CHECK(respondents_new(loop, plant, controller, &s->of));
    RITZ_CHECK(gather_ends(s, num_poles, pole));
    r->engine = &closed_loop_engine;
    r->poles = &s->poles;
    r->from_hz = fmax(plant->from_hz, controller->from_hz);
    r->to_hz = fmin(plant->to_hz, controller->to_hz);
    memcpy(r->damping, plant->damping, sizeof r->damping);
    r->at = closed_at;
    RITZ_MOVE(*out, r);
    return RITZ_OK;
}
