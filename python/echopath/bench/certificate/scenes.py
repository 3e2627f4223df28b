"""Random scenes in which something moves: past each other, out of shadows, round and to and fro."""
from __future__ import annotations

import dataclasses

import numpy as np

import echopath as ep

from ...actors import shapes

FREQUENCY = 77e9        # Hz
CHIRPS = 64
CHIRP_INTERVAL = 400e-6  # s
HEIGHT = 1.0            # m, of the radar
FASTEST = 25.0          # m/s
KINDS = ("crossing", "emerging", "rotor", "turning car", "darting", "moving radar", "swinging plate", "two balls")


@dataclasses.dataclass(frozen=True)
class MovingScene:
    """kind: what is special about it; scene, radar, max_bounces: as traced."""

    kind: str
    scene: object
    radar: object
    max_bounces: int


def random_scene(seed: int) -> MovingScene:
    """The scene of that number; kinds come in turn. Noise is low, so that every object counts."""
    rng = np.random.default_rng(seed)
    kind = KINDS[seed % len(KINDS)]
    scene = ep.Scene()
    _stand_around(scene, rng)
    motion = None
    if kind == "moving radar":
        motion = ep.LinearMotion(velocity=(rng.uniform(5, FASTEST), rng.uniform(-1, 1), 0),
                                 angular_velocity=(0, 0, rng.uniform(-1.5, 1.5)))
        _screen_and_target(scene, rng, screen_speed=0.0, target_speed=0.0)
    else:
        {"crossing": _crossing, "emerging": _emerging, "rotor": _rotor, "turning car": _turning_car, "darting": _darting,
         "swinging plate": _swinging_plate, "two balls": _two_balls}[kind](scene, rng)
    return MovingScene(kind, scene, _radar(motion), 1 if rng.random() < 0.75 else 2)


def _radar(motion):
    waveform = ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=1e9, num_samples=128, sampling_rate=20e6,
                                num_chirps=CHIRPS, chirp_interval=CHIRP_INTERVAL)
    antenna = ep.Antenna((0.0, 0.0, HEIGHT))
    return ep.Radar(waveform, transmitters=[antenna], receivers=[antenna], motion=motion)


def _frame() -> float:
    return CHIRPS * CHIRP_INTERVAL


def _rough(rng):
    return ep.Material(reflectivity=rng.uniform(0.3, 0.8), scattering=1.0)


def _ray_side(rng, distance):
    """A place about that far away and the direction across the line of sight."""
    bearing = rng.uniform(-0.4, 0.4)
    return distance * np.array([np.cos(bearing), np.sin(bearing)]), np.array([-np.sin(bearing), np.cos(bearing)]), bearing


def _add(scene, name, mesh, material, place, *, velocity=(0, 0), height=HEIGHT, yaw=0.0, turning=0.0, motion=None,
         smooth=False):
    motion = motion or ep.LinearMotion(velocity=(*velocity, 0.0), angular_velocity=(0, 0, turning))
    scene.add(mesh, name=name, material=material, position=(*place, height), yaw=yaw, motion=motion, smooth=smooth)


def _stand_around(scene, rng):
    for index in range(rng.integers(1, 4)):
        place, _, _ = _ray_side(rng, rng.uniform(25, 40))
        scene.add(shapes.box((0.3, 0.3, 3.0)), name=f"pole_{index}", material=_rough(rng),
                  position=(place[0], place[1] + rng.choice([-12.0, 12.0]), 1.5))


def _screen_and_target(scene, rng, screen_speed, target_speed):
    """A van whose edge is near the line to a cyclist behind it: within what moves in a frame, on either side."""
    place, across, bearing = _ray_side(rng, rng.uniform(12, 30))
    share, half, width = rng.uniform(0.4, 0.8), rng.uniform(0.8, 2.4), rng.uniform(0.15, 0.9)
    reach = _frame() * max(abs(screen_speed) / share, abs(target_speed), 5.0)
    edge = rng.uniform(-0.6, 0.6) * reach + rng.choice([-1.0, 0.0, 1.0]) * width / 2
    _add(scene, "cyclist", shapes.box((width, width, 1.6)), _rough(rng), place, velocity=target_speed * across, yaw=bearing)
    _add(scene, "van", shapes.box((1.0, 2 * half, 2.4)), _rough(rng), share * (place + edge * across) - half * across,
         velocity=screen_speed * across, yaw=bearing)


def _crossing(scene, rng):
    _screen_and_target(scene, rng, screen_speed=rng.uniform(-FASTEST, FASTEST), target_speed=0.0)


def _emerging(scene, rng):
    _screen_and_target(scene, rng, screen_speed=0.0, target_speed=rng.uniform(3.0, FASTEST) * rng.choice([-1, 1]))


def _rotor(scene, rng):
    """A blade or a box, from standing almost still to a dozen turns; numbers of whole turns are among them."""
    turns = rng.choice([rng.uniform(0.01, 1.0), rng.uniform(1.0, 12.0), float(rng.integers(1, 13))])
    place, _, _ = _ray_side(rng, rng.uniform(8, 25))
    size = rng.choice([(1.2, 0.08, 0.03), (1.2, 0.3, 0.8), (0.6, 0.6, 0.6)])
    _add(scene, "rotor", shapes.box(tuple(map(float, size))), _rough(rng), place, height=1.8,
         yaw=rng.uniform(0, 6.3), turning=2 * np.pi * turns / _frame() * rng.choice([-1, 1]))


def _turning_car(scene, rng):
    place, across, bearing = _ray_side(rng, rng.uniform(10, 30))
    _add(scene, "car", shapes.box((4.4, 1.8, 1.4)), _rough(rng), place, velocity=rng.uniform(-15, 15) * across,
         yaw=bearing + rng.uniform(-0.3, 0.3) + rng.choice([0.0, np.pi / 2]), turning=rng.uniform(-6, 6))


def _darting(scene, rng):
    """Out of a shadow and back within the frame, or into one: keyframes whose ends show nothing of it."""
    place, across, bearing = _ray_side(rng, rng.uniform(12, 25))
    times = np.linspace(0.0, _frame() * 1.001, rng.integers(5, 14))
    way = rng.uniform(0.3, 1.2) * np.sin(np.pi * rng.integers(1, 5) * times / times[-1] + rng.choice([0, np.pi]))
    moves = np.column_stack([way[:, None] * across, 0 * way])
    kind = rng.choice(["cubic", "linear"])
    _add(scene, "child", shapes.box((0.3, 0.3, 1.2)), _rough(rng), place,
         motion=ep.KeyframeMotion(times=times, translations=moves, interpolation=str(kind)))
    half = rng.uniform(0.5, 1.2)
    edge = rng.uniform(-0.5, 0.5)
    _add(scene, "van", shapes.box((1.0, 2 * half, 2.4)), _rough(rng), 0.7 * (place + edge * across) - half * across, yaw=bearing)


def _swinging_plate(scene, rng):
    place, _, bearing = _ray_side(rng, rng.uniform(8, 20))
    _add(scene, "gate", shapes.plate(1.5, 1.0), _rough(rng), place, yaw=bearing + rng.uniform(-1.5, 1.5),
         turning=rng.uniform(-1.5, 1.5) / _frame())


def _two_balls(scene, rng):
    """Smooth and rough balls that pass each other."""
    place, across, _ = _ray_side(rng, rng.uniform(8, 20))
    radius = rng.uniform(0.2, 0.5)
    _add(scene, "metal ball", ep.actors.sphere(radius), ep.Material.metal(), place,
         velocity=rng.uniform(-FASTEST, FASTEST) * across, smooth=True)
    offset = rng.uniform(-1.0, 1.0) * 2 * radius * across
    _add(scene, "rough ball", ep.actors.sphere(radius), _rough(rng), 0.7 * place + 0.7 * offset,
         velocity=rng.uniform(-FASTEST, FASTEST) * across)
