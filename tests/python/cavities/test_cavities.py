"""Waves in cavities against the modes of a shorted guide."""
import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import echopath as ep
from support.background import heed_ctrl_c
from support.rcs_targets import in_plane
from support.references.guide_modes import echo_of_shorted_guide
from support.shapes import METAL, plate, rectangle, scene_of

FREQUENCY = 10e9  # Hz
WAVENUMBER = 2.0 * np.pi * FREQUENCY / ep.speed_of_light
WIDTH, HEIGHT, DEPTH = 0.115, 0.085, 0.05  # m: 3.8 by 2.8 by 1.7 wavelengths; no mode is near its cut-off
AZIMUTHS = np.arange(0.0, 65.0, 8.0)       # deg
MODES_TOLERANCE = 0.1    # of the strongest field: modes that are cut off, and what the mouth sends back; .04 to .085 found
RECIPROCITY = 1e-9      # of the strongest field: rounding


def guide(**other):
    """Five walls, and the cavity that they line."""
    low = np.array([-DEPTH, -WIDTH / 2, -HEIGHT / 2])
    x, y, z = np.diag([DEPTH, WIDTH, HEIGHT])
    walls = {"left": (low, x, z), "right": (low + y, x, z), "floor": (low, x, y), "top": (low + z, x, y), "rear": (low, y, z)}
    scene = scene_of(**{name: (rectangle(*one), METAL) for name, one in walls.items()}, **other)
    mouth = low + x
    return scene, ep.Cavity(tuple(walls), [mouth, mouth + y, mouth + y + z, mouth + z])


def echoes(scene, cavity, polarization, azimuths=AZIMUTHS, **keywords):
    return ep.rcs(scene, frequency=FREQUENCY, incidence=in_plane(azimuths), polarization=polarization, num_rays=4096,
                  cavities=cavity, **keywords)


def modes(polarization):
    """Fields over AZIMUTHS; the first is along the axis."""
    return echo_of_shorted_guide(WAVENUMBER, WIDTH, HEIGHT, DEPTH, np.radians(AZIMUTHS), polarization)


@pytest.mark.parametrize("polarization", ["vv", "hh"])
def test_a_shorted_guide_has_the_echo_of_its_modes(polarization):
    expected = np.abs(modes(polarization))
    found = np.sqrt(echoes(*guide(), polarization) / (4.0 * np.pi))
    assert np.abs(found - expected).max() < MODES_TOLERANCE * expected.max()


@pytest.mark.parametrize("polarization", ["vv", "hh", (0.0, 0.0, 1.0)])
def test_waves_inside_add_to_rays_outside_as_fields(polarization):
    """A plate beside the mouth is moved along its normal: its own echo is -jk A/(2 pi), and the fringes tell the other field."""
    side, wavelength = 0.06, ep.speed_of_light / FREQUENCY
    of_plate = -1j * WAVENUMBER * side ** 2 / (2.0 * np.pi)
    fringes = []
    for shift in np.arange(4) / 8.0 * wavelength:
        scene, cavity = guide(plate=(plate((shift, 0.0, 0.3), (1, 0, 0), side), METAL))
        fringes.append(echoes(scene, cavity, polarization, [0.0])[0] / (4.0 * np.pi))
    product = 0.25 * (fringes[0] - fringes[2] + 1j * (fringes[3] - fringes[1]))  # of the plate and the conjugate of the guide
    expected = modes("hh" if polarization == "hh" else "vv")
    assert abs(np.conj(product / of_plate) - expected[0]) < MODES_TOLERANCE * np.abs(expected).max()


def test_both_directions_may_change_places():
    scene, cavity = guide()
    one, other = in_plane([10.0, 40.0, 55.0]), in_plane([-25.0, 0.0, 20.0])
    one[:, 2], other[:, 2] = 0.3, -0.2
    for channel, back in (("vv", "vv"), ("hh", "hh"), ("vh", "hv")):
        there, opposite = (ep.rcs(scene, frequency=FREQUENCY, incidence=i, observation=o, polarization=p, num_rays=4096,
                                  cavities=[cavity]) for i, o, p in ((one, other, channel), (other, one, back)))
        assert np.abs(np.sqrt(there) - np.sqrt(opposite)).max() < RECIPROCITY * np.sqrt(there).max()


def test_names_of_channels_are_those_of_vectors():
    """Of the waves too: horizontal is level, vertical across it."""
    scene, cavity = guide()
    asked = {"frequency": FREQUENCY, "incidence": (0.768, 0.576, 0.28), "num_rays": 4096, "cavities": cavity}
    by_name = ep.rcs(scene, polarization=["vv", "hh"], **asked)
    for found, across in zip(by_name, [(-0.224, -0.168, 0.96), (-0.6, 0.8, 0.0)]):
        assert found == pytest.approx(ep.rcs(scene, polarization=np.array([across, across]), **asked), rel=1e-6)


def test_nothing_comes_out_behind_the_mouth():
    scene, cavity = guide()
    assert echoes(scene, cavity, "vv", [120.0, 180.0]) == pytest.approx(0.0, abs=1e-15)


def test_parts_and_shapes_are_those_of_other_cross_sections():
    scene, cavity = guide()
    both = echoes(scene, cavity, ["vv", "hh"], [0.0, 10.0])
    assert both.shape == (2, 2) and both[:, 1] == pytest.approx(echoes(scene, cavity, "hh", [0.0, 10.0]))
    parts = ep.rcs(scene, frequency=FREQUENCY, incidence=(1, 0, 0), polarization="vv", cavities=cavity, components=True)
    assert parts == {"coherent": pytest.approx(both[0, 0], rel=1e-6), "diffuse": 0.0}
    assert isinstance(parts["coherent"], float)


def test_a_cavity_is_a_value():
    cavity = guide()[1]
    assert cavity == guide()[1] and hash(cavity) == hash(guide()[1]) and cavity != ep.Cavity("left", cavity.mouth)


@pytest.mark.parametrize("mouth", [[(0, 0, 0), (0, 1, 0)], [(0, 0, 0), (0, 1, 0), (0, 2, 0)],
                                   [(0, 0, 0), (0, 1, 0), (0, 0, 1), (0, 1, 1)], [(0, 0, 0), (0, 1, 0), (0.1, 1, 1), (0, 0, 1)]])
def test_mouths_are_flat_and_convex(mouth):
    with pytest.raises(ValueError, match="^mouth: "):
        ep.Cavity("wall", mouth)


def test_wrong_cavities_are_told_of():
    scene, cavity = guide()
    with pytest.raises(TypeError, match="^walls: "):
        ep.Cavity(3, cavity.mouth)
    with pytest.raises(KeyError, match="celing"):
        echoes(scene, ep.Cavity("celing", cavity.mouth), "vv")
    with pytest.raises(ValueError, match="must close the cavity"):
        echoes(scene, ep.Cavity(cavity.walls[:-1], cavity.mouth), "vv")
    with pytest.raises(TypeError, match="^cavities: "):
        echoes(scene, "left", "vv")
    with pytest.raises(ValueError, match="^cavities: .*return_error"):
        echoes(scene, cavity, "vv", return_error=True)
    with pytest.raises(ValueError, match="facets"):
        ep.rcs(scene, frequency=100e9, incidence=(1, 0, 0), num_rays=1024, cavities=cavity)
    with pytest.raises(ValueError, match="^cavities: each mesh must line one cavity, 'left' lines two"):
        echoes(scene, [cavity, ep.Cavity("left", cavity.mouth)], "vv")
    fine = scene_of(wall=(ep.actors.plate(0.1, 0.1, edge=0.00196), METAL))
    with pytest.raises(ValueError, match="at most 5000 triangles, got 5408"):
        echoes(fine, ep.Cavity("wall", cavity.mouth), "vv")


def test_walls_are_perfect_conductors():
    scene, cavity = guide()
    scene["left"].material = "concrete"
    with pytest.raises(ValueError, match="perfect conductors, mesh 'left'"):
        echoes(scene, cavity, "vv")


def test_ctrl_c_does_not_wait_for_the_equation(monkeypatch, ctrl_c_is_heard):
    scene, cavity = guide()
    goes_on, solved = threading.Event(), threading.Event()

    def solve_until_told(*matrices):
        os.kill(os.getpid(), signal.SIGINT)
        assert goes_on.wait(60.0)
        solved.set()

    monkeypatch.setattr("echopath.cavities.waves.np.linalg.solve", solve_until_told)
    with pytest.raises(KeyboardInterrupt):
        echoes(scene, cavity, "vv", [0.0])
    assert not solved.is_set()
    goes_on.set()


STOPPED = """
import sys
import numpy as np
from echopath.cavities import waves

matrix = np.eye(1500) + 1j * np.random.default_rng(1).normal(size=(1500, 1500)) / 1500
print("begun", flush=True)
try:
    while True:
        waves._solved(matrix, np.ones((1500, 1)))
except KeyboardInterrupt:
    sys.exit(130)
"""


def test_a_program_that_is_stopped_in_the_equation_ends():
    process = subprocess.Popen([sys.executable, "-c", STOPPED], stdout=subprocess.PIPE, preexec_fn=heed_ctrl_c)
    process.stdout.readline()
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=60.0)
    assert process.returncode == 130
