"""Contributions to cells against maps that were made in other ways."""
from __future__ import annotations

import numpy as np
import pytest

import echopath as ep
from echopath.spectra.range_transform import range_profiles
from echopath_viewer.model import CellBox, Session, Signals, from_frame
from echopath_viewer.model.maps.attribution import REST, REST_RECEIVED, Attribution, chirp_weights

SUM = 1e-6       # of a cell's value, or of the largest contribution to it where they cancel
SYNTHESIS = 1e-6  # of the peak: what the synthesis promises of the sum of all amplitudes


def like(radar, **change):
    names = ("start_frequency", "bandwidth", "num_samples", "sampling_rate", "num_chirps", "chirp_interval")
    waveform = ep.ChirpSequence(**{name: getattr(radar.waveform, name) for name in names}, **change)
    return ep.Radar(waveform, transmitters=radar.transmitters, receivers=radar.receivers)


@pytest.fixture(scope="module")
def frame_attribution(frame):
    return Attribution(Signals(frame.paths, dict(frame.spectrum_settings)))


@pytest.mark.parametrize("settings", [{}, {"window": "rect", "zero_pad": 3}, {"window": ("chebyshev", 80.0), "zero_pad": 2}])
@pytest.mark.parametrize("falls", [False, True])
@pytest.mark.parametrize("real", [False, True])
def test_weights_of_a_cell_are_those_of_the_map(frame, settings, real, falls):
    radar = like(frame.radar, real=real)
    if falls:
        radar = radar.replace(waveform=radar.waveform.replace(bandwidth=-radar.waveform.bandwidth))
    rng = np.random.default_rng(5)
    cube = rng.normal(size=(2, 2, 32, 128)) + (0.0 if real else 1j * rng.normal(size=(2, 2, 32, 128)))
    values = ep.range_doppler(cube.astype(complex), radar, **settings).values
    profiles = range_profiles(cube, radar.waveform, **settings)
    for _ in range(40):
        tx, rx, velocity, distance = (int(rng.integers(0, size)) for size in values.shape)
        found = chirp_weights(radar.waveform, velocity, **settings) @ profiles[tx, rx, :, distance]
        assert found == pytest.approx(values[tx, rx, velocity, distance], rel=1e-10, abs=1e-14)


@pytest.mark.parametrize("settings", [{"window": "hann", "zero_pad": 1}, {"window": ("chebyshev", 80.0), "zero_pad": 2}])
def test_contributions_add_up_to_the_value_of_any_cell(frame, settings):
    rng = np.random.default_rng(6)
    attribution = Attribution(Signals(frame.paths, settings))
    whole = ep.range_doppler(ep.synthesize(frame.paths), frame.radar, **settings)
    peak = np.abs(whole.values).max()
    for _ in range(100):
        tx, rx, velocity, distance = (int(rng.integers(0, size)) for size in whole.values.shape)
        weights = np.zeros((2, 2), complex)
        weights[tx, rx] = 1.0
        cell = attribution.of_cell(whole, distance, velocity, weights)
        value = whole.values[tx, rx, velocity, distance]
        assert cell.value == value
        assert abs(sum(one.value for one in cell.contributions) - value) <= SUM * abs(value)
        told = sum(one.value for one in cell.contributions if one.name != REST)  # nothing is hidden in the rest
        assert abs(told - value) <= SUM * abs(value) + SYNTHESIS * peak
    strongest = np.argsort(-np.abs(whole.values).ravel())[:50]
    for tx, rx, velocity, distance in zip(*np.unravel_index(strongest, whole.values.shape)):
        weights = np.zeros((2, 2), complex)
        weights[tx, rx] = 1.0
        told = attribution.values(distance, velocity, weights).sum()
        value = whole.values[tx, rx, velocity, distance]
        assert abs(told - value) <= SUM * abs(value)


def test_a_ground_may_be_called_other():
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=600e6, num_samples=64, sampling_rate=10e6, num_chirps=4,
                                chirp_interval=1e-4)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0.01, 1))])
    found = []
    for name in ("ground", "other"):
        scene = ep.Scene()
        scene.add(ep.actors.plate(0.5, 0.5), name="plate", material="metal", position=(6.0, 0.0, 1.0))
        scene.add(ep.actors.ground(30.0), name=name, material="concrete")
        attribution = Attribution(Signals(ep.trace(scene, radar, num_rays=500), {}))
        assert set(attribution.things) == {"plate", name}
        found.append([group.name.replace(name, "ground") for group in attribution.groups])
    assert found[0] == found[1]


@pytest.mark.parametrize("num_samples, zero_pad", [(33, 1), (33, 2), (11, 3)])
def test_contributions_to_the_last_range_add_up_whatever_the_number_of_real_samples(num_samples, zero_pad):
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=600e6, num_samples=num_samples, sampling_rate=10e6, num_chirps=4,
                                chirp_interval=1e-4, real=True)
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.5, 0.5), name="plate", material="metal", position=(1.0, 0.0, 0.0))
    radar = ep.Radar(waveform, transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, 0.01, 0))])
    paths, settings = ep.trace(scene, radar, num_rays=500), {"window": "rect", "zero_pad": zero_pad}
    whole = ep.range_doppler(ep.synthesize(paths), radar, **settings)
    cell = Attribution(Signals(paths, settings)).of_cell(whole, len(whole.range) - 1, 2 * zero_pad, np.ones((1, 1)))
    assert cell.value == whole.values[0, 0, 2 * zero_pad, -1] != 0.0
    assert abs(cell.contributions[-1].value) <= SUM * abs(cell.value)


def test_contributions_to_a_beam_add_up(frame, frame_attribution):
    rng = np.random.default_rng(7)
    weights = rng.normal(size=(2, 2)) + 1j * rng.normal(size=(2, 2))
    spectrum = ep.range_doppler(ep.synthesize(frame.paths), frame.radar, **frame.spectrum_settings)
    velocity, distance = np.unravel_index(np.abs(spectrum.values[0, 0]).argmax(), spectrum.values.shape[2:])
    wanted = (weights * spectrum.values[:, :, velocity, distance]).sum()
    cell = frame_attribution.of_cell(spectrum, distance, velocity, weights)
    assert cell.value == pytest.approx(wanted) and abs(cell.contributions[-1].value) <= SUM * abs(wanted)


@pytest.mark.parametrize("thing", ["wall_left", "walker"])
def test_the_level_without_a_thing_is_that_of_the_paths_that_do_not_touch_it(frame, frame_attribution, thing):
    others = frame.paths.select(~np.asarray(ep.hits(thing).matches(frame.paths)))
    spectrum = ep.range_doppler(ep.synthesize(frame.paths), frame.radar, **frame.spectrum_settings)
    left = ep.range_doppler(ep.synthesize(others), frame.radar, **frame.spectrum_settings)
    for row in np.argsort(-np.abs(spectrum.values[0, 0]).ravel())[:30]:
        velocity, distance = np.unravel_index(row, spectrum.values.shape[2:])
        cell = frame_attribution.of_cell(spectrum, int(distance), int(velocity), np.array([[1, 0], [0, 0]]))
        wanted = 20 * np.log10(abs(left.values[0, 0, velocity, distance]) / abs(cell.value))
        assert dict(cell.without)[thing] == pytest.approx(wanted, abs=1e-3)


def test_a_cell_of_side_lobes_names_the_far_target_that_makes_it(frame):
    """Without a window the walker's lobes are the brightest far from it, where nothing else is in its parts."""
    direct = frame.paths.select(np.asarray(ep.Selection("T 'walker/head' R").matches(frame.paths)))
    settings = {"window": "rect", "zero_pad": 1}
    spectrum = ep.range_doppler(ep.synthesize(direct), frame.radar, **settings)
    velocity, near = np.unravel_index(np.abs(spectrum.values[0, 0]).argmax(), spectrum.values.shape[2:])
    far = int(near) + 40
    cell = Attribution(Signals(direct, settings)).of_cell(spectrum, far, int(velocity), np.array([[1, 0], [0, 0]]))
    first = cell.contributions[0]
    assert first.name.startswith("walker") and first.group.touched == {"walker"}
    assert first.group.peak_range == pytest.approx(spectrum.range[near])
    assert first.value == pytest.approx(cell.value, rel=1e-4, abs=0)


def test_noise_is_the_rest(frame, frame_attribution):
    noise = frame.spectrum.values[0, 0] - ep.range_doppler(ep.synthesize(frame.paths), frame.radar,
                                                            **frame.spectrum_settings).values[0, 0]
    cell = frame_attribution.of_cell(frame.spectrum, 100, 3, np.array([[1, 0], [0, 0]]))
    assert cell.contributions[-1].name == REST
    assert cell.contributions[-1].value == pytest.approx(noise[3, 100], rel=1e-3, abs=0)


def test_without_a_path_all_of_a_cell_is_the_rest(frame):
    with pytest.warns(RuntimeWarning, match="no mesh that takes part"):
        session = Session(from_frame(ep.simulate(ep.Scene(), frame.radar, num_rays=100, noise_seed=3)))
    session.attribution = Attribution(session.signals)
    session.select_cells(CellBox.around(7, 9), (7, 9))
    cell = session.cell_attribution()
    assert [one.name for one in cell.contributions] == [REST] and cell.without == ()
    assert cell.value == cell.strongest.value == session.parts.whole.spectrum.values[0, 0, 9, 7] != 0.0


ATTRIBUTION = "echopath_viewer.model.maps.attribution"


def test_where_memory_is_short_the_weakest_families_are_in_the_rest(frame, frame_attribution, monkeypatch):
    """Of the five that there is room for each gives a cell what it does beside all others; all of them add up."""
    size = 16 * 4 * frame.radar.waveform.num_chirps * frame.radar.waveform.num_samples
    num_mirrors = len(frame_attribution._mirror_names)
    monkeypatch.setattr(f"{ATTRIBUTION}.MAX_BYTES", (5 + num_mirrors) * size)
    some = Attribution(Signals(frame.paths, dict(frame.spectrum_settings)))
    families = ep.families(frame.paths)
    powers = np.array([power.power for power in ep.received_powers(frame.paths, families.family_of_path, len(families))])
    strongest = {families.families[number] for number in np.argsort(-powers)[:5]}
    assert len(families) > 5 and {group.family for group in some.groups} == strongest
    weights = np.array([[1, 0], [0, 0]])
    velocity, distance = np.unravel_index(np.abs(frame.spectrum.values[0, 0]).argmax(), frame.spectrum.values.shape[2:])
    of_some, of_all = (one.of_cell(frame.spectrum, distance, velocity, weights) for one in (some, frame_attribution))
    whole = {one.name: one.value for one in of_all.contributions}
    *told, rest = of_some.contributions
    for one in told:
        assert abs(one.value - whole[one.name]) <= SYNTHESIS * abs(of_all.value)
    assert sum(one.value for one in of_some.contributions) == pytest.approx(of_all.value, rel=SUM, abs=0)
    assert rest.name == f"{REST}, {len(families) - 5} weak families"
    for group in some.groups:  # the rays of a contribution are shown by this
        same, = (one for one in frame_attribution.groups if one.name == group.name)
        np.testing.assert_array_equal(some.paths_of(group), frame_attribution.paths_of(same))


def test_signals_of_which_not_one_has_room_are_refused(frame, monkeypatch):
    monkeypatch.setattr(f"{ATTRIBUTION}.MAX_BYTES", 1 << 17)
    with pytest.raises(ValueError, match="families: the signals of one and .* mirrors would take more than 0.00012207 GiB"):
        Attribution(Signals(frame.paths, dict(frame.spectrum_settings)))


def radar_at_once(radar, **change):
    """Its two transmitters send in each chirp, in three slots of velocity; change: of the waveform."""
    return radar.replace(waveform=radar.waveform.replace(num_chirps=30, **change), multiplexing="ddm")


def kinds_of_frames(frame) -> dict:
    """{kind: (scene, radar, settings of `simulate`)}: what their maps hold beside the signals of single transmitters."""
    other = ep.Interferer(radar=ep.Radar(frame.radar.waveform, transmitters=[ep.Antenna((8.0, 1.0, 0.0), yaw=np.pi)],
                                         receivers=[ep.Antenna((8.0, 1.0, 0.1))]), over="direct")
    return {
        "turns, padded": (frame.scene, frame.radar, {"zero_pad": 2}),
        "window for each axis": (frame.scene, frame.radar, {"window": ("rect", ("chebyshev", 60.0)), "zero_pad": 3}),
        "at once, told apart by Doppler": (frame.scene, radar_at_once(frame.radar), {}),
        "other radars": (ep.Scene(frame.scene, interferers=[other]), frame.radar, {}),
        "at once, and hop": (frame.scene, radar_at_once(frame.radar, frequency_steps=(0.0, 40e6, -25e6)), {}),
        "real samples": (frame.scene, like(frame.radar, real=True), {"window": "blackman_harris"}),
    }


@pytest.mark.parametrize("kind", ["turns, padded", "window for each axis", "at once, told apart by Doppler", "other radars",
                                  "at once, and hop", "real samples"])
def test_contributions_add_up_in_every_kind_of_frame(frame, kind):
    scene, radar, settings = kinds_of_frames(frame)[kind]
    made = ep.simulate(scene, radar, num_rays=1500, max_bounces=3, seed=4, **settings)
    session = Session(from_frame(made))
    session.attribution = Attribution(session.signals)
    without_noise = ep.range_doppler(made.cube, radar, **made.spectrum_settings).values
    peak, shape, rng = np.abs(without_noise).max(), made.spectrum.values.shape, np.random.default_rng(8)
    strongest = np.argsort(-np.abs(without_noise).ravel())[:50]
    for row in [*strongest, *rng.integers(0, without_noise.size, 50)]:
        tx, rx, velocity, distance = (int(index) for index in np.unravel_index(row, shape))
        if session.channel != (tx, rx):
            session.set_channel(tx, rx)
        session.select_cells(CellBox.around(distance, velocity), (distance, velocity))
        cell, value = session.cell_attribution(), made.spectrum.values[tx, rx, velocity, distance]
        assert abs(sum(one.value for one in cell.contributions) - value) <= SUM * abs(value)
        told, clean = sum(one.value for one in cell.contributions if one.name != REST), without_noise[tx, rx, velocity, distance]
        assert abs(told - clean) <= SUM * abs(clean) + (0.0 if row in strongest else SYNTHESIS * peak)


@pytest.mark.parametrize("steps", [{"frequency_steps": (0.0, 40e6, -25e6)}, {"bandwidth_steps": (0.0, 5e7)}])
def test_chirps_that_differ_leave_no_rest_without_noise(frame, steps):
    radar = frame.radar.replace(waveform=frame.radar.waveform.replace(**steps))
    made = ep.simulate(frame.scene, radar, num_rays=800, max_bounces=3, seed=4, noise_seed=None)
    attribution, values = Attribution(from_frame(made).signals), made.spectrum.values[1, 0]
    for row in np.argsort(-np.abs(values).ravel())[:30]:
        velocity, distance = (int(index) for index in np.unravel_index(row, values.shape))
        rest = attribution.of_cell(made.spectrum, distance, velocity, np.array([[0, 0], [1, 0]])).contributions[-1]
        assert rest.name == REST and abs(rest.value) <= SUM * abs(values[velocity, distance])


def test_the_rest_names_the_receiver_where_there_is_one(frame):
    """Families are what arrives at the antennas: a transmitter 6 dB down leaves half of each echo, minus, to the rest."""
    radar = frame.radar.replace(receiver=ep.Receiver(transmitter_gain_db=(-6.0, -6.0)))
    made = ep.simulate(frame.scene, radar, num_rays=800, max_bounces=3, seed=4, noise_seed=None)
    values = made.spectrum.values[0, 0]
    velocity, distance = (int(index) for index in np.unravel_index(np.abs(values).argmax(), values.shape))
    cell = Attribution(from_frame(made).signals).of_cell(made.spectrum, distance, velocity, np.array([[1, 0], [0, 0]]))
    assert cell.contributions[-1].name == REST_RECEIVED
    assert cell.contributions[-1].value == pytest.approx((1.0 - 10.0 ** 0.3) * cell.value, rel=1e-5, abs=0)
