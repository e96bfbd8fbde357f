/* The controller that ritz-frf closes a loop with. */
#ifndef RITZ_TOOLS_PRINT_LOOPS_H
#define RITZ_TOOLS_PRINT_LOOPS_H

#include "cli/model.h"

#include <ritz/closed_loop.h>

typedef struct loops_wish {
    const char *controller, *feedback, *states; /* NULL: not said */
    cli_list connect;
    bool force;
} loops_wish;

/* Rows of the option table. */
#define LOOPS_OPTIONS(wish)                                                    \
    {CLI_TEXT(&(wish)->controller), .name = "controller", .argument = "FILE",  \
     .help = "close a loop with this state space"},                            \
        {CLI_LIST(&(wish)->connect), .name = "connect", .argument = "OUT=IN",  \
         .help = "join signals of plant and controller whose names differ"},   \
        {CLI_TEXT(&(wish)->feedback), .name = "feedback", .argument = "SIGN",  \
         .help = "negative or positive [negative]"},                           \
        {CLI_TEXT(&(wish)->states), .name = "closed-loop", .argument = "FILE", \
         .help = "write the closed loop as a state space"},                    \
    {                                                                          \
        CLI_FLAG(&(wish)->force),                                              \
            .name = "force", .help = "respond even if the loop is unstable"    \
    }

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

/** Margins and the largest gains, at and between the points of a response. */
ritz_status loops_report(cli_run *run, const loop_run *loop,
                         ritz_responder *plant, const ritz_response *response);

void loop_run_free(loop_run *loop);

#endif
