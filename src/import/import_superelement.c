/*
 * An external superelement as NASTRAN's EXTSEOUT writes it: which of its
 * matrices make a component, and which deck names their rows.
 *
 *     part.op4   KAA MAA BAA K4XX PA ... MUG1 ... MEF1 ...      [MSC2022]
 *     part.pch   EXTRN, SPOINT, GRID, CORD2R
 *     part.asm   GRID, CORD2R, SPOINT for the model that it is joined to
 *
 * Rows of MUG1, MES1 and MEF1 are taken if the tables TUG1, TES1 and TEF1 of the
 * deck name them.
 *
 * Names differ between programs and versions: KXX or KAA, BXX1, K4XX1; of DMIG
 * in a punch file KAAX, MAAX, BAAX, K4AAX. What is not there is a matrix of one
 * zero.
 */
#include "base/alloc.h"
#include "base/text.h"

#include <ritz/import.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

enum { SUFFIX = 4 }; /* ".pch" */

/* Whether a name is that of a matrix: "K4XX1" of "K4". */
static bool is_called(const char *name, const char *letters)
{
    const size_t length = strlen(letters);
    const char *rest = name + length;

    return strncasecmp(name, letters, length) == 0 &&
           (strncasecmp(rest, "AA", 2) == 0 || strncasecmp(rest, "XX", 2) == 0);
}

/* The first matrix with such a name; NULL if there is none. */
static const ritz_listed *find_member(const ritz_listing *all,
                                      const char *letters)
{
    for (int64_t k = 0; k < all->count; k++)
        if (is_called(all->item[k].name, letters))
            return &all->item[k];
    return NULL;
}

/* Whether a matrix is one zero, which stands for a matrix that the superelement
 * does not have. */
static bool is_placeholder(const ritz_listed *item, const ritz_listed *K)
{
    return item->nrow == 1 && item->ncol == 1 && K->nrow != 1;
}

static ritz_status make_spec(const char *path, const ritz_listed *item,
                             char **out)
{
    const size_t size = strlen(path) + strlen(item->name) + 2;

    RITZ_CHECK_NEW(*out, (int64_t)size);
    snprintf(*out, size, "%s:%s", path, item->name);
    return RITZ_OK;
}

/* "MUG1 36 x 32" */
static void describe_member(const ritz_listed *item, char out[RITZ_NAME_SIZE])
{
    if (item->nrow < 0) /* DMIG does not state its size */
        snprintf(out, RITZ_NAME_SIZE, "%.24s", item->name);
    else
        snprintf(out, RITZ_NAME_SIZE, "%.16s %" PRId64 " x %" PRId64,
                 item->name, item->nrow, item->ncol);
}

/* What the tables of a deck say of rows of recovery. */
typedef struct recovery_tables {
    const char *deck;
    ritz_row_table table[RITZ_SUPERELEMENT_RECOVERIES];
} recovery_tables;

static const struct {
    const char *matrix, *kind;
} recoveries[RITZ_SUPERELEMENT_RECOVERIES] = {
    {"MUG1", "displacement"}, {"MES1", "stress"}, {"MEF1", "force"}};

static void recovery_tables_free(recovery_tables *tables)
{
    for (int k = 0; k < RITZ_SUPERELEMENT_RECOVERIES; k++)
        ritz_row_table_free(&tables->table[k]);
}

/* Whether a matrix has a row for each name, and columns as the stiffness. */
static bool is_named(const ritz_listed *item, const ritz_listed *K, int r,
                     const recovery_tables *tables)
{
    return strcasecmp(item->name, recoveries[r].matrix) == 0 &&
           tables->table[r].count > 0 && item->nrow == tables->table[r].count &&
           item->ncol == K->ncol;
}

static ritz_status read_tables(const char *deck, recovery_tables *out)
{
    RITZ_OWN_ARRAY char *text = NULL;

    out->deck = deck;
    RITZ_CHECK(ritz_text_read(deck, &text));
    for (int k = 0;
         k < RITZ_SUPERELEMENT_RECOVERIES && ritz_row_table_recognise(text);
         k++)
        RITZ_CHECK(ritz_row_table_parse(deck, text, recoveries[k].kind,
                                        &out->table[k]));
    return RITZ_OK;
}

/* "stress=FILE" */
static ritz_status make_pair(const char *name, const char *file, char **out)
{
    const size_t size = strlen(name) + strlen(file) + 2;

    RITZ_CHECK_NEW(*out, (int64_t)size);
    snprintf(*out, size, "%s=%s", name, file);
    return RITZ_OK;
}

static ritz_status take_recovery(const char *path, const ritz_listed *item,
                                 int r, const recovery_tables *tables,
                                 ritz_superelement *out)
{
    const int64_t k = out->num_recoveries++;
    RITZ_OWN_ARRAY char *spec = NULL;

    RITZ_CHECK(make_spec(path, item, &spec));
    RITZ_CHECK(make_pair(recoveries[r].kind, spec, &out->recovery[k]));
    return make_pair(recoveries[r].kind, tables->deck, &out->recovery_rows[k]);
}

/* A matrix that is none of a component: rows to recover, or another one. */
static ritz_status take_other(const char *path, const ritz_listed *item,
                              const ritz_listed *K,
                              const recovery_tables *tables,
                              ritz_superelement *out)
{
    for (int r = 0; r < RITZ_SUPERELEMENT_RECOVERIES; r++)
        if (is_named(item, K, r, tables) &&
            out->num_recoveries < RITZ_SUPERELEMENT_RECOVERIES)
            return take_recovery(path, item, r, tables, out);
    describe_member(item, out->other[out->num_others++]);
    return RITZ_OK;
}

static ritz_status take_members(const char *path, const ritz_listing *all,
                                const recovery_tables *tables,
                                ritz_superelement *out)
{
    const struct {
        const char *letters;
        char **spec;
    } part[] = {{"K", &out->stiffness},
                {"M", &out->mass},
                {"B", &out->damping},
                {"K4", &out->structural_damping}};
    const ritz_listed *K = find_member(all, "K");
    const ritz_listed *M = find_member(all, "M");

    RITZ_REFUSE_IF(!K || !M, RITZ_ERR_FORMAT,
                   "'%s' has no %s of an external superelement, %s: name "
                   "its matrices with --stiffness and --mass",
                   path, K ? "mass" : "stiffness",
                   K ? "MAA, MXX or MAAX" : "KAA, KXX or KAAX");
    RITZ_CHECK_NEW(out->other, all->count);
    for (int64_t k = 0; k < all->count; k++) {
        const ritz_listed *item = &all->item[k];
        char **into = NULL;

        if (is_placeholder(item, K))
            continue;
        for (size_t p = 0; p < sizeof part / sizeof *part; p++)
            if (is_called(item->name, part[p].letters) && !*part[p].spec)
                into = part[p].spec;
        if (into)
            RITZ_CHECK(make_spec(path, item, into));
        else
            RITZ_CHECK(take_other(path, item, K, tables, out));
    }
    return RITZ_OK;
}

/* The deck beside "part.op4": "part.pch" or "part.asm"; NULL: neither is. */
static ritz_status find_deck(const char *path, char **out)
{
    static const char *const suffix[] = {".pch", ".PCH", ".asm", ".ASM"};
    const char *point = strrchr(ritz_path_name(path), '.');
    const size_t stem = point ? (size_t)(point - path) : strlen(path);
    RITZ_OWN_ARRAY char *deck = NULL;
    struct stat about;

    RITZ_CHECK_NEW(deck, (int64_t)stem + SUFFIX + 1);
    memcpy(deck, path, stem);
    for (size_t k = 0; k < sizeof suffix / sizeof *suffix; k++) {
        memcpy(deck + stem, suffix[k], SUFFIX);
        if (strcmp(deck, path) == 0 || stat(deck, &about) != 0 ||
            !S_ISREG(about.st_mode))
            continue;
        RITZ_MOVE(*out, deck);
        return RITZ_OK;
    }
    return RITZ_OK;
}

/* The deck that is named, or DMIG itself, or what lies beside the file. */
static ritz_status choose_deck(const char *path, const char *bulk,
                               const ritz_foreign *file, char **out)
{
    const char *named = bulk ? bulk : path;

    if (!bulk && file->format != &ritz_format_dmig)
        return find_deck(path, out);
    RITZ_CHECK_COPY(*out, named, (int64_t)strlen(named) + 1);
    return RITZ_OK;
}

/* Whether a matrix may be rows to recover; DMIG does not state its size. */
static bool has_recovery(const ritz_listing *all)
{
    for (int64_t k = 0; k < all->count; k++)
        for (int r = 0; r < RITZ_SUPERELEMENT_RECOVERIES; r++)
            if (strcasecmp(all->item[k].name, recoveries[r].matrix) == 0 &&
                all->item[k].nrow > 0)
                return true;
    return false;
}

ritz_status ritz_superelement_find(const char *path, const char *bulk,
                                   ritz_superelement *out)
{
    RITZ_OWN(ritz_superelement) found = {0};
    RITZ_OWN(ritz_foreign) file = {0};
    RITZ_OWN(recovery_tables) tables = {0};

    RITZ_CHECK(ritz_foreign_open(path, &file));
    RITZ_CHECK(ritz_foreign_list(&file));
    RITZ_CHECK(choose_deck(path, bulk, &file, &found.bulk));
    if (found.bulk && has_recovery(&file.listing))
        RITZ_CHECK(read_tables(found.bulk, &tables));
    RITZ_CHECK(take_members(path, &file.listing, &tables, &found));
    RITZ_MOVE(*out, found);
    return RITZ_OK;
}

void ritz_superelement_free(ritz_superelement *found)
{
    RITZ_FREE(found->stiffness, found->mass, found->damping,
              found->structural_damping, found->bulk, found->other);
    for (int k = 0; k < RITZ_SUPERELEMENT_RECOVERIES; k++)
        RITZ_FREE(found->recovery[k], found->recovery_rows[k]);
    *found = (ritz_superelement){0};
}
