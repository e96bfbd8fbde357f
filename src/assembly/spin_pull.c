/*
 * An estimate of the stiffness that bodies outboard of a flexible component give
 * it, where the scene names no load `tip`. Its end moves by d across the
 * direction e of the tension tau, relative to the joint that holds it:
 *
 *     d'KG d = (6 / 5) tau d'(I - e e') d / L
 *
 * L is the distance from the end to the farthest grid. A string of the length L
 * has the factor 1. A cantilever that a force at its end bends has 6/5, since
 * its slope is (3/2) (2 x - x^2), x = 0 .. 1, and int slope^2 dx is 6/5. No
 * member that is straight has less than a string, by Cauchy and Schwarz.
 */
#include "assembly/spin.h"

#include "base/alloc.h"
#include "base/vector.h"
#include "model/spin.h"

#include <math.h>

static double distance(const double a[3], const double b[3])
{
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};

    return sqrt(ritz_dot(d, d));
}

/* Distance from a port to the farthest grid or port of the body. */
static double length_from(const ritz_reduced *body, const double *origin)
{
    double length = 0.0;

    for (int64_t p = 0; p < body->num_ports; p++)
        length = fmax(length, distance(body->port[p].origin, origin));
    for (int64_t g = 0; g < body->grids.count; g++)
        length = fmax(length, distance(body->grids.position + 3 * g, origin));
    return length;
}

/* Translation of the end relative to the inlet, 3 x r. */
static ritz_status find_deflection(const ritz_reduced *body,
                                   const ritz_spin_joints *joints,
                                   const ritz_port_map *end, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) motion = {0}, held = {0};

    RITZ_CHECK(ritz_spin_port_motion(body, end, end->origin, &motion));
    if (joints->inlet) {
        RITZ_CHECK(ritz_spin_port_motion(body, joints->inlet,
                                         joints->inlet->origin, &held));
        ritz_dense_add(-1.0, &held, &motion);
    }
    return ritz_dense_block(&motion, 0, 3, 0, motion.ncol, out);
}

/* KG += factor d'(I - e e') d */
static ritz_status add_string(double factor, const double e[3],
                              const ritz_dense *deflection, ritz_dense *KG)
{
    RITZ_OWN(ritz_dense) across = {0}, part = {0};

    RITZ_CHECK(ritz_dense_identity(3, &across));
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++)
            ritz_dense_col(&across, j)[i] -= e[i] * e[j];
    RITZ_CHECK(ritz_dense_congruence(&across, deflection, &part));
    if (!KG->val)
        RITZ_CHECK(ritz_dense_new(part.nrow, part.ncol, KG));
    ritz_dense_add(factor, &part, KG);
    return RITZ_OK;
}

static ritz_status add_outlet(const ritz_stage *stage, const ritz_dense *places,
                              int64_t k, const ritz_spin_joints *joints,
                              const ritz_spin_outlet *outlet, ritz_dense *KG)
{
    const ritz_reduced *body = &stage->body[k];
    const double length = length_from(body, outlet->port->origin);
    double arm[3], e[3], R[9], t[3], away = 0.0, tension = 0.0;
    RITZ_OWN(ritz_dense) deflection = {0};

    ritz_spin_arm(&stage->scene->spin, places, k, outlet->port->origin, arm);
    away = sqrt(ritz_dot(arm, arm));
    tension = ritz_dot(arm, outlet->pull);
    if (outlet->unknown >= 0 || !(tension > 0.0) || !(length > 0.0))
        return RITZ_OK;
    for (int a = 0; a < 3; a++)
        arm[a] /= away;
    ritz_spin_take_place(places, k, R, t);
    ritz_turn_back(R, arm, e);
    RITZ_CHECK(find_deflection(body, joints, outlet->port, &deflection));
    return add_string(1.2 * tension / away / length, e, &deflection, KG);
}

ritz_status ritz_spin_add_missing_pull(const ritz_stage *stage,
                                       const ritz_dense *places, int64_t k,
                                       ritz_dense *KG)
{
    const ritz_scene_component *item = &stage->scene->component[k];
    RITZ_OWN(ritz_spin_joints) joints = {0};
    bool flexible = false;

    RITZ_CHECK(ritz_spin_is_flexible(&stage->body[k], &flexible));
    if (!flexible || *item->stiffening[RITZ_STIFFENING_TIP])
        return RITZ_OK;
    RITZ_CHECK(ritz_spin_joints_of(stage, places, k, &joints));
    if (joints.inlet && !ritz_spin_names_load(item))
        return RITZ_OK;
    for (int64_t j = 0; j < joints.count; j++)
        RITZ_CHECK(
            add_outlet(stage, places, k, &joints, &joints.outlet[j], KG));
    return RITZ_OK;
}
