#include "print/print.h"

#include "base/bytes.h"
#include "base/tolerances.h"

#include <complex.h>

/* Relative size of an antisymmetric part that is rounding. */
static const double skew_rounding = 1e-12;

static void describe_units(cli_run *run, const char *units)
{
    sink_set(run, "units", "%s", units);
    sink_field(run, "units", "", "%s", *units ? units : "not stated");
}

enum { PARTS = 3 * RITZ_DIGEST_SIZE + 64 };

static void add_part(char text[PARTS], const void *bytes, int64_t count,
                     size_t size)
{
    char sum[RITZ_DIGEST_SIZE];

    ritz_digest_bytes(bytes, (size_t)count * size, sum);
    sink_append(text, PARTS, " %s", sum);
}

/* The sum of all parts; a name may have commas, by which sink.h would cut
   it. */
static void set_checksum(cli_run *run, const char *name, const char text[PARTS],
                         char out[RITZ_DIGEST_SIZE])
{
    ritz_digest_bytes(text, strlen(text), out);
    sink_object(run, "checksums");
    json_object_set_new(sink_here(run), name, cli_string(out));
    sink_end(run);
}

ritz_status checksum_sparse(cli_run *run, const char *name,
                            const ritz_sparse *A, char out[RITZ_DIGEST_SIZE])
{
    char text[PARTS], sum[RITZ_DIGEST_SIZE];
    int64_t nnz = A->colptr[A->ncol];
    ritz_digest_work *values = NULL;

    *out = '\0';
    if (run->unread)
        return RITZ_OK;
    RITZ_CHECK(
        ritz_digest_begin(A->val, nnz * (int64_t)sizeof *A->val, &values));
    snprintf(text, sizeof text, "%ld %ld", A->nrow, A->ncol);
    add_part(text, A->colptr, A->ncol + 1, sizeof *A->colptr);
    add_part(text, A->rowind, nnz, sizeof *A->rowind);
    ritz_digest_end(&values, sum);
    sink_append(text, PARTS, " %s", sum);
    set_checksum(run, name, text, out);
    return RITZ_OK;
}

/* A matrix: a line, and its checksum. An absent one is passed over. */
static ritz_status describe_sparse(cli_run *run, const char *name,
                                   const ritz_sparse *A)
{
    char sum[RITZ_DIGEST_SIZE];

    if (!A->colptr)
        return RITZ_OK;
    RITZ_CHECK(checksum_sparse(run, name, A, sum));
    sink_field(run, name, "", "%ld x %ld, %ld entries, sha256 %.12s...",
               A->nrow, A->ncol, A->colptr[A->ncol], sum);
    return RITZ_OK;
}

static void describe_dense(cli_run *run, const char *name, const ritz_dense *A)
{
    char text[PARTS], sum[RITZ_DIGEST_SIZE];

    if (!A->val || run->unread)
        return;
    snprintf(text, sizeof text, "%ld %ld", A->nrow, A->ncol);
    add_part(text, A->val, A->nrow * A->ncol, sizeof *A->val);
    set_checksum(run, name, text, sum);
    sink_field(run, name, "", "%ld x %ld, dense, sha256 %.12s...", A->nrow,
               A->ncol, sum);
}

static void describe_loads(cli_run *run, int64_t count,
                           const ritz_reduced_load *load)
{
    for (int64_t k = 0; k < count; k++) {
        char name[RITZ_NAME_SIZE + 4];

        snprintf(name, sizeof name, "KG/%s", load[k].name);
        describe_dense(run, name, &load[k].KG);
    }
}

/* Inputs and outputs by name, these with their limits. */
static void describe_io(cli_run *run, const ritz_io *io)
{
    sink_names(run, "inputs", "inputs", io->num_inputs, io->input);
    sink_names(run, NULL, "outputs", io->num_outputs, io->output);
    for (int64_t k = 0; k < io->num_outputs; k++) {
        const char *title = k > 0 ? "" : "outputs";

        if (io->limit && !isnan(io->limit[k]))
            cli_say(run, "  %-14s %s, limit %g", title, io->output[k],
                    io->limit[k]);
        else
            cli_say(run, "  %-14s %s", title, io->output[k]);
    }
}

/* A port: its grids in order of first appearance, how many dofs, where.
   @p at names its dofs among all; NULL: they are its own. */
static void describe_port(cli_run *run, char (*name)[RITZ_NAME_SIZE],
                          int64_t count, const int64_t *at, const ritz_dof *dof,
                          const double *origin)
{
    enum { SHOWN = 12 };
    int64_t grids = 0;

    sink_part(run, "  port %-9s %ld dofs at grids", *name, count);
    sink_names(run, NULL, "ports", 1, name);
    sink_list(run, "port_details");
    sink_object(run, NULL);
    sink_set(run, "name,dofs", "%s %ld", *name, count);
    sink_reals(run, "origin", 3, origin);
    sink_list(run, "grids");
    for (int64_t k = 0, last = 0; k < count; k++) {
        int64_t grid = dof[at ? at[k] : k].grid;

        if (k == 0 || grid != last) {
            sink_add(run, "%ld", grid);
            if (grids++ < SHOWN)
                sink_part(run, " %ld", grid);
        }
        last = grid;
    }
    sink_end(run);
    sink_end(run);
    sink_end(run);
    cli_say(run, "%s, origin (%g, %g, %g)", grids > SHOWN ? " ..." : "",
            origin[0], origin[1], origin[2]);
}

/* Lists of ports are there even where there is none. */
static void start_ports(cli_run *run)
{
    sink_wholes(run, "ports", 0, NULL, 0);
    sink_wholes(run, "port_details", 0, NULL, 0);
}

void describe_damping(cli_run *run, const char *text)
{
    ritz_damping damping = {0};
    int64_t at = 0;
    double worst = 0.0;

    sink_set(run, "damping", "%s", text);
    if (*text)
        sink_field(run, "damping", "", "%s", text);
    if (ritz_damping_parse(text, &damping) != RITZ_OK ||
        damping.kind != RITZ_DAMPING_FIT)
        return;
    worst = ritz_damping_misfit(&damping, &at);
    sink_object(run, "rayleigh_fit");
    sink_field(run, "", "a,b,residual",
               "a = %.6g, b = %.6g, off by %.2g of %.2g at most, at %g Hz",
               damping.a, damping.b, worst, damping.point[at][1],
               damping.point[at][0]);
    sink_end(run);
}

void describe_dampers(cli_run *run, const ritz_dampers *dampers)
{
    SINK_EACH(run, "dampers", j, dampers->count) {
        bool held = dampers->held_c[j] == dampers->c[j] &&
                    dampers->held_k[j] == dampers->k[j];

        sink_field(run, j > 0 ? "" : "dampers", "name,c,k",
                   "%s, c = %g, k = %g%s", dampers->name[j], dampers->c[j],
                   dampers->k[j], held ? "" : ", not in D and K");
    }
}

/* The antisymmetric part of D, relative in the Frobenius norm. */
static void describe_skew(cli_run *run, double share)
{
    sink_set(run, "gyroscopic", "%g", share);
    if (share > skew_rounding)
        sink_field(run, "", "",
                   "unsymmetric: a gyroscopic part of %.3g %% is kept",
                   100.0 * share);
}

/* "grid 7: 123456": directions of a grid; the first dof of the next one. */
static int64_t print_grid(const ritz_recovery *r, int64_t k, size_t size,
                          char *text)
{
    ritz_dof first = r->dof[k];

    snprintf(text, size, "%s %ld", first.component == 0 ? "point" : "grid",
             first.grid);
    if (first.component > 0)
        sink_append(text, size, " ");
    for (; k < r->count && r->dof[k].grid == first.grid; k++)
        if (r->dof[k].component > 0)
            sink_append(text, size, "%ld", r->dof[k].component);
    return k;
}

/* Dofs that constraints eliminated. */
static void describe_recovery(cli_run *run, const ritz_recovery *recovery)
{
    enum { SHOWN = 5 };
    int64_t count = recovery->count, grids = 0;

    sink_set(run, "recovered", "%ld", count);
    if (count > 0)
        sink_part(run,
                  "  %-14s %ld dofs that follow from the others: ", "recovered",
                  count);
    sink_list(run, "recovered_dofs");
    for (int64_t k = 0; k < count; grids++) {
        char one[64];

        k = print_grid(recovery, k, sizeof one, one);
        sink_add(run, "%s", one);
        if (grids < SHOWN)
            sink_part(run, "%s%s", grids > 0 ? ", " : "", one);
    }
    sink_end(run);
    if (count > 0)
        cli_say(run, "%s", grids > SHOWN ? ", ..." : "");
}

/* A line for each quantity that can be recovered. */
static void describe_quantities(cli_run *run, int64_t count,
                                const ritz_quantity *quantity)
{
    SINK_ITEMS(run, "quantities", k, count) {
        const ritz_quantity *q = &quantity[k];

        sink_set(run, "mode_acceleration", "%d", q->Q.val != NULL);
        sink_field(run, k > 0 ? "" : "quantities", "name,rows,kind",
                   "%-20s %ld rows of kind %s%s", q->name, q->count, q->kind,
                   q->Q.val ? ", by mode acceleration too" : "");
    }
}

ritz_status describe_component(cli_run *run, const ritz_component *c)
{
    int64_t scalar = 0;
    int64_t grids = 0;

    for (int64_t k = 0; k < c->num_dofs; k++) {
        scalar += c->dof[k].component == 0;
        grids += c->dof[k].component != 0 &&
                 (k == 0 || c->dof[k].grid != c->dof[k - 1].grid);
    }
    sink_set(run, "scalar_points,digits,asymmetry", "%ld %g %g", scalar,
             c->digits, c->asymmetry);
    sink_field(run, "kind", "dofs,grids", "component, %ld dofs at %ld grids%s",
               c->num_dofs, grids,
               c->grids.count > 0 ? "" : " without positions");
    if (scalar > 0)
        sink_field(run, "scalar points", "", "%ld", scalar);
    describe_units(run, c->units);
    RITZ_CHECK(describe_sparse(run, "K", &c->K));
    RITZ_CHECK(describe_sparse(run, "M", &c->M));
    RITZ_CHECK(describe_sparse(run, "D", &c->D));
    describe_skew(run, c->D.colptr ? ritz_sparse_skew(&c->D) : 0.0);
    RITZ_CHECK(describe_sparse(run, "K4", &c->K4));
    for (int64_t k = 0; k < c->num_loads; k++) {
        char name[RITZ_NAME_SIZE + 4];

        snprintf(name, sizeof name, "KG/%s", c->load[k].name);
        RITZ_CHECK(describe_sparse(run, name, &c->load[k].KG));
    }
    describe_damping(run, c->damping);
    describe_dampers(run, &c->dampers);
    describe_recovery(run, &c->recovery);
    describe_quantities(run, c->num_quantities, c->quantity);
    if (c->digits > 0.0)
        sink_field(run, "digits", "", "%g significant", c->digits);
    if (c->asymmetry > 0.0)
        cli_say(run, "  %-14s %.1e of the largest entry, averaged away",
                "asymmetry", c->asymmetry);
    start_ports(run);
    for (int64_t k = 0; k < c->num_ports; k++)
        describe_port(run, &c->port[k].name, c->port[k].dofs.count,
                      c->port[k].dofs.at, c->dof, c->port[k].origin);
    describe_io(run, &c->io);
    return RITZ_OK;
}

/* Lowest and highest frequency of normal modes; false if none has one. */
static bool find_band(const ritz_columns *columns, double *low, double *high)
{
    bool any = false;

    for (int64_t k = 0; k < columns->count; k++) {
        double hertz = columns->hertz[k];

        if (columns->kind[k] != RITZ_COLUMN_NORMAL || isnan(hertz))
            continue;
        *low = any && *low < hertz ? *low : hertz;
        *high = any && *high > hertz ? *high : hertz;
        any = true;
    }
    return any;
}

/* "12 constraint, 8 normal". */
static void describe_columns(cli_run *run, const ritz_columns *c)
{
    int64_t modes = 0;
    double low = 0.0, high = 0.0;
    bool any = false;

    sink_part(run, "  %-14s ", "columns");
    sink_object(run, "columns");
    for (int kind = RITZ_COLUMN_RIGID; kind <= RITZ_COLUMN_BALANCED; kind++) {
        const char *name = ritz_column_name((ritz_column_kind)kind);
        int64_t count = 0;

        for (int64_t k = 0; k < c->count; k++)
            count += (int)c->kind[k] == kind;
        if (count == 0)
            continue;
        sink_set(run, name, "%ld", count);
        sink_part(run, "%s%ld %s", any ? ", " : "", count, name);
        any = true;
        modes += kind == RITZ_COLUMN_NORMAL ? count : 0;
    }
    sink_end(run);
    sink_set(run, "modes", "%ld", modes);
    cli_say(run, "%s", "");
    if (find_band(c, &low, &high))
        sink_field(run, "normal modes", "", "%g to %g Hz", low, high);
}

/* How a basis was made. */
static void describe_origin(cli_run *run, const ritz_origin *o)
{
    sink_set(run, "method,options,engine", "%s %s %s", o->method, o->options,
             o->engine);
    if (o->reason)
        sink_set(run, "reason", "%s", o->reason);
    sink_field(run, "method", "", "%s (%s) [%s]%s%s%s%s", o->method,
               *o->options ? o->options : "no options", o->reference,
               *o->engine ? ", " : "", o->engine, o->reason ? ": " : "",
               o->reason ? o->reason : "");
}

/* Values of a balanced basis: some of them, and all in JSON. */
static void describe_hankel(cli_run *run, const ritz_basis *b)
{
    enum { SHOWN = 10 };

    sink_part(run, "  %-14s", "Hankel values");
    for (int64_t k = 0; k < b->num_hankel && k < SHOWN; k++)
        sink_part(run, " %.4g", b->hankel[k]);
    cli_say(run, "%s", b->num_hankel > SHOWN ? " ..." : "");
    sink_reals(run, "hankel_values", b->num_hankel, b->hankel);
}

void sink_error_bounds(cli_run *run, const ritz_columns *columns)
{
    bool any = false;

    for (int64_t k = 0; columns->error && k < columns->count; k++)
        any = any || !isnan(columns->error[k]);
    if (!any)
        return;
    SINK_EACH(run, "error_bounds", k, columns->count)
        if (!isnan(columns->error[k]))
            sink_add(run, "%g", columns->error[k]);
}

ritz_status describe_basis(cli_run *run, const ritz_basis *b)
{
    sink_field(run, "kind", "dofs,dofs_full", "basis of %ld columns for %ld %s",
               b->T.ncol, b->T.nrow, b->states ? "states" : "dofs");
    describe_origin(run, &b->origin);
    describe_columns(run, &b->columns);
    describe_dense(run, "T", &b->T);
    describe_dense(run, "W", &b->W);
    if (*b->damping)
        describe_damping(run, b->damping);
    if (b->num_hankel > 0)
        describe_hankel(run, b);
    SINK_EACH(run, "frequencies_hz", k, b->columns.count)
        if (!isnan(b->columns.hertz[k]))
            sink_add(run, "%g", b->columns.hertz[k]);
    sink_error_bounds(run, &b->columns);
    return RITZ_OK;
}

/*
 * Why inertias are 0 that no body of mass has: of a point all are, of a rod one
 * is and the others are equal, and none is larger than the sum of the others.
 */
static const char *doubt_inertia(const ritz_inertia *i)
{
    int zeros = 0;

    for (size_t k = 0; k < 3; k++)
        zeros += i->tensor[4 * k] == 0.0;
    if (zeros == 3)
        return "0: of a point, or not known, without translations across axes";
    return zeros == 2 ? "0: not known, without translations across the axis"
                      : NULL;
}

/* Mass, centre and inertia; an empty object if they are not known. */
static void describe_inertia(cli_run *run, const ritz_inertia *i)
{
    sink_object(run, "inertia");
    if (i->known) {
        sink_field(run, "mass", "mass", "%.8g", i->mass);
        sink_field(run, "centre of mass", "", "(%.6g, %.6g, %.6g)",
                   i->centre[0], i->centre[1], i->centre[2]);
        for (size_t k = 0; k < 3; k++)
            cli_say(run, "  %-14s %14.6g %14.6g %14.6g", k > 0 ? "" : "inertia",
                    i->tensor[3 * k], i->tensor[3 * k + 1],
                    i->tensor[3 * k + 2]);
        if (doubt_inertia(i))
            cli_say(run, "  %-14s %s", "", doubt_inertia(i));
        sink_reals(run, "centre", 3, i->centre);
        sink_reals(run, "tensor", 9, i->tensor);
    }
    sink_end(run);
}

/* List frequencies, five per line; those < 0 if @p negative, else all
   others. */
static void list_hertz(cli_run *run, int64_t first, int64_t count,
                       const double *hertz, bool negative)
{
    int64_t listed = 0;

    for (int64_t k = first; k < count; k++) {
        if ((hertz[k] < 0.0) != negative)
            continue;
        if (listed % 5 == 0)
            sink_part(run, "  %-14s", "");
        sink_part(run, " %12.7g", negative ? -hertz[k] : hertz[k]);
        if (++listed % 5 == 0)
            cli_say(run, "%s", "");
    }
    if (listed % 5 != 0)
        cli_say(run, "%s", "");
}

/* List frequencies; rigid modes are only counted, and @p squares modes of
   negative eigenvalue are listed separately. */
static void describe_hertz(cli_run *run, const char *title, int64_t rigid,
                           int64_t count, int64_t squares, const double *hertz)
{
    cli_say(run, "  %-14s %ld rigid, %ld flexible modes%s", title, rigid,
            count - rigid - squares, count - squares > rigid ? ", Hz:" : "");
    if (squares == 0) { /* negative by rounding, or by mistake */
        for (int64_t k = rigid; k < count; k += 5) {
            sink_part(run, "  %-14s", "");
            for (int64_t i = k; i < k + 5 && i < count; i++)
                sink_part(run, " %12.7g", hertz[i]);
            cli_say(run, "%s", "");
        }
    } else {
        list_hertz(run, rigid, count, hertz, false);
        cli_say(run,
                "  %-14s %ld negative squares of the forces that join bodies, "
                "no modes of these; they grow by e^(2 pi f t), f in Hz:",
                "", squares);
        list_hertz(run, rigid, count, hertz, true);
        sink_set(run, "negative_squares", "%ld", squares);
    }
    sink_reals(run, "frequencies_hz", count, hertz);
}

static void describe_measures(cli_run *run, const char *key,
                              const ritz_measures *m, const char *known)
{
    if (m->count > 0)
        cli_say(run, "  %s:", key);
    model_say_measures(run, SINK_LINE, key, m, known);
}

/* A row a measure and a column an order, some orders at a time. */
static void describe_nested_errors(cli_run *run, const ritz_nested *nested)
{
    enum { ACROSS = 6 };

    for (int64_t k = 0; k < nested->count; k += ACROSS) {
        int64_t end = k + ACROSS < nested->count ? k + ACROSS : nested->count;

        sink_part(run, "    %-35s", "errors of the first");
        for (int64_t i = k; i < end; i++)
            sink_part(run, " %8ld", nested->order[i]);
        for (int64_t j = 0; j < nested->num_errors; j++) {
            sink_part(run, "\n      %-33s", nested->error[j]);
            for (int64_t i = k; i < end; i++)
                sink_part(run, " %8.1e", ritz_dense_col(&nested->value, j)[i]);
        }
        cli_say(run, "%s", "");
    }
}

/* Prefixes that are models too, with their errors; there may be none. */
static void describe_nested(cli_run *run, const ritz_nested *nested,
                            int64_t columns)
{
    if (nested->smallest == 0)
        return;
    sink_object(run, "nested");
    sink_field(run, "nested", "smallest",
               "first %ld to %ld columns (--order N)", nested->smallest,
               columns);
    describe_nested_errors(run, nested);
    sink_wholes(run, "order", nested->count, nested->order, 0);
    sink_object(run, "errors");
    for (int64_t j = 0; j < nested->num_errors; j++)
        sink_reals(run, nested->error[j], nested->count,
                   ritz_dense_col(&nested->value, j));
    sink_end(run);
    sink_end(run);
}

ritz_status describe_reduced(cli_run *run, const ritz_reduced *r)
{
    RITZ_OWN_ARRAY double *hertz = NULL;
    int64_t rigid = 0;
    int64_t count = 0;

    RITZ_CHECK(model_hertz(&r->K, &r->M, &rigid, &count, &hertz));
    sink_field(run, "kind", "dofs,dofs_full",
               "reduced component, %ld coordinates for %ld dofs", r->K.nrow,
               r->num_dofs);
    describe_units(run, r->units);
    describe_origin(run, &r->origin);
    describe_columns(run, &r->columns);
    describe_hertz(run, "frequencies", rigid, count, 0, hertz);
    describe_dense(run, "K", &r->K);
    describe_dense(run, "M", &r->M);
    describe_dense(run, "D", &r->D);
    describe_skew(run, ritz_dense_skew(&r->D));
    describe_dense(run, "K4", &r->K4);
    describe_loads(run, r->num_loads, r->load);
    describe_dense(run, "T", &r->T);
    describe_damping(run, r->damping);
    describe_dampers(run, &r->dampers);
    describe_recovery(run, &r->recovery);
    describe_quantities(run, r->num_quantities, r->quantity);
    describe_inertia(run, &r->inertia);
    start_ports(run);
    for (int64_t k = 0; k < r->num_ports; k++)
        describe_port(run, &r->port[k].name, r->port[k].count, NULL,
                      r->port[k].dof, r->port[k].origin);
    describe_io(run, &r->io);
    describe_measures(run, "estimates", &r->estimates, "estimated");
    describe_measures(run, "errors", &r->errors, "measured");
    describe_nested(run, &r->nested, r->K.ncol);
    return RITZ_OK;
}

static ritz_status describe_configuration(cli_run *run,
                                          const ritz_configuration *c)
{
    RITZ_OWN_ARRAY double *hertz = NULL;

    RITZ_CHECK(model_hertz_at(c, &hertz));
    sink_object(run, NULL);
    sink_set(run, "at,dofs,rank", "%s %ld %ld", c->at, c->K.nrow, c->rank);
    describe_hertz(run, *c->at ? c->at : "as joined", c->num_rigid, c->K.nrow,
                   model_negative_squares(c, NULL), hertz);
    SINK_EACH(run, "loads", k, c->num_loads) {
        sink_field(run, k > 0 ? "" : "loads", "", "%s, geometric stiffness",
                   c->load[k].name);
        sink_add(run, "%s", c->load[k].name);
    }
    describe_measures(run, "errors", &c->errors, "measured");
    sink_end(run);
    return RITZ_OK;
}

/* All of them; the report itself has keys of the first one. */
static ritz_status describe_configurations(cli_run *run, const ritz_system *s)
{
    for (int64_t k = 0; k < s->num_configurations; k++) {
        const ritz_configuration *c = &s->configuration[k];
        const json_t *item = NULL;
        char name[2][RITZ_NAME_SIZE + 4];

        sink_list(run, "configurations");
        RITZ_CHECK(describe_configuration(run, c));
        item = json_array_get(sink_here(run), (size_t)k);
        sink_end(run);
        if (k == 0) {
            sink_set(run, "dofs,modes", "%ld %ld", c->K.nrow,
                     c->K.nrow - c->num_rigid);
            json_object_set(sink_here(run), "frequencies_hz",
                            json_object_get(item, "frequencies_hz"));
            describe_io(run, &c->io);
        }
        snprintf(name[0], sizeof name[0], "%s/K", c->at);
        snprintf(name[1], sizeof name[1], "%s/M", c->at);
        describe_dense(run, name[0], &c->K);
        describe_dense(run, name[1], &c->M);
    }
    return RITZ_OK;
}

ritz_status describe_system(cli_run *run, const ritz_system *s)
{
    sink_names(run, NULL, "sweeps", s->num_sweeps, s->sweep);
    sink_list(run, "ports");
    sink_end(run);
    sink_field(run, "kind", "name", "system '%s' at %ld configurations",
               s->name, s->num_configurations);
    describe_units(run, s->units);
    SINK_EACH(run, "components", k, s->num_components)
        sink_field(run, k > 0 ? "" : "components", "name,dofs,dofs_full",
                   "%-16s %ld coordinates for %ld dofs", s->component[k].name,
                   s->component[k].order, s->component[k].order_full);
    if (s->band_hz[1] > 0.0)
        sink_field(run, "band", "", "%g to %g Hz", s->band_hz[0],
                   s->band_hz[1]);
    if (*s->spin)
        sink_field(run, "spin", "spin", "%s", s->spin);
    describe_damping(run, s->damping);
    if (s->num_configurations > 0)
        describe_dampers(run, &s->configuration[0].dampers);
    return describe_configurations(run, s);
}

/* The slowest first, of a pair one line. */
static void describe_poles(cli_run *run, int64_t count,
                           const double _Complex *pole)
{
    enum { SHOWN = 40 };
    int64_t shown = 0;

    sink_field(run, "poles", "", "%14s %14s %12s %10s", "real, rad/s",
               "imaginary", "Hz", "damping");
    SINK_EACH(run, "poles", k, count) {
        double re = creal(pole[k]);
        double im = cimag(pole[k]);
        double w = hypot(re, im);

        sink_list(run, NULL);
        sink_add(run, "%g %g", re, im);
        sink_end(run);
        if (im >= 0.0 && shown++ < SHOWN)
            sink_field(run, "", "", "%14.6g %14.6g %12.6g %10.4g", re, im,
                       w / (2.0 * RITZ_PI), w > 0.0 ? -re / w : 0.0);
    }
    if (shown > SHOWN)
        sink_field(run, "", "", "and %ld faster ones", (shown - SHOWN));
}

ritz_status describe_states(cli_run *run, const ritz_state_space *states)
{
    const ritz_io io = ritz_model_io(ritz_model_of_states(states));
    ritz_probe probe = {0};
    RITZ_OWN_ARRAY double _Complex *pole = NULL;
    int64_t count = 0;
    char text[2 * RITZ_NAME_SIZE];

    RITZ_CHECK(ritz_probe_states(states, &probe));
    if (!ritz_state_space_is_sparse(states))
        RITZ_CHECK(ritz_state_space_poles(states, &count, &pole));
    sink_field(run, "kind", "states", "state space, %ld states",
               ritz_state_space_order(states));
    describe_units(run, states->units);
    if (*states->origin.method)
        describe_origin(run, &states->origin);
    describe_columns(run, &states->columns);
    describe_dense(run, "A", &states->A);
    describe_dense(run, "B", &states->B);
    describe_dense(run, "C", &states->C);
    describe_dense(run, "D", &states->D);
    describe_dense(run, "E", &states->E);
    RITZ_CHECK(describe_sparse(run, "A", &states->sA));
    RITZ_CHECK(describe_sparse(run, "E", &states->sE));
    describe_damping(run, states->damping);
    describe_io(run, &io);
    if (!ritz_state_space_is_sparse(states))
        describe_poles(run, count, pole);
    ritz_probe_print(&probe, text);
    sink_field(run, "stability", "stability", "%s: %s",
               ritz_stability_name(probe.verdict), text);
    describe_measures(run, "estimates", &states->estimates, "estimated");
    describe_measures(run, "errors", &states->errors, "measured");
    return RITZ_OK;
}
