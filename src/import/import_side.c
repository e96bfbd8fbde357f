/*
 * The deck and the file of names, read by another thread while the matrices are
 * read. A failure is kept with its sentence until they are needed: a file of
 * matrices that is wrong is reported first, as if all were read one after the
 * other.
 */
#include "import/import.h"

#include "base/alloc.h"
#include "base/aside.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

enum { SENTENCE = 4608 }; /* as much as ritz_error_message() has */

/* What reading a file returned. */
typedef struct side_outcome {
    ritz_status status;
    char sentence[SENTENCE];
} side_outcome;

struct ritz_side_files {
    const ritz_import_request *request;
    ritz_deck deck;
    ritz_row_names names;
    side_outcome of_deck, of_names;
    bool later; /* they are read when one of them is asked for */
    ritz_aside aside;
};

static void keep_outcome(ritz_status status, side_outcome *out)
{
    out->status = status;
    if (status != RITZ_OK)
        snprintf(out->sentence, SENTENCE, "%s", ritz_error_message());
}

static void read_files(void *task)
{
    ritz_side_files *side = task;
    const ritz_import_request *request = side->request;

    if (request->bulk)
        keep_outcome(ritz_deck_read(request->bulk, &side->deck),
                     &side->of_deck);
    if (request->dofs)
        keep_outcome(ritz_names_of_file(request->dofs, &side->names),
                     &side->of_names);
}

/* Whether a pipe or a device is to be read; it is not before it is asked for. */
static bool is_stream(const char *path)
{
    struct stat about;

    return path && stat(path, &about) == 0 && !S_ISREG(about.st_mode);
}

/* Bytes of a file; 0 if it is not a regular one. */
static int64_t measure_file(const char *path)
{
    struct stat about;

    return path && stat(path, &about) == 0 && S_ISREG(about.st_mode)
               ? about.st_size
               : 0;
}

ritz_status ritz_side_files_begin(const ritz_import_request *request,
                                  ritz_side_files **out)
{
    enum { LARGE = 1 << 16 };
    const int64_t size =
        measure_file(request->bulk) + measure_file(request->dofs);
    ritz_side_files *side = NULL;

    RITZ_CHECK_NEW(side, 1);
    side->request = request;
    side->later = is_stream(request->bulk) || is_stream(request->dofs);
    if (!side->later)
        ritz_aside_begin(read_files, side, size >= LARGE, &side->aside);
    *out = side;
    return RITZ_OK;
}

static void await_files(ritz_side_files *side)
{
    if (side->later)
        read_files(side);
    else
        ritz_aside_end(&side->aside);
    side->later = false;
}

static ritz_status tell_outcome(const side_outcome *of)
{
    if (of->status != RITZ_OK)
        ritz_record("%s", of->sentence);
    return of->status;
}

ritz_status ritz_side_files_deck(ritz_side_files *side, ritz_deck *out)
{
    await_files(side);
    RITZ_CHECK(tell_outcome(&side->of_deck));
    RITZ_MOVE(*out, side->deck);
    return RITZ_OK;
}

ritz_status ritz_side_files_names(ritz_side_files *side, ritz_row_names *out)
{
    await_files(side);
    RITZ_CHECK(tell_outcome(&side->of_names));
    RITZ_MOVE(*out, side->names);
    return RITZ_OK;
}

void ritz_side_files_end(ritz_side_files **side)
{
    if (!*side)
        return;
    ritz_aside_end(&(*side)->aside);
    ritz_deck_free(&(*side)->deck);
    ritz_row_names_free(&(*side)->names);
    free(*side);
    *side = NULL;
}
