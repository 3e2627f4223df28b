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
from echopath.cavities import waves
from echopath.cavities.walls import Facets, _parted, inward_normals
from support.background import heed_ctrl_c
from support.rcs_targets import in_plane
from support.references.guide_modes import echo_of_shorted_guide
from support.shapes import METAL, plate, rectangle, scene_of

FREQUENCY = 10e9  # Hz
WAVENUMBER = 2.0 * np.pi * FREQUENCY / ep.speed_of_light
WIDTH, HEIGHT, DEPTH = 0.115, 0.085, 0.05  # m: 3.8 by 2.8 by 1.7 wavelengths; no mode is near its cut-off
PLATE_SIDE = 0.06  # m
FRINGES = np.arange(3) / 6.0  # wavelengths: thirds of a turn there and back
AZIMUTHS = np.arange(0.0, 65.0, 8.0)       # deg
MODES_TOLERANCE = 0.1    # of the strongest field: modes that are cut off, and what the mouth sends back; .04 to .085 found
SUMMATION = 0.01        # of the strongest field: a mouth of other triangles
ROUNDING = 1e-9         # of the strongest field
HALF_OF_SKY = 0.006     # of the whole sky: pieces of facets beside a corner are points; .0042 found


def guide(depth=DEPTH, width=WIDTH, height=HEIGHT, **other):
    """Five walls, and the cavity that they line."""
    low = np.array([-depth, -width / 2, -height / 2])
    x, y, z = np.diag([depth, width, height])
    walls = {"left": (low, x, z), "right": (low + y, x, z), "floor": (low, x, y), "top": (low + z, x, y), "rear": (low, y, z)}
    scene = scene_of(**{name: (rectangle(*one), METAL) for name, one in walls.items()}, **other)
    mouth = low + x
    return scene, ep.Cavity(tuple(walls), [mouth, mouth + y, mouth + y + z, mouth + z])


def small_guide(**other):
    """For what holds in any cavity: solved in a twentieth of the time."""
    return guide(0.6 * DEPTH, 0.45 * WIDTH, 0.45 * HEIGHT, **other)


def echoes(scene, cavity, polarization, azimuths=AZIMUTHS, **keywords):
    return ep.rcs(scene, frequency=FREQUENCY, incidence=in_plane(azimuths), polarization=polarization, num_rays=4096,
                  cavities=cavity, **keywords)


def modes(polarization):
    """Fields over AZIMUTHS; the first is along the axis."""
    return echo_of_shorted_guide(WAVENUMBER, WIDTH, HEIGHT, DEPTH, np.radians(AZIMUTHS), polarization)


def plate_beside(shift):
    """It stands that far before the mouth, in wavelengths."""
    return plate((shift * ep.speed_of_light / FREQUENCY, 0.0, 0.3), (1, 0, 0), PLATE_SIDE), METAL


@pytest.fixture(scope="module")
def fringes():
    """Along the axis, for plates at FRINGES, of "vv" and "hh": [3, 2] in m^2."""
    return np.concatenate([echoes(*guide(plate=plate_beside(shift)), ["vv", "hh"], [0.0]) for shift in FRINGES])


def test_a_shorted_guide_has_the_echo_of_its_modes():
    found = np.sqrt(echoes(*guide(), ["vv", "hh"]) / (4.0 * np.pi))
    for of_one, polarization in zip(found.T, ["vv", "hh"]):
        expected = np.abs(modes(polarization))
        assert np.abs(of_one - expected).max() < MODES_TOLERANCE * expected.max()


@pytest.mark.parametrize("polarization", ["vv", "hh"])
def test_waves_inside_add_to_rays_outside_as_fields(fringes, polarization):
    """A plate beside the mouth is moved along its normal: its own echo is -jk A/(2 pi), and the fringes tell the other field."""
    of_plate = -1j * WAVENUMBER * PLATE_SIDE ** 2 / (2.0 * np.pi)
    powers = fringes[:, ["vv", "hh"].index(polarization)] / (4.0 * np.pi)
    product = np.mean(powers * np.exp(-4j * np.pi * FRINGES))  # of the plate and the conjugate of the guide
    expected = modes(polarization)
    assert abs(np.conj(product / of_plate) - expected[0]) < MODES_TOLERANCE * np.abs(expected).max()


def test_one_vector_of_both_antennas_is_their_channel():
    by_vector, by_name = (echoes(*small_guide(plate=plate_beside(0.125)), one, [0.0]) for one in ((0.0, 0.0, 1.0), "vv"))
    assert by_vector == pytest.approx(by_name, rel=1e-6)


def test_both_directions_may_change_places():
    scene, cavity = small_guide()
    one, other = in_plane([10.0, 40.0, 55.0]), in_plane([-25.0, 0.0, 20.0])
    one[:, 2], other[:, 2] = 0.3, -0.2
    channels = ["vv", "hh", "vh", "hv"]
    both = ep.rcs(scene, frequency=FREQUENCY, incidence=np.concatenate([one, other]), num_rays=4096, cavities=[cavity],
                  observation=np.concatenate([other, one]), polarization=channels)
    for channel, back in (("vv", "vv"), ("hh", "hh"), ("vh", "hv")):
        there, opposite = both[:3, channels.index(channel)], both[3:, channels.index(back)]
        assert np.abs(np.sqrt(there) - np.sqrt(opposite)).max() < ROUNDING * np.sqrt(there).max()


def test_names_of_channels_are_those_of_vectors():
    """Of the waves too: horizontal is level, vertical across it."""
    scene, cavity = small_guide()
    asked = {"frequency": FREQUENCY, "incidence": (0.768, 0.576, 0.28), "num_rays": 4096, "cavities": cavity}
    by_name = ep.rcs(scene, polarization=["vv", "hh"], **asked)
    for found, across in zip(by_name, [(-0.224, -0.168, 0.96), (-0.6, 0.8, 0.0)]):
        assert found == pytest.approx(ep.rcs(scene, polarization=np.array([across, across]), **asked), rel=1e-6)


@pytest.mark.parametrize("incidence, observation", [(120.0, 120.0), (180.0, 180.0), (0.0, 120.0), (120.0, 0.0)])
def test_nothing_comes_out_behind_the_mouth_or_goes_in_there(incidence, observation):
    scene, cavity = small_guide()
    found = echoes(scene, cavity, "vv", [incidence], observation=in_plane([observation]))
    assert found == pytest.approx(0.0, abs=1e-15)


def test_the_mouth_radiates_as_electric_and_magnetic_dipoles():
    """Fields of both at any distance: Balanis 2016, 4.2 and 7.4, by duality."""
    area, places = 1e-8, np.array([[0.004, 0.001, -0.002], [0.0, 0.009, 0.003], [-0.03, 0.02, 0.05], [0.3, -0.4, 0.1]])
    current = np.array([0.3, -0.5, 0.7])
    r = np.linalg.norm(places, axis=1)[:, None]
    unit, wave = places / r, area * np.exp(-1j * WAVENUMBER * r) / (4.0 * np.pi * r)
    over = 1.0 / (1j * WAVENUMBER * r)
    of_electric = 1j * WAVENUMBER * wave * (1.0 + over) * np.cross(current, unit)
    along = (unit @ current)[:, None] * unit
    of_magnetic = 1j * WAVENUMBER * wave * (2.0 * (over + over ** 2) * along - (1.0 + over + over ** 2) * (current - along))
    mouth = Facets(np.zeros((1, 3)), np.array([[1.0, 0.0, 0.0]]), np.array([area]), 1e-4, np.zeros((1, 3)), np.array([area]),
                   np.array([0, 1]))
    toward, none = np.array([[1.0, 0.0, 0.0]]), np.zeros((1, 3))
    for currents, expected in (((current[None], none), of_electric), ((none, current[None]), of_magnetic)):
        found = waves.magnetic_field_at(places, mouth, WAVENUMBER, toward, *currents)[:, 0]
        assert np.all(np.abs(found - expected).max(axis=1) <= ROUNDING * np.abs(expected).max(axis=1))


def test_the_walls_of_a_closed_box_fill_half_of_the_sky_of_each_facet():
    """Gauss's law, for the kernel of the equation where waves are long: facets near by and beside corners count in full."""
    corners = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.3) for z in (0.0, 0.8)])
    sides = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]]
    triangles = np.array([corners[one] for a, b, c, d in sides for one in ([a, b, c], [a, c, d])])
    walls = _parted(triangles, inward_normals(triangles), 0.2)
    kernel = waves._wavelets(walls, np.arange(len(walls)), 1e-9)
    sky = np.einsum("nmx,mx->n", kernel.real, walls.normals)
    assert sky == pytest.approx(0.5, abs=HALF_OF_SKY)


def test_parts_and_shapes_are_those_of_other_cross_sections():
    scene, cavity = small_guide()
    both = echoes(scene, cavity, ["vv", "hh"], [0.0, 10.0])
    assert both.shape == (2, 2) and both[:, 1] == pytest.approx(echoes(scene, cavity, "hh", [0.0, 10.0]))
    parts = ep.rcs(scene, frequency=FREQUENCY, incidence=(1, 0, 0), polarization="vv", cavities=cavity, components=True)
    assert parts == {"coherent": pytest.approx(both[0, 0], rel=1e-6), "diffuse": 0.0}
    assert isinstance(parts["coherent"], float)


def test_corners_of_a_mouth_may_lie_on_its_sides():
    """As those of the rim of a mesh do."""
    scene, cavity = small_guide()
    corners = np.array(cavity.mouth)
    rim = np.stack([corners, 0.5 * (corners + np.roll(corners, -1, axis=0))], axis=1).reshape(-1, 3)
    four, eight = (np.sqrt(echoes(scene, one, "vv")) for one in (cavity, ep.Cavity(cavity.walls, rim)))
    assert eight == pytest.approx(four, abs=SUMMATION * four.max())


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
    scene, cavity = small_guide()
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
try:
    print("begun", flush=True)
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
