/*
 * Makes modelDescription.xml of FMI 2.0 [FmiTwo2024] and 3.0 [FmiThree2024].
 * The variables are the time, the inputs, the outputs, the states and their
 * derivatives, in this order; value references count them from 0, as in
 * fmu/instance.h.
 *
 * An output or derivative depends on the inputs and states for which its row of
 * A, B, C or D is not 0, by constant factors. A long list of these says little,
 * and of a dense A the lists would grow with the square of the order. Without a
 * list an importer assumes that a variable depends on all inputs and states. So
 * a list of more than MOST_LISTED is left out, but not of an output that some
 * inputs do not act on directly: importers look for algebraic loops there.
 */
#include "base/alloc.h"
#include "formats/fmu.h"
#include "formats/sink.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

typedef struct fmu_page {
    FILE *file;
    const ritz_fmu *fmu;
    const ritz_fmu_text *text;
    int64_t input, output, state, rate; /* first value reference of each */
} fmu_page;

static void put_attribute(FILE *file, const char *name, const char *value)
{
    fprintf(file, " %s=\"", name);
    ritz_xml_put(file, value);
    fputc('"', file);
}

static void put_head(const fmu_page *p)
{
    const bool two = p->text->fmi == 2;
    FILE *file = p->file;

    fprintf(file,
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
            "<fmiModelDescription fmiVersion=\"%s\"",
            two ? "2.0" : "3.0");
    put_attribute(file, "modelName", p->text->name);
    put_attribute(file, two ? "guid" : "instantiationToken", p->text->token);
    put_attribute(file, "description", p->text->description);
    fprintf(
        file,
        " generationTool=\"Ritz %s\" variableNamingConvention=\"flat\"%s>\n",
        ritz_version(), two ? " numberOfEventIndicators=\"0\"" : "");
}

/* The capabilities of the program. canNotUseMemoryManagementFunctions says that
 * the program does not call the importer's functions for memory. */
static void put_interfaces(const fmu_page *p)
{
    static const char two[] = " canNotUseMemoryManagementFunctions=\"true\""
                              " canGetAndSetFMUstate=\"true\""
                              " canSerializeFMUstate=\"true\""
                              " providesDirectionalDerivative=\"true\"/>\n";
    static const char three[] = " canGetAndSetFMUState=\"true\""
                                " canSerializeFMUState=\"true\""
                                " providesDirectionalDerivatives=\"true\""
                                " providesAdjointDerivatives=\"true\""
                                " providesPerElementDependencies=\"true\"/>\n";
    const char *able = p->text->fmi == 2 ? two : three;

    fprintf(p->file,
            "  <ModelExchange modelIdentifier=\"ritz_fmu\"%s%s"
            "  <CoSimulation modelIdentifier=\"ritz_fmu\""
            " canHandleVariableCommunicationStepSize=\"true\"%s",
            p->text->fmi == 2 ? " completedIntegratorStepNotNeeded=\"true\""
                              : " needsCompletedIntegratorStep=\"false\"",
            able, able);
}

/* ---- units -------------------------------------------------------------- */

/* The unit of time (k = 0), of the inputs, then of the outputs. */
static const ritz_fmu_unit *unit_at(const ritz_fmu *fmu, int64_t k)
{
    if (k == 0)
        return &fmu->seconds;
    return k <= fmu->num_inputs ? &fmu->input[k - 1].unit
                                : &fmu->output[k - 1 - fmu->num_inputs].unit;
}

static bool is_new_unit(const ritz_fmu *fmu, int64_t k)
{
    for (int64_t j = 0; j < k; j++)
        if (strcmp(unit_at(fmu, j)->name, unit_at(fmu, k)->name) == 0)
            return false;
    return *unit_at(fmu, k)->name != '\0';
}

static void put_unit(FILE *file, const ritz_fmu_unit *u)
{
    const struct {
        const char *name;
        int power;
    } base[] = {{"kg", u->kg}, {"m", u->m}, {"s", u->s}, {"rad", u->rad}};

    fprintf(file, "    <Unit name=\"%s\"><BaseUnit", u->name);
    for (size_t k = 0; k < sizeof base / sizeof *base; k++)
        if (base[k].power != 0)
            fprintf(file, " %s=\"%d\"", base[k].name, base[k].power);
    fprintf(file, " factor=\"%.17g\"/></Unit>\n", u->factor);
}

static void put_units(const fmu_page *p)
{
    const ritz_fmu *fmu = p->fmu;
    const int64_t count = 1 + fmu->num_inputs + fmu->num_outputs;
    bool any = false;

    for (int64_t k = 0; k < count; k++) {
        if (!is_new_unit(fmu, k))
            continue;
        if (!any)
            fputs("  <UnitDefinitions>\n", p->file);
        any = true;
        put_unit(p->file, unit_at(fmu, k));
    }
    if (any)
        fputs("  </UnitDefinitions>\n", p->file);
}

/* ---- variables ---------------------------------------------------------- */

typedef struct fmu_variable {
    int64_t reference;
    const char *name, *says, *causality, *unit;
    const char *more; /* further attributes, of <ScalarVariable> in FMI 2 */
    char numbers[96]; /* further attributes, of <Real> in FMI 2 */
} fmu_variable;

static void put_variable(const fmu_page *p, const fmu_variable *v)
{
    const bool two = p->text->fmi == 2;
    FILE *file = p->file;

    fputs(two ? "    <ScalarVariable" : "    <Float64", file);
    put_attribute(file, "name", v->name);
    fprintf(file, " valueReference=\"%" PRId64 "\"", v->reference);
    put_attribute(file, "description", v->says);
    fprintf(file, " causality=\"%s\" variability=\"continuous\"%s",
            v->causality, v->more);
    if (two)
        fputs("><Real", file);
    if (*v->unit)
        put_attribute(file, "unit", v->unit);
    fprintf(file, "%s/>%s\n", v->numbers, two ? "</ScalarVariable>" : "");
}

static void put_states(const fmu_page *p)
{
    const ritz_fmu *fmu = p->fmu;

    for (int64_t k = 0; k < fmu->num_states; k++) {
        fmu_variable v = {p->state + k, fmu->state[k],        "state", "local",
                          "",           " initial=\"exact\"", ""};

        snprintf(v.numbers, sizeof v.numbers, " start=\"0\" nominal=\"%.17g\"",
                 fmu->nominal[k]);
        put_variable(p, &v);
    }
    for (int64_t k = 0; k < fmu->num_states; k++) {
        char name[RITZ_NAME_SIZE + 8];
        fmu_variable v = {p->rate + k, name, "derivative",
                          "local",     "",   " initial=\"calculated\"",
                          ""};

        snprintf(name, sizeof name, "der(%s)", fmu->state[k]);
        /* FMI 2 counts variables from 1, FMI 3 names the reference */
        snprintf(v.numbers, sizeof v.numbers, " derivative=\"%" PRId64 "\"",
                 p->state + k + (p->text->fmi == 2));
        put_variable(p, &v);
    }
}

static void put_variables(const fmu_page *p)
{
    const ritz_fmu *fmu = p->fmu;

    fputs("  <ModelVariables>\n", p->file);
    put_variable(p, &(fmu_variable){0, "time", "time", "independent",
                                    fmu->seconds.name, "", ""});
    for (int64_t k = 0; k < fmu->num_inputs; k++)
        put_variable(p, &(fmu_variable){p->input + k, fmu->input[k].name,
                                        fmu->input[k].says, "input",
                                        fmu->input[k].unit.name, "",
                                        " start=\"0\""});
    for (int64_t k = 0; k < fmu->num_outputs; k++)
        put_variable(p, &(fmu_variable){p->output + k, fmu->output[k].name,
                                        fmu->output[k].says, "output",
                                        fmu->output[k].unit.name,
                                        " initial=\"calculated\"", ""});
    put_states(p);
    fputs("  </ModelVariables>\n", p->file);
}

/* ---- dependencies ------------------------------------------------------- */

enum { MOST_LISTED = 100 };

/* An output or a derivative, and its row of the matrices. */
typedef struct fmu_unknown {
    int64_t reference;
    const ritz_dense *by_states; /* C of an output; NULL of a derivative */
    const ritz_dense *by_inputs; /* D of an output, B of a derivative */
    int64_t row;
    int64_t block, first; /* of a derivative: block of A, and its first state */
} fmu_unknown;

static double state_entry(const fmu_page *p, const fmu_unknown *u, int64_t j)
{
    const ritz_fmu *fmu = p->fmu;

    if (u->by_states)
        return ritz_dense_col(u->by_states, j)[u->row];
    if (j < u->first ||
        j >= u->first + ritz_fmu_block_size(&fmu->block[u->block]))
        return 0.0;
    return ritz_fmu_entry(fmu, u->block, u->row - u->first, j - u->first);
}

/* Whether an unknown depends on input j or, behind the inputs, on a state. */
static bool depends(const fmu_page *p, const fmu_unknown *u, int64_t j)
{
    const int64_t state = j - p->fmu->num_inputs;

    return (state < 0 ? ritz_dense_col(u->by_inputs, j)[u->row]
                      : state_entry(p, u, state)) != 0.0;
}

/* Whether the dependencies of an unknown are listed. */
static bool is_listed(const fmu_page *p, const fmu_unknown *u)
{
    const int64_t inputs = p->fmu->num_inputs;
    int64_t count = 0;
    bool all_inputs = true;

    for (int64_t j = 0; j < inputs + p->fmu->num_states; j++) {
        const bool there = depends(p, u, j);

        count += there;
        all_inputs = all_inputs && (there || j >= inputs);
    }
    return count <= MOST_LISTED || (u->by_states && !all_inputs);
}

/* Write the number of each dependency or, if @p text is given, this text for
 * each. */
static void put_dependencies(const fmu_page *p, const fmu_unknown *u,
                             const char *text)
{
    const ritz_fmu *fmu = p->fmu;
    const int64_t one = p->text->fmi == 2; /* numbers count from 1 */
    const char *blank = "";

    for (int64_t j = 0; j < fmu->num_inputs + fmu->num_states; j++) {
        const int64_t state = j - fmu->num_inputs;

        if (!depends(p, u, j))
            continue;
        if (text)
            fprintf(p->file, "%s%s", blank, text);
        else
            fprintf(p->file, "%s%" PRId64, blank,
                    one + (state < 0 ? p->input + j : p->state + state));
        blank = " ";
    }
}

static void put_unknown(const fmu_page *p, const char *element,
                        const fmu_unknown *u)
{
    if (p->text->fmi == 2)
        fprintf(p->file, "      <Unknown index=\"%" PRId64 "\"",
                u->reference + 1);
    else
        fprintf(p->file, "    <%s valueReference=\"%" PRId64 "\"", element,
                u->reference);
    if (is_listed(p, u)) {
        fputs(" dependencies=\"", p->file);
        put_dependencies(p, u, NULL);
        fputs("\" dependenciesKind=\"", p->file);
        put_dependencies(p, u, "constant");
        fputc('"', p->file);
    }
    fputs("/>\n", p->file);
}

static void put_outputs(const fmu_page *p, const char *element)
{
    for (int64_t k = 0; k < p->fmu->num_outputs; k++)
        put_unknown(p, element,
                    &(fmu_unknown){.reference = p->output + k,
                                   .by_states = &p->fmu->C,
                                   .by_inputs = &p->fmu->D,
                                   .row = k});
}

static void put_derivatives(const fmu_page *p, const char *element)
{
    const ritz_fmu *fmu = p->fmu;
    fmu_unknown u = {.by_inputs = &fmu->B};

    for (; u.block < fmu->num_blocks; u.block++) {
        const int64_t size = ritz_fmu_block_size(&fmu->block[u.block]);

        for (; u.row < u.first + size; u.row++) {
            u.reference = p->rate + u.row;
            put_unknown(p, element, &u);
        }
        u.first += size;
    }
}

/* Put the unknowns of one kind. FMI 2 has an element around them, which must
 * not be empty. */
static void put_list(const fmu_page *p, const char *name, bool outputs,
                     bool derivatives)
{
    const ritz_fmu *fmu = p->fmu;
    const bool any = (outputs && fmu->num_outputs > 0) ||
                     (derivatives && fmu->num_states > 0);

    if (!any)
        return;
    if (p->text->fmi == 2)
        fprintf(p->file, "    <%ss>\n", name);
    if (outputs)
        put_outputs(p, name);
    if (derivatives)
        put_derivatives(p, name);
    if (p->text->fmi == 2)
        fprintf(p->file, "    </%ss>\n", name);
}

static void put_structure(const fmu_page *p)
{
    fputs("  <ModelStructure>\n", p->file);
    put_list(p, "Output", true, false);
    put_list(p, p->text->fmi == 2 ? "Derivative" : "ContinuousStateDerivative",
             false, true);
    put_list(p, "InitialUnknown", true, true);
    fputs("  </ModelStructure>\n", p->file);
}

typedef struct fmu_described {
    const ritz_fmu *fmu;
    const ritz_fmu_text *text;
} fmu_described;

static ritz_status put_page(FILE *file, const void *what)
{
    const fmu_described *all = what;
    const ritz_fmu *fmu = all->fmu;
    const ritz_fmu_text *text = all->text;
    const int64_t output = 1 + fmu->num_inputs;
    const int64_t state = output + fmu->num_outputs;
    const fmu_page p = {
        file, fmu, text, 1, output, state, state + fmu->num_states};

    put_head(&p);
    put_interfaces(&p);
    put_units(&p);
    fputs("  <LogCategories>\n    <Category name=\"logStatusError\"/>\n"
          "  </LogCategories>\n",
          file);
    put_variables(&p);
    put_structure(&p);
    fputs("</fmiModelDescription>\n", file);
    return RITZ_OK;
}

ritz_status ritz_fmu_describe(const ritz_fmu *fmu, const ritz_fmu_text *text,
                              char **out, int64_t *length)
{
    const fmu_described all = {fmu, text};

    return ritz_sink_hold(put_page, &all, "a model description", out, length);
}
