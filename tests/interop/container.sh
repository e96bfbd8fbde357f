#!/bin/sh
# container.sh FOLDER-OF-THE-TOOLS - a container of every kind, as the tools
# write it, opened with h5py and SciPy by container.py.
set -eu
bin=$(cd "$1" && pwd)
here=$(cd "$(dirname "$0")" && pwd)
data=${RITZ_DATA:-$here/../../data}/dualspin
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cp "$data"/*.bdf "$data"/*.op4 "$data"/*.yaml "$dir"
cd "$dir"
mkdir build
PATH=$bin:$PATH
for body in rotor stator; do
    ritz-import -q --stiffness $body.op4:KGG --mass $body.op4:MGG \
        --bulk $body.bdf --port bearing=1 --port scan=5 \
        --input torque=1:6 --output-at gyro=5:6@1e-3 --units "kg m s" \
        -o build/$body.h5
done
ritz-import -q --mass platform.op4:MGG --bulk platform.bdf --port scan=1 \
    --units "kg m s" -o build/platform.h5
ritz-basis -q craig-bampton --up-to-hz 20 --attach bearing build/rotor.h5 \
    -o basis.h5
ritz-reduce -q build/rotor.h5 basis.h5 -o reduced.h5
ritz-verify -q build/rotor.h5 reduced.h5 -o verified.h5
ritz-compare -q scene.yaml --components part- -o system.h5
ritz-rank -q --by hankel --at clock=0 system.h5 -o ranking.h5
ritz-rank -q --by modal-cost,h2 system.h5 -o rankings.h5
ritz-frf -q --at clock=0 system.h5 -o response.h5
ritz-basis -q lanczos-one-sided --modes 9 --damping 'modal 0.01' \
    build/stator.h5 -o states.h5
ritz-reduce -q build/stator.h5 states.h5 -o space.h5
ritz-verify -q --damping 'modal 0.01' build/stator.h5 space.h5 -o measured.h5
exec /usr/bin/python3 -s "$here/container.py" build/*.h5 ./*.h5
