"""edges=True: what sharp edges add to physical optics, as paths with a point on an edge."""
import math

import numpy as np
import pytest

import echopath as ep
from support.scenes.edge_scenes import (
    FREQUENCY,
    HEIGHT,
    INCH,
    WAVENUMBER,
    WIDTH,
    box,
    fields,
    on_edges,
    radar_at,
    scene_of,
    sheet,
    trace,
)

FEW_RAYS = 2 ** 12
WEAK_CHAINS = 0.03    # waves from edge to edge that count as none for one polarisation and not for both
SAME = 1e-6           # single precision of weights and barycentric coordinates
FIRST_ORDER_DB = 0.2  # the rays' own physical optics
HIGHER_ORDER_DB = 0.5  # near the edges' own transitions, which the closed form leaves out
THIN_PLATE_DB = 1.5    # the theory; without waves from edge to edge 3 dB


def directions(angles):
    return np.stack([np.cos(angles), np.sin(angles), np.zeros_like(angles)], axis=1)


def first_order(angles, sign: float):
    """Both edges along the axis of a plate, in the plane across them (Ross 1966); sign: +1 VV, -1 HH, where lengths count as
    e^{-jkr}. Over the height / sqrt(pi)."""
    x, sine = WAVENUMBER * WIDTH * np.sin(angles), np.sin(angles)
    return np.cos(x) + sign * 1j * np.sin(x) / sine


def test_a_plate_returns_what_the_first_order_of_edge_theory_has():
    """VV, whose field vanishes along the faces between the edges; the sheet is too high for waves between the other two."""
    angles, height = np.radians([35.0, 50.0, 62.0, 75.0, 86.0, 90.0]), 1.3
    found = ep.rcs(scene_of(sheet(height=height)), frequency=FREQUENCY, incidence=directions(angles), polarization=["vv"],
                   num_rays=2 ** 16, edges=True)[:, 0]
    expected = height ** 2 / math.pi * np.abs(first_order(angles, 1.0)) ** 2
    assert np.abs(10.0 * np.log10(found / expected)).max() < FIRST_ORDER_DB


def test_a_plate_returns_what_edge_after_edge_has():
    """HH: the wave along the face from edge to edge, and back (Ross 1966; Knott, Shaeffer and Tuley 2004, section 5.5)."""
    angles = np.radians([38.0, 45.0, 52.0, 60.0])
    found = ep.rcs(scene_of(sheet()), frequency=FREQUENCY, incidence=directions(angles), polarization=["hh"],
                   num_rays=2 ** 15, edges=True)[:, 0]
    expected = HEIGHT ** 2 / math.pi * np.abs(first_order(angles, -1.0) + higher_orders(angles)) ** 2
    assert np.abs(10.0 * np.log10(found / expected)).max() < HIGHER_ORDER_DB
    assert np.abs(10.0 * np.log10(np.abs(first_order(angles, -1.0)) ** 2 * HEIGHT ** 2 / math.pi / expected)).max() > 2.0


def higher_orders(angles):
    """Of a strip whose edges lie along the magnetic field, over HEIGHT / sqrt(pi)."""
    ka, x, sine = WAVENUMBER * WIDTH, WAVENUMBER * WIDTH * np.sin(angles), np.sin(angles)
    along = np.exp(-1j * (ka + math.pi / 4.0)) / math.sqrt(2.0 * math.pi * ka)
    back = np.exp(1j * x) / (1.0 - sine) + np.exp(-1j * x) / (1.0 + sine)
    return -4.0 * along * (1.0 / np.cos(angles) - 0.5 * along * back)


def test_a_thin_plate_returns_what_the_method_of_moments_has():
    """HH at 10.24 GHz of a plate of 64 mil; levels in dBsm of the Austin RCS Benchmark Suite (data/reference)."""
    levels = {30: -18.67, 38: -17.44, 44: -23.76, 50: -21.82, 58: -18.05, 64: -23.46, 70: -18.71, 76: -17.0, 82: -22.37,
              86: -28.29, 90: -32.05}
    found = 10.0 * np.log10(ep.rcs(scene_of(box((0.064 * INCH, WIDTH, HEIGHT))), frequency=FREQUENCY, polarization=["hh"],
                                   incidence=directions(np.radians(list(levels))), num_rays=2 ** 14, edges=True)[:, 0])
    assert np.abs(found - list(levels.values())).mean() < THIN_PLATE_DB


@pytest.mark.parametrize("model", ["scalar", "jones"])
def test_both_models_of_polarisation_agree_where_nothing_turns_it(model):
    angles = np.radians([40.0, 70.0])
    both = [ep.rcs(scene_of(sheet()), frequency=FREQUENCY, incidence=directions(angles), polarization=(0.0, 0.0, 1.0),
                   model=one, num_rays=FEW_RAYS, edges=True) for one in (model, "jones")]
    assert both[0] == pytest.approx(both[1], rel=WEAK_CHAINS, abs=0)


def test_a_plate_is_reciprocal_across_its_edges():
    """The diffracted field on Keller's cone is; physical optics alone errs by more."""
    one, other = directions(np.radians([50.0])), directions(np.radians([-15.0]))

    def change(edges):
        there, back = (ep.rcs(scene_of(sheet()), frequency=FREQUENCY, incidence=a, observation=b, polarization=["hh"],
                              num_rays=2 ** 15, edges=edges).item() for a, b in ((one, other), (other, one)))
        return abs(10.0 * math.log10(there / back))
    assert change(True) < 0.1 < 0.5 < change(False)


def test_a_wave_over_a_metal_ground_comes_from_the_image_of_the_antenna():
    """Each path over the ground is one in free space from the image, whose polarisation is the mirrored one."""
    ground = ep.Mesh(np.array([(-50.0, -50, 0), (50, -50, 0), (50, 50, 0), (-50, 50, 0)]), np.array([(0, 1, 2), (0, 2, 3)]))
    for polarization, image in (((0.0, 0.0, 1.0), (0.0, 0.0, 1.0)), ((0.28, 0.96, 0.0), (-0.28, -0.96, 0.0))):
        scene = scene_of(sheet(), position=(0, 0, 1.5), yaw=0.4)
        scene.add(ground, name="ground", material=ep.Material.metal(mirror=True))
        both = on_edges(trace(scene, radar_at(polarization=polarization), polarization="jones"))
        there = fields(both.select("T 'ground' E'plate' R"))
        waveform = radar_at().waveform
        free = ep.Radar(waveform, transmitters=[ep.Antenna((8.0, 0.5, -1.0), polarization=image)],
                        receivers=[ep.Antenna((8.0, 0.5, 1.0), polarization=polarization)])
        alone = trace(scene_of(sheet(), position=(0, 0, 1.5), yaw=0.4), free, polarization="jones")
        expected = fields(alone.select("T E R"))
        assert there == pytest.approx(expected, rel=1e-5, abs=np.abs(expected).max() * SAME)
        back, twice = (fields(both.select(way)) for way in ("T E'plate' 'ground' R", "T 'ground' E'plate' 'ground' R"))
        assert len(back) == len(twice) == len(there)


def test_in_the_scalar_model_a_vertical_field_keeps_its_sign_over_the_ground():
    ground = ep.Mesh(np.array([(-50.0, -50, 0), (50, -50, 0), (50, 50, 0), (-50, 50, 0)]), np.array([(0, 1, 2), (0, 2, 3)]))
    scene = scene_of(sheet(), position=(0, 0, 1.5))
    scene.add(ground, name="ground", material=ep.Material.metal(mirror=True))
    sums = [fields(trace(scene, radar_at(polarization=(0.0, 1.0, 0.0)), polarization=model).select("T 'ground' E'plate' R")).sum()
            for model in ("scalar", "jones")]
    assert sums[0] == pytest.approx(sums[1], rel=0.02)


def test_edges_of_a_turning_plate_are_those_of_a_new_trace():
    spin = 10.0  # rad/s
    scene = scene_of(sheet(), motion=ep.LinearMotion(velocity=(1.0, -2.0, 0.5), angular_velocity=(0.0, 0.3, spin)))
    radar = radar_at(num_chirps=128)
    paths, later = (trace(scene, radar, start_time=start).select("T E R") for start in (0.0, 0.01))
    assert later.num_paths == paths.num_paths
    assert fields(paths, later.frame.trace_time) == pytest.approx(fields(later), rel=1e-5)
    assert np.abs(fields(paths) - fields(later)).max() > 0.1 * np.abs(fields(later)).max()


def test_the_signal_of_edges_follows_every_chirp():
    scene = scene_of(sheet(), yaw=0.3, motion=ep.LinearMotion(angular_velocity=(0.0, 0.0, 20.0)))
    radar = radar_at(num_chirps=64)
    paths = on_edges(trace(scene, radar))
    interpolated, exact = (ep.synthesize(paths, radar, evaluate=evaluate) for evaluate in ("interpolated", "samples"))
    assert np.linalg.norm(interpolated - exact) < 1e-3 * np.linalg.norm(exact)


def test_another_array_sees_the_same_edges_from_its_own_place():
    scene, moved = scene_of(sheet(), yaw=0.7), (7.9, 0.9, 1.1)
    paths = on_edges(trace(scene, radar_at()))
    two = ep.Radar(radar_at().waveform, transmitters=[ep.Antenna((8.0, 0.5, 1.0))],
                   receivers=[ep.Antenna((8.0, 0.5, 1.0)), ep.Antenna(moved)])
    anew = on_edges(trace(scene, radar_at(receiver=moved)))
    cube, expected = ep.synthesize(paths, two), ep.synthesize(anew, radar_at(receiver=moved))
    assert np.linalg.norm(cube[0, 1] - expected[0, 0]) < 1e-4 * np.linalg.norm(expected)
