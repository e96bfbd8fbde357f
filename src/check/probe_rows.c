/* The interface of a reduced component: rows of its ports, or its inputs. */
#include "check/probe_parts.h"

#include "base/alloc.h"
#include "linear/general.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Rows whose motion is below this, of the largest entry, do not move. */
static const double unmoved = 1e-12;
/* Column j of @p Lt is a row of the interface, if it moves. */
static bool keep_column(ritz_dense *Lt, int64_t j, double largest)
{
    double most = 0.0;

    for (int64_t i = 0; i < Lt->nrow; i++)
        most = fmax(most, fabs(ritz_dense_col(Lt, j)[i]));
    return most > unmoved * largest;
}

/* Rows of all ports as columns of Lt, and what they are called. */
static int64_t take_ports(const ritz_reduced *reduced, ritz_dense *Lt,
                          char (*row)[RITZ_NAME_SIZE])
{
    char dof[RITZ_DOF_NAME_SIZE];
    int64_t at = 0;

    for (int64_t k = 0; k < reduced->num_ports; k++) {
        const ritz_port_map *port = &reduced->port[k];
        double largest = ritz_dense_max(&port->map);

        for (int64_t i = 0; i < port->count; i++) {
            for (int64_t j = 0; j < Lt->nrow; j++)
                ritz_dense_col(Lt, at)[j] = ritz_dense_col(&port->map, j)[i];
            snprintf(row[at], RITZ_NAME_SIZE, "%.20s, %s", port->name,
                     ritz_dof_name(port->dof[i], dof));
            at += keep_column(Lt, at, largest);
        }
    }
    return at;
}

static int64_t take_inputs(const ritz_io *io, ritz_dense *Lt,
                           char (*row)[RITZ_NAME_SIZE])
{
    double largest = ritz_dense_max(&io->B);
    int64_t at = 0;

    for (int64_t j = 0; j < io->num_inputs; j++) {
        memcpy(ritz_dense_col(Lt, at), ritz_dense_col(&io->B, j),
               (size_t)Lt->nrow * sizeof *Lt->val);
        snprintf(row[at], RITZ_NAME_SIZE, "%s", io->input[j]);
        at += keep_column(Lt, at, largest);
    }
    return at;
}

ritz_status ritz_prober_interface(ritz_prober *it)
{
    ritz_status status = RITZ_OK;
    const ritz_reduced *reduced = it->reduced;
    int64_t most = reduced->io.num_inputs + 1;
    ritz_dense Lt = {0};

    for (int64_t k = 0; k < reduced->num_ports; k++)
        most += reduced->port[k].count;
    RITZ_TRY(ritz_dense_new(reduced->K.nrow, most, &Lt));
    RITZ_NEW(it->row, most);
    if (reduced->num_ports > 0)
        Lt.ncol = take_ports(reduced, &Lt, it->row);
    else
        Lt.ncol = take_inputs(&reduced->io, &Lt, it->row);
    RITZ_TRY(ritz_general_transpose(&Lt, &it->L));
done:
    ritz_dense_free(&Lt);
    return status;
}
