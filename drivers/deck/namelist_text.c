/* namelist_text.c -- the text of a namelist, from a file, an argument or memory; see namelist.h. */
#include "deck/namelist_lex.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

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

/* At most one byte more than allowed, so that the parser can tell. */
static size_t read_bytes(FILE *file, char *text, size_t size)
{
  size_t used = 0, got = 1;
  while (used < size && got > 0) {
    got = fread(text + used, 1, size - used, file);
    used += got;
  }
  return used;
}

pendres_status namelist_read(const char *path, namelist *out, namelist_errors *errors)
{
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  const size_t size = (size_t)NAMELIST_MAX_BYTES + 1;
  char *text = malloc(size);
  FILE *file = NULL;
  size_t length = 0;
  int bad = 0;

  *out = (namelist){ 0 };
  if (text == NULL) goto done;
  errno = 0;
  file = strcmp(path, "-") == 0 ? stdin : fopen(path, "rb");
  if (file != NULL) length = read_bytes(file, text, size);
  bad = file == NULL || ferror(file);
  if (bad) {
    namelist named = { 0 };
    const char *why = strerror(errno);
    const pendres_status parsed = namelist_parse(path, "", 0, &named, errors);
    if (parsed == PENDRES_OK)
      namelist_error_at(&named, namelist_whole, errors, "cannot read the deck: %s", why);
    *out = named;
    status = parsed == PENDRES_OK ? PENDRES_IO : parsed;
    goto done;
  }
  status = namelist_parse(path, text, length, out, errors);
done:
  if (status == PENDRES_OUT_OF_MEMORY) errors->out_of_memory = 1;
  if (file != NULL && file != stdin) fclose(file);
  free(text);
  return status;
}
