/*
 * Claims: published numbers, the commands that state them, and how closely.
 * docs/claims.md has the words of the file.
 */
#ifndef RITZ_TOOLS_CLAIMS_CLAIMS_H
#define RITZ_TOOLS_CLAIMS_CLAIMS_H

#include "cli/sink.h"

#include <limits.h>
#include <sys/types.h>

enum {
    CLAIMS_MOST_WORDS = 128,
    CLAIMS_MOST_ROWS = 1000000, /* grids of `rows` */
    CLAIMS_MOST_LEVELS = 2,     /* a claims file, and one that it runs */
};

/* One line of a claims file, cut into words. */
typedef struct claims_line {
    int count;
    char *word[CLAIMS_MOST_WORDS]; /* of `words` */
    cli_table words;               /* one behind the other, with NUL */
} claims_line;

/* State of a run through a claims file. */
typedef struct claims_state {
    cli_run *run;
    char bin[PATH_MAX];    /* the tools are here */
    char here[PATH_MAX];   /* the claims file is here */
    char data[PATH_MAX];   /* third-party files: $DATA */
    char folder[PATH_MAX]; /* commands run here; "": there is none */
    pid_t keeper;          /* the process that removes the folder */
    int held;              /* keeps the folder while it is open */
    const char *file;      /* of claims, and a line of it */
    int number;
    char *rest;        /* what follows that line; NULL: nothing */
    char source[256];  /* of the claims that follow */
    char command[256]; /* the last one, as written */
    bool skipping;     /* until the next 'need': a file is absent */
    char absent[256];
    int exit_code;  /* of the last command */
    json_t *answer; /* of the last command; NULL: none */
    json_t *list;   /* of all claims, for --json */
    int64_t holds, fails, skipped;
} claims_state;

/** Make the folder of the commands. It is removed after this program and all
 * its commands have ended, even by a signal. */
ritz_status claims_folder_new(claims_state *state);

/** Give the folder up, and wait until it is removed. */
void claims_folder_free(claims_state *state);

/**
 * Count a level of claims files that run others, which must not go on forever.
 * @return RITZ_ERR_FORMAT beyond CLAIMS_MOST_LEVELS
 */
ritz_status claims_level(void);

/** Run all lines of a file. @return RITZ_ERR_FORMAT if it is not understood */
ritz_status claims_file(claims_state *state, const char *path);

/** Compare the answer with "expect PATH ..." and print the result. */
ritz_status claims_expect(claims_state *state, const claims_line *line);

/** Write a text as NAME and its ending into the folder of the state. */
ritz_status claims_save(const claims_state *state, const char *name,
                        const char *ending, cli_table *table);

/**
 * "beam NAME --elements N ...": NAME.k.mtx, NAME.m.mtx, NAME.bdf and NAME.dofs
 * of a plane frame in the folder of the state.
 */
ritz_status claims_beam(claims_state *state, const claims_line *line);

#endif
