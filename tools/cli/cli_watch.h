/* Signals and progress while a tool works. */
#ifndef RITZ_TOOLS_CLI_CLI_WATCH_H
#define RITZ_TOOLS_CLI_CLI_WATCH_H

#include <stdbool.h>

/** From now on SIGINT, SIGTERM and SIGHUP remove unfinished files first. */
void cli_watch_signals(void);

/** Show steps of the library as one line, if standard error is a terminal. */
void cli_watch_progress(bool quiet);

/** Remove that line, before something else is written. */
void cli_watch_clear(void);

#endif
