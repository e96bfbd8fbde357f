#include "base/alloc.h"
#include "base/text.h"

#include <ritz/model.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

ritz_status ritz_dampers_new(int64_t n, int64_t count, ritz_dampers *out)
{
    RITZ_OWN(ritz_dampers) dampers = {.count = count};

    RITZ_CHECK_NEW(dampers.name, count);
    RITZ_CHECK_NEW(dampers.c, count);
    RITZ_CHECK_NEW(dampers.k, count);
    RITZ_CHECK_NEW(dampers.held_c, count);
    RITZ_CHECK_NEW(dampers.held_k, count);
    RITZ_CHECK(ritz_dense_new(n, count, &dampers.B));
    RITZ_MOVE(*out, dampers);
    return RITZ_OK;
}

/* Copy names and numbers of `from` to places first, first + 1, ... */
static void put_dampers(const ritz_dampers *from, int64_t first,
                        ritz_dampers *to)
{
    size_t bytes = (size_t)from->count * sizeof *from->c;

    memcpy(to->name + first, from->name,
           (size_t)from->count * sizeof *from->name);
    memcpy(to->c + first, from->c, bytes);
    memcpy(to->k + first, from->k, bytes);
    memcpy(to->held_c + first, from->held_c, bytes);
    memcpy(to->held_k + first, from->held_k, bytes);
}

ritz_status ritz_dampers_project(const ritz_dampers *dampers,
                                 const ritz_dense *T, ritz_dampers *out)
{
    RITZ_OWN(ritz_dampers) projected = {0};

    if (dampers->count == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dampers_new(0, dampers->count, &projected));
    put_dampers(dampers, 0, &projected);
    ritz_dense_free(&projected.B);
    RITZ_CHECK(ritz_dense_mul_tn(T, &dampers->B, &projected.B));
    RITZ_MOVE(*out, projected);
    return RITZ_OK;
}

ritz_status ritz_dampers_copy(const ritz_dampers *dampers, ritz_dampers *out)
{
    RITZ_OWN(ritz_dampers) copy = {0};

    if (dampers->count == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dampers_append(dampers, NULL, dampers->B.nrow, 0, &copy));
    RITZ_MOVE(*out, copy);
    return RITZ_OK;
}

/* "owner/name" */
static ritz_status own_name(const char *owner, char name[RITZ_NAME_SIZE])
{
    char whole[2 * RITZ_NAME_SIZE + 2];
    int length = snprintf(whole, sizeof whole, "%s/%s", owner, name);

    RITZ_REFUSE_IF(
        length >= RITZ_NAME_SIZE, RITZ_ERR_ARGUMENT,
        "the damper '%s' of '%s' gets a name of more than %d letters", name,
        owner, RITZ_NAME_SIZE - 1);
    memcpy(name, whole, (size_t)length + 1);
    return RITZ_OK;
}

ritz_status ritz_dampers_append(const ritz_dampers *more, const char *owner,
                                int64_t n, int64_t first, ritz_dampers *dampers)
{
    int64_t count = dampers->count;
    RITZ_OWN(ritz_dampers) all = {0};

    if (more->count == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dampers_new(n, count + more->count, &all));
    if (count > 0)
        put_dampers(dampers, 0, &all);
    ritz_dense_put(&dampers->B, 0, 0, &all.B);
    put_dampers(more, count, &all);
    ritz_dense_put(&more->B, first, count, &all.B);
    for (int64_t k = count; k < all.count && owner; k++)
        RITZ_CHECK(own_name(owner, all.name[k]));
    ritz_dampers_free(dampers);
    RITZ_MOVE(*dampers, all);
    return RITZ_OK;
}

ritz_status ritz_dampers_check(const ritz_dampers *dampers, int64_t n)
{
    RITZ_REFUSE_IF(dampers->count > 0 && (dampers->B.nrow != n ||
                                          dampers->B.ncol != dampers->count),
                   RITZ_ERR_FORMAT,
                   "influence vectors of dampers are %" PRId64 " x %" PRId64
                   ", not %" PRId64 " x %" PRId64,
                   dampers->B.nrow, dampers->B.ncol, n, dampers->count);
    for (int64_t j = 0; j < dampers->count; j++) {
        const char *name = dampers->name[j];

        RITZ_REFUSE_IF(!name[0], RITZ_ERR_FORMAT,
                       "damper %" PRId64 " has no name", j + 1);
        for (int64_t i = 0; i < j; i++)
            RITZ_REFUSE_IF(strcmp(dampers->name[i], name) == 0, RITZ_ERR_FORMAT,
                           "there are two dampers '%s'", name);
        RITZ_REFUSE_IF(!(dampers->c[j] >= 0.0) || !isfinite(dampers->c[j]) ||
                           !isfinite(dampers->k[j]),
                       RITZ_ERR_FORMAT,
                       "damper '%s' has c = %g and k = %g: c is not negative, "
                       "and both are finite",
                       name, dampers->c[j], dampers->k[j]);
        RITZ_REFUSE_IF(
            !isfinite(dampers->held_c[j]) || !isfinite(dampers->held_k[j]),
            RITZ_ERR_FORMAT,
            "what the matrices hold of damper '%s' is not finite", name);
        for (int64_t i = 0; i < n; i++)
            RITZ_REFUSE_IF(
                !isfinite(ritz_dense_col(&dampers->B, j)[i]), RITZ_ERR_FORMAT,
                "the influence vector of damper '%s' is not finite", name);
    }
    return RITZ_OK;
}

int64_t ritz_dampers_find(const ritz_dampers *dampers, const char *name)
{
    const ritz_names names = {"damper", dampers->count, (char *)dampers->name,
                              sizeof *dampers->name};

    return ritz_names_seek(&names, name);
}

ritz_status ritz_dampers_tune(ritz_dampers *dampers, const char *text)
{
    const char *equals = strrchr(text, '=');
    char name[RITZ_NAME_SIZE] = "";
    char number[RITZ_NAME_SIZE] = "";
    char *star = NULL;
    double c = 0.0;
    double k = 0.0;
    int64_t j = -1;
    bool good = equals && equals - text < RITZ_NAME_SIZE &&
                strlen(equals + 1) < sizeof number;

    if (good) {
        memcpy(name, text, (size_t)(equals - text));
        memcpy(number, equals + 1, strlen(equals + 1) + 1);
        star = strchr(number, '*');
        if (star)
            *star++ = '\0';
        good =
            ritz_text_real(number, &c) && (!star || ritz_text_real(star, &k));
    }
    RITZ_REFUSE_IF(!good, RITZ_ERR_ARGUMENT,
                   "'%.80s' is not of the form NAME=C or NAME=C*K", text);
    RITZ_REFUSE_IF(c < 0.0, RITZ_ERR_ARGUMENT,
                   "'%.80s': a damper's c is not negative", text);
    j = ritz_dampers_find(dampers, name);
    if (j < 0)
        return RITZ_ERR_ARGUMENT;
    dampers->c[j] = c;
    dampers->k[j] = star ? k : dampers->k[j];
    return RITZ_OK;
}

void ritz_dampers_free(ritz_dampers *dampers)
{
    RITZ_FREE(dampers->name, dampers->c, dampers->k, dampers->held_c,
              dampers->held_k);
    ritz_dense_free(&dampers->B);
    *dampers = (ritz_dampers){0};
}

/* D += sum (c - held_c) b b', K += sum (k - held_k) b b', dense and sparse. */

/* Entries that b b' of one damper may have in a sparse matrix. */
static const int64_t most_entries = 1000000;

/* Whether there is more than the matrix holds already. */
static bool has_more(int64_t count, const double *value, const double *held)
{
    for (int64_t j = 0; j < count; j++)
        if (value[j] - held[j] != 0.0)
            return true;
    return false;
}

static ritz_status check_coordinates(const ritz_dampers *dampers, int64_t n)
{
    RITZ_REFUSE_IF(dampers->count > 0 && dampers->B.nrow != n,
                   RITZ_ERR_ARGUMENT,
                   "dampers of %" PRId64 " coordinates in a model of %" PRId64,
                   dampers->B.nrow, n);
    return RITZ_OK;
}

/* A += sum (value_j - held_j) b_j b_j', whose two triangles are the same to the
   bit; A then holds them. */
static ritz_status add_influence(const ritz_dampers *dampers,
                                 const double *value, double *held,
                                 ritz_dense *A)
{
    int64_t n = dampers->B.nrow;

    if (has_more(dampers->count, value, held) && !A->val)
        RITZ_CHECK(ritz_dense_new(n, n, A));
    for (int64_t j = 0; j < dampers->count; j++) {
        const double *b = ritz_dense_col(&dampers->B, j);
        double more = value[j] - held[j];

        for (int64_t c = 0; more != 0.0 && c < n; c++)
            for (int64_t r = 0; r < n; r++)
                ritz_dense_col(A, c)[r] += more * (b[r] * b[c]);
        held[j] = value[j];
    }
    return RITZ_OK;
}

ritz_status ritz_dampers_install(ritz_dampers *dampers, ritz_dense *K,
                                 ritz_dense *D)
{
    RITZ_CHECK(check_coordinates(dampers, K->nrow));
    RITZ_CHECK(add_influence(dampers, dampers->c, dampers->held_c, D));
    return add_influence(dampers, dampers->k, dampers->held_k, K);
}

/* sum (value_j - held_j) b_j b_j', sparse, from the few entries of each b. */
static ritz_status outer_product(const ritz_dampers *dampers,
                                 const double *value, const double *held,
                                 ritz_sparse *out)
{
    int64_t n = dampers->B.nrow;
    int64_t count = 0, room[3] = {0};
    RITZ_OWN_ARRAY int64_t *list = NULL, *row = NULL, *col = NULL;
    RITZ_OWN_ARRAY double *val = NULL;

    RITZ_CHECK_NEW(list, n);
    for (int64_t j = 0; j < dampers->count; j++) {
        const double *b = ritz_dense_col(&dampers->B, j);
        int64_t m = 0;

        for (int64_t i = 0; i < n; i++)
            if (b[i] != 0.0)
                list[m++] = i;
        RITZ_REFUSE_IF(m * m > most_entries, RITZ_ERR_ARGUMENT,
                       "damper '%s' moves with %" PRId64
                       " dofs: as a sparse matrix that is too many",
                       dampers->name[j], m);
        for (int64_t k = 0; k < m * m; k++) {
            int64_t r = list[k % m], c = list[k / m];

            RITZ_CHECK_ROOM(row, count, room[0]);
            RITZ_CHECK_ROOM(col, count, room[1]);
            RITZ_CHECK_ROOM(val, count, room[2]);
            row[count] = r;
            col[count] = c;
            val[count++] = (value[j] - held[j]) * (b[r] * b[c]);
        }
    }
    return ritz_sparse_from_triplets(n, n, count, row, col, val, out);
}

/* As of a dense matrix. */
static ritz_status add_sparse(const ritz_dampers *dampers, const double *value,
                              double *held, ritz_sparse *A)
{
    RITZ_OWN(ritz_sparse) part = {0}, sum = {0};

    if (!has_more(dampers->count, value, held))
        return RITZ_OK;
    RITZ_CHECK(outer_product(dampers, value, held, &part));
    if (A->colptr)
        RITZ_CHECK(ritz_sparse_add(1.0, A, 1.0, &part, &sum));
    else
        RITZ_MOVE(sum, part);
    ritz_sparse_free(A);
    RITZ_MOVE(*A, sum);
    memcpy(held, value, (size_t)dampers->count * sizeof *held);
    return RITZ_OK;
}

ritz_status ritz_dampers_install_sparse(ritz_dampers *dampers, ritz_sparse *K,
                                        ritz_sparse *D)
{
    RITZ_CHECK(check_coordinates(dampers, K->nrow));
    RITZ_CHECK(add_sparse(dampers, dampers->c, dampers->held_c, D));
    return add_sparse(dampers, dampers->k, dampers->held_k, K);
}
