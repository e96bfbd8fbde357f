/*
 * The order of columns. From the whole model one at a time is left out, that
 * without which the model, at the listed configurations, is nearest to its
 * tolerance; what is left out last comes first.
 */
#include "fit/nesting.h"

#include "base/alloc.h"
#include "base/team.h"
#include "base/tolerances.h"

#include <ritz/base.h>
#include <ritz/matrix.h>

#include <float.h>
#include <math.h>
#include <string.h>

/* Entries of a component's T above which columns stay as they were made. */
static const int64_t most_entries = 4000000;
/* Columns that are tried at each step: those that matter least alone. */
enum { TRIED = 6 };

/* ceil(count / most) = k: one in k is measured; 1 if `most` is no limit. */
static int64_t divide_work(int64_t count, int64_t most)
{
    return count > most && most > 0 ? (count + most - 1) / most : 1;
}

/* Room for the columns of `whole`, numbered through all bodies. */
static ritz_status begin_nesting(ritz_fitter *f, ritz_nesting *n)
{
    n->f = f;
    n->every = n->step = 1;
    RITZ_CHECK_NEW(n->first, f->num_bodies + 1);
    for (int64_t k = 0; k < f->num_bodies; k++)
        n->first[k + 1] = n->count += n->whole.item[k].K.ncol;
    RITZ_CHECK_NEW(n->column, n->count);
    RITZ_CHECK_NEW(n->own, n->count);
    RITZ_CHECK_NEW(n->some, n->count);
    return f->scene ? RITZ_OK
                    : ritz_reference_parts(f->place[0].reference,
                                           &n->whole.item[0].T, &n->parts);
}

/*
 * Columns as they were made, but those that must stay first. Where columns or
 * places are many, some of them speak for all: of c columns that may go, c
 * models alone and some 2 c cuts are measured at places.
 */
static ritz_status begin_order(ritz_fitter *f, ritz_nesting *n)
{
    RITZ_OWN_ARRAY ritz_column_kind *kind = NULL;
    const int64_t most = f->request.most_measured;

    RITZ_CHECK_NEW(n->alone, n->count);
    RITZ_CHECK_NEW(kind, n->count);
    for (int64_t k = 0; k < f->num_bodies; k++)
        RITZ_CHECK(ritz_fit_kinds(&n->whole.item[k], kind + n->first[k]));
    for (int64_t k = 0; k < n->count; k++)
        if (ritz_fit_stays(kind[k]))
            n->column[n->fixed++] = k;
    for (int64_t k = 0, at = n->fixed; k < n->count; k++)
        if (!ritz_fit_stays(kind[k]))
            n->column[at++] = k;
    n->every = divide_work((n->count - n->fixed) * f->num_listed, most);
    n->step = divide_work(2 * (n->count - n->fixed) * f->num_places, most);
    return RITZ_OK;
}

/* A model with one column less that is measured. */
typedef struct column_trial {
    ritz_nesting *n;     /* borrowed */
    int64_t left, which; /* without this one of the first `left` of the order */
    double most;         /* see ritz_nesting_ratio */
    bool keeps_modes;
    double ratio;
    ritz_pairs modes;
    ritz_status status;
} column_trial;

static void column_trial_free(column_trial *t)
{
    ritz_pairs_free(&t->modes);
}

RITZ_ARRAY_OF(column_trial);

static ritz_status measure_trial(column_trial *t)
{
    const size_t before = (size_t)t->which;
    const size_t behind = (size_t)(t->left - 1 - t->which);
    RITZ_OWN_ARRAY int64_t *some = NULL;

    RITZ_CHECK_RAW(some, t->left);
    memcpy(some, t->n->column, before * sizeof *some);
    memcpy(some + before, t->n->column + before + 1, behind * sizeof *some);
    return ritz_nesting_ratio(t->n, t->left - 1, some, t->most,
                              t->keeps_modes ? &t->modes : NULL, &t->ratio);
}

static void measure_item(int64_t k, void *task)
{
    column_trial *t = (column_trial *)task + k;

    t->status = measure_trial(t);
}

/* Measure some trials at once. What fails is memory: other failures are the
   model's own, and make its ratio infinite. */
static ritz_status measure_trials(int threads, int64_t count,
                                  column_trial *item)
{
    RITZ_CHECK(ritz_fit_go_on(item->n->f));
    ritz_team_each(threads, count, measure_item, item);
    for (int64_t k = 0; k < count; k++)
        RITZ_REFUSE_IF(item[k].status != RITZ_OK, item[k].status,
                       "no memory to put columns in order");
    return RITZ_OK;
}

/* Move a column of the order to another place in it, the others moving up. */
static void move_column(ritz_nesting *n, int64_t from, int64_t to)
{
    const int64_t here = n->column[from];
    const int64_t step = from < to ? 1 : -1;

    for (int64_t k = from; k != to; k += step)
        n->column[k] = n->column[k + step];
    n->column[to] = here;
}

/* Sort the columns that may go by the ratio of the model without each alone. */
static ritz_status order_alone(ritz_nesting *n)
{
    const int threads = ritz_nesting_threads(n, n->count - n->fixed);
    RITZ_OWN(column_trial_array) some = {.count = ritz_team_shares(threads)};

    RITZ_CHECK_NEW(some.at, some.count);
    for (int64_t k = n->fixed; k < n->count && n->count > 1; k += some.count) {
        const int64_t more =
            n->count - k < some.count ? n->count - k : some.count;

        ritz_monitor_step("columns alone", k, n->count);
        for (int64_t t = 0; t < more; t++)
            some.at[t] = (column_trial){
                .n = n, .left = n->count, .which = k + t, .most = HUGE_VAL};
        RITZ_CHECK(measure_trials(threads, more, some.at));
        for (int64_t t = 0; t < more; t++)
            n->alone[n->column[k + t]] = some.at[t].ratio;
    }
    for (int64_t k = n->fixed + 1; k < n->count; k++) {
        int64_t at = k;

        while (at > n->fixed &&
               n->alone[n->column[k]] > n->alone[n->column[at - 1]])
            at--;
        move_column(n, k, at);
    }
    return RITZ_OK;
}

/* A body without columns that must stay keeps the one that matters most
   alone. */
static void keep_one_each(ritz_nesting *n)
{
    for (int64_t k = 0; k < n->f->num_bodies; k++) {
        int64_t at = n->fixed;

        if (ritz_nesting_own(n, k, n->fixed, n->column, NULL) > 0)
            continue;
        while (n->column[at] < n->first[k] || n->column[at] >= n->first[k + 1])
            at++;
        move_column(n, at, n->fixed++);
    }
}

/* --- columns that cannot be the next to go -------------------------------- */

/*
 * Eigenvalues below @p x without column j of a model whose modes, Phi'M Phi = I,
 * are all known. Its motions Phi y are those with phi_j y = 0, phi_j being row j
 * of Phi, and their eigenvalues are the zeros of
 *
 *     f(x) = sum_k phi_jk^2 / (lambda_k - x),
 *
 * which rises from -inf to +inf between one lambda and the next: of N lambda
 * below x there remain N zeros where f(x) > 0, and N - 1 otherwise [Golub1973].
 */
static int64_t count_without(const ritz_pairs *modes, int64_t j, double x)
{
    int64_t below = 0;
    double f = 0.0;

    for (int64_t k = 0; k < modes->Phi.ncol; k++) {
        const double part = ritz_dense_col(&modes->Phi, k)[j];

        below += modes->lambda[k] < x;
        if (part != 0.0)
            f += part * part / (modes->lambda[k] - x);
    }
    return f > 0.0 || !isfinite(f) ? below : below - 1;
}

/*
 * Whether the ratio without column j is more than @p least, as eigenvalues alone
 * say. If no frequency were off by more than e = least times its tolerance, the
 * first k flexible modes of the band would have partners up to
 * (1 + e)^2 lambda_k, but for the missing modes, whose number m makes the ratio
 * 1 + m. Eigenvalues that can hardly be told from that are no proof.
 */
static bool is_surely_worse(const ritz_nesting *n, int64_t j, double least)
{
    const double *limit = n->f->request.tolerance.limit;
    const double *band = n->f->request.tolerance.band_hz;
    const ritz_pairs *full = ritz_reference_pairs(n->f->place[0].reference);
    const double e = limit[RITZ_MEASURE_FREQUENCY] * least + RITZ_SAME;
    const int64_t last = n->modes.Phi.ncol - 1;
    const double rounding =
        RITZ_SCREEN_ROUNDING * DBL_EPSILON * n->modes.lambda[last];
    const int64_t missing = (int64_t)fmax(0.0, ceil(least - 1.0) - 1.0);
    int64_t number = 0;

    for (int64_t k = full->num_rigid; k < full->Phi.ncol; k++) {
        const double hertz = ritz_eigen_hertz(full->lambda[k]);
        const double x = full->lambda[k] * (1.0 + e) * (1.0 + e) + rounding;

        if (hertz < band[0] || hertz > band[1])
            continue;
        number++;
        if (count_without(&n->modes, j, x) - n->modes.num_rigid <
            number - missing)
            return true;
    }
    return false;
}

/* Whether eigenvalues can rule columns out: the model's modes are known, and a
   tolerance of frequencies allows no missing mode. */
static bool can_screen(const ritz_nesting *n, double least)
{
    const double *limit = n->f->request.tolerance.limit;

    return isfinite(least) && n->modes.Phi.ncol > 0 &&
           n->modes.Phi.ncol == n->modes.Phi.nrow &&
           limit[RITZ_MEASURE_FREQUENCY] > 0.0 &&
           !(limit[RITZ_MEASURE_MISSING] > 0.0);
}

/* Fill the next trials of those that are not ruled out. @return how many */
static int64_t choose_trials(ritz_nesting *n, int64_t left, double least,
                             int64_t *next, column_trial_array *some)
{
    const bool screens = can_screen(n, least);
    int64_t count = 0;

    for (; *next < TRIED && left - 1 - *next >= n->fixed && count < some->count;
         (*next)++) {
        const int64_t which = left - 1 - *next;

        if (screens && is_surely_worse(n, which, least))
            continue;
        column_trial_free(&some->at[count]);
        some->at[count++] = (column_trial){.n = n,
                                           .left = left,
                                           .which = which,
                                           .most = least,
                                           .keeps_modes = !n->f->scene};
    }
    return count;
}

/* Move one of the last few columns to the end: that which is missed least. */
static ritz_status drop_column(ritz_nesting *n, int64_t left)
{
    const int threads = ritz_nesting_threads(n, TRIED);
    RITZ_OWN(column_trial_array) some = {.count = threads};
    RITZ_OWN(ritz_pairs) modes = {0};
    double least = HUGE_VAL;
    int64_t worst = left - 1, next = 0, count = 0;

    RITZ_CHECK_NEW(some.at, threads);
    while ((count = choose_trials(n, left, least, &next, &some)) > 0) {
        RITZ_CHECK(measure_trials(threads, count, some.at));
        for (int64_t t = 0; t < count; t++) {
            if (!(some.at[t].ratio < least))
                continue;
            least = some.at[t].ratio;
            worst = some.at[t].which;
            ritz_pairs_free(&modes);
            RITZ_MOVE(modes, some.at[t].modes);
        }
    }
    move_column(n, worst, left - 1);
    ritz_pairs_free(&n->modes);
    RITZ_MOVE(n->modes, modes);
    return RITZ_OK;
}

/* Put the columns of all bodies in order, those that matter most first. If a
   component is too large for that, they stay as they were made. */
static ritz_status find_order(ritz_fitter *f, ritz_nesting *n)
{
    if (!f->scene && n->whole.item[0].T.nrow * n->count > most_entries)
        return RITZ_OK;
    RITZ_CHECK(order_alone(n));
    if (f->scene)
        keep_one_each(n);
    /* the one that matters least alone is the first to go */
    for (int64_t left = n->count - 1; left > n->fixed + 1; left--) {
        ritz_monitor_step("columns in order", n->count - left, n->count);
        RITZ_CHECK(drop_column(n, left));
    }
    return RITZ_OK;
}

ritz_status ritz_nesting_order(ritz_fitter *f, const ritz_fit_candidate *of,
                               ritz_nesting *n)
{
    const ritz_fit_ordered *known = NULL;

    RITZ_CHECK(begin_nesting(f, n));
    known = ritz_fit_ordered_find(f, of, n->count);
    if (!known) {
        RITZ_CHECK(begin_order(f, n));
        RITZ_CHECK(find_order(f, n));
        return ritz_fit_ordered_keep(f, of,
                                     &(ritz_fit_ordered){.count = n->count,
                                                         .fixed = n->fixed,
                                                         .step = n->step,
                                                         .column = n->column});
    }
    n->fixed = known->fixed;
    n->step = known->step;
    memcpy(n->column, known->column, (size_t)n->count * sizeof *n->column);
    return RITZ_OK;
}
