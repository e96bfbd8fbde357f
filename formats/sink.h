/* Files, reports, matrices and XML that exporters share. */
#ifndef RITZ_FORMATS_SINK_H
#define RITZ_FORMATS_SINK_H

#include "base/draft.h"
#include "container/h5.h"

#include <ritz/export.h>
#include <ritz/import.h>

#include <stdio.h>

/* What puts @p what into a file. */
typedef ritz_status ritz_sink_writer(FILE *file, const void *what);
typedef ritz_status ritz_sink_h5_writer(hid_t file, const void *what);

/** Let @p write fill a draft. @return RITZ_ERR_FILE if not all of it could be
 * written; what @p write says */
ritz_status ritz_sink_fill(const ritz_draft *draft, ritz_sink_writer *write,
                           const void *what);
ritz_status ritz_sink_fill_h5(const ritz_draft *draft,
                              ritz_sink_h5_writer *write, const void *what);

/** Fill a draft of @p path, then give it its name. */
ritz_status ritz_sink_write(const char *path, ritz_sink_writer *write,
                            const void *what);

/**
 * What @p write puts into a file, in memory.
 *
 * @param[in]  name  what it is, for the sentence: "an archive"
 * @param[out] out   the caller frees it; a NUL follows its last byte
 * @param[out] size  of it without the NUL; NULL: not wanted
 * @return RITZ_ERR_MEMORY; what @p write says
 */
ritz_status ritz_sink_hold(ritz_sink_writer *write, const void *what,
                           const char *name, char **out, int64_t *size);

/** Fill a draft with OUTPUT4, as ritz_output4_write() does. */
ritz_status ritz_output4_fill(const ritz_draft *draft, int64_t count,
                              const ritz_matrix *matrix,
                              const ritz_output4_style *style);

/** Find the style of OUTPUT4 that is requested. Report it if its digits round
 * values. */
ritz_status ritz_output4_style_of(const ritz_export_request *request,
                                  ritz_export_report *report,
                                  ritz_output4_style *out);

/** Copy @p A to a sparse matrix that stores every entry, zeros too. */
ritz_status ritz_sink_store(const ritz_dense *A, ritz_sparse *out);

/** Refuse a matrix that holds a value that is not finite, naming it. */
ritz_status ritz_sink_check(const ritz_matrix *m);

/**
 * The matrices of a reduced component or state space that the request names,
 * and a line of the report for each.
 *
 * Geometric stiffness is "KG" of all loads or "KG:LOAD" of one; the matrices are
 * called KG1, KG2, ... by the number of their load.
 *
 * @param[in] usual  names with commas between, for a request that names none:
 *                   absent ones are left out; NULL: all but T, inputs, outputs
 * @return RITZ_ERR_ARGUMENT if there is no such matrix
 */
ritz_status ritz_export_matrices(const ritz_export_object *object,
                                 const ritz_export_request *request,
                                 const char *usual, ritz_export_report *report,
                                 ritz_matrices *out);

/**
 * The same for formats that hold nothing but matrices: a damping rule, such as
 * modal damping ratios, is added to D.
 */
ritz_status ritz_export_damped(const ritz_export_object *object,
                               const ritz_export_request *request,
                               const char *usual, ritz_export_report *report,
                               ritz_matrices *out);

/** Say which other matrices the object has, if the request names none.
 * @param[in] list  those that are written */
ritz_status ritz_export_say_rest(const ritz_export_object *object,
                                 const ritz_export_request *request,
                                 const ritz_matrices *list,
                                 ritz_export_report *report);

/** Refuse units other than kg, m and s. @param[in] program  its name, for the
 * sentence: "OpenFAST" */
ritz_status ritz_export_demand_si(const char *units, const char *program);

/** Put the n x n matrix @p A by rows, with 17 digits; zeros if A is {0}. */
void ritz_rows_put(FILE *file, const ritz_dense *A, int64_t n);

/* The contents of a VTK unstructured grid. */
typedef struct ritz_vtu_parts {
    const ritz_shapes *shapes;
    const char *certificate;
} ritz_vtu_parts;

/** Put a ritz_vtu_parts as a VTK unstructured grid. */
ritz_status ritz_vtu_print(FILE *file, const void *what);

/*
 * XDMF: the topology and the geometry of shapes, whose numbers are data sets
 * "cells" and "points" of an HDF5 file.
 */

/** Write the data sets "points", "grids" and "cells" of shapes. */
ritz_status ritz_xdmf_write_mesh(hid_t file, const ritz_shapes *shapes);

/** Put <Topology> and <Geometry>. @param[in] heavy  name of the HDF5 file */
void ritz_xdmf_put_mesh(FILE *file, const char *heavy,
                        const ritz_shapes *shapes);

/* An <Attribute> of XDMF. */
typedef struct ritz_xdmf_field {
    const char *name;
    const char *kind;      /* "Vector", "Scalar" */
    const char *centre;    /* "Node", "Cell" */
    const char *type;      /* "Float", "Int" */
    const char *set;       /* name of its data set */
    int64_t rows, columns; /* of the data set; 0 columns: it is a vector */
} ritz_xdmf_field;

/** Put an <Attribute> that refers to its data set in the file @p heavy. */
void ritz_xdmf_put_field(FILE *file, const char *heavy,
                         const ritz_xdmf_field *field);

/** Name the HDF5 file "shapes.xdmf.h5" after "shapes.xdmf".
 * @return RITZ_ERR_ARGUMENT if the name contains ':' */
ritz_status ritz_xdmf_name_heavy(const char *output, char **out);

/** @p text with markup as entities and control characters as '?'. */
void ritz_xml_put(FILE *file, const char *text);

/** Points, cells, shapes, and what was left out. */
ritz_status ritz_shapes_say(const ritz_shapes *shapes,
                            ritz_export_report *report);

#endif
