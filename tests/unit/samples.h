/*
 * One object of each kind that a container holds, with every member filled, or
 * with none of the optional ones. Numbers have no meaning but are all distinct.
 */
#ifndef RITZ_TESTS_SAMPLES_H
#define RITZ_TESTS_SAMPLES_H

#include <ritz/container.h>

#include <stdbool.h>

enum {
    SAMPLE_DOFS = 40, /* K has 118 entries: more than an object header takes */
    SAMPLE_ORDER = 9, /* a matrix of 81 values is chunked too */
};

ritz_status sample_component(bool full, ritz_component *out);
ritz_status sample_basis(ritz_basis *out);
ritz_status sample_reduced(bool full, ritz_reduced *out);
ritz_status sample_system(bool full, ritz_system *out);
ritz_status sample_response(ritz_response *out);
ritz_status sample_simulation(ritz_simulation *out);
ritz_status sample_ranking(ritz_ranking *out);
ritz_status sample_state_space(bool full, ritz_state_space *out);

/* One kind: write the sample to a file; copy what a file holds to another. */
typedef struct sample_kind {
    const char *name;
    ritz_status (*make)(const char *path, const ritz_stamp *stamp);
    ritz_status (*make_bare)(const char *path, const ritz_stamp *stamp);
    ritz_status (*copy)(const char *from, const char *to,
                        const ritz_stamp *stamp);
} sample_kind;

enum { SAMPLE_KINDS = 8 };
extern const sample_kind sample_kinds[SAMPLE_KINDS];

#endif
