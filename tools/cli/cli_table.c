#include "cli/cli_table.h"

#include "base/draft.h"

#include <errno.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

ritz_status cli_table_new(cli_table *out)
{
    out->file = open_memstream(&out->text, &out->size);
    RITZ_REFUSE_IF(!out->file, RITZ_ERR_MEMORY, "no memory for a table");
    return RITZ_OK;
}

ritz_status cli_table_write(cli_table *table, const char *path)
{
    FILE *file = NULL;
    bool whole = false;

    RITZ_REFUSE_IF(ferror(table->file) || fflush(table->file) != 0,
                   RITZ_ERR_MEMORY, "no memory for a table");
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
    ritz_status status = RITZ_OK;
    ritz_draft draft = {0};

    RITZ_TRY(ritz_draft_new(path, &draft));
    RITZ_TRY(cli_table_write(table, draft.name));
    RITZ_TRY(ritz_draft_publish(&draft));
done:
    ritz_draft_free(&draft);
    return ritz_context(status, path);
}

void cli_table_free(cli_table *table)
{
    if (table->file)
        fclose(table->file);
    free(table->text);
    *table = (cli_table){0};
}
