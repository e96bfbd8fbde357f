/*
 * Loaded-interface modes [BenfieldHruda1971]: the lowest modes of the component
 * while the neighbours' stiffness and mass, condensed to the attached dofs a,
 * are added to it,
 *
 *     (K + E K_n E') Phi = (M + E M_n E') Phi Lambda,   E = I(:, a)
 *
 * normalised in the loaded mass. These modes resemble the motion of the
 * component in the system, so that few are needed; they are exact if the
 * condensed neighbour is exact. Static vectors of dampers and other loads are
 * those of the loaded component.
 */
#include "base/alloc.h"
#include "bases/columns.h"
#include "bases/free_set.h"

#include <inttypes.h>

/* A + E A_n E'. */
static ritz_status add_neighbour(const ritz_sparse *A, const ritz_dense *A_n,
                                 const ritz_dofs *a, ritz_sparse *out)
{
    RITZ_OWN(ritz_sparse) added = {0};
    RITZ_OWN_ARRAY int64_t *row = NULL, *col = NULL;
    RITZ_OWN_ARRAY double *val = NULL;
    int64_t count = 0;

    RITZ_CHECK_NEW(row, a->count * a->count);
    RITZ_CHECK_NEW(col, a->count * a->count);
    RITZ_CHECK_NEW(val, a->count * a->count);
    for (int64_t j = 0; j < a->count; j++)
        for (int64_t i = 0; i < a->count; i++) {
            double mean =
                0.5 * (ritz_dense_col(A_n, j)[i] + ritz_dense_col(A_n, i)[j]);

            if (mean == 0.0)
                continue;
            row[count] = a->at[i];
            col[count] = a->at[j];
            val[count++] = mean;
        }
    RITZ_CHECK(ritz_sparse_from_triplets(A->nrow, A->ncol, count, row, col, val,
                                         &added));
    return ritz_sparse_add(1.0, A, 1.0, &added, out);
}

static ritz_status check_request(const ritz_request *request)
{
    const ritz_neighbour *neighbour = request->neighbour;
    int64_t a = request->attached.count;

    if (request->component->num_ports == 0)
        RITZ_CHECK(ritz_refuse_unattached(request, "nothing can hang on it"));
    RITZ_REFUSE_IF(
        !neighbour, RITZ_ERR_ARGUMENT,
        "it is not said what hangs on the interface: name a neighbour "
        "with --neighbour, or a joint in a scene");
    RITZ_REFUSE_IF(a == 0, RITZ_ERR_ARGUMENT,
                   "nothing is attached, so no neighbour hangs on it: name a "
                   "port");
    RITZ_REFUSE_IF(neighbour->K.nrow != a || neighbour->K.ncol != a ||
                       neighbour->M.nrow != a || neighbour->M.ncol != a,
                   RITZ_ERR_ARGUMENT,
                   "the neighbour has %" PRId64 " dofs, %" PRId64
                   " are attached",
                   neighbour->K.nrow, a);
    return RITZ_OK;
}

static ritz_status make_loaded_interface(const ritz_request *request,
                                         ritz_basis *out)
{
    const ritz_component *component = request->component;
    const ritz_span span = ritz_request_span(request);
    ritz_component loaded = *component; /* a copy that borrows all but K and
                                           M */
    ritz_request with_neighbour = *request;
    int loads = 0;
    RITZ_OWN(ritz_sparse) K = {0}, M = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_dofs) rest = {0};

    RITZ_CHECK(check_request(request));
    RITZ_CHECK(ritz_loads_beside(request, RITZ_LOADS_DAMPERS, &loads));
    RITZ_CHECK(
        ritz_dofs_complement(&request->attached, component->num_dofs, &rest));
    RITZ_CHECK(add_neighbour(&component->K, &request->neighbour->K,
                             &request->attached, &K));
    RITZ_CHECK(add_neighbour(&component->M, &request->neighbour->M,
                             &request->attached, &M));
    RITZ_CHECK(ritz_lowest_modes("loaded modes", "K with its neighbour", &K, &M,
                                 &span, NULL, &pairs));
    loaded.K = K;
    loaded.M = M;
    with_neighbour.component = &loaded;
    return ritz_free_set_beside(&with_neighbour, loads, &pairs, out);
}

const ritz_method ritz_method_loaded_interface = {
    .name = "loaded-interface",
    .summary = "modes with the neighbours' mass and stiffness hung on",
    .reference = "BenfieldHruda1971",
    .when = "chains of bodies whose neighbours are known",
    .cost = "a factor, two solves a mode",
    .holds = "frequencies from above",
    .fails = "other neighbours; statics of the interface",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED | RITZ_USES_NEIGHBOUR |
            RITZ_USES_LOADS | RITZ_USES_EIGEN,
    .keeps_interface = true,
    .make = make_loaded_interface,
};
