/* Beams with consistent mass in inertia invariants: see the header. */
#include "model/invariants_beams.h"

#include "base/alloc.h"
#include "base/search.h"
#include "base/team.h"
#include "base/tolerances.h"
#include "base/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

double ritz_shared_directions(const double *axes_i, const int64_t *row_i,
                              const double *axes_j, const int64_t *row_j)
{
    double sum = 0.0;

    for (int64_t p = 0; p < 3; p++)
        for (int64_t q = 0; q < 3; q++)
            if (row_i[p] >= 0 && row_j[q] >= 0) {
                const double cosine =
                    axes_i == axes_j ? (double)(p == q)
                                     : ritz_dot(axes_i + 3 * p, axes_j + 3 * q);

                sum += cosine * cosine;
            }
    return fmax(sum, 1.0);
}

/* ---- pairs of nodes ----------------------------------------------------- */

static int compare_nodes(const void *left, const void *right)
{
    const ritz_beam *a = left;
    const ritz_beam *b = right;

    for (int k = 0; k < 2; k++)
        if (a->node[k] != b->node[k])
            return a->node[k] < b->node[k] ? -1 : 1;
    return 0;
}

/* Set the axis, the length, and the rows and axes of both nodes. */
static void lay_out(const ritz_nodes *nodes, const int64_t *row,
                    ritz_beam *beam)
{
    const double *x = nodes->grids->position;
    double square = 0.0;

    for (int k = 0; k < 2; k++) {
        const int64_t node = beam->node[k];

        beam->axes[k] = ritz_nodes_axes(nodes, node < 0 ? beam->node[1] : node);
        for (int p = 0; p < 6; p++)
            beam->row[k][p] = node < 0 ? -1 : row[6 * node + p];
    }
    for (int a = 0; a < 3; a++) {
        beam->e[a] = x[3 * beam->grid[1] + a] - x[3 * beam->grid[0] + a];
        square += beam->e[a] * beam->e[a];
    }
    beam->L = sqrt(square);
    for (int a = 0; a < 3; a++)
        beam->e[a] /= beam->L;
}

/* Sort the pairs, keep each once, and drop those of length 0. A node that
   several cells join to grids without dofs is dropped too: its own block is the
   sum of several beams, which cannot be told apart. */
static void order_pairs(const ritz_nodes *nodes, const int64_t *row,
                        ritz_beams *list)
{
    int64_t kept = 0;

    if (list->count > 0)
        qsort(list->beam, (size_t)list->count, sizeof *list->beam,
              compare_nodes);
    for (int64_t k = 0; k < list->count; k++) {
        ritz_beam *last = kept > 0 ? &list->beam[kept - 1] : NULL;

        if (last && compare_nodes(last, &list->beam[k]) == 0) {
            if (last->grid[0] != list->beam[k].grid[0])
                last->L = 0.0;
            continue;
        }
        if (last && !(last->L > 0.0))
            kept--;
        list->beam[kept] = list->beam[k];
        lay_out(nodes, row, &list->beam[kept++]);
    }
    if (kept > 0 && !(list->beam[kept - 1].L > 0.0))
        kept--;
    list->count = kept;
}

/* Append the pair of a line cell if at least one of its grids has dofs. */
static void add_pair(const ritz_nodes *nodes, const int64_t *id,
                     ritz_beams *list)
{
    ritz_beam beam = {0};
    int64_t node[2];
    int64_t grid[2];
    int first = 0;

    for (int k = 0; k < 2; k++) {
        grid[k] = ritz_grids_find(nodes->grids, id[k]);
        node[k] =
            grid[k] < 0 ? -1 : ritz_search(nodes->count, nodes->grid, grid[k]);
    }
    if (grid[0] < 0 || grid[1] < 0 || node[0] == node[1])
        return;
    first = node[0] < node[1] ? 0 : 1;
    for (int k = 0; k < 2; k++) {
        beam.node[k] = node[k == 0 ? first : 1 - first];
        beam.grid[k] = grid[k == 0 ? first : 1 - first];
    }
    list->beam[list->count++] = beam;
}

ritz_status ritz_beams_list(const ritz_elements *elements,
                            const ritz_nodes *nodes, const int64_t *row,
                            ritz_beams *out)
{
    RITZ_OWN(ritz_beams) list = {0};
    int64_t lines = 0;

    for (int64_t k = 0; k < elements->count; k++)
        lines += elements->kind[k] == RITZ_CELL_LINE;
    RITZ_CHECK_NEW(list.beam, lines);
    for (int64_t k = 0; k < elements->count; k++)
        if (elements->kind[k] == RITZ_CELL_LINE)
            add_pair(nodes, elements->grid + elements->first[k], &list);
    order_pairs(nodes, row, &list);
    RITZ_MOVE(*out, list);
    return RITZ_OK;
}

ritz_beam *ritz_beams_find(const ritz_beams *beams, int64_t i, int64_t j)
{
    const ritz_beam wanted = {.node = {i < j ? i : j, i < j ? j : i}};

    if (beams->count == 0)
        return NULL;
    return bsearch(&wanted, beams->beam, (size_t)beams->count,
                   sizeof *beams->beam, compare_nodes);
}

void ritz_beams_keep(ritz_beams *beams)
{
    int64_t kept = 0;

    for (int64_t k = 0; k < beams->count; k++)
        if (beams->beam[k].mu > 0.0)
            beams->beam[kept++] = beams->beam[k];
    beams->count = kept;
}

void ritz_beams_free(ritz_beams *beams)
{
    free(beams->beam);
    *beams = (ritz_beams){0};
}

/* ---- integrals of the shape functions ----------------------------------- */

enum { ALONG, ACROSS, SLOPE, FUNCTIONS }; /* n, H, K */

/* integral[f][g][i][j] = 420 int_0^1 f_i g_j dxi, with f and g among n, H, K,
   of ends i and j. */
static const double integral[FUNCTIONS][FUNCTIONS][2][2] = {
    [ALONG] = {{{140, 70}, {70, 140}},
               {{147, 63}, {63, 147}},
               {{21, -14}, {14, -21}}},
    [ACROSS] = {{{147, 63}, {63, 147}},
                {{156, 54}, {54, 156}},
                {{22, -13}, {13, -22}}},
    [SLOPE] = {{{21, 14}, {-14, -21}},
               {{22, 13}, {-13, -22}},
               {{4, -3}, {-3, 4}}},
};

static double term(const ritz_beam *beam, int f, int i, int g, int j)
{
    return beam->mu * integral[f][g][i][j] / 420.0;
}

/* ---- whether a pair is a beam ------------------------------------------- */

/* The matrices that a beam's block is a combination of, where rotations are
   multiplied by L: mu (COUPLING + BENDING), and any multiples of TORSION, e e'
   of rotations, AXIS, e e' of translations, and EVEN, I of translations. */
enum { COUPLING, BENDING, TORSION, AXIS, EVEN, PARTS };

/*
 * One of these matrices, for unit mass and along basic axes, with rows of node
 * i and columns of node j. `own`: i = j. e points from i to the other node.
 */
static void fill_part(int part, bool own, const double *e, double B[6][6])
{
    const double u = part != BENDING ? 0.0 : own ? 156.0 : 54.0;
    const double t = part != BENDING ? 0.0 : own ? 4.0 : -3.0;
    const double tu = part != COUPLING ? 0.0 : own ? 22.0 : 13.0;
    const double ut = own ? -tu : tu;

    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            const double unit = a == b ? 1.0 : 0.0;
            const double axis = e[a] * e[b];
            double skew = 0.0;

            if (a != b)
                skew = (b + 1) % 3 == a ? e[3 - a - b] : -e[3 - a - b];
            B[a][b] = u / 420.0 * (unit - axis);
            B[3 + a][3 + b] = t / 420.0 * (unit - axis);
            B[a][3 + b] = ut / 420.0 * skew;
            B[3 + a][b] = tu / 420.0 * skew;
            if (part == AXIS || part == EVEN)
                B[a][b] = part == AXIS ? axis : unit;
            if (part == TORSION)
                B[3 + a][3 + b] = axis;
        }
}

/* Transform a block from basic axes to those of nodes i and j; entries of
   absent dofs are 0. */
static void turn_block(const ritz_beam *beam, int i, int j,
                       const double B[6][6], double out[36])
{
    for (int64_t p = 0; p < 6; p++)
        for (int64_t q = 0; q < 6; q++) {
            const double *ap = beam->axes[i] + 3 * (p % 3);
            const double *aq = beam->axes[j] + 3 * (q % 3);
            double sum = 0.0;

            if (beam->row[i][p] >= 0 && beam->row[j][q] >= 0)
                for (int64_t a = 0; a < 3; a++)
                    sum += ap[a] * ritz_dot(&B[p / 3 * 3 + a][q / 3 * 3], aq);
            out[6 * p + q] = sum;
        }
}

/* All parts of the block i, j, along the axes of its nodes. */
static void fill_parts(const ritz_beam *beam, int i, int j,
                       double part[PARTS][36])
{
    double e[3];

    for (int a = 0; a < 3; a++)
        e[a] = i == 0 ? beam->e[a] : -beam->e[a];
    for (int k = 0; k < PARTS; k++) {
        double B[6][6];

        fill_part(k, i == j, e, B);
        turn_block(beam, i, j, B, part[k]);
    }
}

static double dot_blocks(const double *A, const double *B)
{
    double sum = 0.0;

    for (int k = 0; k < 36; k++)
        sum += A[k] * B[k];
    return sum;
}

static void take_out(double factor, const double *part, double *block)
{
    for (int k = 0; k < 36; k++)
        block[k] -= factor * part[k];
}

/* The factor of a part in a block, in the sense of least squares. */
static double factor_of(const double *part, const double *block)
{
    const double square = dot_blocks(part, part);

    return square > 0.0 ? dot_blocks(part, block) / square : 0.0;
}

/*
 * Subtract a e e' + d I, fitted by least squares, from the translations; return
 * a. Where the nodes share no direction along the axis, a stays as given, and
 * where they share no other, d is 0.
 */
static double take_even(const double *axis, const double *even, double a,
                        double *block)
{
    const double aa = dot_blocks(axis, axis);
    const double ad = dot_blocks(axis, even);
    const double dd = dot_blocks(even, even);
    const double ab = dot_blocks(axis, block);
    const double db = dot_blocks(even, block);
    const double det = aa * dd - ad * ad;
    double d = 0.0;

    if (det > RITZ_BEAM_FITS * aa * dd) {
        a = (dd * ab - ad * db) / det;
        d = (aa * db - ad * ab) / det;
    } else if (aa > RITZ_BEAM_FITS * dd) {
        a = ab / aa;
    } else if (dd > 0.0) {
        d = db / dd;
    }
    take_out(a, axis, block);
    take_out(d, even, block);
    return a;
}

/* Factor of entry k of a block where rotations are multiplied by L. */
static double scale_of(const ritz_beam *beam, int k)
{
    return (k / 6 < 3 ? 1.0 : 1.0 / beam->L) *
           (k % 6 < 3 ? 1.0 : 1.0 / beam->L);
}

/* The mass of a beam from its block of nodes i and j, and in `axial` the term
 * of s_i with s_j. @return 0 if the block is not that of a beam */
static double fit_block(const ritz_beam *beam, int i, int j,
                        const double *block, double *axial)
{
    double part[PARTS][36], rest[36];
    double mu = 0.0, size = 0.0;

    fill_parts(beam, i, j, part);
    for (int k = 0; k < 36; k++)
        rest[k] = block[k] * scale_of(beam, k);
    mu = factor_of(part[COUPLING], rest);
    if (!(mu > 0.0))
        return 0.0;
    size = mu * sqrt(dot_blocks(part[COUPLING], part[COUPLING]));
    take_out(mu, part[COUPLING], rest);
    take_out(mu, part[BENDING], rest);
    take_out(factor_of(part[TORSION], rest), part[TORSION], rest);
    *axial = take_even(part[AXIS], part[EVEN],
                       mu * integral[ALONG][ALONG][i][j] / 420.0, rest);
    return sqrt(dot_blocks(rest, rest)) > RITZ_BEAM_FITS * size ? 0.0 : mu;
}

void ritz_beam_fit(int column, const double block[static 36], ritz_beam *beam)
{
    double axial = 0.0;
    const double mu = fit_block(beam, 1 - column, column, block, &axial);

    if (!(mu > 0.0))
        return;
    beam->mu = mu;
    beam->axial = axial;
    beam->known[column] = true;
}

/* The term of s_i with s_j. Terms of s_1 and of s_2 with s_j add up to half of
   the mass. */
static double axial_term(const ritz_beam *beam, int i, int j)
{
    return i == j ? beam->mu / 2.0 - beam->axial : beam->axial;
}

void ritz_beam_fit_held(const double block[static 36], ritz_beam *beam)
{
    double axial = 0.0;

    beam->mu = fit_block(beam, 1, 1, block, &axial);
    beam->axial = beam->mu / 2.0 - axial;
    beam->known[1] = beam->mu > 0.0;
}

void ritz_beam_take_out(const ritz_beam *beam, int end, double block[36])
{
    double part[PARTS][36];

    fill_parts(beam, end, end, part);
    for (int k = 0; k < 36; k++)
        block[k] -= (beam->mu * (part[COUPLING][k] + part[BENDING][k]) +
                     axial_term(beam, end, end) * part[AXIS][k]) /
                    scale_of(beam, k);
}

/* ---- terms that the form of invariants_mass.h lacks ---------------------- */

/* Whether the block i, j of the beam is in M. */
static bool has_block(const ritz_beam *beam, int i, int j)
{
    return beam->node[i] >= 0 && beam->known[j];
}

/* The m that invariants_mass.h takes from block i, j of the beam. If both nodes
   have all translations, it is a third of the trace of
   along e e' + across (I - e e'). */
static double mean_term(const ritz_beam *beam, int i, int j)
{
    const double across = term(beam, ACROSS, i, ACROSS, j);
    const double along = axial_term(beam, i, j);
    double even = 0.0;
    double axis = 0.0;

    for (int64_t p = 0; p < 3; p++)
        for (int64_t q = 0; q < 3; q++) {
            const double *ap = beam->axes[i] + 3 * p;
            const double *aq = beam->axes[j] + 3 * q;
            const double cosine = ritz_dot(ap, aq);

            if (beam->row[i][p] < 0 || beam->row[j][q] < 0)
                continue;
            even += cosine * cosine;
            axis += ritz_dot(beam->e, ap) * ritz_dot(beam->e, aq) * cosine;
        }
    return (across * even + (along - across) * axis) / fmax(even, 1.0);
}

/*
 * C of one beam, in the order of the rows of S. The exact integral is that of
 *
 *     (e n_i s_i + H_i l_i + L K_i t_i)_a (e n_j s_j + H_j l_j + L K_j t_j)_b
 *
 * invariants_mass.h has m (s_i + l_i)_a (s_j + l_j)_b in place of the terms of
 * s and l, uses the term of l with t for that of s with t, and has the right
 * term of t with t. C is the difference.
 */
static void fill_weights(const ritz_beam *beam, double C[6][6])
{
    memset(C, 0, 36 * sizeof C[0][0]);
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++) {
            const double m = mean_term(beam, i, j);

            if (!has_block(beam, i, j))
                continue;
            C[i][j] = axial_term(beam, i, j) - m;
            C[i][2 + j] = term(beam, ALONG, i, ACROSS, j) - m;
            C[2 + i][j] = term(beam, ACROSS, i, ALONG, j) - m;
            C[2 + i][2 + j] = term(beam, ACROSS, i, ACROSS, j) - m;
            C[i][4 + j] = beam->L * (term(beam, ALONG, i, SLOPE, j) -
                                     term(beam, ACROSS, i, SLOPE, j));
            C[4 + i][j] = beam->L * (term(beam, SLOPE, i, ALONG, j) -
                                     term(beam, SLOPE, i, ACROSS, j));
        }
}

/* Coefficients of the six dofs of node i in e_a s_i, l_ia and t_ia. */
static void fill_factors(const ritz_beam *beam, int i, int a, double out[3][6])
{
    const double *e = beam->e;
    const int b = (a + 1) % 3;
    const int c = (a + 2) % 3;

    memset(out, 0, 18 * sizeof out[0][0]);
    for (int64_t p = 0; p < 3; p++) {
        const double *axis = beam->axes[i] + 3 * p;

        out[0][p] = e[a] * ritz_dot(e, axis);
        out[1][p] = axis[a] - out[0][p];
        out[2][3 + p] = axis[b] * e[c] - axis[c] * e[b];
    }
}

typedef struct beams_task {
    const ritz_beams *beams;
    const ritz_dense *in;
    int a;
    ritz_dense *out;
} beams_task;

static void take_along(int thread, int64_t from, int64_t to, void *task)
{
    const beams_task *t = task;

    (void)thread;
    for (int64_t n = 0; n < 2 * t->beams->count; n++) {
        const ritz_beam *beam = &t->beams->beam[n / 2];
        const int i = (int)(n % 2);
        double factor[3][6];

        fill_factors(beam, i, t->a, factor);
        for (int64_t k = from; k < to; k++) {
            const double *u = ritz_dense_col(t->in, k);
            double *S = ritz_dense_col(t->out, k) + n / 2 * 6 + i;

            for (int p = 0; p < 6; p++)
                if (beam->row[i][p] >= 0)
                    for (int64_t part = 0; part < 3; part++)
                        S[2 * part] += factor[part][p] * u[beam->row[i][p]];
        }
    }
}

static void take_weighed(int thread, int64_t from, int64_t to, void *task)
{
    const beams_task *t = task;

    (void)thread;
    for (int64_t n = 0; n < t->beams->count; n++) {
        double C[6][6];

        fill_weights(&t->beams->beam[n], C);
        for (int64_t k = from; k < to; k++) {
            const double *S = ritz_dense_col(t->in, k) + 6 * n;
            double *CS = ritz_dense_col(t->out, k) + 6 * n;

            for (int i = 0; i < 6; i++)
                for (int j = 0; j < 6; j++)
                    CS[i] += C[i][j] * S[j];
        }
    }
}

static ritz_status run(ritz_team_range *work, beams_task task, ritz_dense *out)
{
    enum { WORTHWHILE = 50000 }; /* entries of `out` for each further thread */
    RITZ_OWN(ritz_dense) made = {0};
    const int64_t count = 6 * task.beams->count;

    RITZ_CHECK(ritz_dense_new(count, task.in->ncol, &made));
    task.out = &made;
    ritz_team_over(ritz_team_ready(1 + count * made.ncol / WORTHWHILE),
                   made.ncol, work, &task);
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

ritz_status ritz_beams_along(const ritz_beams *beams, const ritz_dense *T,
                             int a, ritz_dense *out)
{
    return run(take_along, (beams_task){beams, T, a, NULL}, out);
}

ritz_status ritz_beams_weigh(const ritz_beams *beams, const ritz_dense *S,
                             ritz_dense *out)
{
    return run(take_weighed, (beams_task){beams, S, 0, NULL}, out);
}

/*
 * The position of a point of the beam is its motion if u_i = x_i and t_i = 0,
 * so `at` holds the rows of S for that motion, to be multiplied by C S.
 * invariants_mass.h also multiplies the arms of t_i, here e_a L K_i, with the
 * motion: `arm` subtracts these integrals.
 */
static void fill_places(const ritz_beam *beam, const ritz_nodes *nodes, int a,
                        double *at, double *arm)
{
    const double e = beam->e[a];
    const double L = beam->L;

    for (int j = 0; j < 2; j++) {
        const double *x = nodes->grids->position + 3 * beam->grid[j];
        const double s = e * ritz_dot(beam->e, x);

        at[j] = s;
        at[2 + j] = x[a] - s;
        for (int i = 0; i < 2; i++) {
            if (!has_block(beam, i, j))
                continue;
            arm[j] -= e * L * term(beam, SLOPE, i, ACROSS, j);
            arm[4 + j] -= e * L * L * term(beam, SLOPE, i, SLOPE, j);
        }
        arm[2 + j] = arm[j];
    }
}

ritz_status ritz_beams_place(const ritz_beams *beams, const ritz_nodes *nodes,
                             const ritz_dense *S, const ritz_dense *CS,
                             ritz_dense *out)
{
    RITZ_OWN(ritz_dense) at = {0}, arm = {0}, more = {0};

    RITZ_CHECK(ritz_dense_new(6 * beams->count, 3, &at));
    RITZ_CHECK(ritz_dense_new(6 * beams->count, 3, &arm));
    for (int a = 0; a < 3; a++)
        for (int64_t n = 0; n < beams->count; n++)
            fill_places(&beams->beam[n], nodes, a,
                        ritz_dense_col(&at, a) + 6 * n,
                        ritz_dense_col(&arm, a) + 6 * n);
    RITZ_CHECK(ritz_dense_mul_tn(&at, CS, out));
    RITZ_CHECK(ritz_dense_mul_tn(&arm, S, &more));
    ritz_dense_add(1.0, &more, out);
    return RITZ_OK;
}
