"""Other radars that move, over walls that move, into receivers that move: phases chirp by chirp against images."""
import numpy as np
import pytest

import echopath as ep
from echopath.signals.interference_crossing import EDGE, Chirps, add_crossing
from support.radars import build_radar

C = ep.speed_of_light
RATE, COUNT, BANDWIDTH, NUM_CHIRPS, INTERVAL = 20e6, 128, 250e6, 64, 60e-6
SLOPE, F0 = BANDWIDTH * RATE / COUNT, 77e9
PHASE = 0.02      # rad: the parabola through the delays of a chirp, and the filter
LEVEL = 0.2       # dB: promised
WALL = 6.0        # m, to the left of both radars, when time is 0
START = 0.3       # s
RADAR = {"num_samples": COUNT, "bandwidth": BANDWIDTH, "num_chirps": NUM_CHIRPS, "chirp_interval": INTERVAL}


def victim(velocity=(0.0, 0.0, 0.0), **settings):
    return build_radar(**RADAR, motion=ep.LinearMotion(velocity=velocity), **settings)


def sender(velocity, **settings):
    """Parallel chirps from 30 m ahead."""
    return build_radar(**RADAR, position=(30, 0, 0), yaw=np.pi, motion=ep.LinearMotion(velocity=velocity), **settings)


def street(other, wall_speed=0.0, *, is_mirror=True):
    scene = ep.Scene(interferers=[ep.Interferer(radar=other, over="paths")])
    scene.add(ep.actors.plate(60.0, 10.0), name="wall", material=ep.Material.metal(mirror=is_mirror), position=(15, WALL, 0),
              yaw=-np.pi / 2, motion=ep.LinearMotion(velocity=(0.0, wall_speed, 0.0)))
    return scene


def received(scene, radar, **settings):
    settings = {"num_rays": 2000, "max_bounces": 1, "start_time": START, "noise_seed": None} | settings
    return ep.simulate(scene, radar, **settings).interference_cube


def image_distance(times, moving, standing, wall_speed):
    """m, from the image of one place behind the wall to another; velocities [3] of both in m/s."""
    wall = WALL + wall_speed * times
    seen = np.array([30.0, 0, 0]) + np.outer(times, moving)
    seen[:, 1] = 2.0 * wall - seen[:, 1]
    return np.linalg.norm(seen - np.outer(times, standing), axis=1)


def phase_errors(channel, tx=0, num_tx=1, **motion):
    """rad, of the middle sample of each chirp [chirp, sample] beside that of the image's delay, but for a constant."""
    middle = COUNT // 2
    time = START + (np.arange(len(channel)) * num_tx + tx) * INTERVAL + middle / RATE
    delay = image_distance(time, **motion) / C
    cycles = F0 * delay + SLOPE * delay * (middle / RATE - 0.5 * delay)
    turned = np.angle(channel[:, middle] * np.exp(-2j * np.pi * np.mod(cycles, 1.0)))
    return np.angle(np.exp(1j * (turned - turned[len(turned) // 2])))


MOTIONS = {"sender": dict(moving=(-20.0, 3.0, 0.0), standing=(0.0, 0.0, 0.0), wall_speed=0.0),
           "receiver": dict(moving=(0.0, 0.0, 0.0), standing=(15.0, -2.0, 0.0), wall_speed=0.0),
           "wall": dict(moving=(0.0, 0.0, 0.0), standing=(0.0, 0.0, 0.0), wall_speed=4.0),
           "all": dict(moving=(-20.0, 3.0, 0.0), standing=(15.0, -2.0, 0.0), wall_speed=4.0)}


@pytest.mark.parametrize("motion", MOTIONS.values(), ids=MOTIONS)
def test_a_mirror_turns_the_phase_as_the_image_moves(motion):
    cube = received(street(sender(motion["moving"]), motion["wall_speed"]), victim(motion["standing"]))
    errors = phase_errors(cube[0, 0], **motion)
    assert np.max(np.abs(errors)) < PHASE
    distance = image_distance(np.array([START]), **motion)[0]
    level = 0.01 * (C / F0 / (4 * np.pi * distance)) ** 2
    assert 10 * np.log10(np.mean(np.abs(cube[0, 0, :, COUNT // 2]) ** 2) / level) == pytest.approx(0.0, abs=LEVEL)


def test_its_line_stands_at_the_rate_of_the_image():
    motion = MOTIONS["all"]
    cube = received(street(sender(motion["moving"]), motion["wall_speed"]), victim(motion["standing"]))
    times = START + np.array([0.0, NUM_CHIRPS * INTERVAL])
    rate = np.diff(image_distance(times, **motion))[0] / (NUM_CHIRPS * INTERVAL)
    turned = np.unwrap(np.angle(cube[0, 0, 1:, COUNT // 2] / cube[0, 0, :-1, COUNT // 2]))
    expected = 2 * np.pi * (F0 + 0.5 * BANDWIDTH) * rate / C * INTERVAL
    assert np.angle(np.exp(1j * (turned.mean() - expected))) == pytest.approx(0.0, abs=0.01)


def test_every_channel_has_an_image_of_its_own():
    """Receivers 0.1 m apart hear transmitters 0.2 m apart: each pair by the distance of its own image."""
    motion = MOTIONS["sender"]
    half = 0.1
    other = build_radar(**RADAR, position=(30, 0, 0), motion=ep.LinearMotion(velocity=motion["moving"]),
                        transmitters=[ep.Antenna((0, 2 * half * m, 0)) for m in range(2)])
    radar = victim(receivers=[ep.Antenna((0, half * n, 0)) for n in range(2)])
    cube = received(street(other), radar)
    for rx in range(2):
        for tx in range(2):
            at = START + (np.arange(NUM_CHIRPS // 2) * 2 + tx) * INTERVAL + COUNT // 2 / RATE
            image = np.array([30, 2 * WALL - 2 * half * tx, 0]) + np.outer(at, [-20.0, -3.0, 0.0])
            delay = np.linalg.norm(image - [0, half * rx, 0], axis=1) / C
            cycles = F0 * delay + SLOPE * delay * (COUNT // 2 / RATE - 0.5 * delay)
            # The other radar takes turns with itself, this one has one transmitter: its chirps fall on every second slot.
            turned = np.angle(cube[0, rx, tx::2, COUNT // 2] * np.exp(-2j * np.pi * cycles))
            assert np.max(np.abs(np.angle(np.exp(1j * (turned - np.pi))))) < PHASE


def test_a_plate_that_is_no_mirror_does_as_its_points_do():
    """Physical optics over a plate of metal, a sum over its points, which all stand where they are hit."""
    motion = MOTIONS["sender"]
    scene = ep.Scene(interferers=[ep.Interferer(radar=sender(motion["moving"]), over="paths")])
    scene.add(ep.actors.plate(3.0, 3.0), name="wall", material=ep.Material.metal(), yaw=-np.pi / 2,
              position=(15 - 10 * START, WALL, 0))
    cube = received(scene, victim(), num_rays=30_000)
    assert np.max(np.abs(phase_errors(cube[0, 0], **motion))) < 0.2


def test_paths_of_other_antennas_are_refused():
    radar, other = victim(), sender((0.0, 0.0, 0.0))
    paths = ep.trace(street(other), ep.interference_radar(radar, other), num_rays=100)
    two = radar.replace(receivers=[ep.Antenna(), ep.Antenna((0, 0.1, 0))])
    with pytest.raises(ValueError, match="^paths: must be those of a trace by interference_radar"):
        ep.interference(two, other, paths)


LONG, SHORT = 300, (1, 3, 16, 32)  # samples: 16 are one block of the fine ones, fewer are less than one


@pytest.mark.parametrize("ratio, late, count", [
    *((ratio, late, LONG) for ratio, late in [(1.0, 0.0), (1.0, 2e-6), (1.0, -2e-6), (0.9, 0.0), (1.1, 3.3e-6), (-1.0, 0.0)]),
    *((1.0, 0.3e-6, count) for count in SHORT)])
def test_many_ways_are_the_sum_of_each(ratio, late, count):
    """Ways of 10 to 60 m that move by up to 100 m/s, added up one by one and sample by sample."""
    random = np.random.default_rng(2)
    chirps = Chirps(victim().waveform.replace(num_samples=count), F0, SLOPE, F0 + (1.0 - ratio) * SLOPE * 5e-6, ratio * SLOPE,
                    12e-6, late)
    begin, speed = random.uniform(10.0, 60.0, 40), random.uniform(-100.0, 100.0, 40) * (count > 1)
    duration = (count - 1) / RATE
    delay = np.array([begin + speed * share * duration for share in (0.0, 0.5, 1.0)]) / C
    amplitude = random.normal(size=40) + 1j * random.normal(size=40)
    amplitude[7] = 0.0
    fine = np.zeros(4 * (count + 2 * EDGE), complex)
    add_crossing(fine, chirps, delay, amplitude)
    expected, time = np.zeros(len(fine), complex), np.arange(len(fine)) / (4 * RATE) - EDGE / RATE
    outside = np.zeros(len(fine))  # the largest difference of frequency, as crossings fade beyond the band
    for way in range(40):
        sent = late + time - (begin[way] + speed[way] * time) / C
        cycles = F0 * time + 0.5 * SLOPE * time ** 2 - chirps.sent_start * sent - 0.5 * ratio * SLOPE * sent ** 2
        frequency = chirps.sent_start + ratio * SLOPE * (late + time - delay[1, way])
        heard = (late + time >= delay[1, way]) & (late + time < delay[1, way] + 12e-6)
        heard &= np.abs(F0 + SLOPE * time - frequency) <= 1.9 * RATE
        outside = np.maximum(outside, heard * np.abs(F0 + SLOPE * time - frequency))
        expected += np.where(heard, np.conj(amplitude[way]) * np.exp(2j * np.pi * np.mod(cycles, 1.0)), 0.0)
    assert fine.any() == expected.any()
    scale = np.sqrt(np.sum(np.abs(amplitude) ** 2))
    edges = (np.abs(fine - expected) > 5e-3 * scale) & (outside < 1.25 * RATE)
    assert np.count_nonzero(edges) <= 2  # a way whose end rounding puts on the next sample


def test_antennas_that_look_aside_on_a_radar_that_pitches_look_there_in_the_world():
    """Each turn in its order: the antenna's own nose up and left, then the radar's, about axes of the world."""
    def looking(yaw, pitch):
        c, s, n, m = np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch)
        return np.array([[c * n, -s, -c * m], [s * n, c, -s * m], [m, 0.0, n]])

    antenna = ep.Antenna((0.1, 0.2, 0.3), yaw=0.3, pitch=0.4)
    radar = build_radar((antenna,), (antenna,), position=(5, 6, 7), yaw=1.0, pitch=-0.7)
    found = ep.interference_radar(radar, radar)
    for one in (*found.transmitters, *found.receivers):
        w, *axis = one.orientation
        turned = [vector + 2 * np.cross(axis, np.cross(axis, vector) + w * vector) for vector in np.eye(3)]
        assert np.transpose(turned) == pytest.approx(looking(1.0, -0.7) @ looking(0.3, 0.4), abs=1e-12)
        assert one.position == pytest.approx([5, 6, 7] + looking(1.0, -0.7) @ [0.1, 0.2, 0.3])
