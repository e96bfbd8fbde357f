/*
 * Weights of inputs and outputs as text, and the inputs and outputs of a model
 * scaled by them.
 */

#include "base/alloc.h"
#include "base/text.h"
#include "base/tolerances.h"
#include "gramians/modes.h"

#include <ritz/ranking.h>

#include <inttypes.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* "torque=4", the text of which ends at `end`. */
static ritz_status parse_weight(const char *text, const char *end,
                                ritz_weight *out)
{
    const char *equal = memchr(text, '=', (size_t)(end - text));
    char name[RITZ_NAME_SIZE];
    char number[RITZ_NAME_SIZE];

    RITZ_REFUSE_IF(!equal || equal - text >= RITZ_NAME_SIZE ||
                       end - equal > RITZ_NAME_SIZE,
                   RITZ_ERR_ARGUMENT, "'%.*s' is not NAME=WEIGHT",
                   (int)(end - text < 60 ? end - text : 60), text);
    (void)snprintf(name, sizeof name, "%.*s", (int)(equal - text), text);
    (void)snprintf(number, sizeof number, "%.*s", (int)(end - equal - 1),
                   equal + 1);
    RITZ_CHECK(ritz_name_copy(name, out->name));
    RITZ_REFUSE_IF(!ritz_text_real(number, &out->value) || out->value < 0.0,
                   RITZ_ERR_ARGUMENT,
                   "'%s' is no weight of '%s': a number, not negative", number,
                   name);
    return RITZ_OK;
}

static ritz_status parse_weights(const char *text, int64_t *count,
                                 ritz_weight **out)
{
    RITZ_OWN_ARRAY ritz_weight *list = NULL;
    int64_t most = 1, n = 0;

    for (const char *c = text; *c; c++)
        most += *c == ',';
    RITZ_CHECK_NEW(list, most);
    for (const char *c = text; n < most; n++) {
        const char *end = c + strcspn(c, ",");

        RITZ_CHECK(parse_weight(c, end, &list[n]));
        for (int64_t k = 0; k < n; k++)
            RITZ_REFUSE_IF(strcmp(list[k].name, list[n].name) == 0,
                           RITZ_ERR_ARGUMENT, "'%s' has two weights",
                           list[n].name);
        c = end + 1;
    }
    *count = n;
    RITZ_MOVE(*out, list);
    return RITZ_OK;
}

ritz_status ritz_weights_parse(const char *inputs, const char *outputs,
                               ritz_weights *out)
{
    RITZ_OWN(ritz_weights) weights = {0};

    if (inputs)
        RITZ_CHECK_IN(
            "weights of inputs",
            parse_weights(inputs, &weights.num_inputs, &weights.input));
    if (outputs)
        RITZ_CHECK_IN(
            "weights of outputs",
            parse_weights(outputs, &weights.num_outputs, &weights.output));
    RITZ_MOVE(*out, weights);
    return RITZ_OK;
}

void ritz_weights_free(ritz_weights *weights)
{
    RITZ_FREE(weights->input, weights->output);
    *weights = (ritz_weights){0};
}

/* Index of the name in a weight, or a message with the nearest name. */
static ritz_status find_name(const ritz_weight *weight, const char *kind,
                             int64_t count, char (*name)[RITZ_NAME_SIZE],
                             int64_t *out)
{
    const ritz_names names = {kind, count, name[0], RITZ_NAME_SIZE};
    const char *near = NULL;

    *out = ritz_names_index(&names, weight->name);
    if (*out >= 0)
        return RITZ_OK;
    if (count > 0)
        near = ritz_text_nearest(weight->name, count, name[0], RITZ_NAME_SIZE);
    return ritz_fail(RITZ_ERR_ARGUMENT, "there is no %s '%s' to weigh%s%s%s",
                     kind, weight->name, near ? ", is '" : "", near ? near : "",
                     near ? "' meant?" : "");
}

/*
 * Scale inputs by the root of their weight, and replace limits by those of the
 * output weights: Q = 1 / limit^2.
 *
 * @return RITZ_ERR_ARGUMENT if a weight names nothing
 */
static ritz_status apply_weights(const ritz_weights *weights, ritz_io *io)
{
    int64_t at = 0;

    for (int64_t k = 0; k < weights->num_inputs; k++) {
        const ritz_weight *w = &weights->input[k];

        RITZ_CHECK(find_name(w, "input", io->num_inputs, io->input, &at));
        for (int64_t i = 0; i < io->B.nrow; i++)
            ritz_dense_col(&io->B, at)[i] *= sqrt(w->value);
    }
    for (int64_t k = 0; k < weights->num_outputs; k++) {
        const ritz_weight *w = &weights->output[k];

        RITZ_CHECK(find_name(w, "output", io->num_outputs, io->output, &at));
        io->limit[at] = 1.0 / sqrt(w->value); /* of 0, infinite */
    }
    return RITZ_OK;
}

/*
 * The data that rankings need of a model. The momentum R'M phi of each mode is
 * computed as six additional outputs, which are removed again: it is then that
 * of the basis that the modal model has chosen for a cluster.
 */

enum { DIRECTIONS = 6 };

/*
 * What is ranked: matrices, inputs and outputs in coordinates, and their
 * momentum.
 */
typedef struct ranked_model {
    const ritz_dense *K, *M, *D;
    const ritz_io *io;
    const ritz_dense *momentum; /* 6 x r; without values: not known */
    const double *rigid;
} ranked_model;

/* io with weights and, if momentum is known, six additional outputs. */
static ritz_status extend_io(const ranked_model *s, const ritz_weights *weights,
                             ritz_io *out)
{
    const ritz_io *io = s->io;
    int64_t n = s->K->nrow;
    int64_t more = s->momentum->val ? DIRECTIONS : 0;
    RITZ_OWN(ritz_io) all = {0};

    RITZ_CHECK(ritz_io_new(n, io->num_inputs, io->num_outputs + more, &all));
    for (int64_t j = 0; j < io->num_inputs; j++)
        memcpy(all.input[j], io->input[j], RITZ_NAME_SIZE);
    for (int64_t i = 0; i < io->num_outputs; i++) {
        memcpy(all.output[i], io->output[i], RITZ_NAME_SIZE);
        all.limit[i] = io->limit[i];
    }
    ritz_dense_put(&io->B, 0, 0, &all.B);
    ritz_dense_put(&io->C, 0, 0, &all.C);
    ritz_dense_put(&io->Cv, 0, 0, &all.Cv);
    ritz_dense_put(&io->Ca, 0, 0, &all.Ca);
    if (more > 0)
        ritz_dense_put(s->momentum, io->num_outputs, 0, &all.C);
    if (weights)
        RITZ_CHECK(apply_weights(weights, &all));
    RITZ_MOVE(*out, all);
    return RITZ_OK;
}

/* Take the additional outputs out of the modal model. */
static ritz_status take_momentum(const ranked_model *s, ritz_rank_request *out)
{
    ritz_dense *const outputs[] = {&out->modal.C, &out->modal.Cv,
                                   &out->modal.Ca};
    int64_t p = s->io->num_outputs;
    int64_t m = out->modal.count;

    if (!s->momentum->val)
        return RITZ_OK;
    RITZ_CHECK(
        ritz_dense_block(&out->modal.C, p, DIRECTIONS, 0, m, &out->momentum));
    for (int k = 0; k < 3; k++) {
        RITZ_OWN(ritz_dense) own = {0};

        if (!outputs[k]->val)
            continue;
        RITZ_CHECK(
            ritz_dense_block(outputs[k], 0, p, 0, outputs[k]->ncol, &own));
        ritz_dense_replace(outputs[k], &own);
    }
    memcpy(out->rigid, s->rigid, sizeof out->rigid);
    return RITZ_OK;
}

/*
 * The modal model. Rankings of mass need no damping: if there is none, an
 * arbitrary ratio is used to find the modes, and `undamped` marks it as
 * meaningless.
 */
static ritz_status find_modal(const ranked_model *s,
                              const ritz_rank_choice *choice, int needs,
                              const ritz_io *io, ritz_rank_request *out)
{
    const ritz_damping any = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.5};
    const ritz_dense *D = s->D && s->D->val ? s->D : NULL;
    bool given = D || choice->damping.kind != RITZ_DAMPING_NONE;

    out->undamped = !(needs & RITZ_RANK_DAMPING) && !given;
    return ritz_modal_new(s->K, s->M, D, io,
                          out->undamped ? &any : &choice->damping, &out->modal);
}

static ritz_status make_request(const ranked_model *s,
                                const ritz_rank_choice *choice, int needs,
                                ritz_rank_request *out)
{
    RITZ_OWN(ritz_rank_request) request = {0};
    RITZ_OWN(ritz_io) io = {0};

    RITZ_CHECK(extend_io(s, choice->weights, &io));
    RITZ_CHECK(find_modal(s, choice, needs, &io, &request));
    RITZ_CHECK(take_momentum(s, &request));
    RITZ_CHECK_COPY(request.input, s->io->input, s->io->num_inputs);
    RITZ_CHECK_COPY(request.output, s->io->output, s->io->num_outputs);
    memcpy(request.band_hz, choice->band_hz, sizeof request.band_hz);
    RITZ_MOVE(*out, request);
    return RITZ_OK;
}

/* Coordinates that are interface displacements, or fixed-interface modes. */
static ritz_status find_columns(const ritz_columns *columns, bool interface,
                                int64_t *count, int64_t **out)
{
    int64_t n = 0;

    RITZ_CHECK_NEW(*out, columns->count);
    for (int64_t k = 0; k < columns->count; k++) {
        ritz_column_kind kind = columns->kind[k];
        bool fits = interface ? kind == RITZ_COLUMN_CONSTRAINT ||
                                    kind == RITZ_COLUMN_INTERFACE
                              : kind == RITZ_COLUMN_NORMAL;

        if (fits)
            (*out)[n++] = k;
    }
    RITZ_REFUSE_IF(
        n == 0, RITZ_ERR_ARGUMENT,
        "the component has no %s: its basis must be craig-bampton or "
        "like it",
        interface ? "constraint modes" : "fixed-interface modes");
    *count = n;
    return RITZ_OK;
}

/* A(row, col). */
static ritz_status copy_block(const ritz_dense *A, int64_t n,
                              const int64_t *row, int64_t m, const int64_t *col,
                              ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(n, m, out));
    for (int64_t j = 0; j < m; j++)
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(out, j)[i] = ritz_dense_col(A, col[j])[row[i]];
    return RITZ_OK;
}

/* For modes with a clamped interface K_bn is zero. */
static ritz_status check_clamped(const ritz_dense *K, int64_t p,
                                 const int64_t *b, int64_t m, const int64_t *n)
{
    for (int64_t j = 0; j < m; j++)
        for (int64_t i = 0; i < p; i++) {
            double own = sqrt(fabs(ritz_dense_col(K, b[i])[b[i]] *
                                   ritz_dense_col(K, n[j])[n[j]]));

            RITZ_REFUSE_IF(
                !(fabs(ritz_dense_col(K, n[j])[b[i]]) <=
                  RITZ_FOREIGN_INTERFACE * own),
                RITZ_ERR_ARGUMENT,
                "normal modes and constraint modes share stiffness: the "
                "interface was not held when they were made");
        }
    return RITZ_OK;
}

/*
 * The interface excites fixed-interface modes by -M_nb u_b''; no output
 * observes them.
 */
static ritz_status make_interface_request(const ritz_reduced *r,
                                          const ritz_rank_choice *choice,
                                          int needs, ritz_rank_request *out)
{
    static const int64_t six[DIRECTIONS] = {0, 1, 2, 3, 4, 5};
    RITZ_OWN(ritz_dense) K = {0}, M = {0}, D = {0}, momentum = {0};
    RITZ_OWN(ritz_io) io = {0};
    const ranked_model s = {&K, &M, &D, &io, &momentum, r->invariants.rigid};
    const ritz_rank_choice bare = {.damping = choice->damping};
    RITZ_OWN_ARRAY int64_t *b = NULL, *n = NULL;
    int64_t p = 0, m = 0;

    RITZ_CHECK(find_columns(&r->columns, true, &p, &b));
    RITZ_CHECK(find_columns(&r->columns, false, &m, &n));
    RITZ_CHECK(check_clamped(&r->K, p, b, m, n));
    RITZ_CHECK(copy_block(&r->K, m, n, m, n, &K));
    RITZ_CHECK(copy_block(&r->M, m, n, m, n, &M));
    if (r->D.val)
        RITZ_CHECK(copy_block(&r->D, m, n, m, n, &D));
    if (r->invariants.momentum.val)
        RITZ_CHECK(copy_block(&r->invariants.momentum, DIRECTIONS, six, m, n,
                              &momentum));
    RITZ_CHECK(ritz_io_new(m, p, 0, &io));
    ritz_dense_free(&io.B);
    RITZ_CHECK(copy_block(&r->M, m, n, p, b, &io.B));
    RITZ_CHECK(make_request(&s, &bare, needs, out));
    RITZ_CHECK(copy_block(&r->M, p, b, p, b, &out->interface));
    RITZ_CHECK(ritz_dense_new(p, out->modal.count, &out->coupling));
    for (int64_t k = 0; k < p * out->modal.count; k++)
        out->coupling.val[k] = ritz_dense_col(&out->modal.B, k % p)[k / p];
    return RITZ_OK;
}

ritz_status ritz_rank_request_of_reduced(const ritz_reduced *reduced,
                                         const ritz_rank_choice *choice,
                                         int needs, ritz_rank_request *out)
{
    const ranked_model s = {&reduced->K,
                            &reduced->M,
                            &reduced->D,
                            &reduced->io,
                            &reduced->invariants.momentum,
                            reduced->invariants.rigid};
    RITZ_OWN(ritz_rank_request) request = {0};

    if (needs & RITZ_RANK_INTERFACE)
        RITZ_CHECK(make_interface_request(reduced, choice, needs, &request));
    else
        RITZ_CHECK(make_request(&s, choice, needs, &request));
    RITZ_MOVE(*out, request);
    return RITZ_OK;
}

ritz_status
ritz_rank_request_of_configuration(const ritz_configuration *configuration,
                                   const ritz_rank_choice *choice, int needs,
                                   ritz_rank_request *out)
{
    const ritz_configuration *c = configuration;
    const ranked_model s = {&c->K,  &c->M,        &c->D,
                            &c->io, &c->momentum, c->rigid};

    for (int64_t k = c->num_rigid; k < c->K.ncol; k++)
        RITZ_REFUSE_IF(
            c->lambda[k] < 0.0, RITZ_ERR_ARGUMENT,
            "mode %" PRId64 ", %.4g Hz, is a negative square: forces that join "
            "bodies of dual-craig-bampton leave such, which have no rank; "
            "macneal-rubin has the same columns",
            k + 1, ritz_eigen_hertz(c->lambda[k]));
    RITZ_REFUSE_IF(needs & RITZ_RANK_INTERFACE, RITZ_ERR_ARGUMENT,
                   "a system has no interface to hold: rank its components");
    return make_request(&s, choice, needs, out);
}

void ritz_rank_request_free(ritz_rank_request *request)
{
    ritz_modal_free(&request->modal);
    ritz_dense_free(&request->momentum);
    ritz_dense_free(&request->coupling);
    ritz_dense_free(&request->interface);
    RITZ_FREE(request->input, request->output);
    *request = (ritz_rank_request){0};
}
