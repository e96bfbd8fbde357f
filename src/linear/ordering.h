/*
 * A fill-reducing order of a sparse symmetric matrix by nested dissection
 * (METIS), which CHOLMOD and MUMPS are both given.
 *
 * The dofs of one grid have the same neighbours. So grids are ordered instead
 * of dofs, which takes a third of the time.
 */
#ifndef RITZ_LINEAR_ORDERING_H
#define RITZ_LINEAR_ORDERING_H

#include <ritz/matrix.h>

/** Smaller matrices are ordered by the library that factors them. */
enum { RITZ_ORDER_FROM = 2000 };

/**
 * Find the order from the pattern of A; its values do not matter.
 *
 * @param[in]  A      n x n, symmetric, both triangles stored
 * @param[out] order  n numbers, to be freed: pivot k is row order[k] of A
 * @return RITZ_ERR_MEMORY
 */
ritz_status ritz_ordering_new(const ritz_sparse *A, int64_t **order);

/* A store of orders, each with the pattern of the matrix that it is for. */
typedef struct ritz_orders ritz_orders;

ritz_status ritz_orders_new(ritz_orders **out);
void ritz_orders_free(ritz_orders **orders);

/** How many orders are stored. */
int64_t ritz_orders_count(const ritz_orders *orders);

/* While a value of this type exists, ritz_ordering_new() of this thread takes the
   order of a pattern from a store if it is there, and stores the orders that it
   finds. K - s M has the same pattern for all shifts s, so that all their factors
   need one order. */
typedef struct ritz_orders_lent {
    ritz_orders *before;
} ritz_orders_lent;

/** Lend a store to this thread, until ritz_orders_lent_free(), which RITZ_OWN
 * calls. @param[in] orders  NULL: no order is stored until then */
ritz_orders_lent ritz_orders_lend(ritz_orders *orders);
void ritz_orders_lent_free(ritz_orders_lent *scope);

/** A tree of substructures. The rows of a node separate those of the subtrees
 * below it from each other: A(i, j) = 0 unless the node of i is that of j, or an
 * ancestor or a descendant of it. */
typedef struct ritz_dissection {
    int64_t rows, nodes;
    int64_t *row;    /* rows of A, node by node */
    int64_t *first;  /* node s has row[first[s]] to row[first[s + 1] - 1] */
    int64_t *parent; /* of each node; -1: none */
    int64_t *begin;  /* the subtree of node s is the nodes begin[s] to s */
} ritz_dissection;

/**
 * Dissect the pattern of A (METIS) until no more than about @p leaf rows are
 * left in a leaf. Parts that are not connected become subtrees without a common
 * parent, or with one that has no rows.
 *
 * @param[in]  A    n x n, symmetric, both triangles stored
 * @param[out] out  freed by ritz_dissection_free()
 * @return RITZ_ERR_MEMORY
 */
ritz_status ritz_dissection_new(const ritz_sparse *A, int64_t leaf,
                                ritz_dissection *out);

void ritz_dissection_free(ritz_dissection *D);

#endif
