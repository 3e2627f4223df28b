"""What a certificate must not miss: surface that emerges, rotors of any speed; and new surface at keyframes, against traces."""
import numpy as np
import pytest

import echopath as ep
from echopath.bench import certificate
from support import shapes
from support.radars import build_radar, chirp_times

ROUGH = ep.Material(reflectivity=0.5, scattering=1.0)
SAME_DB = 0.4       # between powers of two independent sets of rays over a few per cent of an object: .2 dB found
SPECKLE_DB = 2.0    # of the mean of 12 realisations, twice what it scatters by
FOLLOWED = 1e-3     # relative, of the signal by polynomials: 4e-4 found, where what stands still errs by 2
CHIRPS = 64


def radar_of(num_chirps=CHIRPS, chirp_interval=200e-6, motion=None):
    return build_radar(num_samples=256, num_chirps=num_chirps, chirp_interval=chirp_interval, motion=motion)


def frame_of(radar):
    return radar.waveform.num_chirps * radar.waveform.chirp_interval


def cyclist_leaves_a_shadow():
    """A rough box that a van hides at mid-frame, and that is in sight for the last third."""
    scene = ep.Scene()
    scene.add(shapes.plate((0, 0, 0), (-1, 0, 0), 3.0), name="van", material=ROUGH, position=(10, -1.5, 0))
    # The van's edge, y = 0 at x = 10, hides all of the box at mid-frame; it moves .26 m until the end.
    scene.add(ep.actors.shapes.box((0.1, 0.1, 1.6)), name="cyclist", material=ROUGH, position=(15, -0.06 - 40 * 0.0085, 0),
              motion=ep.LinearMotion(velocity=(0, 40, 0)))
    return scene


def traced_power(scene, radar, name, every=8, num_rays=20000):
    """W, mean of what traces of every 8th chirp find of a rough object."""
    found = []
    for start in chirp_times(radar)[every // 2::every]:
        one = build_radar(num_samples=1, num_chirps=1, motion=radar.motion)
        paths = ep.trace(scene, one, num_rays=num_rays, max_bounces=1, seed=77, start_time=start)
        found.append(paths.select(f"T '{name}' R").power.sum())
    return np.mean(found)


def cube_power(cube):
    return np.mean(np.abs(cube) ** 2)


def test_an_object_that_leaves_a_shadow_is_named_with_its_power():
    radar, scene = radar_of(), cyclist_leaves_a_shadow()
    paths = ep.trace(scene, radar, num_rays=20000, max_bounces=1)
    assert paths.select("T 'cyclist' R").num_paths == 0
    report = ep.validity(paths)
    assert not report.ok and any("'cyclist' has no path" in text for text in report.warnings)
    assert "'cyclist' has no path" in str(report).split("reflection slides")[0]  # in the headline
    cyclist = report.objects["cyclist"]
    end = build_radar(num_samples=1, num_chirps=1)
    seen = ep.trace(scene, end, num_rays=50000, max_bounces=1, start_time=chirp_times(radar)[-1]).select("T 'cyclist' R")
    assert not cyclist.ok and not cyclist.has_paths and cyclist.in_range
    assert cyclist.seen_power == pytest.approx(seen.power.sum(), rel=0.1, abs=0)
    assert report.objects["van"].ok


def test_an_object_below_the_noise_need_not_be_right():
    radar, scene = radar_of(), cyclist_leaves_a_shadow()
    quiet = ep.Radar(radar.waveform, transmitters=radar.transmitters, receivers=radar.receivers, transmit_power=1e-13)
    report = ep.validity(ep.trace(scene, quiet, num_rays=20000, max_bounces=1))
    assert not report.objects["cyclist"].in_range and report.objects["cyclist"].ok


def rotor_scene(turns, radar, mesh=None, **keywords):
    scene = ep.Scene()
    scene.add(mesh or ep.actors.shapes.box((0.6, 0.04, 0.3)), name="rotor", material=ROUGH, position=(8, 0, 1),
              motion=ep.LinearMotion(angular_velocity=(0, 0, 2 * np.pi * turns / frame_of(radar))), **keywords)
    return scene


@pytest.mark.parametrize("turns", [0.5, 1, 2, 2.05, 4, 4.1, 8, 34])
def test_a_rotor_is_never_certified(turns):
    """A square rod shows the same face at both ends and in the middle of the frame: only places between tell."""
    radar = radar_of()
    scene = rotor_scene(turns, radar, ep.actors.shapes.box((0.2, 0.2, 1.0)))
    report = ep.validity(ep.trace(scene, radar, num_rays=4000, max_bounces=1))
    assert not report.ok and not report.objects["rotor"].ok, str(report)
    assert report.keyframes >= min(turns * 2 * np.pi / 0.2, 16)


def test_what_turns_too_fast_for_the_check_is_a_warning():
    radar = radar_of()
    report = ep.validity(ep.trace(rotor_scene(60, radar), radar, num_rays=2000, max_bounces=1))
    assert len(report.times) == 256 and any("turns up to 59" in text for text in report.warnings)


def test_what_swings_too_fast_for_the_check_is_not_said_to_turn_alone():
    radar = radar_of()
    times = np.linspace(-0.01, 1.01, 1001) * frame_of(radar)
    ways = 1e-3 * np.sin(2.0 * np.pi * 60.0 * times / frame_of(radar))[:, None] * (1, 0, 0)
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.3, 0.3), name="chest", material=ROUGH, position=(4, 0, 1), yaw=np.pi,
              motion=ep.KeyframeMotion(times, ways))
    told, = (text for text in ep.validity(ep.trace(scene, radar, num_rays=500, max_bounces=1)).warnings if "'chest'" in text)
    assert "goes to and fro" in told


def test_many_keys_within_a_frame_are_a_warning_about_keys():
    """A chest that goes 1 mm to and fro four times by 200 linear keys turns by no more than those four cycles."""
    radar = radar_of()
    times = np.linspace(-0.01, 1.01, 205) * frame_of(radar)
    ways = 1e-3 * np.sin(2.0 * np.pi * 4.0 * times / frame_of(radar))[:, None] * (1, 0, 0)
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.3, 0.3), name="chest", material=ROUGH, position=(4, 0, 1), yaw=np.pi,
              motion=ep.CurveMotion(ep.Curve(times, ways)))
    told, = (text for text in ep.validity(ep.trace(scene, radar, num_rays=500, max_bounces=1)).warnings if "'chest'" in text)
    assert told.startswith("'chest' goes from key to key so often") and "turns" not in told


def test_many_keys_of_the_radar_are_one_warning_about_the_radar():
    """A radar that shakes by 1 mm through 200 linear keys, before two chests at rest: neither of them goes anywhere."""
    radar = radar_of()
    times = np.linspace(-0.01, 1.01, 205) * frame_of(radar)
    ways = 1e-3 * np.sin(2.0 * np.pi * 4.0 * times / frame_of(radar))[:, None] * (1, 0, 0)
    radar = radar.replace(motion=ep.CurveMotion(ep.Curve(times, ways)))
    scene = ep.Scene()
    for side in (-1, 1):
        scene.add(ep.actors.plate(0.3, 0.3), name=f"chest {side}", material=ROUGH, position=(4, side, 1), yaw=np.pi)
    report = ep.validity(ep.trace(scene, radar, num_rays=500, max_bounces=1))
    told, = (text for text in report.warnings if "goes from key to key" in text)
    assert told.startswith("The radar goes from key to key so often") and len(report.times) == 256
    assert not any(found.ok for found in report.objects.values())


def test_slow_things_are_checked_at_few_times():
    radar = radar_of()
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.3), name="ball", material=ROUGH, position=(8, 0, 1), motion=ep.LinearMotion(velocity=(9, 3, 0)))
    report = ep.validity(ep.trace(scene, radar, num_rays=2000, max_bounces=1))
    ends = chirp_times(radar)[[0, -1]]
    places = (np.array(report.times) - ends[0]) / (ends[1] - ends[0])
    assert len(places) == 5 and places[:2].tolist() == [0.0, 1.0]
    assert np.allclose(places[2:], [(k * (np.sqrt(5) - 1) / 2) % 1 for k in (1, 2, 3)])


@pytest.mark.parametrize("kind", ["turns", "keys"])
def test_before_a_radar_that_moves_there_are_as_many_times_as_for_what_moves(kind):
    radar = radar_of()
    frame = frame_of(radar)
    times = np.linspace(-0.1 * frame, 1.1 * frame, 9)
    motion = (ep.LinearMotion(angular_velocity=(0, 0, 6.0 * np.pi / frame)) if kind == "turns" else
              ep.KeyframeMotion(times=times, translations=np.outer((times / frame) ** 3, (0.01, 0.0, 0.0)),
                                interpolation="linear"))

    def num_times(of_radar, of_ball):
        scene = ep.Scene()
        scene.add(ep.actors.sphere(0.3), name="ball", material=ROUGH, position=(8, 0, 1), motion=of_ball)
        paths = ep.trace(scene, radar_of(motion=of_radar), num_rays=500, max_bounces=1)
        return len(ep.validity(paths).times)

    assert num_times(motion, None) == num_times(None, motion) > 5


# --- how fast a motion turns, and replay of what returns to where it was ---

def oscillating(periods, times):
    return 1e-3 * np.sin(2 * np.pi * periods * times / times[-1])


def movers(periods, radar):
    """A box and {kind: motion} that come back as often as that within the frame."""
    mesh = ep.actors.shapes.box((0.3, 0.3, 0.3))
    times = np.linspace(0.0, frame_of(radar), 16 * periods + 1)
    way = oscillating(periods, times)
    angle = 2 * np.pi * periods * times / times[-1]
    spin = np.column_stack([np.cos(angle / 2), 0 * angle, 0 * angle, np.sin(angle / 2)])
    shake = np.asarray(mesh.vertices)[None] + way[:, None, None] * [1.0, 0.0, 0.0]
    return mesh, {"linear": ep.LinearMotion(angular_velocity=(0, 0, 2 * np.pi * periods / frame_of(radar))),
                  "spun keys": ep.KeyframeMotion(times=times, rotations=spin),
                  "shaken keys": ep.KeyframeMotion(times=times, translations=np.outer(way, [1, 0, 0])),
                  "vertices": ep.VertexSequence(times=times, vertices=shake)}


@pytest.mark.parametrize("kind", ["linear", "spun keys", "shaken keys", "vertices"])
@pytest.mark.parametrize("periods", [4, 8, 12])
def test_what_comes_back_a_whole_number_of_times_does_not_stand_still(periods, kind):
    """Four Chebyshev nodes stand at 0, 1/4, 3/4 and 1 of the frame: they see such a motion at rest."""
    radar = radar_of()
    mesh, kinds = movers(periods, radar)
    scene = ep.Scene()
    scene.add(mesh, name="body", material=ROUGH, position=(8, 0, 0), motion=kinds[kind])
    paths = ep.trace(scene, radar, num_rays=300, max_bounces=1)
    found, expected = ep.synthesize(paths, radar), ep.synthesize(paths, radar, evaluate="chirps")
    moved = ep.synthesize(paths, radar_of(num_chirps=1))
    assert np.abs(expected - moved).max() > 0.1 * np.abs(expected).max()  # it does move
    assert np.abs(found - expected).max() < FOLLOWED * np.abs(expected).max()


@pytest.mark.parametrize("periods", [3, 4])
def test_rates_are_those_of_the_motion(periods):
    radar = radar_of()
    frame = frame_of(radar)
    _, kinds = movers(periods, radar)
    true = 2 * np.pi * periods / frame
    assert kinds["linear"].turn_rate(0, frame) == pytest.approx(true, rel=1e-12)
    assert true <= kinds["spun keys"].turn_rate(0, frame) < 2 * true
    for kind in ("shaken keys", "vertices"):  # half a period from one turning point to the next, to a sample
        assert kinds[kind].turn_rate(0, frame) == pytest.approx(true, rel=0.2)


def test_what_goes_straight_on_does_not_turn():
    assert ep.LinearMotion(velocity=(30, -2, 1)).turn_rate(0, 1) == 0
    times = np.linspace(0, 1, 20)
    keys = ep.KeyframeMotion(times=times, translations=np.outer(times**2 + times, [1, -2, 0]))
    assert keys.turn_rate(0, 1) == 0
    mesh = ep.actors.shapes.box((1, 1, 1))
    grown = ep.VertexSequence(times=times, vertices=np.asarray(mesh.vertices)[None] * (1 + times)[:, None, None])
    assert grown.turn_rate(0, 1) == 0


def test_a_bound_of_keyed_rotations_holds_between_the_keys():
    rng = np.random.default_rng(3)
    times = np.sort(rng.uniform(0, 1, 12))
    angles = np.cumsum(rng.uniform(-2.5, 2.5, 12))
    axis = np.array([0.6, 0.0, 0.8])
    keys = ep.KeyframeMotion(times=times, rotations=[[np.cos(a / 2), *np.sin(a / 2) * axis] for a in angles])
    at = np.linspace(times[0], times[-1], 20001)
    turns = np.array([keys.at(t)[:3, :3] for t in at])
    steps = np.einsum("nji,njk->nik", turns[:-1], turns[1:])
    fastest = np.arccos(np.clip((np.trace(steps, axis1=1, axis2=2) - 1) / 2, -1, 1)).max() / (at[1] - at[0])
    assert fastest <= keys.turn_rate(times[0], times[-1]) * (1 + 1e-6)


# --- new surface at keyframes ---

def test_what_leaves_a_shadow_has_its_power_at_keyframes():
    radar, scene = radar_of(), cyclist_leaves_a_shadow()
    paths = ep.trace(scene, radar, num_rays=20000, max_bounces=1)
    select, expected = {"cyclist": "T 'cyclist' R"}, traced_power(scene, radar, "cyclist")
    assert expected > 0 and not ep.decompose(paths, radar, select)["cyclist"].any()
    found = []
    for seed in range(12):  # realisations of the random phases, each with one or two looks: their mean scatters by a quarter
        again = ep.trace(scene, radar, num_rays=4000, max_bounces=1, seed=seed)
        found.append(cube_power(ep.decompose(again, radar, select, retrace="invalid")["cyclist"]))
    assert 10 * np.log10(np.mean(found) / expected) == pytest.approx(0, abs=SPECKLE_DB)


def plate_field(points, area, normal, antennas, wavelength):
    """Physical optics of a metal plate by a sum over its points, sqrt(W) for 1 W and isotropic antennas."""
    ways = [point - points for point in antennas]
    length = [np.linalg.norm(way, axis=-1) for way in ways]
    cosine = np.abs(ways[0] @ normal) / length[0]
    phase = 2 * np.pi / wavelength * (length[0] + length[1])
    return np.sum(cosine * area / (length[0] * length[1]) * np.exp(-1j * phase)) / (4 * np.pi)


def test_a_plate_that_turns_into_its_flash_is_heard_once():
    """At mid-frame rays meet it, in the flash it has an image: either is the echo of the same surface, which nothing hid."""
    radar = build_radar(receivers=[(0, 0.05, 0)], num_samples=32, num_chirps=16, chirp_interval=1.5e-3, bandwidth=100e6,
                        start_frequency=24e9, transmit_power=1.0)
    rate, turn, side = 3.0, 0.08, 0.7
    begin = turn - rate * radar.middle_of_frame()
    scene = ep.Scene()
    scene.add(ep.actors.plate(side, side), name="plate", material="metal", position=(5, 0, 0), yaw=begin,
              motion=ep.LinearMotion(angular_velocity=(0, 0, rate)))
    at = (np.arange(300) + 0.5) / 300 * side - side / 2
    across, up = map(np.ravel, np.meshgrid(at, at))
    power = []
    for angle in begin + rate * chirp_times(radar):
        points = np.stack([5 - np.sin(angle) * across, np.cos(angle) * across, up], axis=-1)
        normal, antennas = np.array([np.cos(angle), np.sin(angle), 0]), np.array([[0, 0, 0], [0, 0.05, 0]])
        power.append(abs(plate_field(points, (side / 300)**2, normal, antennas, radar.waveform.wavelength))**2)
    paths = ep.trace(scene, radar, num_rays=20000, max_bounces=1)
    assert paths.num_paths > 1000 and ep.trace(scene, radar, num_rays=20000, start_time=-radar.middle_of_frame()).num_paths == 1
    report = ep.validity(paths)
    assert report.ok and report.new_surface_share == 0.0
    flash = np.array(power) > 0.1 * max(power)
    for keyframes in (4, 16):
        found = np.mean(np.abs(ep.synthesize(paths, radar, retrace="invalid", keyframes=keyframes)[0, 0])**2, axis=-1)
        np.testing.assert_allclose(10 * np.log10(found[flash] / np.array(power)[flash]), 0.0, atol=SAME_DB)


def test_the_image_in_a_plate_that_a_screen_uncovers_is_new():
    radar = build_radar(num_samples=32, num_chirps=16, chirp_interval=800e-6, bandwidth=100e6, start_frequency=24e9,
                        transmit_power=1.0)
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.7, 0.7), name="plate", material="metal", position=(5, 0, 0))
    scene.add(ep.actors.plate(2.0, 2.0), name="screen", material=ROUGH, position=(3, -0.4 - 150 * radar.middle_of_frame(), 0),
              motion=ep.LinearMotion(velocity=(0, 150, 0)))
    paths = ep.trace(scene, radar, num_rays=4000, max_bounces=1)
    cubes = [ep.decompose(paths, radar, {"plate": "T 'plate' R"}, retrace=retrace, keyframes=16)["plate"][0, 0]
             for retrace in ("invalid", "always")]
    whole = np.abs(cubes[1][:3])  # then the screen's edge comes between
    assert whole.min() > 0 and not cubes[1][8].any()
    np.testing.assert_allclose(cubes[0][:3], cubes[1][:3], rtol=0, atol=1e-3 * whole.max())


def open_tube(radar):
    """Metal, as a blade that turns through 0.16 rad about one end: the other opens toward the radar, which sees farther in."""
    angle = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    rings = np.stack([[0.05 * np.cos(angle), 0 * angle + y, 0.05 * np.sin(angle)] for y in np.linspace(0, 1, 11)])
    first = np.arange(48) + 48 * np.arange(10)[:, None]
    second = (np.arange(48) + 1) % 48 + 48 * np.arange(10)[:, None]
    triangles = np.concatenate([np.stack([first, first + 48, second], -1), np.stack([second, first + 48, second + 48], -1)])
    scene = ep.Scene()
    rate = 0.13 / frame_of(radar)
    scene.add(name="hub", position=(60, 0, 0), motion=ep.LinearMotion(angular_velocity=(0, 0, rate)))
    scene.add(ep.Mesh(rings.transpose(0, 2, 1).reshape(-1, 3), triangles.reshape(-1, 3)[:, ::-1]), name="blade", parent="hub",
              material="metal", smooth=True, yaw=0.036)
    return scene


def test_an_object_whose_power_alone_is_off_is_traced_more_than_once():
    """The echo of a tube and of its inside changes by 0.8 dB: no share of it is lost, and traces of each chirp know it."""
    radar = build_radar(num_samples=32, num_chirps=64, chirp_interval=160e-6, start_frequency=24e9, bandwidth=50e6,
                        transmit_power=10.0)
    paths = ep.trace(open_tube(radar), radar, num_rays=8000, max_bounces=1)
    report = ep.validity(paths)
    assert abs(report.objects["hub"].error_db) > 0.5 and report.keyframes == 16
    assert "of 1 parts" not in str(report)
    expected = cube_power(ep.synthesize(paths, radar, retrace="always", keyframes=64))
    found = [cube_power(ep.synthesize(paths, radar, retrace=retrace)) for retrace in ("never", "invalid")]
    error = np.abs(10 * np.log10(found / expected))
    assert error[0] > 0.5 and error[1] < 0.2


@pytest.mark.parametrize("turns", [0.3, 2.05])
def test_new_surface_is_counted_once(turns):
    """All sides of a box come into view in turn: at each keyframe the paths of all records have the power of a trace then."""
    radar = radar_of()
    scene = rotor_scene(turns, radar, ep.actors.shapes.box((0.4, 0.4, 0.6)))
    paths = ep.trace(scene, radar, num_rays=4000, max_bounces=1)
    cubes = [ep.synthesize(ep.trace(scene, radar, num_rays=4000, max_bounces=1, seed=seed), radar, retrace="invalid",
                           keyframes=16) for seed in range(6)]
    found = np.mean([cube_power(cube) for cube in cubes])
    expected = traced_power(scene, radar, "rotor", every=4)
    assert 10 * np.log10(found / expected) == pytest.approx(0, abs=3 * SAME_DB)
    assert paths.num_paths > 300


def test_speckle_of_new_surface_stays_on_its_material_points():
    """A plate at rest that a fast screen uncovers: its echo does not change from keyframe to keyframe once it is in sight."""
    radar = radar_of()
    scene = ep.Scene()
    scene.add(shapes.plate((0, 0, 0), (-1, 0, 0), 0.5), name="plate", material=ROUGH, position=(10, 0, 0))
    scene.add(shapes.plate((0, 0, 0), (-1, 0, 0), 0.6), name="screen", material=ROUGH, position=(6, -100 * 0.0064, 0),
              motion=ep.LinearMotion(velocity=(0, 100, 0)))
    paths = ep.trace(scene, radar, num_rays=4000, max_bounces=1)
    plate = ep.decompose(paths, radar, {"plate": "T 'plate' R"}, retrace="invalid", keyframes=16)["plate"][0, 0]
    late = plate[-8:]
    assert np.abs(late).max() > 0 and np.abs(late - late[0]).max() < 1e-9 * np.abs(late).max()
    assert np.abs(plate[:8]).max() > 0


def test_new_surface_has_the_same_bits_for_any_number_of_threads():
    radar, scene = radar_of(num_chirps=16, chirp_interval=800e-6), cyclist_leaves_a_shadow()
    paths = ep.trace(scene, radar, num_rays=4000, max_bounces=1)
    cubes = []
    try:
        for threads in (1, 3):
            ep.set_num_threads(threads)
            cubes.append((ep.synthesize(paths, radar, retrace="invalid", keyframes=4), str(ep.validity(paths))))
    finally:
        ep.set_num_threads(0)
    assert np.array_equal(cubes[0][0], cubes[1][0]) and cubes[0][1] == cubes[1][1]


# --- labels ---

def test_what_comes_into_view_is_not_called_occluded():
    radar, scene = radar_of(), cyclist_leaves_a_shadow()
    frame = ep.simulate(scene, radar, num_rays=4000, max_bounces=1, labels={"objects": ["van", "cyclist"]}, noise_seed=None,
                        guard=False)
    status = {label.name: label.status for label in next(iter(frame.labels.values())).objects}
    assert status["cyclist"] == "comes into view"
    hidden = radar_of(num_chirps=8)  # over before it leaves
    frame = ep.simulate(scene, hidden, num_rays=4000, max_bounces=1, labels={"objects": ["van", "cyclist"]}, noise_seed=None,
                        guard=False)
    status = {label.name: label.status for label in next(iter(frame.labels.values())).objects}
    assert status["cyclist"] == "occluded"


# --- the benchmark ---

def test_the_benchmark_finds_nothing_wrong_that_is_certified(tmp_path):
    results = certificate.run_certificate(tmp_path, quick=True)
    assert results["all"]["objects"] > 10 and results["all"]["wrong_uncertified"] == 0
    assert (tmp_path / "certificate.json").exists() and "certified" in "\n".join(certificate.describe(results))
