"""Values of the extension: equal where their arguments are equal, and the same bits after pickle, deepcopy and replace."""
import copy
import multiprocessing
import pickle

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from hypothesis.extra.numpy import arrays

import echopath as ep

numbers = st.floats(-1e5, 1e5)  # m: what moves from key to key stays below the speed of light
vectors = arrays(np.float64, 3, elements=numbers)
positive = st.floats(1e-9, 1e9)


@st.composite
def times(draw, count):
    return draw(st.floats(-10, 10)) + np.cumsum(draw(arrays(np.float64, count, elements=st.floats(0.01, 1.0))))


@st.composite
def quaternions(draw, count):
    rows = draw(arrays(np.float64, (count, 4), elements=st.floats(-1, 1))) + [3.0, 0.0, 0.0, 0.0]
    return rows / np.linalg.norm(rows, axis=1)[:, None]


@st.composite
def waveforms(draw):
    num_samples, sampling_rate = draw(st.integers(1, 4096)), draw(st.floats(1e5, 1e8))
    return ep.ChirpSequence(start_frequency=draw(st.floats(1e9, 3e11)), bandwidth=draw(st.floats(1e6, 5e9)),
                            num_samples=num_samples, sampling_rate=sampling_rate, num_chirps=draw(st.integers(1, 4096)),
                            chirp_interval=1.001 * num_samples / sampling_rate, real=draw(st.booleans()))


@st.composite
def tables(draw):
    rows, columns = draw(st.integers(2, 5)), draw(st.integers(2, 5))
    grid = (rows, columns)
    return ep.GainTable(azimuth=np.linspace(-1, 1, columns), elevation=np.linspace(-0.5, 0.5, rows),
                        gain=draw(arrays(np.float64, grid, elements=st.floats(0.01, 2.0))),
                        phase=draw(st.none() | arrays(np.float64, grid, elements=st.floats(-3.0, 3.0))),
                        normalize=draw(st.booleans()))


gains = st.floats(1e-9, 1.0)
patterns = st.one_of(st.builds(ep.Isotropic, gains), st.builds(ep.CosinePower, st.floats(0, 100), st.none() | gains),
                     tables())
materials = st.one_of(
    st.builds(ep.Material.metal, mirror=st.booleans()),
    st.builds(ep.Material, permittivity=st.builds(complex, st.floats(1, 90), st.floats(-40, 0)),
              conductivity=st.floats(0, 100), roughness_height=st.floats(0, 0.1),
              cross_polarization=st.floats(0, 0.5)),
    st.builds(ep.Material, reflectivity=st.floats(0, 1), scattering=st.floats(0, 1)),
    st.builds(ep.Material, reflectivity=st.floats(0, 1), lobe_exponent=st.integers(1, 100),
              backscatter_share=st.floats(0.01, 1), backscatter_exponent=st.integers(0, 100)))
linear_motions = st.builds(ep.LinearMotion, vectors, vectors)
interpolations = st.sampled_from(["cubic", "linear", "monotone"])


@st.composite
def keyframes(draw):
    count = draw(st.integers(2, 6))
    given = draw(st.sampled_from([(True, True), (True, False), (False, True)]))
    return ep.KeyframeMotion(draw(times(count)),
                             draw(arrays(np.float64, (count, 3), elements=numbers)) if given[0] else None,
                             draw(quaternions(count)) if given[1] else None, draw(interpolations))


@st.composite
def sequences(draw):
    shape = draw(st.integers(2, 5)), draw(st.integers(1, 4)), 3
    frames, keys = draw(arrays(np.float64, shape, elements=numbers)), draw(times(shape[0]))
    if draw(st.booleans()):
        return ep.VertexSequence(keys, frames, draw(interpolations))
    keys = np.asarray(keys) - keys[0]
    return ep.VertexSequence(keys, frames, draw(interpolations), period=keys[-1], offset=draw(st.floats(-10, 10)))


@st.composite
def curves(draw, columns: int = 3):
    count, kind = draw(st.integers(1, 5)), draw(st.sampled_from(["step", "linear", "hermite"]))
    rows = arrays(np.float64, (count, columns), elements=numbers)
    tangents = {"in_tangents": draw(rows), "out_tangents": draw(rows)} if kind == "hermite" else {}
    return ep.Curve(draw(times(count)), draw(rows), kind, **tangents)


clocks = st.fixed_dictionaries({"period": st.none() | st.floats(1e-3, 10), "offset": st.floats(-10, 10)})


@st.composite
def curve_motions(draw):
    turning = ep.Curve([0.0, 1.0], draw(quaternions(2)), "step")
    return ep.CurveMotion(draw(curves()), draw(st.none() | st.just(turning)), draw(st.none() | curves()), **draw(clocks))


@st.composite
def morphs(draw, count: int = 0):
    shape = draw(st.integers(1, 3)), count or draw(st.integers(1, 4)), 3
    points = arrays(np.float64, shape, elements=numbers)
    return ep.MorphTargets(draw(points)[0], draw(points), draw(curves(shape[0])), **draw(clocks))


@st.composite
def skins(draw):
    count, num_joints = draw(st.integers(1, 6)), draw(st.integers(1, 3))
    joints = [ep.Joint(f"joint {k}", f"joint {k - 1}" if k else None, position=draw(vectors),
                       motion=draw(st.none() | linear_motions | curve_motions())) for k in range(num_joints)]
    weights = draw(arrays(np.float64, (count, num_joints), elements=st.floats(0.1, 1.0)))
    return ep.Skin(draw(arrays(np.float64, (count, 3), elements=numbers)), joints,
                   weights / weights.sum(axis=1)[:, None], shape=draw(st.none() | morphs(count)))


@st.composite
def meshes(draw):
    """Any triangles between a few points: non-manifold edges, faces without an area and unused vertices come with it."""
    count = draw(st.integers(1, 12))
    vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [2, 0, 0], [9, 9, 9]]
    triangles = np.array([[0, 1, 2], *draw(arrays(np.uint32, (count, 3), elements=st.integers(0, 5)))])
    original = draw(st.none() | arrays(np.uint32, count + 1))
    mesh = ep.Mesh(vertices, triangles, original)
    return mesh.part(draw(st.integers(1, len(mesh.triangles))) - 1 + np.zeros(1, int)) if draw(st.booleans()) else mesh


KINDS = {"ChirpSequence": waveforms(), "pattern": patterns, "Material": materials, "LinearMotion": linear_motions,
         "KeyframeMotion": keyframes(), "VertexSequence": sequences(), "Skin": skins(),
         "Curve": curves(), "CurveMotion": curve_motions(), "MorphTargets": morphs(), "Mesh": meshes(),
         "Joint": skins().map(lambda skin: skin.joints[-1])}
# All that can be read of them.
READ = """start_frequency bandwidth num_samples sampling_rate num_chirps chirp_interval real slope kind peak_gain exponent
    table_gain table_phase azimuth elevation efficiency conductor permittivity conductivity reflectivity roughness_height
    scattering cross_polarization mirror lobe_exponent backscatter_share backscatter_exponent
    velocity angular_velocity times translations rotations vertices interpolation
    breakpoints span num_vertices name parent transform motion inverse_bind joints weights joint_indices shape targets values
    in_tangents out_tangents translation rotation scale period offset triangles
    original_triangle original_vertex num_input_vertices num_removed_triangles num_duplicated_vertices is_closed area whole
    whole_triangle""".split()


def read(value) -> dict:
    return {name: getattr(value, name) for name in READ if hasattr(value, name)}


def bits(value) -> str:
    """All that can be read of a value, arrays as bytes."""
    if isinstance(value, np.ndarray):
        return f"{value.dtype} {value.shape} {value.tobytes().hex()}"
    if isinstance(value, list):
        return str([bits(item) for item in value])
    if not type(value).__module__.startswith("echopath"):
        return repr(value)
    return repr(value) + str({name: bits(item) for name, item in read(value).items()})


def reads_alike(one, other) -> bool:
    one, other = read(one), read(other)
    return one.keys() == other.keys() and all(np.array_equal(one[name], other[name]) if isinstance(one[name], np.ndarray)
                                              else one[name] == other[name] for name in one)


@pytest.mark.parametrize("kind", KINDS)
def test_round_trips_keep_equality_and_bits(kind):
    @settings(max_examples=15, deadline=None, derandomize=True)
    @given(KINDS[kind])
    def law(value):
        trips = [pickle.loads(pickle.dumps(value, protocol)) for protocol in (2, 5)]
        for other in (*trips, copy.copy(value), copy.deepcopy(value)):
            assert other is not value and type(other) is type(value)
            assert other == value and not other != value and hash(other) == hash(value)
            assert bits(other) == bits(value)

    law()


class Paint(ep.Material):
    """A material of a user's own, whose constructor takes something else."""

    def __init__(self, colour: str, coats: list[str]) -> None:
        super().__init__(permittivity=3.0)
        self.colour, self.coats = colour, coats


def test_objects_of_derived_classes_keep_what_is_their_own():
    paint = Paint("red", ["primer"])
    trips = [pickle.loads(pickle.dumps(paint, protocol)) for protocol in (2, 5)]
    for other in (*trips, copy.copy(paint), copy.deepcopy(paint)):
        assert type(other) is Paint and other == paint and (other.colour, other.coats) == ("red", ["primer"])
        other.colour = "blue"
        assert paint.colour == "red"
    assert copy.copy(paint).coats is paint.coats and copy.deepcopy(paint).coats is not paint.coats


@pytest.mark.parametrize("kind", KINDS)
def test_unequal_values_are_told_apart(kind):
    @settings(max_examples=15, deadline=None, derandomize=True)
    @given(KINDS[kind], KINDS[kind])
    def law(one, other):
        assert (one == other) == reads_alike(one, other)
        assert one != 5 and one != None  # noqa: E711

    law()


@pytest.mark.parametrize("value, change", [
    (ep.ChirpSequence(), {"num_chirps": 64}),
    (ep.CosinePower(2.0), {"exponent": 3.0}),
    (ep.Material(permittivity=4 - 1j), {"roughness_height": 1e-3}),
    (ep.LinearMotion((1, 2, 3)), {"velocity": (1, 2, 4)}),
    (ep.KeyframeMotion([0, 1, 2], [[0, 0, 0], [1, 0, 0], [3, 0, 0]]), {"interpolation": "linear"}),
    (ep.Curve([0, 1], [[0], [1]]), {"interpolation": "step"}),
    (ep.CurveMotion(ep.Curve([0, 1], [[0, 0, 0], [1, 0, 0]])), {"period": 2.0}),
    (ep.Joint("a"), {"name": "b"}), (ep.Layer(0.01, 3 - 0.1j), {"thickness": 0.02}),
    (ep.Weather(), {"rain_mm_per_hour": 5.0}), (ep.Receiver(), {"adc": ep.Adc(bits=10)}), (ep.Adc(), {"bits": 8}),
])
def test_replace_changes_what_is_named_and_nothing_else(value, change):
    before = pickle.dumps(value)
    changed = value.replace(**change)
    assert pickle.dumps(value) == before and changed != value and value.replace() == value
    for name, new in change.items():
        np.testing.assert_array_equal(getattr(changed, name), new)
        assert changed.replace(**{name: getattr(value, name)}) == value
    with pytest.raises(TypeError, match="unknown keyword 'nonsense'"):
        value.replace(nonsense=1)
    with pytest.raises((TypeError, ValueError), match=next(iter(change))):
        value.replace(**{next(iter(change)): object()})


def test_negative_zero_is_zero():
    one, other = ep.LinearMotion((0.0, 1, 0)), ep.LinearMotion((-0.0, 1, 0))
    assert one == other and hash(one) == hash(other)


def test_parts_keep_their_whole():
    whole = ep.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], [[0, 1, 2], [1, 3, 2]])
    one, other = pickle.loads(pickle.dumps([whole.part([0]), whole.part([1])]))
    assert one.whole is other.whole and one.whole == whole
    assert one != other and one == whole.part([0]) and one != whole


@pytest.mark.parametrize("value", [ep.ChirpSequence(), ep.Isotropic(), ep.Material.metal(), ep.LinearMotion()])
@pytest.mark.parametrize("state, message", [
    (5, "state: must be a dict"), ({5: 5}, "state: must be a dict"), ({"no such": 5}, "unknown keyword 'no such'"),
])
def test_states_are_checked_on_the_way_in(value, state, message):
    empty = type(value).__new__(type(value))
    with pytest.raises(TypeError, match=message):
        empty.__setstate__(state)


def test_damaged_states_are_refused_by_name():
    state = ep.ChirpSequence().__getstate__() | {"num_samples": 0}
    with pytest.raises(ValueError, match="num_samples"):
        ep.ChirpSequence.__new__(ep.ChirpSequence).__setstate__(state)


def _answer(values, pipe):
    pipe.send([(value, hash(value) == hash(copy.deepcopy(value)), bits(value)) for value in values])


def test_values_cross_to_a_spawned_process_and_back():
    skin = ep.Skin([[0, 0, 1.5]], [ep.Joint("a", motion=ep.LinearMotion((0.1, 0, 0)))], [[1.0]])
    values = [ep.ChirpSequence(num_chirps=3), ep.CosinePower(0.3), ep.Material(permittivity=5.31 - 0.27j), skin,
              ep.Mesh([[0, 0, 0], [1, 0, 0], [0, 1 / 3, 0]], [[0, 1, 2], [0, 0, 1]])]
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe()
    process = context.Process(target=_answer, args=(values, there))
    process.start()
    answers = here.recv() if here.poll(120) else []
    process.join()
    assert [value for value, _, _ in answers] == values
    assert all(same for _, same, _ in answers)
    assert [text for _, _, text in answers] == [bits(value) for value in values]
