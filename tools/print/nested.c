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
static void say_errors(cli_run *run, const ritz_nested *nested)
{
    enum { ACROSS = 6, WIDTH = 9 };

    for (int64_t k = 0; k < nested->count; k += ACROSS) {
        int64_t end = k + ACROSS < nested->count ? k + ACROSS : nested->count;
        char line[ACROSS * WIDTH + 1] = "";

        for (int64_t i = k; i < end; i++)
            sink_append(line, sizeof line, " %8" PRId64, nested->order[i]);
        cli_say(run, "    %-35s%s", "errors of the first", line);
        for (int64_t j = 0; j < nested->num_errors; j++) {
            const double *value = ritz_dense_col(&nested->value, j);

            line[0] = '\0';
            for (int64_t i = k; i < end; i++)
                if (isnan(value[i])) /* it was not measured */
                    sink_append(line, sizeof line, " %8s", "-");
                else
                    sink_append(line, sizeof line, " %8.1e", value[i]);
            cli_say(run, "      %-33s%s", nested->error[j], line);
        }
    }
}

void nested_describe(cli_run *run, const ritz_nested *nested, int64_t columns)
{
    if (nested->smallest == 0)
        return;
    sink_object(run, "nested");
    sink_field(run, "nested", "smallest",
               "first %" PRId64 " to %" PRId64 " columns (--order N)",
               nested->smallest, columns);
    say_errors(run, nested);
    sink_wholes(run, "order", nested->count, nested->order);
    sink_object(run, "errors");
    for (int64_t j = 0; j < nested->num_errors; j++)
        sink_reals(run, nested->error[j], nested->count,
                   ritz_dense_col(&nested->value, j));
    sink_end(run);
    sink_end(run);
}
