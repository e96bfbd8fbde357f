/*
 * A scene that spins. A point x_k of body k is at x = R x_k + t in the scene.
 * In the frame of the body, an axis n through c therefore has the direction R'n
 * and goes through R'(c - t). At a rate W the matrices of the body become
 *
 *     K + W^2 (S + KG),   D + W G,
 *     KG = sum_{a <= b} n_a n_b KG_ab + tau KG_tip + KG_turn
 *
 * where KG_ab is the geometric stiffness for the product w_a w_b of rates about
 * its basic axes, and tau is the tension that bodies outboard of it cause at
 * W = 1:
 *
 *     tau = e . sum_j m_j d_j
 *
 * The sum is over the bodies that joints connect to the first body only through
 * this one. m_j is the mass of such a body, d_j the vector from the axis to its
 * centre of mass, and e the direction from the axis to the port that holds
 * them. Components of their force perpendicular to e are left out.
 *
 * KG_turn is that of the rotation of the body as a whole: see spin_turn.c. A
 * rigid body has it, and a flexible one for which the scene names no load.
 */
#include "assembly/spin.h"

#include "base/alloc.h"
#include "base/text.h"
#include "base/tolerances.h"
#include "base/vector.h"
#include "model/spin.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

ritz_status ritz_spin_refuse(const ritz_scene *scene)
{
    RITZ_REFUSE_IF(scene->spin.given, RITZ_ERR_ARGUMENT,
                   "%s:%" PRId64 ":%" PRId64
                   ": a scene that spins is for ritz-assemble, without --full, "
                   "and ritz-simulate",
                   scene->path, scene->spin.line, scene->spin.column);
    return RITZ_OK;
}

/* The axis in the frame of body k: its direction, and its point nearest to the
   basic origin. */
static void find_axis(const ritz_scene_spin *spin, const ritz_dense *places,
                      int64_t k, double n[3], double foot[3])
{
    double R[9], t[3], along = 0.0;

    ritz_spin_take_place(places, k, R, t);
    for (int a = 0; a < 3; a++)
        t[a] = spin->through[a] - t[a];
    ritz_turn_back(R, spin->axis, n);
    ritz_turn_back(R, t, foot);
    along = ritz_dot(n, foot);
    for (int a = 0; a < 3; a++)
        foot[a] -= along * n[a];
}

static ritz_status check_pull(const ritz_stage *stage,
                              const ritz_spin_outlet *outlet)
{
    RITZ_REFUSE_IF(outlet->unknown >= 0, RITZ_ERR_ARGUMENT,
                   "the mass of '%s', which pulls its tip, is not known",
                   stage->scene->component[outlet->unknown].name);
    return RITZ_OK;
}

static ritz_status find_tension(const ritz_stage *stage,
                                const ritz_dense *places, int64_t k,
                                const ritz_spin_joints *joints, double *out)
{
    const ritz_spin_outlet *outlet = joints->outlet;
    double arm[3], length = 0.0;

    RITZ_REFUSE_IF(joints->count != 1, RITZ_ERR_ARGUMENT,
                   "'tip' is of one joint that leads outboard, and there are "
                   "%" PRId64,
                   joints->count);
    RITZ_CHECK(check_pull(stage, outlet));
    ritz_spin_arm(&stage->scene->spin, places, k, outlet->port->origin, arm);
    length = sqrt(ritz_dot(arm, arm));
    RITZ_REFUSE_IF(!(length > 0.0), RITZ_ERR_ARGUMENT,
                   "'tip' needs a port away from the axis, and '%s' is on it",
                   outlet->port->name);
    *out = ritz_dot(arm, outlet->pull) / length;
    return RITZ_OK;
}

/* Factor n_a n_b of a geometric stiffness. */
static double weight_of(int which, const double n[3])
{
    static const int pair[][2] = {
        [RITZ_STIFFENING_XX] = {0, 0}, [RITZ_STIFFENING_YY] = {1, 1},
        [RITZ_STIFFENING_ZZ] = {2, 2}, [RITZ_STIFFENING_XY] = {0, 1},
        [RITZ_STIFFENING_YZ] = {1, 2}, [RITZ_STIFFENING_XZ] = {0, 2}};

    return n[pair[which][0]] * n[pair[which][1]];
}

/* Geometric stiffness is that of a body which turns about its basic origin:
   refuse an axis that misses the origin. */
static ritz_status check_origin(const ritz_reduced *body, const double foot[3])
{
    const double away = sqrt(ritz_dot(foot, foot));
    double size = away;

    for (int64_t p = 0; p < body->num_ports; p++)
        size = fmax(size,
                    sqrt(ritz_dot(body->port[p].origin, body->port[p].origin)));
    for (int64_t g = 0; g < body->grids.count; g++)
        size = fmax(size, sqrt(ritz_dot(body->grids.position + 3 * g,
                                        body->grids.position + 3 * g)));
    RITZ_REFUSE_IF(away > RITZ_SPIN_AWAY * size, RITZ_ERR_ARGUMENT,
                   "its stiffening is of a spin about its basic origin, which "
                   "is %.3g from the axis",
                   away);
    return RITZ_OK;
}

static ritz_status add_load(const ritz_reduced *body, const char *name,
                            double weight, ritz_dense *KG)
{
    const ritz_names names = {"load", body->num_loads, body->load[0].name,
                              sizeof *body->load};
    int64_t at = 0;

    RITZ_REFUSE_IF(body->num_loads == 0, RITZ_ERR_ARGUMENT,
                   "there is no load '%s': the model holds no geometric "
                   "stiffness",
                   name);
    RITZ_CHECK(ritz_words_find(&names, name, &at));
    if (!KG->val)
        RITZ_CHECK(ritz_dense_new(body->K.nrow, body->K.ncol, KG));
    ritz_dense_add(weight, &body->load[at].KG, KG);
    return RITZ_OK;
}

static ritz_status stiffen_body(const ritz_stage *stage,
                                const ritz_dense *places, int64_t k,
                                const ritz_spin_joints *joints,
                                const double n[3], const double foot[3],
                                ritz_dense *KG)
{
    const ritz_scene_component *item = &stage->scene->component[k];
    bool spins = false;

    for (int s = 0; s < RITZ_NUM_STIFFENINGS; s++) {
        double weight = 0.0;

        if (!*item->stiffening[s])
            continue;
        if (s == RITZ_STIFFENING_TIP)
            RITZ_CHECK(find_tension(stage, places, k, joints, &weight));
        else
            weight = weight_of(s, n);
        spins = spins || s != RITZ_STIFFENING_TIP;
        RITZ_CHECK_IN(
            ritz_stiffening_word[s],
            add_load(&stage->body[k], item->stiffening[s], weight, KG));
    }
    return spins ? check_origin(&stage->body[k], foot) : RITZ_OK;
}

/* The motion of a body as a whole: of a rigid one its own, of a flexible one
   that of the port by which it is held; {0}: there is none. */
static ritz_status find_motion(const ritz_reduced *body,
                               const ritz_port_map *inlet, const double from[3],
                               ritz_dense *motion)
{
    bool rigid = false;

    RITZ_CHECK(ritz_spin_rigid_motion(body, from, &rigid, motion));
    if (rigid)
        return RITZ_OK;
    ritz_dense_free(motion);
    return inlet && ritz_dense_max(&body->K) > 0.0
               ? ritz_spin_port_motion(body, inlet, from, motion)
               : RITZ_OK;
}

/* B += sum f a' of bodies outboard, a being measured from a point. */
static ritz_status add_pulls(const ritz_stage *stage, const ritz_dense *places,
                             int64_t k, const ritz_spin_joints *joints,
                             const double from[3], double B[9])
{
    double R[9], t[3], pull[3];

    ritz_spin_take_place(places, k, R, t);
    for (int64_t j = 0; j < joints->count; j++) {
        const ritz_spin_outlet *outlet = &joints->outlet[j];

        RITZ_CHECK(check_pull(stage, outlet));
        ritz_turn_back(R, outlet->pull, pull);
        for (int i = 0; i < 9; i++)
            B[i] += pull[i / 3] * (outlet->port->origin[i % 3] - from[i % 3]);
    }
    return RITZ_OK;
}

/* B of the arm between the port that holds body k and the body's own port: the
   body and all bodies outboard of it pull at the end of the arm. */
static ritz_status find_arm_pull(const ritz_stage *stage,
                                 const ritz_dense *places, int64_t k,
                                 const ritz_spin_joints *joints, double B[9])
{
    const ritz_inertia *of = &stage->body[k].inertia;
    double R[9], t[3], arm[3], pull[3], a[3];

    ritz_spin_arm(&stage->scene->spin, places, k, of->centre, pull);
    for (int i = 0; i < 3; i++) {
        pull[i] *= of->mass;
        a[i] = joints->inlet->origin[i] - joints->from[i];
    }
    for (int64_t j = 0; j < joints->count; j++) {
        RITZ_CHECK(check_pull(stage, &joints->outlet[j]));
        for (int i = 0; i < 3; i++)
            pull[i] += joints->outlet[j].pull[i];
    }
    ritz_spin_take_place(places, k, R, t);
    ritz_turn_back(R, pull, arm);
    for (int i = 0; i < 9; i++)
        B[i] = arm[i / 3] * a[i % 3];
    return RITZ_OK;
}

/* Add the stiffness of the rotation of body k as a whole about the port that
   holds it. Loads that the scene names include the body's own stiffness, but
   not that of an arm to it. */
static ritz_status stiffen_turn(const ritz_stage *stage,
                                const ritz_dense *places, int64_t k,
                                const ritz_spin_joints *joints,
                                const double n[3], const double foot[3],
                                ritz_dense *KG)
{
    const ritz_reduced *body = &stage->body[k];
    const double *from = joints->from;
    RITZ_OWN(ritz_dense) motion = {0};
    double B[9] = {0.0};

    if (!body->inertia.known)
        return RITZ_OK;
    if (ritz_spin_names_load(&stage->scene->component[k])) {
        if (!joints->inlet)
            return RITZ_OK;
        RITZ_CHECK(ritz_spin_port_motion(body, joints->inlet, from, &motion));
        RITZ_CHECK(find_arm_pull(stage, places, k, joints, B));
        return ritz_spin_add_turn(B, &motion, KG);
    }
    RITZ_CHECK(find_motion(body, joints->inlet, from, &motion));
    if (!motion.val)
        return RITZ_OK;
    ritz_spin_add_mass(&body->inertia, n, foot, from, B);
    RITZ_CHECK(add_pulls(stage, places, k, joints, from, B));
    return ritz_spin_add_turn(B, &motion, KG);
}

static ritz_status find_stiffening(const ritz_stage *stage,
                                   const ritz_dense *places, int64_t k,
                                   const double n[3], const double foot[3],
                                   ritz_dense *KG)
{
    RITZ_OWN(ritz_spin_joints) joints = {0};

    RITZ_CHECK(ritz_spin_joints_of(stage, places, k, &joints));
    RITZ_CHECK(stiffen_body(stage, places, k, &joints, n, foot, KG));
    return stiffen_turn(stage, places, k, &joints, n, foot, KG);
}

static ritz_status find_body_terms(const ritz_stage *stage,
                                   const ritz_dense *places, int64_t k,
                                   ritz_spin_terms *out)
{
    const ritz_scene *scene = stage->scene;
    const ritz_scene_component *item = &scene->component[k];
    RITZ_OWN(ritz_spin_terms) terms = {0};
    ritz_status status = RITZ_OK;
    double n[3], foot[3];

    find_axis(&scene->spin, places, k, n, foot);
    status = ritz_spin_terms_of(&stage->body[k].invariants, n, foot, &terms);
    if (status == RITZ_OK)
        status = find_stiffening(stage, places, k, n, foot, &terms.KG);
    RITZ_CHECK(ritz_scene_context(scene, status, item->line, item->column,
                                  "component", item->name));
    ritz_spin_terms_keep(scene->spin.model, &terms);
    RITZ_MOVE(*out, terms);
    return RITZ_OK;
}

static ritz_status check_spin(const ritz_stage *stage)
{
    RITZ_REFUSE_IF(ritz_dual_is_due(stage), RITZ_ERR_ARGUMENT,
                   "bodies joined by interface forces (dual-craig-bampton) do "
                   "not spin here");
    return RITZ_OK;
}

ritz_status ritz_stage_spin(const ritz_stage *stage,
                            const ritz_configuration *at, ritz_spin_terms *out)
{
    RITZ_OWN(ritz_spin_terms) sum = {0};

    RITZ_REFUSE_IF(!stage->scene->spin.given, RITZ_ERR_ARGUMENT,
                   "the scene has no 'spin'");
    RITZ_CHECK(check_spin(stage));
    for (int64_t k = 0; k < stage->count; k++) {
        RITZ_OWN(ritz_spin_terms) body = {0};

        RITZ_CHECK(find_body_terms(stage, &at->places, k, &body));
        RITZ_CHECK(ritz_spin_terms_add(&body, &at->P[k], &sum));
    }
    RITZ_MOVE(*out, sum);
    return RITZ_OK;
}

/* The first product of rates that is not 0 and for which the body names no
   geometric stiffness. */
static int find_missing_stiffening(const ritz_scene_component *item,
                                   const double n[3])
{
    for (int s = 0; s < RITZ_STIFFENING_TIP; s++)
        if (fabs(weight_of(s, n)) > RITZ_SAME && !*item->stiffening[s])
            return s;
    return RITZ_NUM_STIFFENINGS;
}

ritz_status ritz_stage_missing_stiffening(const ritz_stage *stage,
                                          const ritz_configuration *at,
                                          int64_t k, int *out)
{
    double n[3], foot[3];
    bool flexible = false;

    RITZ_CHECK(ritz_spin_is_flexible(&stage->body[k], &flexible));
    find_axis(&stage->scene->spin, &at->places, k, n, foot);
    *out = flexible ? find_missing_stiffening(&stage->scene->component[k], n)
                    : RITZ_NUM_STIFFENINGS;
    return RITZ_OK;
}

/* ---- a stage at a constant rate ----------------------------------------- */

void ritz_spun_free(ritz_spun *spun)
{
    for (int64_t k = 0; spun->stage.body && k < spun->stage.count; k++) {
        ritz_dense_free(&spun->stage.body[k].K);
        ritz_dense_free(&spun->stage.body[k].D);
    }
    RITZ_FREE(spun->stage.body);
    ritz_io_free(&spun->stage.io);
    *spun = (ritz_spun){0};
}

/* A body whose K and D are those at a rate W; its other parts are borrowed. */
static ritz_status spin_body(const ritz_reduced *at_rest,
                             const ritz_spin_terms *terms, double W,
                             ritz_reduced *body)
{
    RITZ_OWN(ritz_dense) K = {0}, D = {0};

    RITZ_CHECK(ritz_dense_copy(&at_rest->K, &K));
    if (terms->S.val)
        ritz_dense_add(W * W, &terms->S, &K);
    if (terms->KG.val)
        ritz_dense_add(W * W, &terms->KG, &K);
    if (at_rest->D.val)
        RITZ_CHECK(ritz_dense_copy(&at_rest->D, &D));
    if (terms->G.val) {
        if (!D.val)
            RITZ_CHECK(ritz_dense_new(K.nrow, K.ncol, &D));
        ritz_dense_add(W, &terms->G, &D);
    }
    *body = *at_rest;
    body->K = (ritz_dense){0};
    body->D = (ritz_dense){0};
    RITZ_MOVE(body->K, K);
    RITZ_MOVE(body->D, D);
    return RITZ_OK;
}

/* Inputs and outputs with one more input, the centrifugal load. */
static ritz_status extend_inputs(const ritz_io *own, int64_t n, ritz_io *out)
{
    const ritz_names names = {"input", own->num_inputs, *own->input,
                              RITZ_NAME_SIZE};
    const int64_t m = own->num_inputs, p = own->num_outputs;
    RITZ_OWN(ritz_io) io = {0};

    RITZ_REFUSE_IF(ritz_names_index(&names, RITZ_SPIN_INPUT) >= 0,
                   RITZ_ERR_ARGUMENT,
                   "input '" RITZ_SPIN_INPUT
                   "' is the load of the spin: give yours another name");
    RITZ_CHECK(ritz_io_new(n, m + 1, p, &io));
    for (int64_t j = 0; j < m; j++)
        memcpy(io.input[j], own->input[j], sizeof io.input[j]);
    snprintf(io.input[m], sizeof io.input[m], RITZ_SPIN_INPUT);
    for (int64_t j = 0; j < p; j++) {
        memcpy(io.output[j], own->output[j], sizeof io.output[j]);
        io.limit[j] = own->limit[j];
    }
    ritz_dense_put(&own->B, 0, 0, &io.B);
    ritz_dense_put(&own->C, 0, 0, &io.C);
    ritz_dense_put(&own->Cv, 0, 0, &io.Cv);
    ritz_dense_put(&own->Ca, 0, 0, &io.Ca);
    RITZ_MOVE(*out, io);
    return RITZ_OK;
}

ritz_status ritz_stage_spun(const ritz_stage *stage, const double *setting,
                            ritz_spun *out)
{
    const double W = ritz_spin_rate_at(&stage->scene->spin.rate, 0.0);
    RITZ_OWN(ritz_spun) spun = {.stage = *stage};
    RITZ_OWN(ritz_dense) places = {0};
    double *load = NULL;

    spun.stage.body = NULL;
    spun.stage.io = (ritz_io){0};
    RITZ_CHECK(check_spin(stage));
    RITZ_CHECK(ritz_place_stage(stage, setting, &places));
    RITZ_CHECK(
        extend_inputs(&stage->io, stage->num_coordinates, &spun.stage.io));
    load = ritz_dense_col(&spun.stage.io.B, stage->io.num_inputs);
    RITZ_CHECK_NEW(spun.stage.body, stage->count);
    for (int64_t k = 0; k < stage->count; k++) {
        RITZ_OWN(ritz_spin_terms) terms = {0};

        RITZ_CHECK(find_body_terms(stage, &places, k, &terms));
        RITZ_CHECK(spin_body(&stage->body[k], &terms, W, &spun.stage.body[k]));
        for (int64_t j = 0; j < terms.load.nrow; j++)
            load[stage->first[k] + j] = W * W * terms.load.val[j];
    }
    RITZ_MOVE(*out, spun);
    return RITZ_OK;
}
