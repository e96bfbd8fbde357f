/*
 * Finds names and units of the inputs and outputs of an FMU.
 *
 * A reduced component does not store the grid and direction of an input. But if
 * the input is a unit force on dof i, its column of T'B is row i of T, and so
 * is the row of C, Cv or Ca of an output that is the motion of dof i. So the
 * row of T with these entries gives the dof, and the dof tells force from
 * moment, and translation from rotation.
 */
#include "base/alloc.h"
#include "base/text.h"
#include "base/tolerances.h"
#include "formats/fmu.h"

#include <math.h>
#include <string.h>

/* ---- names -------------------------------------------------------------- */

/* The names that are in use: time, states, derivatives, and as many inputs and
   outputs as have been named so far. */
typedef struct names_taken {
    const ritz_fmu *fmu;
    int64_t inputs, outputs;
} names_taken;

/* Whether the first letters of a text are the name of a state. */
static bool is_state(const ritz_fmu *fmu, const char *text, size_t length)
{
    for (int64_t k = 0; k < fmu->num_states; k++)
        if (strncmp(fmu->state[k], text, length) == 0 &&
            fmu->state[k][length] == '\0')
            return true;
    return false;
}

/* Whether a name is that of a state or "der(STATE)". */
static bool is_state_or_rate(const ritz_fmu *fmu, const char *name)
{
    static const char before[] = "der(";
    const size_t skipped = sizeof before - 1;
    const size_t length = strlen(name);

    if (length > skipped + 1 && strncmp(name, before, skipped) == 0 &&
        name[length - 1] == ')' &&
        is_state(fmu, name + skipped, length - skipped - 1))
        return true;
    return length < RITZ_NAME_SIZE && is_state(fmu, name, length);
}

static bool is_taken(const names_taken *t, const char *name)
{
    const ritz_fmu *fmu = t->fmu;

    if (strcmp(name, "time") == 0 || is_state_or_rate(fmu, name))
        return true;
    for (int64_t k = 0; k < t->inputs; k++)
        if (strcmp(name, fmu->input[k].name) == 0)
            return true;
    for (int64_t k = 0; k < t->outputs; k++)
        if (strcmp(name, fmu->output[k].name) == 0)
            return true;
    return false;
}

/* The number of bytes, at most @p room, of the first whole letters of a
   text. */
static int fit_letters(const char *text, int room)
{
    int length = 0;

    while (text[length]) {
        const int letter = ritz_letter_length(text + length);

        if (letter < 1 || length + letter > room)
            break;
        length += letter;
    }
    return length;
}

/* Choose the given name or, if it is taken, the name with a word and a number
 * behind it: "tip (output 2)". @return whether the name is changed */
static bool choose_name(const names_taken *t, const char *given,
                        const char *word, char out[RITZ_NAME_SIZE])
{
    enum { ROOM = 32 }; /* of word and number */
    char base[RITZ_NAME_SIZE];
    int length = 0;

    snprintf(base, sizeof base, "%s", *given ? given : word);
    ritz_text_clean(base);
    length = fit_letters(base, RITZ_NAME_SIZE - ROOM);
    memcpy(out, base, RITZ_NAME_SIZE);
    for (int number = 1; is_taken(t, out); number++)
        if (number == 1)
            snprintf(out, RITZ_NAME_SIZE, "%.*s (%s)", length, base, word);
        else
            snprintf(out, RITZ_NAME_SIZE, "%.*s (%s %d)", length, base, word,
                     number);
    return strcmp(out, given) != 0;
}

/* ---- units -------------------------------------------------------------- */

/* A unit that --units may name, which is 10^power SI units. */
typedef struct unit_label {
    const char *text;
    int power;
} unit_label;

static const unit_label masses[] = {{"kg", 0},    {"g", -3}, {"t", 3},
                                    {"tonne", 3}, {"Mg", 3}, {0}};
static const unit_label lengths[] = {
    {"m", 0}, {"mm", -3}, {"cm", -2}, {"km", 3}, {0}};
static const unit_label times[] = {{"s", 0}, {"ms", -3}, {0}};

enum { MASS, LENGTH, TIME, DIMENSIONS };

typedef struct unit_labels {
    unit_label of[DIMENSIONS]; /* {0} if the units are not known */
} unit_labels;

/* The label that is the first letters of a text; {0} if there is none. */
static unit_label find_label(const unit_label *among, const char *text,
                             size_t length)
{
    for (; among->text; among++)
        if (strlen(among->text) == length &&
            memcmp(among->text, text, length) == 0)
            break;
    return *among;
}

/* Read units such as "kg mm s". */
static unit_labels read_labels(const char *text)
{
    static const unit_label *const tables[DIMENSIONS] = {masses, lengths,
                                                         times};
    static const unit_labels none = {0};
    unit_labels found = {0};

    for (int k = 0; k < DIMENSIONS; k++) {
        const size_t length = strcspn(text, " ");

        found.of[k] = find_label(tables[k], text, length);
        if (!found.of[k].text)
            return none;
        text += length + strspn(text + length, " ");
    }
    return *text ? none : found;
}

/* Name of the unit of force: "N", or for example "kg.mm/s2". */
static void name_force(const unit_labels *l, int power, char out[24])
{
    if (power == 0)
        snprintf(out, 24, "N");
    else
        snprintf(out, 24, "%s.%s/%s2", l->of[MASS].text, l->of[LENGTH].text,
                 l->of[TIME].text);
}

static ritz_fmu_unit force_unit(const unit_labels *l, bool rotates)
{
    const int power =
        l->of[MASS].power + l->of[LENGTH].power - 2 * l->of[TIME].power;
    ritz_fmu_unit u = {.kg = 1, .m = rotates ? 2 : 1, .s = -2};
    char name[24];

    name_force(l, power, name);
    u.factor = pow(10.0, power + (rotates ? l->of[LENGTH].power : 0));
    if (rotates)
        snprintf(u.name, sizeof u.name, "%.15s.%.7s", name, l->of[LENGTH].text);
    else
        memcpy(u.name, name, sizeof u.name);
    return u;
}

/* Unit of a translation or rotation (order 0), its velocity or acceleration. */
static ritz_fmu_unit motion_unit(const unit_labels *l, bool rotates, int order)
{
    static const char *const per[] = {"", "/", "/"};
    static const char *const power[] = {"", "", "2"};
    ritz_fmu_unit u = {.m = !rotates, .rad = rotates, .s = -order};

    u.factor = pow(10.0, (rotates ? 0 : l->of[LENGTH].power) -
                             order * l->of[TIME].power);
    snprintf(u.name, sizeof u.name, "%s%s%s%s",
             rotates ? "rad" : l->of[LENGTH].text, per[order],
             order > 0 ? l->of[TIME].text : "", power[order]);
    return u;
}

/* Direction, 1 to 6, of the dof whose row of T has these entries. 0 if there is
   no such dof, or translations and rotations that have the same entries. */
static int find_component(const ritz_reduced *reduced, const double *entry,
                          int64_t stride)
{
    const ritz_dense *T = &reduced->T;
    double size = 0.0;
    int found = 0;

    for (int64_t j = 0; j < T->ncol; j++)
        size = fmax(size, fabs(entry[j * stride]));
    for (int64_t i = 0; size > 0.0 && i < T->nrow; i++) {
        int64_t j = 0;

        while (j < T->ncol && fabs(ritz_dense_col(T, j)[i] -
                                   entry[j * stride]) <= RITZ_SAME * size)
            j++;
        if (j < T->ncol)
            continue;
        if (found > 0 && (found > 3) != (reduced->dof[i].component > 3))
            return 0;
        found = (int)reduced->dof[i].component;
    }
    return found;
}

/* ---- ports -------------------------------------------------------------- */

static void describe_input(const ritz_reduced *reduced, const unit_labels *l,
                           int64_t j, ritz_fmu_port *port)
{
    const int component =
        reduced && reduced->T.val && reduced->dof
            ? find_component(reduced, ritz_dense_col(&reduced->io.B, j), 1)
            : 0;

    port->says = !reduced         ? "input"
                 : component == 0 ? "force or moment"
                 : component <= 3 ? "force"
                                  : "moment";
    if (component > 0 && l->of[MASS].text)
        port->unit = force_unit(l, component > 3);
}

/* Whether row i of C is not zero. */
static bool has_row(const ritz_dense *C, int64_t i)
{
    for (int64_t j = 0; j < C->ncol; j++)
        if (ritz_dense_col(C, j)[i] != 0.0)
            return true;
    return false;
}

static void describe_output(const ritz_reduced *reduced, const unit_labels *l,
                            int64_t i, ritz_fmu_port *port)
{
    static const char *const kinds[3][3] = {
        {"displacement or rotation", "velocity", "acceleration"},
        {"displacement", "velocity", "acceleration"},
        {"rotation", "angular velocity", "angular acceleration"}};
    const ritz_io *io = &reduced->io;
    const ritz_dense *const of[3] = {&io->C, &io->Cv, &io->Ca};
    int order = -1;
    int component = 0;

    for (int k = 0; k < 3; k++)
        if (has_row(of[k], i)) {
            port->says = order < 0 ? kinds[0][k] : "motion";
            order = k;
        }
    if (order < 0 || port->says != kinds[0][order])
        return;
    if (reduced->T.val && reduced->dof)
        component =
            find_component(reduced, of[order]->val + i, io->num_outputs);
    port->says = kinds[(component > 0) + (component > 3)][order];
    if (component > 0 && l->of[MASS].text)
        port->unit = motion_unit(l, component > 3, order);
}

ritz_status ritz_fmu_name_ports(const ritz_export_object *object,
                                const ritz_io *io, ritz_fmu *fmu)
{
    const ritz_reduced *reduced = object->reduced;
    const unit_labels l =
        read_labels(reduced ? reduced->units : object->states->units);
    names_taken t = {.fmu = fmu};

    RITZ_CHECK_NEW(fmu->input, fmu->num_inputs);
    RITZ_CHECK_NEW(fmu->output, fmu->num_outputs);
    if (l.of[TIME].text)
        fmu->seconds =
            (ritz_fmu_unit){.s = 1, .factor = pow(10.0, l.of[TIME].power)};
    snprintf(fmu->seconds.name, sizeof fmu->seconds.name, "%s",
             l.of[TIME].text ? l.of[TIME].text : "");
    for (; t.inputs < fmu->num_inputs; t.inputs++) {
        ritz_fmu_port *port = &fmu->input[t.inputs];

        fmu->num_renamed +=
            choose_name(&t, io->input[t.inputs], "input", port->name);
        describe_input(reduced, &l, t.inputs, port);
        fmu->num_without_unit += !*port->unit.name;
    }
    for (; t.outputs < fmu->num_outputs; t.outputs++) {
        ritz_fmu_port *port = &fmu->output[t.outputs];

        port->says = "output";
        fmu->num_renamed +=
            choose_name(&t, io->output[t.outputs], "output", port->name);
        if (reduced)
            describe_output(reduced, &l, t.outputs, port);
        fmu->num_without_unit += !*port->unit.name;
    }
    return RITZ_OK;
}
