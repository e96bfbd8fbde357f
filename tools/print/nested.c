#include "print/nested.h"

#include <ritz/nested.h>

#include <inttypes.h>
#include <math.h>

ritz_status nested_take(const char *path, int64_t order, model *m)
{
    ritz_reduced prefix = {0};

    if (order == 0)
        return RITZ_OK;
    RITZ_REFUSE_IF(m->kind != MODEL_REDUCED, RITZ_ERR_ARGUMENT,
                   "'%s' is no reduced component, --order has no columns to "
                   "choose from",
                   path);
    RITZ_CHECK_IN(path, ritz_reduced_prefix(&m->reduced, order, &prefix));
    ritz_reduced_free(&m->reduced);
    m->reduced = prefix;
    return RITZ_OK;
}

/* A row a measure and a column an order, some orders at a time. */
static void say_errors(const cli_run *run, const ritz_nested *nested)
{
    enum { ACROSS = 6, WIDTH = 9 };

    for (int64_t k = 0; k < nested->count; k += ACROSS) {
        int64_t end = k + ACROSS < nested->count ? k + ACROSS : nested->count;
        char line[ACROSS * WIDTH + 1] = "";
        size_t used = 0;

        for (int64_t i = k; i < end; i++)
            used += (size_t)snprintf(line + used, sizeof line - used,
                                     " %8" PRId64, nested->order[i]);
        cli_say(run, "    %-35s%s", "errors of the first", line);
        for (int64_t j = 0; j < nested->num_errors; j++) {
            const double *value = ritz_dense_col(&nested->value, j);

            used = 0;
            for (int64_t i = k; i < end; i++)
                used += isnan(value[i]) /* it was not measured */
                            ? (size_t)snprintf(line + used, sizeof line - used,
                                               " %8s", "-")
                            : (size_t)snprintf(line + used, sizeof line - used,
                                               " %8.1e", value[i]);
            cli_say(run, "      %-33s%s", nested->error[j], line);
        }
    }
}

void nested_describe(const cli_run *run, json_t *keys,
                     const ritz_nested *nested, int64_t columns)
{
    json_t *group = json_object();
    json_t *orders = json_array();
    json_t *errors = json_object();

    if (nested->smallest == 0) {
        json_decref(group);
        json_decref(orders);
        json_decref(errors);
        return;
    }
    cli_say(run, "  %-14s first %" PRId64 " to %" PRId64 " columns (--order N)",
            "nested", nested->smallest, columns);
    say_errors(run, nested);
    for (int64_t k = 0; k < nested->count; k++)
        json_array_append_new(orders, json_integer(nested->order[k]));
    for (int64_t j = 0; j < nested->num_errors; j++) {
        json_object_set_new(
            errors, nested->error[j],
            model_reals_json(nested->count, ritz_dense_col(&nested->value, j)));
    }
    json_object_set_new(group, "smallest", json_integer(nested->smallest));
    json_object_set_new(group, "order", orders);
    json_object_set_new(group, "errors", errors);
    json_object_set_new(keys, "nested", group);
}
