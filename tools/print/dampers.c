#include "print/dampers.h"

ritz_dampers *dampers_of(model *m)
{
    if (m->kind == MODEL_COMPONENT)
        return &m->component.dampers;
    return m->at ? &m->at->dampers : &m->reduced.dampers;
}

ritz_status dampers_tune(model *m, const cli_list *texts)
{
    for (int k = 0; texts && k < texts->count; k++)
        RITZ_CHECK_IN("--damper",
                      ritz_dampers_tune(dampers_of(m), texts->text[k]));
    return RITZ_OK;
}

ritz_status dampers_install(model *m, const cli_list *texts)
{
    RITZ_CHECK(dampers_tune(m, texts));
    if (m->kind == MODEL_COMPONENT)
        RITZ_CHECK(ritz_component_install(&m->component));
    else if (m->at)
        RITZ_CHECK(ritz_configuration_install(m->at));
    else
        RITZ_CHECK(ritz_reduced_install(&m->reduced));
    return RITZ_OK;
}

ritz_status dampers_keep(const model *m, dampers_bare *out)
{
    const ritz_reduced *r = &m->reduced;

    if (m->kind != MODEL_REDUCED)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_copy(&r->K, &out->K));
    if (r->D.val)
        RITZ_CHECK(ritz_dense_copy(&r->D, &out->D));
    return ritz_dampers_copy(&r->dampers, &out->dampers);
}

void dampers_restore(model *m, dampers_bare *bare)
{
    if (m->kind != MODEL_REDUCED)
        return;
    ritz_dense_free(&m->reduced.K);
    ritz_dense_free(&m->reduced.D);
    ritz_dampers_free(&m->reduced.dampers);
    m->reduced.K = bare->K;
    m->reduced.D = bare->D;
    m->reduced.dampers = bare->dampers;
    *bare = (dampers_bare){0};
}

void dampers_bare_free(dampers_bare *bare)
{
    ritz_dense_free(&bare->K);
    ritz_dense_free(&bare->D);
    ritz_dampers_free(&bare->dampers);
}
