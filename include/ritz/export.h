/* From containers to files that others read: what ritz-export does. */
#ifndef RITZ_EXPORT_H
#define RITZ_EXPORT_H

#include <ritz/reduced.h>
#include <ritz/response.h>
#include <ritz/shapes.h>
#include <ritz/simulate.h>
#include <ritz/state_space.h>

#pragma GCC visibility push(default)

/* Options of an exporter; zero where not given. */
typedef struct ritz_export_request {
    const char *output;   /* path */
    const char *matrices; /* "K,M"; NULL: all that the format takes */
    bool text, dense;     /* output4 */
    int64_t digits;       /* text */
    const char *modes;    /* of shapes, "1-6,9"; NULL: see shapes.h */
} ritz_export_request;

/* Lines for the user: what was written, and what was lost. */
typedef struct ritz_export_report {
    int64_t count;
    char (*line)[256];
} ritz_export_report;

/* The fields of a request that an exporter uses; others must not be set. */
enum {
    RITZ_EXPORT_MATRICES = 1,
    RITZ_EXPORT_STYLE = 2,
    RITZ_EXPORT_SHAPES = 4,
};

typedef struct ritz_exporter {
    const char *name;
    const char *summary;
    const char *reference;
    const char *kind; /* of what it takes: "reduced", "response", "shapes" */
    int uses;         /* RITZ_EXPORT_... */
    ritz_status (*write_reduced)(const ritz_reduced *reduced,
                                 const ritz_export_request *request,
                                 ritz_export_report *report);
    ritz_status (*write_response)(const ritz_response *response,
                                  const ritz_export_request *request,
                                  ritz_export_report *report);
    /** Beside its kind; NULL: it takes none. */
    ritz_status (*write_states)(const ritz_state_space *model,
                                const ritz_export_request *request,
                                ritz_export_report *report);
    /** Beside responses over frequency; NULL: it takes none. */
    ritz_status (*write_simulation)(const ritz_simulation *simulation,
                                    const ritz_export_request *request,
                                    ritz_export_report *report);
    /** For kind "shapes" only. */
    ritz_status (*write_shapes)(const ritz_shapes *shapes,
                                const ritz_export_request *request,
                                ritz_export_report *report);
} ritz_exporter;

/** All exporters, ended by NULL. */
extern const ritz_exporter *const ritz_exporters[];
extern const ritz_exporter ritz_exporter_exudyn;
extern const ritz_exporter ritz_exporter_matlab;
extern const ritz_exporter ritz_exporter_matrix_market;
extern const ritz_exporter ritz_exporter_output4;
extern const ritz_exporter ritz_exporter_tsv;
extern const ritz_exporter ritz_exporter_vtu;
extern const ritz_exporter ritz_exporter_xdmf;

const ritz_exporter *ritz_exporter_find(const char *name);

/** @return RITZ_ERR_ARGUMENT if something is asked that the format has not */
ritz_status ritz_export_check(const ritz_exporter *exporter,
                              const ritz_export_request *request);

[[gnu::format(printf, 2, 3)]] ritz_status
ritz_export_say(ritz_export_report *report, const char *format, ...);
void ritz_export_report_free(ritz_export_report *report);

#pragma GCC visibility pop

#endif
