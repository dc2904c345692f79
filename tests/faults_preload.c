/*
 * faults_preload.c -- a library to preload (LD_PRELOAD) that makes one call fail, for
 * faults_check.sh. FAULT_CALL names the call and FAULT_AT which of its occurrences, from 1 on; 0:
 * none, and FAULT_COUNT names a file that gets the number of them. Of allocations those alone count
 * that are made by FAULT_BY, a part of the name of a library, or by the program itself (""); and
 * FAULT_LIST names a file that gets a line for each of them: its number, and by which of the
 * program's functions it was asked for, the last FAULT_DEPTH of them, as one number.
 * FAULT_CALL=clock: from then on clocks run backwards; FAULT_CALL=flock: all locks are denied.
 * glibc's own names are used.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t n, size_t size);
void *__libc_realloc(void *p, size_t size);
void *__libc_memalign(size_t alignment, size_t size);

static const char *call = "", *by = "";
static long at;
static atomic_long count;
static uintptr_t first[64], last[64]; /* where the code is that counts */
static int parts;
static uintptr_t own_first, own_last; /* where the program's code is */
static int list = -1, depth = 4;
static _Thread_local int listing;

static int note_object(struct dl_phdr_info *info, size_t size, void *arg)
{
  const int own = info->dlpi_name == NULL || *info->dlpi_name == '\0';
  const int program = own && own_first == 0; /* it is the first */
  (void)size;
  (void)arg;
  for (int i = 0; i < info->dlpi_phnum && parts < 64; i++) {
    if (info->dlpi_phdr[i].p_type != PT_LOAD || !(info->dlpi_phdr[i].p_flags & PF_X)) continue;
    const uintptr_t from = info->dlpi_addr + info->dlpi_phdr[i].p_vaddr;
    const uintptr_t to = from + info->dlpi_phdr[i].p_memsz;
    if (program && own_first == 0) {
      own_first = from;
      own_last = to;
    }
    if (*by == '\0' ? !program : own || strstr(info->dlpi_name, by) == NULL) continue;
    first[parts] = from;
    last[parts++] = to;
  }
  return 0;
}

/* Room for a line is on the stack: what is counted here may not allocate. */
static void list_place(long number)
{
  void *frame[64];
  char line[64];
  uint64_t place = 0;
  if (list < 0 || listing) return;
  listing = 1;
  const int n = backtrace(frame, 64);
  for (int i = 0, own = 0; i < n && own < depth; i++) {
    const uintptr_t at = (uintptr_t)frame[i];
    if (at < own_first || at >= own_last) continue;
    place = (place ^ (at - own_first)) * UINT64_C(1099511628211) + 1;
    own++;
  }
  const int size = snprintf(line, sizeof line, "%ld %llx\n", number, (unsigned long long)place);
  if (size < 0 || write(list, line, (size_t)size) != size) abort();
  listing = 0;
}

__attribute__((constructor)) static void begin(void)
{
  const char *which = getenv("FAULT_AT");
  if (getenv("FAULT_BY") != NULL) by = getenv("FAULT_BY");
  if (which != NULL) at = atol(which);
  (void)dl_iterate_phdr(note_object, NULL);
  if (getenv("FAULT_DEPTH") != NULL) depth = atoi(getenv("FAULT_DEPTH"));
  if (getenv("FAULT_LIST") != NULL) {
    void *frame[4];
    (void)backtrace(frame, 4); /* what it allocates when it is first called does not count */
    list = creat(getenv("FAULT_LIST"), 0666);
  }
  if (getenv("FAULT_CALL") != NULL) call = getenv("FAULT_CALL");
}

__attribute__((destructor)) static void end(void)
{
  const char *name = getenv("FAULT_COUNT");
  const long n = atomic_load(&count);
  if (name == NULL) return;
  call = "";
  FILE *f = fopen(name, "w");
  if (f == NULL) return;
  fprintf(f, "%ld\n", n);
  (void)fclose(f);
}

static int is(const char *name)
{
  return strcmp(call, name) == 0;
}

static int fails(const char *name)
{
  if (!is(name)) return 0;
  const long number = atomic_fetch_add(&count, 1) + 1;
  list_place(number);
  return number == at;
}

/* An allocation by the code at `caller`. */
static int fails_for(const void *caller)
{
  if (!is("malloc")) return 0;
  for (int i = 0; i < parts; i++)
    if ((uintptr_t)caller >= first[i] && (uintptr_t)caller < last[i]) return fails("malloc");
  return 0;
}

#define ALLOCATE(value) \
  do { \
    if (!fails_for(__builtin_return_address(0))) return value; \
    errno = ENOMEM; \
    return NULL; \
  } while (0)

void *malloc(size_t size) { ALLOCATE(__libc_malloc(size)); }
void *calloc(size_t n, size_t size) { ALLOCATE(__libc_calloc(n, size)); }
void *realloc(void *p, size_t size) { ALLOCATE(__libc_realloc(p, size)); }
void *aligned_alloc(size_t a, size_t size) { ALLOCATE(__libc_memalign(a, size)); }
int posix_memalign(void **out, size_t a, size_t size)
{
  void *p = fails_for(__builtin_return_address(0)) ? NULL : __libc_memalign(a, size);
  if (p == NULL) return ENOMEM;
  *out = p;
  return 0;
}

/* A call of the system that fails with the errno, or goes through. */
#define FAIL(name, error) \
  do { \
    if (fails(name)) { \
      errno = error; \
      return -1; \
    } \
  } while (0)
#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

ssize_t write(int fd, const void *p, size_t n)
{
  if (fd > 2) FAIL("write", ENOSPC);
  return NEXT(write)(fd, p, n);
}

ssize_t pwrite(int fd, const void *p, size_t n, off_t o)
{
  FAIL("write", ENOSPC);
  return NEXT(pwrite)(fd, p, n, o);
}

ssize_t pwrite64(int fd, const void *p, size_t n, off64_t o)
{
  FAIL("write", EIO);
  return NEXT(pwrite64)(fd, p, n, o);
}

int fsync(int fd)
{
  FAIL("fsync", EIO);
  return NEXT(fsync)(fd);
}

int fdatasync(int fd)
{
  FAIL("fsync", EIO);
  return NEXT(fdatasync)(fd);
}

int flock(int fd, int operation)
{
  if (!is("flock")) return NEXT(flock)(fd, operation);
  errno = ENOLCK;
  return -1;
}

int rename(const char *from, const char *to)
{
  FAIL("rename", EACCES);
  return NEXT(rename)(from, to);
}

int ftruncate(int fd, off_t size)
{
  FAIL("ftruncate", EIO);
  return NEXT(ftruncate)(fd, size);
}

#define OPEN(name) \
  int name(const char *path, int flags, ...) \
  { \
    va_list args; \
    va_start(args, flags); \
    const mode_t mode = flags & (O_CREAT | __O_TMPFILE) ? va_arg(args, mode_t) : 0; \
    va_end(args); \
    FAIL("open", EMFILE); \
    return NEXT(name)(path, flags, mode); \
  }
OPEN(open)
OPEN(open64)

int clock_gettime(clockid_t clock, struct timespec *t)
{
  const int code = NEXT(clock_gettime)(clock, t);
  if (is("clock")) {
    const long n = atomic_fetch_add(&count, 1);
    t->tv_sec = n >= at && t->tv_sec > n ? t->tv_sec - n : t->tv_sec;
  }
  return code;
}
