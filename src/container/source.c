/* Models of a scene, read from the containers that it names. */
#include <ritz/container.h>

#include <string.h>

static ritz_status name_kind(void *state, const char *name,
                             char kind[static RITZ_NAME_SIZE])
{
    ritz_summary summary = {0};

    (void)state;
    RITZ_CHECK(ritz_container_summary(name, &summary));
    memcpy(kind, summary.kind, RITZ_NAME_SIZE);
    ritz_summary_free(&summary);
    return RITZ_OK;
}

static ritz_status read_component(void *state, const char *name,
                                  ritz_component *out)
{
    (void)state;
    return ritz_container_read_component(name, out);
}

static ritz_status read_reduced(void *state, const char *name,
                                ritz_reduced *out)
{
    (void)state;
    return ritz_container_read_reduced(name, out);
}

const ritz_source ritz_container_source = {
    .kind = name_kind,
    .component = read_component,
    .reduced = read_reduced,
};
