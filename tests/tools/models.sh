# Models that several test scripts begin with; sourced after tap.sh.
# shellcheck shell=sh disable=SC2154 # $data is of tap.sh

# import_body NAME OPTION...: a body of data/dualspin; the platform is a mass.
import_body() {
    body=$data/dualspin/$1
    shift
    [ "${body##*/}" = platform ] ||
        set -- --stiffness "$body.op4:KGG" "$@"
    ritz-import --mass "$body.op4:MGG" --bulk "$body.bdf" "$@"
}

# spacecraft NAME KEY...: NAME.yaml, a scene of three bodies of data/dualspin,
# with these keys; they are imported before by import_spacecraft ROTOR-OPTION...
import_spacecraft() {
    expect 0 '' import_body rotor -q --port bearing=1 "$@" --units 'kg m s' \
        -o rotor.h5
    expect 0 '' import_body stator -q --port bearing=1 --port scan=5 \
        --units 'kg m s' -o stator.h5
    expect 0 '' import_body platform -q --port scan=1 --units 'kg m s' \
        -o platform.h5
}
spacecraft() {
    file=$1.yaml
    shift
    cat >"$file" <<'END'
scene: two bodies and a platform
components:
  rotor: {model: rotor.h5, basis: macneal-rubin, modes: 12}
  stator: {model: stator.h5, basis: craig-bampton, modes: 4}
  platform: {model: platform.h5, basis: rigid}
joints:
  - {name: clock, between: [rotor/bearing, stator/bearing], type: hinge, axis: [0, 0, 1], angles_deg: [0, 90]}
  - {name: cone, between: [stator/scan, platform/scan], type: hinge, axis: [0, 1, 0], angles_deg: [0]}
damping: {modal: 0.002}
END
    for key in "$@"; do echo "$key" >>"$file"; done
}

# import_chain OPTION...: data/chain, damped; quietly.
import_chain() {
    chain=$data/chain/chain
    ritz-import -q --stiffness "$chain.K.mtx" --mass "$chain.M.mtx" \
        --damping "$chain.D.mtx" --dofs "$chain.dofs" "$@"
}

# array NAME SIZES VALUE...: a full matrix, by columns.
array() {
    name=$1 sizes=$2
    shift 2
    {
        printf '%%%%MatrixMarket matrix array real general\n%s\n' "$sizes"
        printf '%s\n' "$@"
    } >"$name"
}
