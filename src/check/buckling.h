/* Buckling factors of a model, as checks need them. */
#ifndef RITZ_CHECK_BUCKLING_H
#define RITZ_CHECK_BUCKLING_H

#include <ritz/check.h>

/** Whether K leaves no motion free. */
ritz_status ritz_buckling_held(const ritz_sparse *K, const ritz_sparse *M,
                               bool *held);
ritz_status ritz_buckling_held_dense(const ritz_dense *K, const ritz_dense *M,
                                     bool *held);

/** Factors of one load of a model that is held. */
ritz_status ritz_buckling_dense(const ritz_dense *K, const ritz_dense *KG,
                                ritz_buckling *out);
ritz_status ritz_buckling_sparse(const ritz_sparse *K, const ritz_sparse *KG,
                                 ritz_buckling *out);

/** The same of a model of any size, without LAPACK. */
ritz_status ritz_buckling_iterated(const ritz_sparse *K, const ritz_sparse *KG,
                                   ritz_buckling *out);

#endif
