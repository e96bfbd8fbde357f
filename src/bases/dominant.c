/*
 * In coordinates that make T'MT = I and T'KT = Lambda, with the modes' damping
 * ratios on the diagonal of W,
 *
 *     (p^2 I + p W + Lambda + i K4) z = 0,    x = T X z.
 *
 * Without damping matrices the modes are decoupled; with them poles are
 * eigenvalues of [0, I; -Lambda - i K4, -W].
 */
#include "bases/tangential.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "model/modal.h"

#include <complex.h>
#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

bool ritz_rational_damped(const ritz_rational *R)
{
    return R->component->D.colptr || R->component->K4.colptr;
}

ritz_status ritz_probes_new(int64_t count, int64_t width, ritz_probes *out)
{
    RITZ_OWN(ritz_probes) probes = {.count = count};

    RITZ_CHECK_NEW(probes.item, count);
    RITZ_CHECK_NEW(probes.b, count * width);
    for (int64_t k = 0; k < count; k++)
        probes.item[k].b = probes.b + k * width;
    RITZ_MOVE(*out, probes);
    return RITZ_OK;
}

void ritz_probes_free(ritz_probes *probes)
{
    RITZ_FREE(probes->item, probes->b);
    *probes = (ritz_probes){0};
}

typedef struct candidate {
    double _Complex s;
    double decay;       /* |Re p| */
    double value;       /* dominance, of the largest; in single precision, so
                           that what is equal but for rounding stays so */
    double _Complex *z; /* m, modal coordinates; borrowed from `vectors` */
} candidate;

typedef struct dominant_model {
    const ritz_rational *R;
    ritz_pairs modes; /* of T'KT and T'MT */
    ritz_dense W, K4;
    ritz_dense F[RITZ_RATIONAL_GROUPS][3]; /* m x loads, modal */
    int64_t count;
    candidate *pole;                       /* at most 2 m */
    double _Complex *vectors;              /* m for each */
    double terms[RITZ_RATIONAL_GROUPS][3]; /* upper bounds of |F'x| */
    double most[RITZ_RATIONAL_GROUPS];     /* largest |F'x|; huge if rounding */
} dominant_model;

static void dominant_model_free(dominant_model *s)
{
    ritz_pairs_free(&s->modes);
    ritz_dense_free(&s->W);
    ritz_dense_free(&s->K4);
    for (int g = 0; g < RITZ_RATIONAL_GROUPS; g++)
        for (int k = 0; k < 3; k++)
            ritz_dense_free(&s->F[g][k]);
    RITZ_FREE(s->pole, s->vectors);
}

/* Phi' (T'AT) Phi; zeros if there is no A. */
static ritz_status project_on_modes(const ritz_sparse *A, const ritz_dense *T,
                                    const ritz_dense *Phi, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) small = {0};

    if (!A->colptr)
        return ritz_dense_new(Phi->ncol, Phi->ncol, out);
    RITZ_CHECK(ritz_sparse_condense(A, T, &small));
    return ritz_dense_congruence(&small, Phi, out);
}

/* Largest sum_i |F_ij|, times the largest |X_ik|. */
static double largest_terms(const ritz_dense *F, const ritz_dense *X)
{
    double largest = 0.0;

    for (int64_t j = 0; j < F->ncol; j++) {
        double sum = 0.0;

        for (int64_t i = 0; i < F->nrow; i++)
            sum += fabs(ritz_dense_col(F, j)[i]);
        largest = fmax(largest, sum);
    }
    return largest * ritz_dense_max(X);
}

/* The participation of loads in each mode. */
static ritz_status project_loads(const ritz_dense *X, dominant_model *s)
{
    for (int64_t g = 0; g < s->R->num_groups; g++)
        for (int k = 0; k < 3; k++) {
            const ritz_dense *F = &s->R->group[g].F[k];

            if (!F->val)
                continue;
            RITZ_CHECK(ritz_dense_mul_tn(X, F, &s->F[g][k]));
            s->terms[g][k] = largest_terms(F, X);
        }
    return RITZ_OK;
}

/*
 * These modes are not those of the component: of ratios that are listed mode by
 * mode the last one is used for all.
 */
enum { BEYOND_LISTED = RITZ_MOST_RATIOS };

static ritz_status project_component(const ritz_rational *R,
                                     const ritz_damping *damping,
                                     const ritz_dense *T, dominant_model *s)
{
    const ritz_component *component = R->component;
    RITZ_OWN(ritz_dense) K = {0}, M = {0}, TX = {0};

    s->R = R;
    RITZ_CHECK(ritz_sparse_condense(&component->K, T, &K));
    RITZ_CHECK(ritz_sparse_condense(&component->M, T, &M));
    RITZ_CHECK(ritz_eigen_dense(&K, &M, &s->modes));
    RITZ_CHECK(project_on_modes(&component->D, T, &s->modes.Phi, &s->W));
    RITZ_CHECK(project_on_modes(&component->K4, T, &s->modes.Phi, &s->K4));
    for (int64_t k = 0; k < s->W.ncol; k++)
        ritz_dense_col(&s->W, k)[k] +=
            ritz_modal_rate(damping, BEYOND_LISTED, s->modes.lambda[k]);
    RITZ_CHECK(ritz_dense_mul(T, &s->modes.Phi, &TX));
    RITZ_CHECK(project_loads(&TX, s));
    RITZ_CHECK_NEW(s->pole, 2 * s->W.ncol);
    RITZ_CHECK_NEW(s->vectors, 2 * s->W.ncol * s->W.ncol);
    return RITZ_OK;
}

static candidate *append_pole(dominant_model *s, double _Complex point,
                              double decay)
{
    candidate *pole = &s->pole[s->count];

    pole->s = point;
    pole->decay = decay;
    pole->z = s->vectors + s->count * s->W.ncol;
    s->count++;
    return pole;
}

/* s^2 = -w^2 (1 - zeta) of each mode. */
static void solve_decoupled(dominant_model *s)
{
    for (int64_t k = 0; k < s->W.ncol; k++) {
        double lambda = s->modes.lambda[k];
        double zeta = 0.0;
        double square = 0.0;

        if (lambda <= 0.0)
            continue; /* rounding of a rigid motion */
        zeta = fmax(0.5 * ritz_dense_col(&s->W, k)[k] / sqrt(lambda),
                    RITZ_LEAST_DECAY);
        square =
            copysign(fmax(fabs(zeta - 1.0), RITZ_LEAST_SQUARE), zeta - 1.0);
        append_pole(s, csqrt(lambda * square), zeta * sqrt(lambda))->z[k] = 1.0;
    }
}

/* [0, I; -Lambda - i K4, -W], 2m x 2m. */
static void fill_states(const dominant_model *s, double _Complex *A)
{
    int64_t m = s->W.ncol;

    for (int64_t j = 0; j < m; j++) {
        double _Complex *left = A + j * 2 * m;
        double _Complex *right = A + (m + j) * 2 * m;

        for (int64_t i = 0; i < m; i++) {
            double lambda = i == j ? s->modes.lambda[j] : 0.0;

            left[m + i] = -(lambda + (double _Complex)_Complex_I *
                                         ritz_dense_col(&s->K4, j)[i]);
            right[m + i] = -ritz_dense_col(&s->W, j)[i];
        }
        right[j] = 1.0;
    }
}

/* Keep a pole of the upper half plane or the real axis; z has length 2m. */
static void keep_pole(double _Complex p, const double _Complex *z,
                      dominant_model *s)
{
    double decay = fmax(fabs(creal(p)), RITZ_LEAST_DECAY * cabs(p));
    double omega = cimag(p);
    double length = 0.0;
    candidate *pole = NULL;

    if (fabs(omega) <= RITZ_POLE_REAL * cabs(p))
        omega = 0.0;
    if (omega < 0.0 || cabs(p) == 0.0)
        return;
    pole = append_pole(s, decay + (double _Complex)_Complex_I * omega, decay);
    for (int64_t i = 0; i < s->W.ncol; i++)
        length = hypot(length, cabs(z[i]));
    for (int64_t i = 0; i < s->W.ncol; i++)
        pole->z[i] = z[i] / length;
}

static ritz_status solve_coupled(dominant_model *s)
{
    int64_t m = s->W.ncol;
    int n = (int)(2 * m);
    RITZ_OWN_ARRAY double _Complex *A = NULL, *p = NULL, *V = NULL;

    RITZ_CHECK_NEW(A, 4 * m * m);
    RITZ_CHECK_NEW(p, 2 * m);
    RITZ_CHECK_NEW(V, 4 * m * m);
    fill_states(s, A);
    RITZ_REFUSE_IF(n > 0 && LAPACKE_zgeev(LAPACK_COL_MAJOR, 'N', 'V', n, A, n,
                                          p, NULL, 1, V, n) != 0,
                   RITZ_ERR_CONVERGENCE,
                   "poles of the reduced component do not converge");
    for (int64_t k = 0; k < 2 * m; k++)
        keep_pole(p[k], V + k * 2 * m, s);
    return RITZ_OK;
}

/* b = conj(F(-conj(s))'x) for one kind of load; returns |b|. */
static double find_direction(const dominant_model *s, const candidate *pole,
                             int64_t g, double _Complex *b)
{
    double _Complex power = 1.0;
    double sum = 0.0;
    int64_t count = s->R->group[g].count;

    for (int64_t j = 0; j < count; j++)
        b[j] = 0.0;
    for (int k = 0; k < 3; k++, power *= -conj(pole->s))
        for (int64_t j = 0; j < s->F[g][k].ncol; j++)
            for (int64_t i = 0; i < s->W.ncol; i++)
                b[j] += conj(power * ritz_dense_col(&s->F[g][k], j)[i] *
                             pole->z[i]);
    for (int64_t j = 0; j < count; j++)
        sum += creal(b[j] * conj(b[j]));
    return sqrt(sum);
}

/* |x'(2 p M + D) x| in modal coordinates, p = -conj(s). */
static double pole_scale(const dominant_model *s, const candidate *pole)
{
    double _Complex sum = 0.0;

    for (int64_t j = 0; j < s->W.ncol; j++) {
        double _Complex row = -2.0 * conj(pole->s) * pole->z[j];

        for (int64_t i = 0; i < s->W.ncol; i++)
            row += ritz_dense_col(&s->W, j)[i] * pole->z[i];
        sum += row * pole->z[j];
    }
    return cabs(sum);
}

/*
 * |C x| |x'B| of a pole; with only one kind of load, the square of its factor.
 */
static double pole_gain(const dominant_model *s, const candidate *pole,
                        double _Complex *b)
{
    double in = 0.0;
    double out = 0.0;
    int64_t outputs = 0;

    for (int64_t g = 0; g < s->R->num_groups; g++) {
        double part = find_direction(s, pole, g, b);

        if (!(part > RITZ_NEGLIGIBLE * s->most[g]))
            part = 0.0;
        if (s->R->group[g].kind == RITZ_LOADS_OUTPUTS) {
            out = part;
            outputs++;
        } else {
            in = hypot(in, part);
        }
    }
    if (outputs == 0)
        out = in;
    if (outputs == s->R->num_groups)
        in = out;
    return in * out;
}

/* The largest participation of one kind of load in any pole. */
static double find_most(const dominant_model *s, int64_t g, double _Complex *b)
{
    double most = 0.0;
    double terms = 0.0;

    for (int64_t k = 0; k < s->count; k++) {
        double size = cabs(s->pole[k].s);

        most = fmax(most, find_direction(s, &s->pole[k], g, b));
        terms = fmax(terms, s->terms[g][0] + size * (s->terms[g][1] +
                                                     size * s->terms[g][2]));
    }
    return most > RITZ_NEGLIGIBLE * terms ? most : HUGE_VAL;
}

static ritz_status weigh_poles(dominant_model *s)
{
    RITZ_OWN_ARRAY double _Complex *b = NULL;
    double largest = DBL_MIN;

    RITZ_CHECK_NEW(b, s->R->num_loads);
    for (int64_t g = 0; g < s->R->num_groups; g++)
        s->most[g] = find_most(s, g, b);
    for (int64_t k = 0; k < s->count; k++) {
        candidate *pole = &s->pole[k];

        pole->value =
            pole_gain(s, pole, b) / pole_scale(s, pole) / sqrt(pole->decay);
        largest = fmax(largest, pole->value);
    }
    for (int64_t k = 0; k < s->count; k++)
        s->pole[k].value = (double)(float)(s->pole[k].value / largest);
    return RITZ_OK;
}

/*
 * The most dominant precedes; of equal ones the slower, then the less damped.
 */
static int compare_dominance(const void *left, const void *right)
{
    const candidate *a = left;
    const candidate *b = right;

    if (a->value != b->value)
        return a->value > b->value ? -1 : 1;
    if (cabs(a->s) != cabs(b->s))
        return cabs(a->s) < cabs(b->s) ? -1 : 1;
    return (a->decay > b->decay) - (a->decay < b->decay);
}

/*
 * The probe of a pole and a group: the direction of the loads' participation,
 * normalised.
 */
static void set_probe(const dominant_model *s, const candidate *pole, int64_t g,
                      ritz_interpolation_point *probe)
{
    double _Complex *b = probe->b + s->R->group[g].first;
    double part = find_direction(s, pole, g, b);
    bool counts = part > RITZ_NEGLIGIBLE * s->most[g];

    probe->s = pole->s;
    probe->group = g;
    for (int64_t j = 0; j < s->R->group[g].count; j++)
        b[j] = counts ? b[j] / part : 0.0;
}

static ritz_status list_probes(const dominant_model *s, ritz_probes *out)
{
    int64_t poles = 0;
    int64_t groups = 0;
    int64_t at = 0;

    while (poles < s->count && s->pole[poles].value > 0.0)
        poles++;
    for (int64_t g = 0; g < s->R->num_groups; g++)
        groups += s->R->group[g].interpolated;
    RITZ_CHECK(ritz_probes_new(poles * groups, s->R->num_loads, out));
    for (int64_t k = 0; k < poles; k++)
        for (int64_t g = 0; g < s->R->num_groups; g++)
            if (s->R->group[g].interpolated)
                set_probe(s, &s->pole[k], g, &out->item[at++]);
    return RITZ_OK;
}

ritz_status ritz_dominant_probes(const ritz_rational *R,
                                 const ritz_damping *damping,
                                 const ritz_dense *T, ritz_probes *out)
{
    RITZ_OWN(dominant_model) s = {0};

    RITZ_CHECK(project_component(R, damping, T, &s));
    if (ritz_rational_damped(R))
        RITZ_CHECK(solve_coupled(&s));
    else
        solve_decoupled(&s);
    RITZ_CHECK(weigh_poles(&s));
    if (s.count > 0)
        qsort(s.pole, (size_t)s.count, sizeof *s.pole, compare_dominance);
    return list_probes(&s, out);
}
