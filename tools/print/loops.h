/* The controller that ritz-frf closes a loop with. */
#ifndef RITZ_TOOLS_PRINT_LOOPS_H
#define RITZ_TOOLS_PRINT_LOOPS_H

#include "cli/model.h"

#include <ritz/response.h>

typedef struct loops_wish {
    const char *controller, *feedback, *states; /* NULL: not said */
    cli_list connect;
    bool force;
} loops_wish;

/* A loop that is closed, and what it is made of. */
typedef struct loop_run {
    model controller;
    ritz_loop loop;
    ritz_responder *inner;  /* of the controller */
    ritz_responder *closed; /* to be asked in place of the plant */
} loop_run;

/** Options that make no sense together end the program. */
void loops_check(const cli_program *program, const loops_wish *asked);

/** Read the controller, before anything is said; nothing if there is none. */
ritz_status loops_read(cli_run *run, const loops_wish *asked, loop_run *out);

/**
 * Close the loop, say whether it is stable, and refuse an unstable one without
 * --force; nothing if there is no controller.
 *
 * @param[in] plant  of @p m, made ready for the same range
 */
ritz_status loops_close(cli_run *run, const loops_wish *asked, const model *m,
                        const ritz_damping *damping, ritz_responder *plant,
                        const double range_hz[2], loop_run *out);

/** Margins of a loop at the points of a response; nothing if there is none. */
ritz_status loops_report(cli_run *run, const loop_run *loop,
                         ritz_responder *plant, const ritz_response *response);

void loop_run_free(loop_run *loop);

#endif
