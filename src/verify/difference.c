/* a - b: both models side by side, the outputs of the second taken off. */
#include <ritz/norms.h>

#include <inttypes.h>
#include <string.h>

static ritz_status check_names(const char *what, int64_t a, int64_t b,
                               const char (*of_a)[RITZ_NAME_SIZE],
                               const char (*of_b)[RITZ_NAME_SIZE])
{
    RITZ_REFUSE_IF(a != b, RITZ_ERR_ARGUMENT,
                   "the models differ in %ss: %" PRId64 " and %" PRId64, what,
                   a, b);
    for (int64_t k = 0; k < a; k++)
        RITZ_REFUSE_IF(strcmp(of_a[k], of_b[k]) != 0, RITZ_ERR_ARGUMENT,
                       "%s %" PRId64 " is '%s' of one model and '%s' of the "
                       "other",
                       what, k + 1, of_a[k], of_b[k]);
    return RITZ_OK;
}

/* to(row.., col..) = sign from */
static void put(double sign, const ritz_dense *from, int64_t row, int64_t col,
                ritz_dense *to)
{
    for (int64_t j = 0; j < from->ncol; j++)
        for (int64_t i = 0; i < from->nrow; i++)
            ritz_dense_col(to, col + j)[row + i] =
                sign * ritz_dense_col(from, j)[i];
}

/* E of a model of n states, or the identity, from (first, first) on. */
static void put_descriptor(const ritz_dense *E, int64_t n, int64_t first,
                           ritz_dense *to)
{
    put(1.0, E, first, first, to);
    for (int64_t i = 0; i < n && !E->val; i++)
        ritz_dense_col(to, first + i)[first + i] = 1.0;
}

/* Empty, of so many states, with the names and limits of a model. */
static ritz_status like(const ritz_state_space *model, int64_t states,
                        ritz_state_space *out)
{
    ritz_io io = {.num_inputs = model->num_inputs,
                  .num_outputs = model->num_outputs,
                  .input = model->input,
                  .output = model->output,
                  .limit = model->limit};

    RITZ_CHECK(ritz_state_space_new(states, &io, out));
    memcpy(out->damping, model->damping, sizeof out->damping);
    memcpy(out->units, model->units, sizeof out->units);
    return RITZ_OK;
}

ritz_status ritz_state_space_difference(const ritz_state_space *a,
                                        const ritz_state_space *b,
                                        ritz_state_space *out)
{
    ritz_status status = RITZ_OK;
    ritz_state_space both = {0};
    int64_t n = a->A.nrow;
    int64_t m = b->A.nrow;

    RITZ_TRY(
        check_names("input", a->num_inputs, b->num_inputs, a->input, b->input));
    RITZ_TRY(check_names("output", a->num_outputs, b->num_outputs, a->output,
                         b->output));
    RITZ_TRY(like(a, n + m, &both));
    put(1.0, &a->A, 0, 0, &both.A);
    put(1.0, &b->A, n, n, &both.A);
    put(1.0, &a->B, 0, 0, &both.B);
    put(1.0, &b->B, n, 0, &both.B);
    put(1.0, &a->C, 0, 0, &both.C);
    put(-1.0, &b->C, 0, n, &both.C);
    for (int64_t k = 0; k < a->D.nrow * a->D.ncol; k++)
        both.D.val[k] = a->D.val[k] - b->D.val[k];
    if (a->E.val || b->E.val) {
        RITZ_TRY(ritz_dense_new(n + m, n + m, &both.E));
        put_descriptor(&a->E, n, 0, &both.E);
        put_descriptor(&b->E, m, n, &both.E);
    }
    *out = both;
    both = (ritz_state_space){0};
done:
    ritz_state_space_free(&both);
    return status;
}
