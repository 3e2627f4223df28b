"""edges=True in corners: edges behind and before mirrors that nobody flagged."""
import numpy as np
import pytest

import echopath as ep
from support.references.method_of_moments import Strips, polyline
from support.shapes import FREQUENCY, METAL, WAVELENGTH, decibel, fields, make_radar, rectangle

HALF = np.sqrt(0.5)
SAME = 1e-6           # single precision of weights
CORNER_DB = 0.5       # the promise within 16 degrees of the axis of symmetry; .34 found
ANGLES_DEG = np.arange(0, 43, 3)
OF_REPLAY = 0.02      # shares of the field that stay as at the trace, over one degree; .01 found
ON_EDGE, PAST_EDGE = 4, 32  # bits of Paths.flags


def faces(side, height):
    """Of a right-angled dihedral along z: (corner, edge, edge), m."""
    return [((0, 0, -height / 2), (HALF * side, sign * HALF * side, 0), (0, 0, height)) for sign in (1, -1)]


def one_mesh(side, height, **keywords):
    corners = np.concatenate([np.asarray(part.vertices)[np.asarray(part.triangles)].reshape(-1, 3)
                              for part in (rectangle(*face) for face in faces(side, height))])
    scene = ep.Scene()
    scene.add(ep.Mesh(corners, np.arange(len(corners)).reshape(-1, 3)), name="corner", material=METAL, **keywords)
    return scene


def two_meshes(side, height):
    scene = ep.Scene()
    scene.add(name="corner")
    for name, face in zip(("left", "right"), faces(side, height)):
        scene.add(rectangle(*face), name=name, material=METAL, parent="corner")
    return scene


def trace(scene, *, position=(2.0, 0.4, 0.1), **keywords):
    radar = make_radar(position, polarization=(0.0, 0.28, 0.96))
    return ep.trace(scene, radar, **{"num_rays": 1 << 12, "edges": True, "polarization": "jones", "max_bounces": 3, **keywords})


def over_planes(paths):
    return (np.asarray(paths.flags) & ON_EDGE > 0) & (np.asarray(paths.num_bounces) > 1)


# --- against the method of moments ---

@pytest.mark.parametrize("side", [4, 6])
def test_dihedrals_of_few_wavelengths_have_the_echo_of_the_method_of_moments_in_either_polarisation(side):
    strips = Strips(polyline([(HALF * side, HALF * side), (0, 0), (HALF * side, -HALF * side)], 0.08))
    height = 10 + 8 * np.sqrt(side)  # so long that its ends do not count
    angles = np.radians(ANGLES_DEG)
    incidence = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    scene = one_mesh(side * WAVELENGTH, height * WAVELENGTH)
    mean = {}
    for edges in (False, True):
        found = decibel(np.asarray(ep.rcs(scene, frequency=FREQUENCY, incidence=incidence, polarization=["vv", "hh"],
                                          num_rays=1 << 13, edges=edges)))
        expected = np.stack([decibel(strips.echo_width(ANGLES_DEG, one)) for one in ("tm", "te")], axis=1)
        error = np.abs(found - expected - decibel(2 * (height * WAVELENGTH) ** 2))
        mean[edges] = error.mean(axis=0)
        assert not edges or error[ANGLES_DEG <= 16].max() < CORNER_DB
    assert mean[True][0] < 0.6 * mean[False][0] and mean[True][1] < mean[False][1]


# --- the paths ---

@pytest.fixture(scope="module")
def of_a_corner():
    return trace(one_mesh(0.03, 0.05))


def test_paths_name_the_planes_before_and_behind_the_edge(of_a_corner):
    found = over_planes(of_a_corner)
    numbers = [of_a_corner.select(way).num_paths for way in ("T . E R", "T E . R", "T . E . R")]
    assert sum(numbers) == found.sum() and min(numbers) > 0
    past = np.asarray(of_a_corner.flags) & PAST_EDGE > 0
    assert 0 < past.sum() <= of_a_corner.select("T E . R").num_paths and not np.any(past & ~found)


def test_points_of_reflection_lie_on_the_faces(of_a_corner):
    points, first = of_a_corner.points(of_a_corner.frame.trace_time), np.asarray(of_a_corner.offsets)
    for k in range(2):
        x, y, z = points[first[over_planes(of_a_corner)] + k].T
        assert np.abs(x - np.abs(y)).max() < 1e-6 and np.abs(z).max() < 0.0250001 and x.max() < 0.03 * HALF + 1e-6


def test_faces_of_two_meshes_have_the_same_paths(of_a_corner):
    apart = trace(two_meshes(0.03, 0.05))
    sums = [fields(paths)[over_planes(paths)].sum() for paths in (of_a_corner, apart)]
    assert sums[1] == pytest.approx(sums[0], rel=SAME)
    assert over_planes(apart).sum() == over_planes(of_a_corner).sum()
    for first, last in (("left", "right"), ("right", "left")):
        assert apart.select(f"T 'corner/{first}' E'corner/{last}' R").num_paths > 0


def test_they_are_the_same_for_any_number_of_threads(of_a_corner):
    ep.set_num_threads(1)
    try:
        alone = trace(one_mesh(0.03, 0.05))
    finally:
        ep.set_num_threads(0)
    assert np.array_equal(alone.weight, of_a_corner.weight) and np.array_equal(alone.hits, of_a_corner.hits)


def test_parts_add_up_and_files_keep_them(of_a_corner, tmp_path):
    parts = ep.decompose(of_a_corner, of_a_corner.radar, {"edges": "T .* E .* R"})
    whole = ep.synthesize(of_a_corner, of_a_corner.radar, tolerance=1e-9)
    assert np.abs(sum(parts.values()) - whole).max() < 1e-6 * np.abs(whole).max()
    of_a_corner.save(tmp_path / "corner.h5")
    again = ep.Paths.load(tmp_path / "corner.h5")
    assert np.array_equal(again.flags, of_a_corner.flags) and np.array_equal(again.amplitude, of_a_corner.amplitude)


def test_without_edges_no_plane_is_remembered(of_a_corner):
    plain = trace(one_mesh(0.03, 0.05), edges=False)
    assert plain.num_paths == of_a_corner.select("T S+ R").num_paths and not over_planes(plain).any()


def test_hidden_planes_light_no_edges():
    scene = one_mesh(0.03, 0.05)
    scene.add(rectangle((0.05, -0.1, -0.1), (0, 0.2, 0), (0, 0, 0.2)), name="screen", material=METAL)
    assert not over_planes(trace(scene, position=(2.0, 0.0, 0.0))).any()


# --- replay ---

def test_a_turning_corner_keeps_its_edges():
    spin = ep.LinearMotion(angular_velocity=(0.0, 0.0, 4.0))
    paths, later = (trace(one_mesh(0.03, 0.05, motion=spin), start_time=time) for time in (0.0, 0.005))

    def sum_at(record, time):
        cycles = record.lengths([time])[0] * (record.radar.waveform.start_frequency / ep.speed_of_light)
        return (record.amplitudes([time])[0] * np.exp(-2j * np.pi * np.mod(cycles, 1.0)))[over_planes(record)].sum()

    anew = sum_at(later, later.frame.trace_time)
    assert abs(sum_at(paths, later.frame.trace_time) - anew) < OF_REPLAY * abs(anew)
    assert abs(sum_at(paths, paths.frame.trace_time) - anew) > OF_REPLAY * abs(anew)


def test_another_receiver_finds_the_edges_of_its_own():
    """What the receiver sees over planes is found too where it stands apart."""
    radar = make_radar((2.0, 0.4, 0.1), (2.0, -0.2, 0.0), polarization=(0.0, 0.28, 0.96))
    paths = ep.trace(one_mesh(0.03, 0.05), radar, num_rays=1 << 12, edges=True, polarization="jones", max_bounces=3)
    assert min(paths.select(way).num_paths for way in ("T . E R", "T E . R", "T . E . R")) > 0


def test_which_way_triangles_are_wound_does_not_count():
    """It decides at which end edges begin; both faces and all of their edges are the same."""
    corner = ep.actors.dihedral(0.15)
    vertices, triangles = np.asarray(corner.vertices), np.asarray(corner.triangles)
    found = []
    for wound in (triangles, triangles[:, ::-1], np.roll(triangles, 1, axis=1)[::-1]):
        scene = ep.Scene()
        scene.add(ep.Mesh(vertices, wound), name="corner", material=METAL)
        found.append(decibel(np.asarray(ep.rcs(scene, frequency=10e9, incidence=[(-1, 0.3, 0.2), (-0.5, 0.1, 1), (-1, 0.1, 0.5)],
                                               polarization=["vv", "hh"], num_rays=1 << 13, edges=True))))
    assert np.max(np.abs(np.array(found) - found[0])) < 0.01  # 4 dB where an end decides
