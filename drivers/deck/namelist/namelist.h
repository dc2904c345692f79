/*
 * namelist.h -- the syntax of Fortran 2018 namelists (ISO/IEC 1539-1:2018, 13.11), nothing else.
 *
 * Owns: the text of a deck, its tree of groups, assignments and values with their positions, and
 * the list of errors. What the names mean and which values make sense is the business of deck.h.
 *
 * Read: scalars and one-dimensional arrays; `r*c`, `r*`, null values, D and E and bare signed
 * exponents, inf and nan, logicals, strings in either quote with doubled quotes, subscripts
 * `a(3)`, `a(2:4)`, `a(1:9:2)`, comments, `$group ... $end`, `&end`, CRLF, a byte-order mark,
 * tabs, and a last line without its newline.
 *
 * Stricter than the standard by choice, since each of these hides mistakes: text between groups
 * that is no comment, a group given twice, a name or an array element given twice, semicolons, a
 * string that runs on over a line that looks like the start of something else, and numbers that
 * a double or an int64_t cannot hold.
 *
 * Nothing is printed and nothing exits: all errors of a text are collected. Reading does not
 * depend on the locale. Thread safe: no state outside the arguments.
 */
#ifndef NAMELIST_H
#define NAMELIST_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <pendres/status.h>

/* Bounds that keep a hostile deck from exhausting memory or time. */
enum {
  NAMELIST_MAX_BYTES = 1 << 20,
  NAMELIST_MAX_VALUES = 1000000, /* of a deck, repeat counts multiplied out */
  NAMELIST_MAX_ASSIGNMENTS = 1000,
  NAMELIST_MAX_GROUPS = 100,
  NAMELIST_MAX_NUMBER = 500, /* characters of a number */
  NAMELIST_MAX_ERRORS = 100, /* kept; more are only counted */
  NAMELIST_CLIP = 40,        /* bytes of a value that messages show */
  NAMELIST_NAME = 64         /* bytes of a name with its end: 63 characters as in Fortran */
};

/** Where something stands in the text, from 1 on, columns in characters; `width` of these are
    underlined. */
typedef struct namelist_place {
  int line, column, width;
} namelist_place;

/** One error: `text` is the whole message with position, source line and caret. */
typedef struct namelist_error {
  int order; /* of the text that it is in */
  namelist_place at;
  char *text;
} namelist_error;

/** Errors found so far. Start from all zero; free with namelist_errors_free. */
typedef struct namelist_errors {
  namelist_error *item;
  size_t count;
  size_t capacity;
  size_t dropped;    /* found beyond NAMELIST_MAX_ERRORS, not kept */
  int out_of_memory; /* nonzero: at least one error could not be kept */
} namelist_errors;

typedef enum namelist_form {
  NAMELIST_NULL, /* no value: the default stays */
  NAMELIST_BARE, /* number, logical, or something that is neither */
  NAMELIST_STRING
} namelist_form;

typedef struct namelist_value {
  namelist_form form;
  int repeat;           /* 1 or more */
  namelist_place at;
  size_t begin, length; /* raw text in namelist.text, without repeat count, with quotes */
} namelist_value;

typedef struct namelist_assignment {
  char name[NAMELIST_NAME]; /* in lower case */
  namelist_place at;
  int subscripted;     /* nonzero: a subscript was written, as first:last:step (last 0: open) */
  long first, last, step;
  int broken;          /* nonzero: its values had a syntax error */
  size_t begin, count; /* its values in namelist.value */
} namelist_assignment;

typedef struct namelist_group {
  char name[NAMELIST_NAME]; /* in lower case */
  namelist_place at;
  int broken;          /* nonzero: a syntax error inside may have hidden some names */
  int repeated;        /* nonzero: a group of this name came before (an error, reported) */
  size_t begin, count; /* its assignments in namelist.assignment */
} namelist_group;

typedef struct namelist {
  int order;     /* 0: a deck; above: the number of a setting, whose strings need no quotes */
  char *name;    /* of the file, for messages */
  char *text;    /* verbatim, ends with a 0 byte that is not counted */
  size_t length;
  size_t *line;  /* offset of each line */
  int lines;
  namelist_group *group;
  size_t groups;
  namelist_assignment *assignment;
  size_t assignments;
  namelist_value *value;
  size_t values;
} namelist;

/** The elements of one name, null values and repeats resolved; free with namelist_array_free. */
typedef struct namelist_array {
  const namelist_value **item; /* item[i] belongs to element i + 1; NULL where nothing was given */
  size_t count;                /* up to the last element that was given */
  int given;                   /* nonzero: the name occurs */
  int broken;                  /* nonzero: errors were reported already */
  namelist_place at;           /* of the name where it first occurs */
} namelist_array;

/**
 * Parse a text. `name` stands in messages. *out is filled as far as the text could be understood,
 * also after errors, so that the caller can go on and find the rest of them; free it in any case.
 * Returns PENDRES_OK, PENDRES_INVALID_ARGUMENT after errors in the text, PENDRES_OUT_OF_MEMORY.
 */
pendres_status namelist_parse(const char *name, const char *text, size_t length, namelist *out,
                              namelist_errors *errors);

/**
 * Parse a setting, a key given outside of the deck: `pendulum.damping=0.13`, as a tree with one
 * group and one assignment; the caller has seen that it has this form. order counts settings from
 * 1 on. whole: the value is a string, all that stands behind the equals sign unless that starts
 * with a quote. Returns as namelist_parse does.
 */
pendres_status namelist_parse_setting(const char *argument, int order, int whole, namelist *out,
                                      namelist_errors *errors);

/** The same as namelist_parse from a file, "-" being standard input; PENDRES_IO if it cannot be
 *  read, which is reported in errors too. */
pendres_status namelist_read(const char *path, namelist *out, namelist_errors *errors);

/** Free what a parse filled in; all zero is allowed. */
void namelist_free(namelist *nl);

/** The group of that name (in lower case), or NULL. */
const namelist_group *namelist_group_find(const namelist *nl, const char *name);

/**
 * Gather all values given to a name of a group. An element given twice and more values than a
 * subscript selects are errors. Returns as namelist_parse does.
 */
pendres_status namelist_array_get(const namelist *nl, const namelist_group *group, const char *name,
                                  namelist_array *out, namelist_errors *errors);
void namelist_array_free(namelist_array *array);

/**
 * Convert one value. `key` stands in messages. Returns 1, or 0 with the error reported.
 * A string of more than size - 1 bytes is an error; text holds the string without its quotes.
 */
int namelist_value_real(const namelist *nl, const namelist_value *value, const char *key,
                        double *out, namelist_errors *errors);
int namelist_value_integer(const namelist *nl, const namelist_value *value, const char *key,
                           int64_t *out, namelist_errors *errors);
int namelist_value_logical(const namelist *nl, const namelist_value *value, const char *key,
                           int *out, namelist_errors *errors);
int namelist_value_string(const namelist *nl, const namelist_value *value, const char *key,
                          char *text, size_t size, namelist_errors *errors);

/** The place of what concerns a text as a whole. */
extern const namelist_place namelist_whole;

/** Report an error at a place of nl. The format is that of printf. */
void namelist_error_at(const namelist *nl, namelist_place at, namelist_errors *errors,
                       const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 4, 5)))
#endif
    ;

/** Put the errors into the order of the texts and of places in them. */
void namelist_errors_sort(namelist_errors *errors);
/** Write all errors, and how many were left out. */
void namelist_errors_print(const namelist_errors *errors, FILE *stream);
/** Free the list and make it empty. */
void namelist_errors_free(namelist_errors *errors);

#endif
