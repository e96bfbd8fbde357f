#!/bin/sh
# install.sh FOLDER-OF-THE-TOOLS - the examples, built against an installed
# tree by pkg-config and by CMake, run and right.
. "$(dirname "$0")/tap.sh"

tree=$(dirname "$bin")
here=$here/../../examples
works 'the tree installs' cmake --install "$tree" --prefix "$dir/there"
pc=$(find there -name ritz.pc)
PKG_CONFIG_PATH=$dir/$(dirname "$pc")
LD_LIBRARY_PATH=$(cd "$(dirname "$pc")/.." && pwd)
export PKG_CONFIG_PATH LD_LIBRARY_PATH

for name in basis assembly response; do
    # shellcheck disable=SC2046 # flags are words
    works "$name builds with pkg-config" ${CC:-cc} -std=c2x -Wall -Wextra \
        -Wpedantic -Werror -o "$name" "$here/$name.c" "$here/rod.c" \
        $(pkg-config --cflags --libs ritz) -lm
done

# close NAME COLUMN REFERENCE WITHIN: every line of numbers, relative error
close() {
    "./$1" >"$1.txt" 2>log || report no "$1 runs"
    works "$1: column $2 is column $3 within $4" awk -v a="$2" -v b="$3" \
        -v e="$4" '/^ *[0-9]+ / { n++; d = $a / $b - 1; if (d * d > e * e) bad++ }
        END { exit !(n && !bad) }' "$1.txt"
}
# bar elements of length h: w is (k pi h / l)^2 / 24 too high, 3e-4 for k = 5
# of 200 and of 2 x 100; modes that were cut off add up to 3e-4, measured
close basis 2 3 1e-3
close assembly 2 3 1e-3
# a free rod, E A = rho A = 1: |H| = |cot(w l)| / w; 1 % of damping adds some
# (2 zeta w / w_1)^2 = 6e-5 far below its first mode
./response >response.txt
works 'response: |H| is that of a free rod' awk 'NR == 2 {
    w = 2 * 3.14159265358979 * $1
    d = $2 * w * sin(200 * w) / cos(200 * w) - 1
    exit !(d * d < 1e-6) }' response.txt

# the tools find ritz-walk, which reads HDF5 files first, relative to themselves
"$bin/ritz-import" -q --stiffness "$data/chain/chain.K.mtx" \
    --mass "$data/chain/chain.M.mtx" --dofs "$data/chain/chain.dofs" \
    --input push=1:1 -o chain.h5
works 'an installed tool reads a container' there/bin/ritz-info chain.h5
"$bin/ritz-basis" -q full chain.h5 -o chain-basis.h5
"$bin/ritz-reduce" -q chain.h5 chain-basis.h5 -o chain-small.h5
works 'an installed ritz-export finds the program of FMUs' \
    there/bin/ritz-export -q --force --to fmu chain-small.h5 -o chain.fmu
cp -r there moved
works 'and does where it was moved to' moved/bin/ritz-info chain.h5
rm -r moved/libexec
expect 1 'ritz-walk'"'"', which is installed with the tools, cannot be run' \
    moved/bin/ritz-info chain.h5

# Shared, HDF5 loads libcurl and Kerberos, which alone takes 20 ms.
for tool in there/bin/ritz-*; do
    works "${tool##*/} starts with few libraries" sh -c 'ldd "$1" >libraries &&
        ! grep -E "curl|krb5|hdf5|cholmod|mumps|scotch|slicot" libraries' - \
        "$tool"
done

works 'CMake finds ritz::ritz' cmake -S "$here" -B cmake \
    -DCMAKE_PREFIX_PATH="$dir/there"
works 'and builds the examples' cmake --build cmake
works 'which run' ./cmake/basis
works 'nothing private is visible' sh -c '! nm -D --defined-only \
    "$(ls there/lib*/libritz.so there/lib*/*/libritz.so 2>/dev/null |
    head -n 1)" | grep -v " ritz_" | grep " [TDRB] "'
printf '1..%d\n' "$count"
