/*
 * Shapes: how the grids of a body move, mode by mode, for pictures. Points,
 * translations and rotations are along the axes of the basic frame.
 */
#ifndef RITZ_EXPORT_H
#define RITZ_EXPORT_H

#include <ritz/container.h>
#include <ritz/model.h>
#include <ritz/response.h>
#include <ritz/simulate.h>

#pragma GCC visibility push(default)

/* A mode, scaled to phi'M phi = 1, that a shape shows. */
typedef struct ritz_shape_mode {
    int64_t number; /* from 1, rigid ones first */
    double hertz;   /* 0 if rigid; negative where K is indefinite */
    double ratio;   /* viscous, phi'D phi / (2 w), that of stated damping
                       included; 0 where hertz is not above 0 */
} ritz_shape_mode;

enum { RITZ_FIELD_NAME_SIZE = 2 * RITZ_NAME_SIZE };

typedef struct ritz_shapes {
    int64_t num_points;  /* grids with a position and a dof */
    int64_t *id;         /* num_points, ascending */
    double *position;    /* num_points x 3 */
    ritz_elements cells; /* whose `grid` are indices of points; single points
                             if there is no element */
    bool meshed;         /* there were elements */
    int64_t count;       /* of shapes */
    char (*name)[RITZ_NAME_SIZE]; /* "mode 7, 0.1988 Hz" */
    ritz_dense u;          /* 3 num_points x count; an absent direction is 0 */
    ritz_dense turn;       /* the same of rotations; {0}: no grid has any */
    int64_t num_placeless; /* scalar points, and grids without a position */
    ritz_shape_mode *mode; /* count; NULL: columns of a basis, no modes */
    bool coupled; /* a damping matrix may couple modes, which no ratio says */
    bool structural; /* there is structural damping, which no ratio includes */
    char units[RITZ_NAME_SIZE];          /* "kg m s"; "" if not known */
    int64_t num_fields;                  /* fields with a value for each cell */
    char (*field)[RITZ_FIELD_NAME_SIZE]; /* num_fields, "stress sx" */
    double *of_cell; /* [k * cells.count + cell] in field k; NaN: no value */
} ritz_shapes;

/**
 * Modes of a reduced component as it stands, its dampers' springs installed,
 * u = T phi, with dofs that constraints eliminated.
 *
 * @param[in] list  "1-6,9" of its modes, rigid ones first; NULL: all
 * @return RITZ_ERR_ARGUMENT if it was made --without-basis, has no such mode or
 *         nothing that has a place
 */
ritz_status ritz_shapes_of_reduced(const ritz_reduced *reduced,
                                   const char *list, ritz_shapes *out);

/**
 * Modes of a system at a configuration, by its stored K and M, at the grids of
 * its placed bodies. Where two bodies use the same grid number, all grids of
 * body k (k = 0, 1, ...) are renumbered by adding k times the next power of
 * ten.
 *
 * @param[in] bodies  bodies of the system, in its order
 * @return RITZ_ERR_ARGUMENT if the system does not store where its bodies are
 *         or @p bodies are not its bodies, or as ritz_shapes_of_reduced
 */
ritz_status ritz_shapes_of_system(const ritz_system *system,
                                  const ritz_configuration *at,
                                  const ritz_reduced *const *bodies,
                                  const char *list, ritz_shapes *out);

/** Lowest modes of a component. @param[in] list  NULL: the first ten */
ritz_status ritz_shapes_of_component(const ritz_component *component,
                                     const char *list, ritz_shapes *out);

/** Columns of a basis of displacements, on the component that it is of. */
ritz_status ritz_shapes_of_basis(const ritz_basis *basis,
                                 const ritz_component *component,
                                 const char *list, ritz_shapes *out);

/** The columns of T as shapes: the motion of the points is their sum, each
 * times its reduced coordinate. @return RITZ_ERR_ARGUMENT as
 * ritz_shapes_of_reduced */
ritz_status ritz_shapes_of_motion(const ritz_reduced *reduced,
                                  ritz_shapes *out);

void ritz_shapes_free(ritz_shapes *shapes);

/*
 * The mesh of a reduced component at one time: displaced points, and cells with
 * values of quantities such as stresses. A quantity with a row for each element
 * and part ("sx") has a field of its name, which is the row of the largest
 * magnitude of each element, and a field for each part, "stress sx", if there
 * are 2 to 31 parts.
 */
typedef struct ritz_moving {
    const ritz_reduced *reduced; /* borrowed */
    ritz_shapes columns;         /* those of T */
    ritz_shapes frame;     /* the present time: one shape, and fields; borrows
                              points and cells from `columns` */
    int64_t *first, *last; /* the element of row i has the cells
                              order[first[i]] to order[last[i] - 1] */
    int64_t *order;        /* cells in the order of their elements' numbers */
    int64_t *field;        /* field of the part of each row; -1: none */
    int64_t *whole;        /* field of each quantity; -1: none */
    int64_t num_lost;      /* rows whose element has no cell */
} ritz_moving;

/** @return RITZ_ERR_ARGUMENT as ritz_shapes_of_motion */
ritz_status ritz_moving_new(const ritz_reduced *reduced, ritz_moving *out);

/** Move the points to coordinates @p q, and clear all values of cells. */
void ritz_moving_to(ritz_moving *moving, const double *q);

/** Set the values of cells in the fields of quantity @p k.
 * @param[in] y  the rows of the quantity */
void ritz_moving_paint(ritz_moving *moving, int64_t k, const double *y);

void ritz_moving_free(ritz_moving *moving);

/* A file of shapes over time that is being written. Frames are written one by
   one, and none stays in memory. */
typedef struct ritz_series {
    const struct ritz_series_format *format;
    void *own;           /* data of the format */
    char *comment;       /* certificate of the component */
    int64_t count, room; /* frames */
    double *seconds;     /* count */
} ritz_series;

typedef struct ritz_series_format {
    const char *name; /* "pvd" */
    const char *summary;
    const char *reference; /* key in docs/references.bib */
    /** Begin the files. @param[in] mesh points and cells of all frames,
     * borrowed until end() */
    ritz_status (*begin)(const char *path, const ritz_shapes *mesh,
                         ritz_series *series);
    /** Write frame series->count. @param[in] frame  one shape and its fields */
    ritz_status (*frame)(ritz_series *series, const ritz_shapes *frame);
    /** Write the list of frames, and give it the name @p path, which may differ
     * from that of begin(). */
    ritz_status (*finish)(ritz_series *series, const char *path);
    /** Free the series. Remove its frames if it was not finished. */
    void (*end)(ritz_series *series);
} ritz_series_format;

/** All formats of series, the last entry is NULL. */
extern const ritz_series_format *const ritz_series_formats[];
extern const ritz_series_format ritz_series_format_pvd;
extern const ritz_series_format ritz_series_format_xdmf;

/**
 * Begin a series, whose files carry the certificate of the component.
 *
 * @param[in]  stamp  inputs and command; NULL: not known
 * @param[out] out    freed by ritz_series_free(), after a failure too
 */
ritz_status ritz_series_begin(const ritz_series_format *format,
                              const char *path, const ritz_moving *moving,
                              const ritz_stamp *stamp, ritz_series *out);
ritz_status ritz_series_frame(ritz_series *series, double seconds,
                              const ritz_shapes *frame);
ritz_status ritz_series_finish(ritz_series *series, const char *path);
void ritz_series_free(ritz_series *series);

/* Reading of series that ritz_series_format_pvd wrote, for pictures. */

enum { RITZ_COLLECTION_NAME = 1024 };

/** Whether a text is a list of frames. */
bool ritz_collection_recognise(const char *text);

/**
 * The next frame of a list.
 *
 * @param[in,out] text  moved behind the frame
 * @param[out]    name  of its file, relative to the folder of the list
 * @return RITZ_ERR_FORMAT if the file is outside of this folder, or the frame
 *         has no time
 */
ritz_status ritz_collection_next(const char **text, double *seconds,
                                 char name[RITZ_COLLECTION_NAME], bool *more);

/** Read a frame: points, displacements, cells, and the first field of the
 * cells.
 * @return RITZ_ERR_FORMAT if it is no VTK file whose arrays are text */
ritz_status ritz_frame_parse(const char *text, ritz_shapes *out);
ritz_status ritz_frame_read(const char *path, ritz_shapes *out);

/** Write maxima over time as a table with tabs: comments with the certificate
 * of the component, then a line for each row of each quantity. */
ritz_status ritz_recovered_write(const char *path,
                                 const ritz_recovered *recovered,
                                 const ritz_reduced *reduced,
                                 const ritz_stamp *stamp);

/* From containers to files that others read: what ritz-export does. */

/* Options of an exporter; zero where not given. */
typedef struct ritz_export_request {
    const char *output;      /* path */
    const char *matrices;    /* "K,M"; NULL: all that the format takes */
    bool text, dense;        /* output4, superelement */
    bool numbered;           /* dmig: continuations have marks */
    int64_t digits;          /* text */
    const char *ports;       /* names, with commas between them, of the ports
                                that are the interface; NULL: those that were
                                attached */
    int64_t id;              /* superelement: its number, and the number of the
                                Fortran unit of its file; 0: 101 */
    const char *modes;       /* shapes: which modes, "1-6,9"; NULL: the first
                                ten of a component, all of anything else */
    const char *frame;       /* of a moving body: "basic", "centre" or a grid;
                                NULL: the usual one of the format */
    const char *reference;   /* of its modes: "none", "mean-axis" or "tangent";
                                NULL: the usual one of the format */
    const char *stiffening;  /* of a moving body: terms of geometric stiffness
                                and their loads, "spin_zz=LOAD,force_x@13=LOAD";
                                NULL: none */
    int64_t fmi;             /* fmu: version 2 or 3; 0: 3 */
    const char *runtime;     /* fmu: folder of ritz_fmu.so and its licence */
    const ritz_stamp *stamp; /* inputs and commands, for containers and
                                certificates; NULL: not known */
} ritz_export_request;

/* Lines for the user: what was written, and what was lost; one that begins with
   "warning: " is a warning. */
typedef struct ritz_export_report {
    int64_t count;
    char (*line)[256];
} ritz_export_report;

/* The object to export. One pointer is set, the others are NULL; shapes of a
   reduced component come with that component. */
typedef struct ritz_export_object {
    const ritz_reduced *reduced;
    const ritz_state_space *states;
    const ritz_response *response;
    const ritz_simulation *simulation;
    const ritz_shapes *shapes;
} ritz_export_object;

/* The objects that an exporter takes, and the fields of a request that it uses
   beside `output`, and beside `modes` of shapes; others must not be set. */
enum {
    RITZ_EXPORT_REDUCED = 1,
    RITZ_EXPORT_STATES = 2,
    RITZ_EXPORT_RESPONSE = 4,
    RITZ_EXPORT_SIMULATION = 8,
    RITZ_EXPORT_SHAPES = 16,
    RITZ_EXPORT_MATRICES = 32,
    RITZ_EXPORT_STYLE = 64,
    RITZ_EXPORT_NUMBERED = 128,
    RITZ_EXPORT_FRAME = 256,
    RITZ_EXPORT_PORTS = 512,
    RITZ_EXPORT_FMI = 1024,
    RITZ_EXPORT_ID = 2048,
    RITZ_EXPORT_ROWS = 4096,  /* rows to recover are written */
    RITZ_EXPORT_LOADS = 8192, /* no field: it writes geometric stiffness */
    RITZ_EXPORT_STIFFENING = 16384,
};

typedef struct ritz_exporter {
    const char *name;
    const char *summary;
    const char *reference;
    const char *kind; /* of what it takes: "reduced", "response", "shapes" */
    int takes;        /* RITZ_EXPORT_... */
    ritz_status (*write)(const ritz_export_object *object,
                         const ritz_export_request *request,
                         ritz_export_report *report);
} ritz_exporter;

/** All exporters, ended by NULL. */
extern const ritz_exporter *const ritz_exporters[];
extern const ritz_exporter ritz_exporter_42;
extern const ritz_exporter ritz_exporter_basilisk;
extern const ritz_exporter ritz_exporter_chrono;
extern const ritz_exporter ritz_exporter_container;
extern const ritz_exporter ritz_exporter_dmig;
extern const ritz_exporter ritz_exporter_exudyn;
extern const ritz_exporter ritz_exporter_fmu;
extern const ritz_exporter ritz_exporter_fxbody;
extern const ritz_exporter ritz_exporter_matlab;
extern const ritz_exporter ritz_exporter_matrix_market;
extern const ritz_exporter ritz_exporter_mbdyn;
extern const ritz_exporter ritz_exporter_openfast;
extern const ritz_exporter ritz_exporter_openfast_4;
extern const ritz_exporter ritz_exporter_output4;
extern const ritz_exporter ritz_exporter_sid;
extern const ritz_exporter ritz_exporter_simscape;
extern const ritz_exporter ritz_exporter_superelement;
extern const ritz_exporter ritz_exporter_tsv;
extern const ritz_exporter ritz_exporter_uff;
extern const ritz_exporter ritz_exporter_vtu;
extern const ritz_exporter ritz_exporter_xdmf;

/** Have an exporter write the object. The report names rows to recover, and
 * loads with geometric stiffness, that the format has no place for. */
ritz_status ritz_export_write(const ritz_exporter *exporter,
                              const ritz_export_object *object,
                              const ritz_export_request *request,
                              ritz_export_report *report);

/** @return RITZ_ERR_ARGUMENT if something is asked that the format has not */
ritz_status ritz_export_check(const ritz_exporter *exporter,
                              const ritz_export_request *request);

[[gnu::format(printf, 2, 3)]] ritz_status
ritz_export_say(ritz_export_report *report, const char *format, ...);
void ritz_export_report_free(ritz_export_report *report);

#pragma GCC visibility pop

#endif
