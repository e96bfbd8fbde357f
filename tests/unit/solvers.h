/*
 * The frames of data/nastran among the third-party files: `inboard` and
 * `outboard`, which meet at the grids 3, 11, 19 and 27, as solvers wrote them.
 */
#ifndef RITZ_TESTS_SOLVERS_H
#define RITZ_TESTS_SOLVERS_H

#include <ritz/component.h>

#define SOLVERS "public_solvers/"
#define CSUPER  "nas2cam_csuper/"

/* Files that make a component; `dofs` lies in the current folder. */
typedef struct solvers_source {
    const char *stiffness, *mass, *bulk, *dofs;
} solvers_source;

/* Inboard and outboard. */
extern const solvers_source solvers_nastran95[2], solvers_mystran[2];

/** Path of a file of data/nastran; false, and a reason printed, if nowhere. */
bool solvers_find(const char *name, char path[static 512]);

/** Component with the port 'frame' of the four grids; false if not there. */
bool solvers_import(const solvers_source *from, ritz_component *out);

/** A matrix of data/nastran, which is there. */
void solvers_read(const char *name, ritz_dense *out);

#endif
