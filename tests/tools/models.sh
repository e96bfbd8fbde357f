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
