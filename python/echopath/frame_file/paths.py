"""Paths in HDF5 groups (layout: data/README.md)."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..paths.subset import HIT, HIT_FIELDS, subset
from .h5 import (
    blames_group,
    length_of,
    read_array,
    read_attribute,
    read_group,
    read_texts,
    write_array,
    write_attribute,
    write_texts,
)
from .seeds import read_seed, write_seed

PATH_FIELDS = {"offsets": np.int64, "num_bounces": np.uint8, "diffuse": np.uint64, "weight": np.complex64,
               "stratum": np.uint16, "batch": np.uint8, "flags": np.uint32}
# Columns that are there only where the scene asks for them: dtype and shape of an entry.
OPTIONAL_FIELDS = {"curved_cell": (np.float32, (7,)), "jones": (np.complex64, (2, 2))}
# Of each pass through a sheet, where there are any.
PASS_FIELDS = HIT_FIELDS | {"leg": np.uint32}
PASS = np.dtype(list(PASS_FIELDS.items()))
_NOISE_LIKE = ("u", "v", "weight")  # compression does not pay
RECORD_SETTINGS: dict[str, object] = _core.RECORD_SETTINGS  # of the trace, with the values of files that lack one
FIRST_SETTINGS = ("seed", "max_bounces", "polarization", "footprint", "sampler", "num_batches")  # which no file lacks
FRAME_VALUES = ("start_time", "trace_time", "target_error_db", "error_db")
LATER_FRAME_VALUES = ("objects_time",)  # which older files do not have, nor frames of no sequence
STATISTICS = ("num_rays", "num_queries", "num_hits", "num_paths", "num_near_antenna", "num_grazing", "num_small_mirrors",
              "num_false_hits", "num_unaimed", "num_unfollowed_frusta")
LATER_STATISTICS = ("num_unsplit_rays", "num_stopped_passes", "num_faint_paths")  # which older files do not have
STRATUM_FIELDS = {"axis": (np.float64, (3,)), "versine": (np.float64, ()), "ray_density": (np.float64, ()),
                  "num_rays": (np.int64, ()), "across": (np.float64, (3,)), "num_mirrors": (np.int64, ()),
                  "object": (np.int64, ()), "focus_of": (np.int64, ())}
STRIP = ("half_azimuth", "low", "high")  # of a stratum, one column in files
OLDER_NAMES = {"num_unfollowed_frusta": "num_unfollowed_beams"}


def write_paths(group, paths, min_power: float = 0.0, power=None):
    """Writes the paths of at least `min_power` (W, at the trace time for the first antennas) and how many it left out.

    power: of the paths [P] in W where it is known already.
    Returns which paths were written: bool [P].
    """
    power = paths.power if power is None else power
    keep = power >= min_power
    write_attribute(group, "min_power", float(min_power))
    write_attribute(group, "num_left_out", int(np.count_nonzero(~keep)))
    write_attribute(group, "power_left_out", float(power.sum(where=~keep)))
    written = paths if min_power <= 0.0 else subset(paths, keep)
    _write_frame(group.create_group("frame"), written.frame)
    for fields, folder in ((HIT_FIELDS, "hits"), (PATH_FIELDS, "paths")):
        target = group.create_group(folder)
        for name in fields:
            write_array(target, name, getattr(written, name), compress=name not in _NOISE_LIKE)
    for name in OPTIONAL_FIELDS:
        if len(getattr(written, name)):
            write_array(group["paths"], name, getattr(written, name))
    if len(written.passes):
        _write_passes(group.create_group("passes"), written)
    return keep


def _write_passes(group, paths) -> None:
    write_array(group, "pass_offsets", paths.pass_offsets, compress=True)
    for name in PASS_FIELDS:
        write_array(group, name, paths.passes[name], compress=name not in _NOISE_LIKE)


@blames_group
def _read_passes(group, num_paths: int) -> dict:
    passes = np.empty(length_of(group, "mesh_id"), PASS)
    for name, dtype in PASS_FIELDS.items():
        passes[name] = read_array(group, name, dtype, (len(passes),))
    return {"passes": passes, "pass_offsets": read_array(group, "pass_offsets", np.int64, (num_paths + 1,))}


@blames_group
def read_paths(group, scene, radar):
    """The paths of a group; the same bits that were written."""
    source = read_group(group, "hits")
    num_hits = length_of(source, "mesh_id")
    hits = np.empty(num_hits, HIT)
    for name, dtype in HIT_FIELDS.items():
        hits[name] = read_array(source, name, dtype, (num_hits,))
    source = read_group(group, "paths")
    num_paths = length_of(source, "offsets")
    columns = {name: read_array(source, name, dtype, (num_paths,)) for name, dtype in PATH_FIELDS.items()}
    for name, (dtype, shape) in OPTIONAL_FIELDS.items():
        if name in source:
            columns[name] = read_array(source, name, dtype, (num_paths, *shape))
    if "passes" in group:
        columns |= _read_passes(read_group(group, "passes"), num_paths)
    _check_names(source)
    _check_indices(group, hits, columns, scene)
    frame = _read_frame(read_group(group, "frame"))
    return _core.Paths.from_arrays(hits=hits, **columns, scene=scene, radar=radar, frame=frame)


def _check_names(group) -> None:
    """What nobody would read may be a column whose name is damaged."""
    for name in group:
        if name not in PATH_FIELDS and name not in OPTIONAL_FIELDS:
            raise _core.FileError(f"{group.name}/{name}: unknown column of the paths")


def _check_indices(group, hits, columns: dict, scene) -> None:
    """Whatever indexes something else must stay inside it."""
    offsets = columns["offsets"]
    if np.any(offsets < 0) or np.any(offsets > len(hits) - columns["num_bounces"].astype(np.int64)):
        raise _core.FileError(f"{group.name}/paths/offsets: must lie within the {len(hits)} hits")
    meshes = list(scene.meshes)
    if len(hits) and hits["mesh_id"].max() >= len(meshes):
        raise _core.FileError(f"{group.name}/hits/mesh_id: must be below {len(meshes)}, the number of meshes")
    num_triangles = np.array([len(mesh.mesh.triangles) for mesh in meshes] or [0])
    if len(hits) and np.any(hits["triangle_id"] >= num_triangles[hits["mesh_id"]]):
        raise _core.FileError(f"{group.name}/hits/triangle_id: must be below the number of triangles of its mesh")


def _write_frame(group, frame) -> None:
    for name in (*FRAME_VALUES, *RECORD_SETTINGS):
        (write_seed if name == "seed" else write_attribute)(group, name, getattr(frame, name))
    for name in LATER_FRAME_VALUES:
        if getattr(frame, name) is not None:
            write_attribute(group, name, getattr(frame, name))
    write_array(group, "transmitter", frame.transmitter, unit="m")
    write_array(group, "receiver", frame.receiver, unit="m")
    for name in STATISTICS + LATER_STATISTICS:
        write_attribute(group, name, getattr(frame.statistics, name))
    write_texts(group, "stratum_name", [stratum.name for stratum in frame.strata])
    for name, (dtype, shape) in STRATUM_FIELDS.items():
        values = np.array([getattr(stratum, name) for stratum in frame.strata], dtype).reshape(-1, *shape)
        write_array(group, f"stratum_{name}", values, unit="1/sr" if name == "ray_density" else "")
    strips = [[getattr(stratum, name) for name in STRIP] for stratum in frame.strata]
    write_array(group, "stratum_strip", np.array(strips, np.float64).reshape(-1, len(STRIP)))


def _read_settings(group) -> dict[str, object]:
    """{keyword of TraceFrame: value}"""
    return {name: read_seed(group, name) if name == "seed" else read_attribute(group, name, type(default))
            for name, default in RECORD_SETTINGS.items() if name in group.attrs or name in FIRST_SETTINGS}


def _read_statistics(group):
    values = {name: read_attribute(group, name, int) for name in STATISTICS + LATER_STATISTICS
              if name in group.attrs or name in STATISTICS and name not in OLDER_NAMES}
    for name, older in OLDER_NAMES.items():
        if name not in values:
            values[name] = read_attribute(group, older if older in group.attrs else name, int)
    return _core.TraceStatistics(**values)


def _read_strata(group) -> list:
    names = read_texts(group, "stratum_name")
    columns = [read_array(group, f"stratum_{name}", dtype, (len(names), *shape)).tolist()
               for name, (dtype, shape) in STRATUM_FIELDS.items()]
    strips = read_array(group, "stratum_strip", np.float64, (len(names), len(STRIP))).tolist()
    return [_core.Stratum(name=name, **dict(zip(STRIP, strip)), **dict(zip(STRATUM_FIELDS, values)))
            for name, strip, *values in zip(names, strips, *columns)]


@blames_group
def _read_frame(group):
    strata = _read_strata(group)
    statistics = _read_statistics(group)
    values = {name: read_attribute(group, name, float) for name in FRAME_VALUES + LATER_FRAME_VALUES
              if name in group.attrs or name in FRAME_VALUES}
    return _core.TraceFrame(transmitter=read_array(group, "transmitter", np.float64, (3,)),
                            receiver=read_array(group, "receiver", np.float64, (3,)), strata=strata, statistics=statistics,
                            **values, **_read_settings(group))
