/* Open HDF5 files by descriptor, so that the file is the same whatever its path
   points to by now. Depends on HDF5 and the system alone, since
   libexec/ritz-walk.c uses it, too. */
#ifndef RITZ_CONTAINER_DESCRIPTOR_H
#define RITZ_CONTAINER_DESCRIPTOR_H

#include <hdf5.h>

/** Open to read; @p file is duplicated. @return less than 0 if HDF5 refuses
 * it */
hid_t ritz_descriptor_open(int file);

#endif
