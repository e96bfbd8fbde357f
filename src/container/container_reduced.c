/* Containers of reduced components. */
#include "container/container_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

static ritz_status write_port(hid_t ports, int64_t index,
                              const ritz_port_map *port)
{
    ritz_status status = RITZ_OK;
    hid_t group = 0;
    ritz_name name = "";

    RITZ_TRY(ritz_name_copy(port->name, name));
    RITZ_TRY(ritz_h5_group(ports, name, &group));
    RITZ_TRY(ritz_part_set_whole(group, "index", index));
    RITZ_TRY(ritz_part_set_place(group, port->origin, port->axes));
    RITZ_TRY(ritz_part_write_labels(group, port->count, port->dof));
    RITZ_TRY(ritz_h5_write(group, "position", H5T_IEEE_F64LE,
                           ritz_h5_table(port->count, 3), port->position));
    RITZ_TRY(ritz_h5_write_dense(group, "map", &port->map));
done:
    ritz_h5_close(group);
    return status;
}

static ritz_status read_port(hid_t ports, int64_t r, ritz_port_map *port)
{
    ritz_status status = RITZ_OK;
    hid_t group = 0;

    RITZ_TRY(ritz_h5_enter(ports, port->name, &group));
    RITZ_TRY(ritz_part_get_place(group, port->origin, port->axes));
    RITZ_TRY(ritz_part_read_labels(group, &port->count, &port->dof));
    RITZ_NEW(port->position, 3 * port->count);
    RITZ_TRY(ritz_h5_read_real(group, "position", ritz_h5_table(port->count, 3),
                               false, port->position));
    RITZ_TRY(ritz_h5_read_dense(group, "map", port->count, r, &port->map));
done:
    ritz_h5_close(group);
    return ritz_context(status, port->name);
}

static ritz_status write_ports(hid_t file, const ritz_reduced *reduced)
{
    ritz_status status = RITZ_OK;
    hid_t ports = 0;

    RITZ_TRY(ritz_h5_group(file, "ports", &ports));
    for (int64_t k = 0; k < reduced->num_ports; k++)
        RITZ_TRY(write_port(ports, k, &reduced->port[k]));
done:
    ritz_h5_close(ports);
    return ritz_context(status, "ports");
}

static ritz_status read_ports(hid_t file, ritz_reduced *reduced)
{
    ritz_status status = RITZ_OK;
    ritz_name *name = NULL;
    int64_t count = 0;
    hid_t ports = 0;

    RITZ_TRY(ritz_h5_enter(file, "ports", &ports));
    RITZ_TRY(ritz_h5_list(ports, &count, &name));
    RITZ_NEW(reduced->port, count);
    for (int64_t k = 0; k < count; k++) {
        ritz_port_map *port = &reduced->port[k];

        reduced->num_ports++;
        memcpy(port->name, name[k], sizeof port->name);
        RITZ_TRY(read_port(ports, reduced->K.ncol, port));
    }
done:
    free(name);
    ritz_h5_close(ports);
    return ritz_context(status, "ports");
}

static ritz_status write_invariants(hid_t group, const ritz_invariants *of)
{
    if (!of->momentum.val)
        return RITZ_OK;
    RITZ_CHECK(ritz_h5_write(group, "rigid", H5T_IEEE_F64LE,
                             ritz_h5_table(6, 6), of->rigid));
    RITZ_CHECK(ritz_h5_write_dense(group, "momentum", &of->momentum));
    RITZ_CHECK(ritz_h5_write_dense(group, "position", &of->position));
    return ritz_h5_write_dense(group, "product", &of->product);
}

static ritz_status read_invariants(hid_t group, int64_t r, ritz_invariants *of)
{
    if (!ritz_h5_has(group, "momentum"))
        return RITZ_OK;
    RITZ_CHECK(ritz_h5_read_real(group, "rigid", ritz_h5_table(6, 6), false,
                                 of->rigid));
    RITZ_CHECK(ritz_h5_read_dense(group, "momentum", 6, r, &of->momentum));
    RITZ_CHECK(ritz_h5_read_dense(group, "position", 3, 3 * r, &of->position));
    return ritz_h5_read_dense(group, "product", 3 * r, 3 * r, &of->product);
}

static ritz_status write_inertia(hid_t file, const ritz_reduced *reduced)
{
    ritz_status status = RITZ_OK;
    hid_t group = 0;
    const ritz_inertia *inertia = &reduced->inertia;

    if (!inertia->known)
        return RITZ_OK;
    RITZ_TRY(ritz_h5_group(file, "inertia", &group));
    RITZ_TRY(ritz_h5_write(group, "mass", H5T_IEEE_F64LE, ritz_h5_vector(1),
                           &inertia->mass));
    RITZ_TRY(ritz_h5_write(group, "centre", H5T_IEEE_F64LE, ritz_h5_vector(3),
                           inertia->centre));
    RITZ_TRY(ritz_h5_write(group, "tensor", H5T_IEEE_F64LE, ritz_h5_table(3, 3),
                           inertia->tensor));
    RITZ_TRY(write_invariants(group, &reduced->invariants));
done:
    ritz_h5_close(group);
    return ritz_context(status, "inertia");
}

static ritz_status read_inertia(hid_t file, ritz_reduced *reduced)
{
    ritz_status status = RITZ_OK;
    hid_t group = 0;
    ritz_inertia *inertia = &reduced->inertia;

    if (!ritz_h5_has(file, "inertia"))
        return RITZ_OK;
    RITZ_TRY(ritz_h5_enter(file, "inertia", &group));
    RITZ_TRY(ritz_h5_read_real(group, "mass", ritz_h5_vector(1), false,
                               &inertia->mass));
    RITZ_TRY(ritz_h5_read_real(group, "centre", ritz_h5_vector(3), false,
                               inertia->centre));
    RITZ_TRY(ritz_h5_read_real(group, "tensor", ritz_h5_table(3, 3), false,
                               inertia->tensor));
    RITZ_TRY(read_invariants(group, reduced->K.ncol, &reduced->invariants));
    inertia->known = true;
done:
    ritz_h5_close(group);
    return ritz_context(status, "inertia");
}

/* What is known of the full component: all of it, or only its size. */
static ritz_status read_full(hid_t file, ritz_reduced *reduced)
{
    int64_t count = 0;

    RITZ_CHECK(
        ritz_part_get_size(file, "num_dofs", 0, INT64_MAX, &reduced->num_dofs));
    RITZ_CHECK(ritz_part_read_dense(file, "T", reduced->num_dofs,
                                    reduced->K.ncol, &reduced->T));
    RITZ_CHECK(ritz_part_read_grids(file, &reduced->grids));
    RITZ_CHECK(
        ritz_part_read_elements(file, &reduced->grids, &reduced->elements));
    if (!ritz_h5_has(file, "dofs"))
        return RITZ_OK;
    RITZ_CHECK(ritz_part_read_dofs(file, &count, &reduced->dof));
    RITZ_REFUSE_IF(count != reduced->num_dofs, RITZ_ERR_FORMAT,
                   "'dofs' names %" PRId64 " rows of %" PRId64, count,
                   reduced->num_dofs);
    return ritz_part_read_recovery(file, count, reduced->dof,
                                   &reduced->recovery);
}

static ritz_status read_all(hid_t file, ritz_reduced *reduced)
{
    int64_t r = 0;

    RITZ_CHECK(
        ritz_h5_get_text(file, "units", sizeof reduced->units, reduced->units));
    RITZ_CHECK(ritz_h5_get_text(file, "damping", sizeof reduced->damping,
                                reduced->damping));
    RITZ_CHECK(ritz_part_get_origin(file, &reduced->origin));
    RITZ_CHECK(ritz_h5_read_dense(file, "K", -1, -1, &reduced->K));
    r = reduced->K.ncol;
    RITZ_REFUSE_IF(reduced->K.nrow != r, RITZ_ERR_FORMAT, "'K' is not square");
    RITZ_CHECK(ritz_h5_read_dense(file, "M", r, r, &reduced->M));
    RITZ_CHECK(ritz_part_read_dense(file, "D", r, r, &reduced->D));
    RITZ_CHECK(ritz_part_read_dense(file, "K4", r, r, &reduced->K4));
    RITZ_CHECK(ritz_part_read_dampers(file, r, &reduced->dampers));
    RITZ_CHECK(read_full(file, reduced));
    RITZ_CHECK(
        ritz_part_read_columns(file, reduced->num_dofs, r, &reduced->columns));
    RITZ_CHECK(read_ports(file, reduced));
    RITZ_CHECK(ritz_part_read_io(file, r, &reduced->io));
    RITZ_CHECK(read_inertia(file, reduced));
    RITZ_CHECK(ritz_part_read_measures(file, "estimates", &reduced->estimates));
    RITZ_CHECK(ritz_part_read_measures(file, "errors", &reduced->errors));
    return ritz_part_read_nested(file, r, &reduced->nested);
}

ritz_status ritz_container_read_reduced(const char *path, ritz_reduced *out)
{
    ritz_status status = RITZ_OK;
    ritz_reduced reduced = {0};
    hid_t file = 0;

    RITZ_TRY(ritz_part_open(path, "reduced", &file));
    RITZ_TRY(read_all(file, &reduced));
    *out = reduced;
    reduced = (ritz_reduced){0};
done:
    ritz_reduced_free(&reduced);
    ritz_h5_close(file);
    return ritz_context(status, path);
}

static ritz_status write_all(hid_t file, const ritz_reduced *reduced)
{
    RITZ_CHECK(ritz_h5_set_text(file, "damping", reduced->damping));
    RITZ_CHECK(ritz_part_set_origin(file, &reduced->origin));
    RITZ_CHECK(ritz_part_set_whole(file, "num_dofs", reduced->num_dofs));
    RITZ_CHECK(ritz_h5_write_dense(file, "K", &reduced->K));
    RITZ_CHECK(ritz_h5_write_dense(file, "M", &reduced->M));
    RITZ_CHECK(ritz_part_write_dense(file, "D", &reduced->D));
    RITZ_CHECK(ritz_part_write_dense(file, "K4", &reduced->K4));
    RITZ_CHECK(ritz_part_write_dampers(file, &reduced->dampers));
    RITZ_CHECK(ritz_part_write_dense(file, "T", &reduced->T));
    RITZ_CHECK(ritz_part_write_grids(file, &reduced->grids));
    RITZ_CHECK(ritz_part_write_elements(file, &reduced->elements));
    if (reduced->dof)
        RITZ_CHECK(ritz_part_write_dofs(file, reduced->num_dofs, reduced->dof));
    RITZ_CHECK(ritz_part_write_recovery(file, &reduced->recovery));
    RITZ_CHECK(ritz_part_write_columns(file, &reduced->columns));
    RITZ_CHECK(write_ports(file, reduced));
    RITZ_CHECK(ritz_part_write_io(file, &reduced->io));
    RITZ_CHECK(write_inertia(file, reduced));
    RITZ_CHECK(
        ritz_part_write_measures(file, "estimates", &reduced->estimates));
    RITZ_CHECK(ritz_part_write_measures(file, "errors", &reduced->errors));
    return ritz_part_write_nested(file, &reduced->nested);
}

ritz_status ritz_container_write_reduced(const char *path,
                                         const ritz_reduced *reduced,
                                         const ritz_stamp *stamp)
{
    ritz_status status = RITZ_OK;
    ritz_writer writer = {0};

    RITZ_TRY(ritz_writer_new(path, "reduced", reduced->units, stamp, &writer));
    RITZ_TRY(write_all(writer.file, reduced));
    RITZ_TRY(ritz_writer_finish(&writer));
done:
    ritz_writer_free(&writer);
    return ritz_context(status, path);
}
