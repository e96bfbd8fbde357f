/*
 * The reduction of a flexible body by a method with some number of modes, and
 * the kinds of its columns.
 *
 * All candidates of a nested method share one basis of each body. A method is
 * nested if its basis with m modes consists of columns of its basis with N > m
 * modes: all columns that are no modes, and the first m modes. With S the
 * columns of the unit matrix that select these,
 *
 *     K_m = S'K_N S,   M_m = S'M_N S,   Phi'M T_m = (Phi'M T_N) S,
 *
 * so that a candidate takes no work of the full model's size. The basis is made
 * with more modes than the first candidate needs, and again with twice as many
 * when that is not enough. Modes of one cluster are taken together, as
 * ritz_eigen_sparse computes them.
 *
 * Methods with a function ritz_narrow combine the columns of one basis with N
 * modes, which may be another method's, to those with m < N modes: T_m = T_N V,
 * K_m = V'K_N V and so on. A method of neither kind makes a new basis for each
 * number of modes; the last one is kept.
 */
#include "fit/fitter.h"

#include "assembly/assembly.h"
#include "base/alloc.h"
#include "base/tolerances.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* The first basis has FOR_EACH modes for each mode of the full model in the
   band, and AND_MORE beyond these. */
enum { FOR_EACH = 4, AND_MORE = 24 };

bool ritz_fit_stays(ritz_column_kind kind)
{
    static const ritz_column_kind kinds[] = {
        RITZ_COLUMN_RIGID,      RITZ_COLUMN_CONSTRAINT, RITZ_COLUMN_INTERFACE,
        RITZ_COLUMN_ATTACHMENT, RITZ_COLUMN_RESIDUAL,   RITZ_COLUMN_MASSLESS,
        RITZ_COLUMN_FORCE};

    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        if (kind == kinds[k])
            return true;
    return false;
}

/* Column j is rigid if |x_j| sqrt(M_jj) is more than rounding in a rigid mode x
   with x'M x = 1. */
ritz_status ritz_fit_kinds(const ritz_reduced *whole, ritz_column_kind *kind)
{
    RITZ_OWN(ritz_pairs) pairs = {0};
    const int64_t n = whole->K.ncol;
    ritz_status status = RITZ_OK;

    if (n == 0)
        return RITZ_OK;
    memcpy(kind, whole->columns.kind, (size_t)n * sizeof *kind);
    status = ritz_eigen_dense(&whole->K, &whole->M, &pairs);
    if (status == RITZ_ERR_SINGULAR)
        return RITZ_OK; /* a mechanism without mass: kinds alone decide */
    RITZ_CHECK(status);
    for (int64_t r = 0; r < pairs.num_rigid; r++)
        for (int64_t j = 0; j < n; j++) {
            const double mass = ritz_dense_col(&whole->M, j)[j];
            const double part = ritz_dense_col(&pairs.Phi, r)[j];

            if (part * part * mass > RITZ_RIGID_PART * RITZ_RIGID_PART &&
                !ritz_fit_stays(kind[j]))
                kind[j] = RITZ_COLUMN_RIGID;
        }
    return RITZ_OK;
}

/* --- one body by one method ----------------------------------------------- */

/* The options of the request that this method takes. A band or damping that is
   not among them is that of the tolerance. */
static ritz_choice choose_options(const ritz_fitter *fitter,
                                  const ritz_method *method)
{
    const ritz_verify_request *limits = &fitter->request.tolerance;
    ritz_choice choice = fitter->request.choice;
    int absent = ~choice.given;

    if (absent & method->uses & RITZ_USES_DAMPING &&
        limits->damping.kind != RITZ_DAMPING_NONE) {
        choice.damping = limits->damping;
        choice.given |= RITZ_USES_DAMPING;
    }
    if (absent & method->uses & RITZ_USES_BAND) {
        memcpy(choice.band_hz, limits->band_hz, sizeof choice.band_hz);
        choice.given |= RITZ_USES_BAND;
    }
    if (absent & method->uses & RITZ_USES_SIDES) {
        choice.one_sided = true; /* as symmetric as other candidates */
        choice.given |= RITZ_USES_SIDES;
    }
    choice.given &= method->uses;
    if (!ritz_engine_fits(method, choice.engine)) {
        choice.engine = RITZ_ENGINE_AUTO;
        choice.given &= ~RITZ_USES_ENGINE;
    }
    return choice;
}

/* The request for a basis of flexible body k of a scene. */
static ritz_status request_of_scene(const ritz_fitter *f,
                                    const ritz_method *method, int64_t k,
                                    int64_t modes, ritz_body_request *out)
{
    ritz_scene_component item = f->scene->component[f->body[k]]; /* borrowed */

    (void)snprintf(item.basis, sizeof item.basis, "%s", method->name);
    item.modes = modes;
    item.up_to_hz = 0.0;
    if (f->request.choice.given)
        item.choice = f->request.choice;
    item.choice.given &= method->uses;
    return ritz_body_request_new(f->scene, f->body[k], &item, &f->model[k],
                                 out);
}

/* The request for a basis of flexible body k. */
static ritz_status request_basis(const ritz_fitter *f,
                                 const ritz_method *method, int64_t k,
                                 int64_t modes, ritz_body_request *out)
{
    ritz_request *request = &out->asked;

    if (f->scene)
        return request_of_scene(f, method, k, modes, out);
    *request = (ritz_request)RITZ_REQUEST_NONE;
    request->component = f->component;
    request->modes = modes;
    request->choice = choose_options(f, method);
    request->attached = f->attached;
    return RITZ_OK;
}

/* The modes of flexible body k that the ladder of a scene or the reference of a
   component has; NULL if the stiffness of the reference is not the component's,
   which is without dampers. */
static const ritz_pairs *find_known(const ritz_fitter *f, int64_t k)
{
    const ritz_pairs *ladder = f->scene ? &f->known[f->equal[k]] : NULL;

    if (f->scene)
        return ladder->Phi.val ? ladder : NULL;
    return f->component->dampers.count > 0
               ? NULL
               : ritz_reference_pairs(f->place[0].reference);
}

/* @param[in] counted  prove by a count that no mode is missing */
static ritz_status reduce_body(const ritz_fitter *f, const ritz_method *method,
                               int64_t k, int64_t modes, bool counted,
                               ritz_reduced *out)
{
    RITZ_OWN(ritz_body_request) own = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    RITZ_CHECK(request_basis(f, method, k, modes, &own));
    if (!counted) {
        own.asked.choice.uncounted = true;
        own.asked.known = find_known(f, k);
    }
    RITZ_CHECK(ritz_basis_make(method, &own.asked, &basis));
    return ritz_reduce(own.asked.component, &basis, out);
}

ritz_status ritz_fit_body(ritz_fitter *f, const ritz_method *method, int64_t k,
                          int64_t modes, ritz_reduced *out)
{
    ritz_status status = RITZ_OK;

    if (f->scene && method == &ritz_fit_compare)
        return ritz_fit_second_body(f, k, modes, out);
    status = reduce_body(f, method, k, modes, true, out);
    return f->scene ? ritz_context(status, ritz_fitter_body(f, k)) : status;
}

bool ritz_fit_are_equal(const ritz_fitter *f, const ritz_method *method,
                        int64_t j, int64_t k)
{
    return j == k ||
           (f->equal[j] == f->equal[k] && method != &ritz_fit_compare &&
            !(method->uses & RITZ_USES_NEIGHBOUR));
}

/* --- the basis of a body that is kept ------------------------------------- */

void ritz_fit_family_free(ritz_fit_family *family)
{
    ritz_reduced_free(&family->whole);
    ritz_dense_free(&family->parts);
    *family = (ritz_fit_family){0};
}

static bool is_mode(ritz_column_kind kind)
{
    return kind == RITZ_COLUMN_NORMAL || kind == RITZ_COLUMN_KRYLOV;
}

/* Whether bases with fewer modes can be made from this one. Static columns
   prevent that: their part in the modes was removed, so that they change with
   the number of modes. A residual mode that was left out prevents it too: with
   fewer modes it may be large enough to be kept. */
static bool contains_fewer(const ritz_method *method, int64_t attached,
                           const ritz_columns *columns)
{
    int64_t residuals = 0;

    for (int64_t j = 0; j < columns->count; j++) {
        if (columns->kind[j] == RITZ_COLUMN_STATIC)
            return false;
        residuals += columns->kind[j] == RITZ_COLUMN_RESIDUAL;
    }
    return !method->narrow || residuals == attached;
}

/* Whether the frequencies of two modes differ so little that both are taken or
   neither. */
static bool are_close(const ritz_columns *columns, int64_t j, int64_t next)
{
    const double low = columns->hertz[j];
    const double high = columns->hertz[next];

    return high * high - low * low <= RITZ_CLUSTER_GAP * high * high;
}

/* Choose the columns of a basis with @p modes modes: those that are no modes,
   the first @p modes modes, and further ones of the last one's cluster.
   @return how many */
static int64_t choose_columns(const ritz_columns *columns, int64_t modes,
                              int64_t *at)
{
    int64_t count = 0, taken = 0, last = -1;

    for (int64_t j = 0; j < columns->count; j++) {
        if (is_mode(columns->kind[j])) {
            if (taken >= modes && !(last >= 0 && are_close(columns, last, j)))
                continue;
            last = j;
            taken++;
        }
        at[count++] = j;
    }
    return count;
}

/* Whether candidates with different numbers of modes are made from one basis.
   No count proves that this basis has all modes: candidates are measured, and
   the basis of the result is made again, with a count. */
static bool is_shared(const ritz_method *method)
{
    return method->nested || method->narrow;
}

/* Whether T of a kept basis serves a purpose after the reduction: shapes of a
   component are taken from it, bounds of a scene, and the combinations of a
   method. */
static bool needs_basis(const ritz_fitter *f, const ritz_method *method)
{
    return !f->scene || f->place[0].estimator || method->narrow;
}

static ritz_status make_whole(ritz_fitter *f, const ritz_fit_family *family,
                              int64_t modes, ritz_reduced *out,
                              ritz_dense *parts)
{
    const ritz_method *method = family->method;

    RITZ_CHECK(
        reduce_body(f, method, family->body, modes, !is_shared(method), out));
    if (!needs_basis(f, method))
        ritz_dense_free(&out->T);
    return f->scene
               ? RITZ_OK
               : ritz_reference_parts(f->place[0].reference, &out->T, parts);
}

/* Find what is kept of body k for a method; at the first call, an empty
   entry. */
static ritz_status find_family(ritz_fitter *f, const ritz_method *method,
                               int64_t k, ritz_fit_family **out)
{
    for (int64_t t = 0; t < f->num_families; t++)
        if (f->family[t].method == method &&
            ritz_fit_are_equal(f, method, f->family[t].body, k)) {
            *out = &f->family[t];
            return RITZ_OK;
        }
    RITZ_CHECK_ROOM(f->family, f->num_families, f->room_families);
    *out = &f->family[f->num_families++];
    **out =
        (ritz_fit_family){.method = method,
                          .body = k,
                          .modes = -1,
                          .exact = !method->nested && method->wide != method};
    return RITZ_OK;
}

/* How many flexible modes of a body a method with free-interface modes need not
   compute: all known ones but the last, as it takes known modes only if the next
   one above them is known too. */
static int64_t count_known(const ritz_fitter *f, int64_t k)
{
    const ritz_pairs *known = find_known(f, k);
    const int64_t flexible = known ? known->Phi.ncol - known->num_rigid : 0;

    return flexible > 0 ? flexible - 1 : 0;
}

/* Modes in the band: of the reference of a component, and free modes of a body
   of a scene. */
static int64_t count_in_band(const ritz_fitter *f, int64_t k)
{
    int64_t rigid = 0;

    return f->scene ? ritz_fit_modes_to(f, k, f->request.tolerance.band_hz[1])
                    : ritz_reference_modes(f->place[0].reference, &rigid);
}

/* How many modes the basis gets that is made when a candidate with @p modes
   modes needs one: more than a candidate can ask for are of no use. */
static int64_t choose_modes(const ritz_fitter *f, const ritz_fit_family *family,
                            int64_t modes)
{
    const int64_t known = count_known(f, family->body);
    const int64_t most =
        f->scene ? ritz_fit_modes_to(f, family->body, HUGE_VAL) : f->largest;
    int64_t more = 2 * family->modes;

    if (family->exact || modes <= family->modes) /* dropped by make_room */
        return family->exact ? modes : family->modes;
    if (family->modes < 0)
        more = FOR_EACH * count_in_band(f, family->body) + AND_MORE;
    if (family->modes < 0 && family->method->narrow && modes <= known &&
        known < more)
        more = known;
    if (more > most)
        more = most;
    return more > modes ? more : modes;
}

static int64_t count_entries(const ritz_fit_family *family)
{
    return family->whole.T.nrow * family->whole.T.ncol;
}

/* The kept basis of another method that has not been used for longest; NULL:
   there is none. A candidate needs the bases of all its bodies by one method. */
static ritz_fit_family *find_oldest(const ritz_fitter *f,
                                    const ritz_fit_family *keep)
{
    ritz_fit_family *oldest = NULL;

    for (int64_t k = 0; k < f->num_families; k++) {
        ritz_fit_family *family = &f->family[k];

        if (family->method != keep->method && count_entries(family) > 0 &&
            (!oldest || family->used < oldest->used))
            oldest = family;
    }
    return oldest;
}

/* While all kept bases together are too large, drop the one of another method
   that has not been used for longest. */
static void make_room(ritz_fitter *f, const ritz_fit_family *keep)
{
    ritz_fit_family *oldest = find_oldest(f, keep);
    int64_t held = 0;

    for (int64_t k = 0; k < f->num_families; k++)
        held += count_entries(&f->family[k]);
    for (; held > f->most_entries && oldest; oldest = find_oldest(f, keep)) {
        held -= count_entries(oldest);
        ritz_reduced_free(&oldest->whole);
        ritz_dense_free(&oldest->parts);
    }
}

/* Dofs of the body that are attached. */
static ritz_status count_attached(const ritz_fitter *f,
                                  const ritz_fit_family *family, int64_t *out)
{
    RITZ_OWN(ritz_body_request) own = {0};

    RITZ_CHECK(request_basis(f, family->method, family->body, 0, &own));
    *out = own.asked.attached.count;
    return RITZ_OK;
}

/* Make the basis for a candidate with @p modes modes. If one with more modes
   fails or has static columns, make one with exactly @p modes: only if that
   fails is the candidate refused. */
static ritz_status renew_family(ritz_fitter *f, int64_t modes,
                                ritz_fit_family *family)
{
    int64_t attached = 0;

    RITZ_CHECK(count_attached(f, family, &attached));
    for (bool served = false; !served;) {
        RITZ_OWN(ritz_reduced) whole = {0};
        RITZ_OWN(ritz_dense) parts = {0};
        const int64_t made = choose_modes(f, family, modes);
        const ritz_status status = make_whole(f, family, made, &whole, &parts);

        if (status == RITZ_ERR_MEMORY || made == modes)
            RITZ_CHECK(status);
        if (status != RITZ_OK ||
            !contains_fewer(family->method, attached, &whole.columns))
            family->exact = true;
        served = !family->exact || made == modes;
        if (!served)
            continue;
        ritz_reduced_free(&family->whole);
        ritz_dense_free(&family->parts);
        family->modes = made;
        RITZ_MOVE(family->whole, whole);
        RITZ_MOVE(family->parts, parts);
    }
    make_room(f, family);
    return RITZ_OK;
}

static bool can_serve(const ritz_fit_family *family, int64_t modes)
{
    return family->whole.K.ncol > 0 &&
           (family->exact ? modes == family->modes : modes <= family->modes);
}

/* Reduce the body by some columns of the kept basis; find Phi'M T of these if
   it is a component. */
static ritz_status take_columns(const ritz_fit_family *family, int64_t count,
                                const int64_t *at, bool with_T,
                                ritz_reduced *out, ritz_dense *parts)
{
    ritz_reduced whole = family->whole; /* borrowed */

    if (!with_T) {
        whole.T = (ritz_dense){0};
        whole.invariants = (ritz_invariants){0};
    }
    RITZ_CHECK(ritz_reduced_nest(&whole, count, at, 1, out));
    ritz_nested_free(&out->nested);
    return family->parts.val ? ritz_dense_pick(&family->parts, count, at, parts)
                             : RITZ_OK;
}

/* Reduce the body by combinations V of the columns of the kept basis. */
static ritz_status combine_columns(const ritz_fit_family *family,
                                   const ritz_dense *V, bool with_T,
                                   ritz_reduced *out, ritz_dense *parts)
{
    ritz_reduced whole = family->whole; /* borrowed */

    if (!with_T) {
        whole.T = (ritz_dense){0};
        whole.invariants = (ritz_invariants){0};
    }
    RITZ_CHECK(ritz_reduced_project(&whole, V, out));
    return family->parts.val ? ritz_dense_mul(&family->parts, V, parts)
                             : RITZ_OK;
}

/* Find the kept basis from which the method's bases with at most `modes` modes
   can be made; if there is none, make it. If that fails, or if bases with fewer
   modes cannot be made from it, the family is exact. */
static ritz_status find_wide(ritz_fitter *f, const ritz_method *method,
                             int64_t k, int64_t modes, ritz_fit_family **out)
{
    ritz_fit_family *family = NULL;

    RITZ_CHECK(find_family(f, method->wide, k, &family));
    if (!family->exact && !can_serve(family, modes)) {
        const ritz_status status = renew_family(f, modes, family);

        if (status == RITZ_ERR_MEMORY)
            return status;
        family->exact = family->exact || status != RITZ_OK;
    }
    family->used = ++f->num_uses;
    *out = family;
    return RITZ_OK;
}

/*
 * Reduce body k by a method whose basis can be made from a kept one with more
 * modes. If it cannot, because residual modes depend on others, @p out stays
 * empty and the family is exact from now on.
 */
static ritz_status take_narrow(ritz_fitter *f, const ritz_request *request,
                               const ritz_method *method, int64_t k,
                               bool with_T, ritz_reduced *out,
                               ritz_dense *parts)
{
    ritz_fit_family *family = NULL;
    RITZ_OWN(ritz_dense) V = {0};
    RITZ_OWN(ritz_columns) columns = {0};
    RITZ_OWN_ARRAY int64_t *at = NULL;
    int64_t count = 0;

    RITZ_CHECK(find_wide(f, method, k, request->modes, &family));
    if (family->exact)
        return RITZ_OK;
    RITZ_CHECK_NEW(at, family->whole.columns.count);
    count = choose_columns(&family->whole.columns, request->modes, at);
    RITZ_CHECK(method->narrow(&family->whole, count, at, request->tolerance, &V,
                              &columns));
    family->exact = V.ncol == 0;
    if (family->exact)
        return RITZ_OK;
    RITZ_CHECK(combine_columns(family, &V, with_T, out, parts));
    ritz_columns_free(&out->columns);
    RITZ_MOVE(out->columns, columns);
    (void)snprintf(out->origin.method, RITZ_NAME_SIZE, "%s", method->name);
    (void)snprintf(out->origin.reference, RITZ_NAME_SIZE, "%s",
                   method->reference);
    return RITZ_OK;
}

/* Reduce body k by columns of the method's own kept basis. */
static ritz_status take_own(ritz_fitter *f, const ritz_method *method,
                            int64_t k, int64_t modes, bool with_T,
                            ritz_reduced *out, ritz_dense *parts)
{
    RITZ_OWN_ARRAY int64_t *at = NULL;
    ritz_fit_family *family = NULL;
    int64_t count = 0;

    RITZ_CHECK(find_family(f, method, k, &family));
    if (!can_serve(family, modes))
        RITZ_CHECK(renew_family(f, modes, family));
    family->used = ++f->num_uses;
    RITZ_CHECK_NEW(at, family->whole.columns.count);
    count = choose_columns(&family->whole.columns,
                           family->exact ? INT64_MAX : modes, at);
    if (count == 0) /* the method may refuse that, and says why */
        return make_whole(f, family, modes, out, parts);
    return take_columns(family, count, at, with_T, out, parts);
}

/* Reduce body k by the basis that is kept of it, or of another method's. */
static ritz_status take_kept(ritz_fitter *f, const ritz_method *method,
                             int64_t k, int64_t modes, bool with_T,
                             ritz_reduced *out, ritz_dense *parts)
{
    RITZ_OWN(ritz_body_request) own = {0};
    ritz_request *request = &own.asked;

    RITZ_CHECK(request_basis(f, method, k, modes, &own));
    if (is_shared(method) && method->uses & RITZ_USES_COUNT) {
        request->choice.uncounted = true;
        request->choice.given |= RITZ_USES_COUNT;
    }
    if (method->narrow)
        RITZ_CHECK(take_narrow(f, request, method, k, with_T, out, parts));
    if (out->K.ncol == 0)
        RITZ_CHECK(take_own(f, method, k, modes, with_T, out, parts));
    ritz_request_print(request, out->origin.options);
    return RITZ_OK;
}

ritz_status ritz_fit_take(ritz_fitter *f, const ritz_method *method, int64_t k,
                          int64_t modes, bool with_T, ritz_reduced *out,
                          ritz_dense *parts)
{
    ritz_status status = RITZ_OK;

    if (f->scene && !is_shared(method))
        return ritz_fit_body(f, method, k, modes, out);
    status = take_kept(f, method, k, modes, with_T, out, parts);
    return f->scene ? ritz_context(status, ritz_fitter_body(f, k)) : status;
}
