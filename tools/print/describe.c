#include "print/describe.h"

#include "print/checksum.h"
#include "print/nested.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static json_t *names_json(int64_t count, char (*name)[RITZ_NAME_SIZE])
{
    json_t *array = json_array();

    for (int64_t k = 0; k < count; k++)
        json_array_append_new(array, cli_string(name[k]));
    return array;
}

static void set_int(json_t *keys, const char *key, int64_t value)
{
    json_object_set_new(keys, key, json_integer(value));
}

static void set_text(json_t *keys, const char *key, const char *text)
{
    json_object_set_new(keys, key, cli_string(text));
}

/* A sparse matrix: a line, and its checksum. An absent one is passed over. */
static void matrix(const cli_run *run, json_t *sums, const char *name,
                   const ritz_sparse *A)
{
    char sum[RITZ_DIGEST_SIZE];

    if (!A->colptr)
        return;
    checksum_sparse(A, sum);
    set_text(sums, name, sum);
    cli_say(run, "  %-14s %lld x %lld, %lld entries, sha256 %.12s...", name,
            (long long)A->nrow, (long long)A->ncol,
            (long long)A->colptr[A->ncol], sum);
}

static void dense(const cli_run *run, json_t *sums, const char *name,
                  const ritz_dense *A)
{
    char sum[RITZ_DIGEST_SIZE];

    if (!A->val)
        return;
    checksum_dense(A, sum);
    set_text(sums, name, sum);
    cli_say(run, "  %-14s %lld x %lld, dense, sha256 %.12s...", name,
            (long long)A->nrow, (long long)A->ncol, sum);
}

static void io(const cli_run *run, json_t *keys, const ritz_io *io)
{
    json_object_set_new(keys, "inputs", names_json(io->num_inputs, io->input));
    json_object_set_new(keys, "outputs",
                        names_json(io->num_outputs, io->output));
    for (int64_t k = 0; k < io->num_inputs; k++)
        cli_say(run, "  %-14s %s", k > 0 ? "" : "inputs", io->input[k]);
    for (int64_t k = 0; k < io->num_outputs; k++) {
        if (io->limit && !isnan(io->limit[k]))
            cli_say(run, "  %-14s %s, limit %g", k > 0 ? "" : "outputs",
                    io->output[k], io->limit[k]);
        else
            cli_say(run, "  %-14s %s", k > 0 ? "" : "outputs", io->output[k]);
    }
}

/* A port: its grids in order of first appearance, how many dofs, where. */
static void port(const cli_run *run, json_t *keys, const char *name,
                 int64_t count, const ritz_dof *dof, const double *origin)
{
    enum { SHOWN = 12 };
    json_t *grids = json_array();
    json_t *item = json_object();
    char text[SHOWN * 22] = "";
    size_t used = 0;
    int64_t last = -1;

    for (int64_t k = 0; k < count; k++) {
        if (dof[k].grid == last)
            continue;
        last = dof[k].grid;
        if (json_array_size(grids) < SHOWN)
            used += (size_t)snprintf(text + used, sizeof text - used, " %lld",
                                     (long long)last);
        json_array_append_new(grids, json_integer(last));
    }
    cli_say(run, "  port %-9s %lld dofs at grids%s%s, origin (%g, %g, %g)",
            name, (long long)count, text,
            json_array_size(grids) > SHOWN ? " ..." : "", origin[0], origin[1],
            origin[2]);
    set_text(item, "name", name);
    set_int(item, "dofs", count);
    json_object_set_new(item, "grids", grids);
    json_object_set_new(item, "origin", model_reals_json(3, origin));
    json_array_append_new(json_object_get(keys, "port_details"), item);
    json_array_append_new(json_object_get(keys, "ports"), cli_string(name));
}

static void start_ports(json_t *keys)
{
    json_object_set_new(keys, "ports", json_array());
    json_object_set_new(keys, "port_details", json_array());
}

static void component_ports(const cli_run *run, json_t *keys,
                            const ritz_component *c)
{
    start_ports(keys);
    for (int64_t k = 0; k < c->num_ports; k++) {
        const ritz_port *p = &c->port[k];
        ritz_dof *dof = calloc((size_t)p->dofs.count + 1, sizeof *dof);

        for (int64_t i = 0; dof && i < p->dofs.count; i++)
            dof[i] = c->dof[p->dofs.at[i]];
        port(run, keys, p->name, dof ? p->dofs.count : 0, dof, p->origin);
        free(dof);
    }
}

void describe_component(const cli_run *run, json_t *keys,
                        const ritz_component *c)
{
    json_t *sums = json_object();
    int64_t scalar = 0;
    int64_t grids = 0;

    for (int64_t k = 0; k < c->num_dofs; k++) {
        scalar += c->dof[k].component == 0;
        grids += c->dof[k].component != 0 &&
                 (k == 0 || c->dof[k].grid != c->dof[k - 1].grid);
    }
    cli_say(run, "  %-14s component, %lld dofs at %lld grids%s", "kind",
            (long long)c->num_dofs, (long long)grids,
            c->grids.count > 0 ? "" : " without positions");
    if (scalar > 0)
        cli_say(run, "  %-14s %lld", "scalar points", (long long)scalar);
    cli_say(run, "  %-14s %s", "units", *c->units ? c->units : "not stated");
    matrix(run, sums, "K", &c->K);
    matrix(run, sums, "M", &c->M);
    matrix(run, sums, "D", &c->D);
    describe_skew(run, keys, c->D.colptr ? ritz_sparse_skew(&c->D) : 0.0);
    matrix(run, sums, "K4", &c->K4);
    for (int64_t k = 0; k < c->num_loads; k++) {
        char name[RITZ_NAME_SIZE + 4];

        snprintf(name, sizeof name, "KG/%s", c->load[k].name);
        matrix(run, sums, name, &c->load[k].KG);
    }
    describe_damping(run, keys, c->damping);
    describe_dampers(run, keys, &c->dampers);
    describe_recovery(run, keys, &c->recovery);
    if (c->digits > 0.0)
        cli_say(run, "  %-14s %g significant", "digits", c->digits);
    if (c->asymmetry > 0.0)
        cli_say(run, "  %-14s %.1e of the largest entry, averaged away",
                "asymmetry", c->asymmetry);
    component_ports(run, keys, c);
    io(run, keys, &c->io);
    set_text(keys, "kind", "component");
    set_int(keys, "dofs", c->num_dofs);
    set_int(keys, "grids", grids);
    set_int(keys, "scalar_points", scalar);
    set_text(keys, "units", c->units);
    json_object_set_new(keys, "digits", cli_real(c->digits));
    json_object_set_new(keys, "asymmetry", cli_real(c->asymmetry));
    json_object_set_new(keys, "checksums", sums);
}

/* "12 constraint, 8 normal"; and the same as an object. */
void describe_columns(const cli_run *run, json_t *keys, const ritz_columns *c)
{
    json_t *kinds = json_object();
    char text[160] = "";
    size_t used = 0;
    int64_t modes = 0;
    double low = 0.0;
    double high = 0.0;

    for (int kind = RITZ_COLUMN_RIGID; kind <= RITZ_COLUMN_BALANCED; kind++) {
        const char *name = ritz_column_name((ritz_column_kind)kind);
        int64_t count = 0;

        for (int64_t k = 0; k < c->count; k++)
            count += (int)c->kind[k] == kind;
        if (count == 0)
            continue;
        set_int(kinds, name, count);
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%lld %s",
                                 used > 0 ? ", " : "", (long long)count, name);
        modes += kind == RITZ_COLUMN_NORMAL ? count : 0;
    }
    cli_say(run, "  %-14s %s", "columns", text);
    if (model_band(c, &low, &high))
        cli_say(run, "  %-14s %g to %g Hz", "normal modes", low, high);
    set_int(keys, "modes", modes);
    json_object_set_new(keys, "columns", kinds);
}

void describe_origin(const cli_run *run, json_t *keys, const ritz_origin *o)
{
    cli_say(run, "  %-14s %s (%s) [%s]%s%s", "method", o->method,
            *o->options ? o->options : "no options", o->reference,
            *o->engine ? ", " : "", o->engine);
    set_text(keys, "method", o->method);
    set_text(keys, "options", o->options);
    set_text(keys, "engine", o->engine);
}

/* Values of what was balanced: some of them, and all in JSON. */
static void describe_hankel(const cli_run *run, json_t *keys,
                            const ritz_basis *b)
{
    enum { SHOWN = 10, ROOM = 12 };
    char text[SHOWN * ROOM + 8] = "";
    size_t used = 0;

    for (int64_t k = 0; k < b->num_hankel && k < SHOWN; k++)
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%.4g",
                                 k > 0 ? " " : "", b->hankel[k]);
    cli_say(run, "  %-14s %s%s", "Hankel values", text,
            b->num_hankel > SHOWN ? " ..." : "");
    json_object_set_new(keys, "hankel_values",
                        model_reals_json(b->num_hankel, b->hankel));
}

void describe_basis(const cli_run *run, json_t *keys, const ritz_basis *b)
{
    json_t *sums = json_object();
    json_t *hertz = json_array();

    cli_say(run, "  %-14s basis of %lld columns for %lld %s", "kind",
            (long long)b->T.ncol, (long long)b->T.nrow,
            b->states ? "states" : "dofs");
    describe_origin(run, keys, &b->origin);
    describe_columns(run, keys, &b->columns);
    dense(run, sums, "T", &b->T);
    dense(run, sums, "W", &b->W);
    if (*b->damping)
        describe_damping(run, keys, b->damping);
    if (b->num_hankel > 0)
        describe_hankel(run, keys, b);
    for (int64_t k = 0; k < b->columns.count; k++)
        if (!isnan(b->columns.hertz[k]))
            json_array_append_new(hertz, cli_real(b->columns.hertz[k]));
    set_text(keys, "kind", "basis");
    set_int(keys, "dofs_full", b->T.nrow);
    set_int(keys, "dofs", b->T.ncol);
    json_object_set_new(keys, "frequencies_hz", hertz);
    json_object_set_new(keys, "checksums", sums);
}

void describe_inertia(const cli_run *run, json_t *keys, const ritz_inertia *i)
{
    json_t *item = json_object();

    if (i->known) {
        cli_say(run, "  %-14s %.8g", "mass", i->mass);
        cli_say(run, "  %-14s (%.6g, %.6g, %.6g)", "centre of mass",
                i->centre[0], i->centre[1], i->centre[2]);
        for (size_t k = 0; k < 3; k++)
            cli_say(run, "  %-14s %14.6g %14.6g %14.6g", k > 0 ? "" : "inertia",
                    i->tensor[3 * k], i->tensor[3 * k + 1],
                    i->tensor[3 * k + 2]);
        json_object_set_new(item, "mass", cli_real(i->mass));
        json_object_set_new(item, "centre", model_reals_json(3, i->centre));
        json_object_set_new(item, "tensor", model_reals_json(9, i->tensor));
    }
    json_object_set_new(keys, "inertia", item);
}

/* Frequencies, ten a line at most, rigid modes as their number. */
static void hertz_lines(const cli_run *run, const char *title, int64_t rigid,
                        int64_t count, const double *hertz)
{
    cli_say(run, "  %-14s %lld rigid, %lld flexible modes%s", title,
            (long long)rigid, (long long)(count - rigid),
            count > rigid ? ", Hz:" : "");
    for (int64_t k = rigid; k < count; k += 5) {
        char line[5 * 14 + 1] = "";
        size_t used = 0;

        for (int64_t i = k; i < k + 5 && i < count; i++)
            used += (size_t)snprintf(line + used, sizeof line - used, " %12.7g",
                                     hertz[i]);
        cli_say(run, "  %-14s%s", "", line);
    }
}

void describe_measures(const cli_run *run, json_t *keys, const char *key,
                       const ritz_measures *m)
{
    const char *known =
        strcmp(key, "estimates") == 0 ? "estimated" : "measured";

    json_object_set_new(keys, key, model_measures_json(m, known));
    if (m->count > 0) {
        cli_say(run, "  %s:", key);
        model_say_measures(run, m, known);
    }
}

ritz_status describe_reduced(const cli_run *run, json_t *keys,
                             const ritz_reduced *r)
{
    ritz_status status = RITZ_OK;
    json_t *sums = json_object();
    double *hertz = NULL;
    int64_t rigid = 0;
    int64_t count = 0;

    set_text(keys, "kind", "reduced");
    json_object_set_new(keys, "checksums", sums);
    RITZ_TRY(model_hertz(&r->K, &r->M, &rigid, &count, &hertz));
    cli_say(run, "  %-14s reduced component, %lld coordinates for %lld dofs",
            "kind", (long long)r->K.nrow, (long long)r->num_dofs);
    cli_say(run, "  %-14s %s", "units", *r->units ? r->units : "not stated");
    describe_origin(run, keys, &r->origin);
    describe_columns(run, keys, &r->columns);
    hertz_lines(run, "frequencies", rigid, count, hertz);
    dense(run, sums, "K", &r->K);
    dense(run, sums, "M", &r->M);
    dense(run, sums, "D", &r->D);
    describe_skew(run, keys, describe_skew_dense(&r->D));
    dense(run, sums, "K4", &r->K4);
    dense(run, sums, "T", &r->T);
    describe_damping(run, keys, r->damping);
    describe_dampers(run, keys, &r->dampers);
    describe_recovery(run, keys, &r->recovery);
    describe_inertia(run, keys, &r->inertia);
    start_ports(keys);
    for (int64_t k = 0; k < r->num_ports; k++)
        port(run, keys, r->port[k].name, r->port[k].count, r->port[k].dof,
             r->port[k].origin);
    io(run, keys, &r->io);
    set_int(keys, "dofs", r->K.nrow);
    set_int(keys, "dofs_full", r->num_dofs);
    set_text(keys, "units", r->units);
    json_object_set_new(keys, "frequencies_hz", model_reals_json(count, hertz));
    describe_measures(run, keys, "estimates", &r->estimates);
    describe_measures(run, keys, "errors", &r->errors);
    nested_describe(run, keys, &r->nested, r->K.ncol);
done:
    free(hertz);
    return status;
}

static ritz_status configuration(const cli_run *run, json_t *keys,
                                 const ritz_configuration *c)
{
    ritz_status status = RITZ_OK;
    json_t *item = json_object();
    double *hertz = NULL;

    json_array_append_new(json_object_get(keys, "configurations"), item);
    RITZ_TRY(model_hertz_at(c, &hertz));
    hertz_lines(run, *c->at ? c->at : "as joined", c->num_rigid, c->K.nrow,
                hertz);
    set_text(item, "at", c->at);
    set_int(item, "dofs", c->K.nrow);
    set_int(item, "rank", c->rank);
    json_object_set_new(item, "frequencies_hz",
                        model_reals_json(c->K.nrow, hertz));
    describe_measures(run, item, "errors", &c->errors);
    if (!json_object_get(keys, "frequencies_hz")) { /* the first one's */
        set_int(keys, "dofs", c->K.nrow);
        set_int(keys, "modes", c->K.nrow - c->num_rigid);
        json_object_set(keys, "frequencies_hz",
                        json_object_get(item, "frequencies_hz"));
        io(run, keys, &c->io);
    }
done:
    free(hertz);
    return status;
}

ritz_status describe_system(const cli_run *run, json_t *keys,
                            const ritz_system *s)
{
    json_t *components = json_array();
    json_t *sums = json_object();

    set_text(keys, "kind", "system");
    set_text(keys, "name", s->name);
    set_text(keys, "units", s->units);
    json_object_set_new(keys, "sweeps", names_json(s->num_sweeps, s->sweep));
    json_object_set_new(keys, "ports", json_array());
    json_object_set_new(keys, "configurations", json_array());
    json_object_set_new(keys, "components", components);
    json_object_set_new(keys, "checksums", sums);
    cli_say(run, "  %-14s system '%s' at %lld configurations", "kind", s->name,
            (long long)s->num_configurations);
    cli_say(run, "  %-14s %s", "units", *s->units ? s->units : "not stated");
    for (int64_t k = 0; k < s->num_components; k++) {
        json_t *item = json_object();

        cli_say(run, "  %-14s %-16s %lld coordinates for %lld dofs",
                k > 0 ? "" : "components", s->component[k],
                (long long)s->order[k], (long long)s->order_full[k]);
        set_text(item, "name", s->component[k]);
        set_int(item, "dofs", s->order[k]);
        set_int(item, "dofs_full", s->order_full[k]);
        json_array_append_new(components, item);
    }
    if (s->band_hz[1] > 0.0)
        cli_say(run, "  %-14s %g to %g Hz", "band", s->band_hz[0],
                s->band_hz[1]);
    describe_damping(run, keys, s->damping);
    if (s->num_configurations > 0)
        describe_dampers(run, keys, &s->configuration[0].dampers);
    for (int64_t k = 0; k < s->num_configurations; k++) {
        const ritz_configuration *c = &s->configuration[k];
        char name[2][RITZ_NAME_SIZE + 4];

        RITZ_CHECK(configuration(run, keys, c));
        snprintf(name[0], sizeof name[0], "%s/K", c->at);
        snprintf(name[1], sizeof name[1], "%s/M", c->at);
        dense(run, sums, name[0], &c->K);
        dense(run, sums, name[1], &c->M);
    }
    return RITZ_OK;
}

void describe_response(const cli_run *run, json_t *keys, const ritz_response *r)
{
    double low = r->count > 0 ? r->hertz[0] : (double)NAN;
    double high = r->count > 0 ? r->hertz[r->count - 1] : (double)NAN;

    cli_say(run, "  %-14s frequency response, %lld points, %g to %g Hz", "kind",
            (long long)r->count, low, high);
    cli_say(run, "  %-14s %s, damping %s", "method", r->method,
            *r->damping ? r->damping : "of the matrices");
    for (int64_t k = 0; k < r->num_inputs; k++)
        cli_say(run, "  %-14s %s", k > 0 ? "" : "inputs", r->input[k]);
    for (int64_t k = 0; k < r->num_outputs; k++)
        cli_say(run, "  %-14s %s", k > 0 ? "" : "outputs", r->output[k]);
    set_text(keys, "kind", "response");
    set_int(keys, "points", r->count);
    json_object_set_new(keys, "from_hz", cli_real(low));
    json_object_set_new(keys, "to_hz", cli_real(high));
    set_text(keys, "method", r->method);
    set_text(keys, "damping", r->damping);
    json_object_set_new(keys, "inputs", names_json(r->num_inputs, r->input));
    json_object_set_new(keys, "outputs", names_json(r->num_outputs, r->output));
}
