/*
 * Choice of places for dampers by pruning [ChuMilman1992, section 4]: each
 * candidate is tuned by itself, and all combinations of the best ones are
 * tuned.
 */
#include "base/alloc.h"
#include "base/search.h"
#include "base/tolerances.h"
#include "poles/h2.h"

#include <ritz/base.h>

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Largest number of combinations; candidates to combine in addition to the
   number of places, by default; number of next best combinations reported;
   evaluations of a search; starts for a single candidate, and for a
   combination. */
enum { MOST_CHOICES = 100000, MORE = 5, NEXT = 5, EVALUATIONS = 300 };
enum { STARTS_ALONE = 2, STARTS_TOGETHER = 1 };

/* Binomial coefficient n over k. */
static double count_choices(int64_t n, int64_t k)
{
    double product = 1.0;

    for (int64_t i = 0; i < k; i++)
        product *= (double)(n - i) / (double)(i + 1);
    return round(product);
}

/* Number of candidates of which combinations are formed. */
static int64_t count_among(const ritz_placing_request *request)
{
    int64_t among =
        request->among > 0 ? request->among : request->places + MORE;

    return among < request->tuning.count ? among : request->tuning.count;
}

/* The model without any candidate, and the space that plants are made from. */
typedef struct field {
    const ritz_placing_request *request;
    ritz_component component; /* the model's component with `dampers` in place
                                 of its own; borrows the rest */
    ritz_dampers dampers;
    ritz_model bare;
    ritz_static_space space;
    bool in_space;
    bool *used; /* work space, an entry for each damper */
} field;

static void field_free(field *f)
{
    ritz_dampers_free(&f->dampers);
    ritz_static_space_free(&f->space);
    free(f->used);
}

static ritz_status field_new(const ritz_placing_request *request, field *f)
{
    const ritz_tuning_request *tuning = &request->tuning;
    int64_t modes = ritz_tuning_modes(tuning);
    bool component = tuning->model.kind == RITZ_MODEL_COMPONENT;

    f->request = request;
    f->bare = tuning->model;
    RITZ_CHECK(ritz_dampers_copy(component ? &tuning->model.component->dampers
                                           : tuning->model.dampers,
                                 &f->dampers));
    for (int64_t g = 0; g < tuning->count; g++)
        for (int64_t j = 0; j < tuning->tuned[g].count; j++) {
            f->dampers.c[tuning->tuned[g].damper[j]] = 0.0;
            f->dampers.k[tuning->tuned[g].damper[j]] = 0.0;
        }
    if (component) {
        f->component = *tuning->model.component;
        f->component.dampers = f->dampers;
        f->bare.component = &f->component;
    }
    f->bare.dampers = &f->dampers;
    RITZ_CHECK_NEW(f->used, f->dampers.count);
    f->in_space = ritz_tuned_in_space(tuning, modes);
    if (f->in_space)
        RITZ_CHECK(
            ritz_static_space_new(f->bare, modes, &tuning->noise, &f->space));
    return RITZ_OK;
}

/* The plant of a combination of candidates. */
static ritz_status make_plant(field *f, int64_t count, const ritz_tuned *tuned,
                              ritz_plant *out)
{
    const ritz_tuning_request some = {
        .model = f->bare, .count = count, .tuned = tuned};

    if (!f->in_space)
        return ritz_plant_new(f->bare, &f->request->tuning.noise, out);
    ritz_tuning_uses(&some, f->used);
    return ritz_static_space_plant(&f->space, f->used, out);
}

/* Tune a combination; its norm is HUGE_VAL if it is infinite. */
static ritz_status tune_choice(field *f, const ritz_tuning_search *search,
                               ritz_tuning *out)
{
    RITZ_OWN(ritz_plant) plant = {0};

    RITZ_CHECK(make_plant(f, search->count, search->tuned, &plant));
    return ritz_tune_plant(&plant, search, out);
}

static ritz_status tune_alone(field *f, ritz_placing *out)
{
    const ritz_tuning_request *tuning = &f->request->tuning;

    for (int64_t g = 0; g < out->count; g++) {
        const ritz_tuning_search search = {
            .count = 1,
            .tuned = &tuning->tuned[g],
            .starts = STARTS_ALONE,
            .most = tuning->most > 0 ? tuning->most : EVALUATIONS};
        RITZ_OWN(ritz_tuning) found = {0};

        RITZ_CHECK(tune_choice(f, &search, &found));
        out->alone[g] = found.norm;
        out->c[g] = found.c[0];
        out->k[g] = found.k[0];
        ritz_monitor_step("places, one by one", g + 1, out->count);
    }
    return RITZ_OK;
}

/* Candidates by ascending norm of each by itself; equal ones in their order. */
static ritz_status rank_candidates(const ritz_placing *placing, int64_t **out)
{
    RITZ_OWN_ARRAY int64_t *order = NULL;

    RITZ_CHECK_NEW(order, placing->count);
    for (int64_t g = 0; g < placing->count; g++) {
        int64_t at = g;

        while (at > 0 &&
               placing->alone[order[at - 1]] > RITZ_TIE * placing->alone[g]) {
            order[at] = order[at - 1];
            at--;
        }
        order[at] = g;
    }
    RITZ_MOVE(*out, order);
    return RITZ_OK;
}

/* A combination of candidates, its norm and its values. */
typedef struct choice {
    double norm;
    int64_t *group;
    double *c, *k;
} choice;

static void choice_free(choice *one)
{
    RITZ_FREE(one->group, one->c, one->k);
    *one = (choice){0};
}

typedef struct choices {
    int64_t count; /* NEXT + 1 best combinations so far, by ascending norm */
    choice at[NEXT + 2];
} choices;

static void choices_free(choices *all)
{
    for (int64_t j = 0; j < NEXT + 2; j++)
        choice_free(&all->at[j]);
}

/* Insert a combination by its norm, and drop the last if there are too many. */
static void keep_choice(choices *all, choice *one)
{
    int64_t at = all->count++;

    while (at > 0 && all->at[at - 1].norm > RITZ_TIE * one->norm) {
        all->at[at] = all->at[at - 1];
        at--;
    }
    RITZ_MOVE(all->at[at], *one);
    if (all->count > NEXT + 1)
        choice_free(&all->at[--all->count]);
}

/* Tune one combination, with the values of each candidate by itself as an
   additional start. */
static ritz_status try_choice(field *f, const ritz_placing *placing,
                              const int64_t *order, const int64_t *at,
                              choices *all)
{
    const ritz_tuning_request *tuning = &f->request->tuning;
    int64_t places = placing->places;
    RITZ_OWN(choice) one = {0};
    RITZ_OWN(ritz_tuning) found = {0};
    RITZ_OWN_ARRAY ritz_tuned *tuned = NULL;
    RITZ_OWN_ARRAY double *c = NULL, *k = NULL;
    ritz_tuning_search search = {.count = places,
                                 .starts = STARTS_TOGETHER,
                                 .most = tuning->most > 0 ? tuning->most
                                                          : EVALUATIONS};

    RITZ_CHECK_NEW(one.group, places);
    RITZ_CHECK_NEW(tuned, places);
    RITZ_CHECK_NEW(c, places);
    RITZ_CHECK_NEW(k, places);
    for (int64_t j = 0; j < places; j++)
        one.group[j] = order[at[j]];
    qsort(one.group, (size_t)places, sizeof *one.group, ritz_ascending_index);
    for (int64_t j = 0; j < places; j++) {
        tuned[j] = tuning->tuned[one.group[j]];
        c[j] = placing->c[one.group[j]];
        k[j] = placing->k[one.group[j]];
    }
    search.tuned = tuned;
    search.c = c;
    search.k = k;
    RITZ_CHECK(tune_choice(f, &search, &found));
    one.norm = found.norm;
    RITZ_MOVE(one.c, found.c);
    RITZ_MOVE(one.k, found.k);
    keep_choice(all, &one);
    return RITZ_OK;
}

static ritz_status try_choices(field *f, ritz_placing *placing,
                               const int64_t *order, choices *all)
{
    int64_t n = placing->num_among, places = placing->places;
    RITZ_OWN_ARRAY int64_t *at = NULL;
    int64_t total = (int64_t)count_choices(n, places);

    RITZ_CHECK_NEW(at, places);
    for (int64_t j = 0; j < places; j++)
        at[j] = j;
    do {
        RITZ_CHECK(try_choice(f, placing, order, at, all));
        ritz_monitor_step("places, combined", ++placing->num_choices, total);
    } while (ritz_next_choice(n, places, at));
    return RITZ_OK;
}

/* Tune the best combination again, on the full model, and list the next
   best. */
static ritz_status settle_choice(field *f, const choices *all,
                                 ritz_placing *out)
{
    const choice *best = &all->at[0];
    ritz_tuning_request request = f->request->tuning;
    RITZ_OWN_ARRAY ritz_tuned *tuned = NULL;

    RITZ_CHECK_COPY(out->taken, best->group, out->places);
    out->num_next = all->count - 1;
    RITZ_CHECK_NEW(out->next, out->places * out->num_next);
    RITZ_CHECK_NEW(out->next_norm, out->num_next);
    for (int64_t j = 0; j < out->num_next; j++) {
        out->next_norm[j] = all->at[j + 1].norm;
        memcpy(out->next + j * out->places, all->at[j + 1].group,
               (size_t)out->places * sizeof *out->next);
    }
    RITZ_CHECK_NEW(tuned, out->places);
    for (int64_t j = 0; j < out->places; j++)
        tuned[j] = request.tuned[best->group[j]];
    request.model = f->bare;
    request.count = out->places;
    request.tuned = tuned;
    return ritz_tune_from(&request, best->c, best->k, &out->tuning);
}

static ritz_status check_places(const ritz_placing_request *request)
{
    int64_t count = request->tuning.count;
    double total = 0.0;

    RITZ_REFUSE_IF(
        request->places < 1 || request->places > count, RITZ_ERR_ARGUMENT,
        "%" PRId64 " places of %" PRId64 " candidates cannot be taken",
        request->places, count);
    RITZ_REFUSE_IF(request->among != 0 && request->among < request->places,
                   RITZ_ERR_ARGUMENT,
                   "%" PRId64 " places among the %" PRId64
                   " best candidates cannot be taken",
                   request->places, request->among);
    total = count_choices(count_among(request), request->places);
    RITZ_REFUSE_IF(!(total <= MOST_CHOICES), RITZ_ERR_ARGUMENT,
                   "%" PRId64 " places of %" PRId64
                   " candidates are %.3g combinations, which are too many: "
                   "combine fewer of the best",
                   request->places, count_among(request), total);
    return ritz_tuning_check(&request->tuning);
}

ritz_status ritz_placing_of(const ritz_placing_request *request,
                            ritz_placing *out)
{
    int64_t count = request->tuning.count;
    RITZ_OWN(field) f = {0};
    RITZ_OWN(choices) all = {0};
    RITZ_OWN(ritz_plant) none = {0};
    RITZ_OWN(ritz_placing)
    placing = {.count = count,
               .places = request->places,
               .num_among = count_among(request)};
    RITZ_OWN_ARRAY int64_t *order = NULL;

    RITZ_CHECK(check_places(request));
    RITZ_CHECK_NEW(placing.alone, count);
    RITZ_CHECK_NEW(placing.c, count);
    RITZ_CHECK_NEW(placing.k, count);
    RITZ_CHECK(field_new(request, &f));
    RITZ_CHECK(make_plant(&f, 0, NULL, &none));
    RITZ_CHECK(ritz_plant_norm(&none, &placing.none));
    RITZ_CHECK(tune_alone(&f, &placing));
    RITZ_CHECK(rank_candidates(&placing, &order));
    RITZ_CHECK(try_choices(&f, &placing, order, &all));
    RITZ_CHECK(settle_choice(&f, &all, &placing));
    RITZ_MOVE(*out, placing);
    return RITZ_OK;
}

void ritz_placing_free(ritz_placing *placing)
{
    RITZ_FREE(placing->alone, placing->c, placing->k, placing->taken,
              placing->next, placing->next_norm);
    ritz_tuning_free(&placing->tuning);
    *placing = (ritz_placing){0};
}
