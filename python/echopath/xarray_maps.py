"""Maps as xarray, with named axes and units; comes with `pip install xarray`."""
from __future__ import annotations

from . import _core


def to_xarray(map):
    """A map as xarray with named axes; its arrays are not copied.

    map: RangeDoppler, a DataArray: complex values in sqrt(W), axes tx, rx, velocity (m/s, receding positive) and range (m);
        RangeAzimuth, a DataArray: power in W, axes azimuth (rad, left positive) and range (m); attributes elevation (rad, of
        the beams) and velocity (m/s, of the cells, where only some were taken)
        Labels, a Dataset: power (W) and share by part, velocity (m/s) or azimuth (rad), and range (m); whole (W), mask,
        dominant, object and ghost by cell, the last three indices of `attrs["names"]`, -1: none; errors where they are known
    Units stand in `attrs["units"]` of values and coordinates. `map.to_xarray()` is the same. Raises TypeError for what is no
    map, ModuleNotFoundError without xarray.
    """
    for kind, convert in CONVERTERS.items():
        if isinstance(map, kind):
            return convert(map, _xarray())
    raise TypeError(f"map: must be one of {', '.join(kind.__name__ for kind in CONVERTERS)}, got {type(map).__name__}")


def _xarray():
    try:
        import xarray
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] != "xarray":
            raise
        text = "to_xarray needs xarray, which is not installed: pip install xarray"
        raise ModuleNotFoundError(text, name="xarray") from None
    return xarray


AXES = {
    "velocity": {"units": "m/s", "long_name": "radial velocity, receding positive"},
    "range": {"units": "m", "long_name": "range"},
    "azimuth": {"units": "rad", "long_name": "azimuth, left positive"},
}


def axis(name: str, values):
    """One of AXES as a coordinate of that name: (dimension, values, attributes)."""
    return name, values, AXES[name]


def _range_doppler(map, xarray):
    return xarray.DataArray(map.values, dims=("tx", "rx", "velocity", "range"), name="range_doppler",
                            coords={"velocity": axis("velocity", map.velocity), "range": axis("range", map.range)},
                            attrs={"units": "sqrt(W)", "long_name": "received signal", "zero_pad": map.zero_pad})


def _range_azimuth(map, xarray):
    attrs = {"units": "W", "long_name": "received power", "elevation": map.elevation}
    if map.velocity is not None:
        attrs["velocity"] = map.velocity
    return xarray.DataArray(map.power, dims=("azimuth", "range"), name="range_azimuth",
                            coords={"azimuth": axis("azimuth", map.azimuth), "range": axis("range", map.range)},
                            attrs=attrs)


# {class: function (map, xarray module)}; modules with maps of their own add theirs.
CONVERTERS = {_core.RangeDoppler: _range_doppler, _core.RangeAzimuth: _range_azimuth}

# The core knows no xarray: its maps get this method here.
for _kind in tuple(CONVERTERS):
    _kind.to_xarray = to_xarray
