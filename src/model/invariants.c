/*
 * Inertia invariants of moving bodies. A mass dm that belongs to grid i is at x
 * = x_i + r_i and moves by v = u_i + theta_i x r_i. The blocks of M give the
 * integrals of 1, r and r r' over the mass (invariants_mass.h). For axes a, b,
 * d let p_b(i) be the momentum along b of the mass of grid i, and h_db(i) its
 * first moment along d,
 *
 *     p_b(i)  = sum_j int v_jb           h_db(i) = sum_j int r_id v_jb
 *
 * Then
 *
 *     int x_a v_b = sum_i x_ia p_b(i) + h_ab(i)
 *     int v_a v_b = sum_i u_ia p_b(i) + (theta_i x h_b(i))_a
 *
 * Terms of consistent beams that these lack are added (invariants_beams.h).
 */
#include "base/alloc.h"
#include "base/team.h"
#include "linear/general.h"
#include "model/invariants_mass.h"

#include <ritz/model.h>

#include <string.h>

static const double origin[3];

/* R'MR and R'MT. */
static ritz_status find_momenta(const ritz_component *component,
                                const ritz_dense *T, ritz_invariants *out)
{
    RITZ_OWN(ritz_dense) R = {0}, MR = {0}, A = {0};

    RITZ_CHECK(ritz_rigid_geometry(component, origin, &R));
    RITZ_CHECK(ritz_sparse_mul(&component->M, &R, &MR));
    RITZ_CHECK(ritz_dense_mul_tn(&R, &MR, &A));
    ritz_dense_symmetrise(&A);
    memcpy(out->rigid, A.val, sizeof out->rigid);
    return ritz_dense_mul_tn(&MR, T, &out->momentum);
}

static ritz_status list_positions(const ritz_nodes *nodes, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(nodes->count, 3, out));
    for (int a = 0; a < 3; a++)
        for (int64_t i = 0; i < nodes->count; i++)
            ritz_dense_col(out, a)[i] =
                nodes->grids->position[3 * nodes->grid[i] + a];
    return RITZ_OK;
}

typedef struct motion {
    const ritz_dense *T;
    ritz_nodal_mass mass;
    ritz_dense theta[3]; /* of turning nodes, along basic axes */
} motion;

static void motion_free(motion *of)
{
    ritz_nodal_mass_free(&of->mass);
    for (int a = 0; a < 3; a++)
        ritz_dense_free(&of->theta[a]);
}

/* Motion and momentum along axis b. */
typedef struct along {
    int b;
    ritz_dense u, p;  /* nodes x r */
    ritz_dense h[3];  /* turning nodes x r */
    ritz_dense S, CS; /* of beams: see invariants_beams.h */
} along;

static void along_free(along *of)
{
    ritz_dense_free(&of->u);
    ritz_dense_free(&of->p);
    for (int a = 0; a < 3; a++)
        ritz_dense_free(&of->h[a]);
    ritz_dense_free(&of->S);
    ritz_dense_free(&of->CS);
}

typedef struct arms_task {
    const motion *of;
    along *to;
} arms_task;

/* (theta x r)_b, with r a row of three. */
static double turn(const double theta[3], const double *r, int b)
{
    return theta[(b + 1) % 3] * r[(b + 2) % 3] -
           theta[(b + 2) % 3] * r[(b + 1) % 3];
}

/* p_b(i) += (theta_j x f_j)_b, h_db(i) += f_id u_jb + (theta_j x G_d)_b */
static void add_arm(const motion *of, const ritz_mass_arm *arm, int64_t k,
                    along *to)
{
    const int64_t i = arm->turning[0];
    const int64_t j = arm->turning[1];
    const double u = ritz_dense_col(&to->u, k)[arm->at[1]];
    double theta[3] = {0};

    for (int a = 0; a < 3 && j >= 0; a++)
        theta[a] = ritz_dense_col(&of->theta[a], k)[j];
    ritz_dense_col(&to->p, k)[arm->at[0]] += turn(theta, arm->f[1], to->b);
    for (int d = 0; d < 3 && i >= 0; d++)
        ritz_dense_col(&to->h[d], k)[i] +=
            arm->f[0][d] * u + turn(theta, arm->G[d], to->b);
}

static void add_arms(int thread, int64_t from, int64_t to, void *task)
{
    const arms_task *t = task;

    (void)thread;
    for (int64_t k = from; k < to; k++)
        for (int64_t n = 0; n < t->of->mass.count; n++)
            add_arm(t->of, &t->of->mass.arm[n], k, t->to);
}

static ritz_status find_along(const motion *of, int b, along *out)
{
    enum { WORTHWHILE = 5000 }; /* arms of a column for each further thread */
    const int64_t r = of->T->ncol;
    const ritz_nodal_mass *mass = &of->mass;

    out->b = b;
    RITZ_CHECK(ritz_nodes_along(&mass->nodes, of->T, b, &out->u));
    RITZ_CHECK(ritz_sparse_mul(&mass->m, &out->u, &out->p));
    for (int d = 0; d < 3; d++)
        RITZ_CHECK(ritz_dense_new(mass->turning.count, r, &out->h[d]));
    ritz_team_over(ritz_team_ready(1 + mass->count * r / WORTHWHILE), r,
                   add_arms, &(arms_task){of, out});
    if (mass->beams.count == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_beams_along(&mass->beams, of->T, b, &out->S));
    return ritz_beams_weigh(&mass->beams, &out->S, &out->CS);
}

/* int x_a v_b for a = 1 to 3. */
static ritz_status find_positions(const motion *of, const along *v,
                                  ritz_dense *out)
{
    RITZ_OWN(ritz_dense) X = {0}, beams = {0};

    RITZ_CHECK(list_positions(&of->mass.nodes, &X));
    RITZ_CHECK(ritz_dense_mul_tn(&X, &v->p, out));
    for (int64_t k = 0; k < out->ncol; k++)
        for (int a = 0; a < 3; a++)
            for (int64_t i = 0; i < v->h[a].nrow; i++)
                ritz_dense_col(out, k)[a] += ritz_dense_col(&v->h[a], k)[i];
    if (of->mass.beams.count == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_beams_place(&of->mass.beams, &of->mass.nodes, &v->S, &v->CS,
                                &beams));
    ritz_dense_add(1.0, &beams, out);
    return RITZ_OK;
}

/* P += factor L'R */
static ritz_status add_product(double factor, const ritz_dense *L,
                               const ritz_dense *R, ritz_dense *P)
{
    RITZ_OWN(ritz_dense) more = {0};

    RITZ_CHECK(ritz_dense_mul_tn(L, R, &more));
    ritz_dense_add(factor, &more, P);
    return RITZ_OK;
}

/* int v_a v_b */
static ritz_status find_product(const motion *of, int a, const along *v,
                                ritz_dense *out)
{
    const ritz_nodal_mass *mass = &of->mass;
    RITZ_OWN(ritz_dense) u = {0}, S = {0};
    const bool own = a == v->b;

    if (!own)
        RITZ_CHECK(ritz_nodes_along(&mass->nodes, of->T, a, &u));
    RITZ_CHECK(ritz_dense_mul_tn(own ? &v->u : &u, &v->p, out));
    if (mass->turning.count > 0)
        for (int k = 1; k < 3; k++) /* theta_c h_d - theta_d h_c */
            RITZ_CHECK(add_product(k == 1 ? 1.0 : -1.0, &of->theta[(a + k) % 3],
                                   &v->h[(a + 3 - k) % 3], out));
    if (mass->beams.count > 0 && !own)
        RITZ_CHECK(ritz_beams_along(&mass->beams, of->T, a, &S));
    return mass->beams.count == 0
               ? RITZ_OK
               : add_product(1.0, own ? &v->S : &S, &v->CS, out);
}

/* int x_a v_b for all a, and int v_a v_b for a <= b, of one b. */
static ritz_status find_products(const motion *of, int b, ritz_invariants *out)
{
    const int64_t r = of->T->ncol;
    RITZ_OWN(along) v = {0};
    RITZ_OWN(ritz_dense) P = {0}, mirror = {0};

    RITZ_CHECK(find_along(of, b, &v));
    RITZ_CHECK(find_positions(of, &v, &P));
    ritz_dense_put(&P, 0, b * r, &out->position);
    ritz_dense_free(&P);
    RITZ_CHECK(find_product(of, b, &v, &P));
    ritz_dense_symmetrise(&P);
    ritz_dense_put(&P, b * r, b * r, &out->product);
    ritz_dense_free(&v.u);
    ritz_dense_free(&v.S);
    for (int a = 0; a < b; a++) {
        ritz_dense_free(&P);
        RITZ_CHECK(find_product(of, a, &v, &P));
        ritz_dense_put(&P, a * r, b * r, &out->product);
        RITZ_CHECK(ritz_general_transpose(&P, &mirror));
        ritz_dense_put(&mirror, b * r, a * r, &out->product);
        ritz_dense_free(&mirror);
    }
    return RITZ_OK;
}

ritz_status ritz_invariants_of(const ritz_component *component,
                               const ritz_dense *T, ritz_invariants *out)
{
    int64_t r = T->ncol;
    RITZ_OWN(motion) of = {.T = T};
    RITZ_OWN(ritz_invariants) found = {0};

    if (component->grids.count == 0 || r > RITZ_INVARIANT_COLUMNS)
        return RITZ_OK;
    RITZ_CHECK(ritz_nodal_mass_of(component, &of.mass));
    for (int a = 0; a < 3; a++)
        RITZ_CHECK(ritz_nodes_along(&of.mass.turning, T, a, &of.theta[a]));
    RITZ_CHECK(find_momenta(component, T, &found));
    RITZ_CHECK(ritz_dense_new(3, 3 * r, &found.position));
    RITZ_CHECK(ritz_dense_new(3 * r, 3 * r, &found.product));
    for (int b = 0; b < 3; b++)
        RITZ_CHECK(find_products(&of, b, &found));
    RITZ_MOVE(*out, found);
    return RITZ_OK;
}

ritz_status ritz_invariants_project(const ritz_invariants *invariants,
                                    const ritz_dense *V, ritz_invariants *out)
{
    RITZ_OWN(ritz_invariants) second = {0};
    RITZ_OWN(ritz_dense) V3 = {0};

    if (!invariants->momentum.val)
        return RITZ_OK;
    memcpy(second.rigid, invariants->rigid, sizeof second.rigid);
    /* V transforms each of the three blocks of columns: V3 = I_3 (x) V */
    RITZ_CHECK(ritz_dense_new(3 * V->nrow, 3 * V->ncol, &V3));
    for (int b = 0; b < 3; b++)
        ritz_dense_put(V, b * V->nrow, b * V->ncol, &V3);
    RITZ_CHECK(ritz_dense_mul(&invariants->momentum, V, &second.momentum));
    RITZ_CHECK(ritz_dense_mul(&invariants->position, &V3, &second.position));
    RITZ_CHECK(
        ritz_dense_congruence(&invariants->product, &V3, &second.product));
    RITZ_MOVE(*out, second);
    return RITZ_OK;
}

void ritz_invariants_free(ritz_invariants *invariants)
{
    ritz_dense_free(&invariants->momentum);
    ritz_dense_free(&invariants->position);
    ritz_dense_free(&invariants->product);
    *invariants = (ritz_invariants){0};
}
