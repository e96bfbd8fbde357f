#include "bases/mechanism.h"

#include <ritz/eigen.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { NAMED = 3 };

/* The largest entry of x that was not named before, the first of equals. */
static int64_t largest(int64_t n, const double *x, int64_t count,
                       const int64_t *before)
{
    int64_t best = -1;

    for (int64_t k = 0; k < n; k++) {
        bool taken = false;

        for (int64_t j = 0; j < count; j++)
            taken = taken || before[j] == k;
        if (!taken && (best < 0 || fabs(x[k]) > fabs(x[best]) * (1.0 + 1e-9)))
            best = k;
    }
    return best;
}

/* "grid 3 R1, grid 7 R1": where a motion is largest. */
static void describe(const ritz_component *component, const ritz_dofs *i,
                     const double *x, char text[static 160])
{
    int64_t named[NAMED];
    size_t used = 0;

    text[0] = '\0';
    for (int64_t k = 0; k < NAMED && k < i->count; k++) {
        char name[RITZ_DOF_NAME_SIZE];

        named[k] = largest(i->count, x, k, named);
        if (fabs(x[named[k]]) <= 1e-6 * fabs(x[named[0]]))
            break;
        used += (size_t)snprintf(
            text + used, 160 - used, "%s%s", k > 0 ? ", " : "",
            ritz_dof_name(component->dof[i->at[named[k]]], name));
    }
}

ritz_status ritz_mechanism_refuse(const ritz_component *component,
                                  const ritz_sparse *K_ii,
                                  const ritz_sparse *M_ii, const ritz_dofs *i,
                                  int64_t weak)
{
    ritz_status status = RITZ_OK;
    const ritz_span rigid_only = {.modes = 0};
    ritz_pairs pairs = {0};
    char text[160] = "";
    char name[RITZ_DOF_NAME_SIZE];

    status = ritz_eigen_sparse(K_ii, M_ii, &rigid_only, &pairs);
    if (status == RITZ_ERR_MEMORY)
        goto done;
    if (status == RITZ_OK && pairs.num_rigid > 0)
        describe(component, i, ritz_dense_col(&pairs.Phi, 0), text);
    else if (weak >= 0)
        snprintf(text, sizeof text, "%s",
                 ritz_dof_name(component->dof[i->at[weak]], name));
    if (status == RITZ_OK && pairs.num_rigid == 0 && pairs.Phi.ncol > 0 &&
        pairs.lambda[0] < 0.0)
        status = ritz_fail(RITZ_ERR_SINGULAR,
                           "not positive definite: an eigenvalue is %.3g",
                           pairs.lambda[0]);
    else
        status = ritz_fail(
            RITZ_ERR_SINGULAR,
            "singular, is a rigid-body motion or mechanism left free? with "
            "the attached dofs held, %" PRId64 " motion(s) cost no energy; "
            "largest at %s",
            pairs.num_rigid > 0 ? pairs.num_rigid : 1,
            text[0] ? text : "no dof in particular");
done:
    ritz_pairs_free(&pairs);
    return status;
}
