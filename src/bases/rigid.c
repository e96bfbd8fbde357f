/*
 * Rigid body: six motions by geometry about the centre of mass, or as many of
 * them as have a component along the dofs.
 */
#include "base/tolerances.h"
#include "bases/columns.h"

#include <stdio.h>

static ritz_status make_rigid(const ritz_request *request, ritz_basis *out)
{
    const ritz_component *component = request->component;
    int64_t n = component->num_dofs;
    ritz_inertia inertia = {0};
    RITZ_OWN(ritz_dense) R = {0}, kept = {0};
    double largest = 0.0;

    RITZ_CHECK(ritz_inertia_of(component, &inertia));
    RITZ_REFUSE_IF(!inertia.known, RITZ_ERR_ARGUMENT,
                   "no grid has a position and a mass, so rigid motion cannot "
                   "be told: import with --bulk; a system has no grids");
    RITZ_CHECK(ritz_rigid_geometry(component, inertia.centre, &R));
    RITZ_CHECK(ritz_dense_new(n, 6, &kept));
    largest = ritz_dense_max(&R);
    kept.ncol = 0;
    for (int64_t j = 0; j < 6; j++) {
        const ritz_dense motion = ritz_dense_part(&R, j, 1);

        /* zero at all dofs: a plane model, a point mass */
        if (ritz_dense_max(&motion) > RITZ_NEGLIGIBLE * largest)
            ritz_dense_put(&motion, 0, kept.ncol++, &kept);
    }
    RITZ_CHECK(ritz_basis_new(n, kept.ncol, out));
    ritz_dense_put(&kept, 0, 0, &out->T);
    for (int64_t j = 0; j < kept.ncol; j++)
        ritz_columns_label_rigid(j, &out->columns);
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
