/* What OUTPUT4 is written with, as text or as bytes. */
#ifndef RITZ_FORMATS_OUTPUT4_PUT_H
#define RITZ_FORMATS_OUTPUT4_PUT_H

#include <ritz/foreign.h>

#include <stdio.h>

enum {
    RITZ_OUTPUT4_MOST_8 = 99999999, /* in eight letters */
    RITZ_OUTPUT4_LINE = 80,
};

/* A file, and the matrix that is being written to it. */
typedef struct ritz_output4_writer {
    FILE *file;
    const ritz_matrix *matrix;
    ritz_output4_style style;
    int64_t numbers; /* per value: 1 real, 2 complex */
    int width;       /* of a number in text */
    int integer;     /* of an integer */
    int64_t placed;  /* numbers on the present line */
} ritz_output4_writer;

/** Integers, which are a line of their own in text. */
void ritz_output4_put_integers(const ritz_output4_writer *w, int64_t count,
                               const int64_t *n);

void ritz_output4_put_number(ritz_output4_writer *w, double number);

/** The value of entry @p p, or zero if it is -1. */
void ritz_output4_put_value(ritz_output4_writer *w, int64_t p);

void ritz_output4_end_line(ritz_output4_writer *w);

/** The length in front of and behind a record of bytes. */
void ritz_output4_put_mark(const ritz_output4_writer *w, int64_t bytes);

void ritz_output4_put_header(const ritz_output4_writer *w);

#endif
