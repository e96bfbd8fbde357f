/* Matrix files and decks of other codes. */
#include "print/checksum.h"
#include "print/describe.h"

#include <math.h>

/* One matrix of a file: a line and an item; its checksum comes later. */
static void describe_matrix(cli_run *run, const ritz_matrix *a, const char *sum)
{
    bool square = a->A.nrow == a->A.ncol;
    char form[32];
    char size[48];

    snprintf(form, sizeof form, "%s%s",
             a->symmetric ? "symmetric"
             : square     ? "square"
                          : "rectangular",
             a->imaginary ? " complex" : "");
    snprintf(size, sizeof size, "%lld x %lld", (long long)a->A.nrow,
             (long long)a->A.ncol);
    sink_object(run, NULL);
    sink_set(run, "name,rows,columns,symmetric,complex,dofs_named,checksum",
             "%s %lld %lld %d %d %d %s", a->name, (long long)a->A.nrow,
             (long long)a->A.ncol, a->symmetric, a->imaginary != NULL,
             a->row != NULL, sum);
    sink_say(run, ",,entries,,digits,asymmetry,spelling",
             "  %-10s %17s %10lld %-17s %6lld %9.1e  %s",
             *a->name ? a->name : "-", size, (long long)a->A.colptr[a->A.ncol],
             form, (long long)a->digits,
             square ? ritz_sparse_asymmetry(&a->A) : (double)NAN, a->spelling);
    sink_end(run);
}

/* Variables of a file that are no matrices are told by what they are. */
static void describe_other(cli_run *run, const ritz_listed *one)
{
    sink_object(run, NULL);
    sink_set(run, "name", "%s", one->name);
    sink_say(run, ",,other", "  %-10s %17s %s", *one->name ? one->name : "-",
             "-", one->other);
    sink_end(run);
}

/* What the directory says of a matrix; sizes are not in every format's. */
static void describe_listed(cli_run *run, const ritz_listed *one)
{
    char size[48] = "-";

    if (one->nrow >= 0)
        snprintf(size, sizeof size, "%lld x %lld", (long long)one->nrow,
                 (long long)one->ncol);
    sink_object(run, NULL);
    sink_set(run, "name,symmetric,complex", "%s %d %d", one->name,
             one->symmetric, one->is_complex);
    if (one->nrow >= 0)
        sink_set(run, "rows,columns", "%lld %lld", (long long)one->nrow,
                 (long long)one->ncol);
    cli_say(run, "  %-10s %17s %s%s", *one->name ? one->name : "-", size,
            one->symmetric ? "symmetric" : "",
            one->is_complex ? " complex" : "");
    sink_end(run);
}

/* One matrix of the file is held at a time. */
static ritz_status describe_values(cli_run *run, const ritz_foreign *file,
                                   int64_t k)
{
    char sum[RITZ_DIGEST_SIZE] = "";
    ritz_matrix matrix = {0};

    RITZ_CHECK(ritz_foreign_take(file, k, &matrix));
    checksum_sparse(&matrix.A, sum);
    checksum_set(run, matrix.name, sum);
    sink_list(run, "matrices");
    describe_matrix(run, &matrix, sum);
    ritz_matrix_free(&matrix);
    return RITZ_OK;
}

ritz_status describe_matrices(cli_run *run, const ritz_foreign *file,
                              bool directory)
{
    const ritz_listing *all = &file->listing;

    sink_set(run, "kind", "%s", "matrices");
    sink_field(run, "format", "format", "%s, %lld matrices", file->format->name,
               (long long)all->count);
    if (directory)
        cli_say(run, "  %-10s %17s %s", "name", "size", "form");
    else
        cli_say(run, "  %-10s %17s %10s %-17s %6s %9s  %s", "name", "size",
                "entries", "form", "digits", "asymmetry", "spelling");
    sink_object(run, "checksums");
    sink_end(run);
    for (int64_t k = 0; k < all->count; k++) {
        bool values = !directory && !*all->item[k].other;

        if (values)
            RITZ_CHECK(describe_values(run, file, k));
        else
            sink_list(run, "matrices");
        if (*all->item[k].other)
            describe_other(run, &all->item[k]);
        else if (directory)
            describe_listed(run, &all->item[k]);
        sink_end(run);
    }
    return RITZ_OK;
}

void describe_deck(cli_run *run, const ritz_deck *deck)
{
    static const char *const name[] = {"a_set", "b_set", "q_set"};
    static const char *const title[] = {"a-set", "b-set", "q-set"};

    sink_set(run, "kind,dependent", "%s %lld", deck->format->name,
             (long long)deck->equations.count);
    cli_say(run, "  %-14s %s", "kind", deck->format->title);
    sink_field(run, "grids", "grids,frames",
               "%lld, in %lld displacement frames",
               (long long)deck->grids.count, (long long)deck->grids.num_frames);
    sink_field(run, "scalar points", "scalar_points", "%lld",
               (long long)deck->num_points);
    sink_field(run, "fixed", "fixed", "%lld dofs", (long long)deck->num_fixed);
    for (int k = RITZ_SET_A; k <= RITZ_SET_Q; k++) {
        sink_set(run, name[k], "%lld", (long long)deck->num_sets[k]);
        if (deck->num_sets[k] > 0)
            cli_say(run, "  %-14s %lld dofs", title[k],
                    (long long)deck->num_sets[k]);
    }
    sink_list(run, "constraints");
    for (int64_t k = 0; k < deck->num_constraints; k++) {
        sink_add(run, "%s", deck->constraint[k]);
        if (k < 10)
            cli_say(run, "  %-14s %s", k > 0 ? "" : "constraints",
                    deck->constraint[k]);
    }
    sink_end(run);
    if (deck->num_constraints > 10)
        cli_say(run, "  %-14s and %lld more", "",
                (long long)(deck->num_constraints - 10));
    if (deck->num_constraints > 0)
        cli_say(run, "  %-14s %lld dofs, by these", "dependent",
                (long long)deck->equations.count);
    if (deck->equations.refused)
        cli_say(run, "  %-14s %s", "", deck->equations.refused);
}
