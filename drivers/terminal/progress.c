/* progress.c -- bar, lines and log; see progress.h. */
#define _DEFAULT_SOURCE /* TIOCGWINSZ */
#define _POSIX_C_SOURCE 200809L /* gmtime_r, isatty */
#include "terminal/progress.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#include "system/clock.h"
#include "terminal/safe_text.h"

enum { BAR = 30, LINE_STEP = 10, MOST_COLUMNS = 240 };

/* Redrawing more often would only make a terminal flicker. */
static const double redraw_after = 0.1;
/* What is done sooner needs no lines. */
static const double first_line_after = 1.0;
/* How often it is said that nothing is counted yet, seconds. */
static const double wait_redraw = 1.0;
/* Users of work without a count wonder after so many seconds what is going on. */
static const double doing_line_after = 10.0;
/* A bar names what has been at work for longer. */
static const double named_after = 3.0;

static void log_line(progress *p, const char *text)
{
  char stamp[32] = "";
  struct tm utc;
  const time_t t = time(NULL);
  if (p->log == NULL) return;
  if (gmtime_r(&t, &utc) != NULL) (void)strftime(stamp, sizeof stamp, "%Y-%m-%dT%H:%M:%SZ", &utc);
  fprintf(p->log, "%s %s\n", stamp, text);
  fflush(p->log);
}

void progress_init(progress *p, FILE *stream, int quiet)
{
  const char *terminal = getenv("TERM");
  *p = (progress){ .stream = stream, .quiet = quiet, .every = 300.0 };
  p->start = p->spoken = clock_wall();
  p->terminal = isatty(fileno(stream)) && (terminal == NULL || strcmp(terminal, "dumb") != 0);
}

static void clear(progress *p)
{
  if (p->width > 0) fprintf(p->stream, "\r%*s\r", p->width, "");
  p->width = 0;
}

/* Characters of a line on the terminal. */
static int columns_of(const progress *p)
{
  struct winsize size = { 0 };
  if (ioctl(fileno(p->stream), TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
  return size.ws_col < MOST_COLUMNS ? size.ws_col : MOST_COLUMNS;
}

static void draw(progress *p, size_t done, double elapsed)
{
  char bar[BAR + 1], left[32] = "", at_work[160] = "", line[MOST_COLUMNS + 1];
  const double part = (double)done / (double)p->total;
  const int filled = (int)(BAR * part);
  memset(bar, '.', BAR);
  memset(bar, '#', (size_t)filled);
  bar[BAR] = '\0';
  if (done > p->before && elapsed > 1.0) {
    const double seconds = elapsed * (double)(p->total - done) / (double)(done - p->before);
    snprintf(left, sizeof left, ", %.0f s left", seconds);
  }
  const double busy = p->start + elapsed - p->since;
  if (p->name[0] != '\0' && busy > named_after)
    snprintf(at_work, sizeof at_work, "; %s for %.0f s", p->name, busy);
  /* The last column stays free: many terminals go on to the next line there. */
  snprintf(line, (size_t)columns_of(p), "%3.0f %% [%s] %zu of %zu %.20s%s%s", 100.0 * part, bar,
           done, p->total, p->what, left, at_work);
  clear(p);
  p->width = fprintf(p->stream, "%s", line);
  p->drawn = elapsed;
  fflush(p->stream);
}

void progress_start(progress *p, const char *what, size_t total, size_t done)
{
  if (p == NULL) return;
  snprintf(p->what, sizeof p->what, "%s", what);
  p->total = total;
  p->before = done;
  /* All tasks may be those of other shards. */
  p->percent = total > 0 ? (int)(100.0 * (double)done / (double)total) : 100;
  p->start = p->spoken = clock_wall();
  p->drawn = -1.0;
  p->name[0] = '\0';
}

/* A line on what is under way; a terminal has its bar. */
static void tell(progress *p, const char *text)
{
  p->spoken = clock_wall();
  log_line(p, text);
  if (p->terminal || p->quiet) return;
  fprintf(p->stream, "resonance: %s\n", text);
  fflush(p->stream);
}

void progress_tick(progress *p, size_t done, const char *name, double seconds)
{
  char text[400];
  if (p == NULL || p->total == 0) {
    progress_wait(p);
    return;
  }
  const double t = clock_wall();
  snprintf(p->name, sizeof p->name, "%s", name);
  p->since = t - seconds;
  if (p->terminal && !p->quiet) draw(p, done, t - p->start);
  if (t - p->spoken < p->every) return;
  snprintf(text, sizeof text, "%zu of %zu %s after %.0f s; the longest at work is %s, for %.0f s",
           done, p->total, p->what, t - p->start, name, seconds);
  tell(p, text);
}

void progress_step(progress *p, size_t done)
{
  char text[160];
  if (p == NULL || p->total == 0) return;
  const int percent = (int)(100.0 * (double)done / (double)p->total);
  const double elapsed = clock_wall() - p->start;
  if (p->terminal && !p->quiet && elapsed - p->drawn >= redraw_after) draw(p, done, elapsed);
  if (percent / LINE_STEP == p->percent / LINE_STEP) return;
  p->percent = percent;
  if (elapsed < first_line_after) return;
  snprintf(text, sizeof text, "%d %% of %zu %s after %.1f s", percent, p->total, p->what, elapsed);
  tell(p, text);
}

void progress_end(progress *p)
{
  if (p == NULL) return;
  clear(p);
  fflush(p->stream);
  p->total = 0;
  p->start = clock_wall();
  p->drawn = 0.0;
}

void progress_doing(progress *p, const char *what)
{
  if (p == NULL || p->total > 0) return;
  clear(p);
  snprintf(p->doing, sizeof p->doing, "%s", what);
  safe_text_clean(p->doing);
  p->start = p->spoken = clock_wall();
  p->drawn = 0.0;
}

void progress_wait(progress *p)
{
  char text[200];
  if (p == NULL || p->total > 0) return;
  const double t = clock_wall(), elapsed = t - p->start;
  const int draws = p->terminal && !p->quiet && elapsed - p->drawn >= wait_redraw;
  const double every =
    p->doing[0] != '\0' ? fmin(p->every, fmax(doing_line_after, 0.5 * elapsed)) : p->every;
  if (!draws && t - p->spoken < every) return;
  snprintf(text, sizeof text, "%s, for %.0f s",
           p->doing[0] != '\0' ? p->doing : "before the next tasks", elapsed);
  if (draws) {
    clear(p);
    p->width = fprintf(p->stream, "%.*s", columns_of(p) - 1, text);
    p->drawn = elapsed;
    fflush(p->stream);
  }
  if (t - p->spoken >= every) tell(p, text);
}

static void say(progress *p, int silent, const char *kind, const char *format, va_list args)
{
  char text[2048];
  const int n = snprintf(text, sizeof text, "%s", kind);
  (void)vsnprintf(text + n, sizeof text - (size_t)n, format, args);
  safe_text_clean(text);
  log_line(p, text);
  if (silent) return;
  clear(p);
  fprintf(p->stream, "resonance: %s\n", text);
  fflush(p->stream);
}

void progress_note(progress *p, const char *format, ...)
{
  va_list args;
  if (p == NULL) return;
  va_start(args, format);
  say(p, p->quiet, "", format, args);
  va_end(args);
}

void progress_warning(progress *p, const char *format, ...)
{
  va_list args;
  if (p == NULL) return;
  va_start(args, format);
  say(p, 0, "", format, args);
  va_end(args);
}

const char *progress_words(const char *words, pendres_status status)
{
  return words[0] != '\0' ? words : pendres_status_message(status);
}

void progress_error(progress *p, const char *format, ...)
{
  va_list args;
  if (p == NULL) return;
  va_start(args, format);
  say(p, 0, "error: ", format, args);
  va_end(args);
}
