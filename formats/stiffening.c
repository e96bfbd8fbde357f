#include "formats/stiffening.h"

#include "base/alloc.h"
#include "base/text.h"
#include "base/tolerances.h"
#include "formats/sink.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const kinds[RITZ_STIFFENING_KINDS] = {
    "spin_xx", "spin_yy", "spin_zz", "spin_xy",  "spin_yz",  "spin_xz",
    "turn_x",  "turn_y",  "turn_z",  "accel_x",  "accel_y",  "accel_z",
    "force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z"};

static void ritz_stiffening_term_free(ritz_stiffening_term *term)
{
    ritz_dense_free(&term->K0);
    *term = (ritz_stiffening_term){0};
}

void ritz_stiffening_terms_free(ritz_stiffening_terms *s)
{
    RITZ_FREE_EACH(ritz_stiffening_term, s->count, s->term);
    free(s->grid);
    *s = (ritz_stiffening_terms){0};
}

void ritz_stiffening_name(const ritz_stiffening_term *term,
                          char out[RITZ_NAME_SIZE])
{
    if (term->kind < RITZ_FORCE)
        snprintf(out, RITZ_NAME_SIZE, "%s", kinds[term->kind]);
    else
        snprintf(out, RITZ_NAME_SIZE, "%s@%" PRId64, kinds[term->kind],
                 term->grid);
}

/* ---- the text ----------------------------------------------------------- */

/* "force_x@13" */
static ritz_status parse_term(const char *word, ritz_stiffening_term *out)
{
    const size_t length = strcspn(word, "@");
    char *end = NULL;
    bool has_grid = word[length] == '@';

    out->kind = 0;
    while (out->kind < RITZ_STIFFENING_KINDS &&
           (strlen(kinds[out->kind]) != length ||
            strncmp(kinds[out->kind], word, length) != 0))
        out->kind++;
    RITZ_REFUSE_IF(out->kind == RITZ_STIFFENING_KINDS, RITZ_ERR_ARGUMENT,
                   "there is no term '%s', but spin_xx to spin_xz, turn_x, "
                   "accel_x, force_x@GRID, moment_x@GRID and so on",
                   word);
    RITZ_REFUSE_IF(has_grid != (out->kind >= RITZ_FORCE), RITZ_ERR_ARGUMENT,
                   "'%s': forces and moments are of a grid, as force_x@13, "
                   "other terms are not",
                   word);
    if (!has_grid)
        return RITZ_OK;
    out->grid = strtoll(word + length + 1, &end, 10);
    RITZ_REFUSE_IF(end == word + length + 1 || *end || out->grid <= 0,
                   RITZ_ERR_ARGUMENT, "'%s' names no grid", word);
    return RITZ_OK;
}

static ritz_status find_load(const ritz_reduced *reduced, const char *name,
                             int64_t *out)
{
    const ritz_names names = {.what = "load",
                              .count = reduced->num_loads,
                              .first = (const char *)reduced->load,
                              .stride = sizeof *reduced->load};

    RITZ_REFUSE_IF(reduced->num_loads == 0, RITZ_ERR_ARGUMENT,
                   "there is no load '%s': the model has no geometric "
                   "stiffness",
                   name);
    return ritz_words_find(&names, name, out);
}

static ritz_status refuse_grid(const ritz_floating *body, int64_t grid)
{
    for (int64_t k = 0; k < body->count; k++)
        if (body->id[k] == grid)
            return RITZ_OK;
    return ritz_fail(RITZ_ERR_ARGUMENT, "there is no grid %" PRId64, grid);
}

/* Forces by inertia depend on the point that the frame turns about. */
static ritz_status refuse_origin(const ritz_floating *body,
                                 const ritz_stiffening_term *term)
{
    double size = 0.0, away = 0.0;

    for (int64_t k = 0; k < 3 * body->count; k++)
        size = fmax(size, fabs(body->position[k]));
    for (int a = 0; a < 3; a++)
        away = fmax(away, fabs(body->origin[a]));
    RITZ_REFUSE_IF(
        term->kind < RITZ_ACCEL && away > RITZ_SAME * size, RITZ_ERR_ARGUMENT,
        "loads of %s are about the basic origin, and the frame is "
        "at (%g, %g, %g): export with --frame basic",
        kinds[term->kind], body->origin[0], body->origin[1], body->origin[2]);
    return RITZ_OK;
}

/* "spin_zz=LOAD", or a load that is called as its term. */
static ritz_status add_term(const ritz_reduced *reduced,
                            const ritz_floating *body, char *word,
                            ritz_stiffening_terms *s)
{
    ritz_stiffening_term *term = &s->term[s->count];
    char *mark = strchr(word, '=');

    if (mark)
        *mark = '\0';
    RITZ_CHECK(parse_term(word, term));
    RITZ_CHECK(find_load(reduced, mark ? mark + 1 : word, &term->load));
    RITZ_CHECK(refuse_origin(body, term));
    if (term->grid > 0)
        RITZ_CHECK(refuse_grid(body, term->grid));
    for (int64_t k = 0; k < s->count; k++)
        RITZ_REFUSE_IF(s->term[k].kind == term->kind &&
                           s->term[k].grid == term->grid,
                       RITZ_ERR_ARGUMENT, "term '%s' is named twice", word);
    s->count++;
    return RITZ_OK;
}

static void note_grid(ritz_stiffening_terms *s, int64_t grid)
{
    for (int64_t k = 0; k < s->num_grids; k++)
        if (s->grid[k] == grid)
            return;
    s->grid[s->num_grids++] = grid;
}

ritz_status ritz_stiffening_terms_of(const ritz_reduced *reduced,
                                     const ritz_floating *body,
                                     const ritz_dense *U, const char *text,
                                     ritz_stiffening_terms *out)
{
    RITZ_OWN(ritz_stiffening_terms) s = {0};
    RITZ_OWN_ARRAY char *words = NULL;
    int64_t most = 1;

    if (!text)
        return RITZ_OK;
    for (const char *at = text; *at; at++)
        most += *at == ',';
    RITZ_CHECK_COPY(words, text, (int64_t)strlen(text) + 1);
    RITZ_CHECK_NEW(s.term, most);
    RITZ_CHECK_NEW(s.grid, most);
    for (char *at = words, *next = NULL; at; at = next) {
        next = strchr(at, ',');
        if (next)
            *next++ = '\0';
        RITZ_CHECK_IN("stiffening", add_term(reduced, body, at, &s));
    }
    for (int64_t k = 0; k < s.count; k++) {
        ritz_stiffening_term *term = &s.term[k];

        if (term->grid > 0)
            note_grid(&s, term->grid);
        RITZ_CHECK(
            ritz_dense_congruence(&reduced->load[term->load].KG, U, &term->K0));
    }
    RITZ_MOVE(*out, s);
    return RITZ_OK;
}

/* ---- the report --------------------------------------------------------- */

static bool is_used(const ritz_stiffening_terms *s, int64_t load)
{
    for (int64_t k = 0; k < s->count; k++)
        if (s->term[k].load == load)
            return true;
    return false;
}

ritz_status ritz_stiffening_terms_say(const ritz_reduced *reduced,
                                      const ritz_stiffening_terms *s,
                                      ritz_export_report *report)
{
    for (int64_t k = 0; k < s->count; k++) {
        char name[RITZ_NAME_SIZE];

        ritz_stiffening_name(&s->term[k], name);
        RITZ_CHECK(ritz_export_say(
            report, "stiffening %s: geometric stiffness of load '%s'", name,
            reduced->load[s->term[k].load].name));
    }
    for (int64_t k = 0; k < reduced->num_loads; k++)
        if (!is_used(s, k))
            RITZ_CHECK(ritz_export_say(
                report,
                "geometric stiffness (KG) of load '%s' is left out: name its "
                "term by --stiffening TERM=%s",
                reduced->load[k].name, reduced->load[k].name));
    return RITZ_OK;
}
