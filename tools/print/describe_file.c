/* Files: containers, and matrix files and decks of other codes. */
#include "print/print.h"

/* One matrix of a file, of which one at a time is held: a line and an item. */
static ritz_status describe_values(cli_run *run, const ritz_foreign *file,
                                   int64_t k)
{
    RITZ_OWN(ritz_matrix) a = {0};
    char sum[RITZ_DIGEST_SIZE] = "";
    char form[32], size[48];
    bool square = false;

    RITZ_CHECK(ritz_foreign_take(file, k, &a));
    RITZ_CHECK(checksum_sparse(run, a.name, &a.A, sum));
    square = a.A.nrow == a.A.ncol;
    snprintf(form, sizeof form, "%s%s",
             a.symmetric ? "symmetric"
             : square    ? "square"
                         : "rectangular",
             a.imaginary ? " complex" : "");
    snprintf(size, sizeof size, "%ld x %ld", a.A.nrow, a.A.ncol);
    sink_list(run, "matrices");
    sink_object(run, NULL);
    sink_set(run, "name,rows,columns,symmetric,complex,dofs_named,checksum",
             "%s %ld %ld %d %d %d %s", a.name, a.A.nrow, a.A.ncol, a.symmetric,
             a.imaginary != NULL, a.row != NULL, sum);
    sink_say(run, ",,entries,,digits,asymmetry,spelling",
             "  %-10s %17s %10ld %-17s %6ld %9.1e  %s", *a.name ? a.name : "-",
             size, a.A.colptr[a.A.ncol], form, a.digits,
             square ? ritz_sparse_asymmetry(&a.A) : (double)NAN, a.spelling);
    sink_end(run);
    sink_end(run);
    return RITZ_OK;
}

/*
 * A matrix by its entry in the file's directory, where some formats give no
 * sizes; variables that are no matrices are told by what they are.
 */
static void describe_listed(cli_run *run, const ritz_listed *one)
{
    const char *name = *one->name ? one->name : "-";
    char size[48] = "-";

    if (one->nrow >= 0)
        snprintf(size, sizeof size, "%ld x %ld", one->nrow, one->ncol);
    sink_list(run, "matrices");
    sink_object(run, NULL);
    sink_set(run, "name", "%s", one->name);
    if (*one->other) {
        sink_say(run, ",,other", "  %-10s %17s %s", name, "-", one->other);
    } else {
        sink_set(run, "symmetric,complex", "%d %d", one->symmetric,
                 one->is_complex);
        if (one->nrow >= 0)
            sink_set(run, "rows,columns", "%ld %ld", one->nrow, one->ncol);
        cli_say(run, "  %-10s %17s %s%s", name, size,
                one->symmetric ? "symmetric" : "",
                one->is_complex ? " complex" : "");
    }
    sink_end(run);
    sink_end(run);
}

static ritz_status describe_matrices(cli_run *run, const ritz_foreign *file,
                                     bool directory)
{
    const ritz_listing *all = &file->listing;

    sink_set(run, "kind", "%s", "matrices");
    sink_field(run, "format", "format", "%s, %ld matrices", file->format->name,
               all->count);
    if (directory)
        cli_say(run, "  %-10s %17s %s", "name", "size", "form");
    else
        cli_say(run, "  %-10s %17s %10s %-17s %6s %9s  %s", "name", "size",
                "entries", "form", "digits", "asymmetry", "spelling");
    sink_object(run, "checksums");
    sink_end(run);
    for (int64_t k = 0; k < all->count; k++)
        if (directory || *all->item[k].other)
            describe_listed(run, &all->item[k]);
        else
            RITZ_CHECK(describe_values(run, file, k));
    return RITZ_OK;
}

static void describe_deck(cli_run *run, const ritz_deck *deck)
{
    static const char *const name[] = {"a_set", "b_set", "q_set"};
    static const char *const title[] = {"a-set", "b-set", "q-set"};

    sink_set(run, "kind,dependent", "%s %ld", deck->format->name,
             deck->equations.count);
    sink_field(run, "kind", "", "%s", deck->format->title);
    sink_field(run, "grids", "grids,frames", "%ld, in %ld displacement frames",
               deck->grids.count, deck->grids.num_frames);
    sink_field(run, "scalar points", "scalar_points", "%ld", deck->num_points);
    sink_field(run, "fixed", "fixed", "%ld dofs", deck->num_fixed);
    for (int k = RITZ_SET_A; k <= RITZ_SET_Q; k++) {
        sink_set(run, name[k], "%ld", deck->num_sets[k]);
        if (deck->num_sets[k] > 0)
            cli_say(run, "  %-14s %ld dofs", title[k], deck->num_sets[k]);
    }
    SINK_EACH(run, "constraints", k, deck->num_constraints) {
        sink_add(run, "%s", deck->constraint[k]);
        if (k < 10)
            cli_say(run, "  %-14s %s", k > 0 ? "" : "constraints",
                    deck->constraint[k]);
    }
    if (deck->num_constraints > 10)
        sink_field(run, "", "", "and %ld more", (deck->num_constraints - 10));
    if (deck->num_constraints > 0)
        sink_field(run, "dependent", "", "%ld dofs, by these",
                   deck->equations.count);
    if (deck->equations.refused)
        sink_field(run, "", "", "%s", deck->equations.refused);
    if (deck->unnumbered)
        sink_field(run, "", "", "%s", deck->unnumbered);
}

/* Any of them, by its kind. */
static ritz_status describe_model(cli_run *run, const model *m)
{
    switch (m->kind) {
#define DESCRIBE_KIND(KIND, type, member, name, noun)                          \
    case MODEL_##KIND:                                                         \
        sink_set(run, "kind", "%s", name);                                     \
        return describe_##member(run, &m->member);
        MODEL_EACH_KIND(DESCRIBE_KIND)
    case MODEL_ANY:
        break;
    }
    return ritz_fail(RITZ_ERR_FORMAT, "nothing is known of this kind");
}

void describe_remarks(cli_run *run, const ritz_scene *scene,
                      const ritz_reduced *body)
{
    SINK_EACH(run, "notes", k, scene->num_components) {
        const char *name = scene->component[k].name;

        if (!body[k].remark[0])
            continue;
        sink_object(run, NULL);
        sink_set(run, "component,note", "%s %s", name, body[k].remark);
        sink_end(run);
        cli_say(run, "  %-14s basis of %s: %s", "note", name, body[k].remark);
    }
}

ritz_status describe_output(cli_run *run, const model *m)
{
    ritz_status status = RITZ_OK;

    RITZ_CHECK(model_write(run, m));
    cli_say(run, "%s:", run->output);
    run->unread = run->quiet && !run->json;
    status = describe_model(run, m);
    run->unread = false;
    return status;
}

static void describe_member(const ritz_container_row *row, void *data)
{
    cli_run *run = data;

    sink_say(run, "member,type,shape", "  %-30s %-16s %s", row->name, row->type,
             row->shape);
}

static ritz_status describe_container(cli_run *run, const char *path,
                                      bool members)
{
    RITZ_OWN(ritz_summary) summary = {0};
    RITZ_OWN(model) m = {0};

    sink_names(run, NULL, "made_from", 0, NULL);
    RITZ_CHECK(model_read(run, path, MODEL_ANY, &m));
    RITZ_CHECK(ritz_container_summary(path, &summary));
    RITZ_CHECK_IN(path, describe_model(run, &m));
    if (members) {
        sink_list(run, "members");
        ritz_container_members(summary.kind, model_object(&m), describe_member,
                               run);
        sink_end(run);
    }
    sink_field(run, "made by", "command", "%s", summary.command);
    sink_field(run, "version", "made_by_version", "ritz %s", summary.version);
    if (summary.interrupted[0])
        sink_field(run, "interrupted", "interrupted", "%s",
                   summary.interrupted);
    SINK_EACH(run, "made_from", k, summary.num_inputs) {
        cli_say(run, "  %-14s %s", k > 0 ? "" : "from", summary.input[k]);
        sink_add(run, "%s", summary.input[k]);
    }
    return RITZ_OK;
}

static ritz_status describe_text(cli_run *run, const ritz_foreign *file)
{
    RITZ_OWN(ritz_deck) deck = {0};

    RITZ_REFUSE_IF(file->size == 0, RITZ_ERR_FORMAT, "'%s' is empty",
                   file->path);
    RITZ_CHECK_IN(file->path, ritz_unread_refuse(file->bytes, file->size));
    RITZ_REFUSE_IF(
        !ritz_deck_recognise(file->bytes, file->size), RITZ_ERR_FORMAT,
        "'%s' is neither a container nor a matrix file nor text", file->path);
    RITZ_CHECK(ritz_deck_parse(file->path, file->bytes, file->size,
                               file->folder, &deck));
    RITZ_REFUSE_IF(deck.grids.count + deck.num_points + deck.num_fixed +
                           deck.num_constraints + deck.num_sets[RITZ_SET_A] +
                           deck.num_sets[RITZ_SET_B] +
                           deck.num_sets[RITZ_SET_Q] ==
                       0,
                   RITZ_ERR_FORMAT,
                   "'%s' is no container, no matrix file that Ritz knows, and "
                   "no bulk data with grids",
                   file->path);
    describe_deck(run, &deck);
    return RITZ_OK;
}

static ritz_status describe_foreign(cli_run *run, const char *path,
                                    bool directory)
{
    RITZ_OWN(ritz_foreign) file = {0};

    RITZ_CHECK(cli_input_unread(run, path));
    RITZ_CHECK(ritz_foreign_open(path, &file));
    cli_input_sum(run, path, ritz_foreign_digest(&file));
    if (!file.format)
        return describe_text(run, &file);
    RITZ_CHECK_IN(path, ritz_foreign_list(&file));
    return ritz_context(describe_matrices(run, &file, directory), path);
}

ritz_status describe_file(cli_run *run, const char *path, bool members,
                          bool directory)
{
    return ritz_container_seems(path) ? describe_container(run, path, members)
                                      : describe_foreign(run, path, directory);
}
