"""Wrong values into each argument of the classes of the extension: each is refused by name, and none ends the process."""
import atexit
import decimal
import fractions
import shutil
import tempfile
from pathlib import Path

import numpy as np
import pytest

import echopath as ep


class Broken:
    """An object all of whose conversions fail."""

    def __float__(self):
        raise ZeroDivisionError("no float")

    __index__ = __int__ = __len__ = __iter__ = __bool__ = __repr__ = __array__ = __fspath__ = __float__


class LongText(str):
    pass


class Fifth(int):
    def __repr__(self):
        raise ZeroDivisionError("no repr")


NAN, INF = float("nan"), float("inf")
SCALARS = [None, True, False, 0, 1, 5, -1, 2**31, 2**32, 2**63, -(2**63), 10**40, 10**5000, 0.0, -0.0, 0.5, -0.5, 1e-320, 1e10,
           1e18, 1e300, -1e300, NAN, INF, -INF, 1j, complex(NAN, 1), decimal.Decimal("0.5"), fractions.Fraction(1, 3), Fifth(5),
           np.int8(-3), np.uint64(2**64 - 1), np.float16(0.5), np.float32(NAN), np.longdouble(2), np.bool_(True),
           np.complex64(1j), np.str_("a"), np.datetime64("2026-01-01"), np.timedelta64(3, "s"), np.array(5), np.array(NAN),
           np.array("a"), np.array(None)]
TEXTS = ["", "a", "cubic", "5", "\udc80", "a\0b", "a/b", "é" * 300, LongText("linear"), b"cubic", bytearray(b"a"),
         memoryview(b"abc")]
CONTAINERS = [[], (), {}, set(), [NAN], [1], [1, 2], [1, 2, 3], (1.0, NAN, 3.0), (1, INF, 3), [1, 2, 3, 4], [1, 0, 0, 0],
              [0, 0, 0, 0], [[1, 2, 3]], [[1, 2], [3]], [[]], [[[]]], [None] * 3, ["a", "b", "c"], ["\udc80"], [1, "a", None],
              [1j, 2, 3], [True, False, True], {"a": 1}, {1, 2, 3}, range(3), range(-1, 2), iter([1, 2, 3]), [10**40, 0, 0],
              [1e300, 1e300, 1e300], [[0, 1, 2**40]], [[0, 1, -1]], [[0, 1, 2.5]], [[0, 1, 99]], [[1, 0, 0, 0]] * 2,
              np.zeros(0), np.zeros((0, 3)), np.zeros((3, 0)), np.zeros(3), np.ones((2, 2)), np.ones((2, 3)), np.ones((4, 4)),
              np.eye(4), np.diag([NAN, 1, 1, 1]), np.full((2, 3), NAN), np.full((4, 3), INF), np.zeros((2, 2, 2, 2)),
              np.full((2, 2, 3), NAN), np.array(["a", "b"]), np.array([None, 1]), np.array([1 + 1j, 2]), np.arange(3, dtype="u1"),
              np.array(["2026-01-01"], "M8[D]"), np.zeros(2, [("x", float)]), np.ma.masked_array([1.0, 2.0], [True, False]),
              np.arange(6, dtype=">f4").reshape(2, 3)[:, ::-1]]
OBJECTS = [object(), Broken(), int, Ellipsis, NotImplemented, slice(3), len, lambda: 1, ep, ep.Mesh, ep.Material.metal(),
           ep.LinearMotion(), ep.ChirpSequence(), ep.Isotropic(), ep.Scene(), ep.Joint("a"), [ep.Joint("a"), 5],
           [ep.Joint("a"), ep.Joint("a")], [ep.Joint("a", "b")], [None]]
WRONG = SCALARS + TEXTS + CONTAINERS + OBJECTS

CORNERS, TRIANGLES = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2], [0, 1, 3]]
MESH = ep.Mesh(CORNERS, TRIANGLES)
KEYS = ep.KeyframeMotion([0, 1, 2], [[0, 0, 0], [1, 0, 0], [2, 0, 0]])
SEQUENCE = ep.VertexSequence([0, 1], [CORNERS, CORNERS])
PLACES = ep.Curve([0, 1], [[0, 0, 0], [1, 0, 0]])
SHARES = ep.Curve([0, 1], [[0], [1]])
SKIN = ep.Skin(CORNERS, [ep.Joint("a"), ep.Joint("b", "a")], [[0.5, 0.5]] * 4)
RADAR = ep.Radar(ep.ChirpSequence(num_samples=16, num_chirps=4), transmitters=[ep.Antenna()], receivers=[ep.Antenna()])
PLATE = ep.Scene()
PLATE.add(ep.Mesh([[5, -1, -1], [5, 1, -1], [5, 1, 1], [5, -1, 1]], [[0, 2, 1], [0, 3, 2]]), name="plate",
          material=ep.Material.metal())
PATHS = ep.trace(PLATE, RADAR, num_rays=1000)
FOLDER = Path(tempfile.mkdtemp())
atexit.register(shutil.rmtree, FOLDER)
PATHS.save(FOLDER / "frame.h5")
NODE = {"name": "a", "parent": -1, "placement": np.eye(4), "motion": None, "mesh": MESH, "deformation": None,
        "material": ep.Material.metal(), "material_name": "", "smooth": False, "visible": True}
STRATUM = {"axis": [1, 0, 0], "versine": 2.0, "num_rays": 5, "ray_density": 1.0, "name": "a", "across": [0, 0, 0],
           "half_azimuth": 0.0, "low": 0.0, "high": 0.0, "object": -1, "num_mirrors": 0, "focus_of": -1}
FRAME = {"start_time": 0.0, "trace_time": 0.0, "transmitter": [0, 0, 0], "receiver": [0, 0, 0], "strata": [], "seed": 1,
         "max_bounces": 4, "polarization": "scalar", "footprint": "none", "statistics": ep.TraceStatistics(),
         "num_batches": 1, "target_error_db": 0.0, "error_db": 0.0, "sampler": "lattice"}
# name -> (what is called, arguments that are right)
CALLS = {
    "ChirpSequence": (ep.ChirpSequence, {"start_frequency": 77e9, "bandwidth": 1e9, "num_samples": 64, "sampling_rate": 20e6,
                                         "num_chirps": 4, "chirp_interval": 60e-6, "real": False}),
    "velocity_resolution": (ep.ChirpSequence().velocity_resolution, {"num_slots": 2}),
    "max_velocity": (ep.ChirpSequence().max_velocity, {"num_slots": 2}),
    "Isotropic": (ep.Isotropic, {"gain": 1.0}),
    "CosinePower": (ep.CosinePower, {"exponent": 2.0, "peak_gain": 3.0}),
    "GainTable": (ep.GainTable, {"azimuth": [-1.0, 1.0], "elevation": [-0.5, 0.5], "gain": np.ones((2, 2)),
                                 "phase": np.zeros((2, 2)), "normalize": False}),
    "GaussianBeam": (ep.GaussianBeam, {"azimuth": 1.0, "elevation": 0.2, "peak_gain": 0.5}),
    "gain": (ep.CosinePower(2.0).gain, {"cos_boresight": 0.5}),
    "field": (ep.CosinePower(2.0).field, {"directions": [[1.0, 0.0, 0.0]]}),
    "conductor": (ep.Material, {"conductor": True, "mirror": False}),
    "permittivity": (ep.Material, {"permittivity": 4 - 1j, "conductivity": 0.1, "roughness_height": 1e-3,
                                   "cross_polarization": 0.1}),
    "reflectivity": (ep.Material, {"reflectivity": 0.5, "scattering": 0.5}),
    "lobe": (ep.Material, {"reflectivity": 0.5, "lobe_exponent": 4, "backscatter_share": 0.5, "backscatter_exponent": 3}),
    "backscatter": (ep.Material(reflectivity=0.5).backscatter, {"grazing": [0.1], "frequency": 77e9}),
    "metal": (ep.Material.metal, {"mirror": True}),
    "LinearMotion": (ep.LinearMotion, {"velocity": (1, 2, 3), "angular_velocity": (0, 0, 1)}),
    "KeyframeMotion": (ep.KeyframeMotion, {"times": [0, 1], "translations": [[0, 0, 0], [1, 0, 0]],
                                           "rotations": [[1, 0, 0, 0], [1, 0, 0, 0]], "interpolation": "cubic"}),
    "VertexSequence": (ep.VertexSequence, {"times": [0, 1], "vertices": [CORNERS, CORNERS], "interpolation": "linear",
                                            "period": 1.0, "offset": 0.5}),
    "Curve": (ep.Curve, {"times": [0, 1], "values": [[0], [1]], "interpolation": "hermite", "in_tangents": [[0], [1]],
                         "out_tangents": [[0], [1]]}),
    "Curve at": (PLACES.at, {"time": 0.5}),
    "CurveMotion": (ep.CurveMotion, {"translation": PLACES, "rotation": ep.Curve([0], [[1, 0, 0, 0]]), "scale": PLACES,
                                     "period": 1.0, "offset": 0.5}),
    "MorphTargets": (ep.MorphTargets, {"vertices": CORNERS, "targets": [CORNERS], "weights": SHARES, "period": 1.0,
                                       "offset": 0.5}),
    "motion at": (KEYS.at, {"time": 0.5}),
    "motion turn_rate": (KEYS.turn_rate, {"begin": 0.0, "end": 1.0}),
    "deformation at": (SEQUENCE.at, {"time": 0.5}),
    "deformation turn_rate": (SEQUENCE.turn_rate, {"begin": 0.0, "end": 1.0}),
    "Joint": (ep.Joint, {"name": "a", "parent": "b", "position": (1, 2, 3), "motion": None, "inverse_bind": np.eye(4)}),
    "Joint transform": (ep.Joint, {"name": "a", "transform": np.eye(4)}),
    "Skin": (ep.Skin, {"vertices": CORNERS, "joints": [ep.Joint("a")], "weights": np.ones((4, 1)),
                       "joint_indices": np.zeros((4, 1), int), "shape": SEQUENCE}),
    "joint_transforms": (SKIN.joint_transforms, {"time": 0.5}),
    "parts": (SKIN.parts, {"mesh": MESH}),
    "Mesh": (ep.Mesh, {"vertices": CORNERS, "triangles": TRIANGLES, "original_triangle": [7, 8]}),
    "part": (MESH.part, {"triangles": [0]}),
    "amplitudes": (PATHS.amplitudes, {"times": [0.0], "tx": 0, "rx": 0, "replay": "material"}),
    "lengths": (PATHS.lengths, {"times": [0.0], "transmitter": 0, "receiver": [0, 0, 0], "replay": "fermat"}),
    "points": (PATHS.points, {"time": 0.0}),
    "select": (PATHS.select, {"selection": np.ones(PATHS.num_paths, bool)}),
    "partition": (PATHS.partition, {"parts": {"a": "T . R"}}),
    "from_arrays": (ep.Paths.from_arrays, {name: getattr(PATHS, name) for name in (
        "hits", "offsets", "num_bounces", "diffuse", "weight", "stratum", "batch", "flags", "jones", "scene", "radar", "frame")}),
    "save": (PATHS.save, {"path": FOLDER / "frame.h5", "min_power": 0.0}),
    "load": (ep.Paths.load, {"path": FOLDER / "frame.h5"}),
    "matches": (ep.Selection("T . R").matches, {"paths": PATHS}),
    "check": (ep.Selection("T . R").check, {"scene": PLATE}),
    "Family": (ep.Family, {"object": "a", "ghost_type": 1, "order": 2, "via": ["b"]}),
    "SignalProbe": (ep.SignalProbe, {"seed": 1}),
    "Stratum": (type(PATHS.frame.strata[0]), STRATUM),
    "TraceStatistics": (ep.TraceStatistics, {"num_rays": 1, "num_unaimed": 2}),
    "TraceFrame": (type(PATHS.frame), FRAME),
    "Node": (type(PLATE.nodes[0]), NODE),
    "Node.replace": (PLATE.nodes[0].replace, NODE),
}
# Where two arguments do not fit each other, the message may name the other one and say what of this one it lacks.
FAULT_OF = {("Skin", "vertices"): "weights: must have a row for each vertex",
            ("Curve", "times"): "values: must have ", ("Curve", "interpolation"): "in_tangents: must be given for 'hermite'",
            ("MorphTargets", "vertices"): "targets: must have a displacement",
            ("MorphTargets", "targets"): "weights: must have a row",
            ("select", "selection"): "path expression: expected",  # and a caret under the fault
            ("amplitudes", "times"): "time: must lie in", ("lengths", "times"): "time: must lie in"}
ARGUMENTS = [(call, argument) for call, (_, right) in CALLS.items() for argument in right]


def test_there_are_thousands_of_them():
    assert len(ARGUMENTS) * len(WRONG) > 6000


@pytest.mark.parametrize("call, argument", ARGUMENTS)
def test_wrong_values_are_refused_by_name(call, argument, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # some of them are names of files
    function, right = CALLS[call]
    function(**right)
    refused = 0
    for wrong in WRONG:
        try:
            made = function(**right | {argument: wrong})
        except (TypeError, ValueError, IndexError, ep.FileError) as error:
            text = str(error).split("\n")[0]  # a caret under a path expression stands below
            names = argument, FAULT_OF.get((call, argument), argument)
            of_file = isinstance(error, ep.FileError) and str(wrong) in text
            assert of_file or any(name in text for name in names) and "got" in text, f"{type(wrong).__name__}: {text}"
            assert "incompatible" not in text and len(text) < 400 and text.isprintable(), text
            refused += 1
        else:
            _assert_reads_back(made, argument, wrong)
    assert refused > 60


def _assert_reads_back(made, argument, given) -> None:
    """What was accepted is what is there: no number is cut or wrapped on its way in."""
    kept = getattr(made, argument, None)
    if isinstance(given, (int, float, np.number)) and isinstance(kept, (int, float)):
        assert kept == (float(given) if isinstance(kept, float) else given) or kept != kept and given != given


CALL_FAULTS = [(call, *fault) for call in CALLS for fault in [
    ({"nonsense": 1}, "unknown keyword 'nonsense'; its arguments are"),
    ({"non\udcffsense": 1}, r"unknown keyword 'non\\udcffsense'; its arguments are"),
]]


@pytest.mark.parametrize("call, more, message", CALL_FAULTS)
def test_unknown_keywords_unlike_any_get_the_list(call, more, message):
    function, right = CALLS[call]
    with pytest.raises(TypeError, match=message):
        function(**right, **more)


@pytest.mark.parametrize("call", CALLS)
def test_calls_that_do_not_fit_say_why(call):
    function, right = CALLS[call]
    with pytest.raises(TypeError, match="takes (no|at most|.* without)"):
        function(*right.values(), 1, 2, 3, 4, 5, 6, 7, 8)
    name, value = next(iter(right.items()))
    try:
        function(value, **right)
    except TypeError as error:
        assert f"argument '{name}' is given twice" in str(error) or "without their names" in str(error)


@pytest.mark.parametrize("call, missing", [
    (ep.Mesh, "vertices"), (lambda: ep.Mesh(CORNERS), "triangles"), (ep.Skin, "vertices"), (ep.Joint, "name"),
    (ep.CosinePower, "exponent"), (ep.GainTable, "azimuth"), (ep.KeyframeMotion, "times"), (ep.VertexSequence, "times"),
    (ep.Curve, "times"), (ep.MorphTargets, "vertices"), (KEYS.at, "time"), (MESH.part, "triangles"),
])
def test_missing_arguments_are_named(call, missing):
    with pytest.raises(TypeError, match=f"argument '{missing}' is missing"):
        call()


def test_whole_floats_are_taken_where_a_count_is_meant():
    assert ep.ChirpSequence(num_samples=128.0, num_chirps=np.float32(16)).num_samples == 128
    with pytest.raises(ValueError, match="^num_samples: must be a whole number from 1 to 2147483647, got 0.5$"):
        ep.ChirpSequence(num_samples=0.5)


def test_signatures_show_plain_types():
    for described in (ep.ChirpSequence.__init__, ep.Mesh.__init__, ep.Joint.__init__, ep.Material.__init__, ep.GainTable):
        text = described.__doc__
        assert "Overloaded" not in text and "kwargs" not in text and "typing." not in text and "Arg<" not in text
    assert "num_samples: int = 512" in ep.ChirpSequence.__init__.__doc__
    assert "vertices: ArrayLike, triangles: ArrayLike, original_triangle: ArrayLike | None = None" in ep.Mesh.__init__.__doc__


def test_meshes_refuse_vertices_that_are_not_finite():
    with pytest.raises(ValueError, match="^vertices: vertex 2 must be finite .*, got +0 nan +0$"):
        ep.Mesh([[0, 0, 0], [1, 0, 0], [0, NAN, 0], [0, 1, 0]], [[0, 1, 3], [0, 1, 2]])


def test_tables_of_pandas_are_shown_in_one_line():
    pandas = pytest.importorskip("pandas")
    for value in (pandas.Series([1.0, 2.0, 3.0]), pandas.Categorical(["a", "b"])):
        with pytest.raises(TypeError, match=rf"^num_samples: must be .*, got {type(value).__name__}$"):
            ep.ChirpSequence(num_samples=value)
