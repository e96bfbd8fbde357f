#include "solvers.h"

#include "testing.h"

#include <ritz/foreign.h>
#include <ritz/import.h>

#include <stdio.h>
#include <stdlib.h>

const solvers_source solvers_nastran95[2] = {
    {SOLVERS "nastran95_inboard.op4:KGG", SOLVERS "nastran95_inboard.op4:MGG",
     SOLVERS "nastran95_inboard.deck", NULL},
    {SOLVERS "nastran95_outboard.op4:KGG", SOLVERS "nastran95_outboard.op4:MGG",
     SOLVERS "nastran95_outboard.deck", NULL}};
const solvers_source solvers_mystran[2] = {
    {SOLVERS "mystran_inboard.op4:KGG", SOLVERS "mystran_inboard.op4:MGG",
     SOLVERS "mystran_inboard.dat", NULL},
    {SOLVERS "mystran_outboard.op4:KGG", SOLVERS "mystran_outboard.op4:MGG",
     SOLVERS "mystran_outboard.dat", NULL}};

bool solvers_find(const char *name, char path[static 512])
{
    const char *data = getenv("RITZ_EXTERNAL_DATA");

    if (!data) {
        print_message("skipped: no external data\n");
        return false;
    }
    snprintf(path, 512, "%s/nastran/%s", data, name);
    return true;
}

bool solvers_import(const solvers_source *from, ritz_component *out)
{
    const char *const ports[] = {"frame=3,11,19,27"};
    char K[512], M[512], bulk[512];
    ritz_import_request request = {.stiffness = K,
                                   .mass = M,
                                   .bulk = bulk,
                                   .dofs = from->dofs,
                                   .num_ports = 1,
                                   .port = ports};
    ritz_import_report report = {0};

    if (!solvers_find(from->stiffness, K))
        return false;
    solvers_find(from->mass, M);
    solvers_find(from->bulk, bulk);
    assert_ok(ritz_import(&request, out, &report));
    assert_int_equal(out->port[0].dofs.count, 24);
    ritz_import_report_free(&report);
    return true;
}

void solvers_read(const char *name, ritz_dense *out)
{
    char spec[512];
    ritz_matrix matrix = {0};

    assert_true(solvers_find(name, spec));
    assert_ok(ritz_foreign_select(spec, &matrix));
    assert_ok(ritz_sparse_dense(&matrix.A, out));
    ritz_matrix_free(&matrix);
}
