/* Lines of a coded database of ANSYS: what cdb.c reads its contents from. */
#ifndef RITZ_FORMATS_CDB_LINES_H
#define RITZ_FORMATS_CDB_LINES_H

#include "formats/cdb.h"

/* Fields of a command, and of a line of a block. */
enum { RITZ_CDB_MOST_FIELDS = 32 };

/* The fields of a command, which commas separate, without blanks around them.
   The first is the name of the command. */
typedef struct ritz_cdb_command {
    int64_t count, line;
    ritz_piece field[RITZ_CDB_MOST_FIELDS];
} ritz_cdb_command;

/* A format of Fortran such as "(3i9,6e21.13e3)": a number of fields with whole
   numbers, then a number of fields with real ones, and the widths of both. */
typedef struct ritz_cdb_form {
    int64_t wholes, whole_width, reals, real_width;
} ritz_cdb_form;

/* Arguments of %.*s that print at most 40 letters of a piece. */
#define RITZ_CDB_QUOTED(piece)                                                 \
    (int)((piece).length < 40 ? (piece).length : 40), (piece).text

/** Read the next line, without its line end. @return false at the end of the
 * file */
bool ritz_cdb_take_line(ritz_cdb *all, ritz_piece *out, int64_t *number);

/** Whether a piece is a word, in capitals or not. */
bool ritz_cdb_is_word(ritz_piece piece, const char *word);

/** Read all of a piece as a whole number. */
bool ritz_cdb_read_whole(ritz_piece piece, int64_t *out);

/** Read all of a piece as a finite number; an empty one is 0. */
bool ritz_cdb_read_real(ritz_piece piece, double *out);

/** Cut a command into its fields. Text after '!' is a comment. Fields beyond
 * RITZ_CDB_MOST_FIELDS are ignored. */
void ritz_cdb_split_command(ritz_piece text, int64_t line,
                            ritz_cdb_command *out);

/** Field @p k, empty if there is none. */
ritz_piece ritz_cdb_field(const ritz_cdb_command *command, int64_t k);

/** Read field @p k as a whole number. @return RITZ_ERR_FORMAT if it is none */
ritz_status ritz_cdb_take_whole(const ritz_cdb *all,
                                const ritz_cdb_command *command, int64_t k,
                                int64_t *out);

/** Read field @p k as a number; an empty one is 0. @return RITZ_ERR_FORMAT if
 * it is none */
ritz_status ritz_cdb_take_real(const ritz_cdb *all,
                               const ritz_cdb_command *command, int64_t k,
                               double *out);

/** Read the format of a block from the line after its command.
 * @param[in] reals  whether fields of real numbers are due */
ritz_status ritz_cdb_take_form(ritz_cdb *all, const ritz_cdb_command *command,
                               bool reals, ritz_cdb_form *out);

/** The field from column @p from on, empty if the line ends before it. */
ritz_piece ritz_cdb_cut_field(ritz_piece line, int64_t from, int64_t width);

/** Whether a line ends a block: -1, or a command N or EN whose number is -1. */
bool ritz_cdb_ends_block(ritz_piece line);

/** Read the whole numbers of a line, blank ones as 0.
 * @param[out] count  of fields up to the last that is not blank */
ritz_status ritz_cdb_take_wholes(const ritz_cdb *all, const ritz_cdb_form *form,
                                 ritz_piece line, int64_t number, int64_t *out,
                                 int64_t *count);

#endif
