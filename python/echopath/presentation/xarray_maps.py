"""Results as xarray, with named axes and units: what their methods `to_xarray` do. Arrays are not copied."""
from __future__ import annotations

import numpy as np

from ..base.process.libraries import needed_module

AXES = {
    "time": {"units": "s", "long_name": "time, middle of the window"},
    "velocity": {"units": "m/s", "long_name": "radial velocity, receding positive"},
    "range": {"units": "m", "long_name": "range"},
    "azimuth": {"units": "rad", "long_name": "azimuth, left positive"},
    "sin_azimuth": {"units": "1", "long_name": "direction cosine along the columns of the array, left positive"},
    "sin_elevation": {"units": "1", "long_name": "direction cosine along the rows of the array, up positive"},
}
_LARGEST = 2 ** 31 - 1  # whole number in netCDF 3
_RECORD = ("offsets", "num_bounces", "diffuse", "weight", "stratum", "batch", "flags")
_HITS = ("mesh_id", "triangle_id", "u", "v")


def xarray_module():
    return needed_module("xarray", "to_xarray", extra="xarray")


def axis(name: str, values):
    """One of AXES as a coordinate of that name: (dimension, values, attributes)."""
    return name, values, AXES[name]


def words_of(variable: str, words) -> dict:
    """What the indices of a variable mean, as the coordinate VARIABLE_names: files of netCDF 3 take no list of words beside one
    variable, as an attribute would be. It is no index, so that those of other words are never joined as if they were the same."""
    return {f"{variable}_names": (f"{variable}_number", np.array(words, dtype=str))}


def index_of(variable: str) -> dict:
    """Attributes of a variable whose values are indices of `words_of`."""
    return {"long_name": f"index into {variable}_names, -1: none"}


def attributes_of(result, *names: str) -> dict:
    """Fields of a result as attributes of files: without those that are not known, large whole numbers as text."""
    values = {name: getattr(result, name) for name in names}
    return {name: str(value) if isinstance(value, int) and abs(value) > _LARGEST else value
            for name, value in values.items() if value is not None}


def range_doppler_array(map):
    """A RangeDoppler as a DataArray; see RangeDoppler.to_xarray."""
    attrs = {"units": "sqrt(W)", "long_name": "received signal", "zero_pad": map.zero_pad}
    return _array(map, "range_doppler", map.values, ("tx", "rx", "velocity", "range"), attrs)


def range_azimuth_array(map):
    """A RangeAzimuth as a DataArray; see RangeAzimuth.to_xarray."""
    attrs = {"units": "W", "long_name": "received power", "elevation": map.elevation}
    if map.velocity is not None:
        attrs["velocity"] = map.velocity
    return _array(map, "range_azimuth", map.power, ("azimuth", "range"), attrs)


def angle_spectrum_array(map):
    """An AngleSpectrum as a DataArray; see AngleSpectrum.to_xarray."""
    dims = ("sin_elevation", "sin_azimuth", "velocity", "range")
    return _array(map, "angle_spectrum", map.values, dims, {"units": "sqrt(W)", "long_name": "received signal"})


def time_map_array(map):
    """A Spectrogram, RangeTime or AngleTime as a DataArray; see their to_xarray."""
    coords = {"time": axis("time", map.times), map.AXIS: axis(map.AXIS, map.axis)}
    attrs = {"units": "W", "long_name": "received power", "noise_power": map.noise_power}
    return xarray_module().DataArray(map.power, dims=("time", map.AXIS), name=type(map).__name__, coords=coords, attrs=attrs)


def spectrogram_labels_dataset(labels):
    """SpectrogramLabels as a Dataset; see SpectrogramLabels.to_xarray."""
    cells = {"whole": {"units": "W"}, "mask": {}, "above_noise": {}, "dominant": index_of("dominant")}
    variables = {name: (("time", "velocity"), getattr(labels, name), attrs) for name, attrs in cells.items()}
    for name, unit in (("power", "W"), ("share", "1")):
        variables[name] = ("part", "time", "velocity"), getattr(labels, name), {"units": unit}
    coords = {"part": np.array(labels.part_names, dtype=str), "time": axis("time", labels.times),
              "velocity": axis("velocity", labels.velocity)}
    coords |= words_of("dominant", labels.part_names)
    attrs = attributes_of(labels, "noise_power", "noise_margin_db", "dynamic_range_db")
    return xarray_module().Dataset(variables, coords=coords, attrs=attrs)


def paths_dataset(paths):
    """Paths as a Dataset; see Paths.to_xarray."""
    variables = {name: ("path", getattr(paths, name)) for name in _RECORD}
    variables |= {name: ("hit", getattr(paths, name)) for name in _HITS}
    length = paths.lengths([paths.frame.trace_time])[0]
    variables["length"] = "path", length, {"units": "m", "long_name": "at the trace time, between the first antennas"}
    variables["power"] = "path", paths.power, {"units": "W", "long_name": "at the trace time, between the first antennas"}
    attrs = {"mesh_names": [mesh.name for mesh in paths.scene.meshes], "trace_time": paths.frame.trace_time,
             "start_time": paths.frame.start_time, "seed": paths.frame.seed}
    return xarray_module().Dataset(variables, attrs=attrs)


def _array(map, name: str, values, dims: tuple, attrs: dict):
    coords = {dim: axis(dim, np.asarray(getattr(map, dim))) for dim in dims if dim in AXES}
    return xarray_module().DataArray(values, dims=dims, name=name, coords=coords, attrs=attrs)
