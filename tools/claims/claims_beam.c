/*
 * A plane beam whose every number is known: Euler-Bernoulli elements with
 * consistent mass along x, dofs 1, 2 and 6 of each grid, perhaps with a rigid
 * body at its right end. Written as files that ritz-import reads.
 */
#include "claims/claims.h"

#include "base/alloc.h"

#include <ritz/base.h>

#include <string.h>

static const char mass[] = ".m.mtx";

enum { NODE = 3, SIDE = 2 * NODE, LEFT = 1, RIGHT = 2 };

typedef struct beam {
    int64_t elements, first;
    double length, modulus, density, area, inertia, offset;
    double tip_mass, tip_inertia, tip_centre;
    const char *clamp, *directions;
    int held; /* ends that are clamped */
} beam;

/* An option of a beam, and the member that it sets: one of three. */
static const struct option {
    const char *name;
    enum { WHOLE, REAL, TEXT } kind;
    size_t place;
} options[] = {
    {"--elements", WHOLE, offsetof(beam, elements)},
    {"--first-grid", WHOLE, offsetof(beam, first)},
    {"--length", REAL, offsetof(beam, length)},
    {"--modulus", REAL, offsetof(beam, modulus)},
    {"--density", REAL, offsetof(beam, density)},
    {"--area", REAL, offsetof(beam, area)},
    {"--inertia", REAL, offsetof(beam, inertia)},
    {"--offset", REAL, offsetof(beam, offset)},
    {"--tip-mass", REAL, offsetof(beam, tip_mass)},
    {"--tip-inertia", REAL, offsetof(beam, tip_inertia)},
    {"--tip-centre", REAL, offsetof(beam, tip_centre)},
    {"--clamp", TEXT, offsetof(beam, clamp)},
    {"--directions", TEXT, offsetof(beam, directions)},
};

static ritz_status take_option(const char *name, const char *value, beam *b)
{
    const size_t count = sizeof options / sizeof *options;
    size_t k = 0;
    void *place = NULL;
    bool good = true;

    while (k < count && strcmp(options[k].name, name) != 0)
        k++;
    RITZ_REFUSE_IF(k == count, RITZ_ERR_FORMAT, "a beam has no '%.40s'", name);
    place = (char *)b + options[k].place;
    switch (options[k].kind) {
    case WHOLE:
        good = ritz_text_whole(value, place);
        break;
    case REAL:
        good = ritz_text_real(value, place);
        break;
    case TEXT:
        *(const char **)place = value;
        break;
    }
    RITZ_REFUSE_IF(!good, RITZ_ERR_FORMAT, "'%.40s' is no number for %s", value,
                   name);
    return RITZ_OK;
}

static ritz_status read_beam(const claims_line *line, beam *b)
{
    static const char *const ends[] = {"none", "left", "right", "both"};

    RITZ_REFUSE_IF(
        line->count < 2 || strchr(line->word[1], '/') || line->count % 2 != 0,
        RITZ_ERR_FORMAT, "a beam has a name, then options and values");
    for (int k = 2; k < line->count; k += 2)
        RITZ_CHECK(take_option(line->word[k], line->word[k + 1], b));
    RITZ_REFUSE_IF(b->elements < 1 || b->elements > 100000, RITZ_ERR_FORMAT,
                   "a beam has 1 to 100000 elements");
    RITZ_REFUSE_IF(b->first < 1 || b->first > INT32_MAX, RITZ_ERR_FORMAT,
                   "the grids of a beam count from 1 or more, not from %ld",
                   b->first);
    RITZ_REFUSE_IF(!b->directions[0] ||
                       strspn(b->directions, "126") != strlen(b->directions) ||
                       strlen(b->directions) > NODE,
                   RITZ_ERR_FORMAT, "directions are some of 126, not '%.40s'",
                   b->directions);
    while (b->held <= (LEFT | RIGHT) && strcmp(b->clamp, ends[b->held]) != 0)
        b->held++;
    RITZ_REFUSE_IF(b->held > (LEFT | RIGHT), RITZ_ERR_FORMAT,
                   "a beam is clamped none, left, right or both, not '%.40s'",
                   b->clamp);
    return RITZ_OK;
}

/* K and M of one element, rows u v theta of its ends. */
static void fill_matrices(const beam *b, double K[SIDE][SIDE],
                          double M[SIDE][SIDE])
{
    static const int bend[4] = {1, 2, 4, 5};
    double l = b->length / (double)b->elements;
    double k = b->modulus * b->inertia / (l * l * l);
    double m = b->density * b->area * l / 420.0;
    const double kb[4][4] = {{12, 6 * l, -12, 6 * l},
                             {6 * l, 4 * l * l, -6 * l, 2 * l * l},
                             {-12, -6 * l, 12, -6 * l},
                             {6 * l, 2 * l * l, -6 * l, 4 * l * l}};
    const double mb[4][4] = {{156, 22 * l, 54, -13 * l},
                             {22 * l, 4 * l * l, 13 * l, -3 * l * l},
                             {54, 13 * l, 156, -22 * l},
                             {-13 * l, -3 * l * l, -22 * l, 4 * l * l}};

    memset(K, 0, sizeof(double[SIDE][SIDE]));
    memset(M, 0, sizeof(double[SIDE][SIDE]));
    for (int64_t i = 0; i < 2; i++)
        for (int64_t j = 0; j < 2; j++) {
            K[NODE * i][NODE * j] =
                (i == j ? 1.0 : -1.0) * b->modulus * b->area / l;
            M[NODE * i][NODE * j] = (i == j ? 140.0 : 70.0) * m;
        }
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            K[bend[i]][bend[j]] = k * kb[i][j];
            M[bend[i]][bend[j]] = m * mb[i][j];
        }
}

/* Geometric stiffness of an element under a tension of one. */
static void fill_tension(const beam *b, double G[SIDE][SIDE])
{
    static const int bend[4] = {1, 2, 4, 5};
    const double l = b->length / (double)b->elements;
    const double g[4][4] = {{36, 3 * l, -36, 3 * l},
                            {3 * l, 4 * l * l, -3 * l, -l * l},
                            {-36, -3 * l, 36, -3 * l},
                            {3 * l, -l * l, -3 * l, 4 * l * l}};

    memset(G, 0, sizeof(double[SIDE][SIDE]));
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            G[bend[i]][bend[j]] = g[i][j] / (30.0 * l);
}

/* Number of a dof among those that stay, -1 if it is held. */
static int64_t row_of(const beam *b, int64_t dof)
{
    static const char letters[] = "126";
    int64_t per_node = (int64_t)strlen(b->directions);
    int64_t node = dof / NODE;
    const char *at = strchr(b->directions, letters[dof % NODE]);

    if (!at || (b->held & LEFT && node == 0) ||
        (b->held & RIGHT && node == b->elements))
        return -1;
    return (node - (b->held & LEFT)) * per_node + (at - b->directions);
}

/*
 * A(i, j) of dofs i >= j, where j belongs to the node of i or the one before:
 * val[6 i + j - 3 (node of i) + 3].
 */
static double *entry_at(double *val, int64_t i, int64_t j)
{
    return &val[SIDE * i + j - i / NODE * NODE + NODE];
}

static void add_elements(const beam *b, double A[SIDE][SIDE], double *val)
{
    for (int64_t e = 0; e < b->elements; e++)
        for (int i = 0; i < SIDE; i++)
            for (int j = 0; j <= i; j++)
                *entry_at(val, NODE * e + i, NODE * e + j) += A[i][j];
}

/* The rigid body at the right end, its centre tip_centre beyond it. */
static void add_tip(const beam *b, double *val)
{
    int64_t i = NODE * b->elements;

    *entry_at(val, i, i) += b->tip_mass;
    *entry_at(val, i + 1, i + 1) += b->tip_mass;
    *entry_at(val, i + 2, i + 2) += b->tip_inertia;
    *entry_at(val, i + 2, i + 1) += b->tip_mass * b->tip_centre;
}

/* The entries of dofs that stay; with no file they are only counted. */
static int64_t put_entries(const beam *b, double *val, FILE *file)
{
    int64_t count = 0;

    for (int64_t i = 0; i < NODE * (b->elements + 1); i++)
        for (int64_t j = i < NODE ? 0 : i / NODE * NODE - NODE; j <= i; j++) {
            int64_t row = row_of(b, i);
            int64_t col = row_of(b, j);

            if (row < 0 || col < 0 || *entry_at(val, i, j) == 0.0)
                continue;
            count++;
            if (file)
                fprintf(file, "%ld %ld %.17g\n", row > col ? row + 1 : col + 1,
                        row > col ? col + 1 : row + 1, *entry_at(val, i, j));
        }
    return count;
}

ritz_status claims_save(const claims_state *state, const char *name,
                        const char *ending, cli_table *table)
{
    char path[2 * PATH_MAX];

    snprintf(path, sizeof path, "%s/%s%s", state->folder, name, ending);
    return ritz_context(cli_table_write(table, path), path);
}

/* A matrix as Matrix Market; that of the mass has the body at the end. */
static ritz_status put_matrix(const claims_state *state, const char *name,
                              const char *ending, const beam *b,
                              double A[SIDE][SIDE])
{
    const int64_t dofs = NODE * (b->elements + 1);
    RITZ_OWN_ARRAY double *val = NULL;
    RITZ_OWN(cli_table) table = {0};
    int64_t n = 0;

    RITZ_CHECK_NEW(val, SIDE * dofs);
    RITZ_CHECK(cli_table_new(&table));
    add_elements(b, A, val);
    if (strcmp(ending, mass) == 0)
        add_tip(b, val);
    for (int64_t i = 0; i < dofs; i++)
        n += row_of(b, i) >= 0;
    fprintf(table.file, "%%%%MatrixMarket matrix coordinate real symmetric\n");
    fprintf(table.file, "%ld %ld %ld\n", n, n, put_entries(b, val, NULL));
    put_entries(b, val, table.file);
    return claims_save(state, name, ending, &table);
}

/* GRID cards, and what each row is. */
static ritz_status put_names(const claims_state *state, const char *name,
                             const beam *b)
{
    static const int direction[NODE] = {1, 2, 6};
    RITZ_OWN(cli_table) grids = {0}, dofs = {0};

    RITZ_CHECK(cli_table_new(&grids));
    RITZ_CHECK(cli_table_new(&dofs));
    for (int64_t k = 0; k <= b->elements; k++)
        fprintf(grids.file, "GRID,%ld,,%.17g,0.,0.\n", b->first + k,
                b->offset + b->length * (double)k / (double)b->elements);
    for (int64_t dof = 0; dof < NODE * (b->elements + 1); dof++)
        if (row_of(b, dof) >= 0)
            fprintf(dofs.file, "%ld %d\n", b->first + dof / NODE,
                    direction[dof % NODE]);
    RITZ_CHECK(claims_save(state, name, ".bdf", &grids));
    return claims_save(state, name, ".dofs", &dofs);
}

ritz_status claims_beam(claims_state *state, const claims_line *line)
{
    beam b = {.first = 1,
              .length = 1.0,
              .modulus = 1.0,
              .density = 1.0,
              .area = 1.0,
              .inertia = 1.0,
              .clamp = "none",
              .directions = "126"};
    double K[SIDE][SIDE], M[SIDE][SIDE], G[SIDE][SIDE];

    RITZ_CHECK(read_beam(line, &b));
    fill_matrices(&b, K, M);
    fill_tension(&b, G);
    RITZ_CHECK(put_matrix(state, line->word[1], ".k.mtx", &b, K));
    RITZ_CHECK(put_matrix(state, line->word[1], mass, &b, M));
    RITZ_CHECK(put_matrix(state, line->word[1], ".g.mtx", &b, G));
    return put_names(state, line->word[1], &b);
}
