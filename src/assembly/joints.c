#include "assembly/assembly.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "base/vector.h"

#include <inttypes.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void ritz_turn_about(const double axis[static 3], double degrees,
                     double R[static 9])
{
    /* quarter turns are exact, so that 90 degrees swaps axes and no more */
    double quarter = fmod(degrees, 90.0) == 0.0
                         ? fmod(fmod(degrees / 90.0, 4.0) + 4.0, 4.0)
                         : -1.0;
    static const double sines[] = {0.0, 1.0, 0.0, -1.0, 0.0};
    double s =
        quarter >= 0.0 ? sines[(int)quarter] : sin(degrees * RITZ_PI / 180.0);
    double c = quarter >= 0.0 ? sines[(int)quarter + 1]
                              : cos(degrees * RITZ_PI / 180.0);
    const double skew[9] = {0.0,      -axis[2], axis[1], axis[2], 0.0,
                            -axis[0], -axis[1], axis[0], 0.0};

    for (int64_t i = 0; i < 3; i++)
        for (int64_t j = 0; j < 3; j++)
            R[3 * i + j] = (i == j ? c : 0.0) + s * skew[3 * i + j] +
                           (1.0 - c) * axis[i] * axis[j];
}

void ritz_turn_product(const double A[static 9], const double B[static 9],
                       double C[static 9])
{
    for (int64_t i = 0; i < 3; i++)
        for (int64_t j = 0; j < 3; j++)
            C[3 * i + j] = A[3 * i] * B[j] + A[3 * i + 1] * B[3 + j] +
                           A[3 * i + 2] * B[6 + j];
}

void ritz_turn_apply(const double R[static 9], const double x[static 3],
                     double y[static 3])
{
    for (int64_t i = 0; i < 3; i++)
        y[i] = R[3 * i] * x[0] + R[3 * i + 1] * x[1] + R[3 * i + 2] * x[2];
}

void ritz_turn_back(const double R[static 9], const double x[static 3],
                    double y[static 3])
{
    for (int64_t i = 0; i < 3; i++)
        y[i] = R[i] * x[0] + R[3 + i] * x[1] + R[6 + i] * x[2];
}

/* x / |x|. */
static void normalise_vector(double x[static 3])
{
    double length = sqrt(ritz_dot(x, x));

    for (int i = 0; i < 3; i++)
        x[i] /= length;
}

void ritz_joint_normals(const double axis[static 3], double e[static 2][3])
{
    double start[3] = {0.0, 0.0, 0.0};
    int least = 0;

    for (int i = 1; i < 3; i++)
        if (fabs(axis[i]) < fabs(axis[least]))
            least = i;
    start[least] = 1.0;
    ritz_cross(axis, start, e[0]);
    normalise_vector(e[0]);
    ritz_cross(axis, e[0], e[1]);
}

/*
 * The relations of joints between the displacements u and rotations theta of
 * two ports, each along the basic axes of its own body. At rest a point x_B of
 * the second body is at o_A + d + R (x_B - o_B) in the axes of the first, o
 * being the ports' origins. Their relative motion is taken at the second port's
 * origin, to which the grids have the arms p_A = o_A + d - x_A and p_B = o_B -
 * x_B:
 *
 *     delta = R (u_B + theta_B x p_B) - (u_A + theta_A x p_A)
 *     phi   = R theta_B - theta_A
 *
 * A joint is six directions e in the first body's axes, three for e'delta and
 * three for e'phi, each of them locked, free or caged: on a spring and damper.
 * For plane models only the two e'delta and the one e'phi in the plane remain.
 *
 *     type        R                   d         free are
 *     hinge       R(a, angle)         0         a'phi
 *     slider      I                   s a       a'delta
 *     universal   R(a, one) R(b, two) 0         g_1'phi, g_2'phi
 *     spherical   I                   0         phi
 *     bushing     I                   0         delta and phi, caged
 *     rigid       I                   offset    none
 *
 * In a loop R and d follow from the other joints (placement.c), and axes from
 * the motion that they leave (axes.c).
 *
 * The axes of a universal joint now point along a and c = R b, as b is fixed in
 * the second body. n = a x c / |a x c| is the direction about which the joint
 * locks; angles q_1, q_2 about a and c, phi = a q_1 + c q_2, are those of the
 * dual basis, q_k = g_k'phi with g_1 = c x n / a'(c x n) and
 * g_2 = n x a / c'(n x a).
 */

/* Directions e of a joint: three of translation, then three of rotation. */
typedef void point(const ritz_joint *joint, const ritz_joint_pose *pose,
                   double e[6][3]);

static void fill_basic(double e[3][3])
{
    for (int i = 0; i < 9; i++)
        e[i / 3][i % 3] = i % 4 == 0 ? 1.0 : 0.0;
}

static void point_basic(const ritz_joint *joint, const ritz_joint_pose *pose,
                        double e[6][3])
{
    (void)joint;
    (void)pose;
    fill_basic(e);
    fill_basic(e + 3);
}

static void point_hinge(const ritz_joint *joint, const ritz_joint_pose *pose,
                        double e[6][3])
{
    (void)joint;
    fill_basic(e);
    memcpy(e[3], pose->axis[0], sizeof e[3]);
    ritz_joint_normals(e[3], e + 4);
}

static void point_slider(const ritz_joint *joint, const ritz_joint_pose *pose,
                         double e[6][3])
{
    (void)joint;
    memcpy(e[0], pose->axis[0], sizeof e[0]);
    ritz_joint_normals(e[0], e + 1);
    fill_basic(e + 3);
}

/* g = v / (a'v) */
static void make_dual(const double *a, const double *v, double *g)
{
    for (int i = 0; i < 3; i++)
        g[i] = v[i] / ritz_dot(a, v);
}

static void point_universal(const ritz_joint *joint,
                            const ritz_joint_pose *pose, double e[6][3])
{
    const double *a = pose->axis[0];
    double c[3], v[3];

    (void)joint;
    fill_basic(e);
    ritz_turn_apply(pose->R, pose->axis[1], c);
    ritz_cross(a, c, e[5]);
    normalise_vector(e[5]);
    ritz_cross(c, e[5], v);
    make_dual(a, v, e[3]);
    ritz_cross(e[5], a, v);
    make_dual(c, v, e[4]);
}

/* The first axis, the second in the plane of both, the third normal to it. */
static void point_bushing(const ritz_joint *joint, const ritz_joint_pose *pose,
                          double e[6][3])
{
    (void)pose;
    memcpy(e[0], joint->axis[0], sizeof e[0]);
    ritz_cross(joint->axis[0], joint->axis[1], e[2]);
    normalise_vector(e[2]);
    ritz_cross(e[2], e[0], e[1]);
    memcpy(e + 3, e, 3 * sizeof e[0]);
}

/* The directions that are freedoms of the joint: the first of them, ... */
static const struct {
    const char *called;
    point *point;
    int freedom[6]; /* counted from 1; 0: always locked */
} kinds[] = {
    [RITZ_JOINT_FIXED] = {"fixed joint", point_basic, {0}},
    [RITZ_JOINT_HINGE] = {"hinge", point_hinge, {0, 0, 0, 1, 0, 0}},
    [RITZ_JOINT_SLIDER] = {"slider", point_slider, {1, 0, 0, 0, 0, 0}},
    [RITZ_JOINT_UNIVERSAL] = {"universal joint",
                              point_universal,
                              {0, 0, 0, 1, 2, 0}},
    [RITZ_JOINT_SPHERICAL] = {"spherical joint",
                              point_basic,
                              {0, 0, 0, 1, 2, 3}},
    [RITZ_JOINT_BUSHING] = {"bushing", point_bushing, {1, 2, 3, 4, 5, 6}},
    [RITZ_JOINT_RIGID] = {"rigid joint", point_basic, {0}},
};

/* Row of a direction of the grid that starts at port row @p first, or -1. */
static int64_t find_direction(const ritz_port_map *port, int64_t first,
                              int64_t direction)
{
    for (int64_t k = first; k < port->count; k++)
        if (port->dof[k].grid == port->dof[first].grid &&
            port->dof[k].component == direction)
            return k;
    return -1;
}

/* Marks in place of a port row for a direction that the grid does not have:
   OUT_OF_PLANE for a motion out of a plane model's plane, which is zero;
   ABSENT - k for any other direction k, 0-5. */
enum { OUT_OF_PLANE = -1, ABSENT = -2 };

static const char directions[][3] = {"T1", "T2", "T3", "R1", "R2", "R3"};

/* A hint for models that seem to lie in a plane, because exactly two
   translations are there. */
static const char *guess_plane(const int64_t row[static 6])
{
    static const char *const words[] = {
        "", ": models in a plane are joined where the scene says 'plane: yz'",
        ": models in a plane are joined where the scene says 'plane: xz'",
        ": models in a plane are joined where the scene says 'plane: xy'"};
    int missing = 0, across = 0;

    for (int k = 0; k < 3; k++)
        if (row[k] < 0) {
            missing++;
            across = k + 1;
        }
    return words[missing == 1 ? across : 0];
}

/* Port rows of the six directions of a joint's only grid. In space all six are
   needed; in a plane only those in which the joint's relations have a
   coefficient. */
static ritz_status find_six(const ritz_joint_end *end, const ritz_joint *joint,
                            int64_t row[static 6])
{
    const ritz_port_map *port = end->port;
    const char *called = kinds[joint->type].called;
    const bool plane = joint->plane != RITZ_PLANE_NONE;
    int64_t others = 0;
    char missing[64] = "";
    size_t used = 0;

    for (int64_t k = 0; k < port->count; k++)
        others += port->dof[k].component < 1 ||
                  port->dof[k].grid != port->dof[0].grid;
    RITZ_REFUSE_IF(port->count == 0 || others > 0, RITZ_ERR_ARGUMENT,
                   "a %s holds one %sgrid on each side, '%s/%s' has %s", called,
                   plane ? "" : "six-dof ", end->component, port->name,
                   others > 0 ? "more than one grid, or a scalar point"
                              : "no grid");
    for (int64_t k = 0; k < 6; k++) {
        row[k] = find_direction(port, 0, k + 1);
        if (row[k] >= 0)
            continue;
        row[k] =
            ritz_plane_has(joint->plane, k + 1) ? ABSENT - k : OUT_OF_PLANE;
        if (!plane)
            used +=
                (size_t)snprintf(missing + used, sizeof missing - used, "%s%s",
                                 used > 0 ? ", " : "", directions[k]);
    }
    RITZ_REFUSE_IF(missing[0], RITZ_ERR_ARGUMENT,
                   "a %s holds one six-dof grid on each side, grid %" PRId64
                   " of '%s/%s' has no %s%s",
                   called, port->dof[0].grid, end->component, port->name,
                   missing, guess_plane(row));
    return RITZ_OK;
}

/* sum += v'x, x at three port rows; coefficients that are zero and motions out
   of the plane are left out. */
static void add_terms(ritz_relation *r, int end, const int64_t *row,
                      const double *v)
{
    for (int i = 0; i < 3; i++)
        if (v[i] != 0.0 && row[i] != OUT_OF_PLANE) {
            r->row[end][r->num_terms[end]] = row[i];
            r->factor[end][r->num_terms[end]++] = v[i];
        }
}

/*
 * e'phi = (R'e)'theta_B - e'theta_A; with e'(theta x p) = (p x e)'theta
 *
 * e'delta = (R'e)'u_B + (p_B x R'e)'theta_B - e'u_A - (p_A x e)'theta_A
 */
static ritz_relation project_motion(const double *e, bool rotation,
                                    const double *R, const double arm[2][3],
                                    const int64_t row[2][6])
{
    ritz_relation r = {.rotation = rotation};
    double turned[3], lever[3];
    const double *const direction[2] = {e, turned};

    ritz_turn_back(R, e, turned);
    for (int end = 0; end < 2; end++) {
        add_terms(&r, end, row[end] + (rotation ? 3 : 0), direction[end]);
        if (rotation)
            continue;
        ritz_cross(arm[end], direction[end], lever);
        add_terms(&r, end, row[end] + 3, lever);
    }
    return r;
}

/* Arms p from the grids to the point where the bodies are joined. */
static void find_arms(const ritz_joint_end end[static 2],
                      const ritz_joint_pose *pose, double arm[2][3])
{
    for (int i = 0; i < 3; i++) {
        arm[0][i] =
            end[0].port->origin[i] + pose->d[i] - end[0].port->position[i];
        arm[1][i] = end[1].port->origin[i] - end[1].port->position[i];
    }
}

/* Distance of two grids, each measured from its port's origin. */
static double joint_distance(const ritz_joint_end end[static 2], int64_t a,
                             int64_t b)
{
    const ritz_port_map *one = end[0].port, *two = end[1].port;
    double gap[3];

    for (int i = 0; i < 3; i++)
        gap[i] = one->position[3 * a + i] - one->origin[i] -
                 (two->position[3 * b + i] - two->origin[i]);
    return sqrt(ritz_dot(gap, gap));
}

/* 1e-5 of the largest distance of a port's grids from its origin. */
static double joint_tolerance(const ritz_joint *joint,
                              const ritz_port_map *port)
{
    double most = 0.0;

    for (int64_t k = 0; k < port->count; k++) {
        double arm[3];

        for (int i = 0; i < 3; i++)
            arm[i] = port->position[3 * k + i] - port->origin[i];
        most = fmax(most, sqrt(ritz_dot(arm, arm)));
    }
    return joint->tolerance > 0.0
               ? joint->tolerance
               : RITZ_PORT_MATCH * most + RITZ_PORT_MATCH_LEAST;
}

/* Whether a direction of a joint is a motion in the plane. */
static bool is_in_plane(ritz_plane plane, const double *e, bool rotation)
{
    return plane == RITZ_PLANE_NONE || (e[plane - 1] != 0.0) == rotation;
}

/* Refuse a relation of a plane model that needs a direction which the grid does
   not have. */
static ritz_status check_rows(const ritz_relation *r, const ritz_joint *joint,
                              const ritz_joint_end end[static 2])
{
    for (int k = 0; k < 2; k++)
        for (int64_t t = 0; t < r->num_terms[k]; t++)
            RITZ_REFUSE_IF(r->row[k][t] <= ABSENT, RITZ_ERR_ARGUMENT,
                           "a %s holds one grid on each side, grid %" PRId64
                           " of '%s/%s' has no %s",
                           kinds[joint->type].called, end[k].port->dof[0].grid,
                           end[k].component, end[k].port->name,
                           directions[ABSENT - r->row[k][t]]);
    return RITZ_OK;
}

/* State of the directions that a joint type always locks. */
static const ritz_freedom locked = {.state = RITZ_LOCKED};

/* The relations of a joint of one grid on each side. */
static ritz_status relate_six(const ritz_joint *joint,
                              const ritz_joint_end end[static 2],
                              const ritz_joint_pose *pose, ritz_relations *list)
{
    double e[6][3], arm[2][3];
    int64_t row[2][6];

    for (int k = 0; k < 2; k++)
        RITZ_CHECK(find_six(&end[k], joint, row[k]));
    RITZ_REFUSE_IF(joint->type == RITZ_JOINT_BUSHING &&
                       joint_distance(end, 0, 0) >
                           joint_tolerance(joint, end[0].port),
                   RITZ_ERR_ARGUMENT,
                   "a bushing lies between grids at one place, those of "
                   "'%s/%s' and '%s/%s' lie %.3g apart, %.3g is let pass",
                   end[0].component, end[0].port->name, end[1].component,
                   end[1].port->name, joint_distance(end, 0, 0),
                   joint_tolerance(joint, end[0].port));
    kinds[joint->type].point(joint, pose, e);
    find_arms(end, pose, arm);
    for (int k = 0; k < 6; k++) {
        int at = kinds[joint->type].freedom[k];
        const ritz_freedom *freedom =
            at > 0 ? &joint->freedom[at - 1] : &locked;

        if (freedom->state == RITZ_FREE ||
            !is_in_plane(joint->plane, e[k], k >= 3))
            continue;
        RITZ_CHECK_ROOM(list->item, list->count, list->room);
        list->item[list->count] =
            project_motion(e[k], k >= 3, pose->R, arm, row);
        RITZ_CHECK(check_rows(&list->item[list->count], joint, end));
        list->item[list->count++].freedom = freedom;
    }
    return RITZ_OK;
}

/*
 * List the rows at which a new grid begins, scalar points left out; returns
 * their number.
 */
static int64_t list_grids(const ritz_port_map *port, int64_t *first)
{
    int64_t count = 0;

    for (int64_t k = 0; k < port->count; k++)
        if (port->dof[k].component > 0 &&
            (k == 0 || port->dof[k].grid != port->dof[k - 1].grid))
            first[count++] = k;
    return count;
}

/* Append up to six equalities, for the directions that both grids have. */
static ritz_status pair_grids(const ritz_joint_end end[static 2], int64_t a,
                              int64_t b, ritz_relations *list)
{
    for (int64_t direction = 1; direction <= 6; direction++) {
        int64_t i = find_direction(end[0].port, a, direction);
        int64_t j = find_direction(end[1].port, b, direction);

        if (i < 0 || j < 0)
            continue;
        RITZ_CHECK_ROOM(list->item, list->count, list->room);
        list->item[list->count++] = (ritz_relation){
            .rotation = direction > 3,
            .freedom = &locked,
            .num_terms = {1, 1},
            .row = {{i}, {j}},
            .factor = {{1.0}, {1.0}},
        };
    }
    return RITZ_OK;
}

/* The nearest free grid to `grid`, -1 if all are taken. */
static int64_t find_nearest(const ritz_joint_end end[static 2], int64_t grid,
                            int64_t count, const int64_t *first,
                            const bool *taken)
{
    int64_t near = -1;

    for (int64_t j = 0; j < count; j++)
        if (!taken[j] &&
            (near < 0 || joint_distance(end, grid, first[j]) <
                             joint_distance(end, grid, first[near])))
            near = j;
    return near;
}

/* The relations of a fixed joint: every grid of one port is paired with that of
   the other that lies at the same place, from its port's origin. */
static ritz_status pair_joint(const ritz_joint *joint,
                              const ritz_joint_end end[static 2],
                              ritz_relations *list)
{
    const double tolerance = joint_tolerance(joint, end[0].port);
    RITZ_OWN_ARRAY int64_t *near_row = NULL, *far_row = NULL;
    RITZ_OWN_ARRAY bool *taken = NULL;
    int64_t count = 0, others = 0;

    RITZ_CHECK_NEW(near_row, end[0].port->count);
    RITZ_CHECK_NEW(far_row, end[1].port->count);
    count = list_grids(end[0].port, near_row);
    others = list_grids(end[1].port, far_row);
    RITZ_REFUSE_IF(count != others, RITZ_ERR_ARGUMENT,
                   "'%s/%s' has %" PRId64 " grids and '%s/%s' has %" PRId64,
                   end[0].component, end[0].port->name, count, end[1].component,
                   end[1].port->name, others);
    RITZ_CHECK_NEW(taken, count);
    for (int64_t k = 0; k < count; k++) {
        const int64_t a = near_row[k];
        const int64_t near = find_nearest(end, a, count, far_row, taken);
        const int64_t b = far_row[near];

        RITZ_REFUSE_IF(
            joint_distance(end, a, b) > tolerance, RITZ_ERR_ARGUMENT,
            "grid %" PRId64 " of '%s/%s' has no counterpart: the nearest, grid "
            "%" PRId64 " of '%s/%s', lies %.3g away, %.3g is let pass",
            end[0].port->dof[a].grid, end[0].component, end[0].port->name,
            end[1].port->dof[b].grid, end[1].component, end[1].port->name,
            joint_distance(end, a, b), tolerance);
        taken[near] = true;
        RITZ_CHECK(pair_grids(end, a, b, list));
    }
    return RITZ_OK;
}

ritz_status ritz_joint_relate(const ritz_joint *joint,
                              const ritz_joint_end end[static 2],
                              const ritz_joint_pose *pose, ritz_relations *list)
{
    const int64_t before = list->count;
    char what[RITZ_NAME_SIZE + 40];
    ritz_status status = joint->type == RITZ_JOINT_FIXED
                             ? pair_joint(joint, end, list)
                             : relate_six(joint, end, pose, list);

    for (int64_t k = before; k < list->count; k++) {
        list->item[k].joint = joint;
        for (int i = 0; i < 2; i++)
            list->item[k].port[i] = end[i].port;
    }
    if (status == RITZ_OK && list->count == before)
        status = ritz_fail(RITZ_ERR_ARGUMENT,
                           "its ports have no direction in common");
    snprintf(what, sizeof what, "joint '%s'", joint->name);
    return ritz_context(status, what);
}

void ritz_relations_free(ritz_relations *relations)
{
    free(relations->item);
    *relations = (ritz_relations){0};
}

/* As in the table above. */
void ritz_joint_pose_at(const ritz_joint *joint, const double *setting,
                        ritz_joint_pose *out)
{
    double s[2] = {0.0, 0.0};
    double first[9], second[9];

    *out = (ritz_joint_pose){.R = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    memcpy(out->axis, joint->axis, sizeof out->axis);
    for (int64_t k = 0; k < joint->num_sweeps && k < 2; k++)
        s[k] = setting[joint->sweep + k];
    switch (joint->type) {
    case RITZ_JOINT_HINGE:
        ritz_turn_about(joint->axis[0], s[0], out->R);
        break;
    case RITZ_JOINT_SLIDER:
        for (int i = 0; i < 3; i++)
            out->d[i] = s[0] * joint->axis[0][i];
        break;
    case RITZ_JOINT_UNIVERSAL:
        ritz_turn_about(joint->axis[0], s[0], first);
        ritz_turn_about(joint->axis[1], s[1], second);
        ritz_turn_product(first, second, out->R);
        break;
    case RITZ_JOINT_RIGID:
        memcpy(out->d, joint->offset, sizeof out->d);
        break;
    case RITZ_JOINT_FIXED:
    case RITZ_JOINT_SPHERICAL:
    case RITZ_JOINT_BUSHING:
        break;
    }
}
