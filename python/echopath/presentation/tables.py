"""Results as tables: what their methods `to_dataframe` and `to_csv` do. Units stand in `table.attrs["units"]`, {column: unit},
and in files at the end of the names of columns."""
from __future__ import annotations

import csv

import numpy as np

from ..arguments.checks import file
from ..base.process.libraries import needed_module
from ..base.storage.files import written_whole
from ..paths.edge_hits import edge_hits
from ..paths.families import families

_REVERSED = 1  # bit of Paths.flags
_NO_MESH = -1         # beyond the last hit of a path
_BETWEEN = " > "      # names of meshes along a path
PATH_UNITS = {"length": "m", "power": "W"}
_UNIT_IN_NAME = {"m": "m", "s": "s", "rad": "rad", "m/s": "m_per_s", "rad/s": "rad_per_s", "W": "w", "m^2": "m2", "dB": "db"}


def make_table(columns: dict, units: dict):
    """A pandas.DataFrame of {name: values} with the units {name: unit} of those that have one."""
    table = needed_module("pandas", "to_dataframe", extra="pandas").DataFrame(columns)
    table.attrs["units"] = {name: unit for name, unit in units.items() if name in columns}
    return table


def name_with_unit(name: str, units: dict) -> str:
    """What a column is called in a file: range_m, velocity_m_per_s, snr_db; the name alone where it has no unit."""
    end = "_" + _UNIT_IN_NAME[units[name]] if name in units else ""
    return name if name.endswith(end) else name + end


def write_csv(path, columns: dict, units: dict) -> None:
    """Writes {name: values [N]} with {name: unit} as a table with a header, whole or not at all; NaN as nothing. Raises
    ep.FileError."""
    with written_whole(file("path", path)) as temporary, open(temporary, "w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow([name_with_unit(name, units) for name in columns])
        writer.writerows([_as_text(value) for value in row] for row in zip(*columns.values()))


def _as_text(value) -> str:
    if isinstance(value, (float, np.floating)):
        return "" if np.isnan(value) else repr(float(value))
    return str(value)


def paths_table(paths):
    """Paths as a table; see Paths.to_dataframe."""
    pandas = needed_module("pandas", "to_dataframe", extra="pandas")
    meshes, events = _chains(paths)
    found = families(paths)
    names = np.array([*(stratum.name for stratum in paths.frame.strata), ""], dtype=object)
    stratum = np.minimum(paths.stratum, len(names) - 1)

    def texts(codes, values):
        used, codes = np.unique(np.asarray(values, dtype=object)[codes].astype(str), return_inverse=True)
        return pandas.Categorical.from_codes(codes.astype(np.int32), used)

    family = found.family_of_path
    columns = {
        "bounces": np.asarray(paths.num_bounces),
        "meshes": texts(*meshes), "events": texts(*events), "passes": texts(*_passes(paths)),
        "kind": texts((paths.diffuse != 0).astype(np.int8), ["coherent", "diffuse"]),
        "object": texts(family, [one.object for one in found]), "ghost_type": found.ghost_type, "order": found.order,
        "length": paths.lengths([paths.frame.trace_time])[0], "power": paths.power,
        "stratum": texts(stratum, names), "batch": np.asarray(paths.batch),
        "is_reversed": (paths.flags & _REVERSED) != 0}
    return make_table(columns, PATH_UNITS)


def _chains(paths) -> tuple:
    """(code [P], texts [N]) of the meshes along each path, and the same of its events."""
    most = int(paths.num_bounces.max(initial=0))
    bounces, offsets = paths.num_bounces.astype(np.int64), paths.offsets
    met = np.full((paths.num_paths, most), _NO_MESH, np.int64)
    for hit in range(most):
        has_it = bounces > hit
        met[has_it, hit] = paths.mesh_id[offsets[has_it] + hit]
    names = [mesh.name for mesh in paths.scene.meshes]
    chains, chain_of_path = _distinct(met)
    meshes = [_BETWEEN.join(names[mesh] for mesh in chain if mesh != _NO_MESH) for chain in chains]
    within = (np.uint64(1) << bounces.astype(np.uint64)) - np.uint64(1)  # of 64: all
    edge = edge_hits(paths).astype(np.uint64)
    marks, mark_of_path = _distinct(np.stack([paths.diffuse & within, bounces.astype(np.uint64), edge], axis=1))
    events = ["".join(event(int(bits), int(on), hit) for hit in range(int(count))) for bits, count, on in marks]
    return (chain_of_path, meshes), (mark_of_path, events)


def _passes(paths) -> tuple:
    """(code [P], texts [N]) of the sheets through which each path goes, in order of travel."""
    if len(paths.passes) == 0:
        return np.zeros(paths.num_paths, np.int64), [""]
    names, offsets, mesh_id = [mesh.name for mesh in paths.scene.meshes], paths.pass_offsets, paths.passes["mesh_id"]
    counts = np.diff(offsets)
    met = np.full((paths.num_paths, int(counts.max())), _NO_MESH, np.int64)
    for place in range(met.shape[1]):
        has_it = counts > place
        met[has_it, place] = mesh_id[offsets[:-1][has_it] + place]
    chains, chain_of_path = _distinct(met)
    return chain_of_path, [_BETWEEN.join(names[mesh] for mesh in chain if mesh != _NO_MESH) for chain in chains]


def event(diffuse: int, edges: int, hit: int) -> str:
    """The letter of a hit of a path, as expressions have it: E where its bit of `edges` is set, D where that of `diffuse` is,
    else S."""
    return "E" if edges >> hit & 1 else "SD"[diffuse >> hit & 1]


def _distinct(rows) -> tuple:
    """The distinct rows of [P, K], and which of them each row is [P]."""
    distinct, of_row = np.unique(rows, axis=0, return_inverse=True)
    return distinct, of_row.reshape(len(rows))
