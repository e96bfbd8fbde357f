/* Texts of the tools: sentences on standard error, JSON, and tables that are
   written whole or not at all. Control characters that come from files are
   replaced. */
#include "cli/cli.h"

#include "base/alloc.h"
#include "base/draft.h"
#include "base/text.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* Clean the text between the characters of `kept`, which stay. */
static void clean_between(char *text, const char *kept)
{
    while (*text) {
        char *end = text + strcspn(text, kept);
        char mark = *end;

        *end = '\0';
        ritz_text_clean(text);
        *end = mark;
        text = end + (mark != '\0');
    }
}

void cli_complain_list(const char *format, va_list args)
{
    char text[2 * CLI_MAX_COMMAND]; /* room for a sentence with a long path */

    vsnprintf(text, sizeof text, format, args);
    clean_between(text, "\n");
    fputs(text, stderr);
}

void cli_complain(const char *format, ...)
{
    va_list args;

    va_start(args, format);
    cli_complain_list(format, args);
    va_end(args);
}

json_t *cli_real(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

json_t *cli_string(const char *text)
{
    json_t *string = json_string(text);
    /* not UTF-8: a file may be called so */
    char *copy = string || !text ? NULL : strdup(text);

    for (char *c = copy; c && *c; c++)
        if ((unsigned char)*c > 127)
            *c = '?';
    string = copy ? json_string(copy) : string;
    free(copy);
    return string ? string : json_null();
}

/* Write a letter, or the escape of a control character (U+007F to U+009F),
   which JSON allows in strings. */
static void put_letter(FILE *file, const char *letter, int size)
{
    const unsigned char *c = (const unsigned char *)letter;

    if (ritz_letter_length(letter) > 0 || *letter == '\n')
        fwrite(letter, 1, (size_t)size, file);
    else
        fprintf(file, "\\u%04x", (unsigned)(size == 1 ? c[0] : c[1]));
}

char *cli_json(const json_t *value, size_t flags)
{
    RITZ_OWN(cli_table) table = {0};
    char *plain = json_dumps(value, flags);
    char *text = NULL;

    if (!plain || cli_table_new(&table) != RITZ_OK) {
        free(plain);
        return NULL;
    }
    for (const char *at = plain; *at;) {
        int size = ritz_letter_size(at);

        put_letter(table.file, at, size > 0 ? size : 1);
        at += size > 0 ? size : 1;
    }
    free(plain);
    if (cli_table_end(&table) == RITZ_OK)
        text = ritz_zalloc((int64_t)table.size + 1, 1);
    if (text)
        memcpy(text, table.text, table.size);
    return text;
}

ritz_status cli_table_new(cli_table *out)
{
    out->file = open_memstream(&out->text, &out->size);
    RITZ_REFUSE_IF(!out->file, RITZ_ERR_MEMORY, "no memory for a table");
    return RITZ_OK;
}

ritz_status cli_table_end(const cli_table *table)
{
    RITZ_REFUSE_IF(ferror(table->file) || fflush(table->file) != 0,
                   RITZ_ERR_MEMORY, "no memory for a table");
    return RITZ_OK;
}

ritz_status cli_table_write(cli_table *table, const char *path)
{
    FILE *file = NULL;
    bool whole = false;

    RITZ_CHECK(cli_table_end(table));
    file = fopen(path, "w");
    RITZ_REFUSE_IF(!file, RITZ_ERR_FILE, "cannot open '%s': %s", path,
                   strerror(errno));
    whole = fwrite(table->text, 1, table->size, file) == table->size;
    whole = fclose(file) == 0 && whole;
    RITZ_REFUSE_IF(!whole, RITZ_ERR_FILE, "cannot write: %s", strerror(errno));
    return RITZ_OK;
}

ritz_status cli_table_save(cli_table *table, const char *path)
{
    RITZ_OWN(ritz_draft) draft = {0};

    RITZ_CHECK(cli_table_end(table));
    if (table->text)
        clean_between(table->text, "\n\t\r");
    RITZ_CHECK_IN(path, ritz_draft_new(path, &draft));
    RITZ_CHECK_IN(path, cli_table_write(table, draft.name));
    return ritz_context(ritz_draft_publish(&draft), path);
}

void cli_table_free(cli_table *table)
{
    if (table->file)
        fclose(table->file);
    free(table->text);
    *table = (cli_table){0};
}
