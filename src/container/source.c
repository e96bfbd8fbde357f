/* Models of a scene, read from the containers that it names. */
#include <ritz/container.h>

#include <string.h>

static ritz_status name_kind(void *, const char *name,
                             char kind[static RITZ_NAME_SIZE])
{
    RITZ_OWN(ritz_summary) summary = {0};

    RITZ_CHECK(ritz_container_summary(name, &summary));
    memcpy(kind, summary.kind, RITZ_NAME_SIZE);
    return RITZ_OK;
}

static ritz_status read_component(void *, const char *name, ritz_component *out)
{
    return ritz_container_read_component(name, out);
}

static ritz_status read_reduced(void *, const char *name, ritz_reduced *out)
{
    return ritz_container_read_reduced(name, out);
}

const ritz_source ritz_container_source = {
    .kind = name_kind,
    .component = read_component,
    .reduced = read_reduced,
};
