/*
 * Loads that act for as long as the model is used: K + sum_k x_k KG_k takes the
 * place of K, so that every method that follows is that of the loaded body.
 */
#include "base/alloc.h"
#include "base/text.h"
#include "import/import.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* "LOAD=X" */
static ritz_status find_preload(const char *text, const ritz_component *c,
                                int64_t *load, double *amount)
{
    const char *mark = strrchr(text, '=');
    const ritz_names names = {.what = "load",
                              .count = c->num_loads,
                              .first = (const char *)c->load,
                              .stride = sizeof *c->load};
    RITZ_OWN_ARRAY char *name = NULL;

    RITZ_REFUSE_IF(!mark || mark == text || !ritz_text_real(mark + 1, amount),
                   RITZ_ERR_ARGUMENT, "'%s' is not of the form LOAD=X", text);
    RITZ_REFUSE_IF(c->num_loads == 0, RITZ_ERR_ARGUMENT,
                   "'%s' needs the geometric stiffness of this load", text);
    RITZ_CHECK_NEW(name, mark - text + 1);
    memcpy(name, text, (size_t)(mark - text));
    return ritz_words_find(&names, name, load);
}

static ritz_status add_preload(const char *text, bool *used,
                               ritz_component *component)
{
    RITZ_OWN(ritz_sparse) sum = {0};
    int64_t k = 0;
    double amount = 0.0;

    RITZ_CHECK(find_preload(text, component, &k, &amount));
    RITZ_REFUSE_IF(used[k], RITZ_ERR_ARGUMENT, "load '%s' is given twice",
                   component->load[k].name);
    used[k] = true;
    RITZ_CHECK(ritz_sparse_add(1.0, &component->K, amount,
                               &component->load[k].KG, &sum));
    ritz_sparse_free(&component->K);
    RITZ_MOVE(component->K, sum);
    return RITZ_OK;
}

ritz_status ritz_import_preload(const ritz_import_request *request,
                                ritz_component *component)
{
    RITZ_OWN_ARRAY bool *used = NULL;

    if (request->num_preloads == 0)
        return RITZ_OK;
    RITZ_CHECK_NEW(used, component->num_loads);
    for (int64_t k = 0; k < request->num_preloads; k++)
        RITZ_CHECK_IN("--preload",
                      add_preload(request->preload[k], used, component));
    return RITZ_OK;
}
