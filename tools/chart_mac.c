/*
 * How like the modes of two models are, by the dofs that both have:
 *
 *     MAC_ij = (u_i'v_j)^2 / (u_i'u_i v_j'v_j)
 */
#include "chart.h"

#include "html.h"

#include <ritz/eigen.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Modes of a full component; more than these would not be told apart. */
enum { MOST_MODES = 60, NUMBERED = 24 };

/* Shapes at the dofs of the full component. */
typedef struct shapes {
    ritz_dense U; /* n x m */
    double *hertz;
    int64_t count;
    const ritz_dof *dof; /* n, borrowed; NULL of a basis: those of its rows */
    const char *name;
} shapes;

static void free_shapes(shapes *s)
{
    ritz_dense_free(&s->U);
    free(s->hertz);
}

static const char *base_of(const char *path)
{
    const char *slash = strrchr(path, '/');

    return slash ? slash + 1 : path;
}

/* Flexible modes of pairs, as shapes U = T Phi or, without T, U = Phi. */
static ritz_status keep_modes(const ritz_pairs *pairs, const ritz_dense *T,
                              shapes *out)
{
    ritz_status status = RITZ_OK;
    int64_t first = pairs->num_rigid;
    int64_t count = pairs->Phi.ncol - first;
    ritz_dense flexible = {0};

    count = count < MOST_MODES ? count : MOST_MODES;
    RITZ_FAIL_IF(count < 1, RITZ_ERR_ARGUMENT, "there is no flexible mode");
    RITZ_TRY(ritz_dense_columns(&pairs->Phi, first, count, &flexible));
    out->hertz = calloc((size_t)count, sizeof *out->hertz);
    RITZ_FAIL_IF(!out->hertz, RITZ_ERR_MEMORY, "no memory for modes");
    for (int64_t k = 0; k < count; k++)
        out->hertz[k] = ritz_eigen_hertz(pairs->lambda[first + k]);
    if (T) {
        RITZ_TRY(ritz_dense_mul(T, &flexible, &out->U));
    } else {
        out->U = flexible;
        flexible = (ritz_dense){0};
    }
    out->count = count;
done:
    ritz_dense_free(&flexible);
    return status;
}

static ritz_status modes_of_reduced(const ritz_reduced *r, shapes *out)
{
    ritz_status status = RITZ_OK;
    ritz_pairs pairs = {0};

    RITZ_FAIL_IF(!r->dof, RITZ_ERR_ARGUMENT,
                 "it was made without its basis, it has no shapes");
    RITZ_TRY(ritz_eigen_dense(&r->K, &r->M, &pairs));
    RITZ_TRY(keep_modes(&pairs, &r->T, out));
    out->dof = r->dof;
done:
    ritz_pairs_free(&pairs);
    return status;
}

static ritz_status modes_of_component(const ritz_component *c, shapes *out)
{
    ritz_status status = RITZ_OK;
    const ritz_span span = {.modes = MOST_MODES};
    ritz_pairs pairs = {0};

    RITZ_TRY(ritz_eigen_sparse(&c->K, &c->M, &span, &pairs));
    RITZ_TRY(keep_modes(&pairs, NULL, out));
    out->dof = c->dof;
done:
    ritz_pairs_free(&pairs);
    return status;
}

static ritz_status columns_of_basis(const ritz_basis *b, shapes *out)
{
    ritz_status status = RITZ_OK;
    int64_t count = b->T.ncol < MOST_MODES ? b->T.ncol : MOST_MODES;

    RITZ_TRY(ritz_dense_columns(&b->T, 0, count, &out->U));
    out->hertz = calloc((size_t)count + 1, sizeof *out->hertz);
    RITZ_FAIL_IF(!out->hertz, RITZ_ERR_MEMORY, "no memory for modes");
    for (int64_t k = 0; k < count; k++)
        out->hertz[k] = b->columns.hertz[k];
    out->count = count;
done:
    return status;
}

static ritz_status shapes_of(const chart_file *file, shapes *out)
{
    const model *m = &file->model;
    ritz_status status = RITZ_OK;

    out->name = base_of(file->path);
    if (m->kind == MODEL_REDUCED)
        status = modes_of_reduced(&m->reduced, out);
    else if (m->kind == MODEL_BASIS)
        status = columns_of_basis(&m->basis, out);
    else
        status = modes_of_component(&m->component, out);
    return ritz_context(status, file->path);
}

/* Row of each dof of a in b, -1 where it is not; how many there are. */
static ritz_status match(const shapes *a, const shapes *b, int64_t **out)
{
    ritz_status status = RITZ_OK;
    int64_t n = a->U.nrow, m = b->U.nrow, common = 0;
    int64_t *row = calloc((size_t)n + 1, sizeof *row);
    bool named = a->dof && b->dof;

    RITZ_FAIL_IF(!row, RITZ_ERR_MEMORY, "no memory for dofs");
    RITZ_FAIL_IF(!named && n != m, RITZ_ERR_ARGUMENT,
                 "a basis names no dofs: '%s' has %lld rows and '%s' %lld",
                 a->name, (long long)n, b->name, (long long)m);
    for (int64_t k = 0, guess = 0; k < n; k++) {
        row[k] = named ? -1 : k;
        for (int64_t i = 0; named && i < m && row[k] < 0; i++) {
            int64_t at = (guess + i) % m; /* they mostly come in one order */

            if (a->dof[k].grid == b->dof[at].grid &&
                a->dof[k].component == b->dof[at].component)
                row[k] = at;
        }
        guess = row[k] >= 0 ? row[k] + 1 : guess;
        common += row[k] >= 0;
    }
    RITZ_FAIL_IF(common == 0, RITZ_ERR_ARGUMENT,
                 "'%s' and '%s' have no dof in common", a->name, b->name);
    *out = row;
    row = NULL;
done:
    free(row);
    return status;
}

static double mac_of(const shapes *a, const shapes *b, const int64_t *row,
                     int64_t i, int64_t j)
{
    const double *u = a->U.val + i * a->U.nrow;
    const double *v = b->U.val + j * b->U.nrow;
    double uv = 0.0, uu = 0.0, vv = 0.0;

    for (int64_t k = 0; k < a->U.nrow; k++) {
        if (row[k] < 0)
            continue;
        uv += u[k] * v[row[k]];
        uu += u[k] * u[k];
        vv += v[row[k]] * v[row[k]];
    }
    return uu > 0.0 && vv > 0.0 ? uv * uv / (uu * vv) : nan("");
}

static void say_mode(const shapes *s, int64_t k, char out[32])
{
    if (isnan(s->hertz[k]))
        snprintf(out, 32, "%lld", (long long)k + 1);
    else
        snprintf(out, 32, "%lld: %.3g", (long long)k + 1, s->hertz[k]);
}

static void put_data(const shapes *a, const shapes *b, const int64_t *row,
                     gnuplot *out)
{
    FILE *data = out->data.file, *table = out->table.file;
    char x[32], y[32];

    fprintf(data, "column\trow\tmac\ttip\n");
    html_line(table, a->name);
    for (int64_t j = 0; j < b->count; j++) {
        say_mode(b, j, x);
        fprintf(table, "\t%s", x);
    }
    for (int64_t i = 0; i < a->count; i++) {
        say_mode(a, i, y);
        fprintf(table, "\n%s", y);
        for (int64_t j = 0; j < b->count; j++) {
            double mac = mac_of(a, b, row, i, j);
            int64_t tip = 0;

            say_mode(b, j, x);
            tip = gnuplot_tip(out, "%.60s %s Hz\n%.60s %s Hz\nMAC %.4f",
                              a->name, y, b->name, x, mac);
            fprintf(data, "%lld\t%lld\t%.6g\t%lld\n", (long long)j,
                    (long long)i, mac, (long long)tip);
            fprintf(table, "\t%.4f", mac);
        }
        fprintf(data, "\n");
    }
    fprintf(table, "\n");
}

static void put_tics(FILE *file, char which, const shapes *s, const char *how)
{
    int64_t step = 1 + (s->count - 1) / 30;
    char word[32];

    fprintf(file, "set %ctics nomirror noenhanced %s (", which, how);
    for (int64_t k = 0; k < s->count; k += step) {
        say_mode(s, k, word);
        fprintf(file, "%s'%s' %lld", k > 0 ? ", " : "", word, (long long)k);
    }
    fprintf(file, ") font ',11' tc rgb '" SVG_MUTED "'\n");
}

/* One colour, the more of it the more alike: legible on any paper. */
static void put_plot(const shapes *a, const shapes *b, gnuplot *out)
{
    FILE *file = out->plot.file;

    put_tics(file, 'x', b, "rotate by 60 right");
    put_tics(file, 'y', a, "");
    fprintf(file,
            "unset grid\nset tics scale 0\nset style fill solid 1 noborder\n"
            "shade(x) = (int(255.5 * (1 - 0.94 * x - 0.06)) << 24) + 0x%s\n"
            "plot data skip 1 using 1:2:(0.48):(0.48):(shade($3)) with "
            "boxxyerror lc rgb variable notitle, \\\n"
            "  data skip 1 using 1:2:4 with labels hypertext point pt 7 ps 0.1 "
            "lc rgb '%s' notitle",
            svg_colour[0] + 1, svg_colour[0]);
    if (a->count <= NUMBERED && b->count <= NUMBERED)
        fprintf(file,
                ", \\\n  data skip 1 using ($3 < 0.5 ? NaN : $1):2:"
                "(sprintf('%%.2f', $3)) with labels font ',10' "
                "tc rgb '" SVG_PAPER "' notitle"
                ", \\\n  data skip 1 using (($3 >= 0.5 || $3 < 0.005) ? NaN : "
                "$1):2:(sprintf('%%.2f', $3)) with labels font ',10' "
                "tc rgb '" SVG_INK "' notitle");
    fprintf(file, "\n");
}

static ritz_status draw(const shapes *a, const shapes *b, const int64_t *row,
                        gnuplot *out)
{
    ritz_status status = RITZ_OK;
    int64_t most = a->count > b->count ? a->count : b->count;
    double cell = most <= NUMBERED ? 34.0 : 640.0 / (double)most;
    chart_area area = {.left = 110, .bottom = 100};
    char title[CHART_WORD];

    area.right = area.left + cell * (double)b->count;
    area.top = area.bottom + cell * (double)a->count;
    area.x = (axis){.low = -0.5, .high = (double)b->count - 0.5};
    area.y = (axis){.low = (double)a->count - 0.5, .high = -0.5};
    snprintf(title, sizeof title, "MAC of %.50s and %.50s", a->name, b->name);
    gnuplot_size(out,
                 fmax(area.right + 20.0, area.left + axis_width(title, 14.0)),
                 area.top + 40.0);
    chart_area_begin(out, &area, title, b->name, a->name);
    put_data(a, b, row, out);
    put_plot(a, b, out);
    RITZ_TRY(gnuplot_draw(out, title,
                          "likeness of mode shapes: 1 the same, 0 nothing in "
                          "common"));
done:
    return status;
}

ritz_status chart_mac(const chart_sources *sources, const chart_wish *wish,
                      gnuplot *out)
{
    ritz_status status = RITZ_OK;
    shapes set[2] = {{.count = 0}};
    int64_t *row = NULL;
    int count = 0;

    for (int64_t k = 0; k < sources->count; k++) {
        if (sources->file[k].holds != CHART_MODES)
            continue;
        RITZ_FAIL_IF(count == 2, RITZ_ERR_ARGUMENT,
                     "MAC is of two models, these are more");
        RITZ_TRY(shapes_of(&sources->file[k], &set[count++]));
    }
    RITZ_FAIL_IF(count < 2, RITZ_ERR_ARGUMENT,
                 "MAC is of two models, this is one");
    RITZ_TRY(match(&set[0], &set[1], &row));
    RITZ_TRY(gnuplot_new(wish->path, wish->keep, out));
    RITZ_TRY(draw(&set[0], &set[1], row, out));
done:
    free(row);
    free_shapes(&set[0]);
    free_shapes(&set[1]);
    return status;
}
