"""Frames, labels, detections and files of radars that other radars disturb."""
import copy
import pickle

import numpy as np
import pytest

import echopath as ep
from support.radars import build_radar
from support.signals.other_radars import TONE, victim

LEVEL, SHARE = 0.2, 0.01  # dB and relative: promised


def street(*others, wall=None, **settings):
    """A ball ahead of the radar, and other radars."""
    scene = ep.Scene(interferers=others, **settings)
    scene.add(ep.actors.sphere(0.2), name="ball", material=ep.Material.metal(), smooth=True, position=(8, 3, 0))
    if wall is not None:
        scene.add(ep.actors.plate(*wall["size"]), name="wall", material=ep.Material.metal(mirror=True),
                  position=wall["position"], yaw=wall["yaw"], motion=ep.LinearMotion(velocity=(0, wall.get("speed", 0.0), 0)))
    return scene


SLOW = {"num_chirps": 32, "transmit_power": 1.0}
IN_THE_WAY = {"size": (2.0, 2.0), "position": (20, 1.5, 0), "yaw": np.pi}
ASIDE = {"size": (40.0, 40.0), "position": (20, 8, 0), "yaw": -np.pi / 2}


def frame_of(scene, radar=None, **settings):
    return ep.simulate(scene, victim(**SLOW) if radar is None else radar, num_rays=2000, **{"max_bounces": 2} | settings)


def test_frames_have_what_other_radars_send():
    radar = victim(**SLOW)
    frame = frame_of(street(ep.Interferer(radar=TONE, offset=1e-7, over="direct")), start_time=0.3, noise_seed=None)
    expected = ep.interference(radar, TONE, start_time=0.3, offset=1e-7)
    np.testing.assert_array_equal(frame.interference_cube, expected)
    np.testing.assert_allclose(frame.noisy_cube, frame.cube + expected, rtol=1e-12)
    assert {one.name: one.modelled for one in frame.effects}["interference"]
    alone = frame_of(street(), start_time=0.3, noise_seed=None)
    np.testing.assert_array_equal(frame.cube, alone.cube)
    assert alone.interference_cube is None and alone.beside_spectra == {}


def test_effects_switch_it_off_and_need_it_to_force_it_on():
    off = frame_of(street(ep.Interferer(radar=TONE)), effects={"interference": False})
    assert off.interference_cube is None
    with pytest.raises(ValueError, match="interference.*needs Scene.interferers"):
        frame_of(street(), effects={"interference": True})


def test_the_direct_way_has_its_sign_beside_paths_of_field_vectors():
    """A receiver that is upside down has the opposite field of the direct way, as it has that of the paths over the ball."""
    upside_down = ep.Antenna(polarization=(0, 0, -1))
    for receiver, sign in ((ep.Antenna(), 1.0), (upside_down, -1.0)):
        radar = victim(**SLOW, receivers=(receiver,))
        both, paths = (frame_of(street(ep.Interferer(radar=TONE, over=over)), radar).interference_cube
                       for over in ("both", "paths"))
        assert paths.any()
        by_size = ep.interference(radar, TONE)
        np.testing.assert_allclose(both - paths, sign * by_size, atol=1e-9 * np.abs(by_size).max())


def test_rain_weakens_the_direct_way_once():
    """By the decibels per kilometre of one way of 40 m, those of the other radar's band."""
    rain, one = ep.Weather(rain_mm_per_hour=150.0, humidity=1.0), ep.Interferer(radar=TONE, over="direct")
    wet, clear = (frame_of(street(one, **settings), effects={"echoes of rain": False} if settings else {}).interference_cube
                  for settings in ({"weather": rain}, {}))
    lost_db = sum(rain.attenuation_db_per_km(TONE).values()) * 1e-3 * np.hypot(40, 3)
    assert lost_db > 1.0 and np.abs(wet) == pytest.approx(10.0 ** (-lost_db / 20.0) * np.abs(clear), rel=1e-9)


@pytest.mark.filterwarnings("ignore:interferers.0.. is never heard")
def test_what_stands_in_the_direct_way_hides_it():
    both = [frame_of(street(ep.Interferer(radar=TONE, over="direct"), wall=wall)).interference_cube
            for wall in (IN_THE_WAY, None)]
    assert not both[0].any() and both[1].any()


@pytest.mark.parametrize("turn", [0.0, 0.6])
@pytest.mark.parametrize("aside, sheets", [(0.0, 1), (0.1, 1), (0.1, 2), (2.0, 0)])
def test_sheets_in_the_direct_way_weaken_it(turn, aside, sheets):
    """Lossy foam, of which next to nothing is reflected, takes exp(-k n'' D / cos) of the field; the way goes through the common
    edge of both triangles, through one of them, or beside them."""
    thickness, permittivity = 0.02, 1.0 - 0.02j
    sender = build_radar(position=(20, 0, 0), yaw=np.pi)
    scene = ep.Scene(interferers=[ep.Interferer(radar=sender, over="direct")])
    foam = ep.Material(layers=[ep.Layer(thickness, permittivity)])
    for number in range(max(sheets, 1)):
        scene.add(ep.actors.plate(1.0, 1.0), name=f"foam{number}", material=foam, yaw=turn, position=(5 + number, aside, aside))
    received = frame_of(scene, build_radar(), noise_seed=None, guard=False).interference_cube
    share = np.linalg.norm(received) / np.linalg.norm(ep.interference(build_radar(), sender))
    loss = 2 * np.pi * 77e9 / ep.speed_of_light * thickness * -np.sqrt(permittivity).imag / np.cos(turn)
    assert 20 * np.log10(share) == pytest.approx(-20 * np.log10(np.e) * loss * sheets, abs=0.01)


@pytest.mark.parametrize("model, expected", [("auto", np.cos(0.7)), ("scalar", 1.0)])
def test_the_direct_way_has_what_the_polarisations_share(model, expected):
    """Malus: the cosine of the angle between linear polarisations, whichever way the antennas look."""
    radar = victim(**SLOW, receivers=[ep.Antenna(polarization=(0.0, np.sin(0.7), np.cos(0.7)))])
    sender = TONE.replace(position=(30, 0, 0), yaw=np.pi)
    plain, turned = (frame_of(street(ep.Interferer(radar=sender, over="direct")), one, noise_seed=None, guard=False,
                              polarization=model).interference_cube for one in (victim(**SLOW), radar))
    np.testing.assert_allclose(turned, expected * plain, atol=1e-9 * np.abs(plain).max())


def test_frames_hear_those_alone_whose_lifetimes_cover_them(tmp_path, recwarn):
    """Of three frames that last 1.9 ms each the second one alone lies between the begin and the end, beside which the other radar
    needs no motion."""
    way = ep.KeyframeMotion([0.09, 0.15], translations=np.zeros((2, 3)))
    coming = ep.Interferer(radar=TONE.replace(motion=way), over="direct", lifetime=(0.09, 0.15))
    scene = street(coming)
    sequence = ep.Sequence(scene, victim(**SLOW), frames=3, interval=0.096, num_rays=500, guard=False, noise_seed=None)
    sequence.save(tmp_path / "frames")
    assert not [str(one.message) for one in recwarn if "interferers" in str(one.message)]
    for frames in (sequence, ep.load_sequence(tmp_path / "frames")):
        assert [frame.interference_cube.any() for frame in frames] == [False, True, False]
        told = [next(one.reason for one in frame.effects if one.name == "interference") for frame in frames]
        assert [one == "no other radar is heard in the frame" for one in told] == [True, False, True]
        assert frames[0].scene.interferers == (coming,) == pickle.loads(pickle.dumps(frames[0].scene)).interferers
    with pytest.warns(RuntimeWarning, match=r"^interferers\[0\]: does not send from 0.2 to 0.2.* lifetime is 0.09 to 0.15 s"):
        assert not frame_of(scene, start_time=0.2, guard=False).interference_cube.any()


def test_sequences_warn_of_another_radar_whose_way_ends_among_their_frames():
    way = ep.Trajectory([(30, 3), (25, 3)], speed=10.0)
    parked = street(ep.Interferer(radar=TONE.replace(position=(0, 0, 0), motion=way.motion()), over="direct"))
    with pytest.warns(RuntimeWarning, match=r"^interferers\[0\] stands still in some of the frames, for want of a way"):
        ep.Sequence(parked, victim(**SLOW), frames=3, interval=0.48, num_rays=500, guard=False)


@pytest.mark.parametrize("lifetime", [(1.0, 1.0), (2.0, 1.0), (0.0, np.nan)])
def test_lifetimes_ascend(lifetime):
    with pytest.raises(ValueError, match="^lifetime: must be a begin and an end in s, ascending, got"):
        ep.Interferer(radar=TONE, lifetime=lifetime)


@pytest.mark.parametrize("height", [0.7, 0.73])
@pytest.mark.parametrize("polarization, sign", [((0, 0, 1), 1.0), ((0, 1, 0), -1.0)])
def test_a_metal_floor_adds_to_the_direct_way_as_its_polarisation_asks(polarization, sign, height):
    """Two ways of an oncoming radar, direct and over the floor: |1 + sign r / r' e^{-jk(r' - r)}| of the direct field, with the
    sign of the field along the floor and across it."""
    antennas = [ep.Antenna(polarization=polarization)]
    slow = {"num_samples": 256, "bandwidth": 50e6, "transmitters": antennas, "receivers": antennas}
    radar, sender = build_radar(**slow, position=(0, 0, 0.5)), build_radar(**slow, position=(20, 0, height), yaw=np.pi)
    scene = ep.Scene(interferers=[ep.Interferer(radar=sender, offset=2e-6)])  # a beat amid the band
    scene.add(ep.Mesh([(-20, -30, 0), (60, -30, 0), (60, 30, 0), (-20, 30, 0)], [[0, 1, 2], [0, 2, 3]]), name="floor",
              material=ep.Material.metal(mirror=True))
    found = frame_of(scene, radar, noise_seed=None, guard=False).interference_cube[0, 0, 0, 100]
    slope, first = radar.waveform.slope, radar.waveform.start_frequency
    k = 2 * np.pi / ep.speed_of_light * (first + slope * (100 / radar.waveform.sampling_rate - 2e-6))
    ways = np.hypot(20.0, np.array([height - 0.5, height + 0.5]))
    expected = abs(np.sum(np.array([1.0, sign]) * np.exp(-1j * k * ways) / ways)) * ep.speed_of_light / first / (4 * np.pi) * 0.1
    assert 20 * np.log10(abs(found) / expected) == pytest.approx(0.0, abs=LEVEL)


def test_other_radars_are_heard_whichever_of_their_antennas_looks_at_the_scene():
    """The one that looks at a rough wall as the first or the second of two: speckle of other phases, of the same power."""
    beams = [ep.Antenna((0, 0.01 * n, 0), yaw=side * np.pi / 2, pattern=ep.CosinePower(8)) for n, side in enumerate((1, -1))]
    scene, powers = ep.Scene(), []
    rough = ep.Material(reflectivity=0.5, scattering=1.0)
    scene.add(ep.actors.wall(60.0, 6.0), name="wall", material=rough, position=(10, 8, -3))
    for antennas in (beams, beams[::-1]):
        sender = build_radar(transmitters=antennas, num_chirps=4, num_samples=128, position=(20, 0, 0))
        scene.interferers = [ep.Interferer(radar=sender, over="paths")]
        frame = frame_of(scene, build_radar(num_chirps=8, num_samples=128), noise_seed=None, guard=False)
        powers.append(np.mean(np.abs(frame.interference_cube) ** 2))
    assert 10 * np.log10(powers[1] / powers[0]) == pytest.approx(0.0, abs=3.0)


def test_slants_of_45_degrees_to_the_same_side_do_not_hear_each_other_ahead():
    """As radars of oncoming traffic are built: seen from one, the slant of the other is that to the other side."""
    slant = [ep.Antenna(polarization=np.array((0.0, 1.0, 1.0)) / np.sqrt(2.0))]
    ahead, behind = (victim(**SLOW, transmitters=slant, receivers=slant, position=(x, 0, 0), yaw=yaw)
                     for x, yaw in ((30, np.pi), (-30, 0.0)))
    heard = [np.linalg.norm(ep.interference(victim(**SLOW, receivers=slant), one)) for one in (ahead, behind)]
    upright = ep.interference(victim(**SLOW), victim(**SLOW, position=(30, 0, 0)))
    assert heard[1] == pytest.approx(np.linalg.norm(upright), rel=1e-6)
    assert heard[0] < 1e-9 * heard[1]


def test_a_wall_brings_another_radar_from_its_image_into_a_frame():
    """A conductor 8 m aside: over the paths of the scene as direct from the image, 13 m beyond it."""
    over = frame_of(street(ep.Interferer(radar=TONE, over="paths"), wall=ASIDE), max_bounces=1).interference_cube
    image = ep.interference(victim(**SLOW), TONE.replace(position=(40, 13, 0)))
    assert 10 * np.log10(np.mean(np.abs(over) ** 2) / np.mean(np.abs(image) ** 2)) == pytest.approx(0.0, abs=LEVEL)
    both = frame_of(street(ep.Interferer(radar=TONE), wall=ASIDE), max_bounces=1).interference_cube
    np.testing.assert_allclose(both, over + ep.interference(victim(**SLOW), TONE), atol=1e-12 * np.abs(both).max())


def test_walls_that_move_bring_it_from_where_they_are():
    """After 0.96 s (16 000 chirps) at 2 m/s the wall is 9.92 m aside, and the image 16.84 m."""
    moving = street(ep.Interferer(radar=TONE, over="paths"), wall=ASIDE | {"speed": 2.0})
    over = frame_of(moving, max_bounces=1, start_time=0.96).interference_cube
    image = ep.interference(victim(**SLOW), TONE.replace(position=(40, 16.84, 0)), start_time=0.96)
    steady = [np.fft.fft(cube[0, 0, 0, 64:]) for cube in (over, image)]
    assert np.abs(steady[0]).argmax() == np.abs(steady[1]).argmax()
    assert 10 * np.log10(np.mean(np.abs(over) ** 2) / np.mean(np.abs(image) ** 2)) == pytest.approx(0.0, abs=LEVEL)


def test_an_object_below_another_radar_is_not_what_is_detected():
    """A plate where the line stands, 20 dB weaker: the detection there is of the other radar, and of no object."""
    scene = street(ep.Interferer(radar=TONE, over="direct"))
    scene.add(ep.actors.plate(0.2, 0.2), name="plate", material=ep.Material(reflectivity=1.0, scattering=1.0),
              position=(19.0, -6.44, 0), yaw=2.8)
    for parts in (None, {"plate": "T 'plate' R"}):
        found = frame_of(scene, detections=True, parts=parts).detections
        strongest = found.power.argmax()
        assert found.range[strongest] == pytest.approx(20.0, abs=0.3)
        assert (found.part[strongest], found.object[strongest]) == ("interference", "")
        assert len(found.paths(int(strongest))[0]) > 0  # the plate's echoes are in the cell


def test_labels_and_detections_of_frames_name_it(tmp_path):
    """The line of a parallel chirp stands at half the distance: one way instead of there and back."""
    scene = street(ep.Interferer(radar=TONE, over="direct"))
    frame = frame_of(scene, parts={"ball": "T 'ball' R"}, labels=True, detections=True)
    labels = frame.labels["parts"]
    assert labels.part_names == ["ball", "other", "interference"] and len(labels.part_received) == 3
    at = np.abs(labels.range - np.hypot(40, 3) / 2).argmin()
    line = labels.mask[:, at] & (labels.dominant[:, at] == 2)
    assert line.any() and np.all(labels.object_map[:, at][line] == -1)
    assert labels.part_received[2].power == pytest.approx(np.mean(np.abs(frame.interference_cube) ** 2), rel=1e-12)
    found = frame.detections
    strongest = found.power.argmax()
    assert (found.part[strongest], found.object[strongest], bool(found.is_noise[strongest])) == ("interference", "", False)
    assert "ball" in found.part and set(found.object[found.part == "ball"]) == {"ball"}
    assert ep.annotate_frame(frame)["parts"] == labels
    ep.save_frame(frame, tmp_path / "frame.h5")
    again = ep.load_frame(tmp_path / "frame.h5")
    np.testing.assert_array_equal(again.interference_cube, frame.interference_cube)
    np.testing.assert_array_equal(again.noisy_cube, frame.noisy_cube)
    assert again.labels["parts"] == labels and again.detections == found
    assert again.scene.interferers == scene.interferers


def test_detections_without_parts_name_it_too():
    found = frame_of(street(ep.Interferer(radar=TONE, over="direct")), detections=True).detections
    strongest = found.power.argmax()
    assert found.part[strongest] == "interference" and found.object[strongest] == "" and not found.is_noise[strongest]
    assert set(found.object) == {"", "ball"} and set(found.part[found.object == "ball"]) == {""}


def test_leakage_and_rain_are_parts_of_their_own():
    leaky = victim(**SLOW, receiver=ep.Receiver(leakage_db=[[-60.0]], leakage_delay=2e-9))
    frame = frame_of(street(weather=ep.Weather(rain_mm_per_hour=50.0)), leaky, labels=True, detections=True)
    assert frame.labels["parts"].part_names == ["other", "rain", "leakage"]
    found = frame.detections
    nearest = found.range.argmin()
    assert found.part[nearest] == "leakage" and found.range[nearest] == pytest.approx(0.3, abs=0.15)  # c 2 ns / 2
    with pytest.raises(ValueError, match="^parts: must not be named 'rain'"):
        frame_of(street(), parts={"rain": "T . R"})


def test_errors_of_shares_know_what_no_path_makes():
    frame = frame_of(street(ep.Interferer(radar=TONE, over="direct")), labels={"errors": True}, batches=4)
    labels = frame.labels["parts"]
    np.testing.assert_allclose(labels.mean_power[1], labels.power[1], rtol=1e-9)
    assert not labels.power_error[1].any() and labels.mean_share[1].max() > 0.9


def test_sequences_and_files_keep_it(tmp_path):
    moving = TONE.replace(motion=ep.LinearMotion(velocity=(-10, 0, 0)))
    scene = street(ep.Interferer(radar=moving, offset=2e-7, interval=0.06))
    sequence = ep.Sequence(scene, victim(**SLOW), frames=2, interval=0.12, num_rays=500, labels=True, detections=True)
    first, second = sequence
    assert second.interference_cube.any() and not np.array_equal(first.interference_cube, second.interference_cube)
    spectrogram = ep.spectrogram(sequence, part="interference", window_length=16)
    cubes = ep.spectrogram([first.interference_cube, second.interference_cube], victim(**SLOW), window_length=16,
                           start_times=[0.0, 0.12])
    np.testing.assert_array_equal(spectrogram.power, cubes.power)
    sequence.save(tmp_path / "all")
    stored = ep.load_sequence(tmp_path / "all")
    assert stored.scene.interferers == scene.interferers
    np.testing.assert_array_equal(stored[1].interference_cube, second.interference_cube)
    other = ep.Sequence(street(ep.Interferer(radar=moving, interval=0.06)), victim(**SLOW), frames=2, interval=0.12,
                        num_rays=500, labels=True, detections=True)
    with pytest.raises(ValueError, match="path: must be new, or of this sequence .interferers/0 offset differs"):
        other.save(tmp_path / "all")


def test_other_radars_are_scattered_by_the_points_that_a_sequence_keeps():
    """"auto" is "surface" in sequences, for the ways of other radars, too: their speckle goes on from frame to frame."""
    scene = ep.Scene(interferers=[ep.Interferer(radar=TONE, offset=1e-7, over="paths")])
    scene.add(ep.actors.plate(2.0, 2.0), name="rough", material=ep.Material(reflectivity=0.5, scattering=1.0),
              position=(20, -6, 0), yaw=0.5 * np.pi)
    kept, anew = (ep.Sequence(scene, victim(**SLOW), frames=1, interval=0.1, num_rays=2000, max_bounces=2, scatterers=scatterers,
                              guard=False)[0].interference_cube for scatterers in ("surface", "rays"))
    found = ep.Sequence(scene, victim(**SLOW), frames=1, interval=0.1, num_rays=2000, max_bounces=2, guard=False)[0]
    np.testing.assert_array_equal(found.interference_cube, kept)
    assert np.abs(anew - kept).max() > SHARE * np.abs(kept).max()


CHIRPS = "{start_frequency = 77e9, num_samples = 64, sampling_rate = 20e6, num_chirps = 8, chirp_interval = 2e-5, bandwidth = "
SCENE_FILE = f"""[radar]
waveform = {CHIRPS} 1e9}}
transmitters = [{{position = [0, 0, 0]}}]
receivers = [{{position = [0, 0, 0]}}]

[[interferers]]
waveform = {CHIRPS} 9e8}}
transmitters = [{{position = [0, 0, 0]}}]
position = [20, 0, 0]
yaw_deg = 180
speed = 3
offset = 1e-6
interval = 2e-4
over = "direct"
"""


def test_scene_files_have_other_radars(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE_FILE)
    scene = ep.load_scene(path).scene
    one, = scene.interferers
    assert (one.offset, one.interval, one.over, one.radar.waveform.bandwidth) == (1e-6, 2e-4, "direct", 9e8)
    assert one.lifetime is None
    np.testing.assert_allclose(one.radar.world_from_radar(1.0)[:3, 3], [17, 0, 0], atol=1e-9)
    path.write_text(SCENE_FILE + "lifetime = [1.0, inf]\n")
    assert ep.load_scene(path).scene.interferers[0].lifetime == (1.0, np.inf)
    path.write_text(SCENE_FILE.replace('over = "direct"', 'over = "all"'))
    with pytest.raises(ValueError, match=r"interferers\[0\].over"):
        ep.load_scene(path)
    path.write_text(SCENE_FILE.replace("interval = 2e-4", "interval = 1e-4"))
    with pytest.raises(ValueError, match=r"line \d+: interferers\[0\]: interval: must be at least 0.00014315 s"):
        ep.load_scene(path)


def test_scenes_hold_other_radars_as_values():
    one = ep.Interferer(radar=TONE, offset=1e-6)
    scene = street(one)
    for copied in (scene.copy(), pickle.loads(pickle.dumps(scene)), copy.deepcopy(scene)):
        assert copied.interferers == (one,)
    with pytest.raises(TypeError, match="^interferers: must be a list of Interferer"):
        scene.interferers = TONE
    with pytest.raises(TypeError, match="^radar: must be"):
        ep.Interferer(radar="other.cfg")


def test_what_takes_transmitters_apart_gives_the_interference_the_cells_that_the_map_shows():
    """By the empty shares of "ddm" noise and echoes decide which transmitter a cell of the interference is given to, which, being
    one tone in each chirp, leaves none empty. Where the map is far above the noise and no echo is near, it is interference."""
    waveform = ep.ChirpSequence(start_frequency=60e9, bandwidth=1.5e9, num_samples=128, sampling_rate=5e6, num_chirps=64,
                                chirp_interval=60e-6)
    half = 0.5 * waveform.wavelength
    radar = ep.Radar(waveform, transmitters=[ep.Antenna((0, 4 * half * n, 0)) for n in range(3)],
                     receivers=[ep.Antenna((0, half * n, 0)) for n in range(4)], transmit_power=0.015, multiplexing="ddm")
    other = radar.replace(position=(5.9, 1, 0.8), yaw=np.pi, multiplexing="tdm", waveform=waveform.replace(bandwidth=2e9))
    scene = ep.Scene(interferers=[ep.Interferer(radar=other, offset=3e-6)])
    scene.add(ep.actors.sphere(0.1), name="ball", material="metal", smooth=True, position=(4, 1, 0), speed=1.3)
    frame = ep.simulate(scene, radar, num_rays=1000, labels=True, detections=True, guard=False)
    maps = frame.spectrum, frame.beside_spectra["interference"]
    power, beside = (np.mean(np.abs(one.values) ** 2, axis=(0, 1)) for one in maps)
    is_far = np.abs(frame.range - np.hypot(4, 1)) > 0.6
    strong = (power > 30.0 * ep.noise_power(radar)) & is_far
    assert strong.sum() > 50
    assert np.abs(10.0 * np.log10(beside[strong] / power[strong])).max() < 2.0  # noise 15 dB below
    found = frame.detections
    assert len(found.range) > 40 and np.count_nonzero(found.is_noise) < 0.05 * len(found.range)
    assert np.all(found.part[found.object == ""][~found.is_noise[found.object == ""]] == "interference")
