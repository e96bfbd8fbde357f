/* The program inside FMUs, called by FMI 2 and FMI 3, on models whose motion
   has a closed form. */
#include "fmu_driver.h"
#include "folder.h"
#include "testing.h"

#include "fmu/fmi/fmi2FunctionTypes.h"
#include "fmu/fmi/fmi3FunctionTypes.h"

#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

enum { ROOM = 4096 };

static const double near =
    1e3 * DBL_EPSILON; /* rounding of sums of a few dozen terms */

/* Models have one input (value reference 1), one output (2), and the states
   (3, 4, ...) of one block. */
static void write_one(int64_t size, int64_t states, const double *number,
                      int64_t count)
{
    const fmu_sample sample = {.inputs = 1,
                               .outputs = 1,
                               .states = states,
                               .blocks = 1,
                               .size = &size,
                               .number = number,
                               .count = count};
    unsigned char bytes[ROOM];

    fmu_sample_write(bytes, fmu_sample_bytes(&sample, bytes, sizeof bytes));
}

/* q'' + d q' + lambda q = b u, y = q */
static void write_oscillator(double lambda, double d, double b)
{
    const double number[] = {lambda, d, 0.0, b, 1.0, 0.0, 0.0, 1.0, 1.0};

    write_one(0, 2, number, 9);
}

/* The same oscillator as a dense block. */
static void write_dense(double lambda, double d, double b)
{
    const double number[] = {0.0, -lambda, 1.0, -d,  0.0, b,
                             1.0, 0.0,     0.0, 1.0, 1.0};

    write_one(2, 2, number, 11);
}

static void open_here(int fmi, bool steps, fmu_driver *d)
{
    if (!fmu_open(fmi, folder_path("."), fmu_sample_token, steps, d))
        fail_msg("%s", d->said);
}

/* Simulate steps from q0 and v0 under a constant force. Gives q and q'. */
static void march_once(int fmi, const double start[2], double force, double h,
                       int steps, double end[2])
{
    fmu_driver d;

    open_here(fmi, true, &d);
    assert_int_equal(fmu_put(&d, 3, start[0]), FMI_OK);
    assert_int_equal(fmu_put(&d, 4, start[1]), FMI_OK);
    assert_int_equal(fmu_start(&d, 1.5), FMI_OK);
    assert_int_equal(fmu_put(&d, 1, force), FMI_OK);
    for (int k = 0; k < steps; k++)
        assert_int_equal(fmu_step_over(&d, 1.5 + k * h, h), FMI_OK);
    assert_near(fmu_value(&d, 0), 1.5 + (steps - 1) * h + h, near);
    end[0] = fmu_value(&d, 2);
    end[1] = fmu_value(&d, 4);
    assert_near(fmu_value(&d, 3), end[0], 0.0);
    fmu_close(&d);
}

/* The closed form holds for any lambda, d and h, as an oscillator and as a
   dense block. */
static void assert_motion(double lambda, double d, double force, double h,
                          const double expected[2], double bound)
{
    const double start[2] = {0.3, -0.7};
    double end[2];

    for (int dense = 0; dense < 2; dense++)
        for (int fmi = 2; fmi <= 3; fmi++) {
            if (dense)
                write_dense(lambda, d, 2.0);
            else
                write_oscillator(lambda, d, 2.0);
            march_once(fmi, start, force, h, 1, end);
            for (int k = 0; k < 2; k++)
                assert_near(end[k], expected[k], bound);
        }
}

static void a_free_mass_under_a_constant_force_accelerates(void **state)
{
    const double h = 3.0;
    const double a = 2.0 * 0.25; /* b u */

    (void)state;
    assert_motion(0.0, 0.0, 0.25, h,
                  (double[2]){0.3 - 0.7 * h + 0.5 * a * h * h, -0.7 + a * h},
                  near);
}

static void an_undamped_mode_oscillates_about_its_static_solution(void **state)
{
    (void)state;
    for (int k = 0; k < 6; k++) {
        const double w = 3.0;
        const double h = 1e-3 * pow(7.0, k);
        const double rest = 2.0 * 0.25 / (w * w);
        const double c = cos(w * h);
        const double s = sin(w * h);

        assert_motion(w * w, 0.0, 0.25, h,
                      (double[2]){rest + (0.3 - rest) * c - 0.7 * s / w,
                                  -(0.3 - rest) * w * s - 0.7 * c},
                      1e2 * near);
    }
}

/* zeta = 0.1 and 5, real roots in the second. */
static void a_damped_mode_decays_by_its_poles(void **state)
{
    const double w = 2.0;
    const double h = 1.7;

    (void)state;
    for (int k = 0; k < 2; k++) {
        const double zeta = k == 0 ? 0.1 : 5.0;
        const double rest = 2.0 * 0.25 / (w * w);
        const double q = 0.3 - rest;
        const double v = -0.7 + zeta * w * q;
        const double r = w * sqrt(fabs(1.0 - zeta * zeta));
        const double c = k == 0 ? cos(r * h) : cosh(r * h);
        const double s = (k == 0 ? sin(r * h) : sinh(r * h)) / r;
        const double fade = exp(-zeta * w * h);
        const double rate = k == 0 ? -r * r : r * r;

        assert_motion(w * w, 2.0 * zeta * w, 0.25, h,
                      (double[2]){rest + fade * (q * c + v * s),
                                  fade * (v * c + rate * q * s) -
                                      zeta * w * fade * (q * c + v * s)},
                      1e2 * near);
    }
}

/* At critical damping there is one eigenvector for two states. */
static void a_defective_pair_is_propagated(void **state)
{
    const double w = 2.0;
    const double rest = 2.0 * 0.25 / (w * w);
    const double q = 0.3 - rest;
    const double v = -0.7 + w * q;

    (void)state;
    for (int k = 0; k < 4; k++) {
        const double h = 0.01 * pow(6.0, k);
        const double fade = exp(-w * h);

        assert_motion(w * w, 2.0 * w, 0.25, h,
                      (double[2]){rest + fade * (q + v * h),
                                  fade * (v - w * (q + v * h))},
                      near);
    }
}

/* A free mass on a dashpot: one root is 0. */
static void a_dashpot_stops_rigid_motion(void **state)
{
    const double d = 0.5;

    (void)state;
    for (int k = -2; k <= 1; k++) {
        const double h = pow(10.0, k);
        const double gone = -expm1(-d * h) / d;
        const double a = 0.5;

        assert_motion(0.0, d, 0.25, h,
                      (double[2]){0.3 - 0.7 * gone + a * (h - gone) / d,
                                  -0.7 * exp(-d * h) + a * gone},
                      1e2 * near * h);
    }
}

/* An unstable oscillator, which ritz-export writes only with --force. */
static void a_negative_stiffness_grows(void **state)
{
    const double w = 1.5;
    const double h = 2.0;
    const double rest = -2.0 * 0.25 / (w * w);
    const double q = 0.3 - rest;

    (void)state;
    assert_motion(-w * w, 0.0, 0.25, h,
                  (double[2]){rest + q * cosh(w * h) - 0.7 * sinh(w * h) / w,
                              q * w * sinh(w * h) - 0.7 * cosh(w * h)},
                  1e2 * near);
}

/* A chain of three integrators: one eigenvector for three states. */
static void three_integrators_give_a_cubic_of_time(void **state)
{
    /* A by columns, B, C, D, nominals */
    const double number[] = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0,
                             0.0, 4.0, 1.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0};
    const double h = 1.25;
    fmu_driver d;

    (void)state;
    write_one(3, 3, number, 19);
    for (int fmi = 2; fmi <= 3; fmi++) {
        open_here(fmi, true, &d);
        assert_int_equal(fmu_start(&d, 0.0), FMI_OK);
        assert_int_equal(fmu_put(&d, 1, 3.0), FMI_OK);
        assert_int_equal(fmu_step_over(&d, 0.0, h), FMI_OK);
        assert_near(fmu_value(&d, 2), 12.0 * h * h * h / 6.0 + 1.5, near);
        assert_near(fmu_value(&d, 4), 12.0 * h * h / 2.0, near);
        assert_near(fmu_value(&d, 5), 12.0 * h, near);
        fmu_close(&d);
    }
}

/* Units: displacements of 1e-9, and a force of 1e9. */
static void units_do_not_matter(void **state)
{
    const double w = 2e4;
    const double h = 1e-3;
    const double start[2] = {0.0, 0.0};
    double end[2];

    (void)state;
    for (int dense = 0; dense < 2; dense++) {
        if (dense)
            write_dense(w * w, 0.0, 1e-6);
        else
            write_oscillator(w * w, 0.0, 1e-6);
        march_once(3, start, 1e9, h, 1, end);
        assert_near(end[0], 1e3 / (w * w) * (1.0 - cos(w * h)),
                    1e3 * near * 1e3 / (w * w));
        assert_near(end[1], 1e3 / w * sin(w * h), 1e3 * near * 1e3 / w);
    }
}

static void small_steps_add_up_to_a_large_one(void **state)
{
    const double start[2] = {0.3, -0.7};
    double one[2], many[2];

    (void)state;
    write_dense(9.0, 0.4, 2.0);
    march_once(2, start, 0.25, 3.2, 1, one);
    march_once(2, start, 0.25, 0.1, 32, many);
    for (int k = 0; k < 2; k++)
        assert_near(many[k], one[k], 32.0 * near);
}

/* ---- instances ---------------------------------------------------------- */

static void instances_share_nothing(void **state)
{
    fmu_driver a, b;

    (void)state;
    write_oscillator(4.0, 0.0, 1.0);
    open_here(2, true, &a);
    open_here(3, true, &b);
    assert_int_equal(fmu_start(&a, 0.0), FMI_OK);
    assert_int_equal(fmu_start(&b, 0.0), FMI_OK);
    assert_int_equal(fmu_put(&a, 1, 1.0), FMI_OK);
    assert_int_equal(fmu_step_over(&a, 0.0, 0.5), FMI_OK);
    assert_int_equal(fmu_step_over(&b, 0.0, 0.5), FMI_OK);
    assert_near(fmu_value(&a, 2), (1.0 - cos(1.0)) / 4.0, near);
    assert_near(fmu_value(&b, 2), 0.0, 0.0);
    fmu_close(&a);
    fmu_close(&b);
}

static void a_reset_instance_is_new(void **state)
{
    fmu_driver d;

    (void)state;
    write_oscillator(4.0, 0.0, 1.0);
    for (int fmi = 2; fmi <= 3; fmi++) {
        open_here(fmi, true, &d);
        assert_int_equal(fmu_start(&d, 2.0), FMI_OK);
        assert_int_equal(fmu_put(&d, 1, 1.0), FMI_OK);
        assert_int_equal(fmu_step_over(&d, 2.0, 0.5), FMI_OK);
        assert_int_equal(fmu_again(&d), FMI_OK);
        for (unsigned k = 0; k <= 6; k++)
            assert_near(fmu_value(&d, k), 0.0, 0.0);
        assert_int_equal(fmu_start(&d, 0.0), FMI_OK);
        fmu_close(&d);
    }
}

static void a_restored_state_continues_bit_for_bit(void **state)
{
    fmi2GetFMUstateTYPE *get = NULL;
    fmi2SetFMUstateTYPE *set = NULL;
    fmi2FreeFMUstateTYPE *drop = NULL;
    fmi2SerializedFMUstateSizeTYPE *measure = NULL;
    fmi2SerializeFMUstateTYPE *write = NULL;
    fmi2DeSerializeFMUstateTYPE *read = NULL;
    fmi2FMUstate saved = NULL, copy = NULL;
    char bytes[512];
    size_t size = 0;
    double once = 0.0;
    fmu_driver d;

    (void)state;
    fmu_find("fmi2GetFMUstate", (void *)&get);
    fmu_find("fmi2SetFMUstate", (void *)&set);
    fmu_find("fmi2FreeFMUstate", (void *)&drop);
    fmu_find("fmi2SerializedFMUstateSize", (void *)&measure);
    fmu_find("fmi2SerializeFMUstate", (void *)&write);
    fmu_find("fmi2DeSerializeFMUstate", (void *)&read);
    write_oscillator(4.0, 0.1, 1.0);
    open_here(2, true, &d);
    assert_int_equal(fmu_start(&d, 0.0), FMI_OK);
    assert_int_equal(fmu_put(&d, 1, 1.0), FMI_OK);
    assert_int_equal(fmu_step_over(&d, 0.0, 0.5), FMI_OK);
    assert_int_equal(get(d.instance, &saved), FMI_OK);
    assert_int_equal(measure(d.instance, saved, &size), FMI_OK);
    assert_true(size <= sizeof bytes);
    assert_int_equal(write(d.instance, saved, bytes, size), FMI_OK);
    assert_int_equal(write(d.instance, saved, bytes, size - 1), FMI_ERROR);
    assert_int_equal(fmu_step_over(&d, 0.5, 0.5), FMI_OK);
    once = fmu_value(&d, 2);
    assert_int_equal(read(d.instance, bytes, size, &copy), FMI_OK);
    assert_int_equal(set(d.instance, copy), FMI_OK);
    assert_near(fmu_value(&d, 0), 0.5, 0.0);
    assert_int_equal(fmu_step_over(&d, 0.5, 0.5), FMI_OK);
    assert_near(fmu_value(&d, 2), once, 0.0);
    bytes[3] ^= 1;
    assert_int_equal(read(d.instance, bytes, size, &copy), FMI_ERROR);
    assert_string_equal(d.said, "it is no state of this model");
    assert_int_equal(read(d.instance, bytes, 5, &copy), FMI_ERROR);
    drop(d.instance, &saved);
    drop(d.instance, &copy);
    assert_null(copy);
    fmu_close(&d);
}

/* ---- model exchange ----------------------------------------------------- */

static void derivatives_are_those_of_the_equation(void **state)
{
    fmi3GetContinuousStateDerivativesTYPE *derive = NULL;
    fmi3SetContinuousStatesTYPE *set = NULL;
    fmi3GetNominalsOfContinuousStatesTYPE *nominals = NULL;
    const double x[2] = {0.3, -0.7};
    double dx[2], nominal[2];
    fmu_driver d;

    (void)state;
    fmu_find("fmi3GetContinuousStateDerivatives", (void *)&derive);
    fmu_find("fmi3SetContinuousStates", (void *)&set);
    fmu_find("fmi3GetNominalsOfContinuousStates", (void *)&nominals);
    for (int dense = 0; dense < 2; dense++) {
        if (dense)
            write_dense(4.0, 0.5, 2.0);
        else
            write_oscillator(4.0, 0.5, 2.0);
        open_here(3, false, &d);
        assert_int_equal(fmu_start(&d, 0.0), FMI_OK);
        assert_int_equal(fmu_put(&d, 1, 3.0), FMI_OK);
        assert_int_equal(set(d.instance, x, 2), FMI_OK);
        assert_int_equal(derive(d.instance, dx, 2), FMI_OK);
        assert_near(dx[0], -0.7, 0.0);
        assert_near(dx[1], 6.0 - 4.0 * 0.3 + 0.5 * 0.7, 10.0 * DBL_EPSILON);
        assert_near(fmu_value(&d, 5), dx[0], 0.0);
        assert_near(fmu_value(&d, 6), dx[1], 10.0 * DBL_EPSILON);
        assert_int_equal(nominals(d.instance, nominal, 2), FMI_OK);
        assert_near(nominal[1], 1.0, 0.0);
        assert_int_equal(derive(d.instance, dx, 1), FMI_ERROR);
        assert_string_equal(d.said, "there are 2 states, not 1");
        assert_int_equal(fmu_step_over(&d, 0.0, 0.1), FMI_ERROR);
        assert_non_null(strstr(d.said, "model exchange makes no steps"));
        fmu_close(&d);
    }
}

static void partial_derivatives_are_the_matrices(void **state)
{
    fmi3GetDirectionalDerivativeTYPE *forward = NULL;
    fmi3GetAdjointDerivativeTYPE *adjoint = NULL;
    fmi3GetVariableDependenciesTYPE *depend = NULL;
    fmi3GetNumberOfVariableDependenciesTYPE *count = NULL;
    const unsigned unknown[] = {2, 6};
    const unsigned known[] = {1, 3, 4};
    const double seed[] = {1.0, 10.0, 100.0};
    const double back[] = {1.0, 10.0};
    double out[3] = {0.0};
    size_t number = 0, of[3], by[3];
    unsigned who[3] = {0};
    fmi3DependencyKind kind[3];
    fmu_driver d;

    (void)state;
    fmu_find("fmi3GetDirectionalDerivative", (void *)&forward);
    fmu_find("fmi3GetAdjointDerivative", (void *)&adjoint);
    fmu_find("fmi3GetVariableDependencies", (void *)&depend);
    fmu_find("fmi3GetNumberOfVariableDependencies", (void *)&count);
    write_oscillator(4.0, 0.5, 2.0);
    open_here(3, false, &d);
    assert_int_equal(forward(d.instance, unknown, 2, known, 3, seed, 3, out, 2),
                     FMI_OK);
    assert_near(out[0], 10.0, 0.0);              /* y = q */
    assert_near(out[1], 2.0 - 40.0 - 50.0, 0.0); /* v' */
    assert_int_equal(adjoint(d.instance, unknown, 2, known, 3, back, 2, out, 3),
                     FMI_OK);
    assert_near(out[0], 20.0, 0.0);
    assert_near(out[1], 1.0 - 40.0, 0.0);
    assert_near(out[2], -5.0, 0.0);
    assert_int_equal(forward(d.instance, known, 1, known, 1, seed, 1, out, 1),
                     FMI_ERROR);
    assert_non_null(strstr(d.said, "variable 1 has no derivative"));
    assert_int_equal(count(d.instance, 6, &number), FMI_OK);
    assert_int_equal(number, 3);
    assert_int_equal(depend(d.instance, 6, of, who, by, kind, 3), FMI_OK);
    assert_int_equal(who[0], 1);
    assert_int_equal(who[2], 4);
    assert_int_equal(kind[1], fmi3Constant);
    assert_int_equal(count(d.instance, 2, &number), FMI_OK);
    assert_int_equal(number, 1); /* q alone */
    fmu_close(&d);
}

/* ---- refusals ----------------------------------------------------------- */

static void calls_that_make_no_sense_are_refused(void **state)
{
    fmu_driver d;

    (void)state;
    write_oscillator(4.0, 0.0, 1.0);
    for (int fmi = 2; fmi <= 3; fmi++) {
        open_here(fmi, true, &d);
        assert_int_equal(fmu_step_over(&d, 0.0, 0.1), FMI_ERROR);
        assert_non_null(
            strstr(d.said, "is instantiated, it should be running"));
        assert_int_equal(fmu_put(&d, 2, 1.0), FMI_ERROR);
        assert_string_equal(d.said, "variable 2 cannot be set");
        assert_int_equal(fmu_put(&d, 9, 1.0), FMI_ERROR);
        assert_int_equal(fmu_put(&d, 1, (double)INFINITY), FMI_ERROR);
        assert_string_equal(d.said, "variable 1 is set to inf");
        assert_int_equal(fmu_start(&d, 0.0), FMI_OK);
        assert_int_equal(fmu_start(&d, 0.0), FMI_ERROR);
        assert_int_equal(fmu_put(&d, 3, 1.0), FMI_ERROR);
        assert_non_null(strstr(d.said, "is set before the simulation only"));
        assert_int_equal(fmu_step_over(&d, 0.0, 0.0), FMI_ERROR);
        assert_non_null(strstr(d.said, "no step from 0 over 0 is possible"));
        assert_int_equal(fmu_step_over(&d, 0.0, -1.0), FMI_ERROR);
        fmu_close(&d);
    }
}

/* Functions of one kind of instance are refused by the other, and all of them
   before the simulation begins. */
static void functions_of_another_kind_or_mode_are_refused(void **state)
{
    fmi2SetTimeTYPE *set_time = NULL; /* the same in both versions */
    fmi2SetupExperimentTYPE *setup = NULL;
    fmu_driver d;

    (void)state;
    write_oscillator(4.0, 0.0, 1.0);
    fmu_find("fmi2SetupExperiment", (void *)&setup);
    for (int fmi = 2; fmi <= 3; fmi++) {
        fmu_find(fmi == 2 ? "fmi2SetTime" : "fmi3SetTime", (void *)&set_time);
        open_here(fmi, true, &d);
        assert_int_equal(fmu_start(&d, 0.0), FMI_OK);
        assert_int_equal(set_time(d.instance, 1.0), FMI_ERROR);
        assert_non_null(strstr(d.said, "SetTime is for model exchange, and the "
                                       "instance is for co-simulation"));
        fmu_close(&d);
        open_here(fmi, false, &d);
        assert_int_equal(set_time(d.instance, 1.0), FMI_ERROR);
        assert_non_null(
            strstr(d.said, "is instantiated, it should be running"));
        assert_int_equal(fmu_start(&d, 0.0), FMI_OK);
        assert_int_equal(set_time(d.instance, 1.0), FMI_OK);
        if (fmi == 2)
            assert_int_equal(setup(d.instance, 0, 0.0, 0.0, 0, 0.0), FMI_ERROR);
        assert_near(fmu_value(&d, 0), 1.0, 0.0);
        fmu_close(&d);
    }
}

static void a_motion_beyond_all_bounds_ends_the_step(void **state)
{
    fmu_driver d;

    (void)state;
    for (int dense = 0; dense < 2; dense++) {
        if (dense)
            write_dense(-1e6, 0.0, 1.0);
        else
            write_oscillator(-1e6, 0.0, 1.0);
        open_here(2, true, &d);
        assert_int_equal(fmu_start(&d, 0.0), FMI_OK);
        assert_int_equal(fmu_put(&d, 1, 1.0), FMI_OK);
        assert_int_equal(fmu_step_over(&d, 0.0, 10.0), FMI_ERROR);
        assert_non_null(strstr(d.said, "the motion is not finite"));
        assert_near(fmu_value(&d, 3), 0.0, 0.0);
        fmu_close(&d);
    }
}

static void other_variables_than_reals_are_refused(void **state)
{
    fmi2GetIntegerTYPE *integer = NULL;
    fmi3SetStringTYPE *string = NULL;
    fmi3InstantiateScheduledExecutionTYPE *schedule = NULL;
    const unsigned reference = 1;
    const char *text = "a";
    int number = 0;
    fmu_driver d;

    (void)state;
    fmu_find("fmi2GetInteger", (void *)&integer);
    fmu_find("fmi3SetString", (void *)&string);
    fmu_find("fmi3InstantiateScheduledExecution", (void *)&schedule);
    write_oscillator(4.0, 0.0, 1.0);
    open_here(2, true, &d);
    assert_int_equal(integer(d.instance, &reference, 1, &number), FMI_ERROR);
    assert_string_equal(d.said, "all variables are real");
    assert_int_equal(integer(d.instance, NULL, 0, NULL), FMI_OK);
    fmu_close(&d);
    open_here(3, true, &d);
    assert_int_equal(string(d.instance, &reference, 1, &text, 1), FMI_ERROR);
    assert_string_equal(d.said, "all variables are Float64");
    fmu_close(&d);
    assert_null(
        schedule("one", "", "", false, false, NULL, NULL, NULL, NULL, NULL));
}

static void assert_refused(const char *folder, const char *token,
                           const char *words)
{
    fmu_driver d;

    for (int fmi = 2; fmi <= 3; fmi++) {
        if (fmu_open(fmi, folder, token, true, &d))
            fail_msg("it was not refused: %s", words);
        if (!strstr(d.said, words))
            fail_msg("'%s' does not say '%s'", d.said, words);
    }
}

static void resources_of_another_token_are_refused(void **state)
{
    (void)state;
    write_oscillator(4.0, 0.0, 1.0);
    assert_refused(folder_path("."), "another", "it belongs to the token");
    assert_int_equal(remove(folder_path("ritz.bin")), 0);
    assert_refused(folder_path("."), fmu_sample_token, "cannot be opened");
    assert_int_equal(mkdir(folder_path("ritz.bin"), 0700), 0);
    assert_refused(folder_path("."), fmu_sample_token, "it cannot be read");
    assert_int_equal(rmdir(folder_path("ritz.bin")), 0);
}

/* Bytes of an oscillator and a dense block, two inputs, one output. */
static size_t fill_mixed(unsigned char bytes[ROOM])
{
    static const int64_t size[] = {0, 2};
    static const double number[] = {4.0, 0.1, -1.0, 0.2, 0.3, -2.0, /* blocks */
                                    0.0, 1.0, 0.5,  0.0, 0.0, 0.0,
                                    1.0, 2.0,                      /* B */
                                    1.0, 0.0, 1.0,  1.0, 0.0, 0.5, /* C, D */
                                    1.0, 1.0, 1.0,  1.0};
    const fmu_sample sample = {
        2, 1, 4, 2, size, number, sizeof number / sizeof *number};

    return fmu_sample_bytes(&sample, bytes, ROOM);
}

/* A checksum of 64 bits, made by a product, finds each byte that changes. */
static void resources_that_are_damaged_are_refused(void **state)
{
    unsigned char bytes[ROOM];
    const size_t size = fill_mixed(bytes);
    fmu_driver d;

    (void)state;
    fmu_sample_write(bytes, size);
    open_here(3, true, &d);
    fmu_close(&d);
    for (size_t k = 0; k < size; k++) {
        bytes[k] ^= 0x10;
        fmu_sample_write(bytes, size);
        if (fmu_open(3, folder_path("."), fmu_sample_token, true, &d))
            fail_msg("byte %zu", k);
        bytes[k] ^= 0x10;
        fmu_sample_write(bytes, k);
        if (fmu_open(2, folder_path("."), fmu_sample_token, true, &d))
            fail_msg("cut at byte %zu", k);
    }
}

/* Changed numbers with a checksum that fits them, as an attacker would
 * write. */
static void write_hostile(size_t word, uint64_t value, size_t cut)
{
    unsigned char bytes[ROOM];
    const size_t size = fill_mixed(bytes) - cut;
    uint64_t hash = 14695981039346656037U;

    memcpy(bytes + word, &value, sizeof value);
    for (size_t k = 16; k < size; k++)
        hash = (hash ^ bytes[k]) * 1099511628211U;
    memcpy(bytes + 8, &hash, sizeof hash);
    fmu_sample_write(bytes, size);
}

static void resources_with_wrong_numbers_are_refused(void **state)
{
    static const struct {
        size_t word;
        uint64_t value;
        const char *words;
    } rows[] = {
        {80, UINT64_MAX, "states a size of"},
        {88, 1U << 20, "bytes of numbers instead of"},
        {96, 1U << 20, "its blocks hold 4 of 1048576 states"},
        {96, 3, "block 2 ends behind the last state"},
        {104, 1U << 20, "ends within its list of blocks"},
        {104, 1, "its blocks hold 2 of 4 states"},
        {112, UINT64_MAX, "block 1 ends behind the last state"},
        {120, 1, "its blocks hold 3 of 4 states"},
        {128, 0x7ff0000000000000U, "number 1 is not finite"},
        {128 + 8 * 6, 0x3ff0000000000000U, "drives a displacement at once"},
        {128 + 8 * 23, 0, "nominal value 4 is not positive"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        write_hostile(rows[k].word, rows[k].value, 0);
        assert_refused(folder_path("."), fmu_sample_token, rows[k].words);
    }
    write_hostile(128, 0, 3);
    assert_refused(folder_path("."), fmu_sample_token,
                   "bytes of numbers instead of");
}

/* A URI has some letters as their codes, but no code ends the path; its scheme
 * may be in capitals [BernersLee2005]. */
static void a_uri_is_decoded(void **state)
{
    fmi2InstantiateTYPE *instantiate = NULL;
    fmi2FreeInstanceTYPE *end = NULL;
    char path[2048] = "", uri[4096] = "File://localhost";
    size_t length = strlen(uri);
    void *instance = NULL;

    (void)state;
    write_oscillator(4.0, 0.0, 1.0);
    fmu_find("fmi2Instantiate", (void *)&instantiate);
    fmu_find("fmi2FreeInstance", (void *)&end);
    assert_non_null(realpath(folder_path("."), path));
    for (const char *at = path; *at && length < sizeof uri - 4; at++)
        length += (size_t)snprintf(uri + length, 4,
                                   *at == '/' ? "%c" : "%%%02X", *at);
    instance =
        instantiate("one", fmi2CoSimulation, fmu_sample_token, uri, NULL, 0, 0);
    assert_non_null(instance);
    end(instance);
    snprintf(uri + length, sizeof uri - length, "/ritz.bin%%00");
    assert_null(instantiate("one", fmi2CoSimulation, fmu_sample_token, uri,
                            NULL, 0, 0));
    assert_null(instantiate("one", fmi2CoSimulation, fmu_sample_token, NULL,
                            NULL, 0, 0));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_free_mass_under_a_constant_force_accelerates),
    cmocka_unit_test(an_undamped_mode_oscillates_about_its_static_solution),
    cmocka_unit_test(a_damped_mode_decays_by_its_poles),
    cmocka_unit_test(a_defective_pair_is_propagated),
    cmocka_unit_test(a_dashpot_stops_rigid_motion),
    cmocka_unit_test(a_negative_stiffness_grows),
    cmocka_unit_test(three_integrators_give_a_cubic_of_time),
    cmocka_unit_test(units_do_not_matter),
    cmocka_unit_test(small_steps_add_up_to_a_large_one),
    cmocka_unit_test(instances_share_nothing),
    cmocka_unit_test(a_reset_instance_is_new),
    cmocka_unit_test(a_restored_state_continues_bit_for_bit),
    cmocka_unit_test(derivatives_are_those_of_the_equation),
    cmocka_unit_test(partial_derivatives_are_the_matrices),
    cmocka_unit_test(calls_that_make_no_sense_are_refused),
    cmocka_unit_test(functions_of_another_kind_or_mode_are_refused),
    cmocka_unit_test(a_motion_beyond_all_bounds_ends_the_step),
    cmocka_unit_test(other_variables_than_reals_are_refused),
    cmocka_unit_test(resources_of_another_token_are_refused),
    cmocka_unit_test(resources_that_are_damaged_are_refused),
    cmocka_unit_test(resources_with_wrong_numbers_are_refused),
    cmocka_unit_test(a_uri_is_decoded),
};

TEST_MODULE(fmu_program, tests, folder_make, folder_remove)
