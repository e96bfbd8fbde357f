/* The contents of a file of Standard Input Data. */
#ifndef RITZ_FORMATS_SID_H
#define RITZ_FORMATS_SID_H

#include "formats/normal_body.h"
#include "formats/stiffening.h"
#include "model/inertia_terms.h"

typedef struct sid_body {
    ritz_normal_body normal;
    ritz_sid_terms terms; /* with those of geometric stiffness */
    ritz_stiffening_terms stiffening;
} sid_body;

/** Make the contents of the file. @return as ritz_normal_body_of */
ritz_status sid_body_of(const ritz_reduced *reduced,
                        const ritz_export_request *request, sid_body *out);

void sid_body_free(sid_body *body);

#endif
