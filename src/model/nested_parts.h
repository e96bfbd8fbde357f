/* The table of what is known of prefixes, as it is made and asked. */
#ifndef RITZ_MODEL_NESTED_PARTS_H
#define RITZ_MODEL_NESTED_PARTS_H

#include <ritz/nested.h>

/** Room for so many orders and measures, nothing measured. */
ritz_status ritz_nested_new(int64_t smallest, int64_t count, int64_t errors,
                            ritz_nested *out);

/** Whether there is such a prefix. @return RITZ_ERR_ARGUMENT */
ritz_status ritz_nested_check(const ritz_reduced *in, int64_t order);

#endif
