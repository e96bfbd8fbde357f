#!/bin/sh
# walker.sh FOLDER-OF-THE-TOOLS [COUNT] - HDF5 files that are damaged, or made to
# crash their reader: ritz-walk, a process of its own, reads them first, and the
# tool refuses them. COUNT is the number of random damages of a MAT file and of
# a container; use more for a night.
spoils=${2:-25}
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

import_chain --input tip=10:1 --output-at root=1:1 -o new.h5
works 'files without checksums are made' \
    /usr/bin/python3 -s "$here/walker.py" make
ulimit -c 0
# With a sanitizer: HDF5 itself leaks memory on damaged files.
export LSAN_OPTIONS="suppressions=$here/../unit/hdf5.supp:print_suppressions=0"

# --- sound files --------------------------------------------------------------

expect 0 'MAT 7.3, sparse' ritz-info old.mat
ritz-info new.h5 >new.txt
ritz-info old.h5 >old.txt
works 'a container without checksums is read as one with them' \
    sh -c "sed '1s/new/old/' new.txt | cmp - old.txt"
expect 0 'the same struct as under another name' ritz-info own_member.mat

# --- HDF5 dies, loops, or asks for 4 GB ---------------------------------------

expect 1 'own_child.mat'"'"': damaged: HDF5 ends by' ritz-info own_child.mat
expect 1 'damaged: HDF5 ends by' ritz-import --mass own_child.mat:K \
    -o none.h5
expect 1 'HDF5 has not read its' sh -c \
    'ulimit -S -t 1; ritz-info own_sibling.mat'
expect 1 'HDF5 asks for more than 1024 MiB' ritz-info large_chunk.mat
works 'none of them leaves a file' sh -c '! ls none.h5* 2>/dev/null'

# --- not an HDF5 file, or a part of one ---------------------------------------

head -c 3000 old.h5 >cut.h5
expect 1 'cut.h5: ' ritz-check cut.h5
head -c 3000 new.h5 >cut.h5
expect 1 'cut.h5: ' ritz-check cut.h5
mkfifo pipe
expect 1 'pipe: not a regular file' timeout 20 ritz-check pipe
expect 1 'not a regular file' ritz-check /dev/zero
expect 1 'no container' ritz-check own_member.mat

# --- the process ---------------------------------------------------------------------

# a tool that was copied without ritz-walk does not look for it elsewhere
mkdir alone
cp "$bin/ritz-info" alone
expect 1 'cannot be checked' alone/ritz-info new.h5
expect 1 'cannot be checked' env PATH="$bin" "$dir/alone/ritz-info" old.mat
expect 0 'matrix-market' alone/ritz-info "$data/chain/chain.K.mtx"
ln -s "$bin/ritz-info" linked
expect 0 'component' ./linked new.h5
expect 0 'component' sh -c 'trap "" CHLD; exec ritz-info new.h5'
expect 0 'component' sh -c 'exec ritz-info new.h5 <&-'
expect 0 '' sh -c 'ulimit -f 0; ritz-info -q new.h5'

works "$spoils damages of each kind of file end no tool" \
    /usr/bin/python3 -s "$here/walker.py" damage "$spoils"
echo "1..$count"
