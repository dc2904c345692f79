/*
 * own_file.h -- files that a run makes, beside those of others.
 *
 * Owns: making a file where nothing stands, never through a link; knowing it again by what it is
 * and not by its name alone; removing nothing else; and keeping what stands in the place of a file
 * under another name. No state; any thread may.
 */
#ifndef OWN_FILE_H
#define OWN_FILE_H

/* Make a file and open it for reading and writing: with the permissions of the file `like`, in the
   place of which it is to stand, if that is there. -1 and errno: EEXIST where anything is there. */
int own_file_create(const char *path, const char *like);

/* Is the open file still the one of that name? Somebody may have removed or replaced it. */
int own_file_is(int fd, const char *path);

/* Remove the name of an open file, if it is still its own. */
void own_file_remove(int fd, const char *path);

/*
 * Give a file that is there a second name, PATH.~1~ or the next one that is free; on file systems
 * without links it loses the first. The name is to be freed; NULL and an errno in *why.
 */
char *own_file_keep(const char *path, int *why);

#endif
