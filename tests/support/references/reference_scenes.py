"""Small random scenes for the slow reference, and how far the simulator is from it."""
import dataclasses

import numpy as np

import echopath as ep

from .polarized_reference import PolarizedReference
from .reference import Reference

SPACING = 1e-3        # m, of the reference's cells: edges of shadows fall between them, a percent of a plate of 0.1 m
SLANTED_SPACING = 2e-4  # m, of plates that the radar sees at 60 degrees, too
ROUGH_SPACING = 3e-3  # m, of rough plates: their powers add, but fringes of images are as narrow; 1e-3 of 1 mm found
NUM_RAYS, BATCHES = 2 ** 16, 8
SAMPLE_STEP = 15      # compared are the samples 0 and 15 of 16: the slow sum takes as long for each of them


@dataclasses.dataclass
class Deviation:
    """field, cube: relative to the reference; power: in standard errors, beyond one percent."""

    field: float = 0.0
    cube: float = 0.0
    power: float = 0.0


def random_radar(random):
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=1.5e8, num_samples=16, sampling_rate=20e6,
                                num_chirps=2, chirp_interval=1.5e-4)
    pattern = ep.CosinePower(2.0) if random.random() < 0.5 else ep.Isotropic(0.6)
    polarization = [(0.0, 0.0, 1.0), (0.0, 1.0, 0.0)][random.integers(2)]
    receiver = random.uniform(-0.05, 0.05, 3)
    return ep.Radar(waveform, transmitters=[ep.Antenna((0, 0, 0), pattern=pattern, polarization=polarization)],
                    receivers=[ep.Antenna(tuple(receiver), pattern=pattern, polarization=polarization)], transmit_power=0.1)


def random_material(random, *, rough):
    kinds = [{"conductor": True}, {"permittivity": complex(random.uniform(2, 8), -random.uniform(0, 1))},
             {"reflectivity": random.uniform(0.2, 1.0)}]
    return ep.Material(**kinds[random.integers(3)], scattering=random.uniform(0.6, 1.0) if rough else 0.0)


def bent_panel(side, across, along, num=4):
    """A square panel that faces -x, x = (across y^2 + along z^2)/2: curvatures in 1/m, convex where positive."""
    steps = np.linspace(-side / 2, side / 2, num + 1)
    y, z = (axis.ravel() for axis in np.meshgrid(steps, steps))
    first = (np.arange(num)[:, None] * (num + 1) + np.arange(num)).ravel()
    corners = (first, first + num + 2, first + 1), (first, first + num + 1, first + num + 2)
    faces = np.concatenate([np.stack(triangle, 1) for triangle in corners])
    return ep.Mesh(np.stack([(across * y**2 + along * z**2) / 2, y, z], 1), faces)


def random_scene(seed, *, rough, curved=False):
    """Plates or bent panels that nearly face the radar, often one in the shadow of another, moving, beside up to one large
    plane."""
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
        mesh = bent_panel(side, *random.uniform(-1.0, 1.0, 2)) if curved else ep.actors.plate(side, side)
        scene.add(mesh, name=f"plate{k}", material=random_material(random, rough=rough),
                  transform=_placed(at, yaw, pitch), motion=motion, smooth=curved)
    if random.random() < 0.7:
        plane = random_material(random, rough=False).replace(mirror=True)
        if random.random() < 0.5:
            scene.add(ep.actors.ground((60.0, 30.0), z=-random.uniform(1.2, 2.0)), name="plane", material=plane)
        else:
            scene.add(ep.actors.wall(60.0, 30.0), name="plane", material=plane, position=(0, random.uniform(2, 3), -15.0))
    return scene, random_radar(random)


def mirrored_scene(seed, *, rough):
    """Moving plates between two planes that mirror, a ground and a wall or two walls; each plate faces the radar's image
    over one of them or both."""
    random = np.random.default_rng(seed)
    scene = ep.Scene()
    planes = [("ground", -random.uniform(1.2, 2.0)) if random.random() < 0.5 else ("right", -random.uniform(2, 3)),
              ("left", random.uniform(2, 3))]
    for name, height in planes:
        mirror = random_material(random, rough=False).replace(mirror=True)
        if name == "ground":
            scene.add(ep.actors.ground((60.0, 30.0), z=height), name=name, material=mirror)
        else:
            scene.add(ep.actors.wall(60.0, 30.0), name=name, material=mirror, position=(0, height, -15.0))
    for k in range(random.integers(1, 3)):
        _add_plate_that_faces_an_image(scene, random, planes[k:], rough)
    return scene, random_radar(random)


def _add_plate_that_faces_an_image(scene, random, planes, rough):
    """A plate that faces the image of the origin over planes, (name, height) each."""
    at, image = np.array([random.uniform(5, 8), random.uniform(-1, 1), random.uniform(-0.8, 0.8)]), np.zeros(3)
    for name, height in planes:
        axis = 2 if name == "ground" else 1
        image[axis] = 2 * height - image[axis]
    line = at - image
    yaw, pitch = np.arctan2(line[1], line[0]), -np.arcsin(line[2] / np.linalg.norm(line))
    side = random.uniform(0.2, 0.4) if rough else random.uniform(0.015, 0.025)  # smooth ones send broad beams
    motion = ep.LinearMotion(velocity=random.uniform(-5, 5, 3), angular_velocity=random.uniform(-2, 2, 3))
    scene.add(ep.actors.plate(side, side), name=f"plate{len(scene.meshes)}", material=random_material(random, rough=rough),
              transform=_placed(at, yaw, pitch), motion=motion)


def _placed(at, yaw, pitch):
    """A plate at `at` whose front, -x, is turned up by `pitch` and left by `yaw`."""
    cy, sy, cp, sp = np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch)
    placement = np.eye(4)
    placement[:3, :3] = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]]) @ np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    placement[:3, 3] = at
    return placement


def coherent_deviation(seed):
    """Field at mid-frame and all samples of a random scene of smooth plates."""
    return _coherent(*random_scene(seed, rough=False), Reference, "scalar")


def polarized_deviation(seed):
    """The same with field vectors and antennas of any two linear polarisations."""
    scene, radar = random_scene(seed, rough=False)
    return _coherent(scene, _polarized(radar, seed), PolarizedReference, "jones")


def curved_deviation(seed):
    """The same of bent smooth panels; every other one with field vectors."""
    scene, radar = random_scene(seed, rough=False, curved=True)
    if seed % 2:
        return _coherent(scene, _polarized(radar, seed), PolarizedReference, "jones")
    return _coherent(scene, radar, Reference, "scalar")


def two_mirror_deviation(seed):
    """The same between two planes that mirror, of the echoes that return over the planes by which they came to a plate: it
    faces the image. Others are as strong but few rays resolve them. Every other one with field vectors."""
    scene, radar = mirrored_scene(seed, rough=False)
    if seed % 2:
        return _coherent(scene, _polarized(radar, seed), PolarizedReference, "jones", between_planes=True)
    return _coherent(scene, radar, Reference, "scalar", between_planes=True)


def _polarized(radar, seed):
    """The radar with a transmitter and a receiver of any linear polarisations."""
    random = np.random.default_rng(seed + 500)
    axes = random.normal(size=(2, 3)) * [0.3, 1.0, 1.0]
    antennas = [ep.Antenna(tuple(antenna.position), pattern=antenna.pattern, polarization=tuple(axis / np.linalg.norm(axis)))
                for antenna, axis in zip((radar.transmitters[0], radar.receivers[0]), axes)]
    return ep.Radar(radar.waveform, transmitters=antennas[:1], receivers=antennas[1:], transmit_power=radar.transmit_power)


def array_deviation(seed):
    """Samples of all channels of two transmitters and two receivers on a moving, turning radar."""
    scene, radar = random_scene(seed, rough=False)
    random = np.random.default_rng(seed + 900)
    pattern, polarization = radar.transmitters[0].pattern, tuple(radar.transmitters[0].polarization)
    places = random.uniform(-0.02, 0.02, (4, 3))
    antennas = [ep.Antenna(tuple(place), pattern=pattern, polarization=polarization) for place in places]
    motion = ep.LinearMotion(velocity=random.uniform(-10, 10, 3), angular_velocity=random.uniform(-2, 2, 3))
    radar = ep.Radar(radar.waveform, transmitters=antennas[:2], receivers=antennas[2:], transmit_power=0.1, motion=motion)
    paths = ep.trace(scene, radar, num_rays=NUM_RAYS, max_bounces=3, polarization="scalar")
    reference = Reference(scene, radar, spacing=SPACING, trace_time=paths.frame.trace_time)
    exact = [[reference.cube(SAMPLE_STEP, (t, r)) for r in (0, 1)] for t in (0, 1)]
    samples = ep.synthesize(paths, radar)[..., ::SAMPLE_STEP]
    return Deviation(cube=float(np.linalg.norm(samples - exact) / np.linalg.norm(exact)))


def _coherent(scene, radar, kind, model, between_planes=False):
    max_bounces, spacing = (5, SLANTED_SPACING) if between_planes else (3, SPACING)
    paths = ep.trace(scene, radar, num_rays=NUM_RAYS, max_bounces=max_bounces, polarization=model)
    time = paths.frame.trace_time
    reference = kind(scene, radar, spacing=spacing, trace_time=time, max_bounces=max_bounces)
    if between_planes:
        paths, reference.retro = paths.select(_returns(paths)), True
    turns = np.mod(np.asarray(paths.lengths([time]))[0] / reference.wavelength, 1.0)
    found, expected = np.sum(np.asarray(paths.amplitude) * np.exp(-2j * np.pi * turns)), reference.coherent_field()
    samples, exact = ep.synthesize(paths, radar)[0, 0, :, ::SAMPLE_STEP], reference.cube(SAMPLE_STEP)
    return Deviation(field=float(abs(found - expected) / abs(expected)),
                     cube=float(np.linalg.norm(samples - exact) / np.linalg.norm(exact)))


def diffuse_deviation(seed):
    """Mean diffuse power of a random scene of rough plates, in standard errors of the trace, beyond one percent."""
    return _diffuse(*random_scene(seed, rough=True))


def curved_diffuse_deviation(seed):
    """The same of rough bent panels."""
    return _diffuse(*random_scene(seed, rough=True, curved=True))


def two_mirror_diffuse_deviation(seed):
    """The same of rough plates between two planes that mirror."""
    return _diffuse(*mirrored_scene(seed, rough=True), max_bounces=5)


def _diffuse(scene, radar, max_bounces=3):
    paths = ep.trace(scene, radar, num_rays=NUM_RAYS, max_bounces=max_bounces, batches=BATCHES,
                     polarization="scalar")
    # The reference has no chains of several rough hits.
    once = paths.select((np.asarray(paths.diffuse) != 0) & (hits_on_plates(paths) == 1))
    power = ep.received_power(once)
    expected = Reference(scene, radar, spacing=ROUGH_SPACING, trace_time=paths.frame.trace_time,
                         max_bounces=max_bounces).diffuse_power(paths.frame.trace_time)
    excess = abs(power.diffuse - expected) - 0.01 * expected
    return Deviation(power=float(max(excess, 0.0) / power.diffuse_error))


def _returns(paths):
    """Paths [P] that leave a plate over the planes by which they came, one at least."""
    starts, counts, meshes = (np.asarray(column, int) for column in (paths.offsets, paths.num_bounces, paths.mesh_id))
    hits = meshes.tolist()
    sequences = [hits[start:start + count] for start, count in zip(starts.tolist(), counts.tolist())]
    is_mirror = [mesh.material.mirror for mesh in paths.scene.meshes]
    once = (hits_on_plates(paths) == 1) & (counts >= 3) & (counts % 2 == 1)
    middle_is_plate = [not is_mirror[row[len(row) // 2]] for row in sequences]
    return once & middle_is_plate & [row == row[::-1] for row in sequences]


def hits_on_plates(paths):
    """Hits of each path [P] that are not on mirrors."""
    mirrors = np.array([mesh.material.mirror for mesh in paths.scene.meshes])
    sums = np.concatenate([[0], np.cumsum(~mirrors[np.asarray(paths.mesh_id, int)])])
    starts = np.asarray(paths.offsets, int)
    return sums[starts + np.asarray(paths.num_bounces, int)] - sums[starts]
