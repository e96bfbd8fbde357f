#!/bin/sh
# switched.sh FOLDER-OF-THE-TOOLS - processor time of a step of a switched
# model, of the fixed model of the whole library and of the full model, for the
# beam of data/switching with a load across it: 400 000 steps, the least of
# three runs. Prints the table of docs/methods/switched.md. The status is 1 if a
# step of the switched model costs more than one of the fixed model.
set -eu
bin=$(cd "$1" && pwd)
data=$(cd "$(dirname "$0")/../../data/switching" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
PATH=$bin:$PATH

sh "$data/make-matrices.sh" .
ritz-import -q --stiffness turn.K.mtx --mass beam.M.mtx --dofs beam.dofs \
    --input across=11:2 --output-at y=11:2 -o full.h5
ritz-basis -q normal-modes --modes 11 full.h5 -o basis.h5
ritz-reduce -q full.h5 basis.h5 -o fixed.h5

# run NAME FILE OPTION...: simulate FILE three times and append a line for each
run() {
    name=$1 file=$2
    shift 2
    for turn in 1 2 3; do
        ritz-simulate -q "$file" --damping 'rayleigh 10 0' --seconds 400 \
            --step 0.001 --every 1000 --input across=sine:5*10 "$@" \
            --record runs.jsonl -o run.h5
        ritz-info run.h5 | awk -v name="$name" '/vector-steps/ { v = $4 }
            END { printf "%s\t%s\t", name, v / 400000 }' >>times
        tail -n 1 runs.jsonl | sed 's/.*"cpu":\([0-9.e-]*\).*/\1/' >>times
    done
}
run fixed fixed.h5
run switched full.h5 --switched basis.h5 --indicator 0.999999999 \
    --share-of library --look-ahead --switch-interval 0.02
run full full.h5 --method trapezoidal
awk -F '\t' '{
    if (!($1 in least) || $3 < least[$1])
        least[$1] = $3
    vectors[$1] = $1 == "fixed" ? 12 : $1 == "full" ? 30 : $2
}
END {
    printf "%-10s %10s %10s %10s\n", "model", "vectors", "us a step", "ratio"
    for (k = split("fixed switched full", name, " "); k >= 1; k--)
        printf "%-10s %10.3g %10.3f %10.3f\n", name[k], vectors[name[k]],
            least[name[k]] / 0.4, least[name[k]] / least["fixed"]
    exit !(least["switched"] < least["fixed"])
}' times
