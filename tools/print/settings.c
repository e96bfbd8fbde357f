/* Units of the settings of joints. */
#include "print/print.h"

#include <stdio.h>
#include <string.h>

/* The length among units such as "kg m s"; those of a model are three words. */
static void find_length(const char *units, char out[RITZ_NAME_SIZE])
{
    const char *first = strchr(units, ' ');
    const char *last = first ? strchr(first + 1, ' ') : NULL;

    if (last)
        (void)snprintf(out, RITZ_NAME_SIZE, "%.*s", (int)(last - first - 1),
                       first + 1);
    else
        (void)snprintf(out, RITZ_NAME_SIZE, "length");
}

void settings_unit(const ritz_sweep *sweep, const char *units,
                   char out[RITZ_NAME_SIZE])
{
    if (sweep->turns)
        (void)snprintf(out, RITZ_NAME_SIZE, "deg");
    else
        find_length(units, out);
}

void settings_say(cli_run *run, const ritz_scene *scene, const char *units,
                  const double *setting)
{
    SINK_ITEMS(run, "joints", k, scene->num_sweeps) {
        const ritz_sweep *sweep = &scene->sweep[k];
        char unit[RITZ_NAME_SIZE];

        settings_unit(sweep, units, unit);
        if (setting)
            sink_field(run, k > 0 ? "" : "joints", "name,setting,unit",
                       "%s at %g %s", sweep->name, setting[k], unit);
        else
            sink_field(run, k > 0 ? "" : "joints", "name,unit", "%s in %s",
                       sweep->name, unit);
    }
}
