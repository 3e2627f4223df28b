"""Paths in both directions: what one order cannot carry comes as the reversal of the other."""
import numpy as np
import pytest

import echopath as ep
from support.radars import build_radar
from support.shapes import rectangle

RECIPROCITY = 1e-6  # relative, of the power of a path when the antennas change places
POLARIZED_RECIPROCITY = 1e-4  # likewise: matrices are kept in single precision, and some receivers are nearly crossed
SAME_LENGTH = 1e-9      # m: hits found from either end
ROUNDING = 1e-12        # m


def make_radar(transmitter, receiver, sent=(0, 0, 1), received=(0, 0, 1)):
    return build_radar([ep.Antenna(transmitter, polarization=sent)], [ep.Antenna(receiver, polarization=received)])


def corner_scene():
    """A metal plate that is a mirror for what is near, beside a rough ball."""
    scene = ep.Scene()
    scene.add(ep.Mesh([[1, 1, -1], [7, 1, -1], [7, 1, 1], [1, 1, 1]], [[0, 1, 2], [0, 2, 3]]), name="plate",
              material=ep.Material.metal())
    scene.add(ep.actors.sphere(0.3), name="ball", material=ep.Material(reflectivity=0.5, scattering=1.0), position=(6, 0, 0))
    return scene


def sequences(paths):
    names = np.array([mesh.name for mesh in paths.scene.meshes])
    return [tuple(names[paths.mesh_id[o:o + n]]) for o, n in zip(paths.offsets, paths.num_bounces)]


def test_a_diffuse_end_brings_its_reversal():
    paths = ep.trace(corner_scene(), make_radar((0, 0, 0), (0, 0, 0)), num_rays=20000, max_bounces=2)
    by_order = {}
    for sequence, flag, power in zip(sequences(paths), paths.flags & 1, np.abs(paths.amplitude)**2):
        by_order.setdefault((sequence, int(flag)), []).append(power)
    forward = sum(by_order[("plate", "ball"), 0])
    assert forward > 0
    # Between co-located antennas the two directions carry the same.
    assert abs(sum(by_order[("ball", "plate"), 1]) / forward - 1) < RECIPROCITY


def gain_toward(antenna, directions):
    """[N] power gain of an antenna that is level, along directions [N, 3] of the radar's frame."""
    cosine, sine = np.cos(antenna.yaw), np.sin(antenna.yaw)
    return np.abs(antenna.pattern.field(directions @ [[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]]))**2


def power_by_way_of_wall(center, radius, wall, transmitter, receiver):
    """W from a ball of the material FLAT over a metal wall across x (m) to a receiver, summed over the ball's surface.

    transmitter, receiver: Antenna, both at the origin, of the radar of `build_radar`
    """
    height, turn = np.meshgrid(np.linspace(-1, 1, 801)[1::2], np.arange(800) * np.pi / 400)
    ring = np.sqrt(1 - height**2)
    normals = np.stack([ring * np.cos(turn), ring * np.sin(turn), height], axis=-1).reshape(-1, 3)
    points = center + radius * normals
    power = 0.01 * (ep.speed_of_light / 77e9 / (4 * np.pi))**2 * 0.5 / np.pi * 4 * np.pi * radius**2 / len(points)
    for antenna, place, mirrored in ((transmitter, (0, 0, 0), (1, 1, 1)), (receiver, (2 * wall, 0, 0), (-1, 1, 1))):
        ways = points - place
        distances = np.linalg.norm(ways, axis=1)
        cosines = np.maximum(-(normals * ways).sum(axis=1) / distances, 0)
        power = power * cosines / distances**2 * gain_toward(antenna, ways / distances[:, None] * mirrored)
    return power.sum()


AHEAD, AROUND = ep.Antenna(pattern=ep.CosinePower(2.0)), ep.Antenna()
LEFT, BACK = (ep.Antenna(yaw=yaw, pattern=ep.CosinePower(2.0)) for yaw in (0.3, np.pi - 0.3))


@pytest.mark.parametrize("transmitter, receiver", [(AHEAD, AROUND), (LEFT, BACK)])
def test_a_receiver_hears_walls_that_the_transmitter_does_not_light(transmitter, receiver):
    """A wall behind the transmitter sends the receiver what a ball in front scatters onto it."""
    scene = ep.Scene()
    scene.add(ep.actors.sphere(1.0, subdivisions=24), name="ball", material=FLAT, position=(3, 0, 0))
    scene.add(rectangle((-1, -20, -20), (0, 40, 0), (0, 0, 40)), name="wall", material=ep.Material.metal())
    paths = ep.trace(scene, build_radar([transmitter], [receiver]), num_rays=100_000, max_bounces=2, batches=8,
                     polarization="scalar")
    found = ep.received_power(paths.select("T 'ball' 'wall' R"))
    expected = power_by_way_of_wall(np.array([3.0, 0, 0]), 1.0, -1.0, transmitter, receiver)
    assert abs(found.power - expected) < 2 * found.standard_error < 0.12 * expected


def test_exchanged_antennas_exchange_the_paths():
    """The amplitude of a reversal is that of the forward path with the antennas exchanged, and lengths agree."""
    here, there = (0.0, 0.0, 0.0), (0.0, 0.2, 0.1)
    paths = ep.trace(corner_scene(), make_radar(here, there), num_rays=20000, max_bounces=2)
    lengths = paths.lengths([0.0])[0]
    swapped = paths.lengths([0.0], there, here)[0]
    points = paths.points(0.0)
    for path in np.flatnonzero(paths.flags & 1 == 1)[:50]:
        hits = points[paths.offsets[path]:paths.offsets[path] + paths.num_bounces[path]]
        for start, end, length in ((here, there, lengths[path]), (there, here, swapped[path])):
            chain = np.vstack([start, hits, end])
            assert abs(np.linalg.norm(np.diff(chain, axis=0), axis=1).sum() - length) < ROUNDING


def test_a_small_plate_is_no_mirror():
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.05, 0.05), name="plate", material="metal", position=(5, 0, 0), yaw=-0.4189)
    scene.add(ep.actors.sphere(0.3), name="ball", material=ep.Material(reflectivity=0.5, scattering=1.0),
              position=(3, 2.2, 0))
    paths = ep.trace(scene, make_radar((0, 0, 0), (0, 0, 0)), num_rays=25000, max_bounces=2)
    assert paths.frame.statistics.num_small_mirrors > 0
    assert ("plate", "ball") not in sequences(paths)


HERE, THERE = (0.0, 0.0, 0.0), (0.0, 0.3, 0.2)
FLAT = ep.Material(reflectivity=0.5, scattering=1.0)     # the same at all angles: its lobe is reciprocal


def chains(paths):
    """Per path: its material points, each as (mesh, triangle, u, v), and its mirrors as (mesh,), in travel order."""
    mirrors = [mesh.material.mirror for mesh in paths.scene.meshes]
    columns = (paths.mesh_id, paths.triangle_id, paths.u, paths.v)
    hits = list(zip(*(np.asarray(column).tolist() for column in columns)))

    def point(hit, is_diffuse):
        return hit if is_diffuse or not mirrors[hit[0]] else hit[:1]

    return [tuple(point(hits[start + k], int(bits) >> k & 1) for k in range(count))
            for start, count, bits in zip(paths.offsets, paths.num_bounces, paths.diffuse)]


def with_exchanged_antennas(paths):
    """The same record for a radar whose antennas have changed places."""
    names = ("hits", "offsets", "num_bounces", "diffuse", "weight", "stratum", "batch", "flags")
    (transmitter,), (receiver,) = paths.radar.transmitters, paths.radar.receivers
    radar = make_radar(receiver.position, transmitter.position, receiver.polarization, transmitter.polarization)
    jones = paths.jones if paths.jones.size else None
    return ep.Paths.from_arrays(**{name: getattr(paths, name) for name in names}, jones=jones, scene=paths.scene,
                                frame=paths.frame, radar=radar)


def exchange_error(paths):
    """Largest relative change of power as the antennas change places, of all paths whose opposite is there; their number."""
    forward, swapped = (np.abs(record.amplitude)**2 for record in (paths, with_exchanged_antennas(paths)))
    by_chain = {chain: path for path, chain in enumerate(chains(paths))}
    pairs = [(path, by_chain[chain[::-1]]) for chain, path in by_chain.items() if chain[::-1] in by_chain]
    some, opposite = np.array(pairs).T
    return np.max(np.abs(swapped[opposite] / forward[some] - 1)), len(pairs)


def diffuse_scene(wall, rough=FLAT):
    """Two rough balls beside a mirror: single hits, hits over the mirror and chains of several hits, over it or not."""
    scene = ep.Scene()
    scene.add(rectangle((-1, 2, -5), (12, 0, 0), (0, 0, 10)), name="wall", material=wall)
    scene.add(ep.actors.sphere(0.5), name="ball", material=rough, position=(5, 0, 0))
    scene.add(ep.actors.sphere(0.7), name="other", material=rough, position=(5.5, -1.4, 0.2))
    return scene


def test_exchanged_antennas_receive_the_same_over_diffuse_hits_and_mirrors():
    scene = diffuse_scene(ep.Material.metal(mirror=True))
    paths = ep.trace(scene, make_radar(HERE, THERE), num_rays=50_000, max_bounces=5)
    for events in ("D", "S D", "S D S", "D D", "S D D", "S D D S", "D D D", "D S D", "D S D S"):
        error, count = exchange_error(paths.select(f"T ({events} | {events[::-1]}) R"))
        assert count >= 20 and error < RECIPROCITY, events


def test_exchanged_antennas_and_polarisations_receive_the_same():
    """At one place: matrices are those of the directions in which the antennas were traced."""
    turning = FLAT.replace(cross_polarization=.3)
    scene = diffuse_scene(ep.Material(permittivity=5 - .3j, mirror=True), turning)
    slanted = [np.array(vector) / np.linalg.norm(vector) for vector in ((0, .3, 1), (0, 1, .2))]
    paths = ep.trace(scene, make_radar(HERE, HERE, *slanted), num_rays=50_000, max_bounces=4, polarization="jones")
    for events in ("D", "S D", "D D", "S D D", "D S D"):
        error, count = exchange_error(paths.select(f"T ({events} | {events[::-1]}) R"))
        assert count >= 20 and error < POLARIZED_RECIPROCITY, events


def test_chains_behind_a_leaning_pane_send_the_same_back_and_forth():
    """Antennas at one place with one slanting polarisation, before a pane that is neither upright nor level across any leg."""
    scene = diffuse_scene(ep.Material(permittivity=5 - .3j, mirror=True), FLAT.replace(cross_polarization=.3))
    scene.add(rectangle((-3.1, -6, -5), (6, 9, 0), (2, 0, 9)), name="pane",
              material=ep.Material(layers=[ep.Layer(0.004, 6.3 - 0.1j)]))
    slanted = np.array((0, .5, 1)) / np.linalg.norm((0, .5, 1))
    paths = ep.trace(scene, make_radar(HERE, HERE, slanted, slanted), num_rays=50_000, max_bounces=3, polarization="jones")
    scalar = ep.trace(scene, make_radar(HERE, HERE, slanted, slanted), num_rays=50_000, max_bounces=3, polarization="scalar")
    for events in ("SD", "DD", "SDD"):
        for record, most in ((paths, POLARIZED_RECIPROCITY), (scalar, RECIPROCITY)):
            there, back = (" P* ".join(f"({event})" for event in order) for order in (events, events[::-1]))
            some = record.select(f"T P* ({there} | {back}) P* R & T .* P .* R")
            by_chain = {chain: path for path, chain in enumerate(chains(some))}
            pairs = np.array([(path, by_chain[chain[::-1]]) for chain, path in by_chain.items() if chain[::-1] in by_chain])
            power = np.abs(some.amplitude) ** 2
            assert len(pairs) >= 20 and np.abs(power[pairs[:, 0]] / power[pairs[:, 1]] - 1).max() < most, events


def test_exchanged_antennas_receive_the_same_over_a_dielectric_mirror():
    """At one place: coefficients of the mirror are those of the places where the antennas were traced."""
    paths = ep.trace(diffuse_scene(ep.Material(permittivity=5 - .3j, mirror=True)), make_radar(HERE, HERE), num_rays=10000)
    error, count = exchange_error(paths.select("T S? D S? R"))
    assert count > 1000 and error < RECIPROCITY


def test_exchanged_antennas_receive_the_same_over_mirrors_alone():
    scene = ep.Scene()
    for name, corner, edge, permittivity in (("left", (-9, 2, -2), (0, 0, 8), 5 - .3j),
                                             ("right", (-9, -3, -2), (0, 0, 8), 7 - 1j),
                                             ("floor", (-9, -3, -1), (0, 5, 0), 4 - .2j)):
        material = ep.Material(permittivity=permittivity, mirror=True)
        scene.add(rectangle(corner, (20, 0, 0), edge), name=name, material=material)
    records = []
    for ends in ((HERE, THERE), (THERE, HERE)):
        paths = ep.trace(scene, make_radar(*ends), num_rays=100, max_bounces=4)
        records.append(dict(zip(chains(paths), zip(np.abs(paths.amplitude)**2, paths.lengths([0.0])[0]))))
    assert len(records[0]) > 10 and set(records[1]) == {chain[::-1] for chain in records[0]}
    for chain, (power, length) in records[0].items():
        opposite = records[1][chain[::-1]]
        assert abs(opposite[0] / power - 1) < RECIPROCITY and abs(opposite[1] - length) < SAME_LENGTH


@pytest.mark.parametrize("here, there", [((0, 0, 0), (0, 0, 0)), ((0, 1000, 0), (0, -1000, 0))])
def test_exchanged_antennas_receive_the_same_from_a_plate(here, there):
    """Physical optics is reciprocal in backscatter and in the specular direction, where all of a small plate lies."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.002, 0.002), name="plate", material="metal", position=(4000, 0, 0))
    paths = ep.trace(scene, make_radar(here, there), num_rays=2000, max_bounces=1)
    error, count = exchange_error(paths)
    assert count > 1000 and error < RECIPROCITY


def test_what_a_transmit_leg_finds_comes_back_behind_several_diffuse_hits():
    """A plate that is not flagged is a mirror for the transmit leg alone: the opposite order is the reversal."""
    scene = corner_scene()
    scene.add(ep.actors.sphere(0.8), name="other", material=FLAT, position=(6, -1.2, 0))
    paths = ep.trace(scene, make_radar(HERE, THERE), num_rays=100000, max_bounces=3, polarization="scalar")
    chain, opposite = paths.select("T S'plate' D D R"), paths.select("T D D S'plate' R")
    assert chain.num_paths > 20 and not np.any(chain.flags & 1) and np.all(opposite.flags & 1)
    error, count = exchange_error(paths.select("T (S'plate' D D | D D S'plate') R"))
    assert count > 1.8 * chain.num_paths and error < RECIPROCITY  # some ends are seen by one of the antennas only
