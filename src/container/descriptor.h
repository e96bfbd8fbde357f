/* HDF5 files to be read by a descriptor that is open, whatever has their name
   by now. Of HDF5 and the system alone: libexec/ritz-walk.c uses it, too. */
#ifndef RITZ_CONTAINER_DESCRIPTOR_H
#define RITZ_CONTAINER_DESCRIPTOR_H

#include <hdf5.h>

/** Open to read; @p file is duplicated. @return less than 0 if HDF5 refuses */
hid_t ritz_descriptor_open(int file);

#endif
