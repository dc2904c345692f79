/*
 * file.h -- what a name leads to: the driver's one door to files that are opened by name.
 *
 * Owns: which files are opened, by what they are for; recognising a file by its identity and not
 * only by its name; removing nothing else; and keeping an existing file under another name. No
 * state; any thread may call.
 */
#ifndef FILE_H
#define FILE_H

enum { FILE_WORDS = 512 };

/* What a file is opened for. Each is a regular one, and opening it never waits. */
typedef enum file_use {
  FILE_READ,    /* to be read, whoever made it: decks, data, tables */
  FILE_TRUSTED, /* to be believed, by reading alone: records of others' runs, what a run has left */
  FILE_OWN,     /* to be read and written, and made if there is none: journals, logs */
  FILE_NEW      /* to be made: tables */
} file_use;

/*
 * Open it; -1 and errno: `why`, a sentence with its name, says which condition is not met. Without
 * a link that is followed, and with no other name, all but FILE_READ belong to the user who runs
 * this. named: or to another, since he was told to use it, which `why` then says; otherwise it is
 * "". EEXIST where FILE_NEW finds anything of that name.
 */
int file_open(const char *path, file_use use, int named, char why[FILE_WORDS]);

/* Whether the open file is still the one of that name: it may have been removed or replaced. */
int file_is(int fd, const char *path);

/* Remove the name of an open file, if it is still its own. 0 or an errno. */
int file_remove(int fd, const char *path);

/* Give an open file the permissions of that which it is to replace, if there is one. */
void file_like(int fd, const char *path);

/*
 * Give an existing file a second name, PATH.~1~ or the next one that is free; on file systems
 * without links it loses the first. The name is to be freed; NULL on failure, with an errno in
 * *why.
 */
char *file_keep(const char *path, int *why);

#endif
