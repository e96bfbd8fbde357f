/*
 * Rigid body: six motions by geometry about the centre of mass, or as many of
 * them as have a component along the dofs.
 */
#include "base/tolerances.h"

#include <ritz/basis.h>

#include <ritz/model.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Whether a motion is zero at all dofs: a plane model, a point mass. */
static bool is_nothing(const ritz_dense *R, int64_t j, double largest)
{
    return ritz_dense_col_max(R, j) <= RITZ_NEGLIGIBLE * largest;
}

static ritz_status make_rigid(const ritz_request *request, ritz_basis *out)
{
    const ritz_component *component = request->component;
    int64_t n = component->num_dofs;
    ritz_inertia inertia = {0};
    RITZ_OWN(ritz_dense) R = {0};
    RITZ_OWN(ritz_dense) kept = {0};
    double largest = 0.0;
    int64_t r = 0;

    RITZ_CHECK(ritz_inertia_of(component, &inertia));
    RITZ_REFUSE_IF(!inertia.known, RITZ_ERR_ARGUMENT,
                   "no grid has a position and a mass, so rigid motion cannot "
                   "be told: import with --bulk");
    RITZ_CHECK(ritz_rigid_geometry(component, inertia.centre, &R));
    RITZ_CHECK(ritz_dense_new(n, 6, &kept));
    largest = ritz_dense_max(&R);
    for (int64_t j = 0; j < 6; j++)
        if (!is_nothing(&R, j, largest))
            memcpy(ritz_dense_col(&kept, r++), ritz_dense_col(&R, j),
                   (size_t)n * sizeof *R.val);
    RITZ_CHECK(ritz_basis_new(n, r, out));
    memcpy(out->T.val, kept.val, (size_t)(n * r) * sizeof *kept.val);
    for (int64_t j = 0; j < r; j++) {
        out->columns.kind[j] = RITZ_COLUMN_RIGID;
        out->columns.hertz[j] = 0.0;
    }
    snprintf(out->origin.engine, sizeof out->origin.engine, "geometry");
    return RITZ_OK;
}

const ritz_method ritz_method_rigid = {
    .name = "rigid",
    .summary = "rigid-body motions by geometry, no flexibility",
    .reference = "LeeTsuha1992",
    .when = "bodies much stiffer than all around them",
    .cost = "a product",
    .holds = "mass, centre and inertia",
    .fails = "anything flexible; grids without positions",
    .make = make_rigid,
};
