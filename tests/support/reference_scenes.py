"""Small random scenes for the slow reference, and how far the simulator is from it."""
import dataclasses

import numpy as np

import echopath as ep

from .polarized_reference import PolarizedReference
from .reference import Reference

SPACING = 1e-3        # m, of the reference's cells: edges of shadows fall between them, a percent of a plate of 0.1 m
ROUGH_SPACING = 2e-3  # m, of rough plates: their powers add, but fringes of images are as narrow
NUM_RAYS, BATCHES = 2 ** 16, 8


@dataclasses.dataclass
class Deviation:
    """field, cube: relative to the reference; power: in standard errors, beyond one percent."""

    field: float = 0.0
    cube: float = 0.0
    power: float = 0.0


def random_radar(random, num_chirps=3):
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=1.5e8, num_samples=16, sampling_rate=20e6,
                                num_chirps=num_chirps, chirp_interval=1e-4)
    pattern = ep.CosinePower(2.0) if random.random() < 0.5 else ep.Isotropic(1.5)
    polarization = [(0.0, 0.0, 1.0), (0.0, 1.0, 0.0)][random.integers(2)]
    receiver = random.uniform(-0.05, 0.05, 3)
    return ep.Radar(waveform, transmitters=[ep.Antenna((0, 0, 0), pattern=pattern, polarization=polarization)],
                    receivers=[ep.Antenna(tuple(receiver), pattern=pattern, polarization=polarization)], transmit_power=0.1)


def random_material(random, *, rough):
    kinds = [{"conductor": True}, {"permittivity": complex(random.uniform(2, 8), -random.uniform(0, 1))},
             {"reflectivity": random.uniform(0.2, 1.0)}]
    return ep.Material(**kinds[random.integers(3)], scattering=random.uniform(0.6, 1.0) if rough else 0.0)


def random_scene(seed, *, rough):
    """Plates that nearly face the radar, often one in the shadow of another, moving, beside up to one large plane."""
    random = np.random.default_rng(seed)
    scene = ep.Scene()
    at = np.zeros(3)
    for k in range(random.integers(1, 4)):
        behind, at = at, np.array([random.uniform(5, 8), random.uniform(-1, 1), random.uniform(-0.8, 0.8)])
        if k > 0 and not rough:  # plates as small as these would hardly ever hide each other
            at = random.uniform(0.6, 0.8) * behind + np.array([0.0, *random.uniform(-0.04, 0.04, 2)])
        side = random.uniform(0.2, 0.4) if rough else random.uniform(0.06, 0.1)
        spread = 0.4 if rough else 0.005
        yaw = np.arctan2(at[1], at[0]) + random.uniform(-spread, spread)
        pitch = -np.arcsin(at[2] / np.linalg.norm(at)) + random.uniform(-spread, spread)
        motion = ep.LinearMotion(velocity=random.uniform(-5, 5, 3), angular_velocity=random.uniform(-2, 2, 3))
        scene.add(ep.actors.plate(side, side), name=f"plate{k}", material=random_material(random, rough=rough),
                  transform=_placed(at, yaw, pitch), motion=motion)
    if random.random() < 0.7:
        plane = random_material(random, rough=False).replace(mirror=True)
        if random.random() < 0.5:
            scene.add(ep.actors.ground((60.0, 30.0), z=-random.uniform(1.2, 2.0)), name="plane", material=plane)
        else:
            scene.add(ep.actors.wall(60.0, 30.0), name="plane", material=plane, position=(0, random.uniform(2, 3), -15.0))
    return scene, random_radar(random)


def _placed(at, yaw, pitch):
    """A plate at `at` whose front, -x, is turned up by `pitch` and left by `yaw`."""
    cy, sy, cp, sp = np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch)
    placement = np.eye(4)
    placement[:3, :3] = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]]) @ np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    placement[:3, 3] = at
    return placement


def coherent_deviation(seed):
    """Field at mid-frame and all samples of a random scene of smooth plates."""
    scene, radar = random_scene(seed, rough=False)
    return _coherent(scene, radar, Reference, "scalar")


def polarized_deviation(seed):
    """The same with field vectors and antennas of any two linear polarisations."""
    scene, radar = random_scene(seed, rough=False)
    random = np.random.default_rng(seed + 500)
    axes = random.normal(size=(2, 3)) * [0.3, 1.0, 1.0]
    antennas = [ep.Antenna(tuple(antenna.position), pattern=antenna.pattern, polarization=tuple(axis / np.linalg.norm(axis)))
                for antenna, axis in zip((radar.transmitters[0], radar.receivers[0]), axes)]
    radar = ep.Radar(radar.waveform, transmitters=antennas[:1], receivers=antennas[1:], transmit_power=radar.transmit_power)
    return _coherent(scene, radar, PolarizedReference, "jones")


def array_deviation(seed):
    """Samples of all channels of two transmitters and two receivers on a moving, turning radar."""
    scene, radar = random_scene(seed, rough=False)
    random = np.random.default_rng(seed + 900)
    pattern, polarization = radar.transmitters[0].pattern, tuple(radar.transmitters[0].polarization)
    places = random.uniform(-0.02, 0.02, (4, 3))
    antennas = [ep.Antenna(tuple(place), pattern=pattern, polarization=polarization) for place in places]
    motion = ep.LinearMotion(velocity=random.uniform(-10, 10, 3), angular_velocity=random.uniform(-2, 2, 3))
    radar = ep.Radar(radar.waveform, transmitters=antennas[:2], receivers=antennas[2:], transmit_power=0.1, motion=motion)
    paths = ep.trace(scene, radar, num_rays=NUM_RAYS, max_bounces=3)
    time = paths.frame.trace_time
    exact = [[Reference(scene, radar, spacing=SPACING, trace_time=time, channel=(t, r)).cube() for r in (0, 1)] for t in (0, 1)]
    return Deviation(cube=float(np.linalg.norm(ep.synthesize(paths, radar) - exact) / np.linalg.norm(exact)))


def _coherent(scene, radar, kind, model):
    paths = ep.trace(scene, radar, num_rays=NUM_RAYS, max_bounces=3, polarization=model)
    time = paths.frame.trace_time
    reference = kind(scene, radar, spacing=SPACING, trace_time=time)
    turns = np.asarray(paths.lengths([time]))[0] / reference.wavelength
    found, expected = np.sum(np.asarray(paths.amplitude) * np.exp(-2j * np.pi * np.mod(turns,
                                                                                       1.0))), reference.coherent_field(time)
    samples, exact = ep.synthesize(paths, radar)[0, 0], reference.cube()
    return Deviation(field=float(abs(found - expected) / abs(expected)),
                     cube=float(np.linalg.norm(samples - exact) / np.linalg.norm(exact)))


def diffuse_deviation(seed):
    """Mean diffuse power of a random scene of rough plates, in standard errors of the trace, beyond one percent."""
    scene, radar = random_scene(seed, rough=True)
    paths = ep.trace(scene, radar, num_rays=NUM_RAYS, max_bounces=3, batches=BATCHES)
    # The reference has no chains of several rough hits.
    once = paths.select((np.asarray(paths.diffuse) != 0) & (hits_on_plates(paths) == 1))
    power = ep.received_power(once)
    expected = Reference(scene, radar, spacing=ROUGH_SPACING, trace_time=paths.frame.trace_time).diffuse_power(
        paths.frame.trace_time)
    excess = abs(power.diffuse - expected) - 0.01 * expected
    return Deviation(power=float(max(excess, 0.0) / power.diffuse_error))


def hits_on_plates(paths):
    """Hits of each path [P] that are not on mirrors."""
    mirrors = np.array([mesh.material.mirror for mesh in paths.scene.meshes])
    sums = np.concatenate([[0], np.cumsum(~mirrors[np.asarray(paths.mesh_id, int)])])
    starts = np.asarray(paths.offsets, int)
    return sums[starts + np.asarray(paths.num_bounces, int)] - sums[starts]
