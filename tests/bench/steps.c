/*
 * loops ORDER... - microseconds of processor time for a step of a plant with so
 * many uncoupled modes: without a controller, with one of two states by the
 * split, and with it by one exponential. That is a dense product of the order
 * of the loop, and three more for the integrals of energy. The last column is
 * exact over split. It only prints; set OMP_NUM_THREADS=1 for one thread.
 */
#include "../unit/try.h"

#include <ritz/controlled.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { STEPS = 2000, MOST_EXACT = (RITZ_LOOP_EXACT - 2) / 2 };

/* Modes of 1 to 20 Hz, driven and observed at one end. */
typedef struct plant {
    ritz_dense K, M, D;
    ritz_io io;
    ritz_second_order matrices;
    ritz_state_space controller;
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

static ritz_status make_plant(int64_t n, plant *p)
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
    p->matrices =
        (ritz_second_order){.K = &p->K, .M = &p->M, .D = &p->D, .io = &p->io};
    p->loop = (ritz_loop){1, &p->measured, 1, &p->driven, false};
    RITZ_TRY(make_controller(p));
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
}

static double seconds(void)
{
    struct timespec now;

    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Processor time of a whole run; `way` NULL: without a controller. */
static ritz_status time_run(const plant *p, const ritz_controlled *way,
                            int64_t steps, double *out)
{
    static const ritz_outlook seen = {0};
    static const ritz_signal push = {.kind = RITZ_SIGNAL_STEP,
                                     .amplitude = 1.0};
    const ritz_model model = ritz_model_of_dense(&p->matrices, NULL);
    ritz_simulation_request request = RITZ_SIMULATION_NONE;
    ritz_simulation s = {0};
    ritz_status status = RITZ_OK;
    const double began = seconds();

    request.step = 1e-3;
    request.seconds = request.step * (double)steps;
    request.every = steps;
    request.signal = &push;
    RITZ_TRY(way ? ritz_simulate_controlled(model, &request, way, &seen, &s)
                 : ritz_simulate(model, &request, &s));
    *out = seconds() - began;
done:
    ritz_simulation_free(&s);
    return status;
}

/* Microseconds a step: the difference of two runs, the least of three. */
static ritz_status time_step(const plant *p, const ritz_controlled *way,
                             double *out)
{
    ritz_status status = RITZ_OK;

    *out = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        double one = 0.0, two = 0.0;

        RITZ_TRY(time_run(p, way, STEPS, &one));
        RITZ_TRY(time_run(p, way, 3 * STEPS, &two));
        *out = fmin(*out, 1e6 * (two - one) / (2 * STEPS));
    }
done:
    return status;
}

static ritz_status measure(int64_t n)
{
    ritz_status status = RITZ_OK;
    plant p = {0};
    ritz_controlled way = {.controller = &p.controller, .loop = &p.loop};
    double open = 0.0, split = 0.0, exact = nan("");

    RITZ_TRY(make_plant(n, &p));
    RITZ_TRY(time_step(&p, NULL, &open));
    RITZ_TRY(time_step(&p, &way, &split));
    way.exact = true;
    if (n <= MOST_EXACT)
        RITZ_TRY(time_step(&p, &way, &exact));
    if (isnan(exact))
        printf("%8" PRId64 " %10.3f %10.3f %10s %8s\n", n, open, split, "-",
               "-");
    else
        printf("%8" PRId64 " %10.3f %10.3f %10.3f %8.1f\n", n, open, split,
               exact, exact / split);
    fflush(stdout);
done:
    free_plant(&p);
    return status;
}

int main(int argc, char **argv)
{
    printf("%8s %10s %10s %10s %8s\n", "modes", "open", "split", "exact",
           "ratio");
    for (int k = 1; k < argc; k++)
        if (measure(strtoll(argv[k], NULL, 10)) != RITZ_OK) {
            fprintf(stderr, "loops: %s\n", ritz_error_message());
            return 1;
        }
    return 0;
}
