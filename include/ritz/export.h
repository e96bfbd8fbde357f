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
    char units[RITZ_NAME_SIZE]; /* "kg m s"; "" if not known */
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

void ritz_shapes_free(ritz_shapes *shapes);

/* From containers to files that others read: what ritz-export does. */

/* Options of an exporter; zero where not given. */
typedef struct ritz_export_request {
    const char *output;      /* path */
    const char *matrices;    /* "K,M"; NULL: all that the format takes */
    bool text, dense;        /* output4, superelement */
    bool numbered;           /* dmig: continuations have marks */
    int64_t digits;          /* text */
    const char *ports;       /* names with commas between, whose grids are the
                                interface; NULL: those that were attached */
    int64_t id;              /* superelement: its number and the unit of its
                                file; 0: 101 */
    const char *modes;       /* shapes: which modes, "1-6,9"; NULL: the first
                                ten of a component, all of anything else */
    const char *frame;       /* of a moving body: "basic", "centre" or a grid;
                              NULL: "basic" */
    const char *reference;   /* of its modes: "none", "mean-axis" or "tangent";
                              NULL: "none" */
    int64_t fmi;             /* fmu: version 2 or 3; 0: 3 */
    const char *runtime;     /* fmu: folder of ritz_fmu.so and its licence */
    const ritz_stamp *stamp; /* container: its stamp; NULL: an empty one */
} ritz_export_request;

/* Lines for the user: what was written, and what was lost; one that begins with
   "warning: " is a warning. */
typedef struct ritz_export_report {
    int64_t count;
    char (*line)[256];
} ritz_export_report;

/* What is exported: one of these, the others are NULL; beside shapes `reduced`
   is the component that they are of, if they are of one. */
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

/** @return RITZ_ERR_ARGUMENT if something is asked that the format has not */
ritz_status ritz_export_check(const ritz_exporter *exporter,
                              const ritz_export_request *request);

[[gnu::format(printf, 2, 3)]] ritz_status
ritz_export_say(ritz_export_report *report, const char *format, ...);
void ritz_export_report_free(ritz_export_report *report);

#pragma GCC visibility pop

#endif
