/*
 * A neighbour's mass and stiffness, condensed through a joint to the
 * component's port. Its own motion is u_f = A q with few coordinates q; the
 * relations of the joint (joints.c) are rows
 *
 *     F q - G u = 0 where locked,    a spring of k_s where caged,
 *
 * u being the dofs of the component's port. With L those rows of F that are
 * locked, q = S u + Z z, S = L^+ G, L Z = 0; z is the motion that the joint
 * leaves free. It minimises the strain energy, and where it causes none it
 * follows from inertia,
 *
 *     Z'H Z z = -Z'(H S - sum k_s f g') u,     H = K + sum k_s f f'
 *     (ZN)'M (S u + Z z) = 0,                  Z'HZ N = 0
 *
 * so that q = Y u, M_n = Y'MY, K_n = Y'KY + sum k_s (Y'f - g)(Y'f - g)'.
 */
#include "assembly/assembly.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/*
 * Relations F q - G u of the far body's q and the near port's dofs u, by state;
 * a spring's row is multiplied by the root of its stiffness.
 */
typedef struct ritz_link {
    ritz_dense locked_F, locked_G; /* rows x r, rows x p */
    ritz_dense caged_F, caged_G;
} ritz_link;

/* K + f f' of the springs' rows, each times the root of its stiffness. */
static ritz_status add_springs(const ritz_dense *K, const ritz_dense *f,
                               ritz_dense *H)
{
    RITZ_OWN(ritz_dense) part = {0};

    RITZ_CHECK(ritz_dense_mul_tn(f, f, &part));
    RITZ_CHECK(ritz_dense_copy(K, H));
    ritz_dense_add(1.0, &part, H);
    return RITZ_OK;
}

/*
 * S = L^+ G and Z: the motion q that the locked rows prescribe, and their null
 * space.
 */
static ritz_status solve_locked(const ritz_link *of, ritz_dense *S,
                                ritz_dense *Z)
{
    const ritz_dense *L = &of->locked_F, *G = &of->locked_G;
    const int64_t r = L->ncol, most = L->nrow < r ? L->nrow : r;
    RITZ_OWN(ritz_dense) U = {0}, V = {0}, UG = {0};
    RITZ_OWN_ARRAY double *sigma = NULL;
    int64_t rank = 0;

    RITZ_CHECK_IN("the joint's relations", ritz_general_svd(L, &U, &sigma, &V));
    for (int64_t j = 0; j < r && L->nrow == 0; j++)
        ritz_dense_col(&V, j)[j] = 1.0;
    while (rank < most && sigma[rank] > RITZ_RANK_LOSS * sigma[0])
        rank++;
    RITZ_CHECK(ritz_dense_mul_tn(&U, G, &UG));
    RITZ_CHECK(ritz_dense_new(r, G->ncol, S));
    for (int64_t i = 0; i < r; i++)
        for (int64_t j = 0; j < G->ncol; j++)
            for (int64_t k = 0; k < rank; k++)
                ritz_dense_col(S, j)[i] += ritz_dense_col(&V, k)[i] *
                                           ritz_dense_col(&UG, j)[k] / sigma[k];
    return ritz_dense_columns(&V, rank, r - rank, Z);
}

/*
 * X = -A^+ B of a semidefinite A, and N, the null space of A; both by the
 * eigenvectors of A scaled to unit diagonal. N may be NULL.
 */
static ritz_status minimise_energy(ritz_dense *A, const ritz_dense *B,
                                   double largest, ritz_dense *X, ritz_dense *N)
{
    int64_t n = A->ncol;
    int64_t unseen = 0;
    RITZ_OWN_ARRAY double *d = NULL, *lambda = NULL;

    RITZ_CHECK_NEW(d, n);
    RITZ_CHECK_NEW(lambda, n);
    RITZ_CHECK(ritz_dense_new(n, B->ncol, X));
    for (int64_t j = 0; j < n; j++) {
        double own = ritz_dense_col(A, j)[j];

        d[j] = own > RITZ_CONDENSED_ROUNDING * largest ? 1.0 / sqrt(own) : 0.0;
    }
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(A, j)[i] *= d[i] * d[j];
    for (int64_t j = 0; j < n; j++)
        d[j] = d[j] > 0.0 ? d[j] : 1.0;
    RITZ_REFUSE_IF(n > 0 && LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'V', 'L', (int)n,
                                           A->val, (int)n, lambda) != 0,
                   RITZ_ERR_CONVERGENCE,
                   "what the joint leaves free has no eigenvalues");
    while (unseen < n && lambda[unseen] <= RITZ_RANK_LOSS)
        unseen++;
    for (int64_t k = unseen; k < n; k++)
        for (int64_t j = 0; j < B->ncol; j++) {
            const double *w = ritz_dense_col(A, k);
            double sum = 0.0;

            for (int64_t i = 0; i < n; i++)
                sum += w[i] * d[i] * ritz_dense_col(B, j)[i];
            for (int64_t i = 0; i < n; i++)
                ritz_dense_col(X, j)[i] -= d[i] * w[i] * sum / lambda[k];
        }
    if (N)
        RITZ_CHECK(ritz_dense_columns(A, 0, unseen, N));
    for (int64_t j = 0; N && j < unseen; j++)
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(N, j)[i] *= d[i];
    return RITZ_OK;
}

/* S += Z X with X = -(Z'HZ)^+ Z'R; N as above. */
static ritz_status reduce_energy(const ritz_dense *H, const ritz_dense *R,
                                 const ritz_dense *Z, ritz_dense *S,
                                 ritz_dense *N)
{
    RITZ_OWN(ritz_dense) A = {0}, B = {0}, X = {0}, more = {0};

    RITZ_CHECK(ritz_dense_congruence(H, Z, &A));
    RITZ_CHECK(ritz_dense_mul_tn(Z, R, &B));
    RITZ_CHECK(minimise_energy(&A, &B, ritz_dense_max(H), &X, N));
    RITZ_CHECK(ritz_dense_mul(Z, &X, &more));
    ritz_dense_add(1.0, &more, S);
    return RITZ_OK;
}

/* Y: the motion of the far body due to the near port's. */
static ritz_status map_far_body(const ritz_reduced *far, const ritz_link *of,
                                ritz_dense *Y)
{
    RITZ_OWN(ritz_dense) Z = {0}, N = {0}, ZN = {0};
    RITZ_OWN(ritz_dense) H = {0}, R = {0}, cross = {0}, MS = {0};

    RITZ_CHECK(solve_locked(of, Y, &Z));
    RITZ_CHECK(add_springs(&far->K, &of->caged_F, &H));
    RITZ_CHECK(ritz_dense_mul(&H, Y, &R));
    RITZ_CHECK(ritz_dense_mul_tn(&of->caged_F, &of->caged_G, &cross));
    ritz_dense_add(-1.0, &cross, &R);
    RITZ_CHECK(reduce_energy(&H, &R, &Z, Y, &N));
    RITZ_CHECK(ritz_dense_mul(&Z, &N, &ZN));
    RITZ_CHECK(ritz_dense_mul(&far->M, Y, &MS));
    return reduce_energy(&far->M, &MS, &ZN, Y, NULL);
}

/* K_n and M_n, condensed to the near port's dofs. */
static ritz_status condense_link(const ritz_reduced *far, const ritz_link *of,
                                 ritz_dense *K, ritz_dense *M)
{
    RITZ_OWN(ritz_dense) Y = {0}, own = {0}, gap = {0};

    RITZ_CHECK(map_far_body(far, of, &Y));
    RITZ_CHECK(ritz_dense_congruence(&far->K, &Y, &own));
    RITZ_CHECK(ritz_dense_mul(&of->caged_F, &Y, &gap));
    ritz_dense_add(-1.0, &of->caged_G, &gap);
    RITZ_CHECK(add_springs(&own, &gap, K));
    return ritz_dense_congruence(&far->M, &Y, M);
}

static void ritz_link_free(ritz_link *link)
{
    ritz_dense_free(&link->locked_F);
    ritz_dense_free(&link->locked_G);
    ritz_dense_free(&link->caged_F);
    ritz_dense_free(&link->caged_G);
}

/*
 * The neighbours of a component: the body beyond a joint, condensed to its own
 * port by Guyan's reduction, or, if it has no stiffness, to its six rigid
 * motions; both have few coordinates q. The link above relates them to the
 * component's port.
 */

/* The far body in few coordinates. */
static ritz_status condense_body(const ritz_component *far,
                                 const ritz_port *port, ritz_reduced *out)
{
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_basis) basis = {0};
    bool rigid =
        far->K.colptr[far->K.ncol] == 0 && port->dofs.count < far->num_dofs;

    request.component = far;
    if (!rigid)
        request.attached = port->dofs;
    RITZ_CHECK(ritz_basis_make(rigid ? &ritz_method_rigid : &ritz_method_guyan,
                               &request, &basis));
    return ritz_reduce(far, &basis, out);
}

/* Rows of one end of the joint's relations of one state. */
static ritz_status fill_rows(const ritz_relations *list, int end,
                             ritz_freedom_state state, const ritz_dense *map,
                             ritz_dense *out)
{
    int64_t count = 0;

    for (int64_t k = 0; k < list->count; k++)
        count += list->item[k].freedom->state == state;
    RITZ_CHECK(ritz_dense_new(count, map->ncol, out));
    count = 0;
    for (int64_t k = 0; k < list->count; k++) {
        const ritz_relation *r = &list->item[k];
        const double root =
            state == RITZ_CAGED ? sqrt(r->freedom->stiffness) : 1.0;

        if (r->freedom->state != state)
            continue;
        for (int64_t j = 0; j < out->ncol; j++)
            ritz_dense_col(out, j)[count] = root * ritz_relation_at(r, end, j);
        count++;
    }
    return RITZ_OK;
}

static ritz_status link_bodies(const ritz_joint *joint, const double *setting,
                               const ritz_joined side[2], int near,
                               const ritz_reduced *far, ritz_link *out)
{
    const ritz_port *port =
        ritz_component_port(side[near].component, joint->between[near].port);
    const ritz_port_map *map =
        ritz_reduced_port(far, joint->between[1 - near].port);
    RITZ_OWN(ritz_relations) list = {0};
    RITZ_OWN(ritz_port_map) at = {0};
    ritz_joint_pose pose;
    ritz_joint_end end[2];

    if (!port || !map)
        return RITZ_ERR_ARGUMENT;
    RITZ_CHECK(ritz_port_map_of(side[near].component, port, NULL, &at));
    end[near] = (ritz_joint_end){side[near].name, &at};
    end[1 - near] = (ritz_joint_end){side[1 - near].name, map};
    ritz_joint_pose_at(joint, setting, &pose);
    RITZ_CHECK(ritz_joint_relate(joint, end, &pose, &list));
    RITZ_CHECK(
        fill_rows(&list, 1 - near, RITZ_LOCKED, &map->map, &out->locked_F));
    RITZ_CHECK(fill_rows(&list, near, RITZ_LOCKED, &at.map, &out->locked_G));
    RITZ_CHECK(
        fill_rows(&list, 1 - near, RITZ_CAGED, &map->map, &out->caged_F));
    return fill_rows(&list, near, RITZ_CAGED, &at.map, &out->caged_G);
}

/* Indices of a port's dofs among the attached ones. */
static ritz_status locate_port(const ritz_component *component,
                               const ritz_port *port, const ritz_dofs *attached,
                               int64_t *at)
{
    char name[RITZ_DOF_NAME_SIZE];

    for (int64_t j = 0; j < port->dofs.count; j++) {
        at[j] = -1;
        for (int64_t i = 0; i < attached->count; i++)
            if (attached->at[i] == port->dofs.at[j])
                at[j] = i;
        RITZ_REFUSE_IF(
            at[j] < 0, RITZ_ERR_ARGUMENT,
            "%s of port '%s' is not attached, so nothing can hang on "
            "it",
            ritz_dof_name(component->dof[port->dofs.at[j]], name), port->name);
    }
    return RITZ_OK;
}

/* sum(at, at) += A. */
static void add_scattered(const ritz_dense *A, const int64_t *at,
                          ritz_dense *sum)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            ritz_dense_col(sum, at[j])[at[i]] += ritz_dense_col(A, j)[i];
}

ritz_status ritz_joint_neighbour(const ritz_joint *joint, const double *setting,
                                 const ritz_joined side[static 2], int near,
                                 const ritz_dofs *attached, ritz_neighbour *sum)
{
    const ritz_port *port =
        ritz_component_port(side[near].component, joint->between[near].port);
    const ritz_port *other =
        port ? ritz_component_port(side[1 - near].component,
                                   joint->between[1 - near].port)
             : NULL;
    RITZ_OWN(ritz_reduced) far = {0};
    RITZ_OWN(ritz_link) link = {0};
    RITZ_OWN(ritz_dense) K = {0}, M = {0};
    RITZ_OWN_ARRAY int64_t *at = NULL;

    if (!other)
        return ritz_context(RITZ_ERR_ARGUMENT,
                            side[port ? 1 - near : near].name);
    RITZ_CHECK_NEW(at, port->dofs.count);
    RITZ_CHECK(locate_port(side[near].component, port, attached, at));
    RITZ_CHECK_IN(side[1 - near].name,
                  condense_body(side[1 - near].component, other, &far));
    RITZ_CHECK(link_bodies(joint, setting, side, near, &far, &link));
    RITZ_CHECK(condense_link(&far, &link, &K, &M));
    add_scattered(&K, at, &sum->K);
    add_scattered(&M, at, &sum->M);
    return RITZ_OK;
}

ritz_status ritz_neighbour_new(int64_t attached, ritz_neighbour *out)
{
    RITZ_OWN(ritz_neighbour) neighbour = {0};

    RITZ_CHECK(ritz_dense_new(attached, attached, &neighbour.K));
    RITZ_CHECK(ritz_dense_new(attached, attached, &neighbour.M));
    RITZ_MOVE(*out, neighbour);
    return RITZ_OK;
}

void ritz_neighbour_free(ritz_neighbour *neighbour)
{
    ritz_dense_free(&neighbour->K);
    ritz_dense_free(&neighbour->M);
    *neighbour = (ritz_neighbour){0};
}

/* The full model of the body beyond a joint. */
static ritz_status load_far_body(const ritz_source *source,
                                 const ritz_scene_component *item,
                                 ritz_component *out)
{
    char kind[RITZ_NAME_SIZE];

    RITZ_CHECK(source->kind(source->state, item->model, kind));
    RITZ_REFUSE_IF(strcmp(kind, "component") != 0, RITZ_ERR_ARGUMENT,
                   "its neighbour '%s' is not there as a full model, of which "
                   "loaded-interface needs mass and stiffness",
                   item->name);
    return source->component(source->state, item->model, out);
}

/*
 * The end of a joint that is on body k if the other is on `far`; -1: neither.
 */
static int find_near_end(const ritz_joint *joint, int64_t k, int64_t far)
{
    for (int near = 0; near < 2; near++)
        if (joint->between[near].component == k &&
            joint->between[1 - near].component == far)
            return near;
    return -1;
}

/*
 * Add the condensed neighbour for all joints with one other body, which is read
 * once.
 */
static ritz_status add_body(const ritz_scene *scene, int64_t k, int64_t other,
                            const ritz_component *component,
                            const ritz_dofs *attached, ritz_neighbour *sum)
{
    RITZ_OWN(ritz_component) far = {0};
    ritz_joined side[2];

    for (int64_t j = 0; j < scene->num_joints; j++) {
        int near = find_near_end(&scene->joint[j], k, other);

        if (near < 0)
            continue;
        if (far.num_dofs == 0)
            RITZ_CHECK(
                load_far_body(scene->source, &scene->component[other], &far));
        side[near] = (ritz_joined){scene->component[k].name, component};
        side[1 - near] = (ritz_joined){scene->component[other].name, &far};
        RITZ_CHECK(ritz_joint_neighbour(&scene->joint[j], scene->setting, side,
                                        near, attached, sum));
    }
    return RITZ_OK;
}

ritz_status ritz_scene_neighbour(const ritz_scene *scene, int64_t k,
                                 const ritz_component *component,
                                 const ritz_dofs *attached, ritz_neighbour *out)
{
    RITZ_OWN(ritz_neighbour) sum = {0};

    RITZ_CHECK(ritz_neighbour_new(attached->count, &sum));
    for (int64_t other = 0; other < scene->num_components; other++)
        RITZ_CHECK(add_body(scene, k, other, component, attached, &sum));
    RITZ_MOVE(*out, sum);
    return RITZ_OK;
}
