#include "print/shapes.h"

static ritz_status of_basis(cli_run *run, const ritz_basis *basis,
                            const char *component, const char *modes,
                            ritz_shapes *out)
{
    ritz_status status = RITZ_OK;
    model of = {0};

    RITZ_FAIL_IF(!component, RITZ_ERR_ARGUMENT,
                 "'%s' is a basis, which knows no places: name its component "
                 "with --component",
                 run->operand[0]);
    RITZ_TRY(model_read(run, component, MODEL_COMPONENT, &of));
    RITZ_TRY(ritz_shapes_of_basis(basis, &of.component, modes, out));
done:
    model_free(&of);
    return status;
}

ritz_status shapes_export(cli_run *run, const model *m, const char *component,
                          const ritz_exporter *exporter,
                          const ritz_export_request *request,
                          ritz_export_report *done)
{
    ritz_status status = RITZ_OK;
    const char *path = run->operand[0];
    ritz_shapes shapes = {0};
    json_t *names = json_array();

    json_object_set_new(run->report, "shapes", names);
    RITZ_FAIL_IF(component && m->kind != MODEL_BASIS, RITZ_ERR_ARGUMENT,
                 "--component is for a basis, '%s' knows its places", path);
    if (m->kind == MODEL_BASIS)
        RITZ_TRY_IN(
            path, of_basis(run, &m->basis, component, request->modes, &shapes));
    else if (m->kind == MODEL_COMPONENT)
        RITZ_TRY_IN(path, ritz_shapes_of_component(&m->component,
                                                   request->modes, &shapes));
    else
        RITZ_TRY_IN(
            path, ritz_shapes_of_reduced(&m->reduced, request->modes, &shapes));
    cli_record(run, exporter->name, shapes.count);
    for (int64_t k = 0; k < shapes.count; k++)
        json_array_append_new(names, cli_string(shapes.name[k]));
    RITZ_TRY(exporter->write_shapes(&shapes, request, done));
done:
    ritz_shapes_free(&shapes);
    return status;
}
