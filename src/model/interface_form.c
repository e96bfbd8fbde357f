#include "model/interface_form.h"
#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"
#include "model/equations.h"
#include "model/modal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void ritz_interface_form_free(ritz_interface_form *form)
{
    RITZ_FREE(form->grid, form->position, form->port, form->hertz);
    ritz_dense_free(&form->V);
    ritz_dense_free(&form->K);
    ritz_dense_free(&form->M);
    ritz_dense_free(&form->D);
    *form = (ritz_interface_form){0};
}

/* ---- the grids of the interface ----------------------------------------- */

static bool is_constraint(const ritz_reduced *reduced, int64_t j)
{
    return reduced->columns.kind[j] == RITZ_COLUMN_CONSTRAINT;
}

/* Whether constraint modes alone move a port, or there are none. */
static bool is_attached(const ritz_reduced *reduced, const ritz_port_map *port)
{
    bool moves = false, any = false;

    for (int64_t j = 0; j < reduced->K.ncol; j++) {
        any = any || is_constraint(reduced, j);
        moves = moves || (!is_constraint(reduced, j) &&
                          ritz_dense_col_max(&port->map, j) != 0.0);
    }
    return !any || !moves;
}

static bool has_grid(const ritz_interface_form *form, int64_t grid)
{
    for (int64_t k = 0; k < form->count; k++)
        if (form->grid[k] == grid)
            return true;
    return false;
}

static bool has_motions(const ritz_port_map *port, int64_t first)
{
    for (int64_t i = 0; i < RITZ_FRAME_MOTIONS; i++)
        if (first + i >= port->count ||
            port->dof[first + i].grid != port->dof[first].grid ||
            port->dof[first + i].component != i + 1)
            return false;
    return true;
}

/* Append the grids of a port that the form does not have yet, and their rows of
   T_b. The rows of a port are in the order of its grids. */
static ritz_status add_port(const ritz_port_map *port,
                            ritz_interface_form *form, ritz_dense *T_b)
{
    for (int64_t i = 0; i < port->count; i += RITZ_FRAME_MOTIONS) {
        const int64_t at = form->count;

        RITZ_REFUSE_IF(!has_motions(port, i), RITZ_ERR_ARGUMENT,
                       "grid %lld of port '%s' does not have all six motions: "
                       "tie what is joined to one grid by an RBE2 or RBE3 in "
                       "the deck, and import that grid as the port",
                       (long long)port->dof[i].grid, port->name);
        if (has_grid(form, port->dof[i].grid))
            continue;
        form->grid[at] = port->dof[i].grid;
        memcpy(form->position + 3 * at, port->position + 3 * i,
               3 * sizeof *form->position);
        memcpy(form->port[at], port->name, sizeof port->name);
        for (int64_t j = 0; j < T_b->ncol; j++)
            memcpy(ritz_dense_col(T_b, j) + RITZ_FRAME_MOTIONS * at,
                   ritz_dense_col(&port->map, j) + i,
                   RITZ_FRAME_MOTIONS * sizeof *T_b->val);
        form->count++;
    }
    return RITZ_OK;
}

/* The port of the first of names with commas between them; *names is moved to
   the next. */
static const ritz_port_map *take_port(const ritz_reduced *reduced,
                                      const char **names)
{
    const size_t length = strcspn(*names, ",");
    char name[RITZ_NAME_SIZE];

    snprintf(name, sizeof name, "%.*s", (int)length, *names);
    *names += length + ((*names)[length] != '\0');
    return ritz_reduced_port(reduced, name);
}

static ritz_status add_ports(const ritz_reduced *reduced, const char *ports,
                             ritz_interface_form *form, ritz_dense *T_b)
{
    for (int64_t k = 0; !ports && k < reduced->num_ports; k++)
        if (is_attached(reduced, &reduced->port[k]))
            RITZ_CHECK(add_port(&reduced->port[k], form, T_b));
    while (ports && *ports) {
        const ritz_port_map *port = take_port(reduced, &ports);

        if (!port)
            return RITZ_ERR_ARGUMENT;
        RITZ_CHECK(add_port(port, form, T_b));
    }
    return RITZ_OK;
}

/* The grids, and T_b of the head. */
static ritz_status list_motions(const ritz_reduced *reduced, const char *ports,
                                ritz_interface_form *form, ritz_dense *out)
{
    const int64_t r = reduced->K.ncol;
    RITZ_OWN(ritz_dense) T_b = {0};
    int64_t most = 0;

    for (int64_t k = 0; k < reduced->num_ports; k++)
        most += reduced->port[k].count;
    RITZ_CHECK_NEW(form->grid, most);
    RITZ_CHECK_NEW(form->position, 3 * most);
    RITZ_CHECK_NEW(form->port, most);
    RITZ_CHECK(ritz_dense_new(most + RITZ_FRAME_MOTIONS, r, &T_b));
    RITZ_CHECK(add_ports(reduced, ports, form, &T_b));
    RITZ_REFUSE_IF(form->count == 0, RITZ_ERR_ARGUMENT,
                   "the component has no port by which others could hold it: "
                   "import with --port");
    RITZ_REFUSE_IF(RITZ_FRAME_MOTIONS * form->count > r, RITZ_ERR_ARGUMENT,
                   "%lld coordinates cannot hold the six motions of %lld grids",
                   (long long)r, (long long)form->count);
    return ritz_dense_block(&T_b, 0, RITZ_FRAME_MOTIONS * form->count, 0, r,
                            out);
}

/* ---- constraint modes are there already --------------------------------- */

/* Whether K_bm = 0: no column bends as the interface moves. Columns of rubin do,
   and with them at rest the body resists a rigid motion of its interface. */
static bool is_static(const ritz_reduced *reduced)
{
    const ritz_dense *K = &reduced->K;

    for (int64_t j = 0; j < K->ncol; j++)
        for (int64_t i = 0; i < K->nrow && !is_constraint(reduced, j); i++) {
            const double own =
                sqrt(fabs(ritz_dense_col(K, i)[i] * ritz_dense_col(K, j)[j]));

            if (is_constraint(reduced, i) &&
                fabs(ritz_dense_col(K, j)[i]) > RITZ_FOREIGN_INTERFACE * own)
                return false;
        }
    return true;
}

/* Whether T_b = [P, 0] with P orthogonal, of constraint modes. */
static ritz_status find_turned(const ritz_reduced *reduced,
                               const ritz_dense *T_b, bool *out)
{
    RITZ_OWN(ritz_dense) square = {0};
    int64_t constraints = 0;

    *out = false;
    for (int64_t j = 0; j < T_b->ncol; j++) {
        constraints += is_constraint(reduced, j);
        if (!is_constraint(reduced, j) && ritz_dense_col_max(T_b, j) != 0.0)
            return RITZ_OK;
    }
    if (constraints != T_b->nrow || !is_static(reduced))
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_mul_nt(T_b, T_b, &square));
    for (int64_t i = 0; i < square.nrow; i++)
        ritz_dense_col(&square, i)[i] -= 1.0;
    *out = ritz_dense_max(&square) <= RITZ_NEGLIGIBLE;
    return RITZ_OK;
}

/* V = [P', 0; 0, I], rows in the order of the columns of the basis. */
static ritz_status order_columns(const ritz_reduced *reduced,
                                 const ritz_dense *T_b, ritz_dense *V)
{
    int64_t next = T_b->nrow;

    RITZ_CHECK(ritz_dense_new(T_b->ncol, T_b->ncol, V));
    for (int64_t j = 0; j < T_b->ncol; j++)
        if (is_constraint(reduced, j))
            for (int64_t i = 0; i < T_b->nrow; i++)
                ritz_dense_col(V, i)[j] = ritz_dense_col(T_b, j)[i];
        else
            ritz_dense_col(V, next++)[j] = 1.0;
    return RITZ_OK;
}

/* ---- any other basis ---------------------------------------------------- */

static double invert_or_one(double value)
{
    return value > 0.0 ? 1.0 / value : 1.0;
}

/*
 * c_j of column j, so that c_j^2 M_jj = 1. The largest entry in T_b of a column
 * would not do: if the column leaves the interface at rest, it is rounding, as
 * of the Krylov vectors of krylov-cms-free. A column without mass has no other
 * scale.
 */
static double scale_of(const ritz_dense *M, const ritz_dense *T_b, int64_t j)
{
    const double m = ritz_dense_col(M, j)[j];

    return m > 0.0 ? 1.0 / sqrt(m) : invert_or_one(ritz_dense_col_max(T_b, j));
}

/*
 * T_b^+ and N from the singular value decomposition of diag(a) T_b diag(c).
 * Columns, which have units of their own, are scaled to a mass of 1, and rows,
 * which are lengths and angles, to have the largest entry 1.
 */
static ritz_status divide_space(const ritz_dense *M, const ritz_dense *T_b,
                                ritz_dense *inverse, ritz_dense *N)
{
    const int64_t p = T_b->nrow, r = T_b->ncol;
    RITZ_OWN_ARRAY double *a = NULL, *c = NULL, *s = NULL;
    RITZ_OWN(ritz_dense) A = {0}, U = {0}, W = {0}, head = {0};

    RITZ_CHECK_NEW(a, p);
    RITZ_CHECK_NEW(c, r);
    RITZ_CHECK(ritz_dense_copy(T_b, &A));
    for (int64_t j = 0; j < r; j++) {
        c[j] = scale_of(M, T_b, j);
        for (int64_t i = 0; i < p; i++) {
            ritz_dense_col(&A, j)[i] *= c[j];
            a[i] = fmax(a[i], fabs(ritz_dense_col(&A, j)[i]));
        }
    }
    for (int64_t i = 0; i < p; i++)
        a[i] = invert_or_one(a[i]);
    ritz_dense_scale_rows(a, &A);
    RITZ_CHECK(ritz_general_svd(&A, &U, &s, &W));
    RITZ_REFUSE_IF(s[p - 1] <= RITZ_NEGLIGIBLE * s[0], RITZ_ERR_ARGUMENT,
                   "the motions of the ports depend on each other in this "
                   "basis: name fewer ports with --port, or keep more modes");
    ritz_dense_scale_rows(c, &W);
    RITZ_CHECK(ritz_dense_columns(&W, p, r - p, N));
    RITZ_CHECK(ritz_dense_columns(&W, 0, p, &head));
    for (int64_t j = 0; j < p; j++)
        for (int64_t i = 0; i < r; i++)
            ritz_dense_col(&head, j)[i] /= s[j];
    ritz_dense_scale_rows(a, &U);
    return ritz_dense_mul_nt(&head, &U, inverse);
}

/* N := N Y, the modes of the body whose interface is held. */
static ritz_status find_held_modes(const ritz_structure *model, ritz_dense *N,
                                   ritz_pairs *pairs)
{
    RITZ_OWN(ritz_dense) K = {0}, M = {0};

    RITZ_CHECK(ritz_dense_congruence(&model->K, N, &K));
    RITZ_CHECK(ritz_dense_congruence(&model->M, N, &M));
    RITZ_CHECK(ritz_eigen_dense(&K, &M, pairs));
    RITZ_REFUSE_IF(pairs->Phi.ncol < N->ncol, RITZ_ERR_ARGUMENT,
                   "%lld coordinates have no mass while the ports are held: "
                   "reduce by a method whose columns all have mass",
                   (long long)(N->ncol - pairs->Phi.ncol));
    return ritz_dense_times(&pairs->Phi, N);
}

/* X -= N diag(1 / lambda) N'K X; of modes without stiffness N'K = 0. */
static ritz_status relax(const ritz_structure *model, const ritz_dense *N,
                         const ritz_pairs *pairs, ritz_dense *X)
{
    RITZ_OWN(ritz_dense) KX = {0}, share = {0}, step = {0};

    RITZ_CHECK(ritz_dense_mul(&model->K, X, &KX));
    RITZ_CHECK(ritz_dense_mul_tn(N, &KX, &share));
    for (int64_t j = 0; j < share.ncol; j++)
        for (int64_t i = 0; i < share.nrow; i++)
            ritz_dense_col(&share, j)[i] *=
                i < pairs->num_rigid ? 0.0 : 1.0 / pairs->lambda[i];
    RITZ_CHECK(ritz_dense_mul(N, &share, &step));
    ritz_dense_add(-1.0, &step, X);
    return RITZ_OK;
}

/* ---- rigid motion of all of it ------------------------------------------- */

/* Row of R, which are rigid motions about the basic origin, for direction c of
   a grid at x, put into row `to` of out. */
static void put_rigid(const double *x, int64_t c, int64_t to, ritz_dense *out)
{
    static const double origin[3];
    double place[3] = {x[0], x[1], x[2]};
    double axes[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    int64_t frame = 0;
    const ritz_grids grids = {.position = place, .axes = axes, .frame = &frame};
    double motion[RITZ_FRAME_MOTIONS];

    ritz_tie_row(&grids, 0, c, origin, motion);
    for (int64_t j = 0; j < RITZ_FRAME_MOTIONS; j++)
        ritz_dense_col(out, j)[to] = motion[j];
}

/* R of the frames, and zeros up to `rows`. */
static ritz_status move_rigidly(const ritz_interface_form *form, int64_t rows,
                                ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(rows, RITZ_FRAME_MOTIONS, out));
    for (int64_t k = 0; k < RITZ_FRAME_MOTIONS * form->count; k++)
        put_rigid(form->position + 3 * (k / RITZ_FRAME_MOTIONS),
                  1 + k % RITZ_FRAME_MOTIONS, k, out);
    return RITZ_OK;
}

/* B = T_p N_0 and R = R_p - T_p q over rows p of all ports. */
static ritz_status list_lags(const ritz_reduced *reduced, const ritz_dense *N_0,
                             const ritz_dense *q, ritz_dense *B, ritz_dense *R)
{
    int64_t rows = 0, n = 0;

    for (int64_t k = 0; k < reduced->num_ports; k++)
        rows += reduced->port[k].count;
    RITZ_CHECK(ritz_dense_new(rows, N_0->ncol, B));
    RITZ_CHECK(ritz_dense_new(rows, RITZ_FRAME_MOTIONS, R));
    for (int64_t k = 0; k < reduced->num_ports; k++) {
        const ritz_port_map *port = &reduced->port[k];
        RITZ_OWN(ritz_dense) loose = {0}, there = {0};

        RITZ_CHECK(ritz_dense_mul(&port->map, N_0, &loose));
        RITZ_CHECK(ritz_dense_mul(&port->map, q, &there));
        ritz_dense_put(&loose, n, 0, B);
        for (int64_t i = 0; i < port->count; i++) {
            if (port->dof[i].component > 0)
                put_rigid(port->position + 3 * i, port->dof[i].component, n + i,
                          R);
            for (int64_t j = 0; j < RITZ_FRAME_MOTIONS; j++)
                ritz_dense_col(R, j)[n + i] -= ritz_dense_col(&there, j)[i];
        }
        n += port->count;
    }
    return RITZ_OK;
}

/* A = (B'B)^+ B'R: motions that no port shows stay as they are. */
static ritz_status fit_ports(const ritz_reduced *reduced, const ritz_dense *N_0,
                             const ritz_dense *q, ritz_dense *A)
{
    RITZ_OWN(ritz_dense) B = {0}, R = {0}, square = {0}, right = {0};
    RITZ_OWN(ritz_dense) U = {0}, V = {0}, part = {0};
    RITZ_OWN_ARRAY double *s = NULL;

    RITZ_CHECK(list_lags(reduced, N_0, q, &B, &R));
    RITZ_CHECK(ritz_dense_mul_tn(&B, &B, &square));
    RITZ_CHECK(ritz_dense_mul_tn(&B, &R, &right));
    RITZ_CHECK(ritz_general_svd(&square, &U, &s, &V));
    for (int64_t k = N_0->ncol - 1; k >= 0; k--)
        s[k] = s[k] > RITZ_NEGLIGIBLE * s[0] ? 1.0 / s[k] : 0.0;
    RITZ_CHECK(ritz_dense_mul_tn(&U, &right, &part));
    ritz_dense_scale_rows(s, &part);
    return ritz_dense_mul(&V, &part, A);
}

/* A = N_0'M (q_R - q) if M q_R, the momentum of rigid motion, is known. */
static ritz_status fit_momentum(const ritz_reduced *reduced,
                                const ritz_structure *model,
                                const ritz_dense *N_0, const ritz_dense *q,
                                ritz_dense *A)
{
    RITZ_OWN(ritz_dense) L = {0}, Mq = {0}, own = {0};

    RITZ_CHECK(ritz_dense_mul(&reduced->invariants.momentum, N_0, &L));
    RITZ_CHECK(ritz_general_transpose(&L, A));
    RITZ_CHECK(ritz_dense_mul(&model->M, q, &Mq));
    RITZ_CHECK(ritz_dense_mul_tn(N_0, &Mq, &own));
    ritz_dense_add(-1.0, &own, A);
    return RITZ_OK;
}

/*
 * Motions N_0 without stiffness, as of a hinge, may be a part of X: it becomes
 * X + N_0 A R^+, so that the frames' rigid motion R moves all of the body as a
 * rigid one. R'MR is then its mass.
 */
static ritz_status carry_loose(const ritz_reduced *reduced,
                               const ritz_structure *model,
                               const ritz_dense *N_0,
                               const ritz_interface_form *form, ritz_dense *X)
{
    RITZ_OWN(ritz_dense) R = {0}, q = {0}, A = {0};
    RITZ_OWN(ritz_dense) square = {0}, inverse = {0}, share = {0}, step = {0};

    if (N_0->ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(move_rigidly(form, X->ncol, &R));
    RITZ_CHECK(ritz_dense_mul(X, &R, &q));
    RITZ_CHECK(reduced->invariants.momentum.val
                   ? fit_momentum(reduced, model, N_0, &q, &A)
                   : fit_ports(reduced, N_0, &q, &A));
    RITZ_CHECK(ritz_dense_mul_tn(&R, &R, &square));
    RITZ_CHECK(ritz_general_transpose(&R, &inverse));
    RITZ_CHECK(ritz_general_solve_scaled(&square, false, &inverse));
    RITZ_CHECK(ritz_dense_mul(&A, &inverse, &share));
    RITZ_CHECK(ritz_dense_mul(N_0, &share, &step));
    ritz_dense_add(1.0, &step, X);
    return RITZ_OK;
}

static ritz_status make_columns(const ritz_reduced *reduced,
                                const ritz_structure *model,
                                const ritz_dense *T_b,
                                ritz_interface_form *form)
{
    RITZ_OWN(ritz_dense) X = {0}, N = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    ritz_dense N_0 = {0}; /* borrowed */

    RITZ_CHECK(divide_space(&model->M, T_b, &X, &N));
    RITZ_CHECK_NEW(form->hertz, N.ncol);
    if (N.ncol > 0) {
        RITZ_CHECK(find_held_modes(model, &N, &pairs));
        /* the second time removes what rounding left of the first */
        RITZ_CHECK(relax(model, &N, &pairs, &X));
        RITZ_CHECK(relax(model, &N, &pairs, &X));
        N_0 = ritz_dense_part(&N, 0, pairs.num_rigid);
        RITZ_CHECK(carry_loose(reduced, model, &N_0, form, &X));
    }
    form->num_loose = pairs.num_rigid;
    for (int64_t k = pairs.num_rigid; k < N.ncol; k++)
        form->hertz[k] = ritz_eigen_hertz(pairs.lambda[k]);
    return ritz_dense_beside(&X, &N, &form->V);
}

ritz_status ritz_interface_form_of(const ritz_reduced *reduced,
                                   const char *ports, ritz_interface_form *out)
{
    RITZ_OWN(ritz_interface_form) form = {0};
    RITZ_OWN(ritz_structure) model = {0};
    RITZ_OWN(ritz_dense) T_b = {0};
    ritz_damping damping = {0};

    RITZ_CHECK(list_motions(reduced, ports, &form, &T_b));
    RITZ_CHECK(ritz_structure_of_reduced(reduced, &model));
    RITZ_CHECK(ritz_damping_parse(reduced->damping, &damping));
    RITZ_CHECK_IN("damping", ritz_modal_damping(&model, &damping, &model.D));
    RITZ_CHECK(find_turned(reduced, &T_b, &form.kept));
    RITZ_CHECK(form.kept ? order_columns(reduced, &T_b, &form.V)
                         : make_columns(reduced, &model, &T_b, &form));
    RITZ_CHECK(ritz_dense_congruence(&model.K, &form.V, &form.K));
    RITZ_CHECK(ritz_dense_congruence(&model.M, &form.V, &form.M));
    if (model.D.val)
        RITZ_CHECK(ritz_dense_project(&model.D, &form.V, &form.D));
    RITZ_MOVE(*out, form);
    return RITZ_OK;
}

ritz_status ritz_interface_form_ground(const ritz_interface_form *form,
                                       ritz_interface_ground *out)
{
    RITZ_OWN(ritz_dense) R = {0}, K = {0}, M = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    *out = (ritz_interface_ground){0};
    RITZ_CHECK(move_rigidly(form, form->K.ncol, &R));
    RITZ_CHECK(ritz_dense_congruence(&form->K, &R, &K));
    RITZ_CHECK(ritz_dense_congruence(&form->M, &R, &M));
    for (int64_t j = 0; j < RITZ_FRAME_MOTIONS; j++) {
        const double mass = ritz_dense_col(&M, j)[j];
        const double stiffness = fabs(ritz_dense_col(&K, j)[j]);

        if (mass > 0.0)
            out->rigid_hz =
                fmax(out->rigid_hz, ritz_eigen_hertz(stiffness / mass));
    }
    RITZ_CHECK(ritz_eigen_dense(&form->K, &form->M, &pairs));
    if (pairs.num_rigid < pairs.Phi.ncol) /* negative where K is indefinite */
        out->flexible_hz =
            fabs(ritz_eigen_hertz(pairs.lambda[pairs.num_rigid]));
    out->holds = out->rigid_hz > RITZ_HELD * out->flexible_hz;
    return RITZ_OK;
}

ritz_status ritz_interface_form_modes(const ritz_interface_form *form,
                                      ritz_pairs *out)
{
    const int64_t first = RITZ_FRAME_MOTIONS * form->count;
    const int64_t m = form->K.ncol - first;
    RITZ_OWN(ritz_dense) K = {0}, M = {0};

    RITZ_CHECK(ritz_dense_block(&form->K, first, m, first, m, &K));
    RITZ_CHECK(ritz_dense_block(&form->M, first, m, first, m, &M));
    return ritz_eigen_dense(&K, &M, out);
}
