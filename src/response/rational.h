/* The rational engine while its nodes are chosen: see response_rational.c. */
#ifndef RITZ_RESPONSE_RATIONAL_H
#define RITZ_RESPONSE_RATIONAL_H

#include "poles/spectrum_parts.h"
#include "response/direct.h"
#include "response/interpolant.h"
#include "response/responder.h"

/* So many nodes in a row are within the tolerance at the end. */
enum { RITZ_RATIONAL_ENOUGH = 3 };

typedef struct ritz_nodes {
    ritz_direct full;
    ritz_interpolant poles; /* those alone are cancelled */
    ritz_interpolant both;  /* and zeros, where there are any */
    int64_t num_poles;
    double _Complex *pole; /* all, conjugates too */
    bool mirror;           /* nodes count at -i w too */
    int64_t values;
    int64_t count; /* of candidates */
    double *hertz;
    bool *used;
    bool *with_zeros;        /* values: which of the two is nearer */
    double *missed;          /* 2 x values: most by either at the last nodes */
    double *miss;            /* 2 x values of each of those */
    const ritz_noise *noise; /* of the responder */
    double *peak, *level, *scale;
    double _Complex *H, *guess, *other;
    int64_t nodes;
    bool small; /* `whole` is there */
    ritz_whole whole;
} ritz_nodes;

/**
 * Poles that are cancelled; of small components the dense model they are found
 * with.
 */
ritz_status ritz_nodes_find_poles(ritz_nodes *nodes,
                                  const ritz_responder *responder);

/** Zeros of each channel of that model. */
ritz_status ritz_nodes_find_zeros(ritz_nodes *nodes);

/** Candidates between two frequencies, Hz. */
ritz_status ritz_nodes_place(ritz_nodes *nodes, double low, double high);

/** Nodes until the last were within the tolerance. */
ritz_status ritz_nodes_converge(ritz_nodes *nodes, double tolerance);

#endif
