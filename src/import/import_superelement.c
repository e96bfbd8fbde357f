/*
 * An external superelement as NASTRAN's EXTSEOUT writes it: which of its
 * matrices make a component, and which deck names their rows.
 *
 *     part.op4   KAA MAA BAA K4XX PA ... MUG1 ... MEF1 ...      [MSC2022]
 *     part.pch   EXTRN, SPOINT, GRID, CORD2R
 *     part.asm   GRID, CORD2R, SPOINT for the model that it is joined to
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

static ritz_status take_members(const char *path, const ritz_listing *all,
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
            describe_member(item, out->other[out->num_others++]);
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

ritz_status ritz_superelement_find(const char *path, ritz_superelement *out)
{
    RITZ_OWN(ritz_superelement) found = {0};
    RITZ_OWN(ritz_foreign) file = {0};

    RITZ_CHECK(ritz_foreign_open(path, &file));
    RITZ_CHECK(ritz_foreign_list(&file));
    RITZ_CHECK(take_members(path, &file.listing, &found));
    if (file.format == &ritz_format_dmig)
        RITZ_CHECK_COPY(found.bulk, path, (int64_t)strlen(path) + 1);
    else
        RITZ_CHECK(find_deck(path, &found.bulk));
    RITZ_MOVE(*out, found);
    return RITZ_OK;
}

void ritz_superelement_free(ritz_superelement *found)
{
    RITZ_FREE(found->stiffness, found->mass, found->damping,
              found->structural_damping, found->bulk, found->other);
    *found = (ritz_superelement){0};
}
