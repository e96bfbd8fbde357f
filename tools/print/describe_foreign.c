/* Matrix files and decks of other codes. */
#include "print/checksum.h"
#include "print/describe.h"

#include <math.h>

static void set_int(json_t *keys, const char *key, int64_t value)
{
    json_object_set_new(keys, key, json_integer(value));
}

static void set_text(json_t *keys, const char *key, const char *text)
{
    json_object_set_new(keys, key, cli_string(text));
}

/* What is none: its name, and what it is. */
static void describe_other(const cli_run *run, json_t *array,
                           const ritz_matrix *a)
{
    json_t *item = json_object();

    cli_say(run, "  %-10s %17s %s", *a->name ? a->name : "-", "-", a->other);
    set_text(item, "name", a->name);
    set_text(item, "other", a->other);
    json_array_append_new(array, item);
}

/* One matrix: a line, and its object in the array. */
static void describe_matrix(const cli_run *run, json_t *array, json_t *sums,
                            const ritz_matrix *a)
{
    bool square = a->A.nrow == a->A.ncol;
    double skew = square ? ritz_sparse_asymmetry(&a->A) : (double)NAN;
    char sum[RITZ_DIGEST_SIZE];
    char form[32];
    char size[48];
    json_t *item = json_object();

    checksum_sparse(&a->A, sum);
    snprintf(form, sizeof form, "%s%s",
             a->symmetric ? "symmetric"
             : square     ? "square"
                          : "rectangular",
             a->imaginary ? " complex" : "");
    snprintf(size, sizeof size, "%lld x %lld", (long long)a->A.nrow,
             (long long)a->A.ncol);
    cli_say(run, "  %-10s %17s %10lld %-17s %6lld %9.1e  %s",
            *a->name ? a->name : "-", size, (long long)a->A.colptr[a->A.ncol],
            form, (long long)a->digits, skew, a->spelling);
    set_text(item, "name", a->name);
    set_int(item, "rows", a->A.nrow);
    set_int(item, "columns", a->A.ncol);
    set_int(item, "entries", a->A.colptr[a->A.ncol]);
    json_object_set_new(item, "symmetric", json_boolean(a->symmetric));
    json_object_set_new(item, "complex", json_boolean(a->imaginary));
    json_object_set_new(item, "asymmetry", cli_real(skew));
    set_int(item, "digits", a->digits);
    set_text(item, "spelling", a->spelling);
    json_object_set_new(item, "dofs_named", json_boolean(a->row));
    set_text(item, "checksum", sum);
    set_text(sums, a->name, sum);
    json_array_append_new(array, item);
}

void describe_matrices(const cli_run *run, json_t *keys, const ritz_matrices *m)
{
    json_t *array = json_array();
    json_t *sums = json_object();

    cli_say(run, "  %-14s %s, %lld matrices", "format", m->format,
            (long long)m->count);
    cli_say(run, "  %-10s %17s %10s %-17s %6s %9s  %s", "name", "size",
            "entries", "form", "digits", "asymmetry", "spelling");
    for (int64_t k = 0; k < m->count; k++) {
        if (*m->matrix[k].other)
            describe_other(run, array, &m->matrix[k]);
        else
            describe_matrix(run, array, sums, &m->matrix[k]);
    }
    set_text(keys, "kind", "matrices");
    set_text(keys, "format", m->format);
    json_object_set_new(keys, "matrices", array);
    json_object_set_new(keys, "checksums", sums);
}

void describe_deck(const cli_run *run, json_t *keys, const ritz_deck *deck)
{
    static const char *const name[] = {"a_set", "b_set", "q_set"};
    static const char *const title[] = {"a-set", "b-set", "q-set"};
    json_t *constraints = json_array();

    cli_say(run, "  %-14s %s", "kind", deck->format->title);
    cli_say(run, "  %-14s %lld, in %lld displacement frames", "grids",
            (long long)deck->grids.count, (long long)deck->grids.num_frames);
    cli_say(run, "  %-14s %lld", "scalar points", (long long)deck->num_points);
    cli_say(run, "  %-14s %lld dofs", "fixed", (long long)deck->num_fixed);
    set_text(keys, "kind", deck->format->name);
    set_int(keys, "grids", deck->grids.count);
    set_int(keys, "frames", deck->grids.num_frames);
    set_int(keys, "scalar_points", deck->num_points);
    set_int(keys, "fixed", deck->num_fixed);
    for (int k = RITZ_SET_A; k <= RITZ_SET_Q; k++) {
        set_int(keys, name[k], deck->num_sets[k]);
        if (deck->num_sets[k] > 0)
            cli_say(run, "  %-14s %lld dofs", title[k],
                    (long long)deck->num_sets[k]);
    }
    for (int64_t k = 0; k < deck->num_constraints; k++) {
        json_array_append_new(constraints, cli_string(deck->constraint[k]));
        if (k < 10)
            cli_say(run, "  %-14s %s", k > 0 ? "" : "constraints",
                    deck->constraint[k]);
    }
    if (deck->num_constraints > 10)
        cli_say(run, "  %-14s and %lld more", "",
                (long long)(deck->num_constraints - 10));
    json_object_set_new(keys, "constraints", constraints);
    if (deck->num_constraints > 0)
        cli_say(run, "  %-14s %lld dofs, by these", "dependent",
                (long long)deck->equations.count);
    if (deck->equations.refused)
        cli_say(run, "  %-14s %s", "", deck->equations.refused);
    set_int(keys, "dependent", deck->equations.count);
}
