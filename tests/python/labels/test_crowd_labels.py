"""Labels of a crowd keep few signals: they are those that the signals of all families give."""
import dataclasses
import itertools

import numpy as np
import pytest

import echopath as ep
from echopath.actors import shapes
from echopath.arguments.settings import LabelSettings
from echopath.labels import family_pass
from echopath.labels.cell_owners import ALIKE, SHARED
from echopath.labels.left_out import LeftOut
from echopath.labels.powers import parts_by_rival
from echopath.labels.request import make_request
from support.hand_made import diffuse_paths

SUM = 1e-12  # relative, of parts that add up
PLANES = ("range_doppler", "range_azimuth")


@pytest.fixture(scope="module")
def radar():
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=5e8, num_samples=128, sampling_rate=10e6, num_chirps=32,
                                chirp_interval=4e-5)
    return ep.Radar(waveform, transmitters=[ep.Antenna((0.0, 0.004 * k, 0.8)) for k in range(2)],
                    receivers=[ep.Antenna((0.0, 0.002 * k, 0.8)) for k in range(2)], noise_figure_db=6.0)


@pytest.fixture(scope="module")
def scene():
    """Six boxes that move on a mirroring ground between mirroring walls."""
    scene, mirror = ep.Scene(), ep.materials["concrete"].replace(scattering=0.3, mirror=True)
    scene.add(shapes.ground((80.0, 30.0)), name="ground", material=mirror, position=(30.0, 0.0, 0.0))
    for side in (1.0, -1.0):
        scene.add(shapes.wall(80.0, 5.0), name="wall_left" if side > 0 else "wall_right", material=mirror,
                  position=(30.0, 9.0 * side, 0.0), yaw=0.0 if side > 0 else np.pi)
    rough = ep.Material(conductor=True, scattering=0.6)
    for k in range(6):
        scene.add(shapes.box((1.5, 1.0, 1.2)), name=f"box_{k}", material=rough, position=(6.0 + 4.0 * k, 5.0 * (-1) ** k, 0.7),
                  yaw=0.3 * k, motion=ep.LinearMotion(velocity=(3.0 * k - 8.0, 0.0, 0.0), angular_velocity=(0.0, 0.0, 0.2 * k)))
    return scene


@pytest.fixture(scope="module")
def paths(scene, radar):
    return ep.trace(scene, radar, num_rays=5_000, max_bounces=3, seed=4)


@pytest.fixture(scope="module")
def families(paths):
    return ep.families(paths)


@pytest.fixture(scope="module")
def usual(paths, radar):
    """The labels as anybody makes them."""
    return ep.annotate(paths, None, radar)


@pytest.fixture(scope="module")
def cubes(paths, families):
    """The signal of every family."""
    return ep.decompose(paths, None, families)


def owner_of_cells(cubes, power, whole, labels):
    """The slow rule of Labels in NumPy: {family: cells} and {family: its own power in the strongest of them}."""
    mask = (whole > labels.noise_power * 10.0) & (whole >= whole.max() * 1e-6)
    families = list(cubes)
    own = np.stack([power(cube) for cube in cubes.values()])
    rivals = list(parts_by_rival(families).values())
    joint = np.stack([power(sum(cubes[family] for family in members)) for members in rivals])
    cells, peaks = {}, {}
    for cell in zip(*np.nonzero(mask)):
        strongest = int(np.argmax(joint[(slice(None), *cell)]))
        members = [families.index(family) for family in rivals[strongest]]
        direct = ep.Family(families[members[0]].object, 0, 1, ())
        if direct in families:
            own_power = own[families.index(direct)]
            peak = own_power.max() if own_power.max() > 10.0 * labels.noise_power else np.inf
            if own_power[cell] >= SHARED * min(joint[(strongest, *cell)], peak):
                members = [families.index(direct)]
        here = own[(members, *cell)]
        family = families[members[int(np.argmax(here >= ALIKE * here.max()))]]
        cells[family] = cells.get(family, 0) + 1
        peaks[family] = max(peaks.get(family, 0.0), here[members.index(families.index(family))])
    return cells, peaks


@pytest.mark.parametrize("plane", PLANES)
def test_labels_are_those_of_the_signals_of_all_families(paths, radar, cubes, plane):
    labels = ep.annotate(paths, None, radar, plane=plane)
    power = make_request(radar, 1, LabelSettings(plane=plane)).plane.power
    cells, peaks = owner_of_cells(cubes, lambda cube: power(cube, radar), power(sum(cubes.values()), radar), labels)
    found = {ep.Family(ghost.object, ghost.ghost_type, ghost.order, ghost.via): ghost for ghost in labels.ghosts}
    found |= {ep.Family(one.name, 0, 1, ()): one for one in labels.objects}
    assert {family: label.cells for family, label in found.items() if label.cells} == {
        family: count for family, count in cells.items() if family.object}
    for family, label in found.items():
        if label.cells:
            assert label.peak.power == pytest.approx(peaks[family], rel=1e-6)
    assert 0 < labels.left_out.families < len(cubes)
    assert len(cells) > 5


def test_no_family_that_is_left_out_shows_more_than_its_bound(paths, radar, families, cubes):
    """Of all families, at every velocity of a range."""
    signals = ep._core.PartPass(paths, radar, families.family_of_path, len(families), tolerance=1e-7, method="auto",
                                replay="material", evaluate="interpolated", phase_tolerance=1e-5)
    bounds = signals.bounds([[family] for family in range(len(families))], "hann", 2, None)
    for family, bound in zip(families.families, bounds):
        shown = (np.abs(ep.range_doppler(cubes[family], radar, "hann", 2).values) ** 2).max(axis=(0, 1, 2))
        assert np.all(shown <= bound * (1 + 1e-9))
        if shown.max() > 1e-20 and np.count_nonzero(families.family_of_path == families.families.index(family)) < 3:
            assert bound.max() < 20.0 * shown.max()  # a bound that is of use


def test_families_made_some_at_a_time_add_up_to_the_whole(paths, radar):
    frame = ep.annotate(paths, None, radar)
    whole = (np.abs(ep.range_doppler(ep.synthesize(paths, radar), radar).values) ** 2).mean(axis=(0, 1))
    np.testing.assert_allclose(frame.whole, whole, rtol=0.0, atol=SUM * whole.max())


def test_the_number_of_threads_changes_no_bit(paths, radar):
    threads = ep.num_threads()
    try:
        ep.set_num_threads(1)
        one = ep.annotate(paths, None, radar)
        ep.set_num_threads(3)
        assert ep.annotate(paths, None, radar) == one
    finally:
        ep.set_num_threads(threads)


def test_memory_for_one_signal_at_a_time_gives_the_same_labels(paths, radar, monkeypatch):
    """Signals that are added some at a time are rounded otherwise."""
    at_once = ep.annotate(paths, None, radar)
    monkeypatch.setattr(family_pass, "SIGNALS_IN_MEMORY", 1)
    by_one = ep.annotate(paths, None, radar)
    np.testing.assert_array_equal(by_one.object_map, at_once.object_map)
    np.testing.assert_array_equal(by_one.ghost_map, at_once.ghost_map)
    np.testing.assert_allclose(by_one.whole, at_once.whole, rtol=0.0, atol=SUM * at_once.whole.max())


def test_labels_say_what_was_left_out(paths, radar, families):
    labels = ep.annotate(paths, None, radar)
    assert labels.left_out.families < len(families)
    assert 0.0 < labels.left_out.power < labels.whole.max()
    assert f"{labels.left_out.families} families can own no cell" in str(labels)
    everything = ep.annotate(paths, None, radar, noise=False, dynamic_range_db=None)
    assert everything.left_out.families <= labels.left_out.families


def test_families_without_power_are_not_left_out(radar):
    """A corner alone owns its cells, and nothing else sends anything back; what is left out of others is counted in words."""
    scene = ep.Scene()
    scene.add(shapes.trihedral(0.1), name="corner", material="metal", position=(15.0, 0.0, 0.8))
    labels = ep.annotate(ep.trace(scene, radar, num_rays=1_000, seed=4), None, radar)
    assert labels.objects[0].cells > 0 and len(labels.ghosts) == 0
    assert labels.left_out == (0, 0.0, 0.0) and "own no cell" not in str(labels)
    one, two = (str(dataclasses.replace(labels, left_out=LeftOut(number, 1e-18, 1e-19))) for number in (1, 2))
    assert one.endswith("\n1 family can own no cell and has no signal of its own: -150 dBm, at most -160 dBm in a cell")
    assert two.endswith("\n2 families can own no cell and have no signals of their own: -150 dBm together, at most -160 dBm in a "
                        "cell")
    rounding = str(dataclasses.replace(labels, left_out=LeftOut(1, 1e-266, 0.0)))
    assert rounding.endswith(": below -300 dBm, at most -300 dBm in a cell")


@pytest.mark.parametrize("shown", [0.0, 1e-9, 1e-1, 1e12])
def test_what_maps_of_families_leave_out_at_first_owns_its_cells_all_the_same(paths, radar, usual, monkeypatch, shown):
    """With a floor of 1e12 times the noise no map shows anything at first, with 0 each shows all."""
    monkeypatch.setattr(family_pass, "SHOWN", shown)
    other = ep.annotate(paths, None, radar)
    assert other.objects and np.array_equal(other.object_map, usual.object_map)
    assert np.array_equal(other.ghost_map, usual.ghost_map)
    for one, another in zip(usual.objects + usual.ghosts, other.objects + other.ghosts):
        assert (one.cells, one.box) == (another.cells, another.box)
        assert another.power == pytest.approx(one.power, rel=SUM, abs=0.0)


def test_families_may_be_likely_by_one_sum_of_all_their_paths(paths, radar, usual, monkeypatch):
    """In the place of one sum for each pair of cells: more families are made by themselves, and cells have the same owners."""
    monkeypatch.setattr(family_pass, "MOST_SUMS", 1)
    other = ep.annotate(paths, None, radar)
    assert other.left_out.families < usual.left_out.families
    assert np.array_equal(other.object_map, usual.object_map) and np.array_equal(other.ghost_map, usual.ghost_map)


@pytest.mark.parametrize("apart", [0.0, 1e12])
def test_cells_are_divided_among_families_early_or_late(paths, radar, usual, monkeypatch, apart):
    """With 0 families are looked at where their rival wins any cell so far, with 1e12 only once the owners are known."""
    assert any(ghost.cells for ghost in usual.ghosts)
    monkeypatch.setattr(family_pass, "APART", apart)
    other = ep.annotate(paths, None, radar)
    assert np.array_equal(other.object_map, usual.object_map) and np.array_equal(other.ghost_map, usual.ghost_map)
    for one, another in zip(usual.objects + usual.ghosts, other.objects + other.ghosts):
        assert (one.cells, one.box) == (another.cells, another.box)
        assert another.power == pytest.approx(one.power, rel=SUM, abs=0.0)


def test_a_crowd_has_more_ghosts_than_its_map_can_number():
    """Faint ways over any three of 38 triangles, and one over a wall: the ghost of the last of them has all cells."""
    def triangle(x, y):
        return ep.Mesh([[x, y - 0.1, -0.1], [x, y + 0.1, -0.1], [x, y, 0.1]], [[0, 1, 2]])

    scene, rough = ep.Scene(), ep.Material(reflectivity=0.5, scattering=1.0)
    for k in range(38):
        scene.add(triangle(1.2 + 0.002 * k, -0.5 + 0.025 * k), name=f"body_{k}", material=rough)
    scene.add(triangle(0.7, 0.5), name="wall", material=rough.replace(mirror=True))
    routes = [*itertools.permutations(range(38), 3), (37, 38, 37)]
    paths = diffuse_paths(scene, routes, weight=np.r_[np.full(len(routes) - 1, 1e-9), 1e-3])
    labels = ep.annotate(paths, noise=False)
    assert len(labels.ghosts) > 32768 and len({(one.object, one.ghost_type, one.via) for one in labels.ghosts}) > 32768
    (seen,) = (one for one in labels.ghosts if one.cells)
    assert (seen.object, seen.via, seen.cells) == ("body_37", ("wall",), np.count_nonzero(labels.mask)) and seen.cells > 0
    np.testing.assert_array_equal(labels.ghost_map, np.where(labels.mask, labels.ghosts.index(seen), -1))
    assert seen.peak.power == pytest.approx(labels.whole.max(), rel=1e-6) and not np.any(labels.object_map >= 0)
