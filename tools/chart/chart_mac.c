/*
 * How like the modes of two models are: at the dofs that both have; of two
 * configurations of the same bodies by their masses, if these are named; of
 * anything else with a system by what inputs drive and outputs see.
 */
#include "chart/chart_mac.h"
#include "chart/html.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_FILES = 70 };

/* What is compared, and by which bodies. */
typedef struct choice {
    mac_side side[2];
    int64_t num_bodies;
    const chart_file *body[MOST_FILES];
} choice;

static ritz_status find_at(const chart_file *file, const char *at,
                           mac_side *out)
{
    ritz_status status = RITZ_OK;
    const ritz_configuration *found = NULL;

    *out = (mac_side){.file = file};
    if (file->holds == CHART_SYSTEM)
        status = ritz_system_find(&file->model.system, at, &found);
    out->at = found;
    return ritz_context(status, file->path);
}

/* Two systems at what --at says once or of each. */
static ritz_status choose_two(const chart_file *const *system,
                              const cli_list *at, choice *out)
{
    for (int k = 0; k < 2; k++)
        RITZ_CHECK(find_at(system[k],
                           at->count == 0   ? NULL
                           : at->count == 1 ? at->text[0]
                                            : at->text[k],
                           &out->side[k]));
    return RITZ_OK;
}

/* One system: two configurations of it, or one and another model. */
static ritz_status choose_one(const chart_file *system, const cli_list *at,
                              choice *out)
{
    const ritz_system *s = &system->model.system;

    if (at->count == 2) {
        for (int k = 0; k < 2; k++)
            RITZ_CHECK(find_at(system, at->text[k], &out->side[k]));
    } else if (out->num_bodies == 1) {
        RITZ_CHECK(
            find_at(system, at->count ? at->text[0] : NULL, &out->side[0]));
        RITZ_CHECK(find_at(out->body[0], NULL, &out->side[1]));
        out->num_bodies = 0;
    } else {
        RITZ_REFUSE_IF(
            at->count == 1 || s->num_configurations != 2, RITZ_ERR_ARGUMENT,
            "MAC is of two: choose two configurations of '%s' by --at "
            "and --at again",
            system->path);
        out->side[0] = (mac_side){system, &s->configuration[0]};
        out->side[1] = (mac_side){system, &s->configuration[1]};
    }
    return RITZ_OK;
}

static ritz_status choose(const chart_sources *sources, const cli_list *at,
                          choice *out)
{
    const chart_file *system[2] = {NULL, NULL};
    int64_t num_systems = 0;

    for (int64_t k = 0; k < sources->count; k++) {
        const chart_file *file = &sources->file[k];

        if (file->holds != CHART_MODES && file->holds != CHART_SYSTEM)
            continue;
        RITZ_REFUSE_IF(
            file->holds == CHART_SYSTEM ? num_systems == 2
                                        : out->num_bodies == MOST_FILES,
            RITZ_ERR_ARGUMENT, "MAC is of two models, these are more");
        if (file->holds == CHART_SYSTEM)
            system[num_systems++] = file;
        else
            out->body[out->num_bodies++] = file;
    }
    RITZ_REFUSE_IF(at->count > 2, RITZ_ERR_ARGUMENT,
                   "MAC is of two: --at is there more than twice");
    if (num_systems == 2)
        return choose_two(system, at, out);
    if (num_systems == 1)
        return choose_one(system[0], at, out);
    RITZ_REFUSE_IF(at->count > 0, RITZ_ERR_ARGUMENT,
                   "no file is a system, --at has nothing to choose from");
    RITZ_REFUSE_IF(out->num_bodies != 2, RITZ_ERR_ARGUMENT,
                   "MAC is of two models, %s",
                   out->num_bodies < 2 ? "this is one" : "these are more");
    for (int k = 0; k < 2; k++)
        out->side[k] = (mac_side){.file = out->body[k]};
    out->num_bodies = 0;
    return RITZ_OK;
}

static ritz_status shapes_of(const choice *chosen, const char **how,
                             mac_shapes set[2])
{
    const bool systems = chosen->side[0].at || chosen->side[1].at;

    *how = chosen->num_bodies > 0 ? "by masses"
           : systems              ? "by inputs and outputs"
                                  : "by dofs";
    for (int64_t k = 0; k < chosen->num_bodies; k++)
        RITZ_REFUSE_IF(chosen->body[k]->model.kind != MODEL_REDUCED,
                       RITZ_ERR_ARGUMENT,
                       "'%s' is no reduced component, of which systems are "
                       "assembled",
                       chosen->body[k]->path);
    for (int k = 0; k < 2; k++)
        if (chosen->num_bodies > 0)
            RITZ_CHECK(mac_shapes_of_bodies(
                &chosen->side[k], chosen->num_bodies, chosen->body, &set[k]));
        else if (systems)
            RITZ_CHECK(mac_shapes_of_channels(&chosen->side[k], &set[k]));
        else
            RITZ_CHECK(mac_shapes_of_dofs(&chosen->side[k], &set[k]));
    return RITZ_OK;
}

/* --- the picture ---------------------------------------------------------- */

/* Cells have numbers in them up to so many modes. */
enum { NUMBERED = 24 };

static void say_mode(const mac_shapes *s, int64_t k, char out[32])
{
    if (isnan(s->hertz[k]))
        snprintf(out, 32, "%lld", (long long)k + 1);
    else
        snprintf(out, 32, "%lld: %.3g", (long long)k + 1, s->hertz[k]);
}

/* Names of modes, as an array of the template. */
static ritz_status give_modes(picture *p, const char *name, const mac_shapes *s)
{
    enum { SIZE = 32 };
    char(*word)[SIZE] = calloc((size_t)s->count + 1, SIZE);

    RITZ_REFUSE_IF(!word, RITZ_ERR_MEMORY, "no memory for a chart");
    for (int64_t k = 0; k < s->count; k++)
        say_mode(s, k, word[k]);
    picture_give_texts(p, name, s->count, word[0], SIZE);
    return RITZ_OK;
}

static void put_data(const mac_shapes *a, const mac_shapes *b,
                     const int64_t *row, picture *p)
{
    FILE *data = p->data.file, *table = p->table.file;
    char x[32], y[32];

    fprintf(data, "column\trow\tmac\ttip\n");
    html_line(table, a->name);
    for (int64_t j = 0; j < b->count; j++) {
        say_mode(b, j, x);
        fprintf(table, "\t%s", x);
    }
    for (int64_t i = 0; i < a->count; i++) {
        say_mode(a, i, y);
        fprintf(table, "\n%s", y);
        for (int64_t j = 0; j < b->count; j++) {
            double mac = mac_of(a, b, row, i, j);

            say_mode(b, j, x);
            fprintf(data, "%lld\t%lld\t%.6g\t", (long long)j, (long long)i,
                    mac);
            picture_tip(p, "%.60s %s Hz\n%.60s %s Hz\nMAC %.4f", a->name, y,
                        b->name, x, mac);
            fprintf(data, "\n");
            fprintf(table, "\t%.4f", mac);
        }
        fprintf(data, "\n");
    }
    fprintf(table, "\n");
}

static ritz_status draw_mac(const mac_shapes *a, const mac_shapes *b,
                            const int64_t *row, const char *how, picture *p)
{
    enum { LEFT = 116, RIGHT = 64, HEAD = 40, FOOT = 100, LETTER = 8 };
    const int64_t most = a->count > b->count ? a->count : b->count;
    const double cell = most <= NUMBERED ? 34.0 : 640.0 / (double)most;
    char title[4 * PICTURE_WORD];
    size_t letters =
        (size_t)snprintf(title, sizeof title, "MAC of %.160s and %.160s, %s",
                         a->name, b->name, how);

    p->wide = fmax(LEFT + RIGHT + cell * (double)b->count,
                   (double)(LEFT + LETTER * letters));
    p->body = HEAD + FOOT + cell * (double)a->count;
    /* as many modes can be told apart as there are inputs and outputs */
    if (a->num_seen > 0 && (a->num_seen < a->count || a->num_seen < b->count))
        snprintf(p->note, sizeof p->note,
                 "%lld inputs and outputs tell no more modes apart than that: "
                 "likeness can be chance",
                 (long long)a->num_seen);
    fprintf(p->given.file,
            "across = %lld\ndown = %lld\ncell = %.6g\nleft = %d\n"
            "numbered = %d\n",
            (long long)b->count, (long long)a->count, cell, (int)LEFT,
            most <= NUMBERED);
    picture_give_text(p, "head", title);
    picture_give_text(p, "xlabel", b->name);
    picture_give_text(p, "ylabel", a->name);
    RITZ_CHECK(give_modes(p, "column_name", b));
    RITZ_CHECK(give_modes(p, "row_name", a));
    put_data(a, b, row, p);
    return picture_draw(p, "mac.gp", title,
                        "likeness of mode shapes: 1 the same, 0 nothing in "
                        "common");
}

ritz_status chart_mac(const chart_sources *sources, const chart_wish *wish,
                      picture *out)
{
    ritz_status status = RITZ_OK;
    choice chosen = {.num_bodies = 0};
    mac_shapes set[2] = {{.count = 0}};
    const char *how = "";
    int64_t *row = NULL;

    RITZ_TRY(choose(sources, &wish->at, &chosen));
    RITZ_TRY(shapes_of(&chosen, &how, set));
    RITZ_TRY(mac_match(&set[0], &set[1], &row));
    RITZ_TRY(picture_new(wish->path, wish->keep, out));
    RITZ_TRY(draw_mac(&set[0], &set[1], row, how, out));
done:
    free(row);
    mac_shapes_free(&set[0]);
    mac_shapes_free(&set[1]);
    return status;
}
