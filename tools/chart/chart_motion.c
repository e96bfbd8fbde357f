/* A body at four times of its motion, deformed, with stresses as colours. */
#include "base/text.h"
#include "chart/chart.h"

#include "base/tolerances.h"
#include "model/cell_edges.h"

#include <math.h>
#include <stdlib.h>

enum {
    PANELS = 4,
    ACROSS = 2,
    PANEL_WIDE = 450,
    PANEL_HIGH = 300,
    BANDS = 4,           /* of values */
    CLASSES = 2 + BANDS, /* at rest, without a value, and the bands */
    MOST_LINES = 40000,
    RIGID = 6,
};

/* Colour and width of the lines of each class, in the order of drawing. */
static const struct {
    const char *colour;
    double wide;
} looks[CLASSES] = {{"pale", 1.0}, {"muted", 1.5}, {"c1", 1.8},
                    {"c3", 2.2},   {"c2", 2.8},    {"c8", 3.6}};

typedef struct motion_frame {
    double seconds;
    ritz_shapes shapes;
} motion_frame;

typedef struct motion_chart {
    int64_t count;
    motion_frame frame[PANELS];
    double scale;   /* of displacements */
    double largest; /* |value| of all frames; 0: there are no values */
    picture *picture;
} motion_chart;

static void motion_chart_free(motion_chart *m)
{
    for (int k = 0; k < PANELS; k++)
        ritz_shapes_free(&m->frame[k].shapes);
}

/* ---- frames ------------------------------------------------------------- */

static ritz_status count_frames(const char *text, int64_t *out)
{
    char name[RITZ_COLLECTION_NAME];
    double seconds = 0.0;
    bool more = true;

    for (*out = -1; more; ++*out)
        RITZ_CHECK(ritz_collection_next(&text, &seconds, name, &more));
    return RITZ_OK;
}

/* The file of a frame, which lies beside its list. */
static ritz_status read_frame(const chart_sources *sources, const char *name,
                              ritz_shapes *out)
{
    const char *list = sources->file->path;
    const char *base = ritz_path_name(list);
    char path[PICTURE_PATH + RITZ_COLLECTION_NAME];

    snprintf(path, sizeof path, "%.*s%s", (int)(base - list), list, name);
    RITZ_CHECK(cli_input(sources->run, path));
    return ritz_frame_read(path, out);
}

/* Read all frames if there are at most four. Of more, read four that divide the
   collection equally; the last frame is one of them, the first is not. */
static ritz_status read_frames(const chart_sources *sources, motion_chart *m)
{
    const char *text = sources->file->text;
    char name[RITZ_COLLECTION_NAME];
    double seconds = 0.0;
    int64_t count = 0;
    bool more = true;

    RITZ_CHECK(count_frames(text, &count));
    RITZ_REFUSE_IF(count < 1, RITZ_ERR_FORMAT, "'%s' lists no frames",
                   sources->file->path);
    for (int64_t k = 0; k < count && m->count < PANELS; k++) {
        const int64_t wanted =
            count <= PANELS ? m->count : (m->count + 1) * (count - 1) / PANELS;
        motion_frame *frame = &m->frame[m->count];

        RITZ_CHECK(ritz_collection_next(&text, &seconds, name, &more));
        if (k != wanted)
            continue;
        frame->seconds = seconds;
        RITZ_CHECK(read_frame(sources, name, &frame->shapes));
        RITZ_REFUSE_IF(frame->shapes.num_points !=
                           m->frame[0].shapes.num_points,
                       RITZ_ERR_FORMAT,
                       "'%s' is of another mesh than the "
                       "first frame",
                       name);
        m->count++;
    }
    return RITZ_OK;
}

/* ---- deformation -------------------------------------------------------- */

/* Unit rigid motion j at all points: translations, then rotations. */
static void set_rigid(const ritz_shapes *s, int j, double *out)
{
    const int a = (j + 1) % 3, b = (j + 2) % 3;

    for (int64_t k = 0; k < s->num_points; k++) {
        const double *x = s->position + 3 * k;

        out[3 * k] = out[3 * k + 1] = out[3 * k + 2] = 0.0;
        if (j < 3) {
            out[3 * k + j] = 1.0;
        } else {
            out[3 * k + a] = -x[b];
            out[3 * k + b] = x[a];
        }
    }
}

static double dot(int64_t n, const double *a, const double *b)
{
    double sum = 0.0;

    for (int64_t k = 0; k < n; k++)
        sum += a[k] * b[k];
    return sum;
}

/* x -= (q'x / q'q) q */
static void take_out(int64_t n, const double *q, double *x)
{
    const double size = dot(n, q, q);
    const double part = size > 0.0 ? dot(n, q, x) / size : 0.0;

    for (int64_t k = 0; k < n; k++)
        x[k] -= part * q[k];
}

/* Subtract from the displacements of each frame the rigid motion that fits them
   best: the rest is the deformation, however far the body has moved. */
static ritz_status deform(motion_chart *m)
{
    const ritz_shapes *first = &m->frame[0].shapes;
    const int64_t n = 3 * first->num_points;
    RITZ_OWN(ritz_dense) R = {0};

    RITZ_CHECK(ritz_dense_new(n, RIGID, &R));
    for (int j = 0; j < RIGID; j++) {
        double *column = ritz_dense_col(&R, j);
        double before = 0.0;

        set_rigid(first, j, column);
        before = dot(n, column, column);
        for (int i = 0; i < j; i++)
            take_out(n, ritz_dense_col(&R, i), column);
        /* rotation about the line on which all points lie moves none of them */
        if (dot(n, column, column) < RITZ_NEGLIGIBLE * before)
            memset(column, 0, (size_t)n * sizeof *column);
        for (int64_t k = 0; k < m->count; k++)
            take_out(n, column, m->frame[k].shapes.u.val);
    }
    return RITZ_OK;
}

static double span(const ritz_shapes *s)
{
    double most = 0.0;

    for (int i = 0; i < 3; i++) {
        double low = HUGE_VAL, high = -HUGE_VAL;

        for (int64_t k = 0; k < s->num_points; k++) {
            low = fmin(low, s->position[3 * k + i]);
            high = fmax(high, s->position[3 * k + i]);
        }
        most = fmax(most, high - low);
    }
    return most;
}

/* The largest displacement is drawn as a twelfth of the body, or less: the scale
   is a number that has one digit. */
static void choose_scale(motion_chart *m)
{
    double most = 0.0;

    m->scale = 1.0;
    for (int64_t k = 0; k < m->count; k++) {
        const ritz_shapes *s = &m->frame[k].shapes;

        for (int64_t i = 0; i < s->num_points; i++)
            most = fmax(most, sqrt(dot(3, s->u.val + 3 * i, s->u.val + 3 * i)));
        for (int64_t i = 0; i < s->num_fields * s->cells.count; i++)
            if (!isnan(s->of_cell[i]))
                m->largest = fmax(m->largest, fabs(s->of_cell[i]));
    }
    if (most > 0.0) {
        const double fits = span(&m->frame[0].shapes) / 12.0 / most;
        const double power = pow(10.0, floor(log10(fits)));

        m->scale = floor(fits / power) * power;
    }
}

/* ---- lines -------------------------------------------------------------- */

/* Project a displaced point on the picture; the view is oblique, from above. */
static void project(const double *x, const double *u, double scale,
                    double out[2])
{
    static const double azimuth = -0.9, height = 0.4; /* rad */
    double at[3], along = 0.0;

    for (int i = 0; i < 3; i++)
        at[i] = x[i] + scale * u[i];
    along = cos(azimuth) * at[0] + sin(azimuth) * at[1];
    out[0] = -sin(azimuth) * at[0] + cos(azimuth) * at[1];
    out[1] = cos(height) * at[2] - sin(height) * along;
}

/* Where band k begins. Each ends at four times where the one before it does, the
   last at the largest value: a few members carry most, and the others would
   look alike in bands of equal width. */
static double band_from(const motion_chart *m, int k)
{
    return k > 0 ? ldexp(m->largest, -2 * (BANDS - k)) : 0.0;
}

static int class_of(const motion_chart *m, const ritz_shapes *s, int64_t cell)
{
    const double value =
        s->num_fields > 0 ? fabs(s->of_cell[cell]) : (double)NAN;
    int band = BANDS - 1;

    if (isnan(value) || m->largest == 0.0)
        return 1;
    while (value < band_from(m, band))
        band--;
    return 2 + band;
}

typedef struct box {
    double low[2], high[2];
} box;

static void put_line(const motion_chart *m, int64_t panel, int class,
                     const double from[2], const double to[2], box *b)
{
    fprintf(m->picture->data.file, "%ld\t%d\t%.6g\t%.6g\t%.6g\t%.6g\n", panel,
            class, from[0], from[1], to[0] - from[0], to[1] - from[1]);
    for (int i = 0; i < 2; i++) {
        b->low[i] = fmin(b->low[i], fmin(from[i], to[i]));
        b->high[i] = fmax(b->high[i], fmax(from[i], to[i]));
    }
}

/* All edges of a frame, at rest or deformed. */
static void put_edges(const motion_chart *m, int64_t panel, bool rest, box *b)
{
    const ritz_shapes *s = &m->frame[panel].shapes;
    const double scale = rest ? 0.0 : m->scale;

    for (int64_t k = 0; k < s->cells.count; k++) {
        const int64_t *grid = s->cells.grid + s->cells.first[k];
        const ritz_cell_edges *edges = ritz_cell_edges_of(s->cells.kind[k]);

        for (int i = 0; i < edges->count; i++) {
            double end[2][2];

            for (int j = 0; j < 2; j++) {
                const int64_t at = 3 * grid[edges->end[i][j]];

                project(s->position + at, s->u.val + at, scale, end[j]);
            }
            put_line(m, panel, rest ? 0 : class_of(m, s, k), end[0], end[1], b);
        }
    }
}

/* Ranges of equal scale on both axes, around all that is drawn. */
static void give_ranges(const motion_chart *m, const box *b)
{
    const double wide = PANEL_WIDE - 16.0, high = PANEL_HIGH - 30.0;
    const double unit = 1.04 * fmax((b->high[0] - b->low[0]) / wide,
                                    (b->high[1] - b->low[1]) / high);
    double range[PANELS][4];
    char title[PANELS][PICTURE_WORD];

    for (int64_t k = 0; k < m->count; k++) {
        const double x = 0.5 * (b->low[0] + b->high[0]);
        const double y = 0.5 * (b->low[1] + b->high[1]);

        range[k][0] = x - 0.5 * unit * wide;
        range[k][1] = x + 0.5 * unit * wide;
        range[k][2] = y - 0.5 * unit * high;
        range[k][3] = y + 0.5 * unit * high;
        snprintf(title[k], sizeof title[k], "%.4g s", m->frame[k].seconds);
    }
    picture_give_texts(m->picture, "title", m->count, title[0], sizeof *title);
    picture_give_reals(m->picture, "x_low,x_high,y_low,y_high", m->count,
                       range[0], sizeof *range);
}

/* Three digits, without an exponent up to a million. */
static void write_value(double value, char out[PICTURE_WORD])
{
    char rounded[PICTURE_WORD];

    snprintf(rounded, sizeof rounded, "%.3g", value);
    snprintf(out, PICTURE_WORD, "%.6g", strtod(rounded, NULL));
}

static void give_classes(const motion_chart *m)
{
    const ritz_shapes *s = &m->frame[0].shapes;
    char colour[CLASSES][PICTURE_WORD];
    double wide[CLASSES];

    for (int k = 0; k < CLASSES; k++) {
        snprintf(colour[k], sizeof colour[k], "%s", looks[k].colour);
        wide[k] = looks[k].wide;
    }
    picture_give_texts(m->picture, "class_colour", CLASSES, colour[0],
                       sizeof *colour);
    picture_give_reals(m->picture, "class_wide", CLASSES, wide, sizeof *wide);
    picture_add_sign(m->picture,
                     (picture_sign){.colour = looks[0].colour, .wide = 1.0},
                     "at rest");
    for (int k = m->largest > 0.0 ? 2 : 1; k < CLASSES; k++) {
        const picture_sign sign = {.colour = looks[k].colour,
                                   .wide = looks[k].wide};
        char from[PICTURE_WORD], to[PICTURE_WORD];

        if (k == 1) {
            picture_add_sign(m->picture, sign, "deformed");
            return;
        }
        write_value(band_from(m, k - 2), from);
        write_value(band_from(m, k - 1), to);
        picture_add_sign(m->picture, sign, "|%.40s| %.40s to %.40s",
                         s->field[0], from, to);
    }
}

static void put_rows(const motion_chart *m)
{
    FILE *table = m->picture->table.file;

    fprintf(table, "seconds\tlargest displacement\tlargest value\n");
    for (int64_t k = 0; k < m->count; k++) {
        const ritz_shapes *s = &m->frame[k].shapes;
        double u = 0.0, value = 0.0;

        for (int64_t i = 0; i < s->num_points; i++)
            u = fmax(u, sqrt(dot(3, s->u.val + 3 * i, s->u.val + 3 * i)));
        for (int64_t i = 0; i < s->num_fields * s->cells.count; i++)
            if (!isnan(s->of_cell[i]))
                value = fmax(value, fabs(s->of_cell[i]));
        fprintf(table, "%.6g\t%.4g\t%.4g\n", m->frame[k].seconds, u, value);
    }
}

static ritz_status draw(const char *path, motion_chart *m)
{
    picture *p = m->picture;
    const int64_t rows = (m->count + ACROSS - 1) / ACROSS;
    box b = {{HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL}};

    RITZ_REFUSE_IF(m->frame[0].shapes.cells.count > MOST_LINES,
                   RITZ_ERR_ARGUMENT, "'%s' has more than %d cells to draw",
                   path, (int)MOST_LINES);
    p->wide = ACROSS * PANEL_WIDE;
    p->body = (double)(PANEL_HIGH * rows);
    fprintf(p->data.file, "panel\tclass\tx\ty\tdx\tdy\n");
    for (int64_t k = 0; k < m->count; k++) {
        put_edges(m, k, true, &b);
        put_edges(m, k, false, &b);
    }
    RITZ_REFUSE_IF(!(b.low[0] < HUGE_VAL), RITZ_ERR_ARGUMENT,
                   "'%s' has no cells to draw", path);
    fprintf(p->given.file,
            "panels = %ld\nacross = %d\npanel_wide = %d\npanel_high = %d\n"
            "classes = %d\n",
            m->count, (int)ACROSS, (int)PANEL_WIDE, (int)PANEL_HIGH,
            (int)CLASSES);
    give_ranges(m, &b);
    give_classes(m);
    put_rows(m);
    snprintf(p->note, sizeof p->note,
             "displacements %.15g times as large, less the rigid motion that "
             "fits best",
             m->scale);
    return picture_draw(p, "motion.gp", "Stresses in motion",
                        "a deformed body at four times, coloured by its "
                        "stresses");
}

ritz_status chart_motion(const chart_sources *sources,
                         const chart_request *request, picture *out)
{
    RITZ_OWN(motion_chart) m = {.picture = out};

    (void)request;
    RITZ_REFUSE_IF(sources->count != 1, RITZ_ERR_ARGUMENT,
                   "one motion is drawn, not %ld", sources->count);
    RITZ_CHECK(read_frames(sources, &m));
    RITZ_CHECK(deform(&m));
    choose_scale(&m);
    return draw(sources->file->path, &m);
}
