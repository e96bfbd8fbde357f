/*
 * Claims: published numbers, the commands that state them, and how closely.
 * docs/claims.md has the words of the file.
 */
#ifndef RITZ_TOOLS_CLAIMS_CLAIMS_H
#define RITZ_TOOLS_CLAIMS_CLAIMS_H

#include "cli/sink.h"

#include <limits.h>

enum { CLAIMS_MOST_WORDS = 128 };

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
    char data[PATH_MAX];   /* files of others: $DATA */
    char folder[PATH_MAX]; /* commands run here */
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

/** Run all lines of a file. @return RITZ_ERR_FORMAT if it is not understood */
ritz_status claims_file(claims_state *state, const char *path);

/** Compare the answer with "expect PATH ..." and tell. */
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
