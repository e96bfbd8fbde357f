#include "answers.h"

#include "testing.h"

#include "fit/fit_parts.h"
#include "folder.h"

#include <ritz/container.h>
#include <ritz/nested.h>
#include <ritz/synthesis.h>

#include <stdio.h>
#include <stdlib.h>

void answer_open(const char *text, const ritz_fit_request *request, answer *out)
{
    *out = (answer){.text = text};
    folder_parse(text, &out->scene);
    assert_true(out->scene.num_components <= ANSWER_BODIES);
    assert_ok(ritz_fitter_scene(&out->scene, request, &out->fitter));
}

void answer_search(const char *text, const ritz_fit_request *request,
                   answer *out)
{
    answer_open(text, request, out);
    assert_ok(ritz_fitter_search(out->fitter, &out->fit));
}

const ritz_fit_candidate *answer_chosen(const answer *a)
{
    if (a->fit.chosen < 0)
        fail_msg("%s", a->fit.why);
    return &a->fit.candidate[a->fit.chosen];
}

int64_t answer_smallest_whole(const answer *a)
{
    int64_t least = INT64_MAX;

    for (int64_t k = 0; k < a->fit.count; k++) {
        const ritz_fit_candidate *c = &a->fit.candidate[k];

        if (c->feasible && c->left_out == 0 && c->order < least)
            least = c->order;
    }
    return least;
}

void answer_system(answer *a, const ritz_fit_candidate *candidate)
{
    assert_ok(ritz_fitter_system(a->fitter, candidate, &a->body, &a->path,
                                 &a->system));
}

int64_t answer_columns(const answer *a)
{
    int64_t columns = 0;

    for (int64_t k = 0; k < a->fitter->num_bodies; k++)
        columns += a->body[a->fitter->body[k]].K.ncol;
    return columns;
}

void answer_make(const char *text, const ritz_fit_request *request,
                 const ritz_method *method, const int64_t *modes, answer *out)
{
    const ritz_stamp stamp = {.command = "test"};
    char name[96];

    answer_open(text, request, out);
    assert_ok(ritz_fitter_try(out->fitter, method, modes, &out->whole));
    answer_system(out, &out->whole);
    for (int64_t k = 0; k < out->scene.num_components; k++) {
        snprintf(name, sizeof name, "cut-%s.h5", out->scene.component[k].name);
        assert_ok(ritz_container_write_reduced(folder_path(name), &out->body[k],
                                               &stamp));
    }
}

void answer_free(answer *a)
{
    for (int64_t k = 0; a->body && k < a->scene.num_components; k++)
        ritz_reduced_free(&a->body[k]);
    free(a->body);
    ritz_fit_path_free(&a->path);
    ritz_system_free(&a->system);
    ritz_fit_candidate_free(&a->whole);
    ritz_fit_free(&a->fit);
    ritz_fitter_free(&a->fitter);
    ritz_scene_free(&a->scene);
}

/* The scene of the files, `order: N` of each where it is not 0. */
static void parse_cut(const answer *a, const int64_t *order, ritz_scene *out)
{
    char text[2048] = "scene: cut\ncomponents:\n";
    char keys[64];
    size_t used = strlen(text);

    for (int64_t k = 0; k < a->scene.num_components; k++) {
        const char *name = a->scene.component[k].name;

        keys[0] = '\0';
        if (order[k] > 0)
            snprintf(keys, sizeof keys, ", order: %d", (int)order[k]);
        used +=
            (size_t)snprintf(text + used, sizeof text - used,
                             "  %s: {model: cut-%s.h5%s}\n", name, name, keys);
        assert_true(used < sizeof text);
    }
    used += (size_t)snprintf(text + used, sizeof text - used, "%s",
                             strstr(a->text, "joints:"));
    assert_true(used < sizeof text);
    folder_parse(text, out);
}

void answer_measure(const answer *a, const int64_t *order, bool all,
                    ritz_measures *worst)
{
    ritz_scene scene = {0};
    ritz_stage stage = {0};

    parse_cut(a, order, &scene);
    assert_ok(ritz_stage_new(&scene, &stage));
    for (int64_t k = 0; k < a->fitter->num_places; k++) {
        const ritz_fit_place *place = &a->fitter->place[k];
        ritz_configuration at = {0};
        ritz_measures found = {0};

        if (!all && !place->listed)
            continue;
        assert_ok(ritz_stage_assemble(&stage, place->setting, &at));
        assert_ok(ritz_reference_measure_at(
            place->reference, &at, ritz_fitter_tolerance(a->fitter),
            all ? RITZ_AT_OTHER_POLES | RITZ_AT_RANDOM : 0, &found));
        assert_ok(ritz_fit_worst(&found, place->at, worst));
        ritz_measures_free(&found);
        ritz_configuration_free(&at);
    }
    ritz_stage_free(&stage);
    ritz_scene_free(&scene);
}

void answer_orders(const answer *a, const ritz_fit_row *row, int64_t *order)
{
    for (int64_t k = 0; k < a->scene.num_components; k++) {
        order[k] = 0;
        for (int64_t j = 0; j < a->path.num_bodies; j++)
            if (a->fitter->body[j] == k)
                order[k] = row->first[j];
    }
}

double answer_excess(const answer *a, const int64_t *order)
{
    ritz_fit_candidate judged = {0};
    double excess = 0.0;

    answer_measure(a, order, false, &judged.errors);
    ritz_fit_judge(ritz_fitter_tolerance(a->fitter), &judged);
    excess = judged.excess;
    ritz_fit_candidate_free(&judged);
    return excess;
}

void answer_turn(const answer *a, int k, int64_t from, int64_t to)
{
    const ritz_stamp stamp = {.command = "test"};
    const ritz_reduced *body = &a->body[k];
    ritz_reduced turned = {0};
    int64_t at[64];
    char name[96];

    for (int64_t j = 0; j < body->K.ncol; j++)
        at[j] = j + (j >= from && j < to);
    at[to] = from;
    assert_ok(ritz_reduced_nest(body, body->K.ncol, at, body->nested.smallest,
                                &turned));
    snprintf(name, sizeof name, "cut-%s.h5", a->scene.component[k].name);
    assert_ok(ritz_container_write_reduced(folder_path(name), &turned, &stamp));
    ritz_reduced_free(&turned);
}
