/*
 * State spaces from matrix files,
 *
 *     E x' = A x + B u,   y = C x + D u
 *
 * "A=F,B=F,C=F[,D=F][,E=F]", each F being a matrix file; or one file, "FILE" or
 * "FILE:NAME", with matrices of these names, NAME.A or A of a struct too.
 * Without a file D is zero and E the identity. An E that is the identity is
 * dropped, so that no solver factors it. Large sparse A and E stay sparse.
 */
#include "import/import.h"

#include "base/alloc.h"

#include <ritz/import.h>

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum { PART_A, PART_B, PART_C, PART_D, PART_E, NUM_PARTS };

static const char letters[] = "ABCDE";

/* Matrices of the five letters; `there` those that were found. */
typedef struct parts {
    ritz_matrix matrix[NUM_PARTS];
    bool there[NUM_PARTS];
} parts;

static void parts_free(parts *p)
{
    for (int k = 0; k < NUM_PARTS; k++)
        ritz_matrix_free(&p->matrix[k]);
}

/* Index of the letter that "X=..." begins with; -1: none. */
static int letter_of(const char *text)
{
    const char *found = *text ? strchr(letters, *text) : NULL;

    return found && text[1] == '=' ? (int)(found - letters) : -1;
}

/* Where the item at `text` ends: at a comma before the next letter. */
static const char *end_of(const char *text)
{
    const char *comma = strchr(text, ',');

    while (comma && letter_of(comma + 1) < 0)
        comma = strchr(comma + 1, ',');
    return comma ? comma : text + strlen(text);
}

bool ritz_import_space_next(const char **at, char *out)
{
    const char *from = *at;
    const char *end = NULL;

    if (!*from)
        return false;
    end = end_of(from);
    if (letter_of(from) >= 0)
        from += 2;
    memcpy(out, from, (size_t)(end - from));
    out[end - from] = '\0';
    *at = end + (*end != '\0');
    return true;
}

/* The specs of "A=F,B=F,..." one behind the other in @p specs. */
static ritz_status list_specs(const char *text, char *specs, parts *out,
                              int *count, ritz_wanted wanted[NUM_PARTS])
{
    while (*text) {
        int k = letter_of(text);

        RITZ_REFUSE_IF(k < 0, RITZ_ERR_ARGUMENT,
                       "'%s' is not of the form A=F,B=F,C=F[,D=F][,E=F]", text);
        RITZ_REFUSE_IF(out->there[k], RITZ_ERR_ARGUMENT, "'%c' is given twice",
                       letters[k]);
        ritz_import_space_next(&text, specs);
        wanted[(*count)++] =
            (ritz_wanted){.spec = specs, .into = &out->matrix[k]};
        out->there[k] = true;
        specs += strlen(specs) + 1;
    }
    return RITZ_OK;
}

static ritz_status take_listed(const char *text, ritz_file_sums *sums,
                               parts *out)
{
    ritz_wanted wanted[NUM_PARTS];
    RITZ_OWN_ARRAY char *specs = NULL;
    int count = 0;

    RITZ_CHECK_NEW(specs, (int64_t)strlen(text) + 1);
    RITZ_CHECK(list_specs(text, specs, out, &count, wanted));
    return ritz_foreign_collect(count, wanted, sums);
}

static char fold_case(char c)
{
    return (char)(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
}

/* Index of "STEM.A" or "A"; as it stands before other case; -1: none. */
static int64_t find_letter(const ritz_listing *all, const char *stem,
                           char letter)
{
    int64_t found = -1;
    size_t length = strlen(stem);

    for (int64_t k = 0; k < all->count; k++) {
        const char *name = all->item[k].name;

        if (strncmp(name, stem, length) != 0)
            continue;
        name += length;
        if (length > 0 && *name++ != '.')
            continue;
        if (name[0] && !name[1] && name[0] == letter)
            return k;
        if (name[0] && !name[1] && fold_case(name[0]) == letter && found < 0)
            found = k;
    }
    return found;
}

/* The stem of "sys.A" if no other struct has an A; "" if there is none. */
static ritz_status find_stem(const ritz_listing *all, const char *file,
                             char stem[RITZ_NAME_SIZE])
{
    int64_t found = 0;

    stem[0] = '\0';
    if (find_letter(all, "", 'A') >= 0)
        return RITZ_OK;
    for (int64_t k = 0; k < all->count; k++) {
        const char *name = all->item[k].name;
        const char *dot = strrchr(name, '.');

        if (!dot || fold_case(dot[1]) != 'A' || dot[2])
            continue;
        RITZ_REFUSE_IF(found++ > 0, RITZ_ERR_ARGUMENT,
                       "'%s' holds several state spaces: name one, as %s:%s",
                       file, file, stem);
        snprintf(stem, RITZ_NAME_SIZE, "%.*s", (int)(dot - name), name);
    }
    RITZ_REFUSE_IF(found == 0, RITZ_ERR_FORMAT,
                   "'%s' holds no matrix 'A': name each, as A=FILE:NAME,B=...",
                   file);
    return RITZ_OK;
}

/* The matrices of one stem in a file that is open. */
static ritz_status take_stem(const ritz_foreign *file, const char *stem,
                             parts *out)
{
    const ritz_listing *all = &file->listing;

    for (int k = 0; k < NUM_PARTS; k++) {
        int64_t at = find_letter(all, stem, letters[k]);

        if (at < 0)
            continue;
        RITZ_REFUSE_IF(all->item[at].other[0], RITZ_ERR_FORMAT,
                       "'%s' of '%s' is %s", all->item[at].name, file->path,
                       all->item[at].other);
        RITZ_CHECK(ritz_foreign_context(
            file, ritz_foreign_take(file, at, &out->matrix[k])));
        out->there[k] = true;
    }
    return RITZ_OK;
}

/* "FILE[:NAME]" */
static ritz_status take_file(const char *text, ritz_file_sums *sums, parts *out)
{
    RITZ_OWN(ritz_foreign) file = {0};
    RITZ_OWN_ARRAY char *path = NULL;
    char stem[RITZ_NAME_SIZE] = "";

    RITZ_CHECK(ritz_foreign_path(text, &path));
    RITZ_CHECK(ritz_foreign_open(path, &file));
    RITZ_CHECK(ritz_foreign_context(&file, ritz_foreign_list(&file)));
    if (strlen(path) < strlen(text))
        snprintf(stem, sizeof stem, "%s", text + strlen(path) + 1);
    else
        RITZ_CHECK(find_stem(&file.listing, path, stem));
    RITZ_CHECK(take_stem(&file, stem, out));
    return sums ? ritz_file_sums_add(sums, path, ritz_foreign_digest(&file))
                : RITZ_OK;
}

/* A, B and C are there, all are real, and they are as large as A says. */
static ritz_status check_parts(const parts *p)
{
    const int64_t n = p->matrix[PART_A].A.nrow;
    const int64_t sizes[NUM_PARTS][2] = {
        {n, n},
        {n, p->matrix[PART_B].A.ncol},
        {p->matrix[PART_C].A.nrow, n},
        {p->matrix[PART_C].A.nrow, p->matrix[PART_B].A.ncol},
        {n, n},
    };

    for (int k = 0; k <= PART_C; k++)
        RITZ_REFUSE_IF(!p->there[k], RITZ_ERR_ARGUMENT, "there is no '%c'",
                       letters[k]);
    for (int k = 0; k < NUM_PARTS; k++) {
        const ritz_matrix *m = &p->matrix[k];

        if (!p->there[k])
            continue;
        RITZ_REFUSE_IF(m->imaginary, RITZ_ERR_FORMAT,
                       "'%c' is complex, a real matrix is due", letters[k]);
        RITZ_REFUSE_IF(m->A.nrow == 0 || m->A.ncol == 0, RITZ_ERR_FORMAT,
                       "'%c' is empty", letters[k]);
        RITZ_REFUSE_IF(m->A.nrow != sizes[k][0] || m->A.ncol != sizes[k][1],
                       RITZ_ERR_FORMAT,
                       "'%c' is %" PRId64 " x %" PRId64 " where %" PRId64
                       " x %" PRId64 " is due",
                       letters[k], m->A.nrow, m->A.ncol, sizes[k][0],
                       sizes[k][1]);
    }
    return RITZ_OK;
}

static int64_t count_entries(const ritz_sparse *A)
{
    int64_t count = 0;

    for (int64_t p = 0; A->colptr && p < A->colptr[A->ncol]; p++)
        count += A->val[p] != 0.0;
    return count;
}

static bool is_identity(const ritz_sparse *E)
{
    for (int64_t j = 0; j < E->ncol; j++)
        if (ritz_sparse_diagonal(E, j) != 1.0)
            return false;
    return count_entries(E) == E->ncol;
}

/*
 * Decide whether A and E stay sparse.
 * @return RITZ_ERR_ARGUMENT if they have too many states to be dense and too
 *         many entries to be sparse
 */
static ritz_status choose_form(const parts *p, bool *sparse)
{
    const int64_t most = 2 * (int64_t)RITZ_STATE_DOFS;
    const ritz_sparse *A = &p->matrix[PART_A].A, *E = &p->matrix[PART_E].A;
    double entries = (double)count_entries(A) + (double)count_entries(E);
    double all = (double)A->nrow * (double)A->nrow * (p->there[PART_E] ? 2 : 1);

    *sparse = A->nrow > RITZ_SPARSE_STATES && entries <= all / 10.0;
    RITZ_REFUSE_IF(!*sparse && A->nrow > most, RITZ_ERR_ARGUMENT,
                   "'A' is %" PRId64 " x %" PRId64
                   ": state spaces are dense, of at most %" PRId64
                   " states, or sparse, with at most a tenth of A and E not "
                   "zero",
                   A->nrow, A->nrow, most);
    for (int k = PART_B; k <= PART_C; k++) {
        const ritz_sparse *part = &p->matrix[k].A;

        RITZ_REFUSE_IF((k == PART_B ? part->ncol : part->nrow) > most,
                       RITZ_ERR_ARGUMENT,
                       "'%c' is %" PRId64 " x %" PRId64 ": at most %" PRId64
                       " inputs and outputs are taken",
                       letters[k], part->nrow, part->ncol, most);
    }
    return RITZ_OK;
}

/* Copy the matrices that were given; the others stay zero. */
static ritz_status fill_matrices(const parts *p, bool sparse,
                                 ritz_state_space *model)
{
    ritz_dense *const into[NUM_PARTS] = {&model->A, &model->B, &model->C,
                                         &model->D, &model->E};

    for (int k = 0; k < NUM_PARTS; k++) {
        if (!p->there[k] || (sparse && (k == PART_A || k == PART_E)))
            continue;
        if (k == PART_E && is_identity(&p->matrix[k].A))
            continue;
        ritz_dense_free(into[k]);
        RITZ_CHECK(ritz_sparse_dense(&p->matrix[k].A, into[k]));
    }
    return RITZ_OK;
}

static ritz_status start_space(const parts *p, bool sparse, const ritz_io *io,
                               ritz_state_space *out)
{
    static const ritz_sparse none = {0};
    const ritz_sparse *E = &p->matrix[PART_E].A;
    bool plain = !p->there[PART_E] || is_identity(E);

    return sparse ? ritz_state_space_of_sparse(&p->matrix[PART_A].A,
                                               plain ? &none : E, io, out)
                  : ritz_state_space_new(p->matrix[PART_A].A.nrow, io, out);
}

static ritz_status make_space(const ritz_import_space_request *request,
                              const parts *p, ritz_state_space *out)
{
    RITZ_OWN(ritz_io) io = {0};
    bool sparse = false;

    RITZ_CHECK(choose_form(p, &sparse));
    RITZ_CHECK(ritz_io_new(0, p->matrix[PART_B].A.ncol,
                           p->matrix[PART_C].A.nrow, &io));
    RITZ_CHECK_IN("--input-names",
                  ritz_import_channels(request->inputs, 'u', io.num_inputs,
                                       io.input, NULL));
    RITZ_CHECK_IN("--output-names",
                  ritz_import_channels(request->outputs, 'y', io.num_outputs,
                                       io.output, io.limit));
    RITZ_CHECK(start_space(p, sparse, &io, out));
    RITZ_CHECK(fill_matrices(p, sparse, out));
    RITZ_CHECK(ritz_state_space_check(out));
    if (request->units)
        RITZ_CHECK_IN("--units", ritz_import_units(request->units, out->units));
    return RITZ_OK;
}

ritz_status ritz_import_state_space(const ritz_import_space_request *request,
                                    ritz_state_space *out)
{
    RITZ_OWN(ritz_state_space) model = {0};
    RITZ_OWN(parts) p = {0};

    if (letter_of(request->matrices) >= 0)
        RITZ_CHECK(take_listed(request->matrices, request->sums, &p));
    else
        RITZ_CHECK(take_file(request->matrices, request->sums, &p));
    RITZ_CHECK(check_parts(&p));
    RITZ_CHECK(make_space(request, &p, &model));
    RITZ_MOVE(*out, model);
    return RITZ_OK;
}
