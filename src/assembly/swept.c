/*
 * A basis as a function of the setting of a joint. At equally spaced x_i, V_i =
 * P Phi are the lowest r modes of the system, in the coordinates of all bodies
 * along their own axes. Each V_i is aligned with the basis at the knot before,
 *
 *     T_i+1 = V_i+1 O,   O = U W' of V_i+1'M T_i = U s W'
 *
 * which is Procrustes' rotation [Schoenemann1966]: it chooses signs, turns
 * modes within clusters and exchanges modes that cross. T_i+1'M T_i is then
 * symmetric. If the smallest s is small, the space of r modes is not
 * continuous, because mode r changes places with mode r + 1.
 */
#include "simulate/swept.h"

#include "assembly/assembly.h"
#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Numbers of intervals: at first; from which on a basis that changes too much
   between knots is refused; and at most. */
enum { FEWEST = 8, ENOUGH = 128, MOST = 1024 };

/* Degrees between the first settings of a hinge, at most: from settings that are
   whole turns apart, neither its axis nor an error of the spline is seen. */
enum { COARSEST = 45 };

/* The system at one setting. */
typedef struct sweep_knot {
    double x;
    int64_t rank, rigid;
    ritz_dense V;   /* Q x e, modes */
    ritz_dense SV;  /* springs x e */
    double *lambda; /* e */
    ritz_dense places;
} sweep_knot;

static void sweep_knot_free(sweep_knot *k)
{
    ritz_dense_free(&k->V);
    ritz_dense_free(&k->SV);
    ritz_dense_free(&k->places);
    RITZ_FREE(k->lambda);
    *k = (sweep_knot){0};
}

typedef struct sweep_grid {
    int64_t count;
    sweep_knot *knot; /* count, x ascending */
} sweep_grid;

static void sweep_grid_free(sweep_grid *g)
{
    RITZ_FREE_EACH(sweep_knot, g->count, g->knot);
    *g = (sweep_grid){0};
}

typedef struct sweeper {
    const ritz_stage *stage;
    const ritz_sweep_request *asked;
    double unit, first, last; /* of x */
    int64_t fewest;           /* intervals at first */
} sweeper;

static const char *sweep_name(const sweeper *w)
{
    return w->stage->scene->sweep[w->asked->sweep].name;
}

/* Fill a knot with V, S V, eigenvalues and placements of a configuration. */
static ritz_status fill_knot(const sweeper *w, double x, const double *setting,
                             ritz_configuration *c, sweep_knot *out)
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
static ritz_status make_knots(const sweeper *w, int64_t count, const double *x,
                              sweep_knot *out)
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
        RITZ_CHECK_IN(sweep_name(w), status);
    }
    return RITZ_OK;
}

static ritz_status choose_fewest(sweeper *w)
{
    const double *range = w->asked->range;
    const double wanted = ceil((range[1] - range[0]) / COARSEST);

    w->fewest = FEWEST;
    if (!w->stage->scene->sweep[w->asked->sweep].turns)
        return RITZ_OK;
    RITZ_REFUSE_IF(wanted > MOST, RITZ_ERR_ARGUMENT,
                   "'%s' turns from %g to %g degrees: there are at most %d "
                   "settings, %d degrees apart. Turn it by less",
                   sweep_name(w), range[0], range[1], MOST + 1, COARSEST);
    if (wanted > FEWEST)
        w->fewest = (int64_t)wanted;
    return RITZ_OK;
}

/* The first grid, of w->fewest intervals. */
static ritz_status begin_grid(const sweeper *w, sweep_grid *out)
{
    const double spacing = (w->last - w->first) / (double)w->fewest;
    RITZ_OWN_ARRAY double *x = NULL;

    out->count = w->fewest + 1;
    RITZ_CHECK_NEW(out->knot, out->count);
    RITZ_CHECK_NEW(x, out->count);
    for (int64_t k = 0; k < out->count; k++)
        x[k] = w->first + spacing * (double)k;
    return make_knots(w, out->count, x, out->knot);
}

/* Knots half way between those of a grid. */
static ritz_status make_middles(const sweeper *w, const sweep_grid *grid,
                                sweep_grid *out)
{
    RITZ_OWN_ARRAY double *x = NULL;

    out->count = grid->count - 1;
    RITZ_CHECK_NEW(out->knot, out->count);
    RITZ_CHECK_NEW(x, out->count);
    for (int64_t k = 0; k < out->count; k++)
        x[k] = 0.5 * (grid->knot[k].x + grid->knot[k + 1].x);
    return make_knots(w, out->count, x, out->knot);
}

/* Merge both grids into @p grid; the other one is left empty. */
static ritz_status merge_grids(sweep_grid *grid, sweep_grid *middles)
{
    RITZ_OWN(sweep_grid) all = {0};

    RITZ_CHECK_NEW(all.knot, grid->count + middles->count);
    all.count = grid->count + middles->count;
    for (int64_t k = 0; k < all.count; k++)
        RITZ_MOVE(all.knot[k], (k % 2 == 0 ? grid : middles)->knot[k / 2]);
    sweep_grid_free(grid);
    sweep_grid_free(middles);
    RITZ_MOVE(*grid, all);
    return RITZ_OK;
}

/* Modes of a knot up to the band's end. */
static int64_t count_modes(const sweep_knot *k, double up_to_hz)
{
    const double omega = 2.0 * RITZ_PI * up_to_hz;
    int64_t count = 0;

    while (count < k->V.ncol && k->lambda[count] <= omega * omega)
        count++;
    return count;
}

/* A grid of one knot, at x. */
static ritz_status make_one(const sweeper *w, double x, sweep_grid *out)
{
    out->count = 1;
    RITZ_CHECK_NEW(out->knot, 1);
    return make_knots(w, 1, &x, out->knot);
}

/* The setting between knots i and i + 1 at which the number of modes in the
   band changes, to a thousandth of the range. */
static ritz_status find_change(const sweeper *w, const sweep_grid *grid,
                               int64_t i, double *setting)
{
    const double band = w->asked->up_to_hz;
    const int64_t before = count_modes(&grid->knot[i], band);
    double low = grid->knot[i].x, high = grid->knot[i + 1].x;

    while (high - low > RITZ_SWEPT_CHANGE * (w->last - w->first)) {
        const double x = 0.5 * (low + high);
        RITZ_OWN(sweep_grid) one = {0};

        RITZ_CHECK(make_one(w, x, &one));
        if (count_modes(&one.knot[0], band) == before)
            low = x;
        else
            high = x;
    }
    *setting = 0.5 * (low + high) / w->unit;
    return RITZ_OK;
}

/* Refuse a band if a mode leaves or enters it between the start and a knot. */
static ritz_status check_band(const sweeper *w, const sweep_grid *grid)
{
    const ritz_sweep_request *asked = w->asked;
    const bool back =
        asked->setting[asked->sweep] * w->unit > 0.5 * (w->first + w->last);

    for (int64_t i = 0;
         asked->modes == 0 && asked->up_to_hz > 0.0 && i + 1 < grid->count;
         i++) {
        const int64_t here = count_modes(&grid->knot[i], asked->up_to_hz);
        const int64_t next = count_modes(&grid->knot[i + 1], asked->up_to_hz);
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
            sweep_name(w), at, mode);
    }
    return RITZ_OK;
}

/* Refuse a grid on which the rank of the constraints changes, or on which a
   mode leaves or enters the band. */
static ritz_status check_ranks(const sweeper *w, const sweep_grid *grid)
{
    const sweep_knot *first = &grid->knot[0];

    for (int64_t k = 1; k < grid->count; k++)
        RITZ_REFUSE_IF(grid->knot[k].rank != first->rank, RITZ_ERR_ARGUMENT,
                       "the joints' constraints have rank %" PRId64 " at %s=%g "
                       "and %" PRId64 " at %s=%g: no basis is continuous "
                       "between them",
                       first->rank, sweep_name(w), first->x / w->unit,
                       grid->knot[k].rank, sweep_name(w),
                       grid->knot[k].x / w->unit);
    return check_band(w, grid);
}

static ritz_status choose_order(const sweeper *w, const sweep_grid *grid,
                                int64_t *out)
{
    const ritz_sweep_request *asked = w->asked;
    const sweep_knot *first = &grid->knot[0];

    *out = first->V.ncol;
    if (asked->modes > 0)
        *out = asked->modes;
    else if (asked->up_to_hz > 0.0)
        *out = count_modes(first, asked->up_to_hz);
    RITZ_REFUSE_IF(*out > first->V.ncol, RITZ_ERR_ARGUMENT,
                   "there are %" PRId64 " modes, not %" PRId64, first->V.ncol,
                   *out);
    RITZ_REFUSE_IF(*out < first->rigid || *out < 1, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " modes are fewer than the %" PRId64
                   " rigid motions",
                   *out, first->rigid);
    return RITZ_OK;
}

/* O = U W' of A = U s W', and the smallest s. */
static ritz_status find_rotation(const ritz_dense *A, double *least,
                                 ritz_dense *O)
{
    RITZ_OWN(ritz_dense) U = {0}, W = {0};
    RITZ_OWN_ARRAY double *s = NULL;

    RITZ_CHECK(ritz_general_svd(A, &U, &s, &W));
    *least = s[A->ncol - 1];
    return ritz_dense_mul_nt(&U, &W, O);
}

/* O'diag(d) O, d the damping that ratios give to each mode of a knot. */
static ritz_status turn_ratios(const sweeper *w, const sweep_knot *k,
                               const ritz_dense *O, ritz_dense *out)
{
    const ritz_damping *damping = w->asked->damping;
    RITZ_OWN(ritz_dense) scaled = {0};
    RITZ_OWN_ARRAY double *d = NULL;

    RITZ_CHECK_NEW(d, O->nrow);
    for (int64_t j = 0; j < O->nrow; j++) {
        const double lambda = j < k->rigid ? 0.0 : k->lambda[j];
        const double omega = sqrt(lambda);

        if (ritz_damping_is_rayleigh(damping))
            d[j] = damping->a + damping->b * lambda;
        else if (j >= k->rigid)
            d[j] = 2.0 * omega *
                   ritz_damping_of_mode(damping, j - k->rigid, omega);
    }
    RITZ_CHECK(ritz_dense_copy(O, &scaled));
    ritz_dense_scale_rows(d, &scaled);
    return ritz_dense_mul_tn(O, &scaled, out);
}

/* [V O; SV O; O'dO] of r modes of a knot. */
static ritz_status turn_knot(const sweeper *w, const ritz_swept_model *m,
                             const sweep_knot *k, const ritz_dense *O,
                             ritz_dense *out)
{
    const ritz_dense V = ritz_dense_part(&k->V, 0, m->order);
    const ritz_dense SV = ritz_dense_part(&k->SV, 0, m->order);
    RITZ_OWN(ritz_dense) T = {0}, ST = {0}, ratios = {0};

    RITZ_CHECK(ritz_dense_mul(&V, O, &T));
    RITZ_CHECK(ritz_dense_mul(&SV, O, &ST));
    RITZ_CHECK(ritz_dense_new(m->F.nrow, m->order, out));
    ritz_dense_put(&T, 0, 0, out);
    ritz_dense_put(&ST, T.nrow, 0, out);
    if (!m->has_ratios)
        return RITZ_OK;
    RITZ_CHECK(turn_ratios(w, k, O, &ratios));
    ritz_dense_put(&ratios, T.nrow + ST.nrow, 0, out);
    return RITZ_OK;
}

/* V'M T, V the r modes of a knot. */
static ritz_status correlate(const ritz_dense *V, const ritz_dense *M,
                             const ritz_dense *T, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) MT = {0};

    RITZ_CHECK(ritz_dense_mul(M, T, &MT));
    return ritz_dense_mul_tn(V, &MT, out);
}

/* Smallest overlap of the bases of two neighbouring knots, and which they
   are. */
typedef struct sweep_gap {
    double overlap;
    int64_t at;
} sweep_gap;

/* F of all knots, each aligned with the knot before. */
static ritz_status align_knots(const sweeper *w, const sweep_grid *grid,
                               ritz_swept_model *m, sweep_gap *gap)
{
    const int64_t r = m->order, Q = m->M.nrow;
    const int64_t rows = Q + m->num_springs + (m->has_ratios ? r : 0);
    RITZ_OWN(ritz_dense) T = {0};

    m->count = grid->count;
    m->first = w->first;
    m->spacing = (w->last - w->first) / (double)(grid->count - 1);
    ritz_dense_free(&m->F);
    RITZ_CHECK(ritz_dense_new(rows, r * grid->count, &m->F));
    *gap = (sweep_gap){1.0, 0};
    for (int64_t k = 0; k < grid->count; k++) {
        const ritz_dense V = ritz_dense_part(&grid->knot[k].V, 0, r);
        RITZ_OWN(ritz_dense) A = {0}, O = {0}, made = {0};
        double least = 1.0;

        if (k == 0) {
            RITZ_CHECK(ritz_dense_identity(r, &O));
        } else {
            RITZ_CHECK(correlate(&V, &m->M, &T, &A));
            RITZ_CHECK(find_rotation(&A, &least, &O));
        }
        if (least < gap->overlap)
            *gap = (sweep_gap){least, k};
        RITZ_CHECK(turn_knot(w, m, &grid->knot[k], &O, &made));
        ritz_dense_put(&made, 0, k * r, &m->F);
        ritz_dense_free(&T);
        RITZ_CHECK(ritz_dense_block(&made, 0, Q, 0, r, &T));
    }
    return ritz_swept_bend(m);
}

/* Largest sqrt(x'A x) of the columns of X. */
static double longest_column(const ritz_dense *X, const ritz_dense *AX)
{
    double most = 0.0;

    for (int64_t j = 0; j < X->ncol; j++)
        most = fmax(most, ritz_dense_dot(X, j, AX, j));
    return sqrt(fmax(most, 0.0));
}

/* Error of the spline at a knot that it does not interpolate; @p out becomes
   the larger of both. */
static ritz_status measure_middle(const sweeper *w, const ritz_swept_model *m,
                                  const sweep_knot *k, double *out)
{
    const int64_t r = m->order, Q = m->M.nrow;
    const ritz_dense V = ritz_dense_part(&k->V, 0, r);
    RITZ_OWN(ritz_dense) F = {0}, T = {0}, A = {0}, O = {0}, off = {0};
    RITZ_OWN(ritz_dense) D = {0}, MD = {0}, KD = {0}, rest = {0}, size = {0};
    const double last = k->lambda[r - 1] > 0.0 ? k->lambda[r - 1] : 1.0;
    double least = 1.0;

    RITZ_CHECK(ritz_swept_values(m, k->x, &F));
    RITZ_CHECK(ritz_dense_block(&F, 0, Q, 0, r, &T));
    RITZ_CHECK(correlate(&V, &m->M, &T, &A));
    RITZ_CHECK(find_rotation(&A, &least, &O));
    RITZ_CHECK(turn_knot(w, m, k, &O, &off));
    RITZ_CHECK(ritz_dense_block(&off, Q, off.nrow - Q, 0, r, &size));
    ritz_dense_add(-1.0, &F, &off);
    RITZ_CHECK(ritz_dense_block(&off, 0, Q, 0, r, &D));
    RITZ_CHECK(ritz_dense_block(&off, Q, off.nrow - Q, 0, r, &rest));
    RITZ_CHECK(ritz_dense_mul(&m->M, &D, &MD));
    RITZ_CHECK(ritz_dense_mul(&m->K, &D, &KD));
    *out = fmax(*out, longest_column(&D, &MD));
    *out = fmax(*out, longest_column(&D, &KD) / sqrt(last));
    if (ritz_dense_max(&size) > 0.0)
        *out = fmax(*out, ritz_dense_max(&rest) / ritz_dense_max(&size));
    return RITZ_OK;
}

/* Refuse a basis whose mode r changes places with mode r + 1: this happens
   where two neighbouring bases overlap least. */
static ritz_status refuse_gap(const sweeper *w, const sweep_grid *grid,
                              int64_t r, const sweep_gap *gap)
{
    const sweep_knot *k = &grid->knot[gap->at];

    return ritz_fail(
        RITZ_ERR_ARGUMENT,
        "the basis of %" PRId64 " modes is not continuous: near %s=%.4g mode "
        "%" PRId64 ", %.4g Hz, changes places with the next one. Keep more "
        "modes, or fewer",
        r, sweep_name(w), k->x / w->unit, r,
        sqrt(fmax(k->lambda[r - 1], 0.0)) / (2.0 * RITZ_PI));
}

/* Add knots until the spline between them is accurate. */
static ritz_status refine(const sweeper *w, sweep_grid *grid,
                          ritz_swept_model *m)
{
    const int64_t enough = w->fewest * (ENOUGH / FEWEST);

    while (true) {
        RITZ_OWN(sweep_grid) middles = {0};
        sweep_gap gap;

        RITZ_CHECK(align_knots(w, grid, m, &gap));
        if ((grid->count > enough || grid->count > MOST) &&
            gap.overlap < RITZ_SWEPT_OVERLAP)
            return refuse_gap(w, grid, m->order, &gap);
        RITZ_CHECK(make_middles(w, grid, &middles));
        RITZ_CHECK(check_ranks(w, &middles));
        m->error = 0.0;
        for (int64_t k = 0; k < middles.count; k++)
            RITZ_CHECK(measure_middle(w, m, &middles.knot[k], &m->error));
        if (m->error <= RITZ_SWEPT_ERROR)
            return RITZ_OK;
        RITZ_REFUSE_IF(grid->count > MOST, RITZ_ERR_CONVERGENCE,
                       "the basis of %" PRId64 " modes changes so fast with %s "
                       "that %" PRId64 " settings interpolate it to %.1e only",
                       m->order, sweep_name(w), grid->count, m->error);
        RITZ_CHECK(merge_grids(grid, &middles));
    }
}

/* The axis n about which a body turns with x, in its own frame. With N u = n x
   u and d the angle between two knots, R_0'R_1 = exp(d N) has the skew part
   sin(d) N. */
static void find_axis(const sweep_knot *a, const sweep_knot *b, int64_t body,
                      double n[3])
{
    const double d = sin(b->x - a->x);

    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        double sum = 0.0;

        for (int c = 0; c < 3; c++) {
            const double *const at[4] = {ritz_dense_col(&a->places, 3 * c + k),
                                         ritz_dense_col(&b->places, 3 * c + j),
                                         ritz_dense_col(&a->places, 3 * c + j),
                                         ritz_dense_col(&b->places, 3 * c + k)};

            sum += at[0][body] * at[1][body] - at[2][body] * at[3][body];
        }
        n[i] = 0.5 * sum / d;
    }
}

/* Add to G and H the blocks of a body that turns about n. */
static void add_turning(const ritz_invariants *own, const double n[3],
                        int64_t first, ritz_dense *G, ritz_dense *H)
{
    const int64_t r = own->momentum.ncol;

    for (int64_t k = 0; k < r; k++)
        for (int64_t j = 0; j < r; j++) {
            double g = 0.0, h = 0.0;

            for (int a = 0; a < 3; a++) {
                const int b = (a + 1) % 3, c = (a + 2) % 3;
                const double *at_b = ritz_dense_col(&own->product, b * r + k);
                const double *at_c = ritz_dense_col(&own->product, c * r + k);

                /* n . phi_k x phi_j = sum_a n_a (k_b j_c - k_c j_b) */
                g += n[a] * (at_b[c * r + j] - at_c[b * r + j]);
                h += ritz_dense_col(&own->product, a * r + k)[a * r + j];
                for (int e = 0; e < 3; e++)
                    h -= n[a] * n[e] *
                         ritz_dense_col(&own->product, e * r + k)[a * r + j];
            }
            ritz_dense_col(G, first + k)[first + j] = g;
            ritz_dense_col(H, first + k)[first + j] = h;
        }
}

/* G and H, if any body turns. */
static ritz_status find_turning(const sweeper *w, const sweep_grid *grid,
                                ritz_swept_model *m)
{
    const ritz_stage *stage = w->stage;
    const int64_t Q = stage->num_coordinates, last = grid->count - 1;

    if (!stage->scene->sweep[w->asked->sweep].turns)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_new(Q, Q, &m->G));
    RITZ_CHECK(ritz_dense_new(Q, Q, &m->H));
    for (int64_t k = 0; k < stage->count; k++) {
        const char *name = stage->scene->component[k].name;
        double n[3], end[3], off = 0.0, length = 0.0;

        find_axis(&grid->knot[0], &grid->knot[1], k, n);
        find_axis(&grid->knot[last - 1], &grid->knot[last], k, end);
        for (int i = 0; i < 3; i++) {
            length += n[i] * n[i];
            off = fmax(off, fabs(n[i] - end[i]));
        }
        if (length < RITZ_SWEPT_AXIS && off < RITZ_SWEPT_AXIS)
            continue;
        RITZ_REFUSE_IF(off > RITZ_SWEPT_AXIS ||
                           fabs(length - 1.0) > RITZ_SWEPT_AXIS,
                       RITZ_ERR_ARGUMENT,
                       "'%s' does not turn evenly with '%s': a loop of joints "
                       "turns it",
                       name, sweep_name(w));
        RITZ_REFUSE_IF(!stage->body[k].invariants.momentum.val,
                       RITZ_ERR_ARGUMENT,
                       "'%s' turns with '%s', and its inertia is not known: it "
                       "has no grids, or more than %d columns",
                       name, sweep_name(w), RITZ_INVARIANT_COLUMNS);
        add_turning(&stage->body[k].invariants, n, stage->first[k], &m->G,
                    &m->H);
    }
    return RITZ_OK;
}

/* Matrices of all bodies, and the joints' springs. */
static ritz_status stack_bodies(const sweeper *w, ritz_swept_model *m)
{
    const ritz_stage *stage = w->stage;
    const int64_t Q = stage->num_coordinates;

    RITZ_CHECK(ritz_dense_new(Q, Q, &m->M));
    RITZ_CHECK(ritz_dense_new(Q, Q, &m->K));
    for (int64_t k = 0; k < stage->count; k++) {
        const ritz_reduced *body = &stage->body[k];
        const int64_t first = stage->first[k];

        RITZ_REFUSE_IF(body->K4.val, RITZ_ERR_ARGUMENT,
                       "structural damping of '%s' is of harmonic motion alone",
                       stage->scene->component[k].name);
        ritz_dense_put(&body->M, first, first, &m->M);
        ritz_dense_put(&body->K, first, first, &m->K);
        if (body->D.val && !m->D.val)
            RITZ_CHECK(ritz_dense_new(Q, Q, &m->D));
        if (body->D.val)
            ritz_dense_put(&body->D, first, first, &m->D);
    }
    return ritz_io_copy(&stage->io, &m->io);
}

static ritz_status list_springs(const sweeper *w, ritz_swept_model *m)
{
    RITZ_OWN(ritz_springs) springs = {0};

    RITZ_CHECK(ritz_stage_springs(w->stage, w->asked->setting, &springs));
    m->num_springs = springs.S.nrow;
    RITZ_CHECK_NEW(m->stiffness, m->num_springs);
    RITZ_CHECK_NEW(m->damping, m->num_springs);
    for (int64_t k = 0; k < m->num_springs; k++) {
        m->stiffness[k] = springs.of.item[k].freedom->stiffness;
        m->damping[k] = springs.of.item[k].freedom->damping;
    }
    return RITZ_OK;
}

/* start = sum_c P_c'M_c V_c T_c over the bodies of the stage `origin`, in whose
   modes x0 is; P_c and M_c are of that stage. */
static ritz_status start_from(const sweeper *w, const ritz_dense *T,
                              ritz_swept_model *m)
{
    const ritz_stage *origin = w->asked->origin;
    RITZ_OWN(ritz_configuration) c = {0};

    RITZ_CHECK(ritz_stage_assemble(origin, w->asked->setting, &c));
    RITZ_CHECK(ritz_dense_new(c.K.ncol, m->order, &m->start));
    for (int64_t k = 0; k < origin->count; k++) {
        RITZ_OWN(ritz_dense) part = {0}, VT = {0}, MVT = {0}, own = {0};

        RITZ_CHECK(ritz_dense_block(T, w->stage->first[k], w->asked->V[k].ncol,
                                    0, m->order, &part));
        RITZ_CHECK(ritz_dense_mul(&w->asked->V[k], &part, &VT));
        RITZ_CHECK(ritz_dense_mul(&origin->body[k].M, &VT, &MVT));
        RITZ_CHECK(ritz_dense_mul_tn(&c.P[k], &MVT, &own));
        ritz_dense_add(1.0, &own, &m->start);
    }
    return RITZ_OK;
}

/* The matrix that gives q for x0 at the start, and the frequencies there. */
static ritz_status find_start(const sweeper *w, ritz_swept_model *m)
{
    const double x = m->unit * w->asked->setting[w->asked->sweep];
    RITZ_OWN(sweep_grid) one = {0};
    RITZ_OWN(ritz_dense) F = {0}, T = {0};
    const sweep_knot *k = NULL;

    RITZ_CHECK(make_one(w, x, &one));
    k = &one.knot[0];
    RITZ_CHECK(ritz_swept_values(m, x, &F));
    RITZ_CHECK(ritz_dense_block(&F, 0, m->M.nrow, 0, m->order, &T));
    if (k->rigid < m->order)
        m->start_hz[0] = sqrt(k->lambda[k->rigid]) / (2.0 * RITZ_PI);
    m->start_hz[1] = sqrt(fmax(k->lambda[m->order - 1], 0.0)) / (2.0 * RITZ_PI);
    if (w->asked->origin)
        return start_from(w, &T, m);
    return correlate(&k->V, &m->M, &T, &m->start);
}

static ritz_status check_sweep(const ritz_stage *stage,
                               const ritz_sweep_request *asked)
{
    RITZ_REFUSE_IF(stage->scene->spin.given, RITZ_ERR_ARGUMENT,
                   "no joint is turned in a scene that spins");
    RITZ_REFUSE_IF(asked->sweep < 0 || asked->sweep >= stage->scene->num_sweeps,
                   RITZ_ERR_ARGUMENT, "the scene has no such joint");
    RITZ_REFUSE_IF(!(asked->range[1] > asked->range[0]), RITZ_ERR_ARGUMENT,
                   "'%s' does not move from %g to %g: the range is empty",
                   stage->scene->sweep[asked->sweep].name, asked->range[0],
                   asked->range[1]);
    RITZ_REFUSE_IF(asked->modes > 0 && asked->up_to_hz > 0.0, RITZ_ERR_ARGUMENT,
                   "a number of modes or a band, one of them");
    return ritz_dual_refuse(stage);
}

ritz_status ritz_stage_sweep(const ritz_stage *stage,
                             const ritz_sweep_request *asked,
                             ritz_swept_model *out)
{
    RITZ_OWN(ritz_swept_model) m = {0};
    RITZ_OWN(sweep_grid) grid = {0};
    sweeper w = {.stage = stage, .asked = asked, .unit = 1.0};

    RITZ_CHECK(check_sweep(stage, asked));
    if (stage->scene->sweep[asked->sweep].turns)
        w.unit = RITZ_PI / 180.0;
    w.first = w.unit * asked->range[0];
    w.last = w.unit * asked->range[1];
    m.unit = w.unit;
    memcpy(m.sweep, sweep_name(&w), sizeof m.sweep);
    m.has_ratios = asked->damping && asked->damping->kind != RITZ_DAMPING_NONE;
    RITZ_CHECK(stack_bodies(&w, &m));
    RITZ_CHECK(list_springs(&w, &m));
    RITZ_CHECK(choose_fewest(&w));
    RITZ_CHECK(begin_grid(&w, &grid));
    RITZ_CHECK(check_ranks(&w, &grid));
    RITZ_CHECK(choose_order(&w, &grid, &m.order));
    RITZ_CHECK(find_turning(&w, &grid, &m));
    RITZ_CHECK(refine(&w, &grid, &m));
    RITZ_CHECK(find_start(&w, &m));
    RITZ_MOVE(*out, m);
    return RITZ_OK;
}
