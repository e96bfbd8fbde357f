/*
 * Mass and momentum of all bodies where a configuration puts them. A body at
 * x = R x_b + t moves by its own rigid motions r_b as the whole does by
 *
 *     r = r_b X',    X = [R  0; [t]x R  R],
 *
 * so that R'M P = sum_b X_b (r_b'M_b T_b) P_b and R'MR = sum_b X_b (r_b'M_b
 * r_b) X_b'.
 */
#include "assembly/placement.h"
#include "assembly/turns.h"
#include "base/alloc.h"

#include <stdlib.h>
#include <string.h>

enum { DIRECTIONS = 6, MASSES = 36 };

static bool is_known(const ritz_stage *stage)
{
    for (int64_t k = 0; k < stage->count; k++)
        if (!stage->body[k].invariants.momentum.val)
            return false;
    return stage->count > 0;
}

/* X of a placement, 6 x 6. */
static void carry(const ritz_placement *place, ritz_dense *X)
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
    ritz_status status = RITZ_OK;
    double rigid[MASSES];
    const ritz_dense mass = {DIRECTIONS, DIRECTIONS, rigid};
    ritz_dense XL = {0}, L = {0}, XM = {0}, all = {0};

    memcpy(rigid, own->rigid, sizeof rigid);
    RITZ_TRY(ritz_dense_mul(X, &own->momentum, &XL));
    RITZ_TRY(ritz_dense_mul(&XL, P, &L));
    RITZ_TRY(ritz_dense_mul(X, &mass, &XM));
    RITZ_TRY(ritz_dense_mul_nt(&XM, X, &all));
    for (int64_t k = 0; k < DIRECTIONS * L.ncol; k++)
        c->momentum.val[k] += L.val[k];
    for (int64_t k = 0; k < MASSES; k++)
        c->rigid[k] += all.val[k];
done:
    ritz_dense_free(&XL);
    ritz_dense_free(&L);
    ritz_dense_free(&XM);
    ritz_dense_free(&all);
    return status;
}

ritz_status ritz_place_mass(const ritz_stage *stage, const double *setting,
                            ritz_configuration *configuration)
{
    ritz_status status = RITZ_OK;
    ritz_joint_pose *pose = NULL;
    ritz_placement *place = NULL;
    ritz_dense X = {0};

    if (!is_known(stage))
        return RITZ_OK;
    RITZ_NEW(pose, stage->scene->num_joints);
    RITZ_NEW(place, stage->count);
    RITZ_TRY(ritz_place_joints(stage, setting, pose));
    ritz_place_bodies(stage, pose, place);
    RITZ_TRY(ritz_dense_new(DIRECTIONS, DIRECTIONS, &X));
    RITZ_TRY(ritz_dense_new(DIRECTIONS, configuration->K.ncol,
                            &configuration->momentum));
    for (int64_t k = 0; k < stage->count; k++) {
        carry(&place[k], &X);
        RITZ_TRY(add_body(&stage->body[k].invariants, &X, &configuration->P[k],
                          configuration));
    }
done:
    free(pose);
    free(place);
    ritz_dense_free(&X);
    return status;
}
