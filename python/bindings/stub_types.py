"""Types that pybind11 does not know of: what properties and methods of the extension return, by their class."""
from __future__ import annotations

import re

REAL = "numpy.typing.NDArray[numpy.float64]"
COMPLEX = "numpy.typing.NDArray[numpy.complex128]"
INDEX = "numpy.typing.NDArray[numpy.int64]"
WINDOW = "str | tuple[str, float] | tuple[str | tuple[str, float], str | tuple[str, float]]"
PAIR = "tuple[float, float]"
PATH = "str | os.PathLike[str]"
REPLAY = "Literal['material', 'fermat']"
INTERPOLATION = "Literal['cubic', 'linear', 'monotone']"
AXES = {"ax": "Axes | None"}
LEVELS = AXES | {"vmin": "float | None", "vmax": "float | None"}

# (class, member) -> what it returns
RETURNS = {
    ("Motion", "span"): PAIR, ("Deformation", "span"): PAIR,
    ("SceneMesh", "triangles"): "numpy.typing.NDArray[numpy.uint32]",
    ("CoplanarOverlap", "names"): "tuple[str, str]", ("CoplanarOverlap", "mesh_ids"): "tuple[int, int]",
    ("Scene", "__copy__"): "Scene", ("Scene", "__deepcopy__"): "Scene",
    ("Scene", "__iter__"): "collections.abc.Iterator[str]",
    ("Node", "replace"): "Node", ("Antenna", "replace"): "Antenna", ("Radar", "replace"): "Radar",
    ("Joint", "inverse_bind"): f"{REAL} | None", ("Skin", "parts"): "list[tuple[str, Mesh]]",
    ("AntennaPattern", "azimuth"): f"{REAL} | None", ("AntennaPattern", "elevation"): f"{REAL} | None",
    ("AntennaPattern", "table_gain"): f"{REAL} | None", ("AntennaPattern", "table_phase"): f"{REAL} | None",
    ("Curve", "in_tangents"): f"{REAL} | None", ("Curve", "out_tangents"): f"{REAL} | None",
    ("CurveMotion", "period"): "float | None", ("MorphTargets", "period"): "float | None",
    ("VertexSequence", "period"): "float | None",
    **{("ChirpSequence", name): "tuple[float, ...]" for name in ("extra_idle", "frequency_steps", "bandwidth_steps")},
    ("Radar", "motion"): "Motion | None", ("Radar", "receiver"): "Receiver | None",
    ("Radar", "code_phases"): f"{REAL} | None", ("Radar", "_repr_html_"): "str",
    ("RangeDoppler", "values"): COMPLEX, ("RangeDoppler", "window"): WINDOW, ("RangeDoppler", "_repr_html_"): "str",
    ("VirtualArray", "default_angles"): f"tuple[{REAL}, {REAL}]", ("VirtualArray", "positions"): REAL,
    ("VirtualArray", "element_of_channel"): INDEX, ("VirtualArray", "elements"): REAL, ("VirtualArray", "gaps"): INDEX,
    ("VirtualArray", "grid_axes"): f"{REAL} | None", ("VirtualArray", "grid_deviation"): "float | None",
    ("VirtualArray", "grid_index"): f"{INDEX} | None", ("VirtualArray", "grid_shape"): "tuple[int, int] | None",
    ("VirtualArray", "grid_spacing"): f"{PAIR} | None",
    ("Paths", "load"): "Paths", ("Paths", "save"): "LeftOut", ("Paths", "_repr_html_"): "str",
    ("Paths", "amplitudes"): COMPLEX, ("Paths", "lengths"): REAL,
    ("Paths", "partition"): "dict[str, Paths]", ("Paths", "points"): REAL, ("Paths", "amplitude"): COMPLEX,
    ("Paths", "curved_cell"): "numpy.typing.NDArray[numpy.float32]", ("Paths", "effects"): "list[Effect]",
    ("Material", "layers"): "tuple[Layer, ...]", ("Paths", "passes"): "numpy.typing.NDArray[numpy.void]",
    ("Paths", "hits"): "numpy.typing.NDArray[numpy.void]", ("Paths", "jones"): "numpy.typing.NDArray[numpy.complex64]",
    ("Paths", "power"): REAL,
    ("Validity", "_repr_html_"): "str", ("Validity", "objects"): "dict[str, ObjectValidity]",
    ("Family", "via"): "tuple[str, ...]",
    **{(map, "plot"): "Axes" for map in ("RangeDoppler", "RangeAzimuth", "AngleSpectrum")},
    **{(map, "to_xarray"): "DataArray" for map in ("RangeDoppler", "RangeAzimuth", "AngleSpectrum")},
    ("Paths", "to_xarray"): "Dataset", ("Paths", "to_dataframe"): "DataFrame",
    ("SignalProbe", "share_field"): COMPLEX, ("SignalProbe", "share_power"): REAL,
}
IMPORTS = ("from echopath.base.classes.foreign_types import Axes, DataArray, DataFrame, Dataset\n"
           "from echopath.effects.rules import Effect\nfrom echopath.frame_file.frame import LeftOut\n"
           "from echopath.receiver import Receiver\nfrom typing import Literal\n")

# (class, member) -> {argument: what it takes}
TAKES = {
    ("Mesh", "part"): {"triangles": "ArrayLike"}, ("Scene", "__contains__"): {"name": "object"},
    ("Scene", "__getitem__"): {"name": "str"}, ("Scene", "__deepcopy__"): {"memo": "dict[int, object]"},
    ("Power", "__ne__"): {"arg0": "object"},
    ("Paths", "load"): {"path": PATH}, ("Paths", "save"): {"path": PATH},
    ("Paths", "amplitudes"): {"replay": REPLAY}, ("Paths", "lengths"): {"replay": REPLAY},
    ("KeyframeMotion", "__init__"): {"interpolation": INTERPOLATION},
    ("VertexSequence", "__init__"): {"interpolation": INTERPOLATION},
    ("Radar", "__init__"): {"multiplexing": "Literal['tdm', 'bpm', 'ddm', 'cdm']", "receiver": "Receiver | None"},
    ("RangeDoppler", "plot"): LEVELS, ("RangeAzimuth", "plot"): LEVELS,
    ("AngleSpectrum", "plot"): AXES | {"range": "float | None", "velocity": "float | None"},
}
_CLASS = re.compile(r"^class (\w+)(\(\w+\))?:")
_FUNCTION = re.compile(r"^(    def (\w+)\(.*\) -> )(.*)(:(?:  # .*)?)$")


def with_known_types(text: str) -> str:
    """The stubs with the types above, and with the arguments of its constructor at each `replace`."""
    lines, name, base, given = [], "", None, {}
    for line in text.split("\n"):
        if found := _CLASS.match(line):
            name, base = found.groups()
        if base:
            line = line.replace("] = None  # type: ignore[assignment]", "] = None")
        if found := _FUNCTION.match(line):
            begin, member, returned, end = found.groups()
            for argument, kind in TAKES.get((name, member), {}).items():
                line = re.sub(rf"\b{argument}: ([\w.]+\[[^\]]*\]|[^=,)\[]*)(?=( =|,|\)))", f"{argument}: {kind}", line, count=1)
            begin = line[:line.rindex(") -> ") + 5]
            if member == "__init__":
                given[name] = _changes(line)
            line = begin + RETURNS.get((name, member), returned) + end
            if member == "replace" and given.get(name):
                line = line.replace("(self, **kwargs: typing.Any)", f"(self, *, {given[name]})")
        lines.append(line)
    return "\n".join(lines)


def _changes(init: str) -> str:
    """The parameters of a constructor as those of `replace`: by name, and none must be given."""
    inside = init[init.index("(self") + 5:init.rindex(") -> None")].removeprefix(", ").replace("*, ", "")
    return ", ".join(re.sub(r" = .*", "", one) + " = ..." for one in _split(inside)) if inside else ""


def _split(parameters: str) -> list[str]:
    """At the commas between parameters, not at those within brackets."""
    parts, depth = [""], 0
    for letter in parameters:
        depth += (letter in "([") - (letter in ")]")
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return [part.strip() for part in parts]
