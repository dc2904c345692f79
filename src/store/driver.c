/*
 * driver.c -- a virtual file driver of HDF5 on top of file.c.
 *
 * Owns: the table of callbacks. HDF5's own driver passes a failed write up; HDF5 then cannot
 * close the file, keeps half-freed objects and may crash at exit. Here a refused write is kept in
 * memory and counts as done; the store asks `file->error` after each call instead.
 * The format of the file is that of HDF5's default driver.
 * Source: HDF5 Reference Manual, "HDF5 Virtual File Layer".
 */
#include "store/internal.h"

#include <stdlib.h>

#if H5_VERSION_GE(1, 13, 2)
#include <H5FDdevelop.h>
#endif

typedef struct driver_file {
  H5FD_t base; /* HDF5's part, must be first */
  pendres_store_file *file;
  haddr_t eoa; /* end of what HDF5 has allocated */
  haddr_t eof; /* end of what was written */
} driver_file;

/* What the access property list carries. */
typedef struct driver_info {
  pendres_store_file *file;
} driver_info;

static H5FD_t *driver_open(const char *name, unsigned flags, hid_t access, haddr_t maxaddr)
{
  const driver_info *info = H5Pget_driver_info(access);
  driver_file *f = NULL;

  (void)name;
  (void)flags;
  (void)maxaddr;
  if (!info) return NULL;
  f = calloc(1, sizeof *f);
  if (!f) return NULL;
  f->file = info->file;
  return &f->base;
}

static herr_t driver_close(H5FD_t *base)
{
  free((driver_file *)base); /* the descriptor is the store's */
  return 0;
}

static herr_t driver_query(const H5FD_t *base, unsigned long *flags)
{
  (void)base;
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
           H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

static haddr_t driver_get_eoa(const H5FD_t *base, H5FD_mem_t type)
{
  (void)type;
  return ((const driver_file *)base)->eoa;
}

static herr_t driver_set_eoa(H5FD_t *base, H5FD_mem_t type, haddr_t address)
{
  (void)type;
  ((driver_file *)base)->eoa = address;
  return 0;
}

static haddr_t driver_get_eof(const H5FD_t *base, H5FD_mem_t type)
{
  (void)type;
  return ((const driver_file *)base)->eof;
}

static herr_t driver_get_handle(H5FD_t *base, hid_t access, void **handle)
{
  (void)access;
  *handle = &((driver_file *)base)->file->fd;
  return 0;
}

static herr_t driver_read(H5FD_t *base, H5FD_mem_t type, hid_t transfer, haddr_t address,
                          size_t size, void *buffer)
{
  (void)type;
  (void)transfer;
  return pendres_store_file_read(((driver_file *)base)->file, address, size, buffer);
}

static herr_t driver_write(H5FD_t *base, H5FD_mem_t type, hid_t transfer, haddr_t address,
                           size_t size, const void *buffer)
{
  driver_file *f = (driver_file *)base;

  (void)type;
  (void)transfer;
  if (pendres_store_file_write(f->file, address, size, buffer)) return -1;
  if (address + size > f->eof) f->eof = address + size;
  return 0;
}

static herr_t driver_truncate(H5FD_t *base, hid_t transfer, hbool_t closing)
{
  driver_file *f = (driver_file *)base;

  (void)transfer;
  (void)closing;
  if (f->eof == f->eoa) return 0;
  if (pendres_store_file_resize(f->file, f->eoa)) return -1;
  f->eof = f->eoa;
  return 0;
}

static const H5FD_class_t driver_class = {
#if H5_VERSION_GE(1, 13, 2)
  .version = H5FD_CLASS_VERSION,
  .value = (H5FD_class_value_t)600, /* 512 and above are free for private use */
#endif
  .name = "pendres",
  .maxaddr = (haddr_t)INT64_MAX,
  .fc_degree = H5F_CLOSE_WEAK,
  .fapl_size = sizeof(driver_info),
  .open = driver_open,
  .close = driver_close,
  .query = driver_query,
  .get_eoa = driver_get_eoa,
  .set_eoa = driver_set_eoa,
  .get_eof = driver_get_eof,
  .get_handle = driver_get_handle,
  .read = driver_read,
  .write = driver_write,
  .truncate = driver_truncate,
  .fl_map = H5FD_FLMAP_DICHOTOMY
};

hid_t pendres_store_driver_register(void)
{
  return H5FDregister(&driver_class);
}

herr_t pendres_store_driver_select(hid_t access, hid_t driver, pendres_store_file *file)
{
  const driver_info info = { file };

  return H5Pset_driver(access, driver, &info);
}
