/*
 * steps ORDER... - microseconds of processor time for a step of a reduced model
 * with so many modes, energies included, for each kind of run: integrators with
 * D that leaves modes uncoupled, with two dampers between all modes, and with a
 * full D; loops with a controller of two states; a state space; spin at a rate
 * that is constant (a profile of one value) or changes. The last column
 * is the exponent of the order, fitted to the three largest. It only prints;
 * set OMP_NUM_THREADS=1 for one thread.
 */
#include "../unit/try.h"

#include "linear/general.h"

#include <ritz/controlled.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { FIRST_STEPS = 500, MOST_ORDERS = 8 };

/* Seconds that a measurement takes at least, beyond the start of a run. */
static const double least = 0.02;

/* What D couples. */
typedef enum coupling { UNCOUPLED, DAMPERS, FULL } coupling;

/* Modes of 1 to 20 Hz, driven and observed at one end. */
typedef struct plant {
    ritz_dense K, M, D;
    ritz_io io;
    ritz_second_order matrices;
    ritz_state_space controller;
    ritz_spin_terms spin;
    int64_t measured, driven;
    ritz_loop loop;
} plant;

static ritz_status make_controller(plant *p)
{
    ritz_status status = RITZ_OK;
    ritz_io io = {0};

    RITZ_TRY(ritz_io_new(2, 1, 1, &io));
    RITZ_TRY(ritz_state_space_new(2, &io, &p->controller));
    ritz_dense_col(&p->controller.A, 0)[0] = -30.0;
    ritz_dense_col(&p->controller.A, 1)[1] = -50.0;
    ritz_dense_col(&p->controller.A, 1)[0] = 1.0;
    ritz_dense_col(&p->controller.B, 0)[1] = 1.0;
    ritz_dense_col(&p->controller.C, 0)[0] = 1e-3;
done:
    ritz_io_free(&io);
    return status;
}

/* Damping between modes: two dampers on all of them, or a full matrix. */
static void add_damping(int64_t n, coupling by, ritz_dense *D)
{
    uint64_t seed = 3;

    for (int64_t j = 0; by != UNCOUPLED && j < n; j++)
        for (int64_t i = 0; i <= j; i++) {
            const double d =
                by == DAMPERS
                    ? 0.5 / (double)n * (1.0 + cos((double)i) * cos((double)j))
                    : 0.1 / (double)n * ritz_general_noise(&seed);

            ritz_dense_col(D, j)[i] += d;
            if (i < j)
                ritz_dense_col(D, i)[j] += d;
        }
}

/* A skew G, S = -1 and KG = 2 times the mass, and loads. */
static ritz_status make_spin(int64_t n, ritz_spin_terms *spin)
{
    ritz_status status = RITZ_OK;
    uint64_t seed = 5;

    RITZ_TRY(ritz_dense_new(n, n, &spin->G));
    RITZ_TRY(ritz_dense_new(n, n, &spin->S));
    RITZ_TRY(ritz_dense_new(n, n, &spin->KG));
    RITZ_TRY(ritz_dense_new(n, 2, &spin->load));
    for (int64_t j = 0; j < n; j++) {
        ritz_dense_col(&spin->S, j)[j] = -1.0;
        ritz_dense_col(&spin->KG, j)[j] = 2.0;
        for (int64_t i = 0; i < j; i++) {
            const double g = ritz_general_noise(&seed) / (double)n;

            ritz_dense_col(&spin->G, j)[i] = g;
            ritz_dense_col(&spin->G, i)[j] = -g;
        }
        for (int k = 0; k < 2; k++)
            ritz_dense_col(&spin->load, k)[j] = ritz_general_noise(&seed);
    }
    spin->inertia = 1.0;
done:
    return status;
}

static ritz_status make_plant(int64_t n, coupling by, plant *p)
{
    ritz_status status = RITZ_OK;

    RITZ_TRY(ritz_dense_new(n, n, &p->K));
    RITZ_TRY(ritz_dense_new(n, n, &p->D));
    RITZ_TRY(ritz_dense_identity(n, &p->M));
    RITZ_TRY(ritz_io_new(n, 1, 1, &p->io));
    for (int64_t k = 0; k < n; k++) {
        const double w = 6.3 * (1.0 + 19.0 * (double)k / (double)n);

        ritz_dense_col(&p->K, k)[k] = w * w;
        ritz_dense_col(&p->D, k)[k] = 0.02 * w;
        ritz_dense_col(&p->io.B, 0)[k] = 1.0;
        ritz_dense_col(&p->io.C, k)[0] = 1.0;
    }
    add_damping(n, by, &p->D);
    p->matrices =
        (ritz_second_order){.K = &p->K, .M = &p->M, .D = &p->D, .io = &p->io};
    p->loop = (ritz_loop){1, &p->measured, 1, &p->driven, false};
    RITZ_TRY(make_controller(p));
    RITZ_TRY(make_spin(n, &p->spin));
done:
    return status;
}

static void free_plant(plant *p)
{
    ritz_dense_free(&p->K);
    ritz_dense_free(&p->M);
    ritz_dense_free(&p->D);
    ritz_io_free(&p->io);
    ritz_state_space_free(&p->controller);
    ritz_spin_terms_free(&p->spin);
}

static double seconds(void)
{
    struct timespec now;

    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* A kind of run. */
typedef struct kind {
    const char *name;
    const ritz_integrator *integrator;
    coupling by;
    bool loop, exact, states;
    double sample;
    int spin; /* 0: none, 1: at a constant rate, 2: at one that changes */
} kind;

/* A run whose rate of spin is 1 rad/s, or grows to that for ever. */
static ritz_status spin_run(const plant *p, bool changes, ritz_model model,
                            const ritz_simulation_request *request,
                            ritz_simulation *out)
{
    double time[2] = {0.0, 2.0 * request->seconds}, value[2] = {1.0, 1.0};
    const ritz_spin_rate rate = {RITZ_SPIN_PROFILE, 2, time, value};

    if (changes)
        value[0] = 0.0;
    return ritz_simulate_spun(model, &p->spin, &rate, request, out);
}

/* Processor time of a whole run. */
static ritz_status time_run(const plant *p, const kind *k, int64_t steps,
                            double *out)
{
    static const ritz_loop_stability stability = {0};
    static const ritz_signal push = {.kind = RITZ_SIGNAL_STEP,
                                     .amplitude = 1.0};
    const ritz_controlled way = {.controller = &p->controller,
                                 .loop = &p->loop,
                                 .exact = k->exact,
                                 .sample = k->sample};
    ritz_model model = ritz_model_of_dense(&p->matrices, NULL);
    ritz_simulation_request request = RITZ_SIMULATION_NONE;
    ritz_simulation s = {0};
    ritz_state_space made = {0};
    const ritz_state_space *space = NULL;
    ritz_status status = RITZ_OK;
    double began = 0.0;

    if (k->states) {
        RITZ_TRY(ritz_model_states(model, &made, &space));
        model = ritz_model_of_states(space);
    }
    began = seconds();
    request.integrator = k->integrator;
    request.step = 1e-3;
    request.seconds = request.step * (double)steps;
    request.every = steps;
    request.signal = &push;
    RITZ_TRY(k->loop       ? ritz_simulate_controlled(model, &request, &way,
                                                      &stability, &s)
             : k->spin > 0 ? spin_run(p, k->spin > 1, model, &request, &s)
                           : ritz_simulate(model, &request, &s));
    *out = seconds() - began;
done:
    ritz_simulation_free(&s);
    ritz_state_space_free(&made);
    return status;
}

static ritz_status least_of(const plant *p, const kind *k, int64_t steps,
                            double *out)
{
    double now = 0.0;

    *out = HUGE_VAL;
    for (int run = 0; run < 5; run++) {
        const ritz_status status = time_run(p, k, steps, &now);

        if (status != RITZ_OK)
            return status;
        *out = fmin(*out, now);
    }
    return RITZ_OK;
}

/* Microseconds a step: the difference of a long and a short run. */
static ritz_status time_step(int64_t n, const kind *k, double *out)
{
    ritz_status status = RITZ_OK;
    plant p = {0};
    double begun = 0.0, all = 0.0;
    int64_t steps = FIRST_STEPS;

    RITZ_TRY(make_plant(n, k->by, &p));
    RITZ_TRY(least_of(&p, k, 1, &begun));
    do {
        steps *= 2;
        RITZ_TRY(least_of(&p, k, steps, &all));
    } while (all - begun < fmax(least, 0.5 * begun));
    *out = 1e6 * (all - begun) / (double)(steps - 1);
done:
    free_plant(&p);
    return status;
}

/* Slope of ln t over ln n of the last three. */
static double find_exponent(int count, const int64_t *order, const double *t)
{
    const int first = count > 3 ? count - 3 : 0;
    double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;

    for (int k = first; k < count; k++) {
        const double u = log((double)order[k]), v = log(t[k]);

        x += u;
        y += v;
        xx += u * u;
        xy += u * v;
    }
    return (xy - x * y / (count - first)) / (xx - x * x / (count - first));
}

static ritz_status measure(const kind *k, int count, const int64_t *order)
{
    double t[MOST_ORDERS];

    printf("%-34s", k->name);
    for (int j = 0; j < count; j++) {
        const ritz_status status = time_step(order[j], k, &t[j]);

        if (status != RITZ_OK)
            return status;
        printf(" %8.3f", t[j]);
        fflush(stdout);
    }
    printf(" %8.2f\n", find_exponent(count, order, t));
    return RITZ_OK;
}

static const kind kinds[] = {
    {"modal", &ritz_integrator_modal, .by = UNCOUPLED},
    {"modal, two dampers", &ritz_integrator_modal, .by = DAMPERS},
    {"modal, full D", &ritz_integrator_modal, .by = FULL},
    {"trapezoidal", &ritz_integrator_trapezoidal, .by = UNCOUPLED},
    {"trapezoidal, full D", &ritz_integrator_trapezoidal, .by = FULL},
    {"generalised-alpha", &ritz_integrator_generalised_alpha, .by = UNCOUPLED},
    {"generalised-alpha, full D", &ritz_integrator_generalised_alpha,
     .by = FULL},
    {"central-difference", &ritz_integrator_central_difference,
     .by = UNCOUPLED},
    {"central-difference, full D", &ritz_integrator_central_difference,
     .by = FULL},
    {"loop, split", &ritz_integrator_modal, .loop = true},
    {"loop, sampled each 10 steps", &ritz_integrator_modal, .loop = true,
     .sample = 0.01},
    {"loop, exact", &ritz_integrator_modal, .loop = true, .exact = true},
    {"loop, exact, full D", &ritz_integrator_modal, .by = FULL, .loop = true,
     .exact = true},
    {"state space of 2 r states", &ritz_integrator_modal, .states = true},
    {"spin, constant rate", &ritz_integrator_trapezoidal, .spin = 1},
    {"spin, rate that changes", &ritz_integrator_trapezoidal, .spin = 2},
};

int main(int argc, char **argv)
{
    int64_t order[MOST_ORDERS];
    const int count = argc - 1 < MOST_ORDERS ? argc - 1 : MOST_ORDERS;

    printf("%-34s", "microseconds a step, modes:");
    for (int k = 0; k < count; k++) {
        order[k] = strtoll(argv[k + 1], NULL, 10);
        printf(" %8" PRId64, order[k]);
    }
    printf(" %8s\n", "exponent");
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        if (measure(&kinds[k], count, order) != RITZ_OK) {
            fprintf(stderr, "steps: %s\n", ritz_error_message());
            return 1;
        }
    return 0;
}
