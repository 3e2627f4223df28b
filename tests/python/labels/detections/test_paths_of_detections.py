"""The paths behind a detection, against the signal that they make by themselves."""
from __future__ import annotations

import pickle
import tracemalloc
from fractions import Fraction

import numpy as np
import pytest

import echopath as ep
from echopath import _core
from echopath.detections import echo_fields
from echopath.detections.echo_fields import EchoFields
from echopath.detections.response import Envelope, Response, segments_of
from echopath.detections.uneven_fields import echo_fields as fields_of
from echopath.spectra.windows import samples_of
from support.radars import with_waveform
from support.scenes.small_spheres import TARGETS, WAVELENGTH, at, nearest, radar_with, scene_of
from support.shapes import lambert

TABLE = 0.006  # of the peak: straight lines between the steps of the table
NEAREST_SWEEP = 0.04  # of the peak: 0.1 rad at the ends of the frame, where it is most, averaged over the frame
MODEL = 0.1    # of fields: the third derivative of a length, and the first antennas' states for all chirps
HELD = 0.95    # of a cell's power, by the paths named
LEFT_OUT = 1e-5  # of the power of single paths in a cell; ten times what the bounds promise
FAR_AWAY = 1e-3  # of the peak: what responses follow, 60 dB
LINE = 0.02    # of the peak: two tables, and straight lines between channels
BEYOND = 2.0   # times its bound may be the field of a single tone that moves, where responses have deep gaps
SINGLE = 2e-7  # relative: rounding of single precision


def synthesised_power(paths, chosen, radar, spectrum, cell):
    """Power in W of the chosen paths alone in a cell, mean over channels."""
    mask = np.zeros(paths.num_paths, bool)
    mask[chosen] = True
    cube = ep.synthesize(paths.select(mask), radar)
    part = ep.range_doppler(cube, radar, window=spectrum.window, zero_pad=spectrum.zero_pad)
    return np.mean(np.abs(part.values[:, :, cell[0], cell[1]]) ** 2)


def expect_paths_hold(found, paths, radar, spectrum, i):
    """Synthesised alone they make the cell, and all others little of it."""
    index, share = found.paths(i)
    assert len(index) and np.all(np.diff(share) <= 0.0) and 0.99 < share.sum() <= 1.0 + 1e-12
    whole = synthesised_power(paths, np.arange(paths.num_paths), radar, spectrum, found.cells[i])
    others = np.setdiff1d(np.arange(paths.num_paths), index)
    assert synthesised_power(paths, index, radar, spectrum, found.cells[i]) == pytest.approx(whole, rel=1.0 - HELD, abs=0)
    assert synthesised_power(paths, others, radar, spectrum, found.cells[i]) < (1.0 - HELD) * whole
    return index


def test_the_paths_behind_a_detection_make_its_cell_and_the_others_do_not(spheres):
    radar, paths, spectrum = spheres
    found = ep.detect(spectrum, radar, paths=paths)
    mesh = paths.mesh_id[paths.offsets]
    for number, name in enumerate(TARGETS):
        index = expect_paths_hold(found, paths, radar, spectrum, nearest(found, name))
        assert set(mesh[index]) == {number}


def test_a_pickle_holds_what_the_paths_of_cells_follow_from_and_no_more(spheres):
    """What is kept beside it has names that change from version to version."""
    radar, paths, spectrum = spheres
    found = ep.detect(spectrum, radar, paths=paths)
    before = pickle.dumps(found)
    told = [found.paths(i) for i in range(len(found))]
    assert len(pickle.dumps(found)) == len(before)
    again = pickle.loads(before)
    for i, (index, share) in enumerate(told):
        np.testing.assert_array_equal(again.paths(i)[0], index)
        np.testing.assert_array_equal(again.paths(i)[1], share)


@pytest.fixture(scope="module")
def movers():
    """(radar, paths, signal) of limbs, which speed up during the frame, and of a plate at 30 m/s, which shows three axes
    away and goes on by three cells of range; two transmitters in turn."""
    radar = radar_with(receivers=2, transmitters=2, num_chirps=128, chirp_interval=60e-6)
    scene = ep.Scene()
    scene.add(ep.actors.pedestrian(height=1.78, speed=1.5), name="walker", position=(8, 0, -1), yaw=np.pi)
    scene.add(ep.actors.plate(0.3, 0.3), name="plate", material=lambert(0.27), position=(14, -1, 0),
              motion=ep.LinearMotion(velocity=(30.0, 0, 0)))
    paths = ep.trace(scene, radar, num_rays=1500, max_bounces=2)
    return radar, paths, ep.synthesize(paths, radar)


@pytest.mark.parametrize("window, zero_pad", [("hann", 1), ("rect", 1), ("hann", 2),
                                              ((("chebyshev", 50), "rect"), 1)])
def test_the_paths_behind_limbs_and_folded_speeds_are_found(movers, window, zero_pad):
    radar, paths, cube = movers
    spectrum = ep.range_doppler(ep.add_noise(cube, radar, seed=2), radar, window=window, zero_pad=zero_pad)
    found = ep.detect(spectrum, radar, paths=paths)
    for i in np.argsort(-found.snr_db)[:4]:
        expect_paths_hold(found, paths, radar, spectrum, i)
    assert {"walker", "plate"} <= set(found.object)


def test_paths_that_are_left_out_change_next_to_nothing(movers, monkeypatch):
    """Against the fields of all paths within reach of a cell, of which fewer have its power but for a millionth."""
    radar, paths, cube = movers
    spectrum = ep.range_doppler(ep.add_noise(cube, radar, seed=2), radar)
    cells = ep.detect(spectrum, radar, paths=paths).cells[:6]
    some = EchoFields(paths, spectrum)
    some.evaluate(cells)
    monkeypatch.setattr(echo_fields, "LEFT_OUT", 0.0)
    everything, counts = EchoFields(paths, spectrum), []
    for cell in cells:
        (index, field), (all_of_them, exact) = (one.fields(cell) for one in (some, everything))
        counts.append(len(index) / len(all_of_them))
        power = np.sum(np.abs(exact) ** 2, axis=1)
        np.testing.assert_allclose(field, exact[:, np.isin(all_of_them, index)], rtol=1e-6)  # single precision
        assert np.all(np.sum(np.abs(field) ** 2, axis=1) > (1.0 - LEFT_OUT) * power)
    assert min(counts) < 0.6


@pytest.mark.parametrize("spacing, is_alike", [(0.5 * WAVELENGTH, True), (0.008, True), (0.05, False)])
def test_the_field_of_a_single_path_is_that_of_its_signal(spacing, is_alike):
    """At an echo and beside it, in each of eight channels: in one place of the map, in several, and bins of range apart."""
    radar = radar_with(receivers=8, spacing=spacing)
    paths = ep.trace(scene_of(TARGETS), radar, num_rays=300, max_bounces=1)
    spectrum = ep.range_doppler(ep.synthesize(paths, radar), radar)
    echoes = EchoFields(paths, spectrum)
    assert echoes._channels_are_alike == is_alike
    nearest_cell = ep.path_cells(paths, spectrum)
    for chosen in (np.argmax(np.where(paths.mesh_id[paths.offsets] == number, np.abs(paths.amplitude), 0.0))
                   for number in range(len(TARGETS))):
        alone = ep.synthesize(paths.select(np.arange(paths.num_paths) == chosen), radar, method="direct")
        values = ep.range_doppler(alone, radar).values[0]
        for slow, far in ((0, 0), (1, -1), (-2, 1)):
            cell = nearest_cell.velocity_index[chosen] + slow, nearest_cell.range_index[chosen] + far
            index, field = echoes.fields(cell)
            model, exact = field[:, np.flatnonzero(index == chosen)[0]], values[:, *cell]
            turn = exact[0] * np.conj(model[0]) / np.abs(exact[0] * model[0])  # of all fields of a cell: where samples begin
            np.testing.assert_allclose(turn * model, exact, rtol=0, atol=LINE * np.abs(values).max())


def test_an_echo_that_goes_on_during_the_frame_is_in_all_cells_that_it_passes(movers):
    """The strongest path of a plate that goes on by three cells, against its signal."""
    radar, paths, signal = movers
    spectrum = ep.range_doppler(signal, radar)
    of_plate = np.char.startswith([paths.scene.meshes[mesh].name for mesh in paths.mesh_id[paths.offsets]], "plate")
    chosen = np.argmax(np.where(of_plate, np.abs(paths.amplitude), 0.0))
    alone = ep.synthesize(paths.select(np.arange(paths.num_paths) == chosen), radar, method="direct")
    values = ep.range_doppler(alone, radar).values[0, 0]
    echoes, nearest_cell = EchoFields(paths, spectrum), ep.path_cells(paths, spectrum)
    velocity, distance = (int(part[chosen]) for part in (nearest_cell.velocity_index, nearest_cell.range_index))
    for far in range(-2, 3):
        index, field = echoes.fields((velocity, distance + far))
        model = field[0, index == chosen].sum()
        assert abs(model) == pytest.approx(abs(values[velocity, distance + far]), abs=LINE * np.abs(values).max())


@pytest.mark.parametrize("steps", [(), (0.0, 6e7, 2e7)], ids=["even", "hopping"])
@pytest.mark.parametrize("distance", [1.3, 30.8])
def test_sidelobes_go_around_the_axis_of_complex_samples(distance, steps):
    """Those of an echo at one end of the axis, half of which are at the other: by the paths as in the map itself."""
    radar = with_waveform(radar_with(receivers=2), bandwidth=0.3e9, num_samples=64, num_chirps=8, frequency_steps=steps)
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.2, 0.2), name="plate", material=lambert(0.3), position=(distance, 0.0, 0.0))
    paths = ep.trace(scene, radar, num_rays=100, max_bounces=1)
    spectrum = ep.range_doppler(ep.synthesize(paths, radar, method="direct"), radar, "rect")
    echoes, values = fields_of(paths, spectrum), spectrum.values[0]
    slow = np.unravel_index(np.abs(values).argmax(), values.shape)[1]
    for far in range(0, 64, 3):
        model, exact = echoes.fields((slow, far))[1].sum(axis=1), values[:, slow, far]
        turn = np.vdot(model, exact) / max(abs(np.vdot(model, exact)), 1e-300)  # of all fields of a cell: where samples begin
        np.testing.assert_allclose(turn * model, exact, rtol=0.0, atol=TABLE * np.abs(values).max())


def test_sidelobes_at_the_other_end_of_the_axis_are_no_noise():
    """A ball next to the radar, whose sidelobes of a Taylor window are detections from end to end of the axis."""
    radar = with_waveform(radar_with(receivers=2, num_chirps=16), bandwidth=0.3e9, num_samples=64)
    paths = ep.trace(scene_of({"ball": (1.3, 0.0, 0.0)}), radar, num_rays=1000)
    found = ep.detect(ep.range_doppler(ep.add_noise(ep.synthesize(paths, radar), radar, seed=1), radar, ("taylor", 30)), radar,
                      paths=paths)
    beyond = np.flatnonzero(found.range > 0.5 * radar.waveform.max_range)
    assert len(beyond) and not found.is_noise.any() and set(found.object) == {"ball"}
    assert all(len(found.paths(i)[0]) for i in beyond)


def test_an_echo_counts_that_only_the_last_antennas_have_in_the_cell():
    """Seen from the first ones it is bins away from a stronger echo, which they alone have there."""
    radar, scene = radar_with(receivers=8, spacing=0.4), ep.Scene()
    distance, azimuth, aperture = 10.0, 0.8, 7 * 0.4
    weak = (4.0 * distance ** 2 - aperture ** 2) / (4.0 * distance - 2.0 * aperture * np.sin(azimuth))  # law of cosines
    for name, radius, place, angle in (("strong", 0.9, distance, 0.0), ("weak", 0.02, weak, azimuth)):
        scene.add(ep.actors.sphere(radius), name=name, material="metal", smooth=True, position=tuple(at(place + radius, angle)))
    paths = ep.trace(scene, radar, num_rays=3000, max_bounces=1)
    spectrum = ep.range_doppler(ep.synthesize(paths, radar), radar)
    cells, mesh = ep.path_cells(paths, spectrum), paths.mesh_id[paths.offsets]
    far = cells.range_index[np.argmax(np.abs(paths.amplitude))]
    assert np.median(cells.range_index[mesh == 1]) > far + 4
    echoes = EchoFields(paths, spectrum)
    index, field = echoes.fields((len(spectrum.velocity) // 2, far))
    weak_power = np.abs(field[:, mesh[index] == 1].sum(axis=1)) ** 2
    assert weak_power[-1] > 1e4 * weak_power[0]


def test_a_response_to_few_tones_takes_no_memory_of_the_size_of_its_table():
    """Of 41 sweeps at six nodes, with 8,225 steps each, the table has 16 MB."""
    response = Response("rect", 512, largest_sweep=32.0, segments=5)
    tracemalloc.start()
    try:
        response(np.linspace(-50.0, 50.0, 100), np.linspace(-32.0, 32.0, 100))
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 400 * 6 * 100  # bytes, of tones at nodes


@pytest.mark.parametrize("window", ["rect", "hann", "hamming"])
@pytest.mark.parametrize("travel", [0.0, 0.3, 1.0, 8.0])
@pytest.mark.parametrize("sweep", [0.0, 0.5, 8.0])
def test_no_path_gives_more_to_a_cell_than_its_bound(window, travel, sweep):
    """Of tones that move on in range and in velocity during the frame, summed over all samples; power on the mean."""
    n, rng = 64, np.random.default_rng(5)
    samples = samples_of(window, n) / samples_of(window, n).sum()
    place = (np.arange(n) - 0.5 * (n - 1)) / n
    slow, far = rng.uniform(-16.0, 16.0, 400), rng.uniform(-16.0, 16.0, 400)
    across = np.exp(-2j * np.pi * (far[:, None] - travel * place)[..., None] * place) @ samples  # [tones, chirps]
    along = np.exp(-2j * np.pi * np.outer(slow, place) + 1j * np.pi * sweep * place ** 2)
    field = np.abs((along * across) @ samples)
    envelope = Envelope(window, n)
    bound = envelope.bound(slow, travel + sweep) * envelope.bound(far, travel)
    assert np.all(field <= BEYOND * bound) and np.sum(field ** 2) < np.sum(bound ** 2)
    assert bound.max() <= 1.0


@pytest.mark.parametrize("bandwidth", [1e9, -1e9])
def test_phases_in_the_middle_of_a_chirp_are_those_of_the_carrier(bandwidth):
    """2 pi {(f0 + slope t) d - slope d^2 / 2}, whole turns taken out in fractions, which round nothing."""
    waveform, lengths = ep.ChirpSequence(bandwidth=bandwidth), np.array([[0.0, 3.25], [40.5, 299.792458]])
    middle, slope = Fraction(waveform.window_centre), Fraction(waveform.slope)
    delays = [Fraction(length) / 299792458 for length in lengths.ravel()]
    turns = [(Fraction(waveform.start_frequency) + slope * middle) * delay - slope * delay ** 2 / 2 for delay in delays]
    wanted = np.exp(2j * np.pi * np.array([float(one - round(one)) for one in turns])).reshape(2, 2)
    np.testing.assert_allclose(_core.middle_phases(lengths, waveform), wanted, rtol=0, atol=1e-9)


def test_several_receivers_at_once_have_the_echoes_that_each_has_by_itself(movers):
    _, paths, _ = movers
    length, amplitude = paths._echoes_at_receivers(1e-3, 1, [1, 0])
    for row, rx in enumerate((1, 0)):
        np.testing.assert_array_equal(length[row], paths.lengths([1e-3], 1, rx)[0])
        np.testing.assert_allclose(amplitude[row], paths.amplitudes([1e-3], 1, rx)[0], rtol=1e-12)
    with pytest.raises(IndexError, match="receivers: must lie in 0 to 1, got 2"):
        paths._echoes_at_receivers(1e-3, 0, [2])
    with pytest.raises(ValueError, match="receivers: must be at least one"):
        paths._echoes_at_receivers(1e-3, 0, [])


def test_the_fields_of_all_paths_add_up_to_the_map(movers):
    """In each channel, also in the sidelobes of a window without taper, far from the echo."""
    radar, paths, cube = movers
    clean = ep.range_doppler(cube, radar, window="rect")
    found = ep.detect(ep.range_doppler(ep.add_noise(cube, radar, seed=2), radar, window="rect"), radar, paths=paths)
    exact = clean.values[:, :, found.cells[:, 0], found.cells[:, 1]].reshape(4, -1)
    model = np.array([found.echoes.fields(cell)[1].sum(axis=1) for cell in found.cells]).T
    assert np.all(np.median(np.abs(np.abs(model) / np.abs(exact) - 1.0), axis=1) < MODEL)


@pytest.mark.parametrize("seed", [1, 2])
def test_strong_echoes_are_not_noise_where_they_fade_in_single_antennas(seed):
    """Rough plates far apart enough from one antenna to the next that their random phases add up differently."""
    radar = radar_with(receivers=8, spacing=0.02)
    scene = ep.Scene()
    for k in range(12):
        scene.add(ep.actors.plate(1.0, 1.0), name=f"plate {k}", material=ep.Material(permittivity=4 - 0.2j, scattering=1.0),
                  position=tuple(at(6.0 + 2.0 * k, 1.1 - 0.2 * k)))
    paths = ep.trace(scene, radar, num_rays=10_000, max_bounces=1, seed=seed)
    spectrum = ep.range_doppler(ep.add_noise(ep.synthesize(paths, radar), radar, seed=seed), radar)
    found = ep.detect(spectrum, radar, paths=paths)
    strong = np.flatnonzero(found.snr_db > 20.0)
    assert len(strong) >= 10 and "noise" not in found.part[strong] and "" not in found.object[strong]
    assert all(len(found.paths(i)[0]) for i in strong)


@pytest.mark.parametrize("n", [16, 15])
def test_the_response_of_a_swept_tone_is_its_slow_sum(n):
    """Also whole turns of the axis away, and at the nodes of segments, to which samples belong as they are near."""
    y, sweep = np.array([0.0, -0.37, 2.81, n + 1.3, -2 * n - 0.6]), np.array([0.0, 2.25, -2.25, 2.25, -2.25])
    place = (np.arange(n) - 0.5 * (n - 1)) / n
    terms = np.exp(-2j * np.pi * np.outer(y, place) + 1j * np.pi * np.outer(sweep, place ** 2)) / n
    parts = Response("rect", n, largest_sweep=2.25, segments=3)(y, sweep)  # its step
    np.testing.assert_allclose(parts.sum(axis=0), terms.sum(axis=1), rtol=0, atol=TABLE)
    nodes = (n - 1) / 3 * np.arange(4)[:, None]
    shares = np.maximum(1.0 - np.abs(np.arange(n) - nodes) * 3 / (n - 1), 0.0)
    np.testing.assert_allclose(parts, shares @ terms.T, rtol=0, atol=TABLE)


@pytest.mark.parametrize("segments", [1, 5, 12, 32])
def test_responses_of_any_sweep_come_from_a_small_table(segments):
    """The error is that of the nearest sweep in the table, whatever the number of segments."""
    n, rng = 512, np.random.default_rng(3)
    sweep, y = rng.uniform(-32.0, 32.0, 300), rng.uniform(-20.0, 20.0, 300)
    place = (np.arange(n) - 0.5 * (n - 1)) / n
    terms = np.exp(-2j * np.pi * np.outer(y, place) + 1j * np.pi * sweep[:, None] * place ** 2) / n
    response = Response("rect", n, largest_sweep=32.0, segments=segments)
    assert response._table.nbytes < 20 * 2 ** 20
    error = np.abs(response(y, sweep).sum(axis=0) - terms.sum(axis=1))
    assert error.max() < NEAREST_SWEEP + TABLE


def test_echoes_have_as_many_segments_as_their_ways_ask_for():
    """Eight a bin, one if they stay; those of the fastest one are no more than that, of others less than twice that."""
    travel = np.array([0.0, 5e-4, -2e-3, 0.6, -0.7, 1.3, 3.1, 5.1])
    wanted = np.array([1, 1, 5, 5, 6, 11, 25, 41])
    segments = segments_of(travel)
    assert np.all(segments >= wanted) and np.all(segments <= 2 * wanted) and segments[-1] == 41
    assert segments[:2].tolist() == [1, 1] and len(set(segments.tolist())) <= 5
    assert segments_of(np.array([1e3, 0.0])).tolist() == [64, 1] and segments_of(np.zeros(0)).tolist() == []


def test_detections_do_not_depend_on_the_number_of_threads(movers):
    radar, paths, cube = movers
    spectrum = ep.range_doppler(ep.add_noise(cube, radar, seed=2), radar)
    found = []
    try:
        for count in (1, 4):
            ep.set_num_threads(count)
            found.append(ep.detect(spectrum, radar, method="os", paths=paths))
    finally:
        ep.set_num_threads(0)
    for name in ("range", "velocity", "azimuth", "power", "noise", "object"):
        np.testing.assert_array_equal(getattr(found[0], name), getattr(found[1], name))


@pytest.fixture(scope="module", params=[{}, {"extra_idle": [0.0, 7e-6, 3e-6]}, {"frequency_steps": [0.0, 30e6, 11e6]}],
                ids=["even", "staggered", "hopping"])
def rotor(request):
    """(radar, paths, signal) of a drone whose rotors turn once during the frame."""
    chirps = ep.ChirpSequence(start_frequency=24e9, bandwidth=0.25e9, num_samples=64, sampling_rate=5e6, num_chirps=512,
                              chirp_interval=20e-6, **request.param)
    radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 2))], receivers=[ep.Antenna((0, 0.006, 2)), ep.Antenna((0, 0, 2))],
                     transmit_power=20.0)
    scene = ep.Scene()
    scene.add(ep.actors.drone(), name="drone", position=(12, 0, 6))
    paths = ep.trace(scene, radar, num_rays=400)
    return radar, paths, ep.synthesize(paths, radar)


def test_blades_that_turn_during_the_frame_make_the_cells_of_their_signal(rotor):
    """Fields of paths in cells over 40 dB, against the map of their signal; a parabola of the phase put half of them 3 dB off."""
    radar, paths, cube = rotor
    spectrum = ep.range_doppler(cube, radar)
    power = np.mean(np.abs(spectrum.values) ** 2, axis=(0, 1))
    cells = np.argwhere(power > 1e-4 * power.max())
    cells = cells[::len(cells) // 70]
    fields = fields_of(paths, spectrum)
    fields.evaluate(cells)
    made = np.array([np.mean(np.abs(fields.fields(cell)[1].sum(axis=1)) ** 2) for cell in cells])
    ratio_db = 10.0 * np.log10(made / power[tuple(cells.T)])
    assert len(cells) > 50 and np.mean(np.abs(ratio_db) < 3.0) > 0.95 and abs(np.median(ratio_db)) < 0.2


@pytest.mark.parametrize("speed", [4.0, 15.0, 60.0])
def test_what_goes_on_in_range_leaves_other_velocities_to_weaker_echoes(speed):
    """A ball that goes on by 0.2, 0.7 and 3 bins of range in the frame, in all cells within three bins of its range."""
    radar = radar_with(num_chirps=128, chirp_interval=60e-6)
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.1), name="ball", material="metal", smooth=True, position=(12, 0, 0), speed=speed)
    paths = ep.trace(scene, radar, num_rays=500, max_bounces=1)
    spectrum = ep.range_doppler(ep.synthesize(paths, radar), radar)
    power = np.mean(np.abs(spectrum.values) ** 2, axis=(0, 1))
    of_ball, middle = np.unravel_index(power.argmax(), power.shape)
    beside = [k for k in range(128) if 4 < (k - of_ball) % 128 < 124]  # the main lobe, whose error is the table's
    cells = np.array([(k, distance) for k in beside for distance in range(middle - 3, middle + 4)])
    fields = fields_of(paths, spectrum)
    fields.evaluate(cells)
    made = np.array([np.mean(np.abs(fields.fields(cell)[1].sum(axis=1)) ** 2) for cell in cells])
    error = np.abs(np.sqrt(made) - np.sqrt(power[tuple(cells.T)]))
    assert error.max() < FAR_AWAY * np.sqrt(power.max())


def test_faces_that_flash_beside_the_middle_of_the_frame_make_the_cells_of_their_signal():
    """A metal box that looks at the radar 0.4 frames after the middle, when the fields of its rays were far weaker."""
    radar, spin, scene = radar_with().replace(transmit_power=10.0), 80.0, ep.Scene()
    flash = radar.middle_of_frame(0.0) + 0.4 * radar.frame_duration
    scene.add(ep.actors.box((0.5, 0.3, 0.4)), name="box", material="metal", position=(8, 0, 0), yaw=np.pi - spin * flash,
              motion=ep.LinearMotion(angular_velocity=(0, 0, spin)))
    paths = ep.trace(scene, radar, num_rays=1000, max_bounces=1)
    cube = ep.synthesize(paths, radar)
    spectrum = ep.range_doppler(cube, radar)
    power = np.mean(np.abs(spectrum.values) ** 2, axis=(0, 1))
    cells, fields = np.argwhere(power > 1e-2 * power.max()), fields_of(paths, spectrum)
    fields.evaluate(cells)
    made = np.array([np.mean(np.abs(fields.fields(cell)[1].sum(axis=1)) ** 2) for cell in cells])
    assert len(cells) > 50 and np.abs(10.0 * np.log10(made / power[tuple(cells.T)])).max() < 1.0
    found = ep.detect(ep.range_doppler(ep.add_noise(cube, radar, seed=1), radar), radar, paths=paths)
    assert len(found) > 5 and set(found.object) == {"box"} and not found.is_noise.any()


def test_points_of_reflection_that_swing_make_the_cells_of_their_signal():
    """A chest that breathes under an unmarked roof: both ways lead over the roof, where the ways of the record hardly change, and
    the phase of the amplitude has what its points of reflection slide by."""
    times, wavelength = np.arange(-0.5, 12.0, 0.05), ep.speed_of_light / 60e9
    chirps = ep.ChirpSequence(start_frequency=60e9, bandwidth=4e9, num_samples=128, sampling_rate=2e6, num_chirps=200,
                              chirp_interval=0.05)
    radar = ep.Radar(chirps, transmitters=[ep.Antenna()], receivers=[ep.Antenna((0, 0.5 * wavelength, 0))], transmit_power=0.01,
                     position=(0.3, 0, 1.25), pitch=np.pi / 3)
    scene = ep.Scene()
    scene.add(ep.actors.ellipsoid((0.08, 0.11, 0.2)), name="torso", material="metal", smooth=True, position=(0.62, 0.4, 0.66),
              motion=ep.KeyframeMotion(times, 0.5e-3 * np.sin(0.8 * np.pi * times)[:, None] * (1, 0, 0)))
    scene.add(ep.actors.box((2.6, 1.5, 0.1)), name="roof", material="metal", position=(0.5, 0, 1.35))
    paths = ep.trace(scene, radar, num_rays=10_000, max_bounces=3).select("T 'roof' 'torso' 'roof' R")
    spectrum = ep.range_doppler(ep.synthesize(paths, radar), radar)
    power = np.abs(spectrum.values[0, 0]) ** 2
    cells, fields = np.argwhere(power > 1e-4 * power.max()), fields_of(paths, spectrum)
    fields.evaluate(cells)
    made = np.array([np.abs(fields.fields(cell)[1].sum(axis=1)[0]) ** 2 for cell in cells])
    assert paths.num_paths and len(cells) > 20
    assert np.abs(10.0 * np.log10(made / power[tuple(cells.T)])).max() < 1.0


def test_detections_of_blades_are_no_noise(rotor):
    radar, paths, cube = rotor
    noisy = ep.range_doppler(ep.add_noise(cube, radar, seed=4), radar)
    found = ep.detect(noisy, radar, paths=paths)
    echoes, cells = (np.mean(np.abs(one.values) ** 2, axis=(0, 1))[tuple(found.cells.T)]
                     for one in (ep.range_doppler(cube, radar), noisy))
    made_by_echoes = echoes > 0.7 * cells
    assert np.sum(made_by_echoes) > 8 and not found.is_noise[made_by_echoes].any()
    assert set(found.object[made_by_echoes]) == {"drone"}


def test_how_strong_echoes_are_takes_few_bytes_where_channels_have_them_in_other_bins():
    """Antennas 0.4 m apart, of which each has an echo elsewhere: the strongest of each path is that of its signal by itself, and
    sizes alone are made of it, without the place and phase of all paths in all channels."""
    beams = [ep.Antenna((0, 0.4 * k, 0), pattern=ep.CosinePower(40.0), yaw=0.2 - 0.1 * k) for k in range(4)]
    radar = radar_with().replace(transmitters=beams[:2], receivers=beams)
    scene = ep.Scene()
    scene.add(ep.actors.box((1.0, 3.0, 1.0)), name="box", material=lambert(0.27), position=(8, 0, 0))
    paths = ep.trace(scene, radar, num_rays=20_000, max_bounces=1)
    fields = fields_of(paths, ep.range_doppler(ep.synthesize(paths, radar), radar))
    index = fields._echoes["index"]
    tracemalloc.start()
    try:
        power = fields._power
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    for place in (0, len(index) // 2, len(index) - 1):
        alone = ep.synthesize(paths.select(np.arange(paths.num_paths) == index[place]), radar)
        assert power[place] == pytest.approx(np.max(np.abs(alone[:, :, 32, 64]) ** 2), rel=1e-4, abs=0)
    assert peak < 200 * paths.num_paths  # bytes; with places and phases 350


def test_histories_are_the_signals_of_single_paths_in_the_chirps(movers):
    """Beside lengths and amplitudes one by one, and the phase of an echo half-way through the samples."""
    _, paths, _ = movers
    waveform, times = paths.radar.waveform, [0.0, 3e-4, 9e-4]
    index = np.array([5, 2, paths.num_paths - 1])
    fields, farther, largest = _core.echo_histories(paths, index, times, 5e-4)
    length, (middle,) = (paths.lengths(at, 0, 0)[:, index] for at in (times, [5e-4]))
    delay = length / ep.speed_of_light
    late = 0.5 * (waveform.num_samples - 1) / waveform.sampling_rate
    turns = (waveform.start_frequency + waveform.slope * late) * delay - 0.5 * waveform.slope * delay ** 2
    expected = np.conj(paths.amplitudes(times, 0, 0)[:, index]) * np.exp(2j * np.pi * turns)
    np.testing.assert_allclose(largest, np.abs(expected).max(axis=0), rtol=1e-12)
    np.testing.assert_allclose(fields * largest[:, None], expected.T, rtol=0, atol=SINGLE * largest.max())
    np.testing.assert_allclose(farther, (length - middle).T, rtol=SINGLE, atol=0)
    with pytest.raises(ValueError, match="^index: must lie in 0 to the number of paths"):
        _core.echo_histories(paths, [paths.num_paths], times, 5e-4)


@pytest.mark.parametrize("count", [1, 7, 8, 200])
def test_sums_over_rows_are_those_of_their_products(count):
    """Whatever other rows are asked for, also with weights that are 0 at either end or all over."""
    rng = np.random.default_rng(4)
    table, weights = (np.asarray(rng.normal(size=(n, count, 2)), np.float32).view(np.complex64)[..., 0] for n in (90, 3))
    weights[0, :count // 3] = weights[0, count - count // 4:] = weights[1] = 0.0
    rows = rng.integers(0, 90, 150).astype(np.int32)
    sums = _core.weighted_row_sums(table, rows, weights)
    off = np.abs(sums - weights.astype(complex) @ table[rows].T.astype(complex))
    assert np.all(off <= SINGLE * np.abs(weights) @ np.abs(table[rows]).T)
    np.testing.assert_array_equal(_core.weighted_row_sums(table, rows[7:8], weights), sums[:, 7:8])
    for wrong, words in ((np.array([90], np.int32), "^rows: "), (np.array([-1], np.int32), "^rows: ")):
        with pytest.raises(ValueError, match=words):
            _core.weighted_row_sums(table, wrong, weights)
    with pytest.raises(ValueError, match="^weights: "):
        _core.weighted_row_sums(table, rows, weights[:, :0])


def test_paths_of_cells_can_be_asked_for_again_after_an_interruption(movers, monkeypatch):
    """Ctrl-C while echoes are followed from chirp to chirp, as in a notebook, where the Detections go on."""
    radar, paths, cube = movers
    spectrum = ep.range_doppler(cube, radar)
    cell = np.unravel_index(_core.mean_power(spectrum).argmax(), spectrum.values.shape[2:])
    index, field = EchoFields(paths, spectrum).fields(cell)
    again = EchoFields(paths, spectrum)

    def interrupted(*_):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(_core, "echo_histories", interrupted)
        with pytest.raises(KeyboardInterrupt):
            again.fields(cell)
    found, made = again.fields(cell)
    np.testing.assert_array_equal(found, index)
    np.testing.assert_array_equal(made, field)
