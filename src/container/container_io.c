/* Members that second-order models share: inputs, outputs, measures. */
#include "container/container_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static ritz_status write_inputs(hid_t at, const ritz_io *io)
{
    ritz_status status = RITZ_OK;
    hid_t group = 0;

    RITZ_TRY(ritz_h5_group(at, "inputs", &group));
    RITZ_TRY(ritz_part_write_names(group, "names", io->num_inputs, io->input));
    RITZ_TRY(ritz_h5_write_dense(group, "B", &io->B));
done:
    ritz_h5_close(group);
    return ritz_context(status, "inputs");
}

static ritz_status write_outputs(hid_t at, const ritz_io *io)
{
    ritz_status status = RITZ_OK;
    hid_t group = 0;
    int64_t p = io->num_outputs;

    RITZ_TRY(ritz_h5_group(at, "outputs", &group));
    RITZ_TRY(ritz_part_write_names(group, "names", p, io->output));
    RITZ_TRY(ritz_h5_write_dense(group, "C", &io->C));
    RITZ_TRY(ritz_h5_write_dense(group, "Cv", &io->Cv));
    RITZ_TRY(ritz_h5_write_dense(group, "Ca", &io->Ca));
    RITZ_TRY(ritz_h5_write(group, "limits", H5T_IEEE_F64LE, ritz_h5_vector(p),
                           io->limit));
done:
    ritz_h5_close(group);
    return ritz_context(status, "outputs");
}

ritz_status ritz_part_write_io(hid_t at, const ritz_io *io)
{
    if (io->num_inputs > 0)
        RITZ_CHECK(write_inputs(at, io));
    if (io->num_outputs > 0)
        RITZ_CHECK(write_outputs(at, io));
    return RITZ_OK;
}

/* Number of names in a group that need not be there. */
static ritz_status count_names(hid_t at, const char *name, int64_t *out)
{
    ritz_status status = RITZ_OK;
    hid_t group = 0;

    *out = 0;
    if (!ritz_h5_has(at, name))
        return RITZ_OK;
    RITZ_TRY(ritz_h5_enter(at, name, &group));
    RITZ_TRY_IN(name, ritz_h5_count(group, "names", out));
done:
    ritz_h5_close(group);
    return status;
}

static ritz_status read_inputs(hid_t at, int64_t n, ritz_io *io)
{
    ritz_status status = RITZ_OK;
    int64_t m = io->num_inputs;
    hid_t group = 0;

    RITZ_TRY(ritz_h5_enter(at, "inputs", &group));
    RITZ_TRY(ritz_part_read_names(group, "names", m, io->input));
    RITZ_TRY(ritz_h5_read_dense(group, "B", n, m, &io->B));
done:
    ritz_h5_close(group);
    return ritz_context(status, "inputs");
}

static ritz_status read_outputs(hid_t at, int64_t n, ritz_io *io)
{
    ritz_status status = RITZ_OK;
    int64_t p = io->num_outputs;
    hid_t group = 0;

    RITZ_TRY(ritz_h5_enter(at, "outputs", &group));
    RITZ_TRY(ritz_part_read_names(group, "names", p, io->output));
    RITZ_TRY(ritz_h5_read_dense(group, "C", p, n, &io->C));
    RITZ_TRY(ritz_h5_read_dense(group, "Cv", p, n, &io->Cv));
    RITZ_TRY(ritz_h5_read_dense(group, "Ca", p, n, &io->Ca));
    RITZ_TRY(
        ritz_h5_read_real(group, "limits", ritz_h5_vector(p), true, io->limit));
done:
    ritz_h5_close(group);
    return ritz_context(status, "outputs");
}

/* Matrices come only with what bears them out: first none are allocated. */
ritz_status ritz_part_read_io(hid_t at, int64_t n, ritz_io *out)
{
    ritz_status status = RITZ_OK;
    ritz_io io = {0};

    RITZ_TRY(count_names(at, "inputs", &io.num_inputs));
    RITZ_TRY(count_names(at, "outputs", &io.num_outputs));
    RITZ_NEW(io.input, io.num_inputs);
    RITZ_NEW(io.output, io.num_outputs);
    RITZ_NEW(io.limit, io.num_outputs);
    if (io.num_inputs > 0)
        RITZ_TRY(read_inputs(at, n, &io));
    else
        RITZ_TRY(ritz_dense_new(n, 0, &io.B));
    if (io.num_outputs > 0) {
        RITZ_TRY(read_outputs(at, n, &io));
    } else {
        RITZ_TRY(ritz_dense_new(0, n, &io.C));
        RITZ_TRY(ritz_dense_new(0, n, &io.Cv));
        RITZ_TRY(ritz_dense_new(0, n, &io.Ca));
    }
    *out = io;
    io = (ritz_io){0};
done:
    ritz_io_free(&io);
    return status;
}

/* Columns of a table of measures. */
typedef struct table {
    ritz_name *name, *where;
    double *value, *limit;
} table;

static ritz_status new_table(int64_t count, table *out)
{
    RITZ_CHECK_NEW(out->name, count);
    RITZ_CHECK_NEW(out->where, count);
    RITZ_CHECK_NEW(out->value, count);
    RITZ_CHECK_NEW(out->limit, count);
    return RITZ_OK;
}

static void free_table(table *t)
{
    free(t->name);
    free(t->where);
    free(t->value);
    free(t->limit);
}

ritz_status ritz_part_write_measures(hid_t at, const char *name,
                                     const ritz_measures *measures)
{
    ritz_status status = RITZ_OK;
    int64_t count = measures->count;
    ritz_h5_shape shape = ritz_h5_vector(count);
    table t = {0};
    hid_t group = 0;

    if (count == 0)
        return RITZ_OK;
    RITZ_TRY(new_table(count, &t));
    for (int64_t k = 0; k < count; k++) {
        const ritz_measure *item = &measures->item[k];

        memcpy(t.name[k], item->name, RITZ_NAME_SIZE);
        memcpy(t.where[k], item->where, RITZ_NAME_SIZE);
        t.value[k] = item->value;
        t.limit[k] = item->limit;
    }
    RITZ_TRY(ritz_h5_group(at, name, &group));
    RITZ_TRY(ritz_part_write_words(group, "name", count, t.name));
    RITZ_TRY(ritz_h5_write(group, "value", H5T_IEEE_F64LE, shape, t.value));
    RITZ_TRY(ritz_h5_write(group, "limit", H5T_IEEE_F64LE, shape, t.limit));
    RITZ_TRY(ritz_part_write_words(group, "where", count, t.where));
done:
    free_table(&t);
    ritz_h5_close(group);
    return ritz_context(status, name);
}

static ritz_status read_table(hid_t group, int64_t count, table *t)
{
    ritz_h5_shape shape = ritz_h5_vector(count);

    RITZ_CHECK(new_table(count, t));
    RITZ_CHECK(ritz_part_read_words(group, "name", count, t->name));
    RITZ_CHECK(ritz_part_read_words(group, "where", count, t->where));
    RITZ_CHECK(ritz_h5_read(group, "value", H5T_IEEE_F64LE, shape, t->value));
    for (int64_t k = 0; k < count; k++) /* infinite: a bound that bounds none */
        RITZ_REFUSE_IF(isnan(t->value[k]) || t->value[k] == -HUGE_VAL,
                       RITZ_ERR_FORMAT, "value %" PRId64 " of 'value' is none",
                       k + 1);
    return ritz_h5_read_real(group, "limit", shape, true, t->limit);
}

ritz_status ritz_part_read_measures(hid_t at, const char *name,
                                    ritz_measures *out)
{
    ritz_status status = RITZ_OK;
    ritz_measures measures = {0};
    table t = {0};
    hid_t group = 0;

    if (!ritz_h5_has(at, name))
        return RITZ_OK;
    RITZ_TRY(ritz_h5_enter(at, name, &group));
    RITZ_TRY(ritz_h5_count(group, "name", &measures.count));
    RITZ_TRY(read_table(group, measures.count, &t));
    RITZ_NEW(measures.item, measures.count);
    for (int64_t k = 0; k < measures.count; k++) {
        ritz_measure *item = &measures.item[k];

        RITZ_TRY(ritz_name_copy(t.name[k], item->name));
        memcpy(item->where, t.where[k], RITZ_NAME_SIZE);
        item->value = t.value[k];
        item->limit = t.limit[k];
    }
    *out = measures;
    measures = (ritz_measures){0};
done:
    ritz_measures_free(&measures);
    free_table(&t);
    ritz_h5_close(group);
    return ritz_context(status, name);
}
