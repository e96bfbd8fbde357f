/* ritz_import: read, name, place, and settle. */
#include "import/import.h"

#include "base/alloc.h"
#include "base/letter.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static ritz_status check_matrix(const ritz_part *part)
{
    const ritz_matrix *A = &part->matrix;

    RITZ_REFUSE_IF(A->A.nrow != A->A.ncol, RITZ_ERR_FORMAT,
                   "'%s' is %" PRId64 " x %" PRId64 ", a square matrix is due",
                   part->spec, A->A.nrow, A->A.ncol);
    RITZ_REFUSE_IF(A->imaginary, RITZ_ERR_FORMAT,
                   "'%s' is complex, a real matrix is due", part->spec);
    return RITZ_OK;
}

/* Read a matrix, if one is asked for. */
static ritz_status take_part(const char *spec, ritz_sparse *becomes,
                             ritz_parts *parts)
{
    ritz_part *part = &parts->part[parts->count];

    if (!spec)
        return RITZ_OK;
    *part = (ritz_part){.spec = spec, .becomes = becomes};
    RITZ_CHECK(ritz_foreign_select(spec, &part->matrix));
    parts->count++;
    return check_matrix(part);
}

/* "F@LOAD": geometric stiffness of a unit load. */
static ritz_status take_load(const char *text, ritz_component *component,
                             char **spec, ritz_parts *parts)
{
    ritz_load *load = &component->load[component->num_loads];
    const char *at = strrchr(text, '@');

    RITZ_REFUSE_IF(!at || at == text, RITZ_ERR_ARGUMENT,
                   "'%s' is not of the form FILE@LOAD", text);
    RITZ_CHECK(ritz_name_copy(at + 1, load->name));
    for (int64_t k = 0; k < component->num_loads; k++)
        RITZ_REFUSE_IF(strcmp(component->load[k].name, load->name) == 0,
                       RITZ_ERR_ARGUMENT, "there are two loads '%s'",
                       load->name);
    RITZ_CHECK_NEW(*spec, at - text + 1);
    memcpy(*spec, text, (size_t)(at - text));
    component->num_loads++;
    return take_part(*spec, &load->KG, parts);
}

static ritz_status take_parts(const ritz_import_request *request,
                              ritz_component *component, char **specs,
                              ritz_parts *parts)
{
    const struct {
        const char *option, *spec;
        ritz_sparse *becomes;
    } table[] = {
        {"stiffness", request->stiffness, &component->K},
        {"mass", request->mass, &component->M},
        {"damping", request->damping, &component->D},
        {"structural damping", request->structural_damping, &component->K4},
    };
    int64_t most = (int64_t)(sizeof table / sizeof *table);

    RITZ_REFUSE_IF(!request->mass, RITZ_ERR_ARGUMENT,
                   "no mass matrix is given, without one nothing can move");
    RITZ_CHECK_NEW(parts->part, most + request->num_loads);
    RITZ_CHECK_NEW(component->load, request->num_loads);
    for (int64_t k = 0; k < most; k++)
        RITZ_CHECK_IN(table[k].option,
                      take_part(table[k].spec, table[k].becomes, parts));
    for (int64_t k = 0; k < request->num_loads; k++)
        RITZ_CHECK_IN("geometric stiffness",
                      take_load(request->load[k], component, &specs[k], parts));
    return RITZ_OK;
}

/*
 * Digits of the stiffness: it is differences of stiffness that rounding spoils.
 * An identity as mass has one digit and tells nothing. Of the mass if there is
 * no stiffness: the parts come in that order.
 */
static double source_digits(const ritz_parts *parts)
{
    return parts->count > 0 ? (double)parts->part[0].matrix.digits : 0.0;
}

ritz_status ritz_import_units(const char *text, char out[RITZ_NAME_SIZE])
{
    RITZ_REFUSE_IF(strlen(text) >= RITZ_NAME_SIZE, RITZ_ERR_ARGUMENT,
                   "'%.40s...' is longer than %d letters", text,
                   RITZ_NAME_SIZE - 1);
    for (const char *c = text; *c; c += ritz_letter_length(c))
        RITZ_REFUSE_IF(ritz_letter_length(c) == 0, RITZ_ERR_ARGUMENT,
                       "'%s' is not one line of UTF-8", text);
    memcpy(out, text, strlen(text) + 1);
    return RITZ_OK;
}

/* Grids of rows and of recovered dofs are placed. */
static ritz_status place_grids(const ritz_deck *deck, const ritz_names *kept,
                               ritz_component *component)
{
    ritz_status status = RITZ_OK;
    const ritz_recovery *recovery = &component->recovery;
    ritz_names all = {.count = kept->count + recovery->count};

    RITZ_TRY(ritz_recovery_extend(recovery, kept->count, kept->dof, NULL,
                                  &all.dof, NULL));
    RITZ_TRY(ritz_import_place(deck, &all, component));
done:
    ritz_names_free(&all);
    return status;
}

/* Rows, with the dofs eliminated that constraints make depend on others. */
static ritz_status settle_rows(const ritz_import_request *request,
                               ritz_parts *parts, ritz_deck *deck,
                               ritz_names *names, ritz_component *component,
                               ritz_import_report *report)
{
    ritz_status status = RITZ_OK;
    ritz_names kept = {0};
    ritz_tying tying = {0};

    RITZ_TRY(
        ritz_tying_new(request, deck, parts, names, component, report, &tying));
    RITZ_TRY(ritz_tying_apply(&tying, parts, &kept, report));
    RITZ_TRY(ritz_parts_settle(parts, deck, &kept, component, report));
    RITZ_TRY(ritz_tying_recover(&tying, component, report));
    RITZ_TRY(place_grids(deck, &kept, component));
done:
    ritz_names_free(&kept);
    ritz_tying_free(&tying);
    return status;
}

static bool has_ties(const ritz_import_request *request, const ritz_deck *deck)
{
    return deck->num_constraints > 0 || request->num_rigid_ports > 0 ||
           request->num_averaged_ports > 0;
}

/* Elements whose grids are all there, out of the deck. */
static void take_elements(ritz_deck *deck, ritz_component *component,
                          ritz_import_report *report)
{
    const ritz_grids *grids = &component->grids;

    component->elements = deck->elements;
    deck->elements = (ritz_elements){0};
    report->num_hidden =
        deck->num_strange +
        ritz_elements_keep(&component->elements, grids->count, grids->id);
}

/* From matrices and a deck to a component without ports. */
static ritz_status make_component(const ritz_import_request *request,
                                  ritz_parts *parts, ritz_deck *deck,
                                  ritz_component *component,
                                  ritz_import_report *report)
{
    ritz_status status = RITZ_OK;
    ritz_names names = {0};

    if (request->bulk)
        RITZ_TRY(ritz_deck_read(request->bulk, deck));
    RITZ_FAIL_IF(deck->imposed, RITZ_ERR_FORMAT, "%s", deck->imposed);
    RITZ_TRY(ritz_names_find(request, deck, parts, &names));
    if (has_ties(request, deck)) {
        RITZ_TRY(settle_rows(request, parts, deck, &names, component, report));
    } else {
        RITZ_TRY(ritz_parts_settle(parts, deck, &names, component, report));
        RITZ_TRY(place_grids(deck, &names, component));
    }
    take_elements(deck, component, report);
    component->digits = source_digits(parts);
    if (request->units)
        RITZ_TRY_IN("--units",
                    ritz_import_units(request->units, component->units));
done:
    ritz_names_free(&names);
    return status;
}

/* Ports, inputs and outputs find their rows by name. */
static ritz_status attach(const ritz_import_request *request,
                          const ritz_deck *deck,
                          const ritz_import_report *report,
                          ritz_component *component)
{
    ritz_status status = RITZ_OK;
    ritz_extended extended = {0};

    RITZ_TRY(ritz_extended_new(component, &deck->equations, &extended));
    RITZ_TRY_IN("port",
                ritz_import_ports(request, report, &extended, component));
    RITZ_TRY(ritz_import_io(request, &extended, component));
    RITZ_TRY_IN("damper", ritz_import_dampers(request, &extended, component));
done:
    ritz_extended_free(&extended);
    return status;
}

ritz_status ritz_import(const ritz_import_request *request, ritz_component *out,
                        ritz_import_report *report)
{
    ritz_status status = RITZ_OK;
    ritz_component component = {0};
    ritz_import_report done_what = {0};
    ritz_parts parts = {0};
    ritz_deck deck = {0};
    char **specs = NULL; /* of loads, cut before '@' */

    RITZ_NEW(specs, request->num_loads);
    RITZ_TRY(take_parts(request, &component, specs, &parts));
    RITZ_TRY(make_component(request, &parts, &deck, &component, &done_what));
    ritz_parts_free(&parts); /* the larger half of the memory, done with */
    RITZ_TRY(attach(request, &deck, &done_what, &component));
    RITZ_TRY(ritz_component_settle(&component, request->symmetrise));
    *out = component;
    component = (ritz_component){0};
    *report = done_what;
    done_what = (ritz_import_report){0};
done:
    for (int64_t k = 0; specs && k < request->num_loads; k++)
        free(specs[k]);
    free(specs);
    ritz_parts_free(&parts);
    ritz_deck_free(&deck);
    ritz_component_free(&component);
    ritz_import_report_free(&done_what);
    return status;
}

void ritz_import_report_free(ritz_import_report *report)
{
    free(report->removed);
    free(report->fixed);
    free(report->constraint);
    free(report->unknown);
    free(report->grid);
    *report = (ritz_import_report){0};
}
