/*
 * Reference conditions of floating frames: one becomes the other, energy does
 * not depend on them, and what they need is demanded.
 */
#include "testing.h"

#include "base/vector.h"
#include "fixtures/bodies.h"
#include "fixtures/frame.h"
#include "fixtures/free_bodies.h"
#include "fixtures/matrices.h"
#include "fixtures/project.h"
#include "linear/general.h"
#include "model/equations.h"
#include "model/floating.h"

#include <stdio.h>

/* 4500 eps: sums of some hundred terms, in a basis whose condition is 10 */
static const double rounding = 1e-12;

static const ritz_floating_request requests[] = {
    {"centre", "none"},
    {"13", "mean-axis"},
    {"12", "tangent"},
};
enum { REQUESTS = sizeof requests / sizeof *requests };

/* ---- energy ------------------------------------------------------------- */

/* The motion of the frame and of the modes at one instant. */
typedef struct flight {
    double v[3], omega[3];
    double eta[FREE_FLEXIBLE], rate[FREE_FLEXIBLE];
} flight;

static double shape_at(const ritz_dense *shape, int64_t row, const double *eta)
{
    double sum = 0.0;

    for (int64_t j = 0; j < shape->ncol; j++)
        sum += ritz_dense_col(shape, j)[row] * eta[j];
    return sum;
}

/* Sum of a shape, of translations or of rotations, times the amplitudes. */
static void take_node(const ritz_dense *shape, int64_t node, const double *eta,
                      double out[3])
{
    for (int a = 0; a < 3; a++)
        out[a] = shape_at(shape, 3 * node + a, eta);
}

/*
 * Twice the energy of a node, a rigid body of whose points rho moves by
 * u + theta x rho: int |v + w x (x + u + rho + theta x rho) + u' + theta' x
 * rho|^2. With B rho what depends on rho, int |B rho|^2 is the trace of
 * B S B'.
 */
static double energy_of_node(const ritz_component *body, const ritz_floating *f,
                             int64_t node, const flight *at)
{
    double u[3], theta[3], rate[3], spin[3], turning[3], S[3][3];
    double B[3][3] = {{0}};
    double sum = 0.0;

    take_node(&f->shape, node, at->eta, u);
    take_node(&f->turn, node, at->eta, theta);
    take_node(&f->shape, node, at->rate, rate);
    take_node(&f->turn, node, at->rate, spin);
    for (int a = 0; a < 3; a++)
        u[a] += f->position[3 * node + a];
    ritz_cross(at->omega, u, turning);
    for (int a = 0; a < 3; a++)
        rate[a] += at->v[a] + turning[a];
    for (int d = 0; d < 3; d++) {
        double e[3] = {d == 0, d == 1, d == 2};
        double bent[3], moved[3];

        ritz_cross(spin, e, moved);
        ritz_cross(theta, e, bent);
        for (int a = 0; a < 3; a++)
            bent[a] += e[a];
        ritz_cross(at->omega, bent, turning);
        for (int a = 0; a < 3; a++)
            B[a][d] = moved[a] + turning[a];
    }
    free_moment(body, node, S);
    for (int a = 0; a < 3; a++)
        for (int k = 0; k < 9; k++)
            sum += B[a][k / 3] * S[k / 3][k % 3] * B[a][k % 3];
    return sum + free_mass(body, node) * ritz_dot(rate, rate);
}

/* S(a, b): X_a'm u_b, or u_a'm w_b of u = Psi eta and w = Psi rate. */
static void first_order(const ritz_invariants *of, const double *eta,
                        double S[3][3])
{
    const int64_t m = of->momentum.ncol;

    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            S[a][b] = 0.0;
            for (int64_t k = 0; k < m; k++)
                S[a][b] += ritz_dense_col(&of->position, b * m + k)[a] * eta[k];
        }
}

static void second_order(const ritz_invariants *of, const double *eta,
                         const double *rate, double S[3][3])
{
    const int64_t m = of->momentum.ncol;

    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            S[a][b] = 0.0;
            for (int64_t j = 0; j < m; j++)
                for (int64_t k = 0; k < m; k++)
                    S[a][b] +=
                        ritz_dense_col(&of->product, b * m + k)[a * m + j] *
                        eta[j] * rate[k];
        }
}

/* (omega x x)'m (omega x u) from S = X'm u */
static double spin_product(const double *omega, double S[3][3])
{
    double sum = 0.0;

    for (int a = 0; a < 3; a++) {
        sum += ritz_dot(omega, omega) * S[a][a];
        for (int b = 0; b < 3; b++)
            sum -= omega[a] * omega[b] * S[a][b];
    }
    return sum;
}

static double quadratic(const double *A, const double *x, int64_t n)
{
    double sum = 0.0;

    for (int64_t i = 0; i < n; i++)
        for (int64_t j = 0; j < n; j++)
            sum += x[i] * A[i + n * j] * x[j];
    return sum;
}

/* Twice the kinetic energy, from the invariants alone. */
static double find_energy(const ritz_floating *f, const flight *at)
{
    const ritz_invariants *of = &f->invariants;
    const double c[6] = {at->v[0],     at->v[1],     at->v[2],
                         at->omega[0], at->omega[1], at->omega[2]};
    double S[3][3], momentum[3] = {0}, turning[3];
    double sum = quadratic(of->rigid, c, 6) +
                 quadratic(f->M.val, at->rate, FREE_FLEXIBLE);

    for (int64_t k = 0; k < FREE_FLEXIBLE; k++)
        for (int a = 0; a < 6; a++) {
            const double P = ritz_dense_col(&of->momentum, k)[a];

            sum += 2.0 * c[a] * P * at->rate[k];
            if (a < 3)
                momentum[a] += P * at->eta[k];
        }
    ritz_cross(at->omega, momentum, turning);
    sum += 2.0 * ritz_dot(at->v, turning);
    first_order(of, at->eta, S);
    sum += 2.0 * spin_product(at->omega, S);
    second_order(of, at->eta, at->eta, S);
    sum += spin_product(at->omega, S);
    second_order(of, at->eta, at->rate, S);
    for (int a = 0; a < 3; a++)
        sum += 2.0 * at->omega[a] *
               (S[(a + 1) % 3][(a + 2) % 3] - S[(a + 2) % 3][(a + 1) % 3]);
    return sum;
}

static void energy_is_that_of_the_whole_body(void **state)
{
    (void)state;
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    uint64_t seed = 23;
    flight at;

    assert_ok(free_chain(true, &body, &reduced));
    for (size_t k = 0; k < sizeof at / sizeof(double); k++)
        ((double *)&at)[k] = body_number(&seed);
    for (int k = 0; k < REQUESTS; k++) {
        RITZ_OWN(ritz_floating) f = {0};
        double energy = 0.0;

        assert_ok(ritz_floating_of(&reduced, &requests[k], &f));
        for (int64_t i = 0; i < FREE_GRIDS; i++)
            energy += energy_of_node(&body, &f, i, &at);
        assert_near(find_energy(&f, &at), energy, rounding * energy);
    }
}

/* ---- rigid motion ------------------------------------------------------- */

/* The mass matrix [R Psi]'M [R Psi], made from the invariants. */
static void make_whole(const ritz_floating *f, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) mirror = {0}, A = {0};

    assert_ok(ritz_dense_new(6 + f->V.ncol, 6 + f->V.ncol, out));
    assert_ok(ritz_general_transpose(&f->invariants.momentum, &mirror));
    assert_ok(ritz_dense_new(6, 6, &A));
    memcpy(A.val, f->invariants.rigid, sizeof f->invariants.rigid);
    ritz_dense_put(&A, 0, 0, out);
    ritz_dense_put(&f->invariants.momentum, 0, 6, out);
    ritz_dense_put(&mirror, 6, 0, out);
    ritz_dense_put(&f->M, 6, 6, out);
}

/* The displacement u of all dofs in coordinates [g; eta] of the floating
   body. */
static void find_coordinates(const ritz_component *body,
                             const ritz_reduced *reduced,
                             const ritz_floating *f, const ritz_dense *u,
                             ritz_dense *out)
{
    RITZ_OWN(ritz_dense) R = {0}, Psi = {0}, all = {0}, Mu = {0}, whole = {0};

    assert_ok(ritz_rigid_geometry(body, f->origin, &R));
    assert_ok(ritz_dense_mul(&reduced->T, &f->U, &Psi));
    assert_ok(ritz_dense_beside(&R, &Psi, &all));
    assert_ok(ritz_sparse_mul(&body->M, u, &Mu));
    assert_ok(ritz_dense_mul_tn(&all, &Mu, out));
    make_whole(f, &whole);
    assert_ok(ritz_general_solve(&whole, false, out));
}

static void a_body_moved_rigidly_has_no_elastic_force(void **state)
{
    (void)state;
    static const double somewhere[3] = {-3.0, 7.0, 2.0};
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_dense) R = {0}, mix = {0}, u = {0};
    uint64_t seed = 31;

    assert_ok(free_chain(true, &body, &reduced));
    assert_ok(ritz_rigid_geometry(&body, somewhere, &R));
    assert_ok(ritz_dense_new(6, 3, &mix));
    free_fill(&seed, &mix);
    assert_ok(ritz_dense_mul(&R, &mix, &u));
    for (int k = 0; k < REQUESTS; k++) {
        RITZ_OWN(ritz_floating) f = {0};
        RITZ_OWN(ritz_dense) q = {0}, eta = {0}, force = {0}, unit = {0};

        assert_ok(ritz_floating_of(&reduced, &requests[k], &f));
        find_coordinates(&body, &reduced, &f, &u, &q);
        assert_ok(ritz_dense_block(&q, 6, f.V.ncol, 0, 3, &eta));
        assert_ok(ritz_dense_mul(&f.K, &eta, &force));
        /* of a deformation as large as the displacement */
        assert_true(ritz_dense_max(&force) <= rounding * ritz_dense_max(&f.K) *
                                                  ritz_dense_max(&u) /
                                                  ritz_dense_max(&f.shape));
        /* and the motion of the frame is all there is */
        assert_ok(ritz_dense_block(&q, 0, 6, 0, 3, &unit));
        ritz_dense_free(&R);
        assert_ok(ritz_rigid_geometry(&body, f.origin, &R));
        ritz_dense_free(&eta);
        assert_ok(ritz_dense_mul(&R, &unit, &eta));
        assert_near_dense(&eta, &u, rounding);
    }
}

/* ---- one condition and another ------------------------------------------ */

/* Psi -= R C at the nodes, where R are rigid motions about the frame. */
static void take_motion(const ritz_dense *C, ritz_floating *f)
{
    for (int64_t j = 0; j < C->ncol; j++)
        for (int64_t k = 0; k < f->count; k++) {
            const double *c = ritz_dense_col(C, j);
            double turning[3];

            ritz_cross(c + 3, f->position + 3 * k, turning);
            for (int a = 0; a < 3; a++) {
                ritz_dense_col(&f->shape, j)[3 * k + a] -= c[a] + turning[a];
                ritz_dense_col(&f->turn, j)[3 * k + a] -= c[3 + a];
            }
        }
}

/* C has the translations and rotations of node 1 in each mode. */
static void find_node_motion(const ritz_floating *f, ritz_dense *C)
{
    assert_ok(ritz_dense_new(6, f->V.ncol, C));
    for (int64_t j = 0; j < f->V.ncol; j++)
        for (int a = 0; a < 3; a++) {
            ritz_dense_col(C, j)[a] = ritz_dense_col(&f->shape, j)[3 + a];
            ritz_dense_col(C, j)[3 + a] = ritz_dense_col(&f->turn, j)[3 + a];
        }
}

static void tangent_and_mean_axes_are_converted_into_each_other(void **state)
{
    (void)state;
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_floating) tangent = {0}, mean = {0}, moved = {0};
    RITZ_OWN(ritz_dense) A = {0}, C = {0};

    assert_ok(free_chain(false, &body, &reduced));
    assert_ok(ritz_floating_of(
        &reduced, &(ritz_floating_request){"12", "tangent"}, &tangent));
    assert_ok(ritz_floating_of(
        &reduced, &(ritz_floating_request){"12", "mean-axis"}, &mean));
    assert_ok(ritz_floating_of(
        &reduced, &(ritz_floating_request){"12", "tangent"}, &moved));
    assert_near_dense(&tangent.K, &mean.K, 0.0);
    /* R'MR C = R'M Psi of the tangent modes: what is left has no momentum */
    assert_ok(ritz_dense_new(6, 6, &A));
    memcpy(A.val, tangent.invariants.rigid, sizeof tangent.invariants.rigid);
    assert_ok(ritz_dense_copy(&tangent.invariants.momentum, &C));
    assert_ok(ritz_general_solve(&A, false, &C));
    take_motion(&C, &moved);
    assert_near_dense(&moved.shape, &mean.shape, rounding);
    assert_near_dense(&moved.turn, &mean.turn, rounding);
    /* and back */
    ritz_dense_free(&C);
    find_node_motion(&mean, &C);
    take_motion(&C, &moved);
    assert_near_dense(&moved.shape, &tangent.shape, rounding);
    assert_near_dense(&moved.turn, &tangent.turn, rounding);
}

static void free_modes_have_mean_axes_already(void **state)
{
    (void)state;
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_floating) none = {0}, mean = {0};

    assert_ok(body_chain(FREE_GRIDS, free_places, FREE_FIRST, 5, &body));
    dense_modes(&body, &pairs);
    assert_ok(ritz_basis_new(body.num_dofs, 12, &basis));
    ritz_dense_cut(&pairs.Phi, 0, 0, &basis.T);
    assert_ok(ritz_reduce(&body, &basis, &reduced));
    assert_ok(ritz_floating_of(&reduced, &(ritz_floating_request){0}, &none));
    assert_ok(ritz_floating_of(
        &reduced, &(ritz_floating_request){NULL, "mean-axis"}, &mean));
    assert_int_equal(mean.V.ncol, 6);
    /* eigenvectors: eps of the largest eigenvalue, 1e5, over the lowest, 1e2 */
    assert_near(ritz_dense_max(&mean.W), 0.0, 1e-11);
    assert_near_dense(&none.shape, &mean.shape, 1e-11);
    assert_near_dense(&none.turn, &mean.turn, 1e-11);
    assert_near(none.lowest_hz, mean.lowest_hz, 1e-11 * none.lowest_hz);
}

/* ---- nodes -------------------------------------------------------------- */

/* Turn the displacement axes of grid 13 by Q: K becomes Q K Q'. */
static void turn_grid(ritz_component *body, ritz_dense *others)
{
    static const double axes[9] = {0.8, -0.6,  0.0,   0.36, 0.48,
                                   0.8, -0.48, -0.64, 0.6};
    const int64_t n = body->num_dofs;
    RITZ_OWN(ritz_dense) Q = {0}, Qt = {0}, turned = {0};
    double *more = ritz_zalloc(18, sizeof *more);
    ritz_sparse *const part[] = {&body->K, &body->M};

    assert_non_null(more);
    memcpy(more, body->grids.axes, 9 * sizeof *more);
    memcpy(more + 9, axes, sizeof axes);
    free(body->grids.axes);
    body->grids.axes = more;
    body->grids.num_frames = 2;
    body->grids.frame[2] = 1;
    assert_ok(ritz_dense_identity(n, &Q));
    for (int64_t k = 0; k < 18; k++)
        ritz_dense_col(&Q,
                       12 + 3 * (k / 9) + k % 3)[12 + 3 * (k / 9) + k % 9 / 3] =
            axes[k % 9];
    assert_ok(ritz_general_transpose(&Q, &Qt));
    for (int p = 0; p < 2; p++) {
        RITZ_OWN(ritz_dense) A = project(part[p], &Qt);
        RITZ_OWN_ARRAY int64_t *row = ritz_zalloc(2 * n * n, sizeof *row);

        assert_non_null(row);
        for (int64_t k = 0; k < n * n; k++) {
            row[k] = k % n;
            row[n * n + k] = k / n;
        }
        ritz_sparse_free(part[p]);
        assert_ok(ritz_sparse_from_triplets(n, n, n * n, row, row + n * n,
                                            A.val, part[p]));
    }
    assert_ok(ritz_dense_mul(&Q, others, &turned));
    ritz_dense_replace(others, &turned);
}

static void axes_of_displacements_change_nothing(void **state)
{
    (void)state;
    RITZ_OWN(ritz_component) plain = {0}, body = {0};
    RITZ_OWN(ritz_reduced) of_plain = {0}, reduced = {0};
    RITZ_OWN(ritz_dense) others = {0};
    uint64_t seed = 7;

    assert_ok(free_chain(false, &plain, &of_plain));
    assert_ok(body_chain(FREE_GRIDS, free_places, FREE_FIRST, 5, &body));
    assert_ok(ritz_dense_new(body.num_dofs, FREE_FLEXIBLE, &others));
    free_fill(&seed, &others);
    turn_grid(&body, &others);
    assert_ok(free_reduce(&body, &others, false, &reduced));
    for (int k = 0; k < 4; k++) {
        /* the frame at the turned grid itself, last */
        const ritz_floating_request request =
            k < 3 ? requests[k] : (ritz_floating_request){"13", "tangent"};
        RITZ_OWN(ritz_floating) a = {0}, b = {0};

        assert_ok(ritz_floating_of(&of_plain, &request, &a));
        assert_ok(ritz_floating_of(&reduced, &request, &b));
        assert_near_dense(&a.shape, &b.shape, rounding);
        assert_near_dense(&a.turn, &b.turn, rounding);
        assert_near_dense(&a.invariants.position, &b.invariants.position,
                          rounding);
        assert_near_dense(&a.invariants.product, &b.invariants.product,
                          rounding);
    }
}

/* Add grid 20, which follows grid 12 rigidly; its first `count` dofs are
   recovered. */
static void add_follower(int64_t count, ritz_component *body)
{
    static const double place[3] = {6.0, -3.0, 4.0};
    ritz_grids *grids = &body->grids;
    ritz_recovery *recovery = &body->recovery;
    int64_t row[36], col[36];
    double val[36];

    assert_ok(ritz_array_extend(&grids->id, grids->count, 1, 8));
    assert_ok(ritz_array_extend(&grids->frame, grids->count, 1, 8));
    assert_ok(ritz_array_extend(&grids->position, 3 * grids->count, 3, 8));
    grids->id[grids->count] = 20;
    memcpy(grids->position + 3 * grids->count, place, sizeof place);
    grids->count++;
    recovery->count = count;
    recovery->dof = ritz_zalloc(6, sizeof *recovery->dof);
    assert_non_null(recovery->dof);
    for (int c = 0; c < 6; c++) {
        double motion[6];

        recovery->dof[c] = (ritz_dof){20, c + 1};
        ritz_tie_row(grids, grids->count - 1, c + 1, free_places[1], motion);
        for (int k = 0; k < 6; k++) {
            row[6 * c + k] = c;
            col[6 * c + k] = 6 + k;
            val[6 * c + k] = motion[k];
        }
    }
    assert_ok(ritz_sparse_from_triplets(count, body->num_dofs, 6 * count, row,
                                        col, val, &recovery->G));
}

static void reduce_followed(int64_t count, ritz_reduced *out)
{
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_dense) others = {0};
    uint64_t seed = 7;

    assert_ok(body_chain(FREE_GRIDS, free_places, FREE_FIRST, 5, &body));
    add_follower(count, &body);
    assert_ok(ritz_dense_new(body.num_dofs, FREE_FLEXIBLE, &others));
    free_fill(&seed, &others);
    assert_ok(free_reduce(&body, &others, true, out));
}

static void a_recovered_grid_is_a_node_and_holds_a_frame(void **state)
{
    (void)state;
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_floating) f = {0};

    reduce_followed(6, &reduced);
    assert_ok(ritz_floating_of(&reduced,
                               &(ritz_floating_request){"20", "tangent"}, &f));
    assert_int_equal(f.count, FREE_GRIDS + 1);
    assert_int_equal(f.id[FREE_GRIDS], 20);
    assert_near(f.position[3 * FREE_GRIDS], 0.0, 0.0);
    for (int64_t j = 0; j < FREE_FLEXIBLE; j++)
        for (int a = 0; a < 3; a++) {
            const double bound = rounding * ritz_dense_max(&f.shape);

            /* grid 12, node 1, moves with it */
            assert_near(ritz_dense_col(&f.shape, j)[15 + a], 0.0, bound);
            assert_near(ritz_dense_col(&f.turn, j)[15 + a], 0.0, bound);
            assert_near(ritz_dense_col(&f.shape, j)[3 + a], 0.0, bound);
            assert_near(ritz_dense_col(&f.turn, j)[3 + a], 0.0, bound);
        }
}

static void grids_recovered_in_part_are_left_out(void **state)
{
    (void)state;
    RITZ_OWN(ritz_reduced) two = {0}, four = {0};
    RITZ_OWN(ritz_floating) without = {0}, with = {0};

    reduce_followed(2, &two);
    assert_ok(ritz_floating_of(&two, &requests[0], &without));
    assert_int_equal(without.count, FREE_GRIDS);
    reduce_followed(4, &four);
    assert_ok(ritz_floating_of(&four, &requests[0], &with));
    assert_int_equal(with.count, FREE_GRIDS + 1);
    assert_false(with.rotates[FREE_GRIDS]);
    assert_true(with.rotates[FREE_GRIDS - 1]);
    for (int64_t j = 0; j < FREE_FLEXIBLE; j++)
        assert_near(ritz_dense_col(&with.turn, j)[3 * FREE_GRIDS], 0.0, 0.0);
}

/* A box whose grids 11, 12 and 13 are a port. If `rigid`, they move as a
   rigid body in all columns. */
static void make_ported(bool rigid, int64_t grids, ritz_reduced *out)
{
    static const double origin[3];
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_dense) others = {0}, R = {0}, mix = {0}, moved = {0};
    uint64_t seed = 17;

    assert_ok(free_box(&body));
    body.port = ritz_zalloc(1, sizeof *body.port);
    body.num_ports = 1;
    snprintf(body.port->name, sizeof body.port->name, "foot");
    body.port->dofs.at = ritz_zalloc(9, sizeof(int64_t));
    body.port->dofs.count = 3 * grids;
    for (int64_t k = 0; k < 9; k++)
        body.port->dofs.at[k] = k;
    for (int a = 0; a < 3; a++)
        body.port->axes[4 * a] = 1.0;
    assert_ok(ritz_dense_new(body.num_dofs, FREE_FLEXIBLE, &others));
    assert_ok(ritz_dense_new(6, FREE_FLEXIBLE, &mix));
    free_fill(&seed, &others);
    free_fill(&seed, &mix);
    assert_ok(ritz_rigid_geometry(&body, origin, &R));
    assert_ok(ritz_dense_mul(&R, &mix, &moved));
    for (int64_t j = 0; j < FREE_FLEXIBLE && rigid; j++)
        for (int64_t i = 0; i < 9; i++)
            ritz_dense_col(&others, j)[i] = ritz_dense_col(&moved, j)[i];
    assert_ok(free_reduce(&body, &others, true, out));
}

static const ritz_floating_request at_foot = {"12", "tangent"};

static void a_rigid_port_holds_a_frame(void **state)
{
    (void)state;
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_floating) f = {0};

    make_ported(true, 3, &reduced);
    assert_ok(ritz_floating_of(&reduced, &at_foot, &f));
    for (int64_t j = 0; j < FREE_FLEXIBLE; j++)
        for (int64_t i = 0; i < 9; i++)
            assert_near(ritz_dense_col(&f.shape, j)[i], 0.0,
                        rounding * ritz_dense_max(&f.shape));
}

static void a_tangent_frame_without_rotation_is_refused(void **state)
{
    (void)state;
    RITZ_OWN(ritz_reduced) loose = {0}, line = {0};
    const ritz_floating_request elsewhere = {"15", "tangent"};
    ritz_floating f = {0};

    make_ported(false, 3, &loose);
    assert_fails(ritz_floating_of(&loose, &at_foot, &f), RITZ_ERR_ARGUMENT,
                 "the port of grid 12 does not move as a rigid body");
    assert_fails(ritz_floating_of(&loose, &elsewhere, &f), RITZ_ERR_ARGUMENT,
                 "grid 15 does not say how it turns");
    make_ported(true, 2, &line); /* two grids turn about their line */
    assert_fails(ritz_floating_of(&line, &at_foot, &f), RITZ_ERR_ARGUMENT,
                 "grid 12 does not say how it turns");
}

/* ---- other bodies ------------------------------------------------------- */

/* A plane beam of four elements, held or not, reduced to all of its dofs. */
static void make_beam(bool held, const char *damping, ritz_component *body,
                      ritz_reduced *out)
{
    RITZ_OWN(ritz_basis) basis = {0};

    assert_ok(frame_component(4, 0.5, &frame_mcdaniel, held, false, FREE_FIRST,
                              body));
    snprintf(body->damping, sizeof body->damping, "%s", damping);
    assert_ok(ritz_basis_new(body->num_dofs, body->num_dofs, &basis));
    for (int64_t i = 0; i < body->num_dofs; i++)
        ritz_dense_col(&basis.T, i)[i] = 1.0;
    assert_ok(ritz_reduce(body, &basis, out));
}

static void a_plane_beam_has_three_rigid_motions(void **state)
{
    (void)state;
    RITZ_OWN(ritz_component) body = {0}, held = {0};
    RITZ_OWN(ritz_reduced) reduced = {0}, clamped = {0};
    RITZ_OWN(ritz_floating) tangent = {0}, none = {0};

    make_beam(false, "", &body, &reduced);
    make_beam(true, "", &held, &clamped);
    assert_ok(ritz_floating_of(
        &reduced, &(ritz_floating_request){"11", "tangent"}, &tangent));
    assert_ok(ritz_floating_of(&clamped, &(ritz_floating_request){0}, &none));
    assert_int_equal(tangent.num_rigid, 3);
    assert_int_equal(none.num_rigid, 0);
    assert_int_equal(tangent.V.ncol, 12);
    /* the beam with its frame at one end is the beam that is clamped there:
       the condition of M is 1e5 */
    assert_near(tangent.lowest_hz, none.lowest_hz, 1e-10 * none.lowest_hz);
    assert_near(tangent.highest_hz, none.highest_hz, 1e-10 * none.highest_hz);
    for (int64_t k = 0; k < 15 * tangent.V.ncol; k++)
        if (k % 3 < 2) /* it turns about z alone */
            assert_near(tangent.turn.val[k], 0.0, 0.0);
    assert_true(ritz_dense_max(&tangent.turn) > 0.0);
    assert_true(tangent.rotates[0]);
}

static void a_body_that_is_held_keeps_its_modes(void **state)
{
    (void)state;
    static const char *const words[] = {"mean-axis", "tangent"};
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};

    make_beam(true, "", &body, &reduced);
    for (int k = 0; k < 2; k++) {
        const ritz_floating_request request = {"13", words[k]};
        ritz_floating f = {0};

        assert_fails(ritz_floating_of(&reduced, &request, &f),
                     RITZ_ERR_ARGUMENT,
                     "of 3 rigid motions 0 are free and in the basis");
    }
}

static void stated_damping_is_in_the_matrix(void **state)
{
    (void)state;
    const ritz_floating_request tangent = {"11", "tangent"};
    RITZ_OWN(ritz_component) modal = {0}, rayleigh = {0};
    RITZ_OWN(ritz_reduced) of_modal = {0}, of_rayleigh = {0};
    RITZ_OWN(ritz_floating) a = {0}, b = {0};

    make_beam(false, "modal 0.02", &modal, &of_modal);
    make_beam(false, "rayleigh 0 0.003", &rayleigh, &of_rayleigh);
    assert_ok(ritz_floating_of(&of_modal, &tangent, &a));
    assert_ok(ritz_floating_of(&of_rayleigh, &tangent, &b));
    /* V are eigenvectors: 2 zeta w, and b w^2 */
    for (int64_t j = 0; j < a.V.ncol; j++)
        for (int64_t i = 0; i < a.V.ncol; i++) {
            const double K = ritz_dense_col(&a.K, i)[i];

            assert_near(ritz_dense_col(&a.D, j)[i],
                        i == j ? 0.04 * sqrt(K) : 0.0,
                        1e-9 * ritz_dense_max(&a.D));
            assert_near(ritz_dense_col(&b.D, j)[i],
                        0.003 * ritz_dense_col(&b.K, j)[i],
                        1e-9 * ritz_dense_max(&b.D));
        }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(energy_is_that_of_the_whole_body),
    cmocka_unit_test(a_body_moved_rigidly_has_no_elastic_force),
    cmocka_unit_test(tangent_and_mean_axes_are_converted_into_each_other),
    cmocka_unit_test(free_modes_have_mean_axes_already),
    cmocka_unit_test(axes_of_displacements_change_nothing),
    cmocka_unit_test(a_recovered_grid_is_a_node_and_holds_a_frame),
    cmocka_unit_test(grids_recovered_in_part_are_left_out),
    cmocka_unit_test(a_rigid_port_holds_a_frame),
    cmocka_unit_test(a_tangent_frame_without_rotation_is_refused),
    cmocka_unit_test(a_plane_beam_has_three_rigid_motions),
    cmocka_unit_test(a_body_that_is_held_keeps_its_modes),
    cmocka_unit_test(stated_damping_is_in_the_matrix),
};

TEST_MODULE(floating_reference, tests, NULL, NULL)
