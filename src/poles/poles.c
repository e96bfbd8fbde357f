/* Modal coordinates that D or K4 couples: one dense solve a point. */
#include "poles/poles.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "model/modal.h"

#include <complex.h>
#include <lapacke.h>
#include <math.h>

/* Z = Lambda - w^2 I + i (w D + K4), both triangles. */
static void assemble_coupled(const ritz_poles *poles, bool transposed, double w,
                             double _Complex *Z)
{
    int64_t m = poles->count + poles->massless;

    for (int64_t j = 0; j < m; j++) {
        double own = poles->lambda[j] - (j < poles->count ? w * w : 0.0);

        for (int64_t i = 0; i < m; i++) {
            int64_t at = transposed ? j + i * m : i + j * m;
            double k4 = poles->K4.val ? poles->K4.val[at] : 0.0;
            double d = w * poles->D.val[at];

            Z[i + j * m] = ritz_complex(i == j ? own : 0.0, d + k4);
        }
    }
}

/*
 * S Z S and S q, of unit diagonal: w^2 of rigid motion may be small against
 * Lambda without being singular.
 */
static void equilibrate_coupled(int64_t m, int64_t inputs, double _Complex *Z,
                                double _Complex *q, double *s)
{
    for (int64_t j = 0; j < m; j++) {
        double own = cabs(Z[j + j * m]);

        s[j] = own > 0.0 ? 1.0 / sqrt(own) : 1.0;
    }
    for (int64_t j = 0; j < m; j++)
        for (int64_t i = 0; i < m; i++)
            Z[i + j * m] *= s[i] * s[j];
    for (int64_t j = 0; j < inputs; j++)
        for (int64_t i = 0; i < m; i++)
            q[i + j * m] *= s[i];
}

/* Z := its factors, complex symmetric or not; LAPACK's info. */
static int factor_coupled(bool skew, int m, double _Complex *Z,
                          lapack_int *pivot, double *rcond)
{
    double norm = LAPACKE_zlange(LAPACK_COL_MAJOR, '1', m, m, Z, m);
    int info = skew ? LAPACKE_zgetrf(LAPACK_COL_MAJOR, m, m, Z, m, pivot)
                    : LAPACKE_zsytrf(LAPACK_COL_MAJOR, 'L', m, Z, m, pivot);

    if (info != 0)
        return info;
    return skew ? LAPACKE_zgecon(LAPACK_COL_MAJOR, '1', m, Z, m, norm, rcond)
                : LAPACKE_zsycon(LAPACK_COL_MAJOR, 'L', m, Z, m, pivot, norm,
                                 rcond);
}

static ritz_status solve_whole(const ritz_poles *poles, bool transposed,
                               const ritz_dense *loads, double hertz,
                               double _Complex *q)
{
    int64_t m = poles->count + poles->massless;
    int64_t inputs = loads->ncol;
    RITZ_OWN_ARRAY double _Complex *Z = NULL;
    RITZ_OWN_ARRAY double *s = NULL;
    RITZ_OWN_ARRAY lapack_int *pivot = NULL;
    double rcond = 0.0;
    int info = 0;

    RITZ_CHECK_NEW(Z, m * m);
    RITZ_CHECK_NEW(s, m);
    RITZ_CHECK_NEW(pivot, m);
    assemble_coupled(poles, transposed, 2.0 * RITZ_PI * hertz, Z);
    for (int64_t k = 0; k < m * inputs; k++)
        q[k] = loads->val[k];
    equilibrate_coupled(m, inputs, Z, q, s);
    info = factor_coupled(poles->skew, (int)m, Z, pivot, &rcond);
    RITZ_REFUSE_IF(
        info != 0 || !(rcond > RITZ_COUPLED_RCOND), RITZ_ERR_SINGULAR,
        "the response at %.9g Hz is infinite: an undamped mode, or at "
        "0 Hz a rigid-body motion",
        hertz);
    if (poles->skew)
        (void)LAPACKE_zgetrs(LAPACK_COL_MAJOR, 'N', (int)m, (int)inputs, Z,
                             (int)m, pivot, q, (int)m);
    else
        (void)LAPACKE_zsytrs(LAPACK_COL_MAJOR, 'L', (int)m, (int)inputs, Z,
                             (int)m, pivot, q, (int)m);
    for (int64_t k = 0; k < m * inputs; k++)
        q[k] *= s[k % m];
    return RITZ_OK;
}

/* D of few dampers is symmetric, and Z with it. */
static ritz_status solve_coupled(const ritz_poles *poles, bool transposed,
                                 const ritz_dense *loads, double hertz,
                                 double _Complex *q)
{
    bool solved = false;

    if (poles->L.ncol > 0)
        RITZ_CHECK(ritz_few_dampers_solve(poles, loads, hertz, &solved, q));
    return solved ? RITZ_OK : solve_whole(poles, transposed, loads, hertz, q);
}

static bool couples_modes(const ritz_dense *A)
{
    double largest = 0.0;

    for (int64_t k = 0; k < A->ncol; k++)
        largest = fmax(largest, fabs(ritz_dense_col(A, k)[k]));
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++) {
            double own = sqrt(fabs(ritz_dense_col(A, i)[i]) *
                              fabs(ritz_dense_col(A, j)[j]));

            if (i != j && !(fabs(ritz_dense_col(A, j)[i]) <=
                            RITZ_DIAGONAL_WITHIN * own +
                                RITZ_DIAGONAL_ROUNDING * largest))
                return true;
        }
    return false;
}

/* K4 is kept whole where there is any: it has no rate. */
static ritz_status add_matrices(const ritz_dense *D, const ritz_dense *K4,
                                ritz_poles *poles)
{
    bool has_k4 = K4 && K4->val;

    if (D && D->val) {
        for (int64_t k = 0; k < poles->count; k++)
            poles->rate[k] += ritz_dense_col(D, k)[k];
        poles->coupled = couples_modes(D);
        poles->skew = ritz_dense_asymmetry(D) > RITZ_SYMMETRIC;
        RITZ_CHECK(ritz_dense_copy(D, &poles->D));
    } else if (has_k4) {
        RITZ_CHECK(ritz_dense_new(poles->count, poles->count, &poles->D));
    }
    if (poles->coupled && !poles->skew && !has_k4)
        RITZ_CHECK(ritz_few_dampers(D, &poles->L));
    if (has_k4) {
        poles->coupled = true;
        RITZ_CHECK(ritz_dense_copy(K4, &poles->K4));
    }
    for (int64_t k = 0; poles->D.val && k < poles->count; k++)
        ritz_dense_col(&poles->D, k)[k] = poles->rate[k];
    return RITZ_OK;
}

/* Modal matrices are borrowed until the call ends; {0} or NULL: none. */
static ritz_status poles_new(const ritz_pairs *pairs, const ritz_dense *D,
                             const ritz_dense *K4, const ritz_io *io,
                             const ritz_damping *damping, ritz_poles *out)
{
    RITZ_OWN(ritz_poles)
    poles = {.count = pairs->Phi.ncol, .num_rigid = pairs->num_rigid};

    RITZ_CHECK_NEW(poles.lambda, poles.count);
    RITZ_CHECK_NEW(poles.rate, poles.count);
    for (int64_t k = 0; k < poles.count; k++) {
        bool rigid = k < poles.num_rigid;
        double w = rigid ? 0.0 : sqrt(fmax(pairs->lambda[k], 0.0));

        poles.lambda[k] = w * w;
        poles.rate[k] =
            ritz_modal_rate(damping, k - poles.num_rigid, poles.lambda[k]);
    }
    RITZ_CHECK(add_matrices(D, K4, &poles));
    RITZ_CHECK(ritz_io_project(io, &pairs->Phi, &poles.io));
    RITZ_CHECK_NEW(poles.q, poles.count * io->num_inputs);
    RITZ_MOVE(*out, poles);
    return RITZ_OK;
}

/* Participation of mode k in output i; an acceleration of a rigid mode has
   no pole. */
static double participation_of(const ritz_poles *poles, int64_t i, int64_t k)
{
    const ritz_io *io = &poles->io;
    double of_rest = fabs(ritz_dense_col(&io->C, k)[i]) +
                     fabs(ritz_dense_col(&io->Cv, k)[i]);

    return k < poles->num_rigid ? of_rest
                                : of_rest + fabs(ritz_dense_col(&io->Ca, k)[i]);
}

bool ritz_poles_matter(const ritz_poles *poles, int64_t k)
{
    const ritz_io *io = &poles->io;

    for (int64_t j = 0; j < io->num_inputs; j++) {
        const double *b = ritz_dense_col(&io->B, j);
        double driven = 0.0;

        for (int64_t m = 0; m < poles->count; m++)
            driven = fmax(driven, fabs(b[m]));
        for (int64_t i = 0; i < io->num_outputs; i++) {
            double seen = 0.0;

            for (int64_t m = 0; m < poles->count; m++)
                seen = fmax(seen, participation_of(poles, i, m));
            if (fabs(b[k]) * participation_of(poles, i, k) >
                RITZ_UNOBSERVED * driven * seen)
                return true;
        }
    }
    return false;
}

ritz_status ritz_refuse_pole(bool rigid, double hertz)
{
    if (rigid)
        return ritz_fail(
            RITZ_ERR_SINGULAR,
            "at 0 Hz the response is infinite: a rigid-body "
            "motion is controllable and observable, begin above 0 Hz");
    return ritz_fail(RITZ_ERR_SINGULAR,
                     "%.9g Hz is the frequency of an undamped mode: give it "
                     "damping or leave the point out",
                     hertz);
}

/* 1 / (re + i im). Only numbers whose squares overflow or underflow take the slow
   complex division, which scales. */
static double _Complex invert(double re, double im)
{
    const double square = re * re + im * im;

    return isnormal(square) ? ritz_complex(re / square, -im / square)
                            : 1.0 / ritz_complex(re, im);
}

static ritz_status solve_decoupled(const ritz_poles *poles,
                                   const ritz_dense *loads, double hertz,
                                   double _Complex *q)
{
    double w = 2.0 * RITZ_PI * hertz;

    for (int64_t k = 0; k < poles->count; k++) {
        const double re = poles->lambda[k] - w * w, im = w * poles->rate[k];
        const double hit = RITZ_POLE_HIT * (poles->lambda[k] + w * w);
        const bool on_pole =
            fabs(re) <= hit && fabs(im) <= hit && hypot(re, im) <= hit;
        const double _Complex g = on_pole ? 0.0 : invert(re, im);

        if (on_pole && ritz_poles_matter(poles, k))
            return ritz_refuse_pole(k < poles->num_rigid, hertz);
        for (int64_t j = 0; j < loads->ncol; j++)
            q[k + j * poles->count] = g * loads->val[k + j * loads->nrow];
    }
    return RITZ_OK;
}

ritz_status ritz_poles_solve(const ritz_poles *poles, bool transposed,
                             const ritz_dense *loads, double hertz,
                             double _Complex *q)
{
    if (poles->count + poles->massless == 0 || loads->ncol == 0)
        return RITZ_OK;
    return poles->coupled ? solve_coupled(poles, transposed, loads, hertz, q)
                          : solve_decoupled(poles, loads, hertz, q);
}

/*
 * A rigid mode at 0 Hz has no finite q, but an acceleration: -w^2 q = b, which
 * ritz_poles_solve leaves to this.
 */
static void add_rigid_acceleration(const ritz_poles *poles, double _Complex *H)
{
    const ritz_io *io = &poles->io;

    for (int64_t k = 0; k < poles->num_rigid; k++)
        for (int64_t i = 0; poles->rate[k] == 0.0 && i < io->num_outputs; i++)
            for (int64_t j = 0; j < io->num_inputs; j++)
                H[i * io->num_inputs + j] += ritz_dense_col(&io->Ca, k)[i] *
                                             ritz_dense_col(&io->B, j)[k];
}

ritz_status ritz_poles_add(const ritz_poles *poles, double hertz,
                           double _Complex *H)
{
    RITZ_CHECK(ritz_poles_solve(poles, false, &poles->io.B, hertz, poles->q));
    ritz_io_respond(&poles->io, hertz, poles->q, H);
    if (hertz == 0.0 && !poles->coupled)
        add_rigid_acceleration(poles, H);
    ritz_residual_add(&poles->rest, hertz, H);
    return RITZ_OK;
}

void ritz_poles_roots(double lambda, double rate, double _Complex s[static 2])
{
    double half = 0.5 * rate;
    double square = half * half - lambda;
    double root = sqrt(fabs(square));
    double far = rate < 0.0 ? root - half : -(half + root);

    if (square < 0.0) {
        s[0] = ritz_complex(-half, root);
        s[1] = conj(s[0]);
        return;
    }
    s[0] = far;
    s[1] = far != 0.0 ? lambda / far : 0.0;
}

ritz_status ritz_poles_ratios(const ritz_poles *poles, double **omega,
                              double **zeta)
{
    RITZ_OWN_ARRAY double *w = NULL;
    RITZ_OWN_ARRAY double *z = NULL;

    RITZ_CHECK_NEW(w, poles->count);
    RITZ_CHECK_NEW(z, poles->count);
    for (int64_t k = 0; k < poles->count; k++) {
        double k4 = poles->K4.val ? ritz_dense_col(&poles->K4, k)[k] : 0.0;

        w[k] = sqrt(poles->lambda[k]);
        if (w[k] > 0.0)
            z[k] = (poles->rate[k] + k4 / w[k]) / (2.0 * w[k]);
    }
    RITZ_MOVE(*omega, w);
    RITZ_MOVE(*zeta, z);
    return RITZ_OK;
}

void ritz_poles_free(ritz_poles *poles)
{
    RITZ_FREE(poles->lambda, poles->rate, poles->q);
    ritz_dense_free(&poles->D);
    ritz_dense_free(&poles->K4);
    ritz_dense_free(&poles->L);
    ritz_io_free(&poles->io);
    ritz_residual_free(&poles->rest);
    *poles = (ritz_poles){0};
}

ritz_status ritz_poles_of_component(const ritz_component *component,
                                    const ritz_damping *damping,
                                    double up_to_hz, ritz_pairs *pairs,
                                    ritz_poles *out)
{
    const ritz_span span = {.modes = -1, .up_to_hz = up_to_hz};
    RITZ_OWN(ritz_pairs) found = {0};
    RITZ_OWN(ritz_dense) D = {0};
    RITZ_OWN(ritz_dense) K4 = {0};

    RITZ_CHECK(ritz_eigen_sparse(&component->K, &component->M, &span, &found));
    RITZ_CHECK(ritz_sparse_project(&component->D, &found.Phi, &D));
    RITZ_CHECK(ritz_sparse_project(&component->K4, &found.Phi, &K4));
    RITZ_CHECK(poles_new(&found, &D, &K4, &component->io, damping, out));
    if (pairs) {
        RITZ_MOVE(*pairs, found);
    }
    return RITZ_OK;
}

/* Phi'A Phi; {0} of an absent one. */
static ritz_status project_if(const ritz_dense *A, const ritz_dense *Phi,
                              ritz_dense *out)
{
    return A && A->val ? ritz_dense_project(A, Phi, out) : RITZ_OK;
}

/*
 * Far below 0 an eigenvalue is no rounding: -3e-9 of the largest was seen. All
 * of a rigid body are rounding, of a stiffness that they do not tell of: the
 * largest that matters is then that of the response, (2 pi f)^2.
 */
static ritz_status refuse_unstable(const ritz_pairs *pairs, double to_hz)
{
    int64_t m = pairs->Phi.ncol;
    double largest = pow(2.0 * RITZ_PI * to_hz, 2.0);

    if (m > 0)
        largest = fmax(largest, fabs(pairs->lambda[m - 1]));
    RITZ_REFUSE_IF(m > 0 &&
                       pairs->lambda[0] < -RITZ_NEGATIVE_STIFFNESS * largest,
                   RITZ_ERR_ARGUMENT,
                   "the stiffness has a negative eigenvalue, %.3g where the "
                   "largest is %.3g: an unstable model has no steady response",
                   pairs->lambda[0], pairs->lambda[m - 1]);
    return RITZ_OK;
}

/* Whether A moves with any of N, beyond rounding. */
static ritz_status acts_on(const ritz_dense *A, const ritz_dense *N, bool *out)
{
    RITZ_OWN(ritz_dense) AN = {0}, NA = {0};

    if (!A || !A->val || N->ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_mul(A, N, &AN));
    RITZ_CHECK(ritz_dense_mul_tn(A, N, &NA));
    if (fmax(ritz_dense_max(&AN), ritz_dense_max(&NA)) >
        RITZ_NEGLIGIBLE * ritz_dense_max(A) * ritz_dense_max(N))
        *out = true;
    return RITZ_OK;
}

/*
 * Damping of motions without mass couples them with the modes: they are taken
 * beside them, as X = [Phi N], and their lambda is N'KN = 1.
 */
static ritz_status take_massless(const ritz_second_order *model, bool beside,
                                 ritz_pairs *pairs, int64_t *count)
{
    RITZ_OWN(ritz_dense) N = {0};
    ritz_dense X = {0};
    int64_t m = pairs->Phi.ncol;
    bool damped = beside;

    *count = 0;
    if (m == pairs->Phi.nrow)
        return RITZ_OK;
    RITZ_CHECK(ritz_massless(model, &pairs->Phi, pairs->lambda, &N));
    RITZ_CHECK(acts_on(model->D, &N, &damped));
    RITZ_CHECK(acts_on(model->K4, &N, &damped));
    if (!damped)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_beside(&pairs->Phi, &N, &X));
    ritz_dense_replace(&pairs->Phi, &X);
    *count = N.ncol;
    for (int64_t j = m; j < m + N.ncol; j++) /* lambda has room for all rows */
        pairs->lambda[j] = 1.0;
    return RITZ_OK;
}

/* The last coordinates are no modes: no ratio acts on them. */
static ritz_status mark_massless(int64_t count, const ritz_dense *D,
                                 const ritz_damping *damping, ritz_poles *poles)
{
    double b = damping && ritz_damping_is_rayleigh(damping) ? damping->b : 0.0;

    poles->count -= count;
    poles->massless = count;
    poles->coupled = poles->coupled || count > 0;
    if (count > 0 && !poles->D.val) /* damping couples none of the modes */
        RITZ_CHECK(ritz_dense_new(poles->count + count, poles->count + count,
                                  &poles->D));
    for (int64_t j = 0; j < poles->count && count > 0; j++)
        ritz_dense_col(&poles->D, j)[j] = poles->rate[j];
    for (int64_t j = poles->count; j < poles->count + count; j++) {
        poles->rate[j] = b + (D->val ? ritz_dense_col(D, j)[j] : 0.0);
        ritz_dense_col(&poles->D, j)[j] = poles->rate[j];
    }
    return RITZ_OK;
}

ritz_status ritz_poles_of_pairs(const ritz_second_order *model,
                                const ritz_damping *damping, bool beside,
                                ritz_pairs *pairs, ritz_poles *out)
{
    RITZ_OWN(ritz_dense) D = {0};
    RITZ_OWN(ritz_dense) K4 = {0};
    RITZ_OWN(ritz_residual) rest = {0};
    int64_t massless = 0;

    RITZ_CHECK(ritz_static_rest(model, pairs, &rest));
    RITZ_CHECK(take_massless(model, beside, pairs, &massless));
    RITZ_CHECK_IN("D", project_if(model->D, &pairs->Phi, &D));
    RITZ_CHECK_IN("K4", project_if(model->K4, &pairs->Phi, &K4));
    RITZ_CHECK(poles_new(pairs, &D, &K4, model->io, damping, out));
    RITZ_CHECK(mark_massless(massless, &D, damping, out));
    if (massless == 0) {
        RITZ_MOVE(out->rest, rest);
        if (damping && ritz_damping_is_rayleigh(damping))
            out->rest.b = damping->b;
    }
    return RITZ_OK;
}

ritz_status ritz_poles_of_dense(const ritz_second_order *model,
                                const ritz_damping *damping, double to_hz,
                                ritz_poles *out)
{
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK(ritz_eigen_dense(model->K, model->M, &pairs));
    RITZ_CHECK(refuse_unstable(&pairs, to_hz));
    return ritz_poles_of_pairs(model, damping, false, &pairs, out);
}

ritz_status ritz_poles_of_modes(const ritz_second_order *model,
                                const ritz_damping *damping, double to_hz,
                                const ritz_pairs *pairs, ritz_poles *out)
{
    RITZ_OWN(ritz_pairs) own = {.num_rigid = pairs->num_rigid};

    RITZ_CHECK(refuse_unstable(pairs, to_hz));
    RITZ_CHECK(ritz_dense_copy(&pairs->Phi, &own.Phi));
    RITZ_CHECK_COPY(own.lambda, pairs->lambda, pairs->Phi.nrow);
    return ritz_poles_of_pairs(model, damping, false, &own, out);
}
