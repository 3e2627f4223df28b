"""Corners of a few wavelengths and chains over unflagged bodies against independent sums, however they are cut into meshes."""
import numpy as np
import pytest

import echopath as ep
from support.rcs_targets import in_plane
from support.references import iterated_optics
from support.references.method_of_moments import Strips, hankel, polyline
from support.shapes import FREQUENCY, METAL, WAVELENGTH, decibel, fields, make_radar, rectangle, scene_of, sphere

MOMENTS = 2e-3          # relative: a circle of 60 chords and more has less area than that
CORNER_DB = 0.5         # the promise; .35 found
RECORD = 1e-6           # relative: the rounding of a record's floats
ORDER_DB = 0.3          # of an order that few rays resolve, against 131 000 rays of the other; .2 found
SEGMENT = {4: .05, 6: .05, 8: .06, 12: .07, 20: .09, 30: .09}   # wavelengths: length of the segments of faces that long
ANGLES_DEG = (0, 4, 8, 12, 16)  # from the corner's axis of symmetry
QUARTER = 1 / 4  # wavelengths: cells of the iteration; smaller ones move it by .1 dB
NUM_RAYS = 1 << 14
HALF = np.sqrt(0.5)
RAYS_OF_FEW = 1 << 16


def bessel(count, x):
    """J_n and Y_n, n < count: the first by Miller's downward recurrence, the second upward from Y_0."""
    high = int(x) + count + 30
    j = np.zeros(high + 2)
    j[high] = 1e-200
    for n in range(high, 0, -1):
        j[n - 1] = 2 * n / x * j[n] - j[n + 1]
    j /= j[0] + 2 * j[2::2].sum()
    y = np.zeros(count)
    y[0] = -hankel(x).imag
    y[1] = (j[1] * y[0] - 2 / (np.pi * x)) / j[0]
    for n in range(1, count - 1):
        y[n + 1] = 2 * n / x * y[n] - y[n - 1]
    return j[:count], y


@pytest.mark.parametrize("polarization", ["tm", "te"])
@pytest.mark.parametrize("ka", [3.3, 10.2])
def test_method_of_moments_has_the_echo_width_of_a_cylinder(polarization, ka):
    # Harrington, "Time-Harmonic Electromagnetic Fields" (1961), 5-9.
    count = int(ka) + 12
    j, y = bessel(count + 1, ka)
    if polarization == "te":
        j, y = (np.append(-f[1], (f[:-2] - f[2:]) / 2) for f in (j, y))
    order = np.arange(count)
    terms = (-1.0) ** order * np.where(order == 0, 1, 2) * j[:count] / (j - 1j * y)[:count]
    turn = 2 * np.pi * np.linspace(0, 1, max(60, int(20 * ka)) + 1)
    circle = Strips(ka / (2 * np.pi) * np.stack([np.cos(turn), np.sin(turn)], axis=1), is_closed=True)
    assert circle.echo_width(0, polarization) == pytest.approx(2 / np.pi * abs(terms.sum()) ** 2, rel=MOMENTS, abs=0)


def faces_of_dihedral(side, height):
    """Two faces of right angles, the edge along z, as (corner, edge, edge); sides and height in m."""
    corner = (0, 0, -height / 2)
    return [(corner, (HALF * side, sign * HALF * side, 0), (0, 0, height)) for sign in (1, -1)]


def echo_width_of_corner(side):
    """Of a dihedral of that many wavelengths by the method of moments, mean in dB of both polarisations, in wavelengths."""
    strips = Strips(polyline([(HALF * side, HALF * side), (0, 0), (HALF * side, -HALF * side)], SEGMENT[side]))
    return 0.5 * sum(decibel(strips.echo_width(ANGLES_DEG, polarization)) for polarization in ("tm", "te"))


# Both polarisations differ by up to .5 dB from their mean at 4 wavelengths, and geometrical optics knows neither.
@pytest.mark.parametrize("side", SEGMENT)
def test_dihedrals_of_few_wavelengths_have_the_echo_of_the_method_of_moments(side):
    # So long that its ends do not count: sigma = 2 height^2 / wavelength times the echo width.
    height = 10 + 8 * np.sqrt(side)
    scene = ep.Scene()
    for name, face in zip(("left", "right"), faces_of_dihedral(side * WAVELENGTH, height * WAVELENGTH)):
        scene.add(rectangle(*face), name=name, material=METAL)
    found = ep.rcs(scene, frequency=FREQUENCY, incidence=in_plane(ANGLES_DEG), num_rays=NUM_RAYS)
    expected = echo_width_of_corner(side) + decibel(2 * (height * WAVELENGTH) ** 2)
    assert np.max(np.abs(decibel(np.asarray(found)) - expected)) < CORNER_DB


def triangles_of_dihedral(side, height):
    """[F, 3, 3] of faces that are cut differently, so that their rims do not match where they meet."""
    triangles = []
    for (corner, along, up), cuts in zip(faces_of_dihedral(side, height), ((0, .31, 1), (0, .5, .77, 1))):
        at = lambda u, v: np.asarray(corner) + u * np.asarray(along) + v * np.asarray(up)
        for low, high in zip(cuts[:-1], cuts[1:]):
            for bottom, top in ((0, .4), (.4, 1)):
                quad = [at(low, bottom), at(high, bottom), at(high, top), at(low, top)]
                triangles += [quad[:3], [quad[0], quad[2], quad[3]]]
    return np.array(triangles)


def triangles_of_trihedral(edge):
    tips = edge * np.eye(3)
    halves = [0.37 * tips[k] + 0.63 * tips[k - 1] for k in range(3)]
    return np.array([[np.zeros(3), end, halves[k]] for k in range(3) for end in (tips[k], tips[k - 1])])


def one_object(triangles, groups):
    """The same triangles as the given number of meshes (0: one for each), dealt out in turn, below one object."""
    groups = groups or len(triangles)
    scene = ep.Scene()
    scene.add(name="corner")
    for k in range(groups):
        part = triangles[k::groups]
        scene.add(ep.Mesh(part.reshape(-1, 3), np.arange(3 * len(part)).reshape(-1, 3)), name=f"part{k}", material=METAL,
                  parent="corner")
    return scene


# Field vectors: how double bounces interfere with the triple one depends on the polarisation, which the scalar model has not.
@pytest.mark.parametrize("edge, incidence", [(.016, (1, 1, 1)), (.03, (1, .7, .5))])
def test_trihedrals_of_few_wavelengths_have_the_echo_of_iterated_physical_optics(edge, incidence):
    faces = iterated_optics.trihedral(edge / WAVELENGTH, QUARTER)
    vertical, horizontal = (0, 0, 1), np.cross((0, 0, 1), incidence)
    found = ep.rcs(one_object(triangles_of_trihedral(edge), 3), frequency=FREQUENCY, incidence=incidence, num_rays=NUM_RAYS,
                   polarization=["vv", "hh"])
    for section, polarization in zip(found, (vertical, horizontal)):
        expected = WAVELENGTH ** 2 * iterated_optics.rcs(faces, incidence, polarization)
        assert abs(decibel(section / expected)) < CORNER_DB


@pytest.mark.parametrize("triangles, incidence", [
    (triangles_of_dihedral(.016, .03), (1, 0, .1)), (triangles_of_dihedral(.03, .03), (1, .3, 0)),
    (triangles_of_trihedral(.03), (1, 1, 1)), (triangles_of_trihedral(.042), (1, .7, .5)),
    (triangles_of_trihedral(.1), (1, .5, .6))])
def test_corners_return_the_same_however_they_are_cut_into_meshes(triangles, incidence):
    whole, halves, thirds, single = (ep.rcs(one_object(triangles, groups), frequency=FREQUENCY, incidence=incidence,
                                            num_rays=1 << 13) for groups in (1, 2, 3, 0))
    assert [halves, thirds, single] == pytest.approx([whole] * 3, rel=RECORD, abs=0)


def flank_and_ball(radius):
    """A smooth metal body like the side of a car, and a metal ball before it."""
    flank = sphere((0, 0, 0), 1.0, 6)
    flank = ep.Mesh(np.asarray(flank.vertices) * (2.2, .9, .7) + (7, 3, 0), flank.triangles)
    return scene_of(flank=(flank, METAL, True), ball=(sphere((5, .4, .1), radius, 5), METAL, True))


@pytest.mark.parametrize("radius", [.1, .3])
def test_of_two_orders_the_better_resolved_one_stands(radius):
    """Rays that aim at the ball find the flank behind it, those that aim at the flank hardly the ball."""
    few, many = (ep.trace(flank_and_ball(radius), make_radar((0, 0, 0)), num_rays=num_rays, max_bounces=2)
                 for num_rays in (RAYS_OF_FEW, 1 << 17))
    power = {order: decibel(abs(fields(paths.select(order)).sum()) ** 2)
             for order, paths in (("T 'flank' 'ball' R", few), ("T 'ball' 'flank' R", many))}
    assert abs(power["T 'flank' 'ball' R"] - power["T 'ball' 'flank' R"]) < ORDER_DB
