/* text.c -- the text of a namelist, from a file, an argument or memory; see namelist.h. */
#define _POSIX_C_SOURCE 200809L /* STDIN_FILENO */
#include "deck/namelist/lex.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "system/bytes.h"
#include "system/file.h"

static int index_lines(namelist *nl)
{
  size_t lines = 1, n = 0;
  for (size_t i = 0; i < nl->length; i++) lines += nl->text[i] == '\n';
  nl->line = malloc(lines * sizeof *nl->line);
  if (nl->line == NULL) return 0;
  nl->line[n++] = 0;
  for (size_t i = 0; i < nl->length; i++)
    if (nl->text[i] == '\n') nl->line[n++] = i + 1;
  nl->lines = (int)lines;
  return 1;
}

/* Copy the text and index it; nl must be all zero. */
static pendres_status take_text(namelist *nl, const char *name, const char *text, size_t length)
{
  nl->name = malloc(strlen(name) + 1);
  nl->text = malloc(length + 1);
  if (nl->name == NULL || nl->text == NULL) return PENDRES_OUT_OF_MEMORY;
  strcpy(nl->name, name);
  if (length > 0) memcpy(nl->text, text, length);
  nl->text[length] = '\0';
  nl->length = length;
  return index_lines(nl) ? PENDRES_OK : PENDRES_OUT_OF_MEMORY;
}

pendres_status namelist_parse(const char *name, const char *text, size_t length, namelist *out,
                              namelist_errors *errors)
{
  const size_t errors_before = errors->count + errors->dropped;
  reader r = { .nl = out, .errors = errors, .line = 1, .column = 1 };

  *out = (namelist){ 0 };
  if (take_text(out, name, text, length <= NAMELIST_MAX_BYTES ? length : 0) != PENDRES_OK)
    goto no_memory;
  if (length > NAMELIST_MAX_BYTES) {
    namelist_error_at(out, namelist_whole, errors, "the deck is larger than 1 MiB");
    return PENDRES_INVALID_ARGUMENT;
  }
  if (length >= 2 &&
      (memcmp(out->text, "\xFF\xFE", 2) == 0 || memcmp(out->text, "\xFE\xFF", 2) == 0)) {
    namelist_error_at(out, namelist_whole, errors, "the deck is UTF-16; save it as UTF-8");
    return PENDRES_INVALID_ARGUMENT;
  }
  if (length >= 3 && memcmp(out->text, "\xEF\xBB\xBF", 3) == 0) out->line[0] = r.at = 3; /* BOM */
  if (lex_check_bytes(&r)) namelist_read_groups(&r);
  if (r.out_of_memory || errors->out_of_memory) goto no_memory;
  return errors->count + errors->dropped > errors_before ? PENDRES_INVALID_ARGUMENT : PENDRES_OK;
no_memory:
  errors->out_of_memory = 1;
  return PENDRES_OUT_OF_MEMORY;
}

pendres_status namelist_parse_setting(const char *argument, int order, int whole, namelist *out,
                                      namelist_errors *errors)
{
  const size_t errors_before = errors->count + errors->dropped;
  reader r = { .nl = out, .errors = errors, .line = 1, .column = 1 };
  *out = (namelist){ .order = order };
  if (take_text(out, "command line", argument, strlen(argument)) != PENDRES_OK ||
      (lex_check_bytes(&r) && (namelist_read_setting(&r, whole), r.out_of_memory)) ||
      errors->out_of_memory) {
    errors->out_of_memory = 1;
    return PENDRES_OUT_OF_MEMORY;
  }
  return errors->count + errors->dropped > errors_before ? PENDRES_INVALID_ARGUMENT : PENDRES_OK;
}

const namelist_group *namelist_group_find(const namelist *nl, const char *name)
{
  for (size_t i = 0; i < nl->groups; i++)
    if (strcmp(nl->group[i].name, name) == 0) return &nl->group[i];
  return NULL;
}

void namelist_free(namelist *nl)
{
  if (nl == NULL) return;
  free(nl->name);
  free(nl->text);
  free(nl->line);
  free(nl->group);
  free(nl->assignment);
  free(nl->value);
  *nl = (namelist){ 0 };
}

/* ---- from a file --------------------------------------------------------------------------- */

/* What is wrong with the file; the parse of an empty text makes the tree that names it. */
static pendres_status refuse(const char *path, const char *why, namelist *out,
                             namelist_errors *errors)
{
  const pendres_status status = namelist_parse(path, "", 0, out, errors);
  if (status != PENDRES_OK) return status;
  namelist_error_at(out, namelist_whole, errors, "cannot read the deck: %s", why);
  return PENDRES_IO;
}

pendres_status namelist_read(const char *path, namelist *out, namelist_errors *errors)
{
  char why[FILE_WORDS];
  char *text = NULL;
  size_t length = 0;
  const int standard = strcmp(path, "-") == 0;
  const int file = standard ? STDIN_FILENO : file_open(path, FILE_READ, 0, why);
  if (file < 0) return refuse(path, why, out, errors);
  pendres_status status = bytes_text(file, NAMELIST_MAX_BYTES, &text, &length);
  const char *words = strerror(errno);
  if (!standard) (void)close(file);
  if (status == PENDRES_IO) return refuse(path, words, out, errors);
  if (status == PENDRES_UNSUPPORTED) length = (size_t)NAMELIST_MAX_BYTES + 1; /* which is told */
  if (status != PENDRES_OUT_OF_MEMORY) status = namelist_parse(path, text, length, out, errors);
  else (void)namelist_parse(path, "", 0, out, errors); /* they are to be freed in any case */
  if (status == PENDRES_OUT_OF_MEMORY) errors->out_of_memory = 1;
  free(text);
  return status;
}
