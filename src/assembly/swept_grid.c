/* The settings of a joint at which a basis is computed, and checks on them. */
#include "assembly/swept.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

static void ritz_sweep_knot_free(ritz_sweep_knot *k)
{
    ritz_dense_free(&k->V);
    ritz_dense_free(&k->SV);
    ritz_dense_free(&k->places);
    RITZ_FREE(k->lambda);
    *k = (ritz_sweep_knot){0};
}

void ritz_sweep_grid_free(ritz_sweep_grid *g)
{
    RITZ_FREE_EACH(ritz_sweep_knot, g->count, g->knot);
    *g = (ritz_sweep_grid){0};
}

/* Fill a knot with V, S V, eigenvalues and placements of a configuration. */
static ritz_status fill_knot(const ritz_sweeper *w, double x,
                             const double *setting, ritz_configuration *c,
                             ritz_sweep_knot *out)
{
    RITZ_OWN(ritz_springs) springs = {0};

    out->x = x;
    out->rank = c->rank;
    out->rigid = c->num_rigid;
    RITZ_CHECK(ritz_dense_new(w->stage->num_coordinates, c->K.ncol, &out->V));
    for (int64_t k = 0; k < c->num_blocks; k++)
        ritz_dense_put(&c->P[k], w->stage->first[k], 0, &out->V);
    RITZ_CHECK(ritz_stage_springs(w->stage, setting, &springs));
    RITZ_CHECK(ritz_dense_mul(&springs.S, &out->V, &out->SV));
    RITZ_MOVE(out->lambda, c->lambda);
    RITZ_MOVE(out->places, c->places);
    return RITZ_OK;
}

/* Assemble the system at each x. */
static ritz_status make_knots(const ritz_sweeper *w, int64_t count,
                              const double *x, ritz_sweep_knot *out)
{
    const int64_t sweeps = w->stage->scene->num_sweeps;
    const int64_t most = ritz_stage_round(w->stage);
    RITZ_OWN_ARRAY double *setting = NULL;
    RITZ_OWN_ARRAY const double **row = NULL;

    RITZ_CHECK_NEW(setting, most * sweeps);
    RITZ_CHECK_NEW(row, most);
    for (int64_t first = 0; first < count; first += most) {
        const int64_t some = count - first < most ? count - first : most;
        ritz_status status = RITZ_OK;
        ritz_configuration *c = NULL;

        for (int64_t k = 0; k < some; k++) {
            memcpy(setting + k * sweeps, w->asked->setting,
                   (size_t)sweeps * sizeof *setting);
            setting[k * sweeps + w->asked->sweep] = x[first + k] / w->unit;
            row[k] = setting + k * sweeps;
        }
        RITZ_CHECK_NEW(c, some);
        status = ritz_stage_assemble_some(w->stage, some, row, c);
        for (int64_t k = 0; k < some && status == RITZ_OK; k++)
            status = fill_knot(w, x[first + k], row[k], &c[k], &out[first + k]);
        RITZ_FREE_EACH(ritz_configuration, some, c);
        RITZ_CHECK_IN(ritz_sweep_name(w), status);
    }
    return RITZ_OK;
}

ritz_status ritz_sweep_begin(const ritz_sweeper *w, ritz_sweep_grid *out)
{
    const double spacing = (w->last - w->first) / RITZ_SWEEP_FEWEST;
    RITZ_OWN_ARRAY double *x = NULL;

    out->count = RITZ_SWEEP_FEWEST + 1;
    RITZ_CHECK_NEW(out->knot, out->count);
    RITZ_CHECK_NEW(x, out->count);
    for (int64_t k = 0; k < out->count; k++)
        x[k] = w->first + spacing * (double)k;
    return make_knots(w, out->count, x, out->knot);
}

ritz_status ritz_sweep_middles(const ritz_sweeper *w,
                               const ritz_sweep_grid *grid,
                               ritz_sweep_grid *out)
{
    RITZ_OWN_ARRAY double *x = NULL;

    out->count = grid->count - 1;
    RITZ_CHECK_NEW(out->knot, out->count);
    RITZ_CHECK_NEW(x, out->count);
    for (int64_t k = 0; k < out->count; k++)
        x[k] = 0.5 * (grid->knot[k].x + grid->knot[k + 1].x);
    return make_knots(w, out->count, x, out->knot);
}

ritz_status ritz_sweep_merge(ritz_sweep_grid *grid, ritz_sweep_grid *middles)
{
    RITZ_OWN(ritz_sweep_grid) all = {0};

    RITZ_CHECK_NEW(all.knot, grid->count + middles->count);
    all.count = grid->count + middles->count;
    for (int64_t k = 0; k < all.count; k++)
        RITZ_MOVE(all.knot[k], (k % 2 == 0 ? grid : middles)->knot[k / 2]);
    ritz_sweep_grid_free(grid);
    ritz_sweep_grid_free(middles);
    RITZ_MOVE(*grid, all);
    return RITZ_OK;
}

int64_t ritz_sweep_count_modes(const ritz_sweep_knot *k, double up_to_hz)
{
    const double omega = 2.0 * RITZ_PI * up_to_hz;
    int64_t count = 0;

    while (count < k->V.ncol && k->lambda[count] <= omega * omega)
        count++;
    return count;
}

ritz_status ritz_sweep_one(const ritz_sweeper *w, double x,
                           ritz_sweep_grid *out)
{
    out->count = 1;
    RITZ_CHECK_NEW(out->knot, 1);
    return make_knots(w, 1, &x, out->knot);
}

/* The setting between knots i and i + 1 at which the number of modes in the
   band changes, to a thousandth of the range. */
static ritz_status find_change(const ritz_sweeper *w,
                               const ritz_sweep_grid *grid, int64_t i,
                               double *setting)
{
    const double band = w->asked->up_to_hz;
    const int64_t before = ritz_sweep_count_modes(&grid->knot[i], band);
    double low = grid->knot[i].x, high = grid->knot[i + 1].x;

    while (high - low > RITZ_SWEPT_CHANGE * (w->last - w->first)) {
        const double x = 0.5 * (low + high);
        RITZ_OWN(ritz_sweep_grid) one = {0};

        RITZ_CHECK(ritz_sweep_one(w, x, &one));
        if (ritz_sweep_count_modes(&one.knot[0], band) == before)
            low = x;
        else
            high = x;
    }
    *setting = 0.5 * (low + high) / w->unit;
    return RITZ_OK;
}

/* Refuse a band if a mode leaves or enters it between the start and a knot. */
static ritz_status check_band(const ritz_sweeper *w,
                              const ritz_sweep_grid *grid)
{
    const ritz_sweep_request *asked = w->asked;
    const bool back =
        asked->setting[asked->sweep] * w->unit > 0.5 * (w->first + w->last);

    for (int64_t i = 0;
         asked->modes == 0 && asked->up_to_hz > 0.0 && i + 1 < grid->count;
         i++) {
        const int64_t here =
            ritz_sweep_count_modes(&grid->knot[i], asked->up_to_hz);
        const int64_t next =
            ritz_sweep_count_modes(&grid->knot[i + 1], asked->up_to_hz);
        const int64_t mode = here < next ? next : here;
        double at = 0.0;

        if (here == next)
            continue;
        RITZ_CHECK(find_change(w, grid, i, &at));
        return ritz_fail(
            RITZ_ERR_ARGUMENT,
            "mode %" PRId64 " (flexible mode %" PRId64 ") %s the band of %g Hz "
            "at %s=%.4g: a basis that loses or gains a mode is not continuous. "
            "Keep %" PRId64 " modes at all settings",
            mode, mode - grid->knot[i].rigid,
            (here > next) != back ? "leaves" : "enters", asked->up_to_hz,
            ritz_sweep_name(w), at, mode);
    }
    return RITZ_OK;
}

ritz_status ritz_sweep_check(const ritz_sweeper *w, const ritz_sweep_grid *grid)
{
    const ritz_sweep_knot *first = &grid->knot[0];

    for (int64_t k = 1; k < grid->count; k++)
        RITZ_REFUSE_IF(grid->knot[k].rank != first->rank, RITZ_ERR_ARGUMENT,
                       "the joints' constraints have rank %" PRId64 " at %s=%g "
                       "and %" PRId64 " at %s=%g: no basis is continuous "
                       "between them",
                       first->rank, ritz_sweep_name(w), first->x / w->unit,
                       grid->knot[k].rank, ritz_sweep_name(w),
                       grid->knot[k].x / w->unit);
    return check_band(w, grid);
}

ritz_status ritz_sweep_correlate(const ritz_dense *V, const ritz_dense *M,
                                 const ritz_dense *T, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) MT = {0};

    RITZ_CHECK(ritz_dense_mul(M, T, &MT));
    return ritz_dense_mul_tn(V, &MT, out);
}
