/*
 * The files of a deck, itself and those that it includes, gone through line by
 * line. What a deck may include is limited, since it may come from a stranger.
 */
#ifndef RITZ_FORMATS_DECK_FILES_H
#define RITZ_FORMATS_DECK_FILES_H

#include "formats/decimal.h"

#include <ritz/parts.h>

#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>

enum {
    RITZ_DECK_REPEATED = 16,  /* times that a deck may include a file */
    RITZ_DECK_DEEPEST = 16,   /* files that include each other */
    RITZ_DECK_LONGEST = 4096, /* bytes of the name of an included file */
    RITZ_DECK_PLACE_SIZE = RITZ_DECK_LONGEST + 40,
};

typedef struct ritz_deck_file {
    char *path;
    char *text; /* NULL if borrowed, from an earlier inclusion too */
    bool known; /* device and inode are known */
    /* outside of the deck's folder: sentences do not quote it */
    bool outside;
    uint64_t device; /* device and inode are the same under all names */
    uint64_t inode;
} ritz_deck_file;

typedef struct ritz_deck_files {
    int64_t count, room;
    ritz_deck_file *file; /* the deck itself first */
} ritz_deck_files;

/* A file that is being gone through. */
typedef struct ritz_deck_text {
    ritz_lines text;
    int64_t file;
    char *folder; /* to which its INCLUDEs are relative; NULL: not followed */
} ritz_deck_text;

/* The file that is read, on top of those whose INCLUDE led to it. */
typedef struct ritz_deck_reading {
    ritz_deck_files *files; /* borrowed */
    const char *home;       /* folder of the deck, borrowed; NULL: INCLUDE is
                               not followed */
    int depth;
    ritz_deck_text open[RITZ_DECK_DEEPEST + 1];
} ritz_deck_reading;

/** Lines of a text. A byte order mark, with which some editors begin UTF-8, is
 * skipped. */
ritz_lines ritz_deck_lines(const char *text, int64_t size);

/**
 * Begin with the deck itself.
 *
 * @param[in] path    for messages; NULL: they begin with the line
 * @param[in] text    borrowed as long as the files live
 * @param[in] folder  to which INCLUDE is relative; NULL: it is not followed
 * @param[in,out] reading  its `files` are set
 */
ritz_status ritz_deck_begin(ritz_deck_reading *reading, const char *path,
                            const char *text, int64_t size, const char *folder);

/** The file that is read; NULL after the end of the last one. */
ritz_deck_text *ritz_deck_top(ritz_deck_reading *reading);

/** Take the next line of the file that is read, or else of the one that
 * included it. @return false at the end of all */
bool ritz_deck_next_line(ritz_deck_reading *reading);

/**
 * Continue with the included file @p name, which is relative to the folder of
 * the file that is read; that folder is there. A file that is included again is
 * not read again.
 *
 * @return RITZ_ERR_FORMAT if INCLUDE goes in a circle or too deep, or names a
 *         file more than RITZ_DECK_REPEATED times; RITZ_ERR_FILE if the file is
 *         missing, or is a folder, a device or a pipe
 */
ritz_status ritz_deck_include(ritz_deck_reading *reading, const char *name);

/** "'deck.bdf', line 12", of the line that was taken last; returns @p text. */
const char *ritz_deck_place(ritz_deck_reading *reading,
                            char text[static RITZ_DECK_PLACE_SIZE]);

/** Fail with RITZ_ERR_FORMAT, and with file and line before the sentence.
 * Quotes from a file outside of the deck's folder are left out: they could show
 * the author of a deck what only the user of Ritz may read. */
[[gnu::format(printf, 4, 0)]] ritz_status
ritz_deck_refuse(const ritz_deck_files *files, int64_t file, int64_t line,
                 const char *format, va_list args);

/** Copy the paths of all files; NULL is the path of a deck without one. The
 * caller frees *out, of which *count are there after a failure too. */
ritz_status ritz_deck_paths(const ritz_deck_files *files, int64_t *count,
                            char ***out);

/** List dofs in the order of grids and directions: grid k has a dof in
 * direction c (1 to 6) if bit c of mask[k] is set. The caller frees *out. */
ritz_status ritz_deck_list_dofs(const ritz_grids *grids, const uint8_t *mask,
                                int64_t *count, ritz_dof **out);

/** Copy the sentence of the latest failure, for an error that matters only if a
 * later step needs what is missing. */
ritz_status ritz_deck_keep_sentence(char **out);

void ritz_deck_reading_free(ritz_deck_reading *reading);
void ritz_deck_files_free(ritz_deck_files *files);

#endif
