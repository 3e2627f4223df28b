"""The warning of coarse curved surfaces, against levels of icospheres known from an independent simulator."""
import re
import warnings

import numpy as np
import pytest

import echopath as ep
from echopath.tracing import tessellation
from support.shapes import lambert

WAVELENGTH = ep.speed_of_light / 77e9
RADIUS = 0.1
LEVELS = {2: (1.52, 5.0), 3: (0.76, 1.8), 4: (0.38, 0.30), 5: (0.19, 0.01)}  # edge / sqrt(a lambda), |error| in dB
RATIO_TOLERANCE = 0.03    # relative: edges of an icosphere differ among themselves
ERROR_TOLERANCE = 0.15    # relative: below 0.3 dB the error grows with the fifth power of the edge
FLAT_STRIP = 0.01    # relative: radii and edges are means over a ring of flat strips


def icosphere(subdivisions):
    return ep.actors.sphere(RADIUS, subdivisions=subdivisions)


def radar():
    return ep.Radar(ep.ChirpSequence(num_chirps=1), transmitters=[ep.Antenna()], receivers=[ep.Antenna()])


def warnings_of(shape, *, smooth=False, material="metal"):
    scene = ep.Scene()
    scene.add(shape, name="thing", material=material, position=(5, 0, 0), smooth=smooth)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        ep.trace(scene, radar(), num_rays=10, max_bounces=1)
    return [str(one.message) for one in caught if issubclass(one.category, ep.TessellationWarning)]


def measured(mesh):
    return tessellation.tessellation(mesh.vertices, mesh.triangles)


def as_mesh(shape):
    return shape if isinstance(shape, ep.Mesh) else shape.parts[0].mesh


@pytest.mark.parametrize("subdivisions", LEVELS)
def test_icospheres_have_their_radius_and_their_known_error(subdivisions):
    found = measured(as_mesh(icosphere(2**subdivisions)))
    ratio, error = LEVELS[subdivisions]
    assert found.ratio(WAVELENGTH) == pytest.approx(ratio, rel=RATIO_TOLERANCE, abs=0)
    assert found.radius == pytest.approx(RADIUS, rel=0.06, abs=0)  # the coarsest facets stray by 3 %
    assert tessellation.facet_error_db(found.ratio(WAVELENGTH)) == pytest.approx(error, rel=ERROR_TOLERANCE, abs=0)


@pytest.mark.parametrize("smooth", [False, True])
@pytest.mark.parametrize("scales", [(10.0, 10.0, 10.0), (0.1, 0.1, 0.1), (4.0, -4.0, 4.0), (2.0, 8.0, 1.0)])
def test_objects_that_are_scaled_are_told_as_their_larger_meshes(scales, smooth):
    mesh = as_mesh(icosphere(12))
    half = np.diag([*np.sqrt(np.abs(scales)), 1.0])
    placed, larger = ep.Scene(), ep.Scene()
    placed.add(None, name="group", transform=half, position=(0, 0, 0))
    placed.add(mesh, name="ball", parent="group", material="metal", transform=half * np.sign([*scales, 1.0]), smooth=smooth)
    larger.add(ep.Mesh(mesh.vertices * np.abs(scales), mesh.triangles), name="ball", material="metal", smooth=smooth)
    told, expected = ([one.fault for one in tessellation.coarse_meshes(scene, 77e9)] for scene in (placed, larger))
    assert told == expected


def test_figures_whose_skins_scale_them_are_told_as_they_stand():
    """Files of figures in cm have joints that make metres of them."""
    mesh, told = as_mesh(icosphere(12)), []
    for unit in (1.0, 100.0):
        joint = ep.Joint("hip", transform=np.eye(4), inverse_bind=np.diag([1.0 / unit] * 3 + [1.0]))
        skin = ep.Skin(unit * mesh.vertices, [joint], np.ones((len(mesh.vertices), 1)))
        scene = ep.Scene()
        scene.add(ep.Mesh(unit * mesh.vertices, mesh.triangles), name="figure", material="metal", motion=skin)
        told.append([one.fault for one in tessellation.coarse_meshes(scene, 77e9)])
    assert told[0] == told[1] != []


def test_each_figure_of_a_scene_has_its_own_skin():
    """Nobody keeps the skins while they are asked, one after the other: what stands where another one stood is not that one."""
    def figure(num_sides, scale):
        mesh = as_mesh(icosphere(num_sides))
        joint = ep.Joint("hip", transform=np.eye(4), inverse_bind=np.diag([1.0 / scale] * 3 + [1.0]))
        skin = ep.Skin(mesh.vertices, [joint], np.ones((len(mesh.vertices), 1)))
        return {"mesh_or_actor": mesh, "material": "metal", "motion": skin}

    scene, alone = ep.Scene(), []
    for k, (num_sides, scale) in enumerate([(12, 1.0), (6, 2.0), (10, 0.5), (4, 3.0), (8, 1.5)]):
        one = ep.Scene()
        one.add(name=f"figure {k}", **figure(num_sides, scale))
        alone += [found.fault for found in tessellation.coarse_meshes(one, 77e9)]
        scene.add(name=f"figure {k}", **figure(num_sides, scale))
    assert [found.fault for found in tessellation.coarse_meshes(scene, 77e9)] == alone != []


def with_road(mesh, side=40.0):
    """One mesh of a body and a square below it, as foreign files have them."""
    vertices = np.array([(x, y, -1.0) for x in (-side, side) for y in (-side, side)])
    return ep.Mesh(np.concatenate([mesh.vertices, vertices]),
                   np.concatenate([mesh.triangles, len(mesh.vertices) + np.array([(0, 2, 3), (0, 3, 1)])]))


@pytest.mark.parametrize("subdivisions", LEVELS)
def test_a_road_in_the_same_mesh_hides_no_coarse_body(subdivisions):
    """The road is four orders of magnitude larger than the sphere: neither its area nor its facets count."""
    alone = as_mesh(icosphere(2**subdivisions))
    found, wanted = measured(with_road(alone)), measured(alone)
    for name in ("edge", "radius", "curved_area"):
        assert getattr(found, name) == pytest.approx(getattr(wanted, name), rel=1e-9)
    assert len(warnings_of(with_road(alone))) == len(warnings_of(icosphere(2**subdivisions)))


def test_the_rim_of_a_flat_disc_is_part_of_it():
    """A thin disc is one piece, of which its rim is next to nothing: planes have no curved surfaces."""
    angle = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    ring = np.stack([0.0 * angle, np.cos(angle), np.sin(angle)], axis=1)
    vertices = np.concatenate([ring, ring + (0.01, 0, 0), [(0, 0, 0), (0.01, 0, 0)]])
    triangles = [t for k, n in zip(range(24), [*range(1, 24), 0]) for t in (
        (k, n, 24 + n), (k, 24 + n, 24 + k), (48, n, k), (49, 24 + k, 24 + n))]
    assert measured(ep.Mesh(vertices, triangles)) is None
    assert warnings_of(with_road(ep.Mesh(vertices, triangles))) == []


def test_coarse_spheres_are_warned_of_and_fine_ones_are_not():
    for subdivisions in (2, 3):
        (text,) = warnings_of(icosphere(2**subdivisions))
        assert "'thing'" in text and "mm" in text and "smooth=True" in text
    assert "7.7 mm would do" in text  # 0.4 sqrt(97.5 mm 3.89 mm) = 7.79 mm, rounded down
    for subdivisions in (4, 5):
        assert warnings_of(icosphere(2**subdivisions)) == []


def test_lengths_are_told_in_units_that_fit_them():
    """A dome of 2.5 km: edges of 0.4 sqrt(2500 m 3.89 mm) = 1.25 m would do."""
    (text,) = warnings_of(ep.actors.sphere(2500.0, subdivisions=8))
    assert re.search(r"edges of \d{3} m on a surface curved with a radius of 2.\d+ km .* 1.2 m would do", text)


def test_smooth_spheres_may_be_four_times_coarser():
    assert warnings_of(icosphere(4), smooth=True) == []
    (text,) = warnings_of(icosphere(2), smooth=True)
    assert "smooth=True" not in text


def test_strips_of_a_cylinder_count_by_their_width():
    sides, radius, length = 48, 0.2, 1.0
    angle = 2 * np.pi * np.arange(sides) / sides
    ring = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0 * angle], axis=1)
    i = np.arange(sides)
    j = (i + 1) % sides
    triangles = np.concatenate([np.stack([i, j, j + sides], 1), np.stack([i, j + sides, i + sides], 1)])
    found = tessellation.tessellation(np.concatenate([ring, ring + [0, 0, length]]), triangles)
    width = 2 * radius * np.sin(np.pi / sides)
    # A triangle of half a strip lies sqrt(2/3) as far from the surface, in mean, as an equilateral one of that edge.
    assert found.edge == pytest.approx(width * np.sqrt(2 / 3), rel=FLAT_STRIP, abs=0)
    assert found.radius == pytest.approx(radius, rel=FLAT_STRIP, abs=0)


def bent_plate(pieces):
    """Two planes that meet at 20 degrees."""
    grid = np.arange(pieces + 1) / pieces
    x, y = (values.ravel() for values in np.meshgrid(grid, grid, indexing="ij"))
    corner = (np.arange(pieces)[:, None] * (pieces + 1) + np.arange(pieces)).ravel()
    right, up = pieces + 1, 1
    triangles = np.concatenate([np.stack([corner, corner + right, corner + right + up], 1),
                                np.stack([corner, corner + right + up, corner + up], 1)])
    return ep.Mesh(np.stack([x, y, np.tan(np.radians(10)) * np.abs(x - 0.5)], axis=1), triangles)


@pytest.mark.parametrize("shape", [
    ep.actors.plate(1.0, 2.0), ep.actors.plate(1.0, 1.0, edge=0.1), ep.actors.box((1.0, 2.0, 0.5)),
    ep.actors.box((1.0, 1.0, 1.0), edge=0.1), ep.actors.trihedral(0.3), bent_plate(2), bent_plate(10),
], ids=["plate", "fine plate", "box", "fine box", "trihedral", "bend", "fine bend"])
def test_planes_and_their_edges_are_no_curved_surfaces(shape):
    assert warnings_of(shape) == []


def test_what_has_no_coherent_echo_is_not_asked_for_fineness():
    assert warnings_of(icosphere(4), material=lambert(0.27)) == []
    assert warnings_of(icosphere(4), material=ep.Material(permittivity=4.0, roughness_height=2e-3)) == []
    scene = ep.Scene()
    scene.add(ep.actors.pedestrian(), name="pedestrian", position=(5, 0, 0))
    with warnings.catch_warnings():
        warnings.simplefilter("error", ep.TessellationWarning)
        ep.trace(scene, radar(), num_rays=10)
