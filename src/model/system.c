#include <ritz/model.h>

#include "base/alloc.h"
#include "base/tolerances.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void ritz_configuration_name(int64_t count, const char *sweep, size_t stride,
                             const double *setting, char out[RITZ_NAME_SIZE])
{
    size_t used = 0;

    out[0] = '\0';
    for (int64_t k = 0; k < count && used < RITZ_NAME_SIZE; k++)
        used += (size_t)snprintf(out + used, RITZ_NAME_SIZE - used, "%s%s=%.9g",
                                 k > 0 ? "," : "", sweep + (size_t)k * stride,
                                 setting[k]);
    if (count == 0)
        snprintf(out, RITZ_NAME_SIZE, "fixed");
}

/* Read one part, "clock=60", of a configuration's name. */
static ritz_status read_part(const ritz_system *system, const char *part,
                             double *wanted)
{
    const char *equals = strchr(part, '=');
    size_t length = equals ? (size_t)(equals - part) : 0;
    double setting = 0.0;

    RITZ_REFUSE_IF(!equals || !ritz_text_real(equals + 1, &setting),
                   RITZ_ERR_ARGUMENT, "'%s' is not JOINT=SETTING", part);
    for (int64_t k = 0; k < system->num_sweeps; k++)
        if (strlen(system->sweep[k]) == length &&
            strncmp(system->sweep[k], part, length) == 0) {
            RITZ_REFUSE_IF(!isnan(wanted[k]), RITZ_ERR_ARGUMENT,
                           "joint '%s' is named twice", system->sweep[k]);
            wanted[k] = setting;
            return RITZ_OK;
        }
    return ritz_fail(RITZ_ERR_ARGUMENT, "there is no joint '%.*s' to set",
                     (int)length, part);
}

static bool has_settings(const ritz_configuration *c, const double *wanted)
{
    for (int64_t k = 0; k < c->num_settings; k++)
        if (!isnan(wanted[k]) && fabs(c->setting[k] - wanted[k]) > RITZ_SAME)
            return false;
    return true;
}

/* Setting that a name gives each sweep, NaN where it gives none. */
static ritz_status read_wanted(const ritz_system *system, const char *at,
                               double *wanted)
{
    char part[2 * RITZ_NAME_SIZE];

    for (int64_t k = 0; k < system->num_sweeps; k++)
        wanted[k] = nan("");
    while (at && *at) {
        size_t length = strcspn(at, ",");

        RITZ_REFUSE_IF(length >= sizeof part, RITZ_ERR_ARGUMENT,
                       "'%.40s...' is not JOINT=SETTING", at);
        memcpy(part, at, length);
        part[length] = '\0';
        RITZ_CHECK(read_part(system, part, wanted));
        RITZ_REFUSE_IF(strcmp(at + length, ",") == 0, RITZ_ERR_ARGUMENT,
                       "nothing follows the last ',' of '%s'", at);
        at += length + (at[length] != '\0');
    }
    return RITZ_OK;
}

ritz_status ritz_system_find(const ritz_system *system, const char *at,
                             const ritz_configuration **out)
{
    const ritz_configuration *found = NULL;
    RITZ_OWN_ARRAY double *wanted = NULL;

    RITZ_REFUSE_IF(system->num_configurations < 1, RITZ_ERR_ARGUMENT,
                   "the system has no configuration");
    RITZ_CHECK_NEW(wanted, system->num_sweeps);
    RITZ_CHECK(read_wanted(system, at, wanted));
    for (int64_t k = 0; k < system->num_configurations; k++) {
        const ritz_configuration *c = &system->configuration[k];

        if (!has_settings(c, wanted))
            continue;
        RITZ_REFUSE_IF(
            found, RITZ_ERR_ARGUMENT,
            "there are %" PRId64 " configurations, from '%s' to "
            "'%s': name one with --at",
            system->num_configurations, system->configuration[0].at,
            system->configuration[system->num_configurations - 1].at);
        found = c;
    }
    RITZ_REFUSE_IF(
        !found, RITZ_ERR_ARGUMENT,
        "no configuration is at '%s', there are %" PRId64 " from '%s' to '%s'",
        at ? at : "", system->num_configurations, system->configuration[0].at,
        system->configuration[system->num_configurations - 1].at);
    *out = found;
    return RITZ_OK;
}

ritz_status ritz_configuration_install(ritz_configuration *configuration)
{
    return ritz_dampers_install(&configuration->dampers, &configuration->K,
                                &configuration->D);
}

void ritz_configuration_free(ritz_configuration *configuration)
{
    RITZ_FREE_EACH(ritz_dense, configuration->num_blocks, configuration->P);
    RITZ_FREE(configuration->setting, configuration->lambda);
    ritz_dense_free(&configuration->K);
    ritz_dense_free(&configuration->M);
    ritz_dense_free(&configuration->D);
    ritz_dense_free(&configuration->K4);
    RITZ_FREE_EACH(ritz_reduced_load, configuration->num_loads,
                   configuration->load);
    ritz_dense_free(&configuration->momentum);
    ritz_dense_free(&configuration->places);
    ritz_dampers_free(&configuration->dampers);
    ritz_io_free(&configuration->io);
    ritz_measures_free(&configuration->errors);
    *configuration = (ritz_configuration){0};
}

void ritz_system_free(ritz_system *system)
{
    RITZ_FREE_EACH(ritz_configuration, system->num_configurations,
                   system->configuration);
    RITZ_FREE(system->component, system->sweep);
    *system = (ritz_system){0};
}
