/* The table of runs that are not those of one linear model: a new one is a file
   with its functions, and a row. */
#include "print/simulation.h"

const simulation_kind simulation_kinds[] = {
    {0},
};
