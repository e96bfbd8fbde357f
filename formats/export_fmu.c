/*
 * Writes Functional Mock-up Units of FMI 2.0 [FmiTwo2024] or 3.0
 * [FmiThree2024], for model exchange and co-simulation. All contain the same
 * program, built from fmu/ and copied from the folder where Ritz is installed.
 * It reads the numbers of the model from resources/ritz.bin. The token by which
 * importers tell models apart is the SHA-256 of numbers, description and
 * documentation page, so that the same model always gives the same bytes.
 */
#include "base/alloc.h"
#include "base/text.h"
#include "formats/certificate.h"
#include "formats/fmu.h"
#include "formats/sink.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* The model, and the contents of the files in the archive. */
typedef struct fmu_texts {
    ritz_fmu fmu;
    char name[RITZ_NAME_SIZE];
    char token[RITZ_DIGEST_SIZE];
    char *certificate, *page, *description;
    unsigned char *numbers;
    unsigned char *program, *licence;
    int64_t page_size, description_size, numbers_size, program_size,
        licence_size;
} fmu_texts;

static void fmu_texts_free(fmu_texts *p)
{
    ritz_fmu_free(&p->fmu);
    RITZ_FREE(p->certificate, p->page, p->description, p->numbers, p->program,
              p->licence);
    *p = (fmu_texts){0};
}

/* ---- what is installed -------------------------------------------------- */

static ritz_status read_installed(const char *folder, const char *name,
                                  unsigned char **bytes, int64_t *size)
{
    RITZ_OWN_ARRAY char *path = NULL;
    FILE *file = NULL;
    bool whole = false;
    long end = 0;

    RITZ_CHECK_NEW(path, (int64_t)(strlen(folder) + strlen(name)) + 2);
    sprintf(path, "%s/%s", folder, name);
    file = fopen(path, "rb");
    RITZ_REFUSE_IF(!file, RITZ_ERR_FILE,
                   "'%s', which is installed with the tools, cannot be read: "
                   "%s",
                   path, strerror(errno));
    if (fseek(file, 0, SEEK_END) == 0 && (end = ftell(file)) >= 0 &&
        fseek(file, 0, SEEK_SET) == 0)
        *bytes = ritz_alloc(end, 1);
    whole = *bytes && fread(*bytes, 1, (size_t)end, file) == (size_t)end;
    (void)fclose(file);
    *size = end;
    RITZ_REFUSE_IF(!whole, *bytes ? RITZ_ERR_FILE : RITZ_ERR_MEMORY,
                   "'%s' cannot be read", path);
    return RITZ_OK;
}

/* Check the first bytes of an ELF file: 64 bits, little-endian, x86_64. */
static bool is_for_x86_64(const unsigned char *bytes, int64_t size)
{
    static const unsigned char head[] = {0x7f, 'E', 'L', 'F', 2, 1};
    enum { AT_MACHINE = 18, X86_64 = 62 };

    return size > AT_MACHINE + 1 && memcmp(bytes, head, sizeof head) == 0 &&
           bytes[AT_MACHINE] == X86_64 && bytes[AT_MACHINE + 1] == 0;
}

static ritz_status read_program(const ritz_export_request *request,
                                fmu_texts *p)
{
    RITZ_REFUSE_IF(!request->runtime, RITZ_ERR_ARGUMENT,
                   "no folder with the program of FMUs is given");
    RITZ_CHECK(read_installed(request->runtime, "ritz_fmu.so", &p->program,
                              &p->program_size));
    RITZ_REFUSE_IF(!is_for_x86_64(p->program, p->program_size), RITZ_ERR_FILE,
                   "'%s/ritz_fmu.so' is no program of Linux on x86_64, which "
                   "is the only one that FMUs are written for",
                   request->runtime);
    return read_installed(request->runtime, "ritz_fmu.txt", &p->licence,
                          &p->licence_size);
}

/* ---- texts -------------------------------------------------------------- */

/* The name of the model is that of the file without ".fmu". */
static void name_model(const char *path, char out[RITZ_NAME_SIZE])
{
    static const char ending[] = ".fmu";
    size_t length = 0;

    snprintf(out, RITZ_NAME_SIZE, "%s", ritz_path_name(path));
    ritz_text_clean(out);
    length = strlen(out);
    if (length > sizeof ending - 1 &&
        strcmp(out + length - (sizeof ending - 1), ending) == 0)
        out[length - (sizeof ending - 1)] = '\0';
}

typedef struct fmu_page_text {
    const char *name;
    char *certificate;
} fmu_page_text;

/* documentation/index.html, which shows the certificate. */
static ritz_status put_page(FILE *file, const void *what)
{
    const fmu_page_text *page = what;

    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n"
          "<title>",
          file);
    ritz_xml_put(file, page->name);
    fputs("</title>\n<h1>", file);
    ritz_xml_put(file, page->name);
    fputs(
        "</h1>\n<p>A linear model. In co-simulation inputs are held over each "
        "step, and motion is propagated without an error but rounding.</p>\n"
        "<pre>\n",
        file);
    for (char *line = page->certificate; *line;) {
        char *end = line + strcspn(line, "\n");
        const char last = *end;

        *end = '\0';
        ritz_xml_put(file, line);
        fputc('\n', file);
        *end = last;
        line = end + (last == '\n');
    }
    fputs("</pre>\n</html>\n", file);
    return RITZ_OK;
}

/* SHA-256 of numbers, page and description, in which the token is still zeros.
 */
static ritz_status find_token(const fmu_texts *p, char out[RITZ_DIGEST_SIZE])
{
    RITZ_OWN_ARRAY char *all = NULL;
    const size_t numbers = (size_t)p->numbers_size;
    const size_t page = (size_t)p->page_size;
    const size_t description = (size_t)p->description_size;

    RITZ_CHECK_NEW(all, (int64_t)(numbers + page + description));
    memcpy(all, p->numbers, numbers);
    memcpy(all + numbers, p->page, page);
    memcpy(all + numbers + page, p->description, description);
    ritz_digest_bytes(all, numbers + page + description, out);
    return RITZ_OK;
}

/* Make numbers and description anew, with the present token. */
static ritz_status make_texts(const ritz_export_request *request, fmu_texts *p)
{
    const ritz_fmu_text text = {
        .fmi = request->fmi == 2 ? 2 : 3,
        .name = p->name,
        .description = "linear model: documentation/index.html says how it was "
                       "made and what is known of its errors",
        .token = p->token,
    };
    unsigned char *numbers = NULL;
    char *page = NULL;

    RITZ_CHECK(ritz_fmu_numbers(&p->fmu, p->token, &numbers, &p->numbers_size));
    free(p->numbers);
    p->numbers = numbers;
    RITZ_CHECK(ritz_fmu_describe(&p->fmu, &text, &page, &p->description_size));
    free(p->description);
    p->description = page;
    return RITZ_OK;
}

static ritz_status make_parts(const ritz_export_object *object,
                              const ritz_export_request *request, fmu_texts *p)
{
    RITZ_CHECK(read_program(request, p));
    RITZ_CHECK(ritz_fmu_of(object, &p->fmu));
    RITZ_CHECK(ritz_certificate(object, request->stamp, &p->certificate));
    name_model(request->output, p->name);
    RITZ_CHECK(ritz_sink_hold(put_page,
                              &(fmu_page_text){p->name, p->certificate},
                              "a page", &p->page, &p->page_size));
    memset(p->token, '0', RITZ_DIGEST_SIZE - 1);
    RITZ_CHECK(make_texts(request, p));
    RITZ_CHECK(find_token(p, p->token));
    return make_texts(request, p);
}

/* ---- the archive -------------------------------------------------------- */

static ritz_status write_archive(const ritz_export_request *request,
                                 const fmu_texts *p)
{
    const bool two = request->fmi == 2;
    const ritz_zip_file file[] = {
        {"modelDescription.xml", p->description, p->description_size, false},
        {"documentation/index.html", p->page, p->page_size, false},
        {two ? "documentation/license.txt"
             : "documentation/licenses/license.txt",
         p->licence, p->licence_size, false},
        {"resources/ritz.bin", p->numbers, p->numbers_size, false},
        {two ? "binaries/linux64/ritz_fmu.so"
             : "binaries/x86_64-linux/ritz_fmu.so",
         p->program, p->program_size, true},
    };
    const ritz_zip_files files = {sizeof file / sizeof *file, file};

    return ritz_archive_write(request->output, &files);
}

static ritz_status say_blocks(const ritz_fmu *fmu, ritz_export_report *report)
{
    int64_t dense = 0;
    int64_t largest = 0;

    for (int64_t k = 0; k < fmu->num_blocks; k++)
        if (fmu->block[k].nrow == fmu->block[k].ncol) {
            dense++;
            largest =
                largest > fmu->block[k].nrow ? largest : fmu->block[k].nrow;
        }
    RITZ_CHECK(ritz_export_say(report,
                               "inputs: %" PRId64 ", outputs: %" PRId64
                               ", states: %" PRId64 ", of %" PRId64
                               " uncoupled modes",
                               fmu->num_inputs, fmu->num_outputs,
                               fmu->num_states, fmu->num_blocks - dense));
    if (dense == 1)
        return ritz_export_say(
            report, "one group of %" PRId64 " coupled states", largest);
    if (dense > 1)
        return ritz_export_say(report,
                               "%" PRId64 " groups of coupled states, the "
                               "largest of %" PRId64,
                               dense, largest);
    return RITZ_OK;
}

static ritz_status say_ports(const ritz_fmu *fmu, ritz_export_report *report)
{
    if (fmu->num_inputs == 0)
        RITZ_CHECK(ritz_export_say(report, "warning: no input drives it"));
    if (fmu->num_outputs == 0)
        RITZ_CHECK(ritz_export_say(report, "warning: no output observes it"));
    if (fmu->num_renamed > 0)
        RITZ_CHECK(ritz_export_say(
            report,
            "%" PRId64 " names of inputs and outputs are changed, as variables "
            "of an FMU have distinct names",
            fmu->num_renamed));
    if (fmu->num_without_unit > 0)
        RITZ_CHECK(ritz_export_say(report,
                                   "units of %" PRId64
                                   " inputs and outputs are "
                                   "not known",
                                   fmu->num_without_unit));
    return ritz_export_say(
        report, "numbers keep every bit; left out: shapes, ports, mass "
                "properties, limits of outputs");
}

static ritz_status write_fmu(const ritz_export_object *object,
                             const ritz_export_request *request,
                             ritz_export_report *report)
{
    RITZ_OWN(fmu_texts) p = {0};

    RITZ_CHECK(make_parts(object, request, &p));
    RITZ_CHECK(ritz_export_say(report,
                               "FMI %s, model exchange and co-simulation, for "
                               "Linux on x86_64",
                               request->fmi == 2 ? "2.0" : "3.0"));
    RITZ_CHECK(say_blocks(&p.fmu, report));
    RITZ_CHECK(say_ports(&p.fmu, report));
    return write_archive(request, &p);
}

const ritz_exporter ritz_exporter_fmu = {
    .name = "fmu",
    .summary = "FMU for model exchange and co-simulation",
    .reference = "FmiThree2024",
    .kind = "reduced",
    .takes = RITZ_EXPORT_REDUCED | RITZ_EXPORT_STATES | RITZ_EXPORT_FMI,
    .write = write_fmu,
};
