/*
 * Bodies are placed one after the other through the joints: a point x_B of the
 * second body is, in the axes of the first, at o_A + d + R (x_B - o_B), the
 * origins being those of the ports.
 *
 * When the joint that closes a loop is reached, both its bodies are placed
 * already. Its settings are written with a few digits and fit to that accuracy
 * only, and a gap of rounded digits would take a rigid motion from the system.
 * Its R and d are therefore those of the placements.
 */
#include "assembly/assembly.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "base/vector.h"

#include <math.h>
#include <string.h>

/* x_system = R x + t. */
typedef struct placement {
    bool known;
    double R[9];
    double t[3];
} placement;

/*
 * A joint's relation of its two bodies: x - near of the first is R (x - far).
 */
typedef struct link {
    int64_t body[2];
    double near[3]; /* o_A + d */
    double far[3];  /* o_B */
    const double *R;
    bool turns_freely;
} link;

/*
 * Whether a joint's ports exist; if not, the joint itself refuses them later.
 */
static bool find_link(const ritz_stage *stage, int64_t j,
                      const ritz_joint_pose *pose, link *out)
{
    const ritz_joint *joint = &stage->scene->joint[j];
    const ritz_port_map *port[2];

    for (int k = 0; k < 2; k++) {
        out->body[k] = joint->between[k].component;
        port[k] = ritz_reduced_port(&stage->body[out->body[k]],
                                    joint->between[k].port);
        if (!port[k])
            return false;
    }
    for (int i = 0; i < 3; i++) {
        out->near[i] = port[0]->origin[i] + pose[j].d[i];
        out->far[i] = port[1]->origin[i];
    }
    out->R = pose[j].R;
    out->turns_freely = joint->type == RITZ_JOINT_SPHERICAL;
    return true;
}

/*
 * With R_A, t_A known: R_B = R_A R and t_B = R_A (o_A + d - R o_B) + t_A; with
 * the second body known the same holds with R' and the ends exchanged.
 */
static void place_neighbour(const placement *known, const double *R,
                            const double *near, const double *far,
                            placement *out)
{
    double turned[3], gap[3];

    ritz_turn_product(known->R, R, out->R);
    ritz_turn_apply(R, far, turned);
    for (int i = 0; i < 3; i++)
        turned[i] = near[i] - turned[i];
    ritz_turn_apply(known->R, turned, gap);
    for (int i = 0; i < 3; i++)
        out->t[i] = gap[i] + known->t[i];
    out->known = true;
}

static void transpose_rotation(const double *R, double *out)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[3 * i + j] = R[3 * j + i];
}

/*
 * Go once through the joints; returns whether a body was placed. With
 * `turns_freely` one body is placed through a joint that does not prescribe its
 * rotation.
 */
static bool place_through_joints(const ritz_stage *stage,
                                 const ritz_joint_pose *pose, bool turns_freely,
                                 placement *place)
{
    bool found = false;

    for (int64_t j = 0; j < stage->scene->num_joints; j++) {
        link at;
        placement *a = NULL, *b = NULL;
        double back[9];

        if (!find_link(stage, j, pose, &at) || at.turns_freely != turns_freely)
            continue;
        a = &place[at.body[0]];
        b = &place[at.body[1]];
        if (a->known == b->known)
            continue;
        transpose_rotation(at.R, back);
        if (a->known)
            place_neighbour(a, at.R, at.near, at.far, b);
        else
            place_neighbour(b, back, at.far, at.near, a);
        found = true;
        if (turns_freely)
            return true;
    }
    return found;
}

/*
 * Place every body through the joints; bodies without joints stay where they
 * are. A spherical joint prescribes a body's rotation only if no other joint
 * does.
 */
static void place_bodies(const ritz_stage *stage, const ritz_joint_pose *pose,
                         placement *place)
{
    for (int64_t k = 0; k < stage->count; k++) {
        if (place[k].known)
            continue;
        place[k] = (placement){true, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0}};
        while (place_through_joints(stage, pose, false, place) ||
               place_through_joints(stage, pose, true, place))
            ;
    }
}

/* Bodies and joints at settings of a scene, as these say; a loop may not
   close. */
static void find_places(const ritz_stage *stage, const double *setting,
                        ritz_joint_pose *pose, placement *body)
{
    for (int64_t j = 0; j < stage->scene->num_joints; j++)
        ritz_joint_pose_at(&stage->scene->joint[j], setting, &pose[j]);
    place_bodies(stage, pose, body);
}

static double vector_norm(const double *x)
{
    return sqrt(ritz_dot(x, x));
}

/*
 * Misfit of a loop: its gap, relative to the size of its bodies, and its angle.
 */
typedef struct misfit {
    double gap, size, turn;
} misfit;

/* The second body as placed by this joint, compared with its placement. */
static misfit measure_misfit(const link *at, const placement *place)
{
    const placement *b = &place[at->body[1]];
    misfit found = {
        0.0, vector_norm(at->near) + vector_norm(at->far) + vector_norm(b->t),
        0.0};
    placement due = {0};
    double here[3], there[3];

    place_neighbour(&place[at->body[0]], at->R, at->near, at->far, &due);
    ritz_turn_apply(due.R, at->far, here);
    ritz_turn_apply(b->R, at->far, there);
    for (int i = 0; i < 3; i++)
        here[i] += due.t[i] - there[i] - b->t[i];
    found.gap = vector_norm(here);
    for (int i = 0; i < 9; i++)
        found.turn = fmax(found.turn, fabs(due.R[i] - b->R[i]));
    return found;
}

/*
 * R = R_A'R_B, d = R_A'(R_B o_B + t_B - t_A) - o_A, from the bodies'
 * placements.
 */
static void derive_pose(const link *at, const placement *place,
                        ritz_joint_pose *pose)
{
    const placement *a = &place[at->body[0]];
    const placement *b = &place[at->body[1]];
    double there[3], seen[3], back[9];

    ritz_turn_apply(b->R, at->far, there);
    for (int i = 0; i < 3; i++)
        there[i] += b->t[i] - a->t[i];
    ritz_turn_back(a->R, there, seen);
    for (int i = 0; i < 3; i++) /* near is o_A + d of the settings */
        pose->d[i] += seen[i] - at->near[i];
    transpose_rotation(a->R, back);
    ritz_turn_product(back, b->R, pose->R);
}

static ritz_status close_joint(const ritz_stage *stage, int64_t j,
                               const link *at, const placement *place,
                               ritz_joint_pose *pose)
{
    const ritz_joint *joint = &stage->scene->joint[j];
    const ritz_scene_component *component = stage->scene->component;
    const misfit found = measure_misfit(at, place);

    if (found.gap <= RITZ_PLACEMENT_ROUNDING * found.size &&
        found.turn <= RITZ_PLACEMENT_ROUNDING)
        return RITZ_OK;
    RITZ_REFUSE_IF(
        found.gap > RITZ_LOOP_CLOSURE * found.size, RITZ_ERR_ARGUMENT,
        "closes a loop of joints that does not meet: '%s/%s' and "
        "'%s/%s' stand %.3g apart",
        component[at->body[0]].name, joint->between[0].port,
        component[at->body[1]].name, joint->between[1].port, found.gap);
    RITZ_REFUSE_IF(found.turn > RITZ_LOOP_CLOSURE && !at->turns_freely,
                   RITZ_ERR_ARGUMENT,
                   "closes a loop of joints whose angles do not agree: '%s' is "
                   "turned otherwise against '%s' by the other joints",
                   component[at->body[1]].name, component[at->body[0]].name);
    derive_pose(at, place, pose);
    return RITZ_OK;
}

ritz_status ritz_place_joints(const ritz_stage *stage, const double *setting,
                              ritz_joint_pose *pose)
{
    const ritz_scene *scene = stage->scene;
    RITZ_OWN_ARRAY placement *body = NULL;

    RITZ_CHECK_NEW(body, stage->count);
    find_places(stage, setting, pose, body);
    for (int64_t j = 0; j < scene->num_joints; j++) {
        const ritz_joint *joint = &scene->joint[j];
        link at;

        if (find_link(stage, j, pose, &at))
            RITZ_CHECK(ritz_scene_context(
                scene, close_joint(stage, j, &at, body, &pose[j]), joint->line,
                joint->column, "joint", joint->name));
    }
    return RITZ_OK;
}

/* The grids of all bodies, at their positions in a configuration. */

/*
 * Numbers are kept where the bodies' ranges do not overlap; else body k adds k
 * 10^p.
 */
static void renumber_grids(int64_t count, const ritz_component *body,
                           int64_t *add)
{
    int64_t power = 1;
    int64_t highest = -1;
    bool overlap = false;

    for (int64_t k = 0; k < count; k++) {
        int64_t least = INT64_MAX;
        int64_t most = -1;
        int64_t n = body[k].num_dofs;

        for (int64_t i = 0; i < n + body[k].recovery.count; i++) {
            int64_t grid =
                i < n ? body[k].dof[i].grid : body[k].recovery.dof[i - n].grid;

            least = grid < least ? grid : least;
            most = grid > most ? grid : most;
        }
        overlap = overlap || least <= highest;
        highest = most > highest ? most : highest;
    }
    while (highest >= power && power < INT64_MAX / 1000)
        power *= 10;
    for (int64_t k = 0; k < count; k++)
        add[k] = overlap ? k * power : 0;
}

/* Make room for a grid among those that are there, which ascend. */
static int64_t insert_grid(int64_t id, ritz_grids *to)
{
    int64_t at = to->count++;

    for (; at > 0 && to->id[at - 1] > id; at--) {
        to->id[at] = to->id[at - 1];
        to->frame[at] = to->frame[at - 1];
        memcpy(to->position + 3 * at, to->position + 3 * (at - 1),
               3 * sizeof *to->position);
    }
    to->id[at] = id;
    return at;
}

/* Add the grids of one body. */
static void add_grids(const ritz_grids *from, const placement *place,
                      int64_t add, ritz_grids *to)
{
    for (int64_t i = 0; i < from->count; i++) {
        const int64_t at = insert_grid(from->id[i] + add, to);
        double *x = to->position + 3 * at;

        ritz_turn_apply(place->R, from->position + 3 * i, x);
        for (int64_t k = 0; k < 3; k++)
            x[k] += place->t[k];
        to->frame[at] = to->num_frames + from->frame[i];
    }
    for (int64_t f = 0; f < from->num_frames; f++)
        for (int64_t k = 0; k < 3; k++)
            ritz_turn_apply(place->R, from->axes + 9 * f + 3 * k,
                            to->axes + 9 * (to->num_frames + f) + 3 * k);
    to->num_frames += from->num_frames;
}

ritz_status ritz_place_grids(const ritz_stage *stage, const double *setting,
                             int64_t count, const ritz_component *body,
                             int64_t *add, ritz_grids *out)
{
    RITZ_OWN_ARRAY placement *place = NULL;
    RITZ_OWN_ARRAY ritz_joint_pose *pose = NULL;
    RITZ_OWN(ritz_grids) all = {0};
    int64_t grids = 0;
    int64_t frames = 1;

    for (int64_t k = 0; k < count; k++) {
        grids += body[k].grids.count;
        frames += body[k].grids.num_frames;
    }
    RITZ_CHECK_NEW(all.id, grids);
    RITZ_CHECK_NEW(all.position, 3 * grids);
    RITZ_CHECK_NEW(all.frame, grids);
    RITZ_CHECK_NEW(all.axes, 9 * frames);
    RITZ_CHECK_NEW(place, stage->count);
    RITZ_CHECK_NEW(pose, stage->scene->num_joints);
    find_places(stage, setting, pose, place);
    renumber_grids(count, body, add);
    all.num_frames = 1;
    for (int64_t k = 0; k < 3; k++)
        all.axes[4 * k] = 1.0;
    for (int64_t k = 0; k < count; k++)
        add_grids(&body[k].grids, &place[k], add[k], &all);
    RITZ_MOVE(*out, all);
    return RITZ_OK;
}

/*
 * Mass and momentum of all bodies at their positions in a configuration. For a
 * body at x = R x_b + t the rigid motions of the whole are, by its own r_b,
 *
 *     r = r_b X',    X = [R  0; [t]x R  R],
 *
 * so that R'M P = sum_b X_b (r_b'M_b T_b) P_b and R'MR = sum_b X_b (r_b'M_b
 * r_b) X_b'.
 */

enum { DIRECTIONS = 6, MASSES = 36 };

/* X of a placement, 6 x 6. */
static void fill_transport(const placement *place, ritz_dense *X)
{
    for (int64_t j = 0; j < 3; j++) {
        const double axis[3] = {place->R[j], place->R[3 + j], place->R[6 + j]};
        double moment[3];

        ritz_cross(place->t, axis, moment);
        for (int64_t i = 0; i < 3; i++) {
            ritz_dense_col(X, j)[i] = axis[i];
            ritz_dense_col(X, j)[3 + i] = moment[i];
            ritz_dense_col(X, 3 + j)[i] = 0.0;
            ritz_dense_col(X, 3 + j)[3 + i] = axis[i];
        }
    }
}

static ritz_status add_body(const ritz_invariants *own, const ritz_dense *X,
                            const ritz_dense *P, ritz_configuration *c)
{
    double rigid[MASSES];
    const ritz_dense mass = {DIRECTIONS, DIRECTIONS, rigid};
    RITZ_OWN(ritz_dense) XL = {0}, L = {0}, XM = {0}, all = {0};

    memcpy(rigid, own->rigid, sizeof rigid);
    RITZ_CHECK(ritz_dense_mul(X, &own->momentum, &XL));
    RITZ_CHECK(ritz_dense_mul(&XL, P, &L));
    RITZ_CHECK(ritz_dense_mul(X, &mass, &XM));
    RITZ_CHECK(ritz_dense_mul_nt(&XM, X, &all));
    ritz_dense_add(1.0, &L, &c->momentum);
    for (int64_t k = 0; k < MASSES; k++)
        c->rigid[k] += all.val[k];
    return RITZ_OK;
}

static ritz_status keep_places(int64_t count, const placement *body,
                               ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(count, 12, out));
    for (int64_t k = 0; k < count; k++)
        for (int64_t j = 0; j < 12; j++)
            ritz_dense_col(out, j)[k] = j < 9 ? body[k].R[j] : body[k].t[j - 9];
    return RITZ_OK;
}

ritz_status ritz_place_posed(const ritz_stage *stage,
                             const ritz_joint_pose *pose, ritz_dense *out)
{
    RITZ_OWN_ARRAY placement *body = NULL;

    RITZ_CHECK_NEW(body, stage->count);
    place_bodies(stage, pose, body);
    return keep_places(stage->count, body, out);
}

ritz_status ritz_place_stage(const ritz_stage *stage, const double *setting,
                             ritz_dense *out)
{
    RITZ_OWN_ARRAY ritz_joint_pose *pose = NULL;

    RITZ_CHECK_NEW(pose, stage->scene->num_joints);
    RITZ_CHECK(ritz_place_joints(stage, setting, pose));
    return ritz_place_posed(stage, pose, out);
}

ritz_status ritz_place_configuration(const ritz_stage *stage,
                                     const double *setting,
                                     ritz_configuration *configuration)
{
    RITZ_OWN_ARRAY placement *body = NULL;
    RITZ_OWN_ARRAY ritz_joint_pose *pose = NULL;
    RITZ_OWN(ritz_dense) X = {0};

    RITZ_CHECK_NEW(body, stage->count);
    RITZ_CHECK_NEW(pose, stage->scene->num_joints);
    RITZ_CHECK(ritz_place_joints(stage, setting, pose));
    place_bodies(stage, pose, body);
    RITZ_CHECK(keep_places(stage->count, body, &configuration->places));
    for (int64_t k = 0; k < stage->count; k++)
        if (!stage->body[k].invariants.momentum.val)
            return RITZ_OK;
    RITZ_CHECK(ritz_dense_new(DIRECTIONS, DIRECTIONS, &X));
    RITZ_CHECK(ritz_dense_new(DIRECTIONS, configuration->K.ncol,
                              &configuration->momentum));
    for (int64_t k = 0; k < stage->count; k++) {
        fill_transport(&body[k], &X);
        RITZ_CHECK(add_body(&stage->body[k].invariants, &X,
                            &configuration->P[k], configuration));
    }
    return RITZ_OK;
}
