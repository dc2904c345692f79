/* status.c -- messages of the status codes; see status.h. */
#include <pendres/status.h>

const char *pendres_status_message(pendres_status status)
{
  static const char *const message[] = {
#define STATUS_TEXT(name, text) text,
    PENDRES_STATUS_LIST(STATUS_TEXT)
#undef STATUS_TEXT
  };
  if ((unsigned)status >= PENDRES_STATUS_COUNT) return "unknown status";
  return message[status];
}
