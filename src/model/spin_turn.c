/*
 * Stiffness of the rotation of a body that spins. A mass dm at a from the point
 * whose translation is a coordinate moves, for the rotation vector theta, by
 *
 *     theta x a + theta x (theta x a) / 2 + ...
 *
 * At W = 1 the centrifugal force on it is f = (I - n n') x dm, x its position
 * from the axis. The work of f on the second term is -theta'K theta / 2 with
 *
 *     K = tr(B) I - (B + B') / 2,    B = sum f a'
 *
 * S has the first term alone. With o a point of the axis, p the point that a is
 * measured from, m and c the mass and its centre, and J the inertia about c,
 *
 *     B = (I - n n') (tr(J) / 2 I - J + m (c - o) (c - p)')
 *
 * of the mass of the body. A body that hangs outboard adds its own force, at
 * the port that holds it. The tests compare K with the potential of mass points
 * that turn by finite angles.
 */
#include "model/spin.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "base/vector.h"
#include "linear/general.h"

#include <math.h>

void ritz_spin_add_mass(const ritz_inertia *of, const double axis[static 3],
                        const double through[static 3],
                        const double from[static 3], double B[static 9])
{
    const double *c = of->centre, *n = axis, *o = through, *p = from;
    const double trace = 0.5 * (of->tensor[0] + of->tensor[4] + of->tensor[8]);
    double A[3][3];

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            A[i][j] = (i == j ? trace : 0.0) - of->tensor[3 * i + j] +
                      of->mass * (c[i] - o[i]) * (c[j] - p[j]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            B[3 * i + j] += A[i][j];
            for (int k = 0; k < 3; k++)
                B[3 * i + j] -= n[i] * n[k] * A[k][j];
        }
}

ritz_status ritz_spin_add_turn(const double B[static 9],
                               const ritz_dense *motion, ritz_dense *KG)
{
    const double trace = B[0] + B[4] + B[8];
    RITZ_OWN(ritz_dense) A = {0}, part = {0};

    RITZ_CHECK(ritz_dense_new(6, 6, &A));
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            ritz_dense_col(&A, 3 + j)[3 + i] =
                (i == j ? trace : 0.0) - 0.5 * (B[3 * i + j] + B[3 * j + i]);
    RITZ_CHECK(ritz_dense_congruence(&A, motion, &part));
    if (!KG->val)
        RITZ_CHECK(ritz_dense_new(part.nrow, part.ncol, KG));
    ritz_dense_add(1.0, &part, KG);
    return RITZ_OK;
}

/* ---- motion of a body as a rigid one ------------------------------------ */

/*
 * Normal equations N [u; size theta] = y of a rigid motion, u being the
 * translation of the point `from`.
 */
typedef struct rigid_fit {
    double from[3], size;
    ritz_dense N, y; /* 6 x 6, 6 x r */
} rigid_fit;

static void rigid_fit_free(rigid_fit *fit)
{
    ritz_dense_free(&fit->N);
    ritz_dense_free(&fit->y);
}

/* Largest distance of a grid of the ports, or of the mass, from the point; 1 if
   all are there. */
static double size_of(const ritz_reduced *body, const double from[3])
{
    const ritz_inertia *of = &body->inertia;
    double size = 0.0, a[3];

    for (int64_t p = 0; p < body->num_ports; p++)
        for (int64_t k = 0; k < body->port[p].count; k++) {
            for (int i = 0; i < 3; i++)
                a[i] = body->port[p].position[3 * k + i] - from[i];
            size = fmax(size, sqrt(ritz_dot(a, a)));
        }
    for (int i = 0; i < 3; i++)
        a[i] = of->centre[i] - from[i];
    size = fmax(size, sqrt(ritz_dot(a, a)));
    return size > 0.0 ? size : 1.0;
}

/* Row of R, unit rigid motions about `from`, for a dof of a grid; rotations are
   times the size. */
static bool rigid_row(const rigid_fit *fit, int64_t component, const double *x,
                      double row[6])
{
    const int64_t a = component - 1;

    memset(row, 0, 6 * sizeof *row);
    if (component == 0)
        return false;
    if (component > 3) { /* size theta */
        row[a] = 1.0;
        return true;
    }
    row[a] = 1.0; /* u + theta x (x - from) */
    row[3 + (a + 1) % 3] =
        (x[(a + 2) % 3] - fit->from[(a + 2) % 3]) / fit->size;
    row[3 + (a + 2) % 3] =
        -(x[(a + 1) % 3] - fit->from[(a + 1) % 3]) / fit->size;
    return true;
}

static void fit_port(const ritz_port_map *port, rigid_fit *fit)
{
    for (int64_t k = 0; k < port->count; k++) {
        double row[6];
        const double scale = port->dof[k].component > 3 ? fit->size : 1.0;

        if (!rigid_row(fit, port->dof[k].component, port->position + 3 * k,
                       row))
            continue;
        for (int64_t j = 0; j < 6; j++)
            for (int64_t i = 0; i < 6; i++)
                ritz_dense_col(&fit->N, j)[i] += row[i] * row[j];
        for (int64_t j = 0; j < fit->y.ncol; j++)
            for (int64_t i = 0; i < 6; i++)
                ritz_dense_col(&fit->y, j)[i] +=
                    scale * row[i] * ritz_dense_col(&port->map, j)[k];
    }
}

/* X: rigid motions about the basic origin by those about `from`. */
static ritz_status shift_origin(const rigid_fit *fit, ritz_dense *X)
{
    const double *p = fit->from;
    const double s = 1.0 / fit->size;
    const double cross[3][3] = {{0.0, -p[2] * s, p[1] * s},
                                {p[2] * s, 0.0, -p[0] * s},
                                {-p[1] * s, p[0] * s, 0.0}};

    RITZ_CHECK(ritz_dense_identity(6, X));
    for (int j = 0; j < 3; j++) {
        ritz_dense_col(X, 3 + j)[3 + j] = s;
        for (int i = 0; i < 3; i++)
            ritz_dense_col(X, 3 + j)[i] = cross[i][j];
    }
    return RITZ_OK;
}

/* The kinetic energy of a rigid motion, X'R'MR X, and momentum, X'R'MT. */
static ritz_status shift_inertia(const rigid_fit *fit, const ritz_reduced *body,
                                 ritz_dense *RMR, ritz_dense *RMT)
{
    RITZ_OWN(ritz_dense) X = {0}, rigid = {0};

    RITZ_CHECK(shift_origin(fit, &X));
    RITZ_CHECK(ritz_dense_new(6, 6, &rigid));
    memcpy(rigid.val, body->invariants.rigid, sizeof body->invariants.rigid);
    RITZ_CHECK(ritz_dense_congruence(&rigid, &X, RMR));
    return ritz_dense_mul_tn(&X, &body->invariants.momentum, RMT);
}

/* Least motion that solves the normal equations; theta in rad. */
static ritz_status solve_fit(const rigid_fit *fit, ritz_dense *motion)
{
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_dense) part = {0};

    RITZ_CHECK(ritz_general_symmetric(&fit->N, &pairs));
    RITZ_CHECK(ritz_dense_mul_tn(&pairs.Phi, &fit->y, &part));
    for (int64_t j = 0; j < part.ncol; j++)
        for (int64_t i = 0; i < 6; i++) {
            const bool known =
                pairs.lambda[i] > RITZ_SQUARED_DEPENDENT * pairs.lambda[5];

            ritz_dense_col(&part, j)[i] *= known ? 1.0 / pairs.lambda[i] : 0.0;
        }
    RITZ_CHECK(ritz_dense_mul(&pairs.Phi, &part, motion));
    return RITZ_OK;
}

static ritz_status begin_fit(const ritz_reduced *body, const double from[3],
                             rigid_fit *fit)
{
    memcpy(fit->from, from, sizeof fit->from);
    fit->size = size_of(body, from);
    RITZ_CHECK(ritz_dense_new(6, 6, &fit->N));
    return ritz_dense_new(6, body->M.ncol, &fit->y);
}

/* Divide rotations by the size. */
static void unscale_motion(const rigid_fit *fit, ritz_dense *motion)
{
    for (int64_t j = 0; j < motion->ncol; j++)
        for (int64_t i = 3; i < 6; i++)
            ritz_dense_col(motion, j)[i] /= fit->size;
}

ritz_status ritz_spin_port_motion(const ritz_reduced *body,
                                  const ritz_port_map *port,
                                  const double from[static 3], ritz_dense *out)
{
    RITZ_OWN(rigid_fit) fit = {0};
    RITZ_OWN(ritz_dense) motion = {0};

    RITZ_CHECK(begin_fit(body, from, &fit));
    fit_port(port, &fit);
    RITZ_CHECK(solve_fit(&fit, &motion));
    unscale_motion(&fit, &motion);
    RITZ_MOVE(*out, motion);
    return RITZ_OK;
}

ritz_status ritz_spin_rigid_motion(const ritz_reduced *body,
                                   const double from[static 3], bool *rigid,
                                   ritz_dense *out)
{
    RITZ_OWN(rigid_fit) fit = {0};
    RITZ_OWN(ritz_dense) motion = {0}, RMR = {0}, RMT = {0}, M = {0};

    *rigid = false;
    if (body->M.ncol > 6 || !body->invariants.momentum.val)
        return RITZ_OK;
    RITZ_CHECK(begin_fit(body, from, &fit));
    RITZ_CHECK(shift_inertia(&fit, body, &RMR, &RMT));
    for (int64_t p = 0; p < body->num_ports; p++)
        fit_port(&body->port[p], &fit);
    if (body->inertia.mass > 0.0) {
        ritz_dense_add(1.0 / body->inertia.mass, &RMR, &fit.N);
        ritz_dense_add(1.0 / body->inertia.mass, &RMT, &fit.y);
    }
    RITZ_CHECK(solve_fit(&fit, &motion));
    RITZ_CHECK(ritz_dense_congruence(&RMR, &motion, &M));
    ritz_dense_add(-1.0, &body->M, &M);
    *rigid = ritz_dense_max(&M) <= RITZ_SPIN_RIGID * ritz_dense_max(&body->M);
    unscale_motion(&fit, &motion);
    RITZ_MOVE(*out, motion);
    return RITZ_OK;
}

ritz_status ritz_spin_is_flexible(const ritz_reduced *body, bool *out)
{
    static const double origin[3];
    RITZ_OWN(ritz_dense) motion = {0};
    bool rigid = false;

    RITZ_CHECK(ritz_spin_rigid_motion(body, origin, &rigid, &motion));
    *out = !rigid && ritz_dense_max(&body->K) > 0.0;
    return RITZ_OK;
}
