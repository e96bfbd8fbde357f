/* Containers of components. */
#include "container/container_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A matrix that may be absent: it has no column pointers. */
static ritz_status write_sparse(hid_t at, const char *name,
                                const ritz_sparse *A)
{
    return A->colptr ? ritz_h5_write_sparse(at, name, A) : RITZ_OK;
}

static ritz_status read_sparse(hid_t at, const char *name, ritz_sparse *out)
{
    return ritz_h5_has(at, name) ? ritz_h5_read_sparse(at, name, out) : RITZ_OK;
}

static ritz_status write_loads(hid_t file, const ritz_component *component)
{
    ritz_status status = RITZ_OK;
    ritz_name name = "";
    hid_t loads = 0;
    hid_t group = 0;

    if (component->num_loads == 0)
        return RITZ_OK;
    RITZ_TRY(ritz_h5_group(file, "KG", &loads));
    for (int64_t k = 0; k < component->num_loads; k++) {
        const ritz_load *load = &component->load[k];

        RITZ_TRY(ritz_name_copy(load->name, name));
        RITZ_TRY(ritz_h5_write_sparse(loads, name, &load->KG));
        RITZ_TRY(ritz_h5_enter(loads, name, &group));
        RITZ_TRY(ritz_part_set_whole(group, "index", k));
        ritz_h5_close(group);
        group = 0;
    }
done:
    ritz_h5_close(group);
    ritz_h5_close(loads);
    return ritz_context(status, "KG");
}

static ritz_status read_loads(hid_t file, ritz_component *component)
{
    ritz_status status = RITZ_OK;
    ritz_name *name = NULL;
    int64_t count = 0;
    hid_t loads = 0;

    if (!ritz_h5_has(file, "KG"))
        return RITZ_OK;
    RITZ_TRY(ritz_h5_enter(file, "KG", &loads));
    RITZ_TRY(ritz_h5_list(loads, &count, &name));
    RITZ_NEW(component->load, count);
    for (int64_t k = 0; k < count; k++) {
        ritz_load *load = &component->load[k];

        component->num_loads++;
        memcpy(load->name, name[k], sizeof load->name);
        RITZ_TRY(ritz_h5_read_sparse(loads, load->name, &load->KG));
    }
done:
    free(name);
    ritz_h5_close(loads);
    return ritz_context(status, "KG");
}

static ritz_status write_port(hid_t ports, int64_t index, const ritz_port *port)
{
    ritz_status status = RITZ_OK;
    hid_t group = 0;
    ritz_name name = "";

    RITZ_TRY(ritz_name_copy(port->name, name));
    RITZ_TRY(ritz_h5_group(ports, name, &group));
    RITZ_TRY(ritz_part_set_whole(group, "index", index));
    RITZ_TRY(ritz_part_set_place(group, port->origin, port->axes));
    RITZ_TRY(ritz_h5_write(group, "dofs", H5T_STD_I64LE,
                           ritz_h5_vector(port->dofs.count), port->dofs.at));
done:
    ritz_h5_close(group);
    return status;
}

static int compare(const void *a, const void *b)
{
    const int64_t *left = a;
    const int64_t *right = b;

    return (*left > *right) - (*left < *right);
}

static ritz_status check_distinct(const ritz_dofs *dofs)
{
    ritz_status status = RITZ_OK;
    ritz_dofs sorted = {0};

    RITZ_TRY(ritz_dofs_copy(dofs, &sorted));
    qsort(sorted.at, (size_t)sorted.count, sizeof *sorted.at, compare);
    for (int64_t k = 1; k < sorted.count; k++)
        RITZ_FAIL_IF(sorted.at[k - 1] == sorted.at[k], RITZ_ERR_FORMAT,
                     "row %" PRId64 " is in 'dofs' twice", sorted.at[k]);
done:
    ritz_dofs_free(&sorted);
    return status;
}

static ritz_status read_port(hid_t ports, int64_t n, ritz_port *port)
{
    ritz_status status = RITZ_OK;
    int64_t count = 0;
    hid_t group = 0;

    RITZ_TRY(ritz_h5_enter(ports, port->name, &group));
    RITZ_TRY(ritz_part_get_place(group, port->origin, port->axes));
    RITZ_TRY(ritz_h5_count(group, "dofs", &count));
    RITZ_NEW(port->dofs.at, count);
    port->dofs.count = count;
    RITZ_TRY(
        ritz_part_read_whole(group, "dofs", count, 0, n - 1, port->dofs.at));
    RITZ_TRY(check_distinct(&port->dofs));
done:
    ritz_h5_close(group);
    return ritz_context(status, port->name);
}

static ritz_status write_ports(hid_t file, const ritz_component *component)
{
    ritz_status status = RITZ_OK;
    hid_t ports = 0;

    RITZ_TRY(ritz_h5_group(file, "ports", &ports));
    for (int64_t k = 0; k < component->num_ports; k++)
        RITZ_TRY(write_port(ports, k, &component->port[k]));
done:
    ritz_h5_close(ports);
    return ritz_context(status, "ports");
}

static ritz_status read_ports(hid_t file, ritz_component *component)
{
    ritz_status status = RITZ_OK;
    ritz_name *name = NULL;
    int64_t count = 0;
    hid_t ports = 0;

    RITZ_TRY(ritz_h5_enter(file, "ports", &ports));
    RITZ_TRY(ritz_h5_list(ports, &count, &name));
    RITZ_NEW(component->port, count);
    for (int64_t k = 0; k < count; k++) {
        ritz_port *port = &component->port[k];

        component->num_ports++;
        memcpy(port->name, name[k], sizeof port->name);
        RITZ_TRY(read_port(ports, component->num_dofs, port));
    }
done:
    free(name);
    ritz_h5_close(ports);
    return ritz_context(status, "ports");
}

static ritz_status read_matrices(hid_t file, ritz_component *component)
{
    RITZ_CHECK(read_sparse(file, "K", &component->K));
    RITZ_CHECK(read_sparse(file, "M", &component->M));
    RITZ_CHECK(read_sparse(file, "D", &component->D));
    RITZ_CHECK(read_sparse(file, "K4", &component->K4));
    return read_loads(file, component);
}

static ritz_status read_all(hid_t file, ritz_component *component)
{
    double asymmetry = 0.0;

    RITZ_CHECK(ritz_h5_get_text(file, "units", sizeof component->units,
                                component->units));
    RITZ_CHECK(ritz_h5_get_text(file, "damping", sizeof component->damping,
                                component->damping));
    RITZ_CHECK(ritz_part_get_real(file, "asymmetry", false, 1, &asymmetry));
    RITZ_CHECK(
        ritz_part_get_real(file, "digits", false, 1, &component->digits));
    RITZ_CHECK(
        ritz_part_read_dofs(file, &component->num_dofs, &component->dof));
    RITZ_CHECK(read_matrices(file, component));
    RITZ_CHECK(ritz_part_read_grids(file, &component->grids));
    RITZ_CHECK(
        ritz_part_read_elements(file, &component->grids, &component->elements));
    RITZ_CHECK(read_ports(file, component));
    RITZ_CHECK(ritz_part_read_io(file, component->num_dofs, &component->io));
    RITZ_CHECK(ritz_part_read_recovery(file, component->num_dofs,
                                       component->dof, &component->recovery));
    RITZ_CHECK(
        ritz_part_read_dampers(file, component->num_dofs, &component->dampers));
    RITZ_CHECK(ritz_component_settle(component, false));
    component->asymmetry = fmax(component->asymmetry, asymmetry);
    return RITZ_OK;
}

ritz_status ritz_container_read_component(const char *path, ritz_component *out)
{
    ritz_status status = RITZ_OK;
    ritz_component component = {0};
    hid_t file = 0;

    RITZ_TRY(ritz_part_open(path, "component", &file));
    RITZ_TRY(read_all(file, &component));
    *out = component;
    component = (ritz_component){0};
done:
    ritz_component_free(&component);
    ritz_h5_close(file);
    return ritz_context(status, path);
}

ritz_status ritz_container_write_component(const char *path,
                                           const ritz_component *component,
                                           const ritz_stamp *stamp)
{
    ritz_status status = RITZ_OK;
    ritz_writer writer = {0};
    hid_t file = 0;

    RITZ_TRY(
        ritz_writer_new(path, "component", component->units, stamp, &writer));
    file = writer.file;
    RITZ_TRY(ritz_h5_set_text(file, "damping", component->damping));
    RITZ_TRY(ritz_part_set_real(file, "asymmetry", 1, &component->asymmetry));
    RITZ_TRY(ritz_part_set_real(file, "digits", 1, &component->digits));
    RITZ_TRY(write_sparse(file, "K", &component->K));
    RITZ_TRY(write_sparse(file, "M", &component->M));
    RITZ_TRY(write_sparse(file, "D", &component->D));
    RITZ_TRY(write_sparse(file, "K4", &component->K4));
    RITZ_TRY(write_loads(file, component));
    RITZ_TRY(ritz_part_write_dofs(file, component->num_dofs, component->dof));
    RITZ_TRY(ritz_part_write_grids(file, &component->grids));
    RITZ_TRY(ritz_part_write_elements(file, &component->elements));
    RITZ_TRY(write_ports(file, component));
    RITZ_TRY(ritz_part_write_io(file, &component->io));
    RITZ_TRY(ritz_part_write_recovery(file, &component->recovery));
    RITZ_TRY(ritz_part_write_dampers(file, &component->dampers));
    RITZ_TRY(ritz_writer_finish(&writer));
done:
    ritz_writer_free(&writer);
    return ritz_context(status, path);
}
