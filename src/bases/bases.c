/* The table of bases: a new one is a file with a descriptor, and a name in
 * RITZ_EACH_METHOD. */
#include <ritz/basis.h>

#define ROW(name) &ritz_method_##name,

const ritz_method *const ritz_methods[] = {RITZ_EACH_METHOD(ROW) NULL};
