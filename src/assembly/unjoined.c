/*
 * The bodies of a stage before they are joined: K, M and D with a block for
 * each body, to which the springs and dampers of joints are added, and a row of
 * C q = 0 for each motion that a joint locks, in lengths and radians.
 *
 * Damping that is stated for the model is that of the modes of the joined
 * system, where its matrix is D_e. With P M-orthonormal, the bodies have
 *
 *     D = M P D_e P'M,    P'D P = D_e,
 *
 * which damps the joined motion like the system, and does not damp violations.
 */
#include "assembly/assembly.h"

#include "base/alloc.h"
#include "linear/general.h"
#include "model/modal.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Block-diagonal matrix of the bodies' matrices at an offset of ritz_reduced;
   {0} if no body has one. */
static ritz_status gather(const ritz_stage *stage, size_t offset,
                          ritz_dense *out)
{
    const int64_t n = stage->num_coordinates;

    for (int64_t k = 0; k < stage->count; k++) {
        const void *at = (const char *)&stage->body[k] + offset;
        const ritz_dense *A = at;

        if (!A->val)
            continue;
        if (!out->val)
            RITZ_CHECK(ritz_dense_new(n, n, out));
        ritz_dense_put(A, stage->first[k], stage->first[k], out);
    }
    return RITZ_OK;
}

static ritz_status refuse_structural(const ritz_stage *stage)
{
    for (int64_t k = 0; k < stage->count; k++)
        RITZ_CHECK(
            ritz_structure_refuse(ritz_dense_max(&stage->body[k].K4) > 0.0));
    return RITZ_OK;
}

/* Name rows as "clock translation 2": joint, kind and number within the
   kind. */
static void name_rows(const ritz_relations *of, ritz_unjoined *u)
{
    int64_t count[2] = {0};

    for (int64_t k = 0; k < of->count; k++) {
        const ritz_relation *r = &of->item[k];

        if (k == 0 || r->joint != r[-1].joint)
            count[0] = count[1] = 0;
        (void)snprintf(u->row[k], RITZ_NAME_SIZE, "%.40s %s %d", r->joint->name,
                       r->rotation ? "rotation" : "translation",
                       (int)++count[r->rotation]);
    }
}

/* Length of a row whose columns are scaled to unit mass. */
static double measure_row(const ritz_stage *stage, const ritz_dense *C,
                          int64_t i)
{
    double sum = 0.0;

    for (int64_t j = 0; j < C->ncol; j++) {
        const double x = ritz_dense_col(C, j)[i] * stage->scale[j];

        sum += x * x;
    }
    return sqrt(sum);
}

/* The scale of a row is the length of the longest row of the same joint and
   kind, as in ritz_stage_constraints. */
static void scale_rows(const ritz_stage *stage, const ritz_relations *of,
                       ritz_unjoined *u)
{
    for (int64_t i = 0; i < of->count; i++) {
        const double length = measure_row(stage, &u->C, i);

        for (int64_t k = 0; k < of->count; k++)
            if (of->item[k].joint == of->item[i].joint &&
                of->item[k].rotation == of->item[i].rotation)
                u->scale[k] = fmax(u->scale[k], length);
    }
}

static ritz_status fill_constraints(const ritz_stage *stage,
                                    const double *setting, ritz_unjoined *u)
{
    RITZ_OWN(ritz_springs) locked = {0};

    RITZ_CHECK(ritz_stage_locks(stage, setting, &locked));
    u->num_rows = locked.of.count;
    RITZ_CHECK_NEW(u->row, u->num_rows);
    RITZ_CHECK_NEW(u->scale, u->num_rows);
    RITZ_MOVE(u->C, locked.S);
    name_rows(&locked.of, u);
    scale_rows(stage, &locked.of, u);
    return RITZ_OK;
}

/* P: the blocks of all bodies, one below the other. */
static ritz_status stack_blocks(const ritz_stage *stage,
                                const ritz_configuration *joined, ritz_dense *P)
{
    RITZ_CHECK(ritz_dense_new(stage->num_coordinates, joined->K.ncol, P));
    for (int64_t k = 0; k < stage->count; k++)
        ritz_dense_put(&joined->P[k], stage->first[k], 0, P);
    return RITZ_OK;
}

/* D += M P D_e P'M. */
static ritz_status add_damping(const ritz_configuration *joined,
                               const ritz_damping *damping, ritz_unjoined *u)
{
    const ritz_structure s = {joined->K, joined->M, {0}}; /* borrowed */
    RITZ_OWN(ritz_dense) D_e = {0}, MP = {0}, PM = {0}, D = {0};

    if (damping && damping->kind != RITZ_DAMPING_NONE)
        RITZ_CHECK(ritz_modal_damping(&s, damping, &D_e));
    if (!D_e.val)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_mul(&u->M, &u->P, &MP));
    RITZ_CHECK(ritz_general_transpose(&MP, &PM));
    RITZ_CHECK(ritz_dense_congruence(&D_e, &PM, &D));
    if (!u->D.val)
        RITZ_CHECK(ritz_dense_new(u->n, u->n, &u->D));
    ritz_dense_add(1.0, &D, &u->D);
    return RITZ_OK;
}

static ritz_status take_apart(const ritz_stage *stage, const double *setting,
                              const ritz_configuration *joined,
                              const ritz_damping *damping, ritz_unjoined *out)
{
    RITZ_OWN(ritz_unjoined) u = {.n = stage->num_coordinates};
    RITZ_OWN(ritz_springs) springs = {0};
    RITZ_OWN(ritz_dense) one = {0};

    RITZ_CHECK(ritz_dual_refuse(stage));
    RITZ_CHECK(refuse_structural(stage));
    RITZ_CHECK(gather(stage, offsetof(ritz_reduced, K), &u.K));
    RITZ_CHECK(gather(stage, offsetof(ritz_reduced, M), &u.M));
    RITZ_CHECK(gather(stage, offsetof(ritz_reduced, D), &u.D));
    RITZ_CHECK(ritz_stage_springs(stage, setting, &springs));
    RITZ_CHECK(ritz_dense_identity(u.n, &one));
    RITZ_CHECK(ritz_springs_add(&springs, false, &one, &u.K));
    RITZ_CHECK(ritz_springs_add(&springs, true, &one, &u.D));
    RITZ_CHECK(fill_constraints(stage, setting, &u));
    RITZ_CHECK(ritz_io_copy(&stage->io, &u.io));
    RITZ_CHECK(stack_blocks(stage, joined, &u.P));
    RITZ_CHECK(add_damping(joined, damping, &u));
    RITZ_MOVE(*out, u);
    return RITZ_OK;
}

ritz_status ritz_stage_unjoined(const ritz_stage *stage, const double *setting,
                                const ritz_configuration *joined,
                                const ritz_damping *damping, ritz_unjoined *out)
{
    const ritz_scene_spin *spin = &stage->scene->spin;
    RITZ_OWN(ritz_spun) spun = {0};

    if (!spin->given || spin->rate.course != RITZ_SPIN_CONSTANT)
        return take_apart(stage, setting, joined, damping, out);
    RITZ_CHECK(ritz_stage_spun(stage, setting, &spun));
    return take_apart(&spun.stage, setting, joined, damping, out);
}
