/* A scene's answer: what it comes to if it is cut, and its files. */
#include "print/fit.h"

#include <stdlib.h>

static json_t *row_json(const ritz_fitter *fitter, const ritz_fit_row *row)
{
    json_t *object = json_object();
    json_t *orders = json_object();

    for (int64_t k = 0; k < ritz_fitter_bodies(fitter); k++)
        json_object_set_new(orders, ritz_fitter_body(fitter, k),
                            json_integer(row->first[k]));
    json_object_set_new(object, "orders", orders);
    json_object_set_new(object, "columns", json_integer(row->columns));
    json_object_set_new(object, "order",
                        row->order > 0 ? json_integer(row->order)
                                       : json_null());
    json_object_set_new(object, "error", cli_real(row->ratio));
    json_object_set_new(object, "errors", fit_values_json(&row->errors));
    json_object_set_new(object, "feasible", json_boolean(row->feasible));
    if (row->refusal[0])
        json_object_set_new(object, "refused", cli_string(row->refusal));
    return object;
}

/* " %9lld" of each body, or its name in the head. */
static void print_bodies(const ritz_fitter *fitter, const ritz_fit_row *row,
                         int64_t size, char *out)
{
    size_t used = 0;

    out[0] = '\0';
    for (int64_t k = 0; k < ritz_fitter_bodies(fitter); k++) {
        if (used + 16 >= (size_t)size)
            return;
        if (row)
            used += (size_t)snprintf(out + used, (size_t)size - used, " %9lld",
                                     (long long)row->first[k]);
        else
            used += (size_t)snprintf(out + used, (size_t)size - used, " %9.9s",
                                     ritz_fitter_body(fitter, k));
    }
}

/* "        26        20        46     42      0.47 frequency" */
static void say_step(const cli_run *run, const ritz_fitter *fitter,
                     const ritz_fit_row *row)
{
    char orders[256];
    const char *word =
        row->worst < 0 ? ""
                       : ritz_tolerance_word(row->errors.item[row->worst].name);

    print_bodies(fitter, row, sizeof orders, orders);
    if (row->refusal[0])
        cli_say(run, "%s  %8lld refused: %s", orders, (long long)row->columns,
                row->refusal);
    else
        cli_say(run, "%s  %8lld %6lld  %8.2g %s%s", orders,
                (long long)row->columns, (long long)row->order, row->ratio,
                word, row->feasible ? "" : ", not met");
}

/* The fewest columns that do, if they are not all. */
static void say_enough(cli_run *run, const ritz_fitter *fitter,
                       const ritz_fit_path *path)
{
    int64_t last = 0;
    char orders[256] = "";
    size_t used = 0;

    for (int64_t k = 0; k < path->count; k++)
        last = path->row[k].feasible ? k : last;
    if (last == 0)
        return;
    for (int64_t k = 0; k < path->num_bodies && used + 80 < sizeof orders; k++)
        used += (size_t)snprintf(orders + used, sizeof orders - used,
                                 "%s%s to %lld", k > 0 ? ", " : "",
                                 ritz_fitter_body(fitter, k),
                                 (long long)path->row[last].first[k]);
    cli_say(run, "\nThe tolerance holds down to order %lld: cut %s.",
            (long long)path->row[last].order, orders);
}

static void say_path(cli_run *run, const ritz_fitter *fitter,
                     const ritz_fit_path *path)
{
    json_t *array = json_array();
    char bodies[256];
    /* some twenty lines, the first and the last among them */
    const int64_t step = (path->count + 19) / 20;

    print_bodies(fitter, NULL, sizeof bodies, bodies);
    cli_say(run, "\nWith the first columns alone ('order: N' of a body's file "
                 "in a scene):\n");
    cli_say(run, "%s  %8s %6s  %8s of", bodies, "columns", "order", "error");
    for (int64_t k = 0; k < path->count; k++) {
        json_array_append_new(array, row_json(fitter, &path->row[k]));
        if (k % step == 0 || k == path->count - 1)
            say_step(run, fitter, &path->row[k]);
    }
    say_enough(run, fitter, path);
    json_object_set_new(run->report, "path", array);
}

ritz_status fit_body_path(const char *prefix, const char *name,
                          char out[FIT_PATH])
{
    int length = snprintf(out, FIT_PATH, "%s%s.h5", prefix, name);

    RITZ_REFUSE_IF(length < 0 || length >= FIT_PATH, RITZ_ERR_ARGUMENT,
                   "--components '%.40s...' is too long", prefix);
    return RITZ_OK;
}

static ritz_status write_bodies(cli_run *run, const char *prefix,
                                const ritz_scene *scene,
                                const ritz_reduced *body)
{
    ritz_stamp stamp = cli_stamp(run);
    json_t *files = json_array();
    char path[FIT_PATH];

    json_object_set_new(run->report, "component_files", files);
    for (int64_t k = 0; prefix && k < scene->num_components; k++) {
        RITZ_CHECK(fit_body_path(prefix, scene->component[k].name, path));
        RITZ_CHECK(ritz_container_write_reduced(path, &body[k], &stamp));
        json_array_append_new(files, cli_string(path));
    }
    return RITZ_OK;
}

ritz_status fit_write_scene(cli_run *run, const char *prefix,
                            const ritz_scene *scene, ritz_fitter *fitter,
                            const ritz_fit_candidate *chosen)
{
    ritz_status status = RITZ_OK;
    ritz_stamp stamp = cli_stamp(run);
    ritz_system system = {0};
    ritz_fit_path path = {0};
    ritz_reduced *body = NULL;

    RITZ_TRY(ritz_fitter_system(fitter, chosen, &body, &path, &system));
    say_path(run, fitter, &path);
    RITZ_TRY(write_bodies(run, prefix, scene, body));
    if (run->output)
        RITZ_TRY(ritz_container_write_system(run->output, &system, &stamp));
done:
    for (int64_t k = 0; body && k < scene->num_components; k++)
        ritz_reduced_free(&body[k]);
    free(body);
    ritz_fit_path_free(&path);
    ritz_system_free(&system);
    return status;
}
