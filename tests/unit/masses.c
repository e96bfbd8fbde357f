#include "masses.h"

#include "base/alloc.h"
#include "frame.h"

#include <ritz/import.h>

#include <stdio.h>
#include <stdlib.h>

/* Elements s[i] between i - 1 and i; s[0] to ground, if it is not 0. */
static ritz_status assemble(int64_t n, const double *s, ritz_sparse *out)
{
    int64_t row[4 * MASSES_MOST];
    int64_t col[4 * MASSES_MOST];
    double val[4 * MASSES_MOST];
    int64_t count = 0;

    for (int64_t e = s[0] != 0.0 ? 0 : 1; e < n; e++)
        for (int64_t i = e > 0 ? e - 1 : 0; i <= e; i++)
            for (int64_t j = e > 0 ? e - 1 : 0; j <= e; j++) {
                row[count] = i;
                col[count] = j;
                val[count++] = i == j ? s[e] : -s[e];
            }
    return ritz_sparse_from_triplets(n, n, count, row, col, val, out);
}

ritz_status masses_component(int64_t n, const double *m, const double *k,
                             const double *c, ritz_component *out)
{
    ritz_status status = RITZ_OK;
    ritz_component masses = {.units = "none", .num_dofs = n};
    int64_t own[MASSES_MOST];

    RITZ_FAIL_IF(n > MASSES_MOST, RITZ_ERR_ARGUMENT, "the row is too long");
    for (int64_t i = 0; i < n; i++)
        own[i] = i;
    RITZ_NEW(masses.dof, n);
    for (int64_t i = 0; i < n; i++)
        masses.dof[i] = (ritz_dof){i + 1, 1};
    RITZ_TRY(ritz_sparse_from_triplets(n, n, n, own, own, m, &masses.M));
    RITZ_TRY(assemble(n, k, &masses.K));
    if (c)
        RITZ_TRY(assemble(n, c, &masses.D));
    RITZ_TRY(ritz_component_settle(&masses, false));
    *out = masses;
    masses = (ritz_component){0};
done:
    ritz_component_free(&masses);
    return status;
}

ritz_status masses_apart(int64_t n, const double *k, const double *c,
                         ritz_component *out)
{
    ritz_status status = RITZ_OK;
    ritz_component masses = {.units = "none", .num_dofs = n};
    int64_t own[MASSES_MOST];
    double one[MASSES_MOST];

    RITZ_FAIL_IF(n > MASSES_MOST, RITZ_ERR_ARGUMENT, "these are too many");
    RITZ_NEW(masses.dof, n);
    for (int64_t i = 0; i < n; i++) {
        own[i] = i;
        one[i] = 1.0;
        masses.dof[i] = (ritz_dof){i + 1, 1};
    }
    RITZ_TRY(ritz_sparse_from_triplets(n, n, n, own, own, one, &masses.M));
    RITZ_TRY(ritz_sparse_from_triplets(n, n, n, own, own, k, &masses.K));
    if (c)
        RITZ_TRY(ritz_sparse_from_triplets(n, n, n, own, own, c, &masses.D));
    *out = masses;
    masses = (ritz_component){0};
done:
    ritz_component_free(&masses);
    return status;
}

ritz_status masses_io(ritz_component *masses, int64_t num_inputs,
                      const int64_t *input_mass, int64_t num_outputs,
                      const int64_t *output_mass)
{
    return frame_io(masses, num_inputs, input_mass, num_outputs, output_mass);
}

ritz_status masses_shipped(ritz_component *out)
{
    static const char *const input[] = {"tip=10:1"};
    static const char *const output[] = {"root=1:1"};
    static const char *const end[] = {"K.mtx", "M.mtx", "D.mtx", "dofs"};
    ritz_status status = RITZ_OK;
    ritz_import_report report = {0};
    ritz_import_request request = {
        .num_inputs = 1, .input = input, .num_outputs = 1, .output = output};
    const char *folder = getenv("RITZ_DATA");
    char path[4][512];

    RITZ_FAIL_IF(!folder, RITZ_ERR_FILE, "RITZ_DATA is not set");
    for (int k = 0; k < 4; k++)
        snprintf(path[k], sizeof path[k], "%s/chain/chain.%s", folder, end[k]);
    request.stiffness = path[0];
    request.mass = path[1];
    request.damping = path[2];
    request.dofs = path[3];
    RITZ_TRY(ritz_import(&request, out, &report));
done:
    ritz_import_report_free(&report);
    return status;
}
