/*
 * What the kinds of container have in common: docs/container.md says where each
 * member lies. Functions that read `find` what is there, and refuse what does
 * not fit; `at` is the file or a group in it.
 */
#ifndef RITZ_CONTAINER_CONTAINER_PARTS_H
#define RITZ_CONTAINER_CONTAINER_PARTS_H

#include "base/draft.h"
#include "container/h5.h"

#include <ritz/container.h>

typedef char ritz_name[RITZ_NAME_SIZE];

/* A container being written, under a name of its own until it is complete. */
typedef struct ritz_writer {
    hid_t file;
    ritz_draft draft;
} ritz_writer;

ritz_status ritz_writer_new(const char *path, const char *kind,
                            const char *units, const ritz_stamp *stamp,
                            ritz_writer *out);
ritz_status ritz_writer_finish(ritz_writer *writer);
void ritz_writer_free(ritz_writer *writer);

/** Open a container that must be of this kind. */
ritz_status ritz_part_open(const char *path, const char *kind, hid_t *out);

/* A text of an object that is an attribute of the same name. */
typedef struct ritz_text_member {
    const char *name;
    size_t offset; /* of a char[RITZ_NAME_SIZE] in the object */
} ritz_text_member;

/** Tables of these end in a member without a name. */
ritz_status ritz_part_set_members(hid_t at, const ritz_text_member *member,
                                  const void *object);
ritz_status ritz_part_get_members(hid_t at, const ritz_text_member *member,
                                  void *object);

/** One number or a few, as an attribute. */
ritz_status ritz_part_set_whole(hid_t at, const char *name, int64_t value);
ritz_status ritz_part_get_whole(hid_t at, const char *name, int64_t *out);
ritz_status ritz_part_set_real(hid_t at, const char *name, int64_t count,
                               const double *values);
ritz_status ritz_part_get_real(hid_t at, const char *name, bool nan_allowed,
                               int64_t count, double *out);

/** A number of which there must not be less than @p least. */
ritz_status ritz_part_get_size(hid_t at, const char *name, int64_t least,
                               int64_t most, int64_t *out);

/** Names, which must be distinct; each can be the name of a link. */
ritz_status ritz_part_write_names(hid_t at, const char *name, int64_t count,
                                  const ritz_name *names);
ritz_status ritz_part_read_names(hid_t at, const char *name, int64_t count,
                                 ritz_name *out);

/** The same in a group of its own, `inputs` or `outputs`; count as found. */
ritz_status ritz_part_write_group_names(hid_t at, const char *name,
                                        int64_t count, const ritz_name *names);
ritz_status ritz_part_read_group_names(hid_t at, const char *name,
                                       int64_t *count, ritz_name **out);

/** Texts that need not be distinct and may be empty. */
ritz_status ritz_part_write_words(hid_t at, const char *name, int64_t count,
                                  const ritz_name *words);
ritz_status ritz_part_read_words(hid_t at, const char *name, int64_t count,
                                 ritz_name *out);

/** Whole numbers that must lie in @p least .. @p most. */
ritz_status ritz_part_read_whole(hid_t at, const char *name, int64_t count,
                                 int64_t least, int64_t most, int64_t *out);

/** `grid` and `component` of rows; `count` as found. */
ritz_status ritz_part_write_labels(hid_t at, int64_t count,
                                   const ritz_dof *dof);
ritz_status ritz_part_read_labels(hid_t at, int64_t *count, ritz_dof **out);

/** The same in a group `dofs`. */
ritz_status ritz_part_write_dofs(hid_t at, int64_t count, const ritz_dof *dof);
ritz_status ritz_part_read_dofs(hid_t at, int64_t *count, ritz_dof **out);

/** Group `grids`; none is an empty object. */
ritz_status ritz_part_write_grids(hid_t at, const ritz_grids *grids);
ritz_status ritz_part_read_grids(hid_t at, ritz_grids *out);

/** Group `elements`, of grids that are there; none if empty. */
ritz_status ritz_part_write_elements(hid_t at, const ritz_elements *elements);
ritz_status ritz_part_read_elements(hid_t at, const ritz_grids *grids,
                                    ritz_elements *out);

/** Groups `inputs` and `outputs` for @p n coordinates; none if empty. */
ritz_status ritz_part_write_io(hid_t at, const ritz_io *io);
ritz_status ritz_part_read_io(hid_t at, int64_t n, ritz_io *out);

/** Group `dampers` for @p n coordinates; none if empty. */
ritz_status ritz_part_write_dampers(hid_t at, const ritz_dampers *dampers);
ritz_status ritz_part_read_dampers(hid_t at, int64_t n, ritz_dampers *out);

/** Group `recovery` for the @p n dofs of a full model; none if empty. */
ritz_status ritz_part_write_recovery(hid_t at, const ritz_recovery *recovery);
ritz_status ritz_part_read_recovery(hid_t at, int64_t n, const ritz_dof *dof,
                                    ritz_recovery *out);

/** Group `columns` and data set `residuals`, for @p n full dofs. */
ritz_status ritz_part_write_columns(hid_t at, const ritz_columns *columns);
ritz_status ritz_part_read_columns(hid_t at, int64_t n, int64_t r,
                                   ritz_columns *out);

/** How a basis was made, as attributes. */
ritz_status ritz_part_set_origin(hid_t at, const ritz_origin *origin);
ritz_status ritz_part_get_origin(hid_t at, ritz_origin *out);

/** Group of measures called @p name; none if empty. */
ritz_status ritz_part_write_measures(hid_t at, const char *name,
                                     const ritz_measures *measures);
ritz_status ritz_part_read_measures(hid_t at, const char *name,
                                    ritz_measures *out);

/** Group `nested` of @p r columns; none if it is not nested. */
ritz_status ritz_part_write_nested(hid_t at, const ritz_nested *nested);
ritz_status ritz_part_read_nested(hid_t at, int64_t r, ritz_nested *out);

/** Place of a port: attributes `origin` and `axes`. */
ritz_status ritz_part_set_place(hid_t at, const double origin[static 3],
                                const double axes[static 9]);
ritz_status ritz_part_get_place(hid_t at, double origin[static 3],
                                double axes[static 9]);

/** A matrix that may be absent: {0}. */
ritz_status ritz_part_write_dense(hid_t at, const char *name,
                                  const ritz_dense *A);
ritz_status ritz_part_read_dense(hid_t at, const char *name, int64_t n,
                                 int64_t m, ritz_dense *out);

#endif
