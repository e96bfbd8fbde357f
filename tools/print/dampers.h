/* Dampers of a model, as tools that answer for it tune and install them. */
#ifndef RITZ_TOOLS_PRINT_DAMPERS_H
#define RITZ_TOOLS_PRINT_DAMPERS_H

#include "cli/model.h"

/* --damper NAME=C[*K], in the option table of such a tool. */
#define DAMPERS_OPTION(list)                                                   \
    {                                                                          \
        CLI_LIST(list),                                                        \
            .name = "damper", .argument = "NAME=C[*K]",                        \
            .help = "give a damper other values than the model states"         \
    }

/* --damping TEXT, of the same. */
#define DAMPING_OPTION(place)                                                  \
    {                                                                          \
        CLI_TEXT(place),                                                       \
            .name = "damping", .argument = "TEXT",                             \
            .help =                                                            \
                "\"modal ZETA\", \"modes ZETA ...\", \"bands F F ZETA ...\" "  \
                "(Hz), \"rayleigh A B\" or \"fit F ZETA ...\" [the model's]"   \
    }

/** The dampers of what was read: of the configuration that model_at chose. */
ritz_dampers *dampers_of(model *m);

/** Take the texts of --damper; NULL: none. */
ritz_status dampers_tune(model *m, const cli_list *texts);

/** Tune, and install them in the model's D and K. */
ritz_status dampers_install(model *m, const cli_list *texts);

/* K and D of a reduced component without its dampers, to be written again. */
typedef struct dampers_bare {
    ritz_dense K, D;
    ritz_dampers dampers;
} dampers_bare;

/** Copy them; of any other model nothing. */
ritz_status dampers_keep(const model *m, dampers_bare *out);

/** Put them back, and leave nothing in @p bare. */
void dampers_restore(model *m, dampers_bare *bare);
void dampers_bare_free(dampers_bare *bare);

#endif
