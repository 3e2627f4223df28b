"""Pictures of scenes without a window, and without a screen."""
from __future__ import annotations

import ctypes
import os
import subprocess
import sys
import uuid
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import pyvista as pv
from PIL import Image
from scipy.ndimage import maximum_filter, minimum_filter
from vtkmodules.vtkRenderingCore import vtkCoordinate

import echopath as ep
from echopath_viewer.model import CellBox, Session, from_frame, from_paths
from echopath_viewer.model.antennas import world_from_antenna
from echopath_viewer.off_screen import renderer
from echopath_viewer.plot import _new_plotter
from echopath_viewer.scene_builder import VIEWS, SceneBuilder, export_meshes, export_rays
from echopath_viewer.scene_builder.antenna_layer import AXIS_COLOURS
from echopath_viewer.scene_builder.mesh_layer import boundary_edges
from echopath_viewer.scene_builder.ray_layer import RayLayer
from support import shapes

BASELINES = Path(__file__).parent / "baselines"
SIZE = (240, 180)
DOT = 4.0  # pixels from the middle of a hit's dot to where the picture ends to change
BASELINE_DIFFERENCE = 0.2  # mean over all pixels, of 255; with half of the rays it is 0.85, by Mesa 25 in place of 22 it is 0.08
INSIDE = 1.0 + 1e-6


@pytest.fixture
def session(frame):
    return Session(from_frame(frame))


@pytest.fixture
def plotter():
    plotter = pv.Plotter(off_screen=True, window_size=list(SIZE))
    yield plotter
    plotter.close()


@pytest.fixture(scope="module")
def drawn_paths(frame):
    """Paths that no tracer has made, so that pictures of them stay: over each wall, and by a wall to the head."""
    grid = [(u, v) for u in (0.1, 0.3, 0.5) for v in (0.1, 0.3)]
    chains = [[(mesh, u, v)] for mesh in (2, 3) for u, v in grid] + [[(2, u, v), (0, 0.4 * u, v)] for u, v in grid]
    hits = np.array([(mesh, 0, u, v) for chain in chains for mesh, u, v in chain], frame.paths.hits.dtype)
    num_bounces = np.array([len(chain) for chain in chains])
    zeros = np.zeros(len(chains), int)
    return ep.Paths.from_arrays(
        hits=hits, offsets=np.cumsum(num_bounces) - num_bounces, num_bounces=num_bounces, diffuse=2 ** num_bounces - 1,
        weight=np.linspace(1.0, 2.0, len(chains)).astype(np.complex64), stratum=zeros, batch=zeros, flags=zeros,
        scene=frame.scene, radar=frame.radar, frame=frame.paths.frame)


def colours_of(layer):
    mapper = layer._rays.GetMapper()
    return pv.wrap(mapper.GetInput()).point_data["rgb"][::2]  # both points of a segment have its colour


def project(plotter, points):
    """Clip coordinates [N, 2]: inside the picture they lie in -1 to 1."""
    matrix = plotter.camera.GetCompositeProjectionTransformMatrix(SIZE[0] / SIZE[1], -1.0, 1.0)
    clip_from_world = np.array([[matrix.GetElement(row, column) for column in range(4)] for row in range(4)])
    clip = np.column_stack([points, np.ones(len(points))]) @ clip_from_world.T
    assert np.all(clip[:, 3] > 0.0)
    return clip[:, :2] / clip[:, 3:]


def test_rays_are_drawn_in_the_colours_of_the_model(session, plotter):
    builder = SceneBuilder(plotter, session)
    for mode in ("mesh", "power", "bounces"):
        session.set_color_by(mode)
        builder.update({"colours"})
        segments = session.segments(session.shown_rays())
        assert np.array_equal(colours_of(builder.rays), session.colouring(segments).rgb)


def test_lit_rays_are_drawn_over_grey_ones(session, plotter):
    builder = SceneBuilder(plotter, session)
    strongest = int(session.shown_rays(1)[0])
    session.select_cells(CellBox.around(*session.cell_of(strongest), 1))
    builder.update({"selection"})
    assert set(builder.lit.segments.rays) == set(np.flatnonzero(session.lit))
    assert len(np.unique(colours_of(builder.rays), axis=0)) == 1
    assert builder.drawn_layers() == [builder.lit]
    session.select_cells(None)
    builder.update({"selection"})
    assert builder.lit.segments.num_segments == 0 and builder.drawn_layers() == [builder.rays]


@pytest.mark.parametrize("view", VIEWS)
def test_every_view_shows_what_matters(session, plotter, view):
    builder = SceneBuilder(plotter, session)
    builder.look(view)
    if view == "radar":
        corners = np.stack([session.scene.world_vertices(mesh, session.time).mean(axis=0) for mesh in (0, 1)])
    else:
        low, high = builder.corners()
        corners = np.stack(np.meshgrid(*np.stack([low, high], axis=1)), axis=-1).reshape(-1, 3)
    seen = project(plotter, corners)
    assert np.abs(seen).max() <= INSIDE
    assert view == "radar" or np.abs(seen).max() > 0.85  # as near as it fits


@pytest.mark.parametrize("size", [1.0, 0.01])
def test_the_picture_holds_objects_and_rays_and_not_all_of_the_ground(plotter, size):
    """Boxes 6 m and 6 cm ahead of a radar over an unflagged ground that is a thousand times as wide."""
    scene = ep.Scene()
    ground = shapes.plate((0.0, 0.0, -size), (0.0, 0.0, 1.0), 1000.0 * size, up=(1.0, 0.0, 0.0))
    scene.add(ground, name="ground", material="asphalt")
    scene.add(ep.actors.box(size=(size, size, size)), name="box", position=(6.0 * size, 0, -0.5 * size), material="metal")
    chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=16, sampling_rate=1e7, num_chirps=2,
                              chirp_interval=1e-4)
    radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, 0.1 * size, 0))])
    builder = SceneBuilder(plotter, Session(from_paths(scene, ep.trace(scene, radar, num_rays=500, max_bounces=1))))
    low, high = builder.corners()
    assert (low < [0.0, 0.0, -0.5 * size]).all() and high[0] > 6.5 * size
    assert np.linalg.norm(high - low) < 40.0 * size


def test_moving_scenes_keep_their_triangles(session, plotter):
    builder = SceneBuilder(plotter, session)
    session.set_chirp(0)
    builder.update({"time"})
    for mesh in session.scene.meshes:
        poly = builder.meshes.actors[mesh.id].GetMapper().GetInput()
        assert poly.points == pytest.approx(session.scene.world_vertices(mesh.id, session.time), abs=1e-5)
        assert np.array_equal(poly.regular_faces, mesh.triangles)


def test_axes_of_an_antenna_turn_with_it():
    half = np.sqrt(0.5)
    radar = SimpleNamespace(world_from_radar=lambda time: np.eye(4))
    for quaternion, ahead in (((half, 0, 0, half), [0, 1, 0]), ((half, 0, -half, 0), [0, 0, 1])):  # a quarter turn about z, -y
        axes = world_from_antenna(radar, SimpleNamespace(orientation=quaternion, position=(1.0, 2.0, 3.0)), 0.0)
        assert axes @ [1, 0, 0, 0] == pytest.approx([*ahead, 0]) and axes[:, 3] == pytest.approx([1, 2, 3, 1])


def test_the_outline_of_a_rectangle_is_its_four_edges():
    assert sorted(map(tuple, boundary_edges(np.array([[0, 1, 2], [0, 2, 3]])))) == [(0, 1), (0, 3), (1, 2), (2, 3)]


@pytest.mark.parametrize("driver", ["llvmpipe", "softpipe"])  # Mesa's renderers: a machine's, a wheel's
def test_plot_rays_writes_a_picture_without_a_screen(frame, tmp_path, driver):
    frame.paths.save(tmp_path / "paths.h5")
    script = ("import sys, echopath as ep; paths = ep.Paths.load(sys.argv[1]);"
              "ep.plot_rays(paths.scene, paths, off_screen=True, screenshot=sys.argv[2], window_size=(480, 360),"
              "num_rays=20)")
    environment = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    done = subprocess.run([sys.executable, "-c", script, str(tmp_path / "paths.h5"), str(tmp_path / "rays.png")],
                          env=environment | {"GALLIUM_DRIVER": driver}, capture_output=True, text=True)
    assert done.returncode == 0 and not done.stderr, done.stderr
    colours = np.unique(pv.read(tmp_path / "rays.png").point_data.active_scalars, axis=0)
    assert len(colours) > 10
    assert np.abs(colours.astype(float) - AXIS_COLOURS[0]).max(axis=1).min() < 25.0, "the boresight of an antenna"
    with Image.open(tmp_path / "rays.png") as image:
        assert image.text["Seed"] == str(frame.paths.frame.seed) and image.text["Software"] == f"echopath {ep.__version__}"


def test_plot_rays_draws_what_is_asked_for(frame):
    plotter = ep.plot_rays(frame.scene, frame.paths, selection=ep.hits("wall_left") & (ep.num_bounces == 2), num_rays=7,
                           color_by="range", clim=(0.0, 10.0), chirp=0, tx=1, hidden=["walker/*"], off_screen=True,
                           window_size=SIZE, return_plotter=True)
    lines = plotter.actors["all rays"].GetMapper().GetInput()
    assert lines.GetNumberOfLines() == 7 * 3
    assert not plotter.actors["mesh 0"].GetVisibility() and plotter.actors["mesh 2"].GetVisibility()
    plotter.close()


def test_plot_rays_draws_the_scene_alone_where_no_ray_is_asked_for(frame):
    plotter = ep.plot_rays(frame.scene, frame.paths, num_rays=0, off_screen=True, window_size=SIZE, return_plotter=True)
    assert plotter.actors["all rays"].GetMapper().GetInput().GetNumberOfLines() == 0
    assert plotter.actors["mesh 2"].GetVisibility()
    plotter.close()


def test_names_in_whatever_letters_are_exported(tmp_path):
    names = ["Fußgänger", "歩行者"]
    scene = ep.Scene()
    for number, name in enumerate(names):
        scene.add(ep.actors.plate(1.0, 1.0), name=name, material="metal", position=(6.0, number, 0.0))
    chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=64, sampling_rate=10e6, num_chirps=4,
                              chirp_interval=1e-4)
    radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, 0.01, 0))])
    session = Session(from_paths(scene, ep.trace(scene, radar, num_rays=200)))
    for export in (export_rays, export_meshes):
        export(session, tmp_path / "names.vtp")
        assert list(pv.read(tmp_path / "names.vtp").field_data["mesh_names"]) == names


@pytest.mark.filterwarnings("ignore:'guest' is absent")
def test_plot_rays_takes_the_scene_that_was_traced_without_what_was_absent():
    scene = ep.Scene()
    for name, distance in (("guest", 10.0), ("host", 20.0)):
        scene.add(ep.actors.plate(2.0, 2.0), name=name, material="concrete", position=(distance, 0.0, 0.0), yaw=np.pi)
    scene["guest"].lifetime = 0.0, 1.0
    radar = ep.Radar(ep.ChirpSequence(num_chirps=2), transmitters=[ep.Antenna()], receivers=[ep.Antenna((0.0, 0.01, 0.0))])
    paths = ep.trace(scene, radar, num_rays=500, start_time=2.0)
    keywords = dict(off_screen=True, window_size=SIZE, return_plotter=True)
    plotter = ep.plot_rays(scene, paths, **keywords)
    assert "mesh 0" in plotter.actors and "mesh 1" not in plotter.actors
    plotter.close()
    scene["guest"].lifetime = None
    with pytest.raises(ValueError, match="scene: must be the one that was traced, with 1 meshes, got one with 2"):
        ep.plot_rays(scene, paths, **keywords)


@pytest.mark.parametrize("keywords, error, word", [
    ({"colour_by": "mesh"}, TypeError, "color_by"), ({"color_by": "mood"}, ValueError, "color_by"),
    ({"cmap": "rainbows", "color_by": "power"}, ValueError, "cmap"), ({"view": "back"}, ValueError, "view"),
    ({"selection": "T nonsense"}, ValueError, "^"), ({"tx": 2}, ValueError, "tx: must"),
    ({"rx": -1}, ValueError, "rx: must"), ({"num_rays": -1}, ValueError, "num_rays: must"),
    ({"chirp": 32}, ValueError, "chirp: must"), ({"chirp": -1}, ValueError, "chirp: must"),
    ({"clim": (-80.0, -120.0), "color_by": "power"}, ValueError, "clim: must"),
])
def test_bad_keywords_are_named(frame, keywords, error, word):
    with pytest.raises(error) as caught:
        ep.plot_rays(frame.scene, frame.paths, off_screen=True, window_size=SIZE, **keywords)
    assert word in str(caught.value)


@pytest.mark.parametrize("name, keywords", [
    ("fit", {}), ("radar", {"view": "radar", "color_by": "mesh", "show_hits": True}),
    ("top", {"view": "top", "color_by": "power"}),
])
def test_pictures_are_as_they_were(drawn_paths, tmp_path, name, keywords):
    """ECHOPATH_UPDATE_BASELINES=1 writes new ones: look at them."""
    picture = tmp_path / f"{name}.png"
    plotter = ep.plot_rays(None, drawn_paths, off_screen=True, window_size=SIZE, show_legend=False, return_plotter=True,
                           **keywords)
    plotter.disable_anti_aliasing()
    plotter.screenshot(str(picture))
    plotter.close()
    if os.environ.get("ECHOPATH_UPDATE_BASELINES"):
        BASELINES.mkdir(exist_ok=True)
        (BASELINES / picture.name).write_bytes(picture.read_bytes())
    got, wanted = (np.asarray(Image.open(path).convert("RGB"), float) for path in (picture, BASELINES / picture.name))
    assert beyond_neighbours(got, wanted).mean() + beyond_neighbours(wanted, got).mean() < BASELINE_DIFFERENCE


def beyond_neighbours(picture, other):
    """By how much values lie outside of those around the same pixel of another picture: renderers put lines a pixel aside."""
    around = {"size": (3, 3, 1), "mode": "nearest"}
    return np.maximum(picture - maximum_filter(other, **around), 0.0) + np.maximum(minimum_filter(other, **around) - picture, 0.0)


def test_hits_are_dots_where_rays_turn(drawn_paths):
    pictures, places = [], np.empty((0, 2))
    for show_hits in (False, True):
        plotter = ep.plot_rays(None, drawn_paths, off_screen=True, window_size=SIZE, show_legend=False, return_plotter=True,
                               view="radar", show_hits=show_hits)
        plotter.disable_anti_aliasing()
        pictures.append(plotter.screenshot(return_img=True).astype(float))
        places = np.array([in_picture(plotter, point) for point in drawn_paths.points(0.0)])
        plotter.close()
    changed = np.argwhere(np.abs(pictures[1] - pictures[0]).max(axis=-1) > 0.0)[:, ::-1]
    distances = np.linalg.norm(changed[:, None] - places[None], axis=-1)
    assert distances.min(axis=1).max() < DOT
    in_sight = np.all((places > 0.0) & (places < np.array(SIZE)), axis=1)
    assert np.count_nonzero(distances.min(axis=0)[in_sight] < DOT) > 0.7 * np.count_nonzero(in_sight) > 0  # others are hidden


def in_picture(plotter, point) -> tuple[float, float]:
    """Column and row of a place of the scene, in m."""
    place = vtkCoordinate()
    place.SetValue(*point)
    column, row = place.GetComputedDoubleDisplayValue(plotter.renderer)
    return column, SIZE[1] - 1 - row


@pytest.fixture
def lacking(monkeypatch) -> str:
    """What is said on a machine without a screen and without renderers, where VTK would end the process."""
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("VTK_DEFAULT_OPENGL_WINDOW", raising=False)
    monkeypatch.setattr("echopath_viewer.off_screen.RENDERERS", {"egl": ("libc.so.6", "libnone.so.1"), "mesa": ("libnone.so.8",)})
    return "pictures without a screen need libc.so.6 and libnone.so.1, or libnone.so.8, got neither .*libegl1"


@pytest.mark.parametrize("keywords", [{}, {"return_plotter": True, "screenshot": "rays.png"}])
def test_a_plotter_without_a_screen_and_a_renderer_says_what_is_missing(drawn_paths, lacking, keywords):
    with pytest.raises(OSError, match=f"^off_screen: {lacking}"):
        ep.plot_rays(None, drawn_paths, off_screen=True, **keywords)


def test_a_picture_without_a_screen_and_a_renderer_is_drawn_by_matplotlib(drawn_paths, lacking, tmp_path):
    with pytest.warns(RuntimeWarning, match=f"^off_screen: drawn by Matplotlib, in its views and colours: {lacking}") as told:
        assert ep.plot_rays(None, drawn_paths, off_screen=True, selection="T . R", screenshot=tmp_path / "rays.png") is None
    assert told[0].filename == __file__
    shades = pv.read(tmp_path / "rays.png").point_data.active_scalars
    assert len(np.unique(shades, axis=0)) > 20, "an empty picture has few colours"


def test_the_renderer_that_is_there_is_asked_to_draw(lacking, monkeypatch):
    monkeypatch.setattr("echopath_viewer.off_screen.RENDERERS", {"egl": ("libnone.so.1",), "mesa": ("libc.so.6",)})
    monkeypatch.setenv("VTK_DEFAULT_OPENGL_WINDOW", "")  # so that it is as before after the test
    monkeypatch.delenv("VTK_DEFAULT_OPENGL_WINDOW")
    monkeypatch.setattr("echopath_viewer.plot.pv.Plotter", lambda **keywords: None)
    _new_plotter(True, (4, 3))
    assert os.environ["VTK_DEFAULT_OPENGL_WINDOW"] == "mesa"


def test_the_renderer_that_the_user_asks_vtk_for_is_the_one_that_draws(lacking, monkeypatch):
    both = {"egl": ("libc.so.6",), "mesa": ("libm.so.6",), "gone": ("libnone.so.1",)}
    monkeypatch.setattr("echopath_viewer.off_screen.RENDERERS", both)
    monkeypatch.setattr("echopath_viewer.plot.pv.Plotter", lambda **keywords: None)
    for asked in ("mesa", "egl", "vtkXOpenGLRenderWindow"):  # the last: VTK's own, of which nothing is known here
        monkeypatch.setenv("VTK_DEFAULT_OPENGL_WINDOW", asked)
        assert renderer() == asked
        _new_plotter(True, (4, 3))
        assert os.environ["VTK_DEFAULT_OPENGL_WINDOW"] == asked
    monkeypatch.setenv("VTK_DEFAULT_OPENGL_WINDOW", "gone")
    with pytest.raises(OSError, match="^off_screen: VTK_DEFAULT_OPENGL_WINDOW=gone needs libnone.so.1, got none"):
        _new_plotter(True, (4, 3))


def test_the_renderer_of_the_wheel_is_found_by_those_who_ask_for_its_name(monkeypatch, tmp_path):
    monkeypatch.delenv("VTK_DEFAULT_OPENGL_WINDOW", raising=False)
    own = tmp_path / f"lib{uuid.uuid4().hex}.so.8"  # of the run alone: what is loaded stays so, under this name
    subprocess.run(["gcc", "-shared", "-x", "c", "/dev/null", f"-Wl,-soname,{own.name}", "-o", own], check=True)
    monkeypatch.setattr("echopath_viewer.off_screen.RENDERERS", {"egl": ("libnone.so.1",), "mesa": (own.name,)})
    assert renderer() == ""
    monkeypatch.setattr("echopath_viewer.off_screen.OWN", tmp_path)
    assert renderer() == "mesa"
    ctypes.CDLL(own.name)  # as VTK loads it; raises OSError where nothing of that name is loaded or found


def test_rays_that_are_drawn_opaque_have_their_colours_and_are_hidden_by_what_stands_before_them(plotter):
    near = RayLayer(plotter, "near", width=6.0)
    ends = np.array([[0, 1]])
    near.show(SimpleNamespace(points=np.array([[-1.0, 0, 0], [1, 0, 0]]), ends=ends, num_segments=1, hits=[]), [(10, 200, 30)])
    plotter.add_mesh(pv.Plane(center=(0.5, 0, 0.5), direction=(0, 0, 1), i_size=1.0, j_size=1.0), color="red", lighting=False)
    plotter.view_xy()
    plotter.camera.zoom(1.5)
    pixels = plotter.screenshot(None, return_img=True)
    row = pixels[SIZE[1] // 2]
    is_ray = np.all(row == (10, 200, 30), axis=-1)
    assert is_ray[:SIZE[0] // 2].sum() > 20 and not is_ray[SIZE[0] // 2 + 2:].any()


def test_a_leg_that_rays_share_is_drawn_once_in_the_colours_of_the_first(plotter):
    layer = RayLayer(plotter, "shared", width=2.0)
    points = np.float32([[-1, 0, 0], [1, 0, 0], [1, 1, 0], [-1, 0, 0], [1, 0, 0]])
    segments = SimpleNamespace(points=points, ends=np.array([[0, 1], [1, 2], [4, 3]]), num_segments=3, hits=[],
                               num_segments_of={1: 2, 2: 3}.get)
    layer.show(segments, np.uint8([(9, 0, 0), (8, 0, 0), (7, 0, 0)]))
    lines = layer._rays.GetMapper().GetInput()
    assert lines.n_lines == 2 and lines.point_data["rgb"][:, 0].tolist() == [9, 9, 8, 8]
    layer.recolour(np.uint8([(1, 0, 0), (2, 0, 0), (3, 0, 0)]))
    assert lines.point_data["rgb"][:, 0].tolist() == [1, 1, 2, 2]
    layer.show_first(2, 10.0)  # m: all ends are one
    assert layer._rays.GetMapper().GetInput().n_lines == 1


def test_translucent_rays_are_drawn_as_often_as_they_are_there(plotter):
    layer = RayLayer(plotter, "shared", width=2.0, opacity=0.5)  # more of them on each other look darker
    segments = SimpleNamespace(points=np.eye(3)[:2], ends=np.array([[0, 1], [0, 1]]), num_segments=2, hits=[])
    layer.show(segments, np.uint8([(9, 0, 0), (7, 0, 0)]))
    assert layer._rays.GetMapper().GetInput().n_lines == 2


MUNICH = np.array([691607.0, 5334760.0, 520.0])  # m, in UTM zone 32: single precision lies half a metre apart there


def session_at(place) -> Session:
    """A ball 5 m before a radar at a place [3] in m."""
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.5), name="ball", material="metal", position=place + (5.0, 0.5, 0.25), smooth=True)
    radar = ep.Radar(ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=32, sampling_rate=10e6, num_chirps=4,
                                      chirp_interval=1e-4),
                     transmitters=[ep.Antenna()], receivers=[ep.Antenna((0.0, 0.25, 0.0))], position=place)
    return Session(from_paths(scene, ep.trace(scene, radar, num_rays=400, max_bounces=1, seed=1)))


def test_what_stands_far_from_the_origin_is_drawn_as_what_stands_there(tmp_path):
    """Single precision makes a lump of half a metre of the ball, and the rays of its neighbours end in one point of it."""
    pictures = []
    for place in (np.zeros(3), MUNICH):
        plotter = pv.Plotter(off_screen=True, window_size=list(SIZE))
        session = session_at(place)
        builder = SceneBuilder(plotter, session)
        builder.look("fit")
        pictures.append(plotter.screenshot(return_img=True).astype(float))
        segments = session.segments(session.listed_rays())
        assert len({tuple(point) for point in segments.points[segments.hits]}) == len(session.listed_rays())
        away = (segments.points - plotter.camera.position) @ plotter.camera.direction
        assert builder.nearest_ray() == pytest.approx(away.min(), rel=0.0, abs=1e-3)
        plotter.close()
        export_meshes(session, tmp_path / "ball.vtp")
        assert np.allclose(pv.read(tmp_path / "ball.vtp").points, session.scene.world_vertices(0), rtol=0.0, atol=1e-6)
    assert np.abs(pictures[0] - pictures[1]).mean() < BASELINE_DIFFERENCE


def test_axes_of_a_page_begin_near_what_stands_far_from_the_origin():
    """The library of the page draws in single precision, whatever it is given."""
    pytest.importorskip("plotly")
    from echopath_viewer.scene_builder.web_page import ScenePage

    near, far = (ScenePage(session_at(place)) for place in (np.zeros(3), MUNICH))
    begin = np.array([692e3, 5335e3, 0.0])
    for one, other in zip(near._traces, far._traces, strict=True):
        if one.type == "mesh3d" or one.name in ("rays", "antennas"):
            places = [np.array([trace.x, trace.y, trace.z], float).T for trace in (one, other)]
            np.testing.assert_allclose(places[1] + begin - MUNICH, places[0], rtol=0.0, atol=1e-4)
    titles = [[page._layout()["scene"][f"{name}axis"]["title"] for name in "xyz"] for page in (near, far)]
    assert titles == [["x in m", "y in m", "z in m"], ["x in m from 692000", "y in m from 5335000", "z in m"]]
