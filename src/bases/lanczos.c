/*
 * One-sided Lanczos vectors of x' = A x + B u in the inner product of the
 * inverse of a Gramian [CraigSuKim1992, section 5]. With
 *
 *     A W + W A' + B B' = 0,   Q' W^-1 Q = I,   span Q = [B, A B, A^2 B, ...]
 *
 * the reduced A_r = Q' W^-1 A Q is block tridiagonal and skew-symmetric but for
 * its first block:
 *
 *     A_r + A_r' = -B_r B_r'
 *
 * so I is its own Gramian and no pole is right of the axis. The factor W = U U'
 * is found without W, and U = Z Sigma X' says where W is more than rounding:
 * the vectors are Q = Z Sigma P, Z and Sigma cut to that range, with P
 * orthonormal for
 *
 *     A~ = Sigma^-1 Z'A Z Sigma,   B~ = Sigma^-1 Z'B,   A~ + A~' = -B~ B~'
 *
 * For Krylov vectors of A^-1 the operator is G = A~^-1 with b = G B~, for which
 * G + G' = -b b'; then A_r = (P'G P)^-1, whose moments about 0 Hz are those of
 * A, not its Markov parameters. With the observability Gramian the same is
 * applied to (A', C').
 *
 * The residual A~ + A~' + B~ B~' is rounding, and is measured: the range is cut
 * until it is small against the least damping, and vectors whose poles it could
 * still move across the axis are left out (on A^-1, where an odd number of them
 * has one pole far out).
 */

#include "bases/lanczos.h"
#include "base/alloc.h"
#include "base/tolerances.h"
#include "bases/columns.h"
#include "bases/space.h"
#include "gramians/space.h"
#include "linear/general.h"
#include "linear/orthonormal.h"

#include <complex.h>
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/*
 * A system, or its dual (A', C') as (A, B), and its reduction. With the Gramian
 * W = U U' and U = Z Sigma X', cut to r values: Q = Z Sigma, V = Z Sigma^-1.
 */
typedef struct one_sided {
    ritz_dense A, B;
    int64_t states;      /* of the system */
    double damping;      /* least -Re s of A */
    int64_t reached;     /* number of values of U above the tolerance */
    ritz_dense Q, V;     /* n x r; r <= reached, as far as rounding allows */
    ritz_dense A_r, B_r; /* V'A Q, V'B */
    ritz_dense G, b;     /* operator and start, r x r and r x inputs */
    double rounding;     /* |G + G' + b b'| */
    ritz_dense P;        /* r x number of vectors */
    int64_t uncertain;   /* vectors left out at the end */
} one_sided;

static void one_sided_free(one_sided *s)
{
    ritz_dense *const all[9] = {&s->A,   &s->B, &s->Q, &s->V, &s->A_r,
                                &s->B_r, &s->G, &s->b, &s->P};

    for (int k = 0; k < 9; k++)
        ritz_dense_free(all[k]);
}

static ritz_status start_one_sided(const ritz_request *request,
                                   const ritz_states *states, one_sided *s)
{
    bool outputs = request->choice.gramian == RITZ_GRAMIAN_OUTPUTS;

    s->states = states->A.nrow;
    RITZ_REFUSE_IF(
        (outputs ? states->C.nrow : states->B.ncol) == 0, RITZ_ERR_ARGUMENT,
        "the component has no %s, and the Gramian of %s is none",
        outputs ? "outputs" : "inputs", outputs ? "outputs" : "inputs");
    if (outputs) {
        RITZ_CHECK(ritz_general_transpose(&states->A, &s->A));
        return ritz_general_transpose(&states->C, &s->B);
    }
    RITZ_CHECK(ritz_dense_copy(&states->A, &s->A));
    return ritz_dense_copy(&states->B, &s->B);
}

/* A Gramian is finite if every pole is stable, those of A less the shift. */
static ritz_status check_poles(const ritz_states *states, one_sided *s)
{
    RITZ_OWN(ritz_eigenvalues) poles = {0};
    int64_t k = 0;
    double growth = 0.0;
    double rounding = 0.0;

    RITZ_CHECK(ritz_eigenvalues_of(&s->A, &poles));
    k = ritz_eigenvalues_worst(&poles, RITZ_POLE_BOUND_FACTOR);
    s->damping = -poles.re[k];
    growth = poles.re[k] + states->alpha;
    rounding = RITZ_POLE_BOUND_FACTOR * poles.error[k];
    RITZ_REFUSE_IF(s->damping <= rounding &&
                       (s->damping < -rounding || states->alpha > 0.0),
                   RITZ_ERR_ARGUMENT,
                   "a pole grows at %.4g rad/s (%.4g Hz), the Gramian is "
                   "infinite: shift by more than that",
                   growth, growth / (2.0 * RITZ_PI));
    RITZ_REFUSE_IF(s->damping <= rounding, RITZ_ERR_ARGUMENT,
                   "the Gramian is infinite: motion at %.4g Hz has no damping, "
                   "give some or a shift above 0 Hz",
                   hypot(poles.re[k], poles.im[k]) / (2.0 * RITZ_PI));
    return RITZ_OK;
}

/* Entry (i, j) of A + A' + B B'. */
static double defect_entry(const ritz_dense *A, const ritz_dense *B, int64_t i,
                           int64_t j)
{
    double sum = ritz_dense_col(A, j)[i] + ritz_dense_col(A, i)[j];

    for (int64_t k = 0; k < B->ncol; k++)
        sum += ritz_dense_col(B, k)[i] * ritz_dense_col(B, k)[j];
    return sum;
}

/*
 * The number of leading rows and columns in which the defect's norm is below
 * the limit.
 */
static int64_t count_accurate(const ritz_dense *A, const ritz_dense *B,
                              double limit, double *norm)
{
    double sum = 0.0;

    *norm = 0.0;
    for (int64_t j = 0; j < A->nrow; j++) {
        for (int64_t i = 0; i <= j; i++)
            sum += (i < j ? 2.0 : 1.0) * pow(defect_entry(A, B, i, j), 2.0);
        if (sqrt(sum) > limit)
            return j;
        *norm = sqrt(sum);
    }
    return A->nrow;
}

/* Columns k < r of Z times s^power. */
static ritz_status scale_columns(const ritz_dense *Z, const double *s,
                                 int64_t r, double power, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_columns(Z, 0, r, out));
    for (int64_t j = 0; j < r; j++)
        for (int64_t i = 0; i < Z->nrow; i++)
            ritz_dense_col(out, j)[i] *= pow(s[j], power);
    return RITZ_OK;
}

/* Q, V, A_r and B_r of the first r values. */
static ritz_status transform_system(const ritz_dense *Z, const double *sigma,
                                    int64_t r, one_sided *s)
{
    RITZ_OWN(ritz_dense) AQ = {0};

    ritz_dense_free(&s->Q);
    ritz_dense_free(&s->V);
    ritz_dense_free(&s->A_r);
    ritz_dense_free(&s->B_r);
    RITZ_CHECK(scale_columns(Z, sigma, r, 1.0, &s->Q));
    RITZ_CHECK(scale_columns(Z, sigma, r, -1.0, &s->V));
    RITZ_CHECK(ritz_dense_mul(&s->A, &s->Q, &AQ));
    RITZ_CHECK(ritz_dense_mul_tn(&s->V, &AQ, &s->A_r));
    return ritz_dense_mul_tn(&s->V, &s->B, &s->B_r);
}

/*
 * The controllable states of the Gramian, in coordinates in which it is I, cut
 * until its rounding is small against the least damping.
 *
 * @return RITZ_ERR_ARGUMENT if the Gramian is zero, or a pole is not stable;
 *         RITZ_ERR_CONVERGENCE if nothing is left
 */
static ritz_status find_range(double tolerance, one_sided *s)
{
    RITZ_OWN(ritz_dense) U = {0}, Z = {0};
    RITZ_OWN_ARRAY double *sigma = NULL;
    int64_t n = s->A.nrow;
    int64_t r = 0;
    double least = fmax(tolerance, (double)n * DBL_EPSILON);
    double norm = 0.0;

    RITZ_CHECK(ritz_general_gramian(&s->A, &s->B, &U));
    RITZ_CHECK(ritz_general_svd(&U, &Z, &sigma, NULL));
    while (s->reached < n && sigma[s->reached] > least * sigma[0])
        s->reached++;
    RITZ_REFUSE_IF(s->reached == 0, RITZ_ERR_ARGUMENT,
                   "no flexible state is controllable, the Gramian is zero: do "
                   "the inputs and outputs act on rigid motion alone?");
    RITZ_CHECK(transform_system(&Z, sigma, s->reached, s));
    r = count_accurate(&s->A_r, &s->B_r, RITZ_LANCZOS_SMALL * s->damping,
                       &norm);
    RITZ_REFUSE_IF(r == 0, RITZ_ERR_CONVERGENCE,
                   "rounding of the Gramian is as large as the least damping");
    return r < s->reached ? transform_system(&Z, sigma, r, s) : RITZ_OK;
}

/* P, with the requested number of columns or as many as there are. */
static ritz_status find_vectors(const ritz_request *request, one_sided *s)
{
    int64_t first = 0;
    RITZ_OWN(ritz_orthonormal) P = {0};
    RITZ_OWN(ritz_dense) X = {0};

    RITZ_CHECK(ritz_orthonormal_new(s->G.nrow, NULL, request->tolerance, &P));
    RITZ_CHECK(ritz_dense_copy(&s->b, &X));
    do {
        ritz_dense last = {0};

        first = P.count;
        RITZ_CHECK(
            ritz_orthonormal_append(&P, &X, request->modes - first, NULL));
        ritz_dense_free(&X);
        last = ritz_dense_part(&P.V, first, P.count - first);
        RITZ_CHECK(ritz_dense_mul(&s->G, &last, &X));
    } while (P.count > first && P.count < request->modes);
    return ritz_dense_columns(&P.V, 0, P.count, &s->P);
}

/* P'G P of the first columns. */
static ritz_status reduce_operator(const one_sided *s, int64_t columns,
                                   ritz_dense *out)
{
    const ritz_dense P = ritz_dense_part(&s->P, 0, columns);
    RITZ_OWN(ritz_dense) GP = {0};

    RITZ_CHECK(ritz_dense_mul(&s->G, &P, &GP));
    return ritz_dense_mul_tn(&P, &GP, out);
}

/*
 * Leave out last vectors until no pole can be moved across the axis by
 * rounding.
 */
static ritz_status drop_uncertain(one_sided *s, ritz_dense *Gr)
{
    RITZ_OWN(ritz_eigenvalues) poles = {0};
    bool certain = false;

    while (s->P.ncol > 0 && !certain) {
        int64_t k = 0;

        ritz_dense_free(Gr);
        ritz_eigenvalues_free(&poles);
        RITZ_CHECK(reduce_operator(s, s->P.ncol, Gr));
        RITZ_CHECK(ritz_eigenvalues_of(Gr, &poles));
        k = ritz_eigenvalues_worst(&poles, RITZ_POLE_BOUND_FACTOR);
        certain = poles.re[k] < -RITZ_POLE_BOUND_FACTOR * poles.error[k] &&
                  poles.re[k] < -RITZ_LANCZOS_SAFE * s->rounding;
        if (!certain) {
            s->P.ncol--;
            s->uncertain++;
        }
    }
    RITZ_REFUSE_IF(s->P.ncol == 0, RITZ_ERR_CONVERGENCE,
                   "no states are left whose stability rounding leaves alone");
    return RITZ_OK;
}

/*
 * T = Z Sigma P and W = Z Sigma^-1 P; for A^-1 the latter is Z Sigma^-1 G'P
 * (P'G P)^-T, with which W'A T = (P'G P)^-1.
 */
static ritz_status find_bases(const one_sided *s, bool inverse,
                              const ritz_dense *Gr, ritz_dense *own,
                              ritz_dense *other)
{
    RITZ_OWN(ritz_dense) GP = {0}, Y = {0};

    RITZ_CHECK(ritz_dense_mul(&s->Q, &s->P, own));
    if (!inverse) {
        RITZ_CHECK(ritz_dense_mul(&s->V, &s->P, other));
        return RITZ_OK;
    }
    RITZ_CHECK(ritz_dense_mul_tn(&s->P, &s->G, &GP)); /* P'G */
    RITZ_CHECK(ritz_general_solve(Gr, false, &GP));
    RITZ_CHECK(ritz_general_transpose(&GP, &Y));
    return ritz_dense_mul(&s->V, &Y, other);
}

/* Say which requested vectors do not exist, and why. */
static void add_remark(const ritz_request *request, const one_sided *s,
                       ritz_basis *basis)
{
    const bool outputs = request->choice.gramian == RITZ_GRAMIAN_OUTPUTS;
    int64_t found = s->P.ncol + s->uncertain;
    char rounding[RITZ_NAME_SIZE] = "";
    char uncertain[RITZ_NAME_SIZE] = "";

    if (s->G.nrow < s->reached)
        snprintf(rounding, sizeof rounding,
                 ", %" PRId64 " of them above rounding", s->G.nrow);
    if (s->uncertain > 0)
        snprintf(uncertain, sizeof uncertain,
                 "; of the last %" PRId64 " rounding would decide",
                 s->uncertain);
    if (found < request->modes)
        snprintf(basis->remark, sizeof basis->remark,
                 "%" PRId64 " states asked for: the %s %" PRId64 " of %" PRId64
                 "%s; there are %" PRId64 "%s",
                 request->modes, outputs ? "outputs observe" : "inputs control",
                 s->reached, s->states, rounding, s->P.ncol, uncertain);
    else if (s->uncertain > 0)
        snprintf(basis->remark, sizeof basis->remark,
                 "the last %" PRId64 " state(s) left out: rounding would "
                 "decide on their stability",
                 s->uncertain);
}

/* Operator, vectors and bases, once the range of the Gramian is known. */
static ritz_status finish_one_sided(const ritz_request *request, one_sided *s,
                                    ritz_dense *own, ritz_dense *other)
{
    bool inverse = request->choice.inverse;
    RITZ_OWN(ritz_dense) Gr = {0};

    RITZ_CHECK(ritz_lanczos_operator(&s->A_r, &s->B_r, inverse, &s->G, &s->b));
    (void)count_accurate(&s->G, &s->b, HUGE_VAL, &s->rounding);
    RITZ_CHECK(find_vectors(request, s));
    RITZ_CHECK(drop_uncertain(s, &Gr));
    return find_bases(s, inverse, &Gr, own, other);
}

/*
 * State spaces. A dense one is converted to z' = E^-1 A z + E^-1 B u, and the
 * left basis becomes E^-T W at the end. The Gramian of a sparse one has a
 * factor of low rank (gramians/space.h) with residual R,
 *
 *     A W E' + E W A' + B B' = R,   W = Z Z',   Z = U Sigma
 *     Q = U Sigma,   V = E^-T U Sigma^-1,   V'E Q = I,
 *     V'A Q + (V'A Q)' + V'B B'V = V'R V
 *
 * so V'R V takes the place of the rounding error and is measured like it.
 */

/* E^-1 A - alpha I, E^-1 B and C of a dense state space. */
static ritz_status take_space(const ritz_state_space *model, double alpha,
                              ritz_states *out)
{
    out->alpha = alpha;
    out->count = model->A.nrow;
    RITZ_CHECK(ritz_dense_copy(&model->A, &out->A));
    RITZ_CHECK(ritz_dense_copy(&model->B, &out->B));
    RITZ_CHECK(ritz_dense_copy(&model->C, &out->C));
    if (model->E.val) {
        RITZ_CHECK_IN("E", ritz_general_solve(&model->E, false, &out->A));
        RITZ_CHECK_IN("E", ritz_general_solve(&model->E, false, &out->B));
    }
    for (int64_t k = 0; k < out->count; k++)
        ritz_dense_col(&out->A, k)[k] -= alpha;
    return RITZ_OK;
}

static ritz_status find_dense_bases(const ritz_request *request, double alpha,
                                    one_sided *s, ritz_dense *own,
                                    ritz_dense *other)
{
    const ritz_state_space *model = request->space;
    bool outputs = request->choice.gramian == RITZ_GRAMIAN_OUTPUTS;
    RITZ_OWN(ritz_states) states = {0};

    RITZ_CHECK(take_space(model, alpha, &states));
    RITZ_CHECK(start_one_sided(request, &states, s));
    RITZ_CHECK(check_poles(&states, s));
    RITZ_CHECK(find_range(request->tolerance, s));
    RITZ_CHECK(finish_one_sided(request, s, own, other));
    if (!model->E.val)
        return RITZ_OK;
    return ritz_general_solve(&model->E, true, outputs ? own : other);
}

/* The model with A - alpha E instead of A. */
static ritz_status shift_space(const ritz_state_space *model, double alpha,
                               const ritz_pencil *pencil, ritz_state_space *out)
{
    RITZ_OWN(ritz_sparse) A = {0};
    const ritz_io io = ritz_model_io(ritz_model_of_states(model));

    RITZ_CHECK(ritz_sparse_add(1.0, &pencil->A, -alpha, &pencil->E, &A));
    RITZ_CHECK(ritz_state_space_of_sparse(&A, &model->sE, &io, out));
    ritz_dense_put(&model->B, 0, 0, &out->B);
    ritz_dense_put(&model->C, 0, 0, &out->C);
    return RITZ_OK;
}

/* X := E^-1 X, or E^-T X if @p transposed. */
static ritz_status divide_descriptor(const ritz_pencil *pencil, bool transposed,
                                     ritz_dense *X)
{
    const ritz_sparse *const E[] = {&pencil->E};
    const double _Complex one[] = {1.0};
    RITZ_OWN(ritz_zldl) *F = NULL;
    RITZ_OWN_ARRAY double _Complex *x = NULL;
    int64_t size = X->nrow * X->ncol;

    if (pencil->plain)
        return RITZ_OK;
    RITZ_CHECK_NEW(x, size);
    for (int64_t k = 0; k < size; k++)
        x[k] = X->val[k];
    RITZ_CHECK(ritz_zldl_new(1, E, &F));
    RITZ_CHECK_IN("E", ritz_zldl_factor(F, one));
    RITZ_CHECK(ritz_zldl_solve(F, transposed, X->ncol, x));
    for (int64_t k = 0; k < size; k++)
        X->val[k] = creal(x[k]);
    return RITZ_OK;
}

/* Q, V, A_r and B_r from Z, whose columns are orthogonal, longest first. */
static ritz_status take_low_rank(const ritz_state_space *model,
                                 const ritz_pencil *pencil, bool outputs,
                                 double tolerance, const ritz_dense *Z,
                                 one_sided *s)
{
    RITZ_OWN(ritz_dense) AQ = {0}, B = {0};
    double longest = 0.0;

    RITZ_CHECK(ritz_dense_copy(Z, &s->V));
    for (int64_t j = 0; j < Z->ncol; j++) {
        double square = ritz_dense_dot(Z, j, Z, j);

        longest = fmax(longest, sqrt(square));
        if (!(sqrt(square) > tolerance * longest))
            break;
        for (int64_t i = 0; i < Z->nrow; i++)
            ritz_dense_col(&s->V, j)[i] /= square;
        s->reached++;
    }
    RITZ_REFUSE_IF(s->reached == 0, RITZ_ERR_ARGUMENT,
                   "no state is controllable, the Gramian is zero");
    s->V.ncol = s->reached;
    RITZ_CHECK(ritz_dense_columns(Z, 0, s->reached, &s->Q));
    RITZ_CHECK(divide_descriptor(pencil, !outputs, &s->V));
    RITZ_CHECK(
        ritz_sparse_mul(ritz_pencil_system(pencil, outputs), &s->Q, &AQ));
    RITZ_CHECK(ritz_dense_mul_tn(&s->V, &AQ, &s->A_r));
    RITZ_CHECK(outputs ? ritz_general_transpose(&model->C, &B)
                       : ritz_dense_copy(&model->B, &B));
    return ritz_dense_mul_tn(&s->V, &B, &s->B_r);
}

/* Keep the leading columns for which the residual is small relative to the
   least damping of the poles nearest to 0. */
static ritz_status cut_range(ritz_pencil *pencil, one_sided *s)
{
    enum { LOOKED_AT = 20 };
    RITZ_OWN(ritz_pencil_pairs) slow = {0};
    RITZ_OWN(ritz_dense) A = {0}, B = {0};
    double norm = 0.0;
    int64_t r = 0;

    RITZ_CHECK(ritz_space_slowest(pencil, LOOKED_AT, &slow));
    s->damping = HUGE_VAL;
    for (int64_t k = 0; k < slow.count; k++)
        s->damping = fmin(s->damping, -creal(slow.s[k]));
    r = count_accurate(&s->A_r, &s->B_r, RITZ_LANCZOS_SMALL * s->damping,
                       &norm);
    RITZ_REFUSE_IF(r == 0, RITZ_ERR_CONVERGENCE,
                   "the residual of the Gramian is as large as the least "
                   "damping");
    RITZ_CHECK(ritz_dense_block(&s->A_r, 0, r, 0, r, &A));
    RITZ_CHECK(ritz_dense_block(&s->B_r, 0, r, 0, s->B_r.ncol, &B));
    ritz_dense_replace(&s->A_r, &A);
    ritz_dense_replace(&s->B_r, &B);
    s->Q.ncol = s->V.ncol = r;
    return RITZ_OK;
}

static ritz_status find_sparse_bases(const ritz_request *request, double alpha,
                                     one_sided *s, ritz_dense *own,
                                     ritz_dense *other)
{
    bool outputs = request->choice.gramian == RITZ_GRAMIAN_OUTPUTS;
    RITZ_OWN(ritz_pencil) pencil = {0}, shifted = {0};
    RITZ_OWN(ritz_state_space) model = {0};
    RITZ_OWN(ritz_gramians) g = {0};

    RITZ_CHECK(ritz_pencil_of_space(request->space, &pencil));
    RITZ_CHECK(shift_space(request->space, alpha, &pencil, &model));
    RITZ_CHECK(ritz_pencil_of_space(&model, &shifted));
    RITZ_CHECK(ritz_gramians_space_low_rank(&model, RITZ_LANCZOS_RESIDUAL, &g));
    RITZ_REFUSE_IF(g.T.ncol > 0, RITZ_ERR_ARGUMENT,
                   "the Gramian is infinite: poles at 0 (%" PRId64
                   " of them) have no damping, give a shift above 0 Hz",
                   g.T.ncol);
    s->states = shifted.n;
    RITZ_CHECK(take_low_rank(&model, &shifted, outputs, request->tolerance,
                             outputs ? &g.Zo : &g.Zc, s));
    RITZ_CHECK(cut_range(&shifted, s));
    return finish_one_sided(request, s, own, other);
}

static ritz_status make_of_space(const ritz_request *request, ritz_basis *out)
{
    enum { USES = RITZ_USES_SHIFTS | RITZ_USES_GRAMIAN | RITZ_USES_OPERATOR };
    const ritz_choice *choice = &request->choice;
    const ritz_state_space *model = request->space;
    bool outputs = choice->gramian == RITZ_GRAMIAN_OUTPUTS;
    double alpha = 0.0;
    RITZ_OWN(one_sided) s = {0};
    RITZ_OWN(ritz_dense) own = {0}, other = {0};

    RITZ_CHECK(ritz_space_request(request, USES));
    RITZ_CHECK(ritz_lanczos_shift(choice, &alpha));
    RITZ_CHECK(ritz_ends_check("model", model->num_inputs, model->num_outputs,
                               model->limit, model->output));
    RITZ_CHECK((ritz_state_space_is_sparse(model)
                    ? find_sparse_bases
                    : find_dense_bases)(request, alpha, &s, &own, &other));
    RITZ_CHECK(ritz_space_basis(model, outputs ? &other : &own,
                                outputs ? &own : &other, out));
    snprintf(out->origin.engine, sizeof out->origin.engine,
             ritz_state_space_is_sparse(model) ? "ADI + MUMPS"
                                               : "dense LAPACK + SLICOT");
    add_remark(request, &s, out);
    return RITZ_OK;
}

static ritz_status make_one_sided(const ritz_request *request, ritz_basis *out)
{
    bool outputs = request->choice.gramian == RITZ_GRAMIAN_OUTPUTS;
    RITZ_OWN(ritz_states) states = {0};
    RITZ_OWN(one_sided) s = {0};
    RITZ_OWN(ritz_dense) own = {0}, other = {0};

    if (request->space)
        return make_of_space(request, out);
    RITZ_CHECK(ritz_lanczos_states(request, &states));
    RITZ_CHECK(start_one_sided(request, &states, &s));
    RITZ_CHECK(check_poles(&states, &s));
    RITZ_CHECK(find_range(request->tolerance, &s));
    RITZ_CHECK(finish_one_sided(request, &s, &own, &other));
    RITZ_CHECK(ritz_states_basis(&states, outputs ? &other : &own,
                                 outputs ? &own : &other, out));
    snprintf(out->origin.engine, sizeof out->origin.engine,
             "dense LAPACK + SLICOT");
    add_remark(request, &s, out);
    return RITZ_OK;
}

const ritz_method ritz_method_lanczos_one_sided = {
    .name = "lanczos-one-sided",
    .summary = "Lanczos vectors of states, stable by construction",
    .reference = "CraigSuKim1992",
    .when = "small damped models for control, in states; state spaces",
    .cost = "a dense Gramian: O(n^3), 1500 states; of sparse ones by ADI",
    .holds = "stability, whatever the order",
    .fails = "free bodies; states that are not controllable",
    .uses = RITZ_USES_MODES | RITZ_USES_SHIFTS | RITZ_USES_GRAMIAN |
            RITZ_USES_OPERATOR | RITZ_USES_DAMPING | RITZ_USES_SPACE,
    .make = make_one_sided,
};
