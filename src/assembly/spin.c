/*
 * A scene that spins. A point x_k of body k is at x = R x_k + t in the scene.
 * In the frame of the body, an axis n through c therefore has the direction R'n
 * and goes through R'(c - t). At a rate W the matrices of the body become
 *
 *     K + W^2 (S + KG),   D + W G,
 *     KG = sum_{a <= b} n_a n_b KG_ab + tau KG_tip
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
 */
#include "assembly/assembly.h"

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

/* Row k of placements: R row by row, and t. */
static void take_place(const ritz_dense *places, int64_t k, double R[9],
                       double t[3])
{
    for (int64_t j = 0; j < 12; j++)
        *(j < 9 ? &R[j] : &t[j - 9]) = ritz_dense_col(places, j)[k];
}

/* The axis in the frame of body k: its direction, and its point nearest to the
   basic origin. */
static void find_axis(const ritz_scene_spin *spin, const ritz_dense *places,
                      int64_t k, double n[3], double foot[3])
{
    double R[9], t[3], along = 0.0;

    take_place(places, k, R, t);
    for (int a = 0; a < 3; a++)
        t[a] = spin->through[a] - t[a];
    ritz_turn_back(R, spin->axis, n);
    ritz_turn_back(R, t, foot);
    along = ritz_dot(n, foot);
    for (int a = 0; a < 3; a++)
        foot[a] -= along * n[a];
}

/* Vector from the axis to a point of body k, in the frame of the scene. */
static void find_arm(const ritz_scene_spin *spin, const ritz_dense *places,
                     int64_t k, const double *point, double arm[3])
{
    double R[9], t[3], along = 0.0;

    take_place(places, k, R, t);
    ritz_turn_apply(R, point, arm);
    for (int a = 0; a < 3; a++)
        arm[a] += t[a] - spin->through[a];
    along = ritz_dot(spin->axis, arm);
    for (int a = 0; a < 3; a++)
        arm[a] -= along * spin->axis[a];
}

/* Bodies that joints connect to @p start without passing through body k. */
static void reach_bodies(const ritz_scene *scene, int64_t start, int64_t k,
                         bool *reached)
{
    bool more = true;

    reached[start] = true;
    while (more) {
        more = false;
        for (int64_t j = 0; j < scene->num_joints; j++) {
            const int64_t a = scene->joint[j].between[0].component;
            const int64_t b = scene->joint[j].between[1].component;

            if (a == k || b == k || reached[a] == reached[b])
                continue;
            reached[a] = reached[b] = more = true;
        }
    }
}

/* The only joint between body k and a body that is not `inboard`, and the side
   of the joint on which body k is. */
static ritz_status find_outlet(const ritz_scene *scene, int64_t k,
                               const bool *inboard, const ritz_joint **joint,
                               int *side)
{
    int count = 0;

    for (int64_t j = 0; j < scene->num_joints; j++)
        for (int s = 0; s < 2; s++) {
            const ritz_scene_place *end = scene->joint[j].between;

            if (end[s].component != k || inboard[end[1 - s].component])
                continue;
            *joint = &scene->joint[j];
            *side = s;
            count++;
        }
    RITZ_REFUSE_IF(count != 1, RITZ_ERR_ARGUMENT,
                   "'tip' is of one joint that leads outboard, and there are "
                   "%d",
                   count);
    return RITZ_OK;
}

/* Sum of m_j d_j of the bodies outboard of the joint. */
static ritz_status pull_of(const ritz_stage *stage, const ritz_dense *places,
                           int64_t start, int64_t k, double pull[3])
{
    RITZ_OWN_ARRAY bool *reached = NULL;

    RITZ_CHECK_NEW(reached, stage->count);
    reach_bodies(stage->scene, start, k, reached);
    for (int64_t j = 0; j < stage->count; j++) {
        const ritz_inertia *of = &stage->body[j].inertia;
        double arm[3];

        if (!reached[j])
            continue;
        RITZ_REFUSE_IF(!of->known, RITZ_ERR_ARGUMENT,
                       "the mass of '%s', which pulls its tip, is not known",
                       stage->scene->component[j].name);
        find_arm(&stage->scene->spin, places, j, of->centre, arm);
        for (int a = 0; a < 3; a++)
            pull[a] += of->mass * arm[a];
    }
    return RITZ_OK;
}

static ritz_status find_tension(const ritz_stage *stage,
                                const ritz_dense *places, int64_t k,
                                double *out)
{
    const ritz_scene *scene = stage->scene;
    RITZ_OWN_ARRAY bool *inboard = NULL;
    const ritz_joint *joint = NULL;
    const ritz_port_map *port = NULL;
    double pull[3] = {0.0}, arm[3], length = 0.0;
    int side = 0;

    RITZ_CHECK_NEW(inboard, stage->count);
    if (k > 0)
        reach_bodies(scene, 0, k, inboard);
    RITZ_CHECK(find_outlet(scene, k, inboard, &joint, &side));
    RITZ_CHECK(
        pull_of(stage, places, joint->between[1 - side].component, k, pull));
    port = ritz_reduced_port(&stage->body[k], joint->between[side].port);
    if (!port) /* assembly refuses such a joint */
        return RITZ_ERR_ARGUMENT;
    find_arm(&scene->spin, places, k, port->origin, arm);
    length = sqrt(ritz_dot(arm, arm));
    RITZ_REFUSE_IF(!(length > 0.0), RITZ_ERR_ARGUMENT,
                   "'tip' needs a port away from the axis, and '%s' is on it",
                   joint->between[side].port);
    *out = ritz_dot(arm, pull) / length;
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
            RITZ_CHECK(find_tension(stage, places, k, &weight));
        else
            weight = weight_of(s, n);
        spins = spins || s != RITZ_STIFFENING_TIP;
        RITZ_CHECK_IN(
            ritz_stiffening_word[s],
            add_load(&stage->body[k], item->stiffening[s], weight, KG));
    }
    return spins ? check_origin(&stage->body[k], foot) : RITZ_OK;
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
        status = stiffen_body(stage, places, k, n, foot, &terms.KG);
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
static int find_lack(const ritz_scene_component *item, const double n[3])
{
    for (int s = 0; s < RITZ_STIFFENING_TIP; s++)
        if (fabs(weight_of(s, n)) > RITZ_SAME && !*item->stiffening[s])
            return s;
    return RITZ_NUM_STIFFENINGS;
}

int ritz_stage_spin_lacks(const ritz_stage *stage, const ritz_configuration *at,
                          int64_t k)
{
    double n[3], foot[3];

    if (ritz_dense_max(&stage->body[k].K) == 0.0)
        return RITZ_NUM_STIFFENINGS;
    find_axis(&stage->scene->spin, &at->places, k, n, foot);
    return find_lack(&stage->scene->component[k], n);
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
