"""edges=True: what sharp edges add to physical optics, as paths with a point on an edge."""
import math
import pickle

import numpy as np
import pytest

import echopath as ep
from support.shapes import sphere

INCH = 0.0254
FREQUENCY = 10.24e9
WAVENUMBER = 2.0 * math.pi * FREQUENCY / 299792458.0
WIDTH, HEIGHT = 10.5 * INCH, 6.0 * INCH  # across and along the axis about which the plate turns
FEW_RAYS = 2 ** 12
WEAK_CHAINS = 0.03    # waves from edge to edge that count as none for one polarisation and not for both
SAME = 1e-6           # single precision of weights and barycentric coordinates
FIRST_ORDER_DB = 0.2  # the rays' own physical optics
HIGHER_ORDER_DB = 0.5  # near the edges' own transitions, which the closed form leaves out
THIN_PLATE_DB = 1.5    # the theory; without waves from edge to edge 3 dB


def sheet(width: float = WIDTH, height: float = HEIGHT) -> ep.Mesh:
    """A rectangle of two triangles in the yz-plane."""
    corners = [(0.0, y * width / 2.0, z * height / 2.0) for y in (-1, 1) for z in (-1, 1)]
    return ep.Mesh(np.array(corners), np.array([(0, 1, 3), (0, 3, 2)]))


def box(size) -> ep.Mesh:
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * np.asarray(size) / 2.0
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return ep.Mesh(corners, np.array([t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]))


def scene_of(mesh, **keywords) -> ep.Scene:
    scene = ep.Scene()
    scene.add(mesh, name="plate", **{"material": ep.Material.metal(), **keywords})
    return scene


def directions(angles):
    return np.stack([np.cos(angles), np.sin(angles), np.zeros_like(angles)], axis=1)


def radar_at(position=(8.0, 0.5, 1.0), *, polarization=(0.0, 0.0, 1.0), receiver=None, num_chirps=1) -> ep.Radar:
    waveform = ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=100e6, num_samples=64, sampling_rate=1e6,
                                num_chirps=num_chirps, chirp_interval=200e-6)
    antenna = {"polarization": polarization}
    return ep.Radar(waveform, transmitters=[ep.Antenna(position, **antenna)],
                    receivers=[ep.Antenna(position if receiver is None else receiver, **antenna)])


def trace(scene, radar, **keywords):
    return ep.trace(scene, radar, **{"num_rays": 200, "edges": True, **keywords})


def fields(paths, time=None):
    """[P] amplitudes with the phases of their lengths."""
    time = paths.frame.trace_time if time is None else time
    return paths.amplitudes([time])[0] * np.exp(-1j * WAVENUMBER * paths.lengths([time])[0])


def on_edges(paths):
    return paths.select("T .* E .* R")


# --- against theory ---

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


# --- replay ---

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


# --- the record ---

@pytest.fixture(scope="module")
def of_a_box():
    return trace(scene_of(box((0.4, 0.5, 0.6)), yaw=0.4), radar_at(), num_rays=2000)


def test_paths_name_a_point_on_an_edge(of_a_box):
    edges = of_a_box.select("T E R")
    assert edges.num_paths > 0 and set(edges.num_bounces) == {1}
    first = np.asarray(edges.offsets)
    u, v = np.asarray(edges.u)[first], np.asarray(edges.v)[first]
    assert np.all((u == 0.0) | (v == 0.0) | (u.astype(float) + v == 1.0))
    corner = edges.points(0.0)[first] - np.mean(edges.points(0.0)[first], axis=0)
    assert np.ptp(corner, axis=0) == pytest.approx([0.56, 0.61, 0.58], abs=0.05)


def test_only_edges_that_both_antennas_see_make_echoes(of_a_box):
    """Three faces of the box are in sight, with nine of its twelve edges."""
    scene = scene_of(box((0.4, 0.5, 0.6)), yaw=0.4)
    triangles = np.unique(np.asarray(on_edges(of_a_box).triangle_id)[np.asarray(on_edges(of_a_box).offsets)])
    assert len(triangles) >= 5
    scene.add(box((0.01, 5.0, 5.0)), name="screen", position=(4.0, 0.0, 0.0), material=ep.Material.metal())
    hidden = trace(scene, radar_at())
    assert hidden.select("T E'plate' R").num_paths == 0 < hidden.select("T E'screen' R").num_paths


def test_expressions_and_partitions_know_them(of_a_box):
    edges = of_a_box.select("T E R")
    assert edges.num_paths == of_a_box.select("T E'plate' R").num_paths == of_a_box.select("T ['plate'] R & T E R").num_paths
    assert (of_a_box.select("T S R").num_paths + edges.num_paths == of_a_box.select("T . R").num_paths
            == of_a_box.num_paths - of_a_box.select("T E E+ R").num_paths)
    assert of_a_box.select("T D R").num_paths == of_a_box.select("T E S R").num_paths == 0
    radar = of_a_box.radar
    parts = ep.decompose(of_a_box, radar, {"edges": "T E R"})
    assert parts["edges"] == pytest.approx(ep.synthesize(edges, radar, tolerance=1e-9), abs=1e-6 * np.abs(parts["edges"]).max())
    assert list(of_a_box.to_dataframe()["events"]).count("E") == edges.num_paths


def test_files_and_pickles_keep_them(of_a_box, tmp_path):
    of_a_box.save(tmp_path / "box.h5")
    for again in (ep.Paths.load(tmp_path / "box.h5"), pickle.loads(pickle.dumps(of_a_box))):
        assert again.frame.edges
        assert np.array_equal(again.flags, of_a_box.flags)
        assert np.array_equal(on_edges(again).amplitude, on_edges(of_a_box).amplitude)


def arrays_of(paths) -> tuple[np.ndarray, dict]:
    """(hits, {name: column}) of paths, which a test may change."""
    names = ("offsets", "num_bounces", "diffuse", "weight", "stratum", "batch", "flags", "curved_cell", "jones")
    columns = {name: np.array(getattr(paths, name)) for name in names}
    return np.array(paths.hits), {name: value for name, value in columns.items() if len(value)}


def test_a_record_whose_edge_has_no_mirror_behind_it_is_refused(of_a_box):
    hits, columns = arrays_of(of_a_box)
    columns["flags"][np.flatnonzero(columns["flags"] & 4)[0]] |= 32
    with pytest.raises(ValueError, match="flags: must name an edge before a mirror"):
        ep.Paths.from_arrays(hits=hits, **columns, scene=of_a_box.scene, radar=of_a_box.radar, frame=of_a_box.frame)


def test_a_record_whose_edge_is_none_is_refused(of_a_box):
    hits, columns = arrays_of(of_a_box)
    edge = int(np.flatnonzero(columns["flags"] & 4)[0])
    hits["u"][columns["offsets"][edge]] = hits["v"][columns["offsets"][edge]] = 0.25
    with pytest.raises(ValueError, match="flags: must name hits on sharp edges"):
        ep.Paths.from_arrays(hits=hits, **columns, scene=of_a_box.scene, radar=of_a_box.radar, frame=of_a_box.frame)


def test_the_frame_stays_valid_while_nothing_moves(of_a_box):
    report = ep.validity(of_a_box, of_a_box.radar)
    assert report.ok
    assert report.occluded_share == report.turned_share == report.left_share == 0.0


# --- from edge to edge ---

@pytest.fixture(scope="module")
def of_a_small_sheet():
    motion = ep.LinearMotion(velocity=(1.0, -2.0, 0.5), angular_velocity=(0.0, 0.3, 10.0))
    return trace(scene_of(sheet(0.3, 0.4), yaw=1.0, motion=motion), radar_at(polarization=(0.0, 1.0, 0.0), num_chirps=64))


def test_paths_from_edge_to_edge_name_all_their_points(of_a_small_sheet, tmp_path):
    chains = of_a_small_sheet.select("T E E+ R")
    assert chains.num_paths == of_a_small_sheet.select("T E{2,4} R").num_paths > 0
    assert set(chains.num_bounces) <= {2, 3, 4} and set(chains.to_dataframe()["events"]) <= {"EE", "EEE", "EEEE"}
    first, second = (chains.points(chains.frame.trace_time)[np.asarray(chains.offsets) + k] for k in (0, 1))
    assert np.linalg.norm(first - second, axis=1).max() < 0.5
    chains.save(tmp_path / "chains.h5")
    assert np.array_equal(ep.Paths.load(tmp_path / "chains.h5").amplitude, chains.amplitude)


def test_waves_from_edge_to_edge_follow_a_turning_plate(of_a_small_sheet):
    """The points stay where they are on the plate; new ones lie where the cone is by then."""
    later = trace(of_a_small_sheet.scene, of_a_small_sheet.radar, start_time=0.003)
    there = [fields(paths.select("T E E R"), later.frame.trace_time).sum() for paths in (of_a_small_sheet, later)]
    assert abs(there[0] - there[1]) < 0.1 * abs(there[1])


def test_only_faces_of_few_wavelengths_carry_waves_from_edge_to_edge():
    """From one edge to the other across a sheet that is wider than 40 wavelengths there is none."""
    wavelength = 299792458.0 / FREQUENCY
    for size, has_some in ((1.1, True), (1.3, False)):
        chains = trace(scene_of(sheet(2.0, size)), radar_at((2.0, 0.0, 7.5), polarization=(1.0, 0.0, 0.0))).select("T E E R")
        first, second = (chains.points(0.0)[np.asarray(chains.offsets) + k] for k in (0, 1))
        ways = np.linalg.norm(first - second, axis=1)
        assert ways.max(initial=0.0) < 40.0 * wavelength and bool(np.any(ways > 35.0 * wavelength)) == has_some


# --- seams ---

def faces_of(mesh: ep.Mesh) -> list[ep.Mesh]:
    """A mesh for each pair of triangles."""
    vertices, triangles = np.asarray(mesh.vertices), np.asarray(mesh.triangles)
    return [ep.Mesh(vertices[pair].reshape(-1, 3), np.arange(6).reshape(2, 3)) for pair in triangles.reshape(-1, 2, 3)]


def parts_scene(mesh, motions=None, **keywords) -> ep.Scene:
    scene = ep.Scene()
    for k, face in enumerate(faces_of(mesh)):
        motion = {"motion": motions[k]} if motions and motions[k] else {}
        scene.add(face, name=f"face_{k}", material=ep.Material.metal(), **motion, **keywords)
    return scene


def test_a_box_of_six_meshes_is_one_box():
    whole, parts = (fields(on_edges(trace(scene, radar_at(), polarization="jones"))) for scene in (
        scene_of(box((0.4, 0.5, 0.6)), yaw=0.4), parts_scene(box((0.4, 0.5, 0.6)), yaw=0.4)))
    assert len(whole) == len(parts)
    assert parts.sum() == pytest.approx(whole.sum(), rel=SAME)


def test_a_sheet_cut_in_two_has_no_rim_where_it_is_cut():
    cut = [ep.Mesh(np.array(corners) @ np.diag([1.0, 0.5, 0.5]), np.array([(0, 1, 3), (0, 3, 2)])) for corners in (
        [(0, y, z) for y in (-1, 0) for z in (-1, 1)], [(0, y, z) for y in (0, 1) for z in (-1, 1)])]
    scene = ep.Scene()
    for name, half in zip("ab", cut):
        scene.add(half, name=name, material=ep.Material.metal())
    points = on_edges(trace(scene, radar_at(), max_bounces=1))
    middle = np.abs(points.points(0.0)[np.asarray(points.offsets)][:, 1])
    assert len(middle) > 0 and not np.any((middle < 1e-6) & (middle == middle.min()))


def test_meshes_that_move_apart_have_rims_of_their_own():
    motions = [ep.LinearMotion(velocity=(0.0, 0.0, 1.0)), *[None] * 5]
    one, apart = (on_edges(trace(parts_scene(box((0.4, 0.5, 0.6)), motions), radar_at(), max_bounces=1)).num_paths
                  for motions in (None, motions))
    assert apart > one


# --- what has none ---

@pytest.mark.parametrize("material, has_edges", [
    (ep.Material.metal(), True), (ep.Material(reflectivity=0.25), True), (ep.Material(permittivity=4.0 - 0.2j), False)])
def test_edges_of_conductors_make_echoes(material, has_edges):
    paths = trace(scene_of(sheet(), material=material), radar_at())
    assert (on_edges(paths).num_paths > 0) == has_edges


def test_a_surface_that_reflects_less_has_weaker_edges():
    full, half = (fields(on_edges(trace(scene_of(sheet(), material=material), radar_at()))).sum()
                  for material in (ep.Material.metal(), ep.Material(reflectivity=0.25)))
    assert half == pytest.approx(0.5 * full, rel=1e-5)


def test_round_bodies_have_none():
    assert on_edges(trace(scene_of(sphere((0.0, 0.0, 0.0), 0.2, 3)), radar_at())).num_paths == 0


def test_without_the_keyword_nothing_is_looked_for():
    paths = trace(scene_of(sheet()), radar_at(), edges=False)
    assert not paths.frame.edges and not np.any(np.asarray(paths.flags) & 4)
    assert on_edges(paths).num_paths == 0


def test_effects_say_with_what_power():
    off, on = ({effect.name: effect for effect in trace(scene_of(sheet()), radar_at(), edges=edges).effects}
               for edges in (False, True))
    assert not off["edge diffraction"].modelled and "not looked for: the strongest would carry" in off["edge diffraction"].reason
    assert on["edge diffraction"].modelled and "dBm" in on["edge diffraction"].reason


def test_auto_looks_for_edges_where_they_stand_out_of_the_noise():
    near, far = (radar_at((x, 0.5, 0.0)) for x in (8.0, 8e4))
    for radar, is_on in ((near, True), (far, False)):
        paths = trace(scene_of(sheet(), yaw=0.5), radar, edges="auto")
        assert paths.frame.edges == is_on
        effect, = (one for one in ep.effects(scene_of(sheet(), yaw=0.5), radar, edges="auto") if one.name == "edge diffraction")
        assert effect.modelled == is_on and "edges = 'auto': the strongest would carry" in effect.reason
        recorded, = (one for one in paths.effects if one.name == "edge diffraction")  # which knows no more than what was done
        assert recorded.modelled == is_on and recorded.reason.startswith("looked for: " if is_on else "not looked for: ")
    off = trace(scene_of(sheet()), far, edges=False)
    assert np.array_equal(off.weight, trace(scene_of(sheet()), far, edges="auto").weight)


def test_auto_does_not_depend_on_the_order_of_the_antennas():
    """Of an upright plate, whose upright edges send nothing to a level antenna that is asked first."""
    for order in ((0, 1), (1, 0)):
        radar = radar_at((8.0, 0.5, 0.0))
        both = [radar.receivers[0], radar.receivers[0].replace(polarization=(0.0, 1.0, 0.0))]
        paths = trace(scene_of(sheet(), yaw=0.5), radar.replace(receivers=[both[index] for index in order]), edges="auto")
        assert paths.frame.edges


def test_the_estimate_is_near_the_strongest_edge():
    """Of a plate seen across two of its edges, whose echo is about that of both."""
    radar = radar_at((6.0, 6.0, 0.0))
    reason = next(one.reason for one in ep.effects(scene_of(sheet()), radar) if one.name == "edge diffraction")
    power = ep.received_power(on_edges(trace(scene_of(sheet()), radar))).power
    assert float(reason.split("carry ")[1].split(" dBm")[0]) == pytest.approx(10.0 * math.log10(power / 1e-3), abs=4.0)


def test_effects_name_those_without_edges():
    scene = scene_of(sheet())
    scene.add(sheet(), name="board", material=ep.Material(permittivity=4.0 - 0.2j), position=(1.0, 0.0, 0.0))
    reason = next(one.reason for one in ep.effects(scene, radar_at(), edges=True) if one.name == "edge diffraction")
    assert "left out: those of 1 mesh: board, of dielectrics" in reason


def test_frames_take_the_keyword():
    frame = ep.simulate(scene_of(sheet(), yaw=0.5), radar_at(num_chirps=4), num_rays=500, edges=True, guard=False)
    assert on_edges(frame.paths).num_paths > 0
    with pytest.raises(ValueError, match="edges: must be True, False or 'auto'"):
        ep.simulate(scene_of(sheet()), radar_at(), edges="yes")
