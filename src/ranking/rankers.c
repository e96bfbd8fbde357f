/* The table of rankings: a new one is a file with a descriptor, and a name in
 * RITZ_EACH_RANKER. */
#include <ritz/ranking.h>

#define ROW(name) &ritz_ranker_##name,

const ritz_ranker *const ritz_rankers[] = {RITZ_EACH_RANKER(ROW) NULL};
