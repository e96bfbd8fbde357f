/*
 * A body for Exudyn: the HDF5 file that its ObjectFFRFreducedOrderInterface
 * loads [Gerstmayr2023], as release 1.13.6 saves it. Nodes carry translations
 * only, along basic axes, and come in the order of grid ids.
 */
#include "formats/exudyn.h"

#include "base/draft.h"
#include "container/h5.h"

/* Exudyn compares `datatype` with str: only text of variable length is one. */
static hid_t text_type(void)
{
    hid_t type = ritz_h5_string(1);

    H5Tset_size(type, H5T_VARIABLE);
    return type;
}

static ritz_status label(hid_t at, const char *datatype)
{
    hid_t type = text_type();
    ritz_status status =
        ritz_h5_set(at, "datatype", type, ritz_h5_scalar(), &datatype);

    ritz_h5_close(type);
    return status;
}

static ritz_status label_set(hid_t file, const char *name, const char *datatype)
{
    ritz_status status = RITZ_OK;
    hid_t set = H5Dopen2(file, name, H5P_DEFAULT);

    RITZ_FAIL_IF(set < 0, RITZ_ERR_FILE, "cannot open '%s'", name);
    RITZ_TRY(label(set, datatype));
done:
    ritz_h5_close(set);
    return status;
}

static ritz_status write_text(hid_t file, const char *name, const char *text)
{
    ritz_status status = RITZ_OK;
    hid_t type = text_type();

    RITZ_TRY(ritz_h5_write(file, name, type, ritz_h5_scalar(), &text));
    RITZ_TRY(label_set(file, name, "str"));
done:
    ritz_h5_close(type);
    return status;
}

/* Values that are no matrix. */
static ritz_status write_values(hid_t file, const ritz_reduced *reduced,
                                const exudyn_body *b)
{
    int64_t m = b->modes.V.ncol;
    const int64_t version = 1;
    const int64_t info[6] = {m, b->nodes.count, 3, 4, 7, 7 + m};
    const struct {
        const char *name, *datatype;
        hid_t type;
        ritz_h5_shape shape;
        const void *values;
    } list[] = {
        {"fileVersion", "int", H5T_STD_I64LE, ritz_h5_scalar(), &version},
        {"infoList", "ndarray", H5T_STD_I64LE, ritz_h5_vector(6), info},
        {"xRef", "ndarray", H5T_IEEE_F64LE, ritz_h5_vector(3 * b->nodes.count),
         b->xRef},
        {"totalMass", "float64", H5T_IEEE_F64LE, ritz_h5_scalar(),
         &reduced->inertia.mass},
        {"chiU", "ndarray", H5T_IEEE_F64LE, ritz_h5_vector(3),
         reduced->inertia.centre},
        {"trigList", "ndarray", H5T_IEEE_F64LE, ritz_h5_vector(0), b->xRef},
    };

    for (size_t k = 0; k < sizeof list / sizeof *list; k++) {
        RITZ_CHECK(ritz_h5_write(file, list[k].name, list[k].type,
                                 list[k].shape, list[k].values));
        RITZ_CHECK(label_set(file, list[k].name, list[k].datatype));
    }
    return RITZ_OK;
}

static ritz_status write_matrices(hid_t file, const exudyn_body *b)
{
    const exudyn_terms *t = &b->terms;
    const struct {
        const char *name;
        const ritz_dense *A;
    } list[] = {
        {"modeBasis", &b->modeBasis},
        {"massMatrixReduced", &b->modes.M},
        {"stiffnessMatrixReduced", &b->modes.K},
        {"inertiaLocal", &t->inertiaLocal},
        {"Mtt", &t->Mtt},
        {"chiUtilde", &t->chiUtilde},
        {"mPsiTildePsi", &t->mPsiTildePsi},
        {"mPsiTildePsiTilde", &t->mPsiTildePsiTilde},
        {"mPhitTPsi", &t->mPhitTPsi},
        {"mPhitTPsiTilde", &t->mPhitTPsiTilde},
        {"mXRefTildePsi", &t->mXRefTildePsi},
        {"mXRefTildePsiTilde", &t->mXRefTildePsiTilde},
    };

    for (size_t k = 0; k < sizeof list / sizeof *list; k++) {
        RITZ_CHECK(ritz_h5_write_dense(file, list[k].name, list[k].A));
        RITZ_CHECK(label_set(file, list[k].name, "ndarray"));
    }
    return RITZ_OK;
}

static ritz_status write_file(hid_t file, const ritz_reduced *reduced,
                              const exudyn_body *b)
{
    ritz_status status = RITZ_OK;
    hid_t group = 0;

    RITZ_TRY(write_values(file, reduced, b));
    RITZ_TRY(write_matrices(file, b));
    RITZ_TRY(write_text(file, "type", "ObjectFFRFreducedOrderInterface"));
    RITZ_TRY(write_text(file, "rigidBodyNodeType",
                        "NodeType.RotationEulerParameters"));
    RITZ_TRY(ritz_h5_group(file, "postProcessingModes", &group));
    RITZ_TRY(label(group, "dict"));
done:
    ritz_h5_close(group);
    return status;
}

static ritz_status publish(const char *path, const ritz_reduced *reduced,
                           const exudyn_body *b)
{
    ritz_status status = RITZ_OK;
    ritz_draft draft = {0};
    hid_t file = 0;
    herr_t closed = 0;

    RITZ_TRY(ritz_draft_new(path, &draft));
    RITZ_TRY(ritz_h5_create(draft.name, &file));
    RITZ_TRY(write_file(file, reduced, b));
    closed = H5Fclose(file); /* what HDF5 held back may not fit */
    file = 0;
    RITZ_FAIL_IF(closed < 0, RITZ_ERR_FILE,
                 "'%s' cannot be written to its end, is the disk full?", path);
    RITZ_TRY(ritz_draft_publish(&draft));
done:
    ritz_h5_close(file);
    ritz_draft_free(&draft);
    return status;
}

static ritz_status write(const ritz_reduced *reduced,
                         const ritz_export_request *request,
                         ritz_export_report *report)
{
    ritz_status status = RITZ_OK;
    exudyn_body b = {0};

    RITZ_TRY(exudyn_body_of(reduced, &b));
    RITZ_TRY(exudyn_body_say(reduced, &b, report));
    RITZ_TRY(publish(request->output, reduced, &b));
done:
    exudyn_body_free(&b);
    return status;
}

const ritz_exporter ritz_exporter_exudyn = {
    .name = "exudyn",
    .summary = "a flexible body for Exudyn (FFRF, reduced order), HDF5",
    .reference = "Gerstmayr2023",
    .kind = "reduced",
    .write_reduced = write,
};
