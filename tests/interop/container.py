#!/usr/bin/python3 -s
"""container.py FILE... - h5py and SciPy see in containers what the
documentation says; the kind of each file says what is looked for."""
import sys

try:
    import h5py
    import numpy
    import scipy.sparse
except ImportError as missing:
    print("skipped:", missing)
    sys.exit(77)

KINDS = {"rigid", "constraint", "normal", "residual", "system", "krylov",
         "static", "attachment", "interface", "massless", "force", "state",
         "perturbed", "balanced"}


def text(value):
    """Text of an attribute, or of the data set that stands for a long one."""
    value = numpy.ravel(value)[0] if numpy.ndim(value) else value
    return value.decode() if isinstance(value, bytes) else str(value)


def texts(values):
    return [text(value) for value in values]


def sparse(group, n, symmetric=True):
    assert text(group.attrs["format"]) == "csc"
    A = scipy.sparse.csc_matrix(
        (group["data"][:], group["indices"][:], group["indptr"][:]),
        group.attrs["shape"])
    assert A.shape == (n, n) and A.has_sorted_indices
    # a component is settled: what asymmetry it had is averaged away, but in D
    assert not symmetric or A.nnz == 0 or abs(A - A.T).max() == 0.0
    return A


def check_sets(name, item):
    """Checksums over more than 64 values, no compression."""
    if isinstance(item, h5py.Dataset) and item.size > 64:
        assert item.fletcher32, name
        assert item.compression is None, name
        assert item.attrs["checksum"] > 0, name


def check_root(file):
    assert file.attrs["ritz_format"] == 1
    assert text(file.attrs["ritz_version"])
    for name in "command", "inputs":
        assert (name in file.attrs) != ("long_" + name in file), name
    inputs = (file.attrs["inputs"] if "inputs" in file.attrs
              else file["long_inputs"])
    for line in texts(inputs[:]):
        assert "  " in line, line
    assert "units" in file.attrs
    file.visititems(check_sets)


def check_io(at, n):
    if "inputs" in at:
        m = len(at["inputs/names"])
        assert len(set(texts(at["inputs/names"][:]))) == m
        assert at["inputs/B"].shape == (n, m)
    if "outputs" in at:
        p = len(at["outputs/names"])
        assert len(set(texts(at["outputs/names"][:]))) == p
        for name in "C", "Cv", "Ca":
            assert at["outputs"][name].shape == (p, n)
        assert at["outputs/limits"].shape == (p,)


def check_dampers(at, n):
    if "dampers" in at:
        dampers = at["dampers"]
        count = len(dampers["names"])
        assert len(set(texts(dampers["names"][:]))) == count > 0
        for name in "c", "k", "held_c", "held_k":
            assert dampers[name].shape == (count,)
        assert (dampers["c"][:] >= 0.0).all()
        assert dampers["B"].shape == (n, count)


def check_dofs(at, n):
    component = at["component"][:]
    assert at["grid"].shape == component.shape == (n,)
    assert ((component >= 0) & (component <= 6)).all()


def check_grids(file):
    if "grids" not in file:
        return
    grids = file["grids"]
    g = len(grids["id"])
    frames = grids["frames"][:]
    assert (numpy.diff(grids["id"][:]) > 0).all()
    assert grids["position"].shape == (g, 3)
    assert frames.shape[1:] == (3, 3)
    assert (frames[0] == numpy.eye(3)).all()
    assert (grids["frame"][:] < len(frames)).all()


def check_place(port):
    assert port.attrs["origin"].shape == (3,)
    assert port.attrs["axes"].shape == (3, 3)


def check_indices(group):
    indices = sorted(item.attrs["index"] for item in group.values())
    assert indices == list(range(len(group)))


def check_columns(file, r):
    assert set(texts(file["columns/kind"][:])) <= KINDS
    for name in "columns/kind", "columns/dof", "columns/hertz", "residuals":
        assert file[name].shape == (r,), name
    for name in "method", "options", "reference", "engine":
        assert name in file.attrs, name


def check_measures(at, name):
    if name in at:
        count = len(at[name]["name"])
        for part in "name", "value", "limit", "where":
            assert at[name][part].shape == (count,)


def component(file):
    n = len(file["dofs/grid"])
    check_dofs(file["dofs"], n)
    sparse(file["M"], n)
    sparse(file["K"], n)
    for name in "D", "K4":
        if name in file:
            sparse(file[name], n, name == "K4")
    check_dampers(file, n)
    if "KG" in file:
        check_indices(file["KG"])
        for load in file["KG"].values():
            sparse(load, n)
    check_grids(file)
    check_indices(file["ports"])
    for port in file["ports"].values():
        check_place(port)
        dofs = port["dofs"][:]
        assert len(set(dofs)) == len(dofs) and (dofs < n).all()
    check_io(file, n)
    assert {"damping", "asymmetry", "digits"} <= set(file.attrs)


def basis(file):
    check_columns(file, file["T"].shape[1])
    assert (file["columns/dof"][:] < file["T"].shape[0]).all()
    assert ("states" in file.attrs) == ("damping" in file.attrs)
    assert "W" not in file or file["W"].shape == file["T"].shape


def reduced(file):
    r = file["K"].shape[0]
    n = file.attrs["num_dofs"]
    for name in "K", "M", "D", "K4":
        assert (name in ("D", "K4") and name not in file
                or file[name].shape == (r, r))
    check_columns(file, r)
    check_dampers(file, r)
    if "T" in file:
        assert file["T"].shape == (n, r)
    if "dofs" in file:
        check_dofs(file["dofs"], n)
    check_grids(file)
    check_indices(file["ports"])
    for port in file["ports"].values():
        check_place(port)
        p = len(port["grid"])
        check_dofs(port, p)
        assert port["position"].shape == (p, 3)
        assert port["map"].shape == (p, r)
    check_io(file, r)
    if "inertia" in file:
        assert file["inertia/mass"].shape == (1,)
        assert file["inertia/centre"].shape == (3,)
        assert file["inertia/tensor"].shape == (3, 3)
    check_measures(file, "estimates")
    check_measures(file, "errors")


def system(file):
    check_indices(file["blocks"])
    check_indices(file["configurations"])
    first = 0
    for block in sorted(file["blocks"].values(),
                        key=lambda block: block.attrs["index"]):
        assert block.attrs["first"] == first
        first += block.attrs["order"]
    assert file.attrs["band_hz"].shape == (2,)
    for at in file["configurations"].values():
        e = at["K"].shape[0]
        assert at["M"].shape == (e, e) and at["lambda"].shape == (e,)
        for name in "D", "K4":
            assert name not in at or at[name].shape == (e, e)
        check_dampers(at, e)
        assert at["settings"].shape == file["sweeps"].shape
        assert 0 <= at.attrs["num_rigid"] <= e
        assert set(at["blocks"]) == set(file["blocks"])
        for name, P in at["blocks"].items():
            assert P.shape == (file["blocks"][name].attrs["order"], e)
        check_io(at, e)
        check_measures(at, "errors")


def response(file):
    hertz = file["hertz"][:]
    shape = (len(hertz), len(file["outputs/names"]), len(file["inputs/names"]))
    assert (numpy.diff(hertz) >= 0.0).all()
    assert file["H/real"].shape == file["H/imag"].shape == shape


def one_ranking(at):
    m = len(at["hertz"])
    for name in "zeta", "value", "order", "cluster":
        assert at[name].shape == (m,), name
    assert sorted(at["order"][:]) == list(range(m))
    assert (at["cluster"][:] <= numpy.arange(m)).all()
    assert (numpy.diff(abs(at["value"][:])[at["order"][:]]) <= 0.0).all()
    assert (numpy.diff(at["system_value"][:]) <= 0.0).all()
    assert at.attrs["coupled"].shape == (2,)
    assert at.attrs["coupling"].shape == at.attrs["total"].shape == ()
    assert "at" in at.attrs and "damping" in at.attrs
    if "parts" in at:
        p = len(at["parts/names"])
        assert at["parts/values"].shape == (m, p)
        assert at["parts/whole"].shape == (p,)
    if not numpy.isnan(at.attrs["total"]):
        assert numpy.isclose(at["value"][:].sum(), at.attrs["total"], 1e-12)


def ranking(file):
    if "rankings" not in file:
        one_ranking(file)
        return
    groups = sorted(file["rankings"].values(), key=lambda g: g.attrs["index"])
    assert [g.attrs["index"] for g in groups] == list(range(len(groups)))
    for group in groups:
        one_ranking(group)


def state_space(file):
    n = len(file["A"])
    m = len(file["inputs/names"]) if "inputs" in file else 0
    p = len(file["outputs/names"]) if "outputs" in file else 0
    assert file["A"].shape == (n, n)
    assert file["B"].shape == (n, m)
    assert file["C"].shape == (p, n)
    assert file["D"].shape == (p, m)
    assert "E" not in file or file["E"].shape == (n, n)
    assert p == 0 or file["outputs/limits"].shape == (p,)
    check_columns(file, n)
    check_measures(file, "estimates")
    check_measures(file, "errors")
    assert "damping" in file.attrs


CHECKS = {check.__name__.replace("_", "-"): check for check in
          (component, basis, reduced, system, response, ranking, state_space)}

if len(sys.argv) < 2:
    sys.exit(__doc__)
for path in sys.argv[1:]:
    with h5py.File(path, "r") as container:
        kind = text(container.attrs["ritz_kind"])
        check_root(container)
        CHECKS[kind](container)
        print(f"{path}: {kind}")
