/* A scene of the test's folder and its answer, in files to be cut in other
   scenes. */
#ifndef RITZ_TESTS_ANSWERS_H
#define RITZ_TESTS_ANSWERS_H

#include <ritz/fit.h>

enum { ANSWER_BODIES = 3 };

/* A scene that is fitted; what was not asked for is empty. */
typedef struct answer {
    const char *text;
    ritz_scene scene;
    ritz_fitter *fitter;
    ritz_fit fit;             /* of answer_search */
    ritz_fit_candidate whole; /* of answer_make, or a test's own */
    ritz_reduced *body;       /* these three of answer_system */
    ritz_fit_path path;
    ritz_system system;
} answer;

/** Read a scene and prepare it. */
void answer_open(const char *text, const ritz_fit_request *request,
                 answer *out);

/** The same, and search. */
void answer_search(const char *text, const ritz_fit_request *request,
                   answer *out);

/** What the search chose; the test fails if that is nothing. */
const ritz_fit_candidate *answer_chosen(const answer *a);

/** Order of the smallest that holds with all columns it was asked for. */
int64_t answer_smallest_whole(const answer *a);

/** Make the system of a candidate, its bodies and its path. */
void answer_system(answer *a, const ritz_fit_candidate *candidate);

/** Columns of the bodies that are flexible, together. */
int64_t answer_columns(const answer *a);

/** The system of the whole candidate; its bodies are cut-NAME.h5 in the folder.
 */
void answer_make(const char *text, const ritz_fit_request *request,
                 const ritz_method *method, const int64_t *modes, answer *out);

/**
 * A scene of those files against the full system, at listed places on the grid
 * or at all and where it is confirmed.
 *
 * @param[in] order  key `order` of each component, 0: none
 */
void answer_measure(const answer *a, const int64_t *order, bool all,
                    ritz_measures *worst);

/** How far off that is at listed places. */
double answer_excess(const answer *a, const int64_t *order);

/** A row of the path as such orders. */
void answer_orders(const answer *a, const ritz_fit_row *row, int64_t *order);

/** Write a body's file anew, with column `from` moved to the place `to`. */
void answer_turn(const answer *a, int k, int64_t from, int64_t to);

void answer_free(answer *a);

#endif
