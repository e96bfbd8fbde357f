#include "bases/columns.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/orthonormal.h"
#include "model/local_damping.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

ritz_status ritz_request_damping(const ritz_request *request, ritz_damping *out)
{
    if (request->choice.given & RITZ_USES_DAMPING) {
        *out = request->choice.damping;
        return RITZ_OK;
    }
    return ritz_context(ritz_damping_parse(request->component->damping, out),
                        "damping of the component");
}

ritz_status ritz_lowest_modes(const char *what, const char *name,
                              const ritz_sparse *K, const ritz_sparse *M,
                              const ritz_span *span, const ritz_factor_use *use,
                              ritz_pairs *out)
{
    RITZ_CHECK_IN(what, ritz_eigen_lending(K, M, span, use, out));
    RITZ_REFUSE_IF(out->Phi.ncol > 0 && out->num_rigid == 0 &&
                       out->lambda[0] <= 0.0,
                   RITZ_ERR_SINGULAR,
                   "%s is not positive semidefinite: an eigenvalue is %.3g",
                   name, out->lambda[0]);
    return RITZ_OK;
}

void ritz_columns_label_rigid(int64_t at, ritz_columns *columns)
{
    columns->kind[at] = RITZ_COLUMN_RIGID;
    columns->hertz[at] = 0.0;
}

void ritz_columns_label(const ritz_pairs *modes, ritz_column_kind kind,
                        int64_t at, ritz_columns *columns)
{
    for (int64_t j = 0; j < modes->Phi.ncol; j++) {
        columns->kind[at + j] = kind;
        columns->hertz[at + j] = ritz_eigen_hertz(modes->lambda[j]);
        columns->residual[at + j] = modes->residual[j];
        if (modes->error)
            columns->error[at + j] = modes->error[j];
        if (j < modes->num_rigid)
            ritz_columns_label_rigid(at + j, columns);
    }
}

void ritz_columns_label_dofs(int64_t count, const int64_t *dof, int64_t at,
                             ritz_columns *columns)
{
    for (int64_t j = 0; j < count; j++) {
        columns->kind[at + j] = RITZ_COLUMN_CONSTRAINT;
        columns->dof[at + j] = dof[j];
    }
}

void ritz_origin_name_engine(const ritz_pairs *modes, ritz_origin *origin)
{
    memcpy(origin->engine, modes->engine, sizeof origin->engine);
    origin->reason = modes->reason;
}

ritz_status ritz_basis_of_modes(const ritz_pairs *modes, int64_t more,
                                ritz_basis *out)
{
    RITZ_CHECK(ritz_basis_new(modes->Phi.nrow, modes->Phi.ncol + more, out));
    ritz_dense_put(&modes->Phi, 0, 0, &out->T);
    ritz_columns_label(modes, RITZ_COLUMN_NORMAL, 0, &out->columns);
    ritz_origin_name_engine(modes, &out->origin);
    return RITZ_OK;
}

void ritz_remark_add(ritz_basis *basis, const char *joint, const char *format,
                     ...)
{
    size_t used = strlen(basis->remark);
    size_t left = sizeof basis->remark - used;
    char text[sizeof basis->remark];
    va_list args;

    va_start(args, format);
    (void)vsnprintf(text, sizeof text, format, args);
    va_end(args);
    (void)snprintf(basis->remark + used, left, "%s%s", used > 0 ? joint : "",
                   text);
}

/* Kinds of loads, and what one of them is called. */
static const struct {
    int bit;
    const char *word;
} kinds[] = {
    {RITZ_LOADS_ATTACHED, "attached"},
    {RITZ_LOADS_INPUTS, "input"},
    {RITZ_LOADS_OUTPUTS, "output"},
    {RITZ_LOADS_DAMPERS, "damper"},
};

enum { NUM_KINDS = sizeof kinds / sizeof *kinds };

/* One load vector: a unit force at a row, or entries that lie elsewhere. */
typedef struct load_view {
    const char *word; /* kind */
    const char *name; /* NULL: of an attached dof */
    int64_t row;      /* of an attached dof; -1 */
    const double *val;
    int64_t stride;
} load_view;

/* x := the load vector; x is zero on entry. */
static void take_load(const load_view *load, int64_t n, double *x)
{
    if (load->row >= 0)
        x[load->row] = 1.0;
    for (int64_t i = 0; load->val && i < n; i++)
        x[i] = load->val[i * load->stride];
}

static bool is_zero_load(const load_view *load, int64_t n)
{
    for (int64_t i = 0; load->val && i < n; i++)
        if (load->val[i * load->stride] != 0.0)
            return false;
    return load->val != NULL;
}

/* An iterator over the loads that are not zero. */
typedef struct load_walk {
    const ritz_request *request;
    int loads;
    size_t kind;
    int64_t at; /* of that kind: the next to be looked at */
} load_walk;

/* Load j of a kind; false past the last. */
static bool find_load(const ritz_request *request, size_t kind, int64_t j,
                      load_view *out)
{
    const ritz_io *io = &request->component->io;
    const ritz_dampers *dampers = &request->component->dampers;
    const ritz_dense *const reads[] = {&io->C, &io->Cv, &io->Ca};
    const ritz_dofs *attached = &request->attached;
    int64_t p = io->num_outputs;

    *out = (load_view){kinds[kind].word, NULL, -1, NULL, 1};
    switch (kinds[kind].bit) {
    case RITZ_LOADS_ATTACHED:
        out->row = j < attached->count ? attached->at[j] : -1;
        return j < attached->count;
    case RITZ_LOADS_INPUTS:
        if (j >= io->num_inputs)
            return false;
        out->name = io->input[j];
        out->val = ritz_dense_col(&io->B, j);
        return true;
    case RITZ_LOADS_OUTPUTS: /* rows of C, then those of Cv, then those of Ca */
        if (j >= 3 * p)
            return false;
        out->name = io->output[j % p];
        out->val = reads[j / p]->val + j % p;
        out->stride = p;
        return true;
    default:
        if (j >= dampers->count)
            return false;
        out->name = dampers->name[j];
        out->val = ritz_dense_col(&dampers->B, j);
        return true;
    }
}

/* The next load that is not zero; false past the last. */
static bool next_load(load_walk *w, load_view *out)
{
    for (; w->kind < NUM_KINDS; w->kind++, w->at = 0)
        while ((w->loads & kinds[w->kind].bit) &&
               find_load(w->request, w->kind, w->at, out)) {
            w->at++;
            if (!is_zero_load(out, w->request->component->num_dofs))
                return true;
        }
    return false;
}

int64_t ritz_loads_count(const ritz_request *request, int loads)
{
    load_walk w = {request, loads, 0, 0};
    load_view load = {0};
    int64_t count = 0;

    while (next_load(&w, &load))
        count++;
    return count;
}

/* "attached dof or input": the requested kinds. */
static const char *list_kinds(int loads, char text[64])
{
    size_t used = 0;

    text[0] = '\0';
    for (size_t k = 0; k < NUM_KINDS; k++)
        if (loads & kinds[k].bit)
            used += (size_t)snprintf(
                text + used, 64 - used, "%s%s%s", used > 0 ? " or " : "",
                kinds[k].word,
                kinds[k].bit == RITZ_LOADS_ATTACHED ? " dof" : "");
    return text;
}

ritz_status ritz_loads_collect(const ritz_request *request, int loads,
                               ritz_dense *F, int64_t **dof)
{
    int64_t n = request->component->num_dofs;
    load_walk w = {request, loads, 0, 0};
    load_view load = {0};
    RITZ_OWN(ritz_dofs) rest = {0};
    RITZ_OWN(ritz_dense) columns = {0};
    RITZ_OWN_ARRAY int64_t *row = NULL;
    int64_t count = 0;
    char text[64];

    if (loads & RITZ_LOADS_ATTACHED) /* refuses repeated or impossible ones */
        RITZ_CHECK(ritz_dofs_complement(&request->attached, n, &rest));
    count = ritz_loads_count(request, loads);
    RITZ_REFUSE_IF(count == 0, RITZ_ERR_ARGUMENT,
                   "there is no load to respond to, no %s",
                   list_kinds(loads, text));
    RITZ_CHECK(ritz_dense_new(n, count, &columns));
    RITZ_CHECK_NEW(row, count);
    for (int64_t k = 0; next_load(&w, &load); k++) {
        row[k] = load.row;
        take_load(&load, n, ritz_dense_col(&columns, k));
    }
    RITZ_MOVE(*F, columns);
    RITZ_MOVE(*dof, row);
    return RITZ_OK;
}

const char *ritz_loads_name(const ritz_request *request, int loads, int64_t j,
                            char text[RITZ_LOADS_NAME_SIZE])
{
    load_walk w = {request, loads, 0, 0};
    load_view load = {0};
    char name[RITZ_DOF_NAME_SIZE];

    text[0] = '\0';
    for (int64_t k = 0; k <= j; k++)
        if (!next_load(&w, &load))
            return text;
    if (load.row >= 0)
        snprintf(text, RITZ_LOADS_NAME_SIZE, "%s",
                 ritz_dof_name(request->component->dof[load.row], name));
    else if (load.name)
        snprintf(text, RITZ_LOADS_NAME_SIZE, "%s '%s'", load.word, load.name);
    return text;
}

ritz_status ritz_loads_beside(const ritz_request *request, int usual,
                              int *loads)
{
    const bool asked = request->choice.given & RITZ_USES_LOADS;
    const int all = asked ? request->choice.loads : usual;
    const int beside = all & ~RITZ_LOADS_ATTACHED;
    char text[64];

    RITZ_REFUSE_IF(asked && beside && ritz_loads_count(request, all) == 0,
                   RITZ_ERR_ARGUMENT, "there is no load to respond to, no %s",
                   list_kinds(all, text));
    *loads = beside;
    return RITZ_OK;
}

ritz_status ritz_statics_choose(const ritz_dense *F, const ritz_dense *Psi,
                                const double *least, double tolerance,
                                bool *keep, int64_t *kept)
{
    RITZ_OWN(ritz_dense) R = {0};

    RITZ_CHECK(ritz_dense_mul_tn(F, Psi, &R));
    return ritz_statics_choose_from(&R, least, tolerance, keep, kept);
}

ritz_status ritz_statics_choose_from(ritz_dense *R, const double *least,
                                     double tolerance, bool *keep,
                                     int64_t *kept)
{
    RITZ_OWN_ARRAY double *scale = NULL;
    RITZ_OWN_ARRAY int64_t *order = NULL;

    *kept = 0;
    RITZ_CHECK_NEW(scale, R->ncol);
    RITZ_CHECK_NEW(order, R->ncol);
    for (int64_t j = 0; j < R->ncol; j++) {
        double own = ritz_dense_col(R, j)[j];

        if (own > least[j])
            scale[j] = 1.0 / sqrt(own);
    }
    for (int64_t j = 0; j < R->ncol; j++)
        for (int64_t i = 0; i < R->ncol; i++)
            ritz_dense_col(R, j)[i] *= scale[i] * scale[j];
    ritz_dense_symmetrise(R);
    *kept = ritz_pivots_find(R, tolerance, RITZ_PIVOT_TIE, R->ncol, order);
    for (int64_t k = 0; k < *kept; k++)
        keep[order[k]] = true;
    return RITZ_OK;
}

void ritz_remark_left_out(const ritz_request *request, int loads, int64_t first,
                          int64_t count, const bool *keep,
                          ritz_column_kind kind, ritz_basis *basis)
{
    char name[RITZ_LOADS_NAME_SIZE] = "";
    int64_t left_out = 0;

    for (int64_t j = 0; j < count; j++)
        if (!keep[j] && left_out++ == 0)
            ritz_loads_name(request, loads, first + j, name);
    if (left_out > 0)
        ritz_remark_add(basis, "; ",
                        "%" PRId64 " %s mode(s) left out, the first of %s: "
                        "dependent, or negligible relative to the kept modes",
                        left_out, ritz_column_name(kind), name);
}

/* The engine of a ritz_span for the engine of a request. */
static ritz_eigen_engine engine_of_modes(ritz_engine engine)
{
    static const ritz_eigen_engine of[] = {
        [RITZ_ENGINE_LANCZOS] = RITZ_EIGEN_LANCZOS,
        [RITZ_ENGINE_ARPACK] = RITZ_EIGEN_ARPACK,
        [RITZ_ENGINE_SLICES] = RITZ_EIGEN_SLICES,
        [RITZ_ENGINE_AMLS] = RITZ_EIGEN_AMLS,
        /* what the ranks leave to one process */
        [RITZ_ENGINE_SLEPC] = RITZ_EIGEN_AUTO, /* the last */
    };

    return of[engine];
}

ritz_span ritz_request_span(const ritz_request *request)
{
    return (ritz_span){
        .modes = request->modes,
        .up_to_hz = request->up_to_hz,
        .engine = engine_of_modes(request->choice.engine),
        .uncounted = request->choice.uncounted,
        .accuracy = request->choice.accuracy,
    };
}

ritz_status ritz_refuse_unattached(const ritz_request *request, const char *so)
{
    RITZ_REFUSE_IF(request->attached.count == 0, RITZ_ERR_ARGUMENT,
                   "nothing is attached, so %s: %s", so,
                   request->component->num_ports > 0
                       ? "name a port by --attach"
                       : "there is no port; ritz-import --port gives them to a "
                         "component, and a system has none, of which "
                         "normal-modes or balanced makes less");
    return RITZ_OK;
}

void ritz_remark_dampers(const ritz_request *request, int loads,
                         ritz_basis *basis)
{
    const int64_t count = request->component->dampers.count;

    if (count > 0 && !(loads & RITZ_LOADS_DAMPERS))
        ritz_remark_add(basis, "; ",
                        "%" PRId64 " damper(s) without a static vector: "
                        "damping may be wrong where frequencies are right, "
                        "take dampers among the loads",
                        count);
}

ritz_status ritz_remark_damping(const ritz_request *request, ritz_basis *basis)
{
    const ritz_component *c = request->component;
    char name[RITZ_DOF_NAME_SIZE] = "";
    int64_t count = 0, first = -1;

    RITZ_CHECK(ritz_damping_beyond(c, &count, &first));
    if (count == 0)
        return RITZ_OK;
    ritz_remark_add(basis, "; ",
                    "the damping matrix, no a M + b K at %" PRId64
                    " dof(s)%s%s, has no static vectors: damping may "
                    "be wrong where frequencies are right; state local "
                    "dampers by ritz-import --damper",
                    count, c->dof ? ", the first " : "",
                    c->dof ? ritz_dof_name(c->dof[first], name) : "");
    return RITZ_OK;
}

/* --- mechanisms ----------------------------------------------------------- */

enum { NAMED = 3 };

/* The largest entry of x that was not named before, the first of equals. */
static int64_t largest_unnamed(int64_t n, const double *x, int64_t count,
                               const int64_t *before)
{
    int64_t best = -1;

    for (int64_t k = 0; k < n; k++) {
        bool taken = false;

        for (int64_t j = 0; j < count; j++)
            taken = taken || before[j] == k;
        if (!taken && (best < 0 || fabs(x[k]) > fabs(x[best]) * RITZ_TIE))
            best = k;
    }
    return best;
}

/* "grid 3 R1, grid 7 R1": the dofs where a motion is largest. */
static void name_dofs(const ritz_component *component, const ritz_dofs *i,
                      const double *x, char text[static 160])
{
    int64_t named[NAMED];
    size_t used = 0;

    text[0] = '\0';
    for (int64_t k = 0; k < NAMED && k < i->count; k++) {
        char name[RITZ_DOF_NAME_SIZE];

        named[k] = largest_unnamed(i->count, x, k, named);
        if (fabs(x[named[k]]) <= RITZ_NULL_VECTOR_SHARE * fabs(x[named[0]]))
            break;
        used += (size_t)snprintf(
            text + used, 160 - used, "%s%s", k > 0 ? ", " : "",
            ritz_dof_name(component->dof[i->at[named[k]]], name));
    }
}

ritz_status ritz_refuse_mechanism(const ritz_component *component,
                                  const ritz_dofs *i, const ritz_pairs *pairs,
                                  int64_t weak, int64_t negative)
{
    const int64_t num_rigid = pairs ? pairs->num_rigid : 0;
    char text[160] = "";
    char name[RITZ_DOF_NAME_SIZE];

    if (num_rigid > 0 || (negative > 0 && pairs && pairs->Phi.ncol > 0))
        name_dofs(component, i, ritz_dense_col(&pairs->Phi, 0), text);
    else if (weak >= 0)
        snprintf(text, sizeof text, "%s",
                 ritz_dof_name(component->dof[i->at[weak]], name));
    RITZ_REFUSE_IF(
        negative > 0, RITZ_ERR_SINGULAR,
        "not positive definite: with the attached dofs held, %" PRId64
        " motion(s) have negative energy; largest at %s",
        negative, text[0] ? text : "no dof in particular");
    RITZ_REFUSE_IF(pairs && num_rigid == 0 && pairs->Phi.ncol > 0 &&
                       pairs->lambda[0] < 0.0,
                   RITZ_ERR_SINGULAR,
                   "not positive definite: an eigenvalue is %.3g",
                   pairs->lambda[0]);
    return ritz_fail(
        RITZ_ERR_SINGULAR,
        "singular, is a rigid-body motion or mechanism left free? with "
        "the attached dofs held, %" PRId64 " motion(s) cost no energy; "
        "largest at %s",
        num_rigid > 0 ? num_rigid : 1, text[0] ? text : "no dof in particular");
}
