/*
 * Lines of files that Abaqus and CalculiX write and read: data, keywords
 * "*KEYWORD, PARAMETER=VALUE, FLAG", and comments "** text". Commas separate
 * fields; one at the end of a line ends its last field. Neither case nor blanks
 * count in keywords and parameters.
 *
 * [Abaqus2016], "Input syntax rules".
 */
#ifndef RITZ_FORMATS_ABAQUS_H
#define RITZ_FORMATS_ABAQUS_H

#include "formats/decimal.h"

#include <ritz/base.h>

/* What lies between two commas, without the blanks around it. */
typedef struct ritz_comma_field {
    const char *at, *end;
} ritz_comma_field;

/** The lines of some bytes, before the first. */
static inline ritz_lines ritz_abaqus_lines(const char *bytes, int64_t size)
{
    return (ritz_lines){.at = bytes, .end = bytes + size};
}

/** Put the number of a line before the sentence of a failure. */
ritz_status ritz_abaqus_in_line(ritz_status status, int64_t number);

/** Take the next line that is not blank, without the blanks around it.
 * @return false at the end of the text */
bool ritz_abaqus_next(ritz_lines *text);

/** Take the next line that is neither blank nor a comment.
 * @return false at the end of the text */
bool ritz_abaqus_next_stated(ritz_lines *text);

/** Take the next line of data. @return false at the end of the text or before a
 * keyword; the text then stands where it stood */
bool ritz_abaqus_next_data(ritz_lines *text);

/** Whether the line that was taken last is a comment, or a keyword. */
bool ritz_abaqus_is_comment(const ritz_lines *text);
bool ritz_abaqus_is_keyword(const ritz_lines *text);

/** Take the next field; @return false at the end of the line. */
bool ritz_abaqus_field(const char **at, const char *end, ritz_comma_field *out);

/** Whether a field is this word, which is given in capitals. */
bool ritz_abaqus_spells(const ritz_comma_field *field, const char *word);

/** Cut "NAME = VALUE" down to NAME. @return VALUE, empty where there is none */
ritz_comma_field ritz_abaqus_value(ritz_comma_field *field);

/** Letters of a field that a message quotes. */
int ritz_abaqus_quoted(const ritz_comma_field *field);

/** Copy a field that is a name of a matrix.
 * @return RITZ_ERR_FORMAT if it is empty or too long, or has signs that a name
 *         may not have */
ritz_status ritz_abaqus_name(const ritz_comma_field *field,
                             char out[RITZ_NAME_SIZE]);

/** A whole number. @return RITZ_ERR_FORMAT quoting the field */
ritz_status ritz_abaqus_whole(const ritz_comma_field *field, int64_t *out);

/** A finite number; @p digits is raised to those that it is written with. */
ritz_status ritz_abaqus_real(const ritz_comma_field *field, int64_t *digits,
                             double *out);

/** @return RITZ_ERR_FORMAT if the number is none of a node, as those are not
 *         that Abaqus makes for itself */
ritz_status ritz_abaqus_check_node(int64_t node);

/** @return RITZ_ERR_FORMAT if the number of a degree of freedom is none of 1 to
 *         6, with what it stands for */
ritz_status ritz_abaqus_check_direction(int64_t direction);

#endif
