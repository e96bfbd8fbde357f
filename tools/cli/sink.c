#include "cli/sink.h"

#include "base/text.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* One conversion of a format. */
typedef struct conversion {
    int width, precision; /* width below 0: to the left; precision: none */
    bool plus;
    char size;   /* 'l', 'L' of "ll", or 0 */
    char letter; /* 0: the format has ended */
} conversion;

/* Where one call goes: the text, the keys that are left, the target. */
typedef struct telling {
    FILE *text;
    const char *keys; /* NULL: all are plain items of a list */
    json_t *to;
} telling;

/* Arguments, in a struct so that functions may take them by turns. */
typedef struct arguments {
    va_list list;
} arguments;

static int read_count(const char **at, arguments *args)
{
    int count = 0;

    if (**at == '*') {
        ++*at;
        return va_arg(args->list, int);
    }
    while (isdigit((unsigned char)**at))
        count = 10 * count + *(*at)++ - '0';
    return count;
}

/* The conversion that begins behind a '%'; @p at is moved behind it. */
static conversion read_conversion(const char **at, arguments *args)
{
    conversion c = {.precision = -1};
    bool left = false;

    for (; **at == '-' || **at == '+'; ++*at) {
        left = left || **at == '-';
        c.plus = c.plus || **at == '+';
    }
    c.width = read_count(at, args);
    c.width = left ? -c.width : c.width;
    if (**at == '.') {
        ++*at;
        c.precision = read_count(at, args);
    }
    for (; **at == 'l' || **at == 'z'; ++*at)
        c.size = c.size == 'l' ? 'L' : 'l';
    c.letter = **at;
    *at += **at != '\0';
    return c;
}

/* The next key, which is cut off; "" if there is none. */
static void cut_key(telling *t, char key[RITZ_NAME_SIZE])
{
    size_t length = t->keys ? strcspn(t->keys, ",") : 0;

    snprintf(key, RITZ_NAME_SIZE, "%.*s", (int)length, t->keys ? t->keys : "");
    if (t->keys)
        t->keys += length + (t->keys[length] == ',');
}

static void put_value(telling *t, const char *key, json_t *value)
{
    if (!t->keys)
        json_array_append_new(t->to, value);
    else if (*key)
        json_object_set_new(t->to, key, value);
    else
        json_decref(value);
}

/* Texts from files may hold anything. In a terminal, a report or a table they
 * stay on their line, and control characters become '?'. */
static void put_text(FILE *file, conversion c, const char *value)
{
    const size_t size =
        c.precision < 0 ? strlen(value) : strnlen(value, (size_t)c.precision);
    const char *end = value + size;
    const int blanks = abs(c.width) > (int)size ? abs(c.width) - (int)size : 0;

    fprintf(file, "%*s", c.width > 0 ? blanks : 0, "");
    for (const char *at = value; at < end;) {
        const int length = ritz_letter_length(at);

        if (length > 0 && length <= end - at)
            at += fwrite(at, 1, (size_t)length, file);
        else
            at += putc('?', file) == '?';
        if (ferror(file))
            return; /* the owner of the file sees the error */
    }
    fprintf(file, "%*s", c.width < 0 ? blanks : 0, "");
}

static void tell_text(telling *t, conversion c, const char *key,
                      const char *value)
{
    if (t->text)
        put_text(t->text, c, value ? value : "");
    put_value(t, key, cli_string(value));
}

static void tell_letter(const telling *t, conversion c, int letter)
{
    const char text[] = {(char)letter, '\0'};

    put_text(t->text, c, text);
}

static void tell_real(telling *t, conversion c, const char *key, double value)
{
    put_value(t, key, cli_real(value));
    if (!t->text)
        return;
    if (isnan(value))
        fprintf(t->text, "%*s", c.width, "-");
    else if (c.letter == 'e')
        fprintf(t->text, c.plus ? "%+*.*e" : "%*.*e", c.width, c.precision,
                value);
    else if (c.letter == 'f')
        fprintf(t->text, c.plus ? "%+*.*f" : "%*.*f", c.width, c.precision,
                value);
    else
        fprintf(t->text, c.plus ? "%+*.*g" : "%*.*g", c.width, c.precision,
                value);
}

static void tell_whole(telling *t, conversion c, const char *key,
                       arguments *args)
{
    long long value = c.size == 'L'   ? va_arg(args->list, long long)
                      : c.size == 'l' ? va_arg(args->list, long)
                                      : va_arg(args->list, int);

    if (t->text)
        fprintf(t->text, "%*lld", c.width, value);
    put_value(t, key, c.size ? json_integer(value) : json_boolean(value));
}

static void tell_one(telling *t, conversion c, arguments *args)
{
    char key[RITZ_NAME_SIZE];

    cut_key(t, key);
    switch (c.letter) {
    case 's':
        tell_text(t, c, key, va_arg(args->list, const char *));
        break;
    case 'c':
        tell_letter(t, c, va_arg(args->list, int));
        break;
    case 'd':
        tell_whole(t, c, key, args);
        break;
    case 'e':
    case 'f':
    case 'g':
        tell_real(t, c, key, va_arg(args->list, double));
        break;
    default:
        abort(); /* a format that no tool may use */
    }
}

static void tell_values(telling *t, const char *format, arguments *args)
{
    while (*format) {
        size_t plain = strcspn(format, "%");

        if (t->text)
            fwrite(format, 1, plain, t->text);
        format += plain;
        if (!*format++)
            return;
        if (*format != '%')
            tell_one(t, read_conversion(&format, args), args);
        else if (t->text)
            putc(*format++, t->text);
        else
            format++;
    }
}

json_t *sink_here(const cli_run *run)
{
    return run->depth > 0 ? run->open[run->depth - 1] : run->report;
}

/* Where the values of a call go: the object that is open, or a new item. */
static json_t *find_target(const cli_run *run, const char *keys)
{
    json_t *here = sink_here(run);
    json_t *item = NULL;

    if (!json_is_array(here) || !keys || keys[strspn(keys, ",")] == '\0')
        return here;
    item = json_object();
    json_array_append_new(here, item);
    return item;
}

/* Show what of the text is new. */
static void show_text(const cli_run *run, long from)
{
    const cli_table *said = &run->said;

    fflush(said->file);
    if (run->quiet || run->json || !said->text || from < 0)
        return;
    cli_watch_clear();
    fwrite(said->text + from, 1, said->size - (size_t)from, stdout);
}

void sink_tell(const cli_run *run, sink_text text, const char *title,
               const char *keys, const char *format, ...)
{
    FILE *said = text == SINK_NONE ? NULL : run->said.file;
    long from = said ? ftell(said) : 0;
    telling t = {said, keys, find_target(run, keys)};
    arguments args;

    if (title) {
        fputs("  ", said);
        put_text(said, (conversion){.width = -14, .precision = -1}, title);
        putc(' ', said);
    }
    va_start(args.list, format);
    tell_values(&t, format, &args);
    va_end(args.list);
    if (text == SINK_LINE)
        putc('\n', said);
    if (said)
        show_text(run, from);
}

void sink_open(cli_run *run, json_t *value)
{
    if (run->depth == CLI_MAX_DEPTH || !value)
        abort();
    run->open[run->depth++] = value;
}

/* Open what is there under that key, or else a new object or list. */
static void open_value(cli_run *run, const char *key, json_t *value)
{
    json_t *here = sink_here(run);
    json_t *there = key ? json_object_get(here, key) : NULL;

    if (there && json_typeof(there) == json_typeof(value)) {
        json_decref(value);
        value = there;
    } else if (key) {
        json_object_set_new(here, key, value);
    } else {
        json_array_append_new(here, value);
    }
    sink_open(run, value);
}

void sink_object(cli_run *run, const char *key)
{
    open_value(run, key, json_object());
}

void sink_list(cli_run *run, const char *key)
{
    open_value(run, key, json_array());
}

void sink_end(cli_run *run)
{
    run->depth--;
}

void sink_lift(cli_run *run, const json_t *from)
{
    json_t *copy = json_deep_copy(from);

    json_object_update_missing(sink_here(run), copy);
    json_decref(copy);
}

void sink_reals(cli_run *run, const char *key, int64_t count,
                const double *values)
{
    SINK_EACH(run, key, k, count)
        sink_add(run, "%g", values[k]);
}

void sink_wholes(cli_run *run, const char *key, int64_t count,
                 const int64_t *values, int64_t first)
{
    SINK_EACH(run, key, k, count)
        sink_add(run, "%ld", first + values[k]);
}

void sink_names(cli_run *run, const char *title, const char *key, int64_t count,
                char (*name)[RITZ_NAME_SIZE])
{
    SINK_EACH(run, key, k, count) {
        sink_add(run, "%s", name[k]);
        if (title)
            sink_field(run, k > 0 ? "" : title, "", "%s", name[k]);
    }
}

void sink_append(char *text, size_t size, const char *format, ...)
{
    size_t used = strlen(text);
    va_list args;

    va_start(args, format);
    vsnprintf(text + used, size - used, format, args);
    va_end(args);
}
