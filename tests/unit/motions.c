#include "motions.h"

#include "masses.h"

const ritz_signal motions_step = {.kind = RITZ_SIGNAL_STEP, .amplitude = 1.0};

ritz_status motions_row(int64_t n, const double *m, const double *k,
                        const double *c, motions *out)
{
    const int64_t last = n - 1;
    const int64_t first = 0;
    ritz_status status = RITZ_OK;

    RITZ_TRY(masses_component(n, m, k, c, &out->component));
    RITZ_TRY(masses_io(&out->component, 1, &last, 1, &first));
    RITZ_TRY(ritz_sparse_dense(&out->component.K, &out->K));
    RITZ_TRY(ritz_sparse_dense(&out->component.M, &out->M));
    if (c)
        RITZ_TRY(ritz_sparse_dense(&out->component.D, &out->D));
    out->model = (ritz_second_order){
        .K = &out->K, .M = &out->M, .D = &out->D, .io = &out->component.io};
    out->dense.model = &out->model;
    out->sparse.component = &out->component;
done:
    return status;
}

ritz_status motions_new(bool damped, motions *out)
{
    static const double m[] = {1.0, 2.0, 1.5};
    static const double k[] = {100.0, 50.0, 80.0};
    static const double c[] = {0.5, 0.0, 3.0};

    return motions_row(3, m, k, damped ? c : NULL, out);
}

void motions_free(motions *m)
{
    ritz_component_free(&m->component);
    ritz_dense_free(&m->K);
    ritz_dense_free(&m->M);
    ritz_dense_free(&m->D);
    *m = (motions){0};
}
