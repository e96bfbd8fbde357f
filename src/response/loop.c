/*
 * A loop closed in frequency. With G_yu what the controller sees of what it
 * drives, L = F G_yu (its sign turned by positive feedback), and F_u, F_y wider
 * by rows and columns of zeros,
 *
 *     y = G w + G_u v',   v' = -F e,   e = G_y w + G_yu v',
 *
 *     H = G - G_u (I + L)^-1 F G_y
 *
 * which costs no more than the signals of the loop do [Sirlin1992].
 */
#include "base/alloc.h"
#include "poles/curve.h"
#include "response/responder.h"

#include <ritz/closed_loop.h>
#include <ritz/singular.h>

#include <inttypes.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Matrices of one frequency, by columns; c signals are driven, m measured. */
typedef struct room {
    int64_t c, m, p, q; /* outputs and inputs of the plant */
    double _Complex *L; /* c x c, then I + L */
    double _Complex *X; /* c x (q + c), F G_y and I, then S times them */
    double *sigma;      /* c */
    lapack_int *pivot;
} room;

static void discard(room *r)
{
    free(r->L);
    free(r->X);
    free(r->sigma);
    free(r->pivot);
}

static ritz_status make_room(const ritz_loop *loop, int64_t p, int64_t q,
                             room *r)
{
    *r = (room){.c = loop->num_driven, .m = loop->num_measured, .p = p, .q = q};
    RITZ_CHECK_NEW(r->L, r->c * r->c);
    RITZ_CHECK_NEW(r->X, r->c * (q + r->c));
    RITZ_CHECK_NEW(r->sigma, r->c);
    RITZ_CHECK_NEW(r->pivot, r->c);
    return RITZ_OK;
}

/* (F S_y G)(i, j) with the sign of negative feedback. */
static double _Complex around(const ritz_loop *loop, const room *r,
                              const double _Complex *G,
                              const double _Complex *F, int64_t i, int64_t j)
{
    double _Complex sum = 0.0;

    for (int64_t k = 0; k < r->m; k++)
        sum += F[i * r->m + k] * G[loop->measured[k] * r->q + j];
    return loop->positive ? -sum : sum;
}

static ritz_status measure_gain(room *r, ritz_loop_values *values)
{
    values->gain =
        r->c == 1 && r->m == 1 ? r->L[0] : ritz_complex(nan(""), nan(""));
    RITZ_CHECK(ritz_singular_values(r->c, r->c, r->L, NULL, r->sigma));
    values->largest_gain = r->sigma[0];
    return RITZ_OK;
}

ritz_status ritz_loop_at(const ritz_loop *loop, int64_t num_outputs,
                         int64_t num_inputs, const double _Complex *G,
                         const double _Complex *F, double _Complex *H,
                         ritz_loop_values *values)
{
    ritz_status status = RITZ_OK;
    int64_t q = num_inputs;
    room r = {0};
    int info = 0;

    RITZ_TRY(make_room(loop, num_outputs, num_inputs, &r));
    for (int64_t i = 0; i < r.c; i++) {
        for (int64_t j = 0; j < q; j++)
            r.X[i + j * r.c] = around(loop, &r, G, F, i, j);
        for (int64_t j = 0; j < r.c; j++)
            r.L[i + j * r.c] = r.X[i + loop->driven[j] * r.c];
        r.X[i + (q + i) * r.c] = 1.0;
    }
    RITZ_TRY(measure_gain(&r, values));
    for (int64_t i = 0; i < r.c; i++)
        r.L[i + i * r.c] += 1.0;
    info = LAPACKE_zgesv(LAPACK_COL_MAJOR, (int)r.c, (int)(q + r.c), r.L,
                         (int)r.c, r.pivot, r.X, (int)r.c);
    RITZ_FAIL_IF(info != 0, RITZ_ERR_SINGULAR,
                 "the closed loop has a pole there: I + F G is singular");
    RITZ_TRY(ritz_singular_values(r.c, r.c, r.X + q * r.c, NULL, r.sigma));
    values->sensitivity = r.sigma[0];
    for (int64_t i = 0; H && i < num_outputs; i++)
        for (int64_t j = 0; j < q; j++) {
            double _Complex sum = G[i * q + j];

            for (int64_t k = 0; k < r.c; k++)
                sum -= G[i * q + loop->driven[k]] * r.X[k + j * r.c];
            H[i * q + j] = sum;
        }
done:
    discard(&r);
    return status;
}

/* The closed loop that responds. */
typedef struct closed {
    const ritz_loop *loop;
    ritz_responder *plant, *controller;
    ritz_poles poles; /* of all three, and the names */
    double _Complex *G, *F;
} closed;

static void free_closed(void *state)
{
    closed *s = state;

    ritz_poles_free(&s->poles);
    free(s->G);
    free(s->F);
    free(s);
}

static ritz_status at(void *state, double hertz, double _Complex *H)
{
    closed *s = state;
    const ritz_io *io = &s->poles.io;
    ritz_loop_values values = {0};

    RITZ_CHECK_IN("plant", ritz_responder_at(s->plant, hertz, s->G));
    RITZ_CHECK_IN("controller", ritz_responder_at(s->controller, hertz, s->F));
    return ritz_loop_at(s->loop, io->num_outputs, io->num_inputs, s->G, s->F, H,
                        &values);
}

/* Poles above the axis or on it, as s^2 + rate s + lambda; those of the open
   loop that nothing damps are none of the closed one. */
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

static ritz_status open_poles(const ritz_responder *of, int64_t *count,
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

/* Every pole is driven and seen, as far as is known. */
static ritz_status name_ends(const ritz_io *io, ritz_poles *poles)
{
    int64_t n = poles->count;

    RITZ_CHECK(ritz_io_new(n, io->num_inputs, io->num_outputs, &poles->io));
    memcpy(poles->io.input, io->input,
           (size_t)io->num_inputs * sizeof *io->input);
    memcpy(poles->io.output, io->output,
           (size_t)io->num_outputs * sizeof *io->output);
    for (int64_t k = 0; k < n * io->num_inputs; k++)
        poles->io.B.val[k] = 1.0;
    for (int64_t k = 0; k < n * io->num_outputs; k++)
        poles->io.C.val[k] = 1.0;
    return RITZ_OK;
}

static ritz_status gather(closed *s, int64_t num_poles,
                          const double _Complex *pole)
{
    ritz_status status = RITZ_OK;
    double _Complex *plant = NULL, *controller = NULL;
    int64_t n = 0, m = 0;

    RITZ_TRY(open_poles(s->plant, &n, &plant));
    RITZ_TRY(open_poles(s->controller, &m, &controller));
    RITZ_NEW(s->poles.lambda, num_poles + n + m);
    RITZ_NEW(s->poles.rate, num_poles + n + m);
    add_poles(num_poles, pole, &s->poles);
    add_poles(n, plant, &s->poles);
    add_poles(m, controller, &s->poles);
    RITZ_TRY(name_ends(&s->plant->poles->io, &s->poles));
done:
    free(plant);
    free(controller);
    return status;
}

static const ritz_response_engine engine = {
    .name = "closed loop",
    .summary = "a plant and a controller, closed at each frequency",
    .reference = "Sirlin1992",
};

ritz_status ritz_loop_responder(const ritz_loop *loop, ritz_responder *plant,
                                ritz_responder *controller, int64_t num_poles,
                                const double _Complex *pole,
                                ritz_responder **out)
{
    ritz_status status = RITZ_OK;
    const ritz_io *io = &plant->poles->io;
    const ritz_io *other = &controller->poles->io;
    ritz_responder *r = NULL;
    closed *s = NULL;

    RITZ_TRY(ritz_loop_check(
        loop, &(ritz_ends){io->num_inputs, io->num_outputs, NULL, NULL},
        &(ritz_ends){other->num_inputs, other->num_outputs, NULL, NULL}));
    RITZ_NEW(r, 1);
    RITZ_NEW(s, 1);
    r->state = s;
    r->free = free_closed;
    s->loop = loop;
    s->plant = plant;
    s->controller = controller;
    RITZ_NEW(s->G, io->num_outputs * io->num_inputs);
    RITZ_NEW(s->F, loop->num_driven * loop->num_measured);
    RITZ_TRY(gather(s, num_poles, pole));
    r->engine = &engine;
    r->poles = &s->poles;
    r->from_hz = fmax(plant->from_hz, controller->from_hz);
    r->to_hz = fmin(plant->to_hz, controller->to_hz);
    memcpy(r->damping, plant->damping, sizeof r->damping);
    r->at = at;
    *out = r;
    r = NULL;
done:
    ritz_responder_free(&r); /* and with it s */
    return status;
}
