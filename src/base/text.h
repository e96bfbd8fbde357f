/*
 * Text that others wrote: its letters, and paths; names in sentences, looked up
 * with a suggestion and cut to a readable length.
 */
#ifndef RITZ_BASE_TEXT_H
#define RITZ_BASE_TEXT_H

#include <ritz/base.h>

/* Bytes of the longest sentence of a failure: the cause stands behind the path
   that it concerns, however long that is. */
enum { RITZ_MESSAGE_SIZE = 4096 + 512 };

/**
 * Bytes of the letter of UTF-8 at @p text, which NUL ends.
 *
 * @return 0 at a control character, the end, or what is not UTF-8
 */
int ritz_letter_length(const char *text);

/**
 * Copy @p length letters, and cut the copy at the first @p mark.
 *
 * @param[out] rest  what stands behind the mark; NULL: there is none
 * @return false if the copy has no room for them
 */
bool ritz_text_part(const char *text, size_t length, char mark,
                    char copy[RITZ_NAME_SIZE], char **rest);

/** Read @p length letters as "5" or "7-9", from 1 on; @p to is 0 of one number.
 * @return false if they are neither */
bool ritz_text_range(const char *text, size_t length, int64_t *from,
                     int64_t *to);

/** Number of bytes of the UTF-8 character at @p text, which may be a control
 * character; 0 at the end of the text, or if the bytes are not UTF-8. */
int ritz_letter_size(const char *text);

/** Replace control characters, and each byte that is not UTF-8, by '?', because
 * a terminal could obey them. */
void ritz_text_clean(char *text);

/** One more than the line ends of a text: room for all of its lines. */
int64_t ritz_text_lines(const char *text);

/** The folder of a path: "." if it names none. The caller frees @p out. */
ritz_status ritz_path_folder(const char *path, char **out);

/** The name of the file in @p path, such as "rotor.h5" in "build/rotor.h5"; it
 * points into @p path. */
const char *ritz_path_name(const char *path);

/** Whether a file lies in a folder or below it, with symbolic links resolved;
 * false if either does not exist. */
bool ritz_path_within(const char *path, const char *folder);

/* Names of one sort: an array of structs that each begin with a name. */
typedef struct ritz_names {
    const char *what; /* "component", for sentences */
    int64_t count;
    const char *first;
    size_t stride;
} ritz_names;

/**
 * Index of @p word.
 *
 * @return RITZ_ERR_ARGUMENT "unknown WHAT 'modez', is 'modes' meant?", or with
 *         all there are if none is near
 */
ritz_status ritz_words_find(const ritz_names *names, const char *word,
                            int64_t *out);

/** Index of @p word, without a sentence; -1 if it is not there. */
int64_t ritz_names_index(const ritz_names *names, const char *word);

/** A name that occurs more than once; "" if there is none. */
ritz_status ritz_names_repeated(int64_t count,
                                const char (*name)[RITZ_NAME_SIZE],
                                char out[RITZ_NAME_SIZE]);

/** Index of @p word in an array of names; -1 if it is not there. */
int64_t ritz_name_index(int64_t count, char (*name)[RITZ_NAME_SIZE],
                        const char *word);

/** Index of @p word; if it is not there, the sentence is "there is no WHAT
 * 'word', is 'ward' meant?". */
int64_t ritz_names_seek(const ritz_names *names, const char *word);

enum { RITZ_SHORT_SIZE = 48 };

/** Beginning of a text on one line, for 'quotes'; returns @p out. */
const char *ritz_text_short(const char *text, char out[RITZ_SHORT_SIZE]);

#endif
