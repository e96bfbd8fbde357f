#!/bin/sh
# outputs.sh FOLDER-OF-THE-TOOLS - no input is overwritten, a failure leaves no
# output, and a replaced file keeps its permissions and links.
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

# stays FILE COMMAND...: the command is refused, and FILE is unchanged.
stays() {
    kept=$1
    shift
    cp "$kept" kept
    expect 1 "would overwrite the input" "$@"
    same "  $kept stays" "$kept" kept
}

# gone FILE: neither FILE nor a draft of it exists.
gone() {
    ls "$1"* >log 2>&1 && report no "no $1*" || report yes "  leaves no $1*"
}

cp "$data/chain/chain.K.mtx" K.mtx
import_chain --input tip=10:1 --output-at root=1:1 -o chain.h5
ritz-basis -q balanced --modes 4 chain.h5 -o basis.h5
ritz-reduce -q chain.h5 basis.h5 -o small.h5
ritz-basis -q macneal-rubin --modes 4 chain.h5 -o modes.h5
ritz-reduce -q chain.h5 modes.h5 -o list.h5

# --- an input under any of its names -----------------------------------------

stays chain.h5 ritz-basis balanced --modes 2 chain.h5 -o chain.h5
stays basis.h5 ritz-reduce chain.h5 basis.h5 -o ./basis.h5
ln chain.h5 hard.h5
ln -s chain.h5 soft.h5
stays chain.h5 ritz-reduce chain.h5 basis.h5 -o hard.h5
stays chain.h5 ritz-reduce chain.h5 basis.h5 -o soft.h5
stays chain.h5 ritz-reduce soft.h5 basis.h5 -o chain.h5
works '  soft.h5 is a link yet' test -L soft.h5
stays small.h5 ritz-verify chain.h5 small.h5 -o small.h5
stays chain.h5 ritz-info chain.h5 -o chain.h5
stays chain.h5 ritz-check chain.h5 -o chain.h5
stays chain.h5 ritz-poles chain.h5 -o chain.h5
stays chain.h5 ritz-info chain.h5 --record chain.h5
stays small.h5 ritz-info chain.h5 small.h5 --record small.h5
cp small.h5 kept
expect 1 'none.h5' ritz-info none.h5 small.h5 --record small.h5
same '  one that was not read yet stays' small.h5 kept
expect 1 "'K.mtx' holds something else than records" ritz-basis balanced \
    --modes 2 chain.h5 -o none.h5 --record K.mtx
same '  what is no record stays' "$data/chain/chain.K.mtx" K.mtx
printf '\n {"tool": "a"}\n' >old.jsonl
expect 0 '' ritz-info small.h5 -q --record old.jsonl
works '  a line behind another' grep -q '^{"tool":"ritz-info"' old.jsonl
stays chain.h5 ritz-frf small.h5 --points-of chain.h5 -o chain.h5
stays small.h5 ritz-rank small.h5 --table small.h5
stays small.h5 ritz-export small.h5 --to matlab --force -o small.h5
stays K.mtx ritz-import --stiffness K.mtx --mass "$data/chain/chain.M.mtx" \
    --dofs "$data/chain/chain.dofs" -o K.mtx

# a file that an input includes is an input too
printf "BEGIN BULK\nINCLUDE 'inner.bdf'\nENDDATA\n" >outer.bdf
awk 'BEGIN { for (i = 1; i <= 10; i++) printf "GRID,%d,,%d.,0.,0.\n", i, i }' \
    >inner.bdf
stays inner.bdf ritz-import --stiffness K.mtx --mass "$data/chain/chain.M.mtx" \
    --dofs "$data/chain/chain.dofs" --bulk outer.bdf -o inner.bdf

# names that a tool makes itself
import_spacecraft
spacecraft scene 'band_hz: [0, 5]'
stays rotor.h5 ritz-compare scene.yaml --components '' -o system.h5
gone system.h5
stays rotor.h5 ritz-fit scene.yaml --tolerance frequency=1e-2 --components ''
stays scene.yaml ritz-compare scene.yaml --report scene.yaml -o system.h5
stays rotor.h5 ritz-assemble scene.yaml --tracks rotor.h5 -o system.h5
gone system.h5
ritz-assemble -q scene.yaml -o system.h5 --tracks page.svg.tsv
stays page.svg.tsv ritz-chart tracks page.svg.tsv -o page.svg

# --- two outputs under one name -----------------------------------------------

expect 2 "--report and --output name one file, './system.h5'" ritz-compare \
    scene.yaml --report system.h5 -o ./system.h5
expect 2 "--table and --record name one file" ritz-rank list.h5 --table t \
    --record t
gone t
expect 1 'written twice' ritz-rank list.h5 --by modal-cost --table x.svg.tsv \
    --chart x.svg
gone x.svg

# --- any failure, even the last step's, leaves nothing ------------------------

expect 1 'No space left' ritz-reduce chain.h5 basis.h5 -o new.h5 \
    --record /dev/full
gone new.h5
expect 1 'cannot write to standard output' sh -c \
    'ritz-reduce chain.h5 basis.h5 -o new.h5 >/dev/full'
gone new.h5
cp small.h5 old.h5
expect 1 'No space left' ritz-reduce chain.h5 basis.h5 -o old.h5 \
    --record /dev/full
same '  what was there stays' small.h5 old.h5
expect 1 "cannot open 'none/runs'" ritz-basis balanced --modes 4 chain.h5 \
    -o new.h5 --record none/runs
gone new.h5
expect 1 "does not end in '.svg'" ritz-rank list.h5 --by modal-cost -o new.h5 \
    --table new.tsv --chart new.png
gone new
expect 1 "No space left" ritz-compare scene.yaml --components new- \
    --report new.txt --tracks new.tsv -o new.h5 --record /dev/full
gone new

# a missed limit keeps its output, as documented, but not without its record
expect 1 'limits not met' ritz-verify chain.h5 small.h5 --limit-h-infinity \
    1e-12 -o missed.h5 --record runs.jsonl
works '  missed.h5 is there' test -s missed.h5
expect 1 'No space left' ritz-verify chain.h5 small.h5 --limit-h-infinity \
    1e-12 -o new.h5 --record /dev/full
gone new.h5

# --- a file that is replaced ----------------------------------------------------

chmod 600 old.h5
expect 0 '' ritz-reduce -q chain.h5 basis.h5 -o old.h5
works '  keeps its permissions' test "$(stat -c %a old.h5)" = 600
ln -s made.h5 link.h5
expect 0 '' ritz-reduce -q chain.h5 basis.h5 -o link.h5
works '  a link to nothing yet stays a link' test -L link.h5
works '  and what it names is made' test -s made.h5

# --- names under which no file can be made ------------------------------------

mkfifo fifo
for name in /dev/stdout /dev/stderr /dev/fd/1 /proc/self/fd/1; do
    expect 1 'an open file, such as standard output' \
        ritz-reduce -q chain.h5 basis.h5 -o "$name"
    expect 1 'an open file, such as standard output' sh -c \
        "ritz-reduce -q chain.h5 basis.h5 -o $name >plain"
done
ln -s /dev/stdout spoken
expect 1 'an open file, such as standard output' \
    ritz-rank -q small.h5 --table spoken
for name in fifo /dev/null /dev/full; do
    expect 1 'not a regular file' \
        ritz-reduce -q chain.h5 basis.h5 -o "$name"
done
works '  fifo is a pipe yet' test -p fifo
expect 1 'standard output or error goes there already' sh -c \
    'ritz-reduce chain.h5 basis.h5 -o plain >plain'
expect 0 '' sh -c 'ritz-info -q small.h5 --record /dev/stdout | grep -q tool'

ls -A | grep -F .part >log && report no 'no leftovers' ||
    report yes 'no leftovers'
echo "1..$count"
