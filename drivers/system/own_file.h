/*
 * own_file.h -- files that a run makes, as opposed to those of others.
 *
 * Owns: making a file where none exists, never through a link; recognising it by its identity and
 * not only by its name; removing nothing else; and keeping an existing file under another name. No
 * state; any thread may call.
 */
#ifndef OWN_FILE_H
#define OWN_FILE_H

/* Make a file and open it for reading and writing, with the permissions of the file `like`, which
   it is to replace, if that exists. -1 and errno: EEXIST where anything of that name exists. */
int own_file_create(const char *path, const char *like);

/* Whether the open file is still the one of that name: it may have been removed or replaced. */
int own_file_is(int fd, const char *path);

/* Remove the name of an open file, if it is still its own. */
void own_file_remove(int fd, const char *path);

/*
 * Give an existing file a second name, PATH.~1~ or the next one that is free; on file systems
 * without links it loses the first. The name is to be freed; NULL on failure, with an errno in
 * *why.
 */
char *own_file_keep(const char *path, int *why);

#endif
