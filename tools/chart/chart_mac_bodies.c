/*
 * Shapes of a configuration in the coordinates of all its bodies, each fixed in
 * its own axes, so that a turned body needs no turning back:
 *
 *     u = (P_1 x, P_2 x, ...),    u'M v = sum_c (P_c x)' M_c (P_c' x')
 *
 * as ritz_track has it. A system does not hold M_c: the reduced components do
 * that it was assembled from, which sum_c P_c' M_c P_c = M of it shows.
 */
#include "chart/chart_mac.h"

#include <ritz/eigen.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of the largest of M: what assembly and files lose. */
static const double rounding = 1e-6;

enum { MOST_BODIES = 64 };

static ritz_status refuse(const mac_side *side, const char *why)
{
    const ritz_system *s = &side->file->model.system;
    char list[400] = "";
    size_t used = 0;

    for (int64_t c = 0; c < s->num_components && used < sizeof list; c++)
        used += (size_t)snprintf(list + used, sizeof list - used, "%s'%.63s'",
                                 c > 0 ? ", " : "", s->component[c]);
    return ritz_fail(RITZ_ERR_ARGUMENT,
                     "the bodies of '%s' (%s) are not these: %s",
                     side->file->path, list, why);
}

/* The first file for each body that has as many coordinates. */
static ritz_status assign(const mac_side *side, int64_t count,
                          const chart_file *const *body,
                          const ritz_reduced *of[MOST_BODIES])
{
    const ritz_system *s = &side->file->model.system;
    bool taken[MOST_BODIES] = {false};
    char why[120];

    if (count != s->num_components || count > MOST_BODIES) {
        snprintf(why, sizeof why, "%lld bodies, %lld named",
                 (long long)s->num_components, (long long)count);
        return refuse(side, why);
    }
    for (int64_t c = 0; c < count; c++) {
        int64_t k = 0;

        while (k < count &&
               (taken[k] || body[k]->model.reduced.K.ncol != s->order[c]))
            k++;
        if (k == count) {
            snprintf(why, sizeof why, "none left has %lld coordinates",
                     (long long)s->order[c]);
            return refuse(side, why);
        }
        taken[k] = true;
        of[c] = &body[k]->model.reduced;
    }
    return RITZ_OK;
}

/* Flexible columns of P_c, and M_c times them, into their rows. */
static ritz_status put_block(const ritz_dense *P, const ritz_dense *M,
                             int64_t rigid, int64_t first, mac_shapes *out)
{
    ritz_status status = RITZ_OK;
    const ritz_dense part = ritz_dense_part(P, rigid, out->count);
    ritz_dense MP = {0};

    RITZ_TRY(ritz_dense_mul(M, &part, &MP));
    for (int64_t k = 0; k < out->count; k++)
        for (int64_t i = 0; i < P->nrow; i++) {
            ritz_dense_col(&out->U, k)[first + i] = ritz_dense_col(&part, k)[i];
            ritz_dense_col(&out->MU, k)[first + i] = ritz_dense_col(&MP, k)[i];
        }
done:
    ritz_dense_free(&MP);
    return status;
}

/* Whether U'MU is what M of the configuration says. */
static ritz_status check_mass(const mac_side *side, const mac_shapes *s)
{
    ritz_status status = RITZ_OK;
    const ritz_dense *M = &side->at->M;
    int64_t rigid = side->at->num_rigid;
    ritz_dense product = {0};
    double apart = 0.0, most = 0.0;

    RITZ_TRY(ritz_dense_mul_tn(&s->U, &s->MU, &product));
    for (int64_t j = 0; j < s->count; j++)
        for (int64_t i = 0; i < s->count; i++) {
            double due = ritz_dense_col(M, rigid + j)[rigid + i];

            apart = fmax(apart, fabs(ritz_dense_col(&product, j)[i] - due));
            most = fmax(most, fabs(due));
        }
    if (!(apart <= rounding * most))
        status = refuse(side, "their masses are not its mass");
done:
    ritz_dense_free(&product);
    return status;
}

ritz_status mac_shapes_of_bodies(const mac_side *side, int64_t count,
                                 const chart_file *const *body, mac_shapes *out)
{
    const ritz_system *s = &side->file->model.system;
    const ritz_configuration *at = side->at;
    const ritz_reduced *of[MOST_BODIES] = {NULL};
    int64_t n = 0, first = 0;

    snprintf(out->name, sizeof out->name, "%.80s, %.80s",
             chart_base(side->file->path), at->at);
    RITZ_CHECK(assign(side, count, body, of));
    for (int64_t c = 0; c < s->num_components; c++)
        n += s->order[c];
    out->count = at->K.ncol - at->num_rigid;
    out->count = out->count < MAC_MOST_MODES ? out->count : MAC_MOST_MODES;
    RITZ_REFUSE_IF(out->count < 1, RITZ_ERR_ARGUMENT,
                   "%s: there is no flexible mode", side->file->path);
    RITZ_CHECK(ritz_dense_new(n, out->count, &out->U));
    RITZ_CHECK(ritz_dense_new(n, out->count, &out->MU));
    out->hertz = calloc((size_t)out->count, sizeof *out->hertz);
    RITZ_REFUSE_IF(!out->hertz, RITZ_ERR_MEMORY, "no memory for modes");
    for (int64_t k = 0; k < out->count; k++)
        out->hertz[k] = ritz_eigen_hertz(at->lambda[at->num_rigid + k]);
    for (int64_t c = 0; c < s->num_components; c++) {
        RITZ_CHECK(put_block(&at->P[c], &of[c]->M, at->num_rigid, first, out));
        first += s->order[c];
    }
    return check_mass(side, out);
}
