#!/bin/sh
# fmu.sh FOLDER-OF-THE-TOOLS - FMUs of a body of data/dualspin, opened and driven
# by Python alone: zipfile, ElementTree and ctypes.
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

import_body rotor -q --port bearing=1 --input torque=1:6 --output-at turn=1:6 \
    --units 'kg m s' -o rotor.h5
ritz-basis -q macneal-rubin --up-to-hz 5 --attach bearing rotor.h5 -o basis.h5
ritz-reduce -q rotor.h5 basis.h5 -o small.h5
ritz-verify -q --band-hz 0,3 --damping 'modal 0.01' rotor.h5 small.h5 \
    -o verified.h5
ritz-simulate -q verified.h5 --damping 'modal 0.01' --input torque=sine:0.7 \
    --hold zero --step 0.05 --seconds 5 -o motion.h5
ritz-export -q --to tsv motion.h5 -o motion.tsv

expect 0 'FMI 3.0, model exchange and co-simulation' ritz-export --to fmu \
    --damping 'modal 0.01' verified.h5 -o three.fmu
expect 0 'FMI 2.0, model exchange and co-simulation' ritz-export --to fmu \
    --fmi 2 --damping 'modal 0.01' verified.h5 -o two.fmu
expect 0 'of 0 uncoupled modes' ritz-export --to fmu --states \
    --damping 'modal 0.01' verified.h5 -o states.fmu
cp three.fmu first.fmu
ritz-export --to fmu --damping 'modal 0.01' verified.h5 -o three.fmu >said
works 'the same command writes the same bytes' cmp first.fmu three.fmu

cat >drive.py <<'TEXT'
"""The FMU's motion is that of a table of ritz-simulate, inputs held."""
import ctypes
import pathlib
import sys
import tempfile
import xml.etree.ElementTree
import zipfile

path, table = sys.argv[1:]
with open(table) as file:
    head = file.readline().lstrip('# ').rstrip('\n').split('\t')
    rows = [dict(zip(head, map(float, line.split('\t')))) for line in file]
real, number = ctypes.c_double, ctypes.c_uint32


def run(folder):
    root = xml.etree.ElementTree.parse(folder / 'modelDescription.xml').getroot()
    two = root.get('fmiVersion') == '2.0'
    where = 'linux64' if two else 'x86_64-linux'
    unit = ctypes.CDLL(str(folder / 'binaries' / where / 'ritz_fmu.so'))
    reference = {v.get('name'): number(int(v.get('valueReference')))
                 for v in root.find('ModelVariables')}
    resources = folder / 'resources'
    if two:
        unit.fmi2Instantiate.restype = ctypes.c_void_p
        one = ctypes.c_void_p(unit.fmi2Instantiate(
            b'one', 1, root.get('guid').encode(), resources.as_uri().encode(),
            None, 0, 0))
        assert one
        assert unit.fmi2SetupExperiment(one, 0, real(0), real(0), 0,
                                        real(0)) == 0
        assert unit.fmi2EnterInitializationMode(one) == 0
        assert unit.fmi2ExitInitializationMode(one) == 0
    else:
        unit.fmi3InstantiateCoSimulation.restype = ctypes.c_void_p
        one = ctypes.c_void_p(unit.fmi3InstantiateCoSimulation(
            b'one', root.get('instantiationToken').encode(),
            str(resources).encode(), False, False, False, False, None,
            ctypes.c_size_t(0), None, None, None))
        assert one
        assert unit.fmi3EnterInitializationMode(
            one, False, real(0), real(0), False, real(0)) == 0
        assert unit.fmi3ExitInitializationMode(one) == 0
    few = [] if two else [ctypes.c_size_t(1)]
    put = unit.fmi2SetReal if two else unit.fmi3SetFloat64
    get = unit.fmi2GetReal if two else unit.fmi3GetFloat64
    flags = (ctypes.c_bool * 3)()
    rest = [] if two else [ctypes.byref(flags, k) for k in range(3)] + \
        [ctypes.byref(real())]
    step = unit.fmi2DoStep if two else unit.fmi3DoStep
    worst = most = 0.0
    for row in rows:
        value = real(row['torque'])
        one_of = ctypes.c_size_t(1)
        assert put(one, ctypes.byref(reference['torque']), one_of,
                   ctypes.byref(value), *few) == 0
        assert get(one, ctypes.byref(reference['turn']), one_of,
                   ctypes.byref(value), *few) == 0
        worst = max(worst, abs(value.value - row['turn']))
        most = max(most, abs(row['turn']))
        assert step(one, real(row['seconds']), real(0.05), False, *rest) == 0
    (unit.fmi2FreeInstance if two else unit.fmi3FreeInstance)(one)
    # the table has 16 digits, and 100 steps round
    assert 0.0 < most and worst <= 1e-10 * most, (worst, most)


with tempfile.TemporaryDirectory() as folder:
    zipfile.ZipFile(path).extractall(folder)
    run(pathlib.Path(folder))
TEXT
for file in two three states; do
    works "$file.fmu moves as ritz-simulate --hold zero" \
        /usr/bin/python3 -s drive.py $file.fmu motion.tsv
done
unzip_text() {
    /usr/bin/python3 -s -c 'import sys, zipfile
print(zipfile.ZipFile(sys.argv[1]).read(sys.argv[2]).decode())' "$@"
}
expect 0 'error, measured: frequency-relative' \
    unzip_text three.fmu documentation/index.html
works 'inputs are named by their SHA-256' sh -c '
    /usr/bin/python3 -s -c "import zipfile
print(zipfile.ZipFile(\"three.fmu\").read(\"documentation/index.html\").decode())" |
    grep -q "^input: $(sha256sum <verified.h5 | cut -c 1-64)"'
expect 0 'unit="N.m"' unzip_text three.fmu modelDescription.xml

# --- refusals --------------------------------------------------------------------------

expect 1 'carries neither estimated nor measured errors' \
    sh -c 'ritz-basis -q guyan rotor.h5 -o b.h5 && ritz-reduce -q rotor.h5 b.h5 \
        -o unknown.h5 && ritz-export --to fmu unknown.h5 -o none.fmu'
expect 2 'openfast has no version of FMI' ritz-export --to openfast --fmi 2 \
    verified.h5 -o none.fmu
import_body rotor -q --port bearing=1 -o deaf.h5
ritz-basis -q macneal-rubin --up-to-hz 5 --attach bearing deaf.h5 -o b.h5
ritz-reduce -q deaf.h5 b.h5 -o deaf-small.h5
expect 1 'it has neither inputs nor outputs' ritz-export --force --to fmu \
    deaf-small.h5 -o none.fmu
works '  and nothing is written' test ! -e none.fmu
