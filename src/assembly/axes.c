/*
 * Axes of joints in closed loops. A scene gives them with a few digits, and an
 * axis that is off by this rounding from a direction with which the loop can
 * move locks the motion.
 *
 * If bodies are taken as rigid, each motion k that a joint allows is a twist: a
 * rotation, and the velocity at a point o that moves with the body,
 *
 *     a_k = (s, (x - o) x s) of an axis s through x,   a_k = (0, s) of a slide,
 *
 * and the rates of all joints close every loop: A q = 0, six rows for each loop
 * that the joints close. The motions of the system are the null space of A. Let
 * A = U S V', and U_2, V_2 the vectors of all singular values but the first r.
 * Axes with A of rank r are found by Newton's method: turns t of the axes with
 *
 *     U_2'A V_2 + sum_k t_k (U_2'd_k) (v_k V_2) = 0,   d_k = da/dt_k,
 *
 * v_k V_2 being the row of V_2 that belongs to the motion. Its normal equations
 * have the matrix of products (d_j'U_2 U_2'd_k) (v_j V_2 V_2'v_k').
 *
 * Turns up to the digits of a scene are made. The joints' rows and forces are
 * then those of the turned axes, whatever the bodies are; where bodies stand is
 * left as the settings say.
 */
#include "assembly/assembly.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "base/vector.h"
#include "linear/general.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TWIST = 6, MOST_PASSES = 12 };

/* A motion that a joint allows, in the axes of the first body of its tree. */
typedef struct joint_motion {
    int64_t joint;
    int which; /* axis of the joint; -1: the motion has none that may turn */
    bool turns;
    double R[9];  /* of the body in whose axes the joint has it */
    double at[3]; /* a point of the axis */
    double given[3], now[3];
    double normal[2][3]; /* directions in which it may be turned, or zero */
    double turned;       /* angle from given to now */
} joint_motion;

typedef struct loops {
    ritz_loops of;
    double *origin; /* 3 of each loop */
    double *size;
    int64_t num_motions, room;
    joint_motion *motion;
} loops;

static void free_loops(loops *l)
{
    ritz_loops_free(&l->of);
    free(l->origin);
    free(l->size);
    free(l->motion);
}

/* The motions that joints allow. */

/* Rotation and place of a body, rows of ritz_configuration.places. */
static void read_place(const ritz_dense *places, int64_t body, double R[9],
                       double t[3])
{
    for (int64_t i = 0; i < 12; i++)
        *(i < 9 ? &R[i] : &t[i - 9]) = ritz_dense_col(places, i)[body];
}

/* The point at which a joint acts: the origin of its second port. */
static void find_point(const ritz_stage *stage, const ritz_dense *places,
                       const ritz_joint *joint, double out[3])
{
    const ritz_scene_place *end = &joint->between[1];
    double R[9], t[3];

    read_place(places, end->component, R, t);
    ritz_turn_apply(
        R, ritz_reduced_port(&stage->body[end->component], end->port)->origin,
        out);
    for (int i = 0; i < 3; i++)
        out[i] += t[i];
}

/* How an axis may be turned; in a plane model a hinge's may not. */
static void find_ways(ritz_plane plane, joint_motion *m)
{
    double n[3] = {0.0, 0.0, 0.0};

    if (m->which < 0)
        return;
    if (plane == RITZ_PLANE_NONE) {
        ritz_joint_normals(m->now, m->normal);
        return;
    }
    n[plane - 1] = m->turns ? 0.0 : 1.0;
    ritz_cross(n, m->now, m->normal[0]);
}

/* The motion of number @p k, counted from 0, of a joint. */
static ritz_status add_motion(const ritz_stage *stage, const ritz_dense *places,
                              int64_t j, int k, loops *l)
{
    const ritz_joint *joint = &stage->scene->joint[j];
    const bool second = joint->type == RITZ_JOINT_UNIVERSAL && k == 1;
    const double basic[3] = {k == 0, k == 1, k == 2};
    const bool spherical = joint->type == RITZ_JOINT_SPHERICAL;
    joint_motion *m = NULL;
    double t[3];

    if (joint->freedom[k].state == RITZ_LOCKED ||
        (spherical && !ritz_plane_has(joint->plane, k + 4)))
        return RITZ_OK;
    RITZ_CHECK_ROOM(l->motion, l->num_motions, l->room);
    m = &l->motion[l->num_motions++];
    *m = (joint_motion){.joint = j,
                        .which = spherical ? -1 : k,
                        .turns = joint->type != RITZ_JOINT_SLIDER};
    read_place(places, joint->between[second].component, m->R, t);
    ritz_turn_apply(m->R, spherical ? basic : joint->axis[k], m->given);
    memcpy(m->now, m->given, sizeof m->now);
    find_point(stage, places, joint, m->at);
    find_ways(joint->plane, m);
    return RITZ_OK;
}

static int count_motions(ritz_joint_type type)
{
    switch (type) {
    case RITZ_JOINT_HINGE:
    case RITZ_JOINT_SLIDER:
        return 1;
    case RITZ_JOINT_UNIVERSAL:
        return 2;
    case RITZ_JOINT_SPHERICAL:
        return 3;
    case RITZ_JOINT_FIXED:
    case RITZ_JOINT_BUSHING:
    case RITZ_JOINT_RIGID:
        break;
    }
    return 0;
}

/* Mean and extent of the points at which the joints of a loop act. */
static void measure_loop(const ritz_stage *stage, const ritz_dense *places,
                         loops *l, int64_t k)
{
    const double *sign = l->of.sign + k * l->of.num_joints;
    double *middle = l->origin + 3 * k;
    int64_t count = 0;

    for (int pass = 0; pass < 2; pass++)
        for (int64_t j = 0; j < l->of.num_joints; j++) {
            double x[3], arm[3];

            if (sign[j] == 0.0)
                continue;
            find_point(stage, places, &stage->scene->joint[j], x);
            count += pass == 0;
            for (int i = 0; i < 3; i++)
                if (pass == 0)
                    middle[i] += (x[i] - middle[i]) / (double)count;
                else
                    arm[i] = x[i] - middle[i];
            if (pass == 1)
                l->size[k] = fmax(l->size[k], sqrt(ritz_dot(arm, arm)));
        }
    if (l->size[k] == 0.0)
        l->size[k] = 1.0;
}

static ritz_status find_motions(const ritz_stage *stage,
                                const ritz_dense *places, loops *l)
{
    for (int64_t k = 0; k < l->of.count; k++)
        measure_loop(stage, places, l, k);
    for (int64_t j = 0; j < l->of.num_joints; j++) {
        const ritz_joint *joint = &stage->scene->joint[j];
        bool closes = false;

        for (int64_t k = 0; k < l->of.count; k++)
            closes = closes || l->of.sign[k * l->of.num_joints + j] != 0.0;
        for (int k = 0; closes && k < count_motions(joint->type); k++)
            RITZ_CHECK(add_motion(stage, places, j, k, l));
    }
    return RITZ_OK;
}

/* The rank of A. */

/* The twist of a motion, or its derivative, along s in all loops. */
static void fill_twist(const loops *l, const joint_motion *m, const double s[3],
                       double *to)
{
    for (int64_t k = 0; k < l->of.count; k++) {
        const double sign = l->of.sign[k * l->of.num_joints + m->joint];
        double arm[3], moment[3];

        for (int i = 0; i < 3; i++)
            arm[i] = (m->at[i] - l->origin[3 * k + i]) / l->size[k];
        ritz_cross(arm, s, moment);
        for (int i = 0; i < 3; i++) {
            to[TWIST * k + i] = m->turns ? sign * s[i] : 0.0;
            to[TWIST * k + 3 + i] = sign * (m->turns ? moment[i] : s[i]);
        }
    }
}

/* A = U diag(s) V' */
typedef struct decomposed {
    ritz_dense U, V;
    double *s;
    int64_t least, rank;
} decomposed;

static void free_decomposed(decomposed *d)
{
    ritz_dense_free(&d->U);
    ritz_dense_free(&d->V);
    free(d->s);
    *d = (decomposed){0};
}

static ritz_status decompose(const loops *l, decomposed *d)
{
    RITZ_OWN(ritz_dense) A = {0};

    free_decomposed(d);
    RITZ_CHECK(ritz_dense_new(TWIST * l->of.count, l->num_motions, &A));
    for (int64_t k = 0; k < l->num_motions; k++)
        fill_twist(l, &l->motion[k], l->motion[k].now, ritz_dense_col(&A, k));
    RITZ_CHECK_IN("loops", ritz_general_svd(&A, &d->U, &d->s, &d->V));
    d->least = A.nrow < A.ncol ? A.nrow : A.ncol;
    while (d->rank < d->least && d->s[d->rank] > RITZ_NEGLIGIBLE * d->s[0])
        d->rank++;
    return RITZ_OK;
}

/* The normal equations of the turns. Turns 2 k and 2 k + 1 are of motion k. */
typedef struct turns {
    ritz_dense N;
    double *right;
    double left; /* |U_2'A V_2|^2 */
} turns;

static void free_turns(turns *t)
{
    ritz_dense_free(&t->N);
    free(t->right);
    *t = (turns){0};
}

static ritz_status multiply_turns(const ritz_dense *G, const ritz_dense *H,
                                  turns *t)
{
    RITZ_OWN(ritz_dense) GG = {0}, HH = {0};

    RITZ_CHECK(ritz_dense_mul_tn(G, G, &GG));
    RITZ_CHECK(ritz_dense_mul_tn(H, H, &HH));
    RITZ_CHECK(ritz_dense_new(G->ncol, G->ncol, &t->N));
    for (int64_t j = 0; j < G->ncol; j++)
        for (int64_t i = 0; i < G->ncol; i++)
            ritz_dense_col(&t->N, j)[i] =
                ritz_dense_col(&GG, j)[i] * ritz_dense_col(&HH, j / 2)[i / 2];
    return RITZ_OK;
}

/* The equations for rank @p r. */
static ritz_status make_turns(const loops *l, const decomposed *d, int64_t r,
                              turns *t)
{
    const ritz_dense U_2 = ritz_dense_part(&d->U, r, d->U.ncol - r);
    const ritz_dense V_2 = ritz_dense_part(&d->V, r, d->V.ncol - r);
    RITZ_OWN(ritz_dense) D = {0}, G = {0}, H = {0};

    RITZ_CHECK(ritz_dense_new(TWIST * l->of.count, 2 * l->num_motions, &D));
    for (int64_t k = 0; k < D.ncol; k++)
        fill_twist(l, &l->motion[k / 2], l->motion[k / 2].normal[k % 2],
                   ritz_dense_col(&D, k));
    RITZ_CHECK(ritz_dense_mul_tn(&U_2, &D, &G));
    RITZ_CHECK(ritz_general_transpose(&V_2, &H));
    RITZ_CHECK(multiply_turns(&G, &H, t));
    RITZ_CHECK_NEW(t->right, D.ncol);
    for (int64_t i = 0; r + i < d->least; i++) {
        t->left += d->s[r + i] * d->s[r + i];
        for (int64_t k = 0; k < D.ncol; k++)
            t->right[k] -= d->s[r + i] * ritz_dense_col(&G, k)[i] *
                           ritz_dense_col(&H, k / 2)[i];
    }
    return RITZ_OK;
}

/* N x of turns first, first + 1, ... of all. */
static double multiply_row(const turns *all, int64_t first, int64_t i,
                           int64_t n, const double *x)
{
    double sum = 0.0;

    for (int64_t k = 0; k < n; k++)
        sum += ritz_dense_col(&all->N, first + k)[first + i] * x[k];
    return sum;
}

/* x := N^-1 x, without eigenvectors of the value 0. */
static ritz_status solve_symmetric(const ritz_dense *N, double *x)
{
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN_ARRAY double *right = NULL;
    const int64_t n = N->nrow;

    RITZ_CHECK_COPY(right, x, n);
    RITZ_CHECK_IN("loops", ritz_general_symmetric(N, &pairs));
    memset(x, 0, (size_t)n * sizeof *x);
    for (int64_t k = 0; k < n; k++) {
        const double *y = ritz_dense_col(&pairs.Phi, k);
        double part = 0.0;

        if (pairs.lambda[k] <= RITZ_RANK_LOSS * pairs.lambda[n - 1])
            continue;
        for (int64_t i = 0; i < n; i++)
            part += y[i] * right[i];
        for (int64_t i = 0; i < n; i++)
            x[i] += part / pairs.lambda[k] * y[i];
    }
    return RITZ_OK;
}

/*
 * Turns t of motions first to first + count - 1 that minimise U_2'A V_2 and,
 * among these, the total turns c + t, with c the turns so far:
 * N (c + t) = right + N c. @p left is the relative remainder of U_2'A V_2.
 */
static ritz_status solve_turns(const loops *l, const turns *all, int64_t first,
                               int64_t count, double *t, double *left)
{
    const int64_t n = 2 * count, f = 2 * first;
    RITZ_OWN(ritz_dense) N = {0};
    RITZ_OWN_ARRAY double *c = NULL;
    double rest = all->left;

    RITZ_CHECK_NEW(c, n);
    RITZ_CHECK(ritz_dense_block(&all->N, f, n, f, n, &N));
    for (int64_t k = 0; k < n; k++) {
        const joint_motion *m = &l->motion[first + k / 2];

        c[k] = -ritz_dot(m->normal[k % 2], m->given);
    }
    for (int64_t k = 0; k < n; k++)
        t[k] = all->right[f + k] + multiply_row(all, f, k, n, c);
    RITZ_CHECK(solve_symmetric(&N, t));
    for (int64_t k = 0; k < n; k++)
        t[k] -= c[k];
    for (int64_t k = 0; k < n; k++)
        rest +=
            t[k] * (multiply_row(all, f, k, n, t) - 2.0 * all->right[f + k]);
    *left = sqrt(fmax(rest, 0.0) / all->left);
    return RITZ_OK;
}

/* Turn an axis within its normals. */
static void turn_motion(ritz_plane plane, const double t[2], joint_motion *m)
{
    double across[3], length = 0.0;

    for (int i = 0; i < 3; i++)
        m->now[i] += t[0] * m->normal[0][i] + t[1] * m->normal[1][i];
    length = sqrt(ritz_dot(m->now, m->now));
    for (int i = 0; i < 3; i++)
        m->now[i] /= length;
    ritz_cross(m->given, m->now, across);
    m->turned = sqrt(ritz_dot(across, across));
    find_ways(plane, m);
}

/*
 * Newton's method for rank @p r by turns of motions first to first + count - 1.
 * If it does not converge, or an axis turns too far, *found is false.
 */
static ritz_status try_turns(const ritz_scene *scene, int64_t r, int64_t first,
                             int64_t count, loops *l, bool *found)
{
    [[gnu::cleanup(free_decomposed)]] decomposed d = {0};
    RITZ_OWN_ARRAY double *t = NULL;
    double before = HUGE_VAL;

    *found = false;
    RITZ_CHECK_NEW(t, 2 * count);
    for (int pass = 0; pass < MOST_PASSES; pass++) {
        [[gnu::cleanup(free_turns)]] turns all = {0};
        double left = 0.0, most = 0.0;

        RITZ_CHECK(decompose(l, &d));
        if (*found || d.s[r] > 0.5 * before)
            return RITZ_OK;
        *found = d.rank <= r; /* one step more makes it exact */
        if (d.s[r] == 0.0)
            return RITZ_OK;
        before = d.s[r];
        RITZ_CHECK(make_turns(l, &d, r, &all));
        RITZ_CHECK(solve_turns(l, &all, first, count, t, &left));
        for (int64_t k = 0; k < 2 * count; k++)
            most = fmax(most, fabs(t[k]));
        if (left > RITZ_AXIS_LEFT || most > 2.0 * RITZ_AXIS_NEAR)
            return RITZ_OK;
        for (int64_t k = 0; k < count; k++) {
            joint_motion *m = &l->motion[first + k];

            turn_motion(scene->joint[m->joint].plane, t + 2 * k, m);
        }
    }
    return RITZ_OK;
}

/* Count the other axes of the loops that are parallel to a motion's axis, to a
   small part of the angle by which it was turned. */
static int64_t count_parallel(const loops *l, const joint_motion *m)
{
    int64_t count = 0;

    for (int64_t k = 0; k < l->num_motions; k++) {
        double across[3];

        ritz_cross(l->motion[k].now, m->now, across);
        count += (l->motion[k].joint != m->joint ||
                  l->motion[k].which != m->which) &&
                 sqrt(ritz_dot(across, across)) <= RITZ_AXIS_SHARE * m->turned;
    }
    return count;
}

/*
 * The one axis by whose turn alone rank @p r is reached, -1 if there is none. Of
 * several it is the one that is parallel to most others then; of these the one
 * that turns least, and of equal ones the last, as positions are those of the
 * last joint of a loop.
 */
static ritz_status choose_axis(const ritz_scene *scene, const loops *l,
                               int64_t r, int64_t *chosen)
{
    [[gnu::cleanup(free_decomposed)]] decomposed d = {0};
    [[gnu::cleanup(free_turns)]] turns all = {0};
    double least = HUGE_VAL;
    int64_t most = 0;

    *chosen = -1;
    RITZ_CHECK(decompose(l, &d));
    RITZ_CHECK(make_turns(l, &d, r, &all));
    for (int64_t k = 0; k < l->num_motions; k++) {
        joint_motion m = l->motion[k];
        double t[2] = {0.0, 0.0}, left = 1.0;
        int64_t parallel = 0;

        RITZ_CHECK(solve_turns(l, &all, k, 1, t, &left));
        if (left > RITZ_AXIS_LEFT)
            continue;
        turn_motion(scene->joint[m.joint].plane, t, &m);
        parallel = count_parallel(l, &m);
        if (parallel < most ||
            (parallel == most && m.turned > least * RITZ_AXIS_TIE))
            continue;
        least = parallel > most ? m.turned : fmin(least, m.turned);
        most = parallel;
        *chosen = k;
    }
    return RITZ_OK;
}

/* Turn one axis, or else all, so that A has rank @p r. */
static ritz_status reach_rank(const ritz_scene *scene, int64_t r,
                              const joint_motion *before, loops *l, bool *found)
{
    int64_t one = -1;

    *found = false;
    RITZ_CHECK(choose_axis(scene, l, r, &one));
    if (one >= 0)
        RITZ_CHECK(try_turns(scene, r, one, 1, l, found));
    if (*found)
        return RITZ_OK;
    memcpy(l->motion, before, (size_t)l->num_motions * sizeof *before);
    return try_turns(scene, r, 0, l->num_motions, l, found);
}

/* What is done with the axes. */

/* List the axis that was turned most; @p taken: its turn stays. */
static ritz_status list_axis(const loops *l, const joint_motion *before,
                             bool taken, ritz_near_axes *out)
{
    const joint_motion *most = NULL;
    double angle = 0.0;
    int64_t others = 0;

    for (int pass = 0; pass < 2; pass++)
        for (int64_t k = 0; k < l->num_motions; k++) {
            double across[3], turn = 0.0;

            ritz_cross(before[k].now, l->motion[k].now, across);
            turn = sqrt(ritz_dot(across, across));
            if (pass == 1)
                others += turn > RITZ_AXIS_SHARE * angle;
            else if (turn > angle) {
                angle = turn;
                most = &l->motion[k];
            }
        }
    if (!out || !most || angle <= RITZ_SAME)
        return RITZ_OK;
    RITZ_CHECK_ROOM(out->item, out->count, out->room);
    out->item[out->count] = (ritz_near_axis){.joint = most->joint,
                                             .which = most->which,
                                             .angle = angle,
                                             .taken = taken,
                                             .others = others - 1};
    ritz_turn_back(most->R, most->now, out->item[out->count++].exact);
    return RITZ_OK;
}

/* One motion more of the loops, if axes within the digits of a scene leave it;
   *more is false where none is found. */
static ritz_status release_motion(const ritz_scene *scene, loops *l, bool *more,
                                  ritz_near_axes *out)
{
    [[gnu::cleanup(free_decomposed)]] decomposed d = {0};
    RITZ_OWN_ARRAY joint_motion *before = NULL;
    double most = 0.0;

    *more = false;
    RITZ_CHECK(decompose(l, &d));
    if (d.rank == 0 || d.s[d.rank - 1] > RITZ_AXIS_NEAR * d.s[0])
        return RITZ_OK;
    RITZ_CHECK_COPY(before, l->motion, l->num_motions);
    RITZ_CHECK(reach_rank(scene, d.rank - 1, before, l, more));
    for (int64_t k = 0; k < l->num_motions; k++)
        most = fmax(most, l->motion[k].turned);
    if (*more && most <= RITZ_AXIS_NEAR)
        RITZ_CHECK(list_axis(l, before, most <= RITZ_LOOP_CLOSURE, out));
    *more = *more && most <= RITZ_LOOP_CLOSURE;
    if (!*more)
        memcpy(l->motion, before, (size_t)l->num_motions * sizeof *before);
    return RITZ_OK;
}

ritz_status ritz_settle_axes(const ritz_stage *stage, ritz_joint_pose *pose,
                             ritz_near_axes *out)
{
    [[gnu::cleanup(free_loops)]] loops l = {0};
    RITZ_OWN(ritz_dense) places = {0};
    bool more = true;

    RITZ_CHECK(ritz_loops_of(stage, &l.of));
    if (l.of.count == 0)
        return RITZ_OK;
    RITZ_CHECK_NEW(l.origin, 3 * l.of.count);
    RITZ_CHECK_NEW(l.size, l.of.count);
    RITZ_CHECK(ritz_place_posed(stage, pose, &places));
    RITZ_CHECK(find_motions(stage, &places, &l));
    while (more && l.num_motions > 0)
        RITZ_CHECK(release_motion(stage->scene, &l, &more, out));
    for (int64_t k = 0; k < l.num_motions; k++) {
        const joint_motion *m = &l.motion[k];

        if (m->turned > 0.0)
            ritz_turn_back(m->R, m->now, pose[m->joint].axis[m->which]);
    }
    return RITZ_OK;
}

ritz_status ritz_stage_near_axes(const ritz_stage *stage, const double *setting,
                                 ritz_near_axes *out)
{
    RITZ_OWN(ritz_near_axes) found = {0};
    RITZ_OWN_ARRAY ritz_joint_pose *pose = NULL;

    RITZ_CHECK_NEW(pose, stage->scene->num_joints);
    RITZ_CHECK(ritz_place_joints(stage, setting, pose));
    RITZ_CHECK(ritz_settle_axes(stage, pose, &found));
    RITZ_MOVE(*out, found);
    return RITZ_OK;
}

void ritz_near_axes_free(ritz_near_axes *axes)
{
    free(axes->item);
    *axes = (ritz_near_axes){0};
}
