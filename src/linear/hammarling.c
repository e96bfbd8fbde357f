/*
 * Factors of Gramians. SLICOT leaves a triangle: U, W = U U', or of the
 * transposed equation U'U, for which the right hand side goes in as B'. Of a
 * pair in Schur form it takes the Schur vectors, here the identity.
 */
#include "base/alloc.h"
#include "linear/general.h"

/* Fortran names; character arguments bring their lengths at the end. */
void sb03od_(/* NOLINT: its name */ const char *dico, const char *fact,
             const char *trans, const int *n, const int *m, double *A,
             const int *lda, double *Q, const int *ldq, double *B,
             const int *ldb, double *scale, double *wr, double *wi,
             double *work, const int *ldwork, int *info, size_t dico_length,
             size_t fact_length, size_t trans_length);
void sg03bd_(/* NOLINT: its name */ const char *dico, const char *fact,
             const char *trans, const int *n, const int *m, double *A,
             const int *lda, double *E, const int *lde, double *Q,
             const int *ldq, double *Z, const int *ldz, double *B,
             const int *ldb, double *scale, double *alphar, double *alphai,
             double *beta, double *work, const int *ldwork, int *info,
             size_t dico_length, size_t fact_length, size_t trans_length);

/* Arguments of SLICOT, which it may overwrite. */
typedef struct equation {
    int n, m, ldb, room;
    bool schur, transposed;
    ritz_dense S, P, Q, Z, B;
    double *re, *im, *beta, *work;
    double scale;
} equation;

static void equation_free(equation *e)
{
    ritz_dense_free(&e->S);
    ritz_dense_free(&e->P);
    ritz_dense_free(&e->Q);
    ritz_dense_free(&e->Z);
    ritz_dense_free(&e->B);
    RITZ_FREE(e->re, e->im, e->beta, e->work);
}

static ritz_status copy_right_side(const ritz_dense *B, equation *e)
{
    int64_t wide = e->m > e->n ? e->m : e->n;

    e->ldb = e->transposed ? (int)wide : e->n;
    RITZ_CHECK(ritz_dense_new(e->ldb, wide, &e->B));
    for (int64_t j = 0; j < B->ncol; j++)
        for (int64_t i = 0; i < B->nrow; i++)
            if (e->transposed)
                ritz_dense_col(&e->B, i)[j] = ritz_dense_col(B, j)[i];
            else
                ritz_dense_col(&e->B, j)[i] = ritz_dense_col(B, j)[i];
    return RITZ_OK;
}

static ritz_status prepare_equation(const ritz_dense *S, const ritz_dense *P,
                                    const ritz_dense *B, equation *e)
{
    e->n = (int)S->nrow;
    e->m = (int)B->ncol;
    e->room = e->schur ? 64 * (e->n + e->m) + 64 : 128 * e->n + e->m;
    RITZ_CHECK(ritz_dense_copy(S, &e->S));
    RITZ_CHECK(ritz_dense_identity(e->n, &e->Q));
    if (P->val) {
        RITZ_CHECK(ritz_dense_copy(P, &e->P));
        RITZ_CHECK(ritz_dense_identity(e->n, &e->Z));
    }
    RITZ_CHECK(copy_right_side(B, e));
    RITZ_CHECK_NEW(e->re, e->n);
    RITZ_CHECK_NEW(e->im, e->n);
    RITZ_CHECK_NEW(e->beta, e->n);
    RITZ_CHECK_NEW(e->work, e->room);
    return RITZ_OK;
}

static ritz_status solve_equation(equation *e)
{
    const char *trans = e->transposed ? "N" : "T";
    const char *fact = e->schur ? "F" : "N";
    int n = e->n;
    int unstable = e->P.val ? 5 : 3;
    int info = 0;

    if (e->P.val)
        sg03bd_("C", fact, trans, &n, &e->m, e->S.val, &n, e->P.val, &n,
                e->Q.val, &n, e->Z.val, &n, e->B.val, &e->ldb, &e->scale, e->re,
                e->im, e->beta, e->work, &e->room, &info, 1, 1, 1);
    else
        sb03od_("C", fact, trans, &n, &e->m, e->S.val, &n, e->Q.val, &n,
                e->B.val, &e->ldb, &e->scale, e->re, e->im, e->work, &e->room,
                &info, 1, 1, 1);
    RITZ_REFUSE_IF(info == unstable || (!e->P.val && info == 2),
                   RITZ_ERR_ARGUMENT,
                   "a Gramian is infinite: a pole is not stable");
    RITZ_REFUSE_IF(
        info < 0 || info > 1 || e->scale == 0.0, RITZ_ERR_CONVERGENCE,
        "the Lyapunov equation was not solved, SLICOT says %d", info);
    return RITZ_OK;
}

static ritz_status take_triangle(const equation *e, ritz_dense *F)
{
    RITZ_CHECK(ritz_dense_new(e->n, e->n, F));
    for (int64_t j = 0; j < e->n; j++)
        for (int64_t i = 0; i <= j; i++) {
            double u = ritz_dense_col(&e->B, j)[i] / e->scale;

            if (e->transposed)
                ritz_dense_col(F, i)[j] = u;
            else
                ritz_dense_col(F, j)[i] = u;
        }
    return RITZ_OK;
}

static ritz_status find_factor(const ritz_dense *S, const ritz_dense *P,
                               const ritz_dense *B, equation *e, ritz_dense *F)
{
    if (S->nrow == 0 || B->ncol == 0)
        return ritz_dense_new(S->nrow, S->nrow, F);
    RITZ_CHECK(prepare_equation(S, P, B, e));
    RITZ_CHECK(solve_equation(e));
    return take_triangle(e, F);
}

ritz_status ritz_general_hammarling(const ritz_dense *S, const ritz_dense *P,
                                    bool transposed, const ritz_dense *B,
                                    ritz_dense *F)
{
    RITZ_OWN(equation)
    e = {.schur = true, .transposed = transposed, .scale = 1.0};

    return find_factor(S, P, B, &e, F);
}

ritz_status ritz_general_gramian(const ritz_dense *A, const ritz_dense *B,
                                 ritz_dense *U)
{
    RITZ_OWN(equation) e = {.scale = 1.0};

    return find_factor(A, &(ritz_dense){0}, B, &e, U);
}
