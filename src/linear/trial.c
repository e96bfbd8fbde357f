#include "linear/trial.h"

#include <stdlib.h>
#include <string.h>

static const ritz_trial usual = {
    .engine = RITZ_EIGEN_AUTO, .small = 600, .medium = 4000, .plenty = 20};

#define TRIAL(e)                                                               \
    {                                                                          \
        .engine = (e), .small = 40, .plenty = 3, .side = 8, .leaf = 12         \
    }

static const struct {
    const char *name;
    ritz_trial trial;
} trials[] = {
    {"lanczos", TRIAL(RITZ_EIGEN_LANCZOS)},
    {"arpack", TRIAL(RITZ_EIGEN_ARPACK)},
    {"slices", TRIAL(RITZ_EIGEN_SLICES)},
    {"amls", TRIAL(RITZ_EIGEN_AMLS)},
};

const ritz_trial *ritz_trial_here(void)
{
    const char *name = getenv("RITZ_TEST_ENGINE");

    for (size_t i = 0; name && i < sizeof trials / sizeof *trials; i++)
        if (strcmp(trials[i].name, name) == 0)
            return &trials[i].trial;
    return &usual;
}
