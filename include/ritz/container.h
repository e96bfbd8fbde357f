/*
 * Where the models that a scene names come from. Assembly and reduction ask a
 * source and open no file; ritz_container_source reads containers, and a
 * program may return models from memory.
 */
#ifndef RITZ_CONTAINER_H
#define RITZ_CONTAINER_H

#include <ritz/model.h>
#include <ritz/ranking.h>
#include <ritz/recover.h>
#include <ritz/response.h>
#include <ritz/simulate.h>

#pragma GCC visibility push(default)

typedef struct ritz_source {
    void *state; /* given to each function */
    /** "component" or "reduced", what the model called @p name is. */
    ritz_status (*kind)(void *state, const char *name,
                        char kind[static RITZ_NAME_SIZE]);
    /** A full model, settled; the caller frees it. */
    ritz_status (*component)(void *state, const char *name,
                             ritz_component *out);
    /** A reduced model with all of its columns; the caller frees it. */
    ritz_status (*reduced)(void *state, const char *name, ritz_reduced *out);
} ritz_source;

/*
 * The HDF5 container in which tools hand their objects to each other: see
 * docs/container.md for what lies where.
 *
 * Reading checks before it believes: kind and format, declared sizes against
 * what is stored, indices against sizes, that values are finite. A file that is
 * written appears under its name once it is complete, or not at all; written
 * twice it has the same bytes.
 */

/*
 * HDF5 does not validate the files that it reads, and this library reads
 * containers by HDF5: a damaged or hostile file can crash the program, make
 * HDF5 loop forever, or make it allocate any amount of memory, before the
 * library can check anything. Install a guard before you read files from an
 * untrusted source.
 */

/** Examines a regular file, given as a descriptor, before HDF5 opens it; may
 * move the file offset.
 * @return RITZ_OK, or why the file is refused */
typedef ritz_status (*ritz_guard)(int file);

/**
 * Have each HDF5 file, container or MAT 7.3, examined by @p guard before it is
 * opened. The file that was examined is the one that is opened, even if its
 * name points to another file by then. The guard holds for the whole process.
 * The tools' guard has another process read the file first (tools/cli/walk.h).
 *
 * @param[in] guard  NULL: none, the initial state
 */
void ritz_container_guard(ritz_guard guard);

/**
 * Open a container now and keep it open: until ritz_container_release, the
 * functions below that get this @p path read from the open file instead of
 * opening it again. Each thread can keep one file. This only saves time.
 */
ritz_status ritz_container_keep(const char *path);
void ritz_container_release(void);

/* What every file says about how it was made. */
typedef struct ritz_stamp {
    const char *command; /* that made it */
    int64_t num_inputs;
    char *const *input; /* "SHA256  NAME", one for each file that was read */
    const char *interrupted; /* what a signal has cut short; NULL: nothing */
    /* the commands that made and measured the exported model, for certificates;
       containers do not store it; NULL: not known */
    const char *source;
    bool now; /* the file appears at once, though others are held back */
} ritz_stamp;

/* What can be said of any container without reading its matrices. */
typedef struct ritz_summary {
    char kind[RITZ_NAME_SIZE];
    char version[RITZ_NAME_SIZE];
    char units[RITZ_NAME_SIZE];
    char interrupted[4 * RITZ_NAME_SIZE]; /* as in ritz_stamp; "": nothing */
    char *command;
    int64_t num_inputs;
    char **input;
    int64_t num_loads; /* geometric stiffnesses of a component */
} ritz_summary;

/* Models by the paths of their containers. */
extern const ritz_source ritz_container_source;

/** Whether a regular file begins with the signature of HDF5, as containers do.
 * The file is not opened by HDF5, and may be damaged or no container. */
bool ritz_container_seems(const char *path);

ritz_status ritz_container_summary(const char *path, ritz_summary *out);
void ritz_summary_free(ritz_summary *summary);

/* A member that containers hold, as docs/container.md lists it. */
typedef struct ritz_container_row {
    const char *of;    /* kind or part that it belongs to: "component" */
    const char *name;  /* "inputs/B" */
    const char *type;  /* "f64"; NULL: members that several kinds share */
    const char *shape; /* "n, m"; of an object its sizes, "243, 2" */
    const char *about; /* what it means */
    const char *range; /* of whole numbers, "0..n-1"; NULL: any */
    bool optional;
    const char *with; /* name of a member that requires this optional one; NULL:
                         none */
    bool nan;         /* NaN means that there is no value */
} ritz_container_row;

/** All members of all kinds, from the tables that read and write them. */
void ritz_container_rows(void (*say)(const ritz_container_row *row, void *data),
                         void *data);

/**
 * The members that a file of an object holds, with their sizes.
 *
 * @param[in] kind    "component", ... as `ritz_kind` says
 * @param[in] object  of that kind: a ritz_component, ...; rankings: all
 */
void ritz_container_members(const char *kind, const void *object,
                            void (*say)(const ritz_container_row *row,
                                        void *data),
                            void *data);

/*
 * One pair for each kind of container, such as
 *
 *     ritz_container_read_component(path, &component)
 *     ritz_container_write_component(path, &component, &stamp)
 *
 * Reading a component settles it. A file of one ranking holds it at its root.
 */
#define RITZ_CONTAINER_PAIR(kind)                                              \
    ritz_status ritz_container_read_##kind(const char *path,                   \
                                           ritz_##kind *out);                  \
    ritz_status ritz_container_write_##kind(                                   \
        const char *path, const ritz_##kind *object, const ritz_stamp *stamp)

RITZ_CONTAINER_PAIR(component);
RITZ_CONTAINER_PAIR(basis);
RITZ_CONTAINER_PAIR(reduced);
RITZ_CONTAINER_PAIR(system);
RITZ_CONTAINER_PAIR(response);
RITZ_CONTAINER_PAIR(state_space);
RITZ_CONTAINER_PAIR(simulation);
RITZ_CONTAINER_PAIR(rankings);
RITZ_CONTAINER_PAIR(recovered);

#pragma GCC visibility pop

#endif
