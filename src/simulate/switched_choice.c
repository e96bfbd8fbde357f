/*
 * The choice of a set at a switch: vectors are taken in the order of their
 * shares of |R|^2, until E > Emin [McDaniel2000, 5.2.12-14].
 *
 * The share of a redundant candidate is that of its part which is orthogonal to
 * the vectors chosen before it, so that shares add up to E.
 *
 * No decision depends on rounding. Shares that agree to twelve digits are a
 * tie: a vector of the present set is preferred, and then the lowest number. If
 * E equals Emin within rounding, a vector of the present set is kept, and no
 * other is added.
 */
#include "simulate/switched.h"

#include "base/tolerances.h"

#include <math.h>
#include <string.h>

/* |A x|; A x is written to `whole`. */
static double whole_size(const ritz_dense *A, const double *x, double *whole)
{
    memset(whole, 0, (size_t)A->nrow * sizeof *whole);
    ritz_motion_gemv(A, 1.0, x, whole);
    return sqrt(ritz_motion_dot(A->nrow, whole, whole));
}

/* V'W M^-1 (B u - K q - D w) */
static void find_force(const ritz_library *library, const double *q,
                       const double *w, const double *u, double *out)
{
    for (int64_t i = 0; i < library->span; i++) {
        double sum = 0.0;

        for (int64_t j = 0; j < library->B.ncol; j++)
            sum += ritz_dense_col(&library->B, j)[i] * u[j];
        for (int64_t j = 0; j < library->n; j++)
            sum -= ritz_dense_col(&library->K, j)[i] * q[j] +
                   ritz_dense_col(&library->D, j)[i] * w[j];
        out[i] = library->scale[i] * sum;
    }
}

/* |M^-1 (B u - K q - D w)|^2 in W; the size of its terms is noted in r. */
static double square_of_force(const ritz_library *library, const double *q,
                              const double *w, const double *u, ritz_residue *r)
{
    const double terms = whole_size(&library->S_k, q, r->whole) +
                         whole_size(&library->S_d, w, r->whole) +
                         whole_size(&library->S_b, u, r->whole);

    r->largest = fmax(r->largest, terms);
    ritz_motion_gemv(&library->S_k, 1.0, q, r->whole);
    ritz_motion_gemv(&library->S_d, 1.0, w, r->whole);
    return ritz_motion_dot(library->S_x.nrow, r->whole, r->whole);
}

void ritz_residue_find(const ritz_library *library, const double *q,
                       const double *w, const double *u, const double *ahead,
                       ritz_residue *r)
{
    const int64_t n = library->span;
    const double moved = whole_size(&library->S_x, w, r->whole);

    r->twice = ahead ? 2.0 : 1.0;
    r->largest = moved;
    r->square = r->twice * moved * moved + square_of_force(library, q, w, u, r);
    find_force(library, q, w, u, r->v);
    for (int64_t i = 0; i < n; i++)
        r->x[i] = library->scale[i] * w[i];
    if (ahead) {
        r->square += square_of_force(library, q, w, ahead, r);
        find_force(library, q, w, ahead, r->ahead);
    }
    if (library->share_of_library)
        r->square = r->twice * ritz_motion_dot(n, r->x, r->x) +
                    ritz_motion_dot(n, r->v, r->v) +
                    ritz_motion_dot(n, r->ahead, r->ahead);
}

static double share_of(const ritz_residue *r, int64_t n, const double *psi,
                       double size)
{
    const double x = ritz_motion_dot(n, psi, r->x) / size;
    const double v = ritz_motion_dot(n, psi, r->v) / size;
    const double ahead = ritz_motion_dot(n, psi, r->ahead) / size;

    return (r->twice * x * x + v * v + ahead * ahead) / r->square;
}

/* Shares of all vectors; -1 if a redundant vector depends on those chosen. */
static void find_shares(const ritz_library *library, const ritz_residue *r,
                        ritz_choosing *c)
{
    const int64_t n = library->span;

    for (int64_t k = 0; k < library->num_vectors; k++) {
        if (!library->redundant) {
            c->share[k] = (r->twice * r->x[k] * r->x[k] + r->v[k] * r->v[k] +
                           r->ahead[k] * r->ahead[k]) /
                          r->square;
            continue;
        }
        const double *psi = ritz_dense_col(&c->rest, k);
        const double size = sqrt(ritz_motion_dot(n, psi, psi));

        c->share[k] = size > RITZ_SWITCH_NEW ? share_of(r, n, psi, size) : -1.0;
    }
}

/* Make all other vectors orthogonal to the chosen one. */
static void deflate(const ritz_library *library, int64_t chosen,
                    ritz_choosing *c)
{
    const int64_t n = library->span;
    const double *psi = ritz_dense_col(&c->rest, chosen);
    const double square = ritz_motion_dot(n, psi, psi);

    for (int64_t k = 0; k < library->num_vectors; k++) {
        double *other = ritz_dense_col(&c->rest, k);
        const double part =
            k == chosen ? 0.0 : ritz_motion_dot(n, psi, other) / square;

        for (int64_t i = 0; i < n; i++)
            other[i] -= part * psi[i];
    }
    for (int64_t i = 0; i < n; i++)
        ritz_dense_col(&c->rest, chosen)[i] = 0.0;
}

/* The vector that is taken next; -1: none is left. */
static int64_t find_best(const ritz_library *library,
                         const ritz_switched *switched, const ritz_choosing *c)
{
    int64_t best = -1;
    double most = -1.0;

    for (int64_t k = 0; k < library->num_vectors; k++) {
        const double favour =
            c->present[k] != 0.0 ? 1.0 + switched->hysteresis : 1.0;

        if (c->next[k] == 0.0 && c->share[k] >= 0.0)
            most = fmax(most, favour * c->share[k]);
    }
    for (int64_t k = 0; k < library->num_vectors; k++) {
        const bool present = c->present[k] != 0.0;
        const double favour = present ? 1.0 + switched->hysteresis : 1.0;

        if (c->next[k] != 0.0 || c->share[k] < 0.0 ||
            favour * c->share[k] < most - RITZ_SWITCH_TIE)
            continue;
        if (best < 0 || (present && c->present[best] == 0.0))
            best = k;
    }
    return best;
}

/* Whether E is large enough that the next vector is not needed. */
static bool is_enough(const ritz_switched *switched, double E, bool present)
{
    const double room = 1.0 - switched->indicator;

    if (!present)
        return E > switched->indicator - RITZ_SWITCH_TIE;
    return E > switched->indicator +
                   fmax(RITZ_SWITCH_TIE, switched->hysteresis * room);
}

void ritz_choose_vectors(const ritz_library *library,
                         const ritz_switched *switched, const ritz_residue *r,
                         ritz_choosing *c)
{
    const size_t size = (size_t)library->num_vectors * sizeof(double);

    memset(c->next, 0, size);
    if (library->redundant)
        memcpy(c->rest.val, library->vector.val, (size_t)library->span * size);
    c->leading = -1;
    c->indicator = 0.0;
    c->fallback = false;
    find_shares(library, r, c);
    while (true) {
        const int64_t best = find_best(library, switched, c);

        if (best >= 0 && c->leading >= 0 &&
            is_enough(switched, c->indicator, c->present[best] != 0.0))
            return;
        if (best < 0)
            break;
        if (c->leading < 0)
            c->leading = best;
        c->next[best] = 1.0;
        c->indicator += c->share[best];
        if (library->redundant) {
            deflate(library, best, c);
            find_shares(library, r, c);
        }
    }
    c->fallback = !is_enough(switched, c->indicator, false);
}

double ritz_present_indicator(const ritz_library *library,
                              const ritz_residue *r, ritz_choosing *c)
{
    double sum = 0.0;

    if (library->redundant)
        memcpy(c->rest.val, library->vector.val,
               (size_t)(library->span * library->num_vectors) * sizeof(double));
    find_shares(library, r, c);
    for (int64_t k = 0; k < library->num_vectors; k++) {
        if (c->present[k] == 0.0 || c->share[k] < 0.0)
            continue;
        sum += c->share[k];
        if (library->redundant) {
            deflate(library, k, c);
            find_shares(library, r, c);
        }
    }
    return sum;
}
