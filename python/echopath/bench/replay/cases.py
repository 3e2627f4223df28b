"""What moves in the replay benchmark: scenes, and radars that suit them."""
from __future__ import annotations

import dataclasses

import echopath as ep

from ...actors import shapes

FREQUENCY = 77e9
CHIRPS = 128


@dataclasses.dataclass(frozen=True)
class Case:
    """name: key of the results; title: for people; scene; radar: one transmitter and receiver; max_bounces."""

    name: str
    title: str
    scene: object
    radar: object
    max_bounces: int = 3


def radar(*, transmitters=1, receivers=1, chirp_interval=60e-6, num_chirps=CHIRPS, motion=None):
    """Radar 1 m above the origin, receivers across y by half wavelengths, carried on by transmitters.

    chirp_interval: s
    """
    half = ep.speed_of_light / FREQUENCY / 2.0
    waveform = ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=1e9, num_samples=256, sampling_rate=20e6,
                                num_chirps=num_chirps, chirp_interval=chirp_interval)
    across = [ep.Antenna((0.0, half * receivers * i, 1.0)) for i in range(transmitters)]
    return ep.Radar(waveform, transmitters=across, receivers=[ep.Antenna((0.0, half * i, 1.0)) for i in range(receivers)],
                    motion=motion)


def all_cases() -> list[Case]:
    """The motions that a replay has to follow, from a walk to a rotor."""
    return [_person(), _car(), _wheel(), _rotor(), _guard_rail()]


def person_scene():
    """A person who walks toward the radar beside a wall."""
    scene = ep.Scene()
    scene.add(ep.actors.pedestrian(), name="person", position=(11.0, 0.5, 0.0), yaw=3.14159)
    scene.add(shapes.wall(40.0, 6.0), name="wall", position=(15.0, 3.0, 0.0),
              material=ep.Material(permittivity=5 - 0.3j, scattering=0.3, mirror=True))
    return scene


def _rough():
    return ep.Material(reflectivity=0.6, scattering=0.8)


def _person() -> Case:
    return Case("person", "walking person", person_scene(), radar())


def _car() -> Case:
    scene = ep.Scene()
    scene.add(None, name="car", position=(18.0, 2.0, 0.8),
              motion=ep.LinearMotion(velocity=(-8, 1, 0), angular_velocity=(0, 0, 0.8)))
    scene.add(shapes.box((4.4, 1.8, 1.0)), name="body", parent="car", material=_rough())
    scene.add(shapes.box((2.2, 1.6, 0.6)), name="cabin", parent="car", position=(-0.3, 0.0, 0.8), material=_rough())
    return Case("car", "turning car", scene, radar())


def _wheel() -> Case:
    scene = ep.Scene()
    scene.add(shapes.ellipsoid((0.33, 0.1, 0.3), edge=0.012), name="wheel", position=(10.0, 0.5, 0.4), material=_rough(),
              motion=ep.LinearMotion(velocity=(-6, 0, 0), angular_velocity=(0, 100, 0)))
    return Case("wheel", "wheel, 100 rad/s", scene, radar(chirp_interval=30e-6))


def _rotor() -> Case:
    scene = ep.Scene()
    scene.add(shapes.box((0.6, 0.04, 0.01)), name="rotor", position=(8.0, 0.0, 2.0), material=_rough(),
              motion=ep.LinearMotion(angular_velocity=(0, 0, 800)))
    return Case("rotor", "rotor, 800 rad/s", scene, radar(chirp_interval=20e-6), max_bounces=1)


def _guard_rail() -> Case:
    scene = ep.Scene()
    scene.add(shapes.box((60.0, 0.06, 0.3)), name="rail", position=(30.0, 3.0, 0.7),
              material=ep.Material(conductor=True, scattering=0.5))
    scene.add(shapes.box((4.4, 1.8, 1.2)), name="car", position=(25.0, -0.5, 0.8), material=_rough(),
              motion=ep.LinearMotion(velocity=(25, 0, 0)))
    return Case("guard_rail", "guard rail, ego 30 m/s", scene, radar(motion=ep.LinearMotion(velocity=(30, 0, 0))))
