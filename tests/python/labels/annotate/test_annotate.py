"""Labels of cells, objects and ghosts against closed forms of where echoes appear, and against NumPy."""
import numpy as np
import pytest

import echopath as ep
from echopath import _core
from echopath.labels import powers
from echopath.labels.cell_owners import CellOwners
from echopath.labels.family_pass import owners_of_views
from support.labelled import TARGETS, make_radar

# Main lobe of a Blackman-Harris window is 4 cells to each side; an extended body adds some.
LOBE = 6.0
CHUNKED = 1e-5   # relative, of the strongest cell: rms tolerance of the signals 1e-7 of the sum of all amplitudes
ROUNDING = 1e-9  # relative: sums in another order


def cells_from(labels, radar, distance, velocity):
    """How many cells of an unpadded map each cell is from a point, along velocity [V] and range [R]; velocities fold."""
    wave = radar.waveform
    coupling = wave.centre_frequency * velocity / wave.slope
    step, span = wave.velocity_resolution(), 2 * wave.max_velocity()
    slow = (labels.velocity - velocity + span / 2) % span - span / 2
    return np.abs(slow) / step, np.abs(labels.range - distance - coupling) / wave.range_resolution


def test_every_labelled_cell_has_the_part_that_closed_forms_put_there(labels, plates_and_wall):
    paths, _, truth = plates_and_wall
    near = []
    for name in labels.part_names:
        slow, far = cells_from(labels, paths.radar, *truth.get(name, (1e9, 0.0)))
        near.append((slow < LOBE)[:, None] & (far < LOBE)[None, :])
    near = np.array(near)
    assert near.sum(axis=0).max() == 1  # the scene was chosen so
    at = np.flatnonzero(labels.mask)
    expected = np.where(near.any(axis=0), near.argmax(axis=0), -2).ravel()[at]
    assert labels.noise_margin_db == 10.0 and len(at) > 500
    assert np.array_equal(labels.dominant.ravel()[at], expected)
    assert set(np.unique(expected)) == set(range(len(truth)))  # each of the seven is seen


def test_objects_and_ghosts_peak_where_closed_forms_put_them(labels, plates_and_wall):
    paths, _, truth = plates_and_wall
    wave = paths.radar.waveform

    def is_at(peak, name):
        distance, velocity = truth[name]
        distance += wave.centre_frequency * velocity / wave.slope
        is_near = abs(peak.range - distance) < wave.range_resolution
        return is_near and abs(peak.velocity - velocity) < wave.velocity_resolution()

    assert [label.name for label in labels.objects] == ["a", "b"] and all(label.status == "seen" for label in labels.objects)
    for label in labels.objects:
        assert is_at(label.peak, label.name) and label.visible_share == 1.0 and label.occluders == {}
        assert label.box.range_min <= label.peak.range <= label.box.range_max
    seen = {(ghost.object, ghost.order): ghost for ghost in labels.ghosts if ghost.cells}
    assert set(seen) == {("a", 2), ("a", 3), ("b", 2), ("b", 3)}
    for (name, order), ghost in seen.items():
        assert is_at(ghost.peak, f"{name} {'one' if order == 2 else 'two'} way") and ghost.via == ("wall",)
    codes = {(ghost.order, ghost.ghost_type, ghost.class_code) for ghost in seen.values()}
    assert {code for code in codes if code[0] == 3} == {(3, 2, 124)}


def test_maps_of_objects_and_ghosts_hold_the_cells_that_labels_count(labels):
    for index, label in enumerate(labels.objects):
        assert np.count_nonzero(labels.object_map == index) == label.cells > 0
    for index, ghost in enumerate(labels.ghosts):
        assert np.count_nonzero(labels.ghost_map == index) == ghost.cells
    assert not np.any((labels.object_map >= 0) & (labels.ghost_map >= 0))
    assert not np.any(((labels.object_map >= 0) | (labels.ghost_map >= 0)) & ~labels.mask)


def test_boxes_go_from_the_first_to_the_last_of_the_cells(labels):
    """Velocities are a circle, of which a box leaves out the longest arc without a cell."""
    owners = [(labels.object_map == index, label) for index, label in enumerate(labels.objects)]
    owners += [(labels.ghost_map == index, ghost) for index, ghost in enumerate(labels.ghosts) if ghost.cells]
    for own, label in owners:
        rows, columns = (np.flatnonzero(own.any(axis=axis)) for axis in (1, 0))
        last = int(np.argmax(np.diff(rows, append=rows[0] + len(own))))
        first = rows[(last + 1) % len(rows)]
        expected = *labels.range[columns[[0, -1]]], *labels.velocity[[first, rows[last]]]
        assert tuple(label.box) == pytest.approx(expected, abs=0)


def test_shares_sum_to_one_and_the_dominant_part_has_the_largest(labels):
    lit = labels.power.sum(axis=0) > 0
    assert np.abs(labels.share.sum(axis=0)[lit] - 1).max() < ROUNDING
    assert np.array_equal(labels.dominant[labels.mask], labels.share.argmax(axis=0)[labels.mask])
    assert np.all(labels.dominant[~labels.mask] == -1)
    assert labels.part_names[-1] == "other" and labels.shape == labels.whole.shape == labels.mask.shape


def test_masks_are_those_of_the_noise_and_of_the_dynamic_range(plates_and_wall):
    paths, parts, _ = plates_and_wall
    found = ep.annotate(paths, parts, noise_margin_db=20.0, dynamic_range_db=35.0)
    assert np.array_equal(found.above_noise, found.whole > 100 * found.noise_power)
    assert np.array_equal(found.mask, found.above_noise & (found.whole >= found.whole.max() * 10**-3.5))
    every = ep.annotate(paths, parts, noise=False, dynamic_range_db=None)
    assert np.array_equal(every.mask, every.whole > 0)


@pytest.mark.parametrize("window, real", [("hann", False), (("chebyshev", 70), True)])
def test_noise_of_a_cell_is_the_mean_of_noise_alone(window, real):
    wave = ep.ChirpSequence(num_samples=256, num_chirps=128, real=real)
    radar = ep.Radar(wave, transmitters=[ep.Antenna()], receivers=[ep.Antenna()] * 4)
    noise = ep.add_noise(np.zeros((1, 4, 128, 256)), radar, seed=5)
    measured = np.mean(np.abs(ep.range_doppler(noise, radar, window=window).values[..., 1:]) ** 2)
    assert _core.cell_noise_power(radar, window) / measured == pytest.approx(1.0, abs=0.02)  # 6e4 cells, neighbours alike


@pytest.mark.parametrize("real", [False, True])
def test_noise_against_echoes_is_that_of_maps_without_a_window(real):
    radar = ep.Radar(ep.ChirpSequence(num_samples=256, num_chirps=128, real=real), transmitters=[ep.Antenna()],
                     receivers=[ep.Antenna()] * 4)
    noise = ep.add_noise(np.zeros((1, 4, 128, 256)), radar, seed=6)
    measured = np.mean(np.abs(ep.range_doppler(noise, radar, window="rect").values[..., 1:]) ** 2)
    assert _core.noise_power_in_cell(radar) / measured == pytest.approx(1.0, abs=0.02)  # 6e4 cells


def test_powers_are_those_of_numpy(plates_and_wall):
    paths, parts, _ = plates_and_wall
    radar = make_radar(num_rx=3)
    made = ep.decompose(paths, radar, parts)
    found = ep.annotate(paths, made)
    spectra = {name: ep.range_doppler(cube, radar).values for name, cube in made.items()}
    for name, power in zip(found.part_names, found.power):
        assert np.allclose(power, np.mean(np.abs(spectra[name]) ** 2, axis=(0, 1)), rtol=ROUNDING, atol=0.0)
    whole = np.mean(np.abs(sum(spectra.values())) ** 2, axis=(0, 1))
    assert np.abs(found.whole - whole).max() < ROUNDING * whole.max()


def test_receivers_one_at_a_time_give_the_labels_of_all_at_once(plates_and_wall, monkeypatch):
    paths, parts, _ = plates_and_wall
    radar = make_radar(num_rx=3)
    together = ep.annotate(paths, ep.decompose(paths, radar, parts))
    monkeypatch.setattr(powers, "CUBES_IN_MEMORY", 1)
    apart = ep.annotate(paths, parts, radar)
    assert len(powers.receiver_sets(radar, 1)) == 3
    assert np.abs(apart.power - together.power).max() < CHUNKED * together.whole.max()
    assert np.mean(apart.dominant == together.dominant) > 0.999


def test_power_of_an_object_is_that_of_its_cube(plates_and_wall):
    paths, parts, _ = plates_and_wall
    made = ep.decompose(paths, None, parts)
    for label in ep.annotate(paths, made).objects:
        assert label.power / np.mean(np.abs(made[label.name]) ** 2) == pytest.approx(1.0, abs=ROUNDING)


def test_mean_powers_are_received_by_the_radar_that_is_asked_for(plates_and_wall, labels):
    """All powers grow with the power that is sent, those of objects, ghosts and parts over the random phases, too."""
    paths, parts, _ = plates_and_wall
    loud = ep.annotate(paths, parts, make_radar().replace(transmit_power=7.0 * make_radar().transmit_power))
    of_loud, of_own = ([*(label.received for label in (*found.objects, *found.ghosts)), *found.part_received]
                       for found in (loud, labels))
    assert np.allclose(of_loud, 7.0 * np.array(of_own), rtol=ROUNDING, atol=0.0)


def test_power_of_ghosts_that_share_cells_is_that_of_the_cube_of_each(plates_and_wall, labels):
    paths, _, _ = plates_and_wall
    cubes = ep.decompose(paths, parts=ep.families(paths))
    shared = [ghost for ghost in labels.ghosts if ghost.order == 2]
    assert len(shared) == 2 * len(TARGETS)
    for ghost in shared:
        own = cubes[ep.Family(ghost.object, ghost.ghost_type, ghost.order, ghost.via)]
        assert ghost.power / np.mean(np.abs(own) ** 2) == pytest.approx(1.0, abs=CHUNKED)


class OneCell:
    """A map of one cell with the power of a cube of one sample."""

    def power(self, cube, radar):
        return np.abs(cube[0, 0]) ** 2


@pytest.mark.parametrize("there, back, wins", [(1.0, 1.0, 1), (1.0, -1.0, 0), (0.7, 0.7, 0), (1.0, 1.02, 2)])
def test_a_way_there_and_back_wins_cells_by_its_common_field(there, back, wins):
    """Against another object's echo of amplitude 1.5. Equal powers are of type 1, whatever rounding says."""
    families = [ep.Family("b", 0, 1, ()), *(ep.Family("a", kind, 2, ("wall",)) for kind in (1, 2)), ep.Family("", 0, 0, ())]
    fields = 1.5, there, back * (1 + 1e-9), 0.0
    cubes = {family: np.full((1, 1, 1, 1), field) for family, field in zip(families, fields)}
    found = powers.ViewPowers(OneCell())
    for _ in range(2):
        found.add(cubes, powers.CubeSet(None, 0.5, {}))
    assert owners_of_views(found, np.ones((1, 1), bool)).family.item() == wins
    assert found.rivals["a", 2, frozenset({"wall"})] == pytest.approx((there + back) ** 2, abs=10 * ROUNDING)


@pytest.mark.parametrize("own, stranger, floor, wins", [
    (1.5, 0.0, 9.0, 0), (0.64, 0.0, 9.0, 0), (0.62, 0.0, 9.0, 1), (0.62, 0.0, 0.3, 0), (1.5, 2.1, 0.0, 3), (1.5, 1.9, 0.0, 0)])
def test_an_object_has_the_cells_that_it_shares_with_its_ghosts(own, stranger, floor, wins):
    """A pair of ghosts whose fields add up to 2, so 10 dB above an echo of amplitude 0.632, and what another object sends;
    an echo that has faded, but is above the noise, is there, too."""
    families = [ep.Family("a", 0, 1, ()), *(ep.Family("a", kind, 2, ("road",)) for kind in (1, 2)), ep.Family("b", 0, 1, ())]
    cubes = {family: np.full((1, 1, 1, 1), field) for family, field in zip(families, (own, 1.0, 1.0, stranger))}
    found = powers.ViewPowers(OneCell())
    found.add(cubes, powers.CubeSet(None, 1.0, {}))
    owners = owners_of_views(found, np.ones((1, 1), bool), floor)
    assert owners.family.item() == wins and owners.own.item() == pytest.approx([own, 1.0, 1.0, stranger][wins] ** 2)


OWNERS = [ep.Family("a", 0, 1, ()), ep.Family("b", 0, 1, ()), ep.Family("a", 1, 2, ("road",)), ep.Family("b", 1, 2, ("road",)),
          ep.Family("", 0, 0, ())]


def slow_owner(power, peak, floor):
    """The rule of CellOwners for one cell, power [F], of families with their strongest cells, peak [F]."""
    best = int(np.argmax(power))
    if power[best] == 0.0:
        return -1
    direct = best - 2 if OWNERS[best].is_ghost else best
    shown = 0.1 * min(power[best], peak[direct] if peak[direct] > floor else np.inf)
    return direct if power[direct] >= shown else best


@pytest.mark.parametrize("seed", range(40))
def test_owners_of_some_cells_are_those_of_the_whole_map_in_whatever_order(seed):
    """Powers over four decades about the floor, of which many are alike; detections ask for a few cells of the map."""
    random, floor = np.random.default_rng(seed), 1.0
    power = random.integers(0, 4, (len(OWNERS), 30)) * 10.0 ** random.integers(-2, 2, (len(OWNERS), 1))
    peak, some = power.max(axis=1), slice(0, 5)
    expected = [slow_owner(of_cell, peak, floor) for of_cell in power.T]
    for order in (range(len(OWNERS)), reversed(range(len(OWNERS)))):
        whole, few = CellOwners((30,), OWNERS, floor), CellOwners((5,), OWNERS, floor)
        for rival in order:
            whole.add(rival, power[rival], 0.0)
            few.add(rival, power[rival, some], 0.0)
        for rival in few.faded():
            few.peak[few.rivals[rival]] = peak[few.rivals[rival]]
        for owners in (whole, few):
            owners.give(np.ones(owners.best.shape, bool))
        assert whole.family.tolist() == expected and few.family.tolist() == expected[some]


def test_pairs_of_ghosts_have_their_cells_together(labels):
    kinds = {(ghost.object, ghost.ghost_type): ghost.cells for ghost in labels.ghosts if ghost.order == 2}
    assert all(kinds[name, 1] > 0 and kinds[name, 2] == 0 for name in TARGETS)


def test_parts_by_families_are_labelled_too(plates_and_wall):
    paths, _, _ = plates_and_wall
    families = ep.families(paths)
    found = ep.annotate(paths, ep.decompose(paths, parts=families))
    assert found.part_names == [str(family) for family in families]
    for label in found.objects:
        part = families.families.index(ep.Family(label.name, 0, 1, ()))
        assert np.count_nonzero(found.dominant == part) == label.cells > 0
    batched = ep.trace(paths.scene, paths.radar, num_rays=500, batches=2)
    with pytest.raises(ValueError, match="errors: need the selections of the parts"):
        ep.annotate(batched, ep.decompose(batched, parts=ep.families(batched)), errors=True)
