/*
 * bytes.h -- reading and writing bytes of a file, always completely: what the system does in parts,
 * or a signal interrupts, is continued. No state; any thread may call.
 */
#ifndef BYTES_H
#define BYTES_H

#include <sys/types.h>

#include <pendres/status.h>

/* At an offset. 0 on failure, see errno: EIO where the file ends before, ENOSPC where nothing is
   taken. */
int bytes_read(int file, off_t at, void *to, size_t size);
int bytes_write(int file, off_t at, const void *from, size_t size);

/*
 * All that is still to be read of a file or a stream, as a text with a zero behind its end, to be
 * freed: the driver's one way to read a text. It is whole, or *text is NULL and the status says
 * why: PENDRES_UNSUPPORTED, it has more bytes than `most`; PENDRES_OUT_OF_MEMORY; PENDRES_IO, see
 * errno.
 */
pendres_status bytes_text(int file, size_t most, char **text, size_t *length);

#endif
