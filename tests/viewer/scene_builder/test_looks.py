"""Colours, legends and edges of meshes, without a window."""
from __future__ import annotations

import colorsys
import zlib
from types import SimpleNamespace

import h5py
import numpy as np
import pytest
import pyvista as pv

import echopath as ep
from echopath.frame_file.h5 import CHECK_SUM
from echopath_viewer.model import Legend, Session, colour_rays, from_file, from_frame, from_paths, mesh_palette
from echopath_viewer.scene_builder.legend import LegendLayer
from echopath_viewer.scene_builder.mesh_layer import MeshLayer, creases
from echopath_viewer.scene_builder.name_layer import NameLayer
from echopath_viewer.window.maps.ticks import nice_below, scientific_text, tick_text

HUE_STEP = 0.02  # of the circle of hues: what 8 bits of a colour turn it by at most


def scene_of(names):
    material = SimpleNamespace(mirror=False)
    return SimpleNamespace(meshes=[SimpleNamespace(name=name, material=material) for name in names])


def test_no_two_meshes_share_a_colour_and_those_of_an_object_share_its_hue():
    names = [f"car_{car}/{part}" for car in range(40) for part in ("body", "wheel_1", "wheel_2", "glass")]
    colours = mesh_palette(scene_of(names))
    assert len(np.unique(colours, axis=0)) == len(names)
    hues = np.array([colorsys.rgb_to_hls(*rgb / 255.0)[0] for rgb in colours]).reshape(40, 4)
    turn = (hues - hues[:, :1] + 0.5) % 1.0 - 0.5
    assert np.abs(turn).max() < HUE_STEP


def test_objects_of_one_mesh_each_have_colours_of_their_own_that_are_neither_black_nor_white_however_many_there_are():
    colours = mesh_palette(scene_of([f"thing_{number}" for number in range(400)]))
    assert len(np.unique(colours, axis=0)) == 400
    lightness = np.array([colorsys.rgb_to_hls(*rgb / 255.0)[1] for rgb in colours])
    assert 0.1 < lightness.min() and lightness.max() < 0.9


def test_a_legend_of_many_objects_says_how_many_it_leaves_out(frame):
    session = Session(from_frame(frame))
    session.set_color_by("mesh")
    segments = session.segments(session.shown_rays(300))
    names = [f"thing_{mesh}" for mesh in range(30)]
    many = SimpleNamespace(mesh_id=np.arange(300) % 30, ray=segments.ray, rays=segments.rays)
    legend = colour_rays("mesh", session.columns, many, mesh_palette(scene_of(names)), names).legend
    assert len(legend.rows) == 12 and legend.num_more == 18 and legend.texts()[-1] == "and 18 more"


def test_legends_in_pictures_are_black_whatever_the_colours():
    plotter = pv.Plotter(off_screen=True, window_size=(300, 200))
    plotter.set_background("white")
    LegendLayer(plotter).show(Legend("Object", rows=(("floor", (250, 245, 200)),), num_more=2))
    pixels = plotter.screenshot(None, return_img=True).astype(int)
    plotter.close()
    is_coloured = np.ptp(pixels, axis=-1) > 8
    assert pixels[~is_coloured].min() < 60                          # the text
    assert np.abs(pixels[is_coloured] - (250, 245, 200)).max() < 60  # and a square


def test_only_rims_and_creases_of_a_chosen_mesh_are_drawn():
    box, ball = pv.Box().triangulate(), pv.Sphere(theta_resolution=60, phi_resolution=60)
    assert len(creases(box.clean().points, box.clean().regular_faces)) == 12
    assert len(creases(ball.points, ball.regular_faces)) == 0
    plane = pv.Plane(i_resolution=20, j_resolution=20).triangulate()
    assert len(creases(plane.points, plane.regular_faces)) == 4 * 20


def test_a_frame_without_signal_is_dark_and_draws_nothing(frame):
    none = frame.paths.select(np.zeros(frame.paths.num_paths, bool))
    session = Session(from_paths(None, none))
    low, high = session.map_limits()
    assert session.parts.whole.level(0, 0).max() < low < high and len(session.shown_rays()) == 0


def test_leakage_sets_no_colours(frame):
    """10 dB of the transmit power: the maps are as bright as without it, where there is more in view than the leakage."""
    leak = np.full((len(frame.radar.transmitters), len(frame.radar.receivers)), -10.0)
    radars = frame.radar, frame.radar.replace(receiver=ep.Receiver(leakage_db=leak, leakage_delay=0.3e-9))
    clean, leaking = (Session(from_frame(ep.simulate(frame.scene, radar, num_rays=800, seed=3, guard=False))) for radar in radars)
    assert leaking.map_limits() == clean.map_limits()
    assert leaking.parts.whole.level(0, 0).max() > leaking.map_limits()[1] + 30.0
    near = leaking.map_limits((0.0, 0.1), (-0.1, 0.1))
    assert near[1] > leaking.map_limits()[1] + 30.0  # what is in view of leakage alone is shown by its own scale


def test_a_number_that_is_none_is_told_with_the_name_of_the_file(frame, tmp_path):
    """Also where the program that wrote it has made the check sum of it."""
    path, told = tmp_path / "frame.h5", set()
    ep.save_frame(frame, path)
    with h5py.File(path, "r+") as file:
        names = []
        file.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
        kept = {name: file[name][()] for name in names if file[name].dtype.kind in "fc" and file[name].size > 1}
    for name, values in kept.items():
        broken = values.copy()
        broken.flat[0] = np.nan
        write(path, name, broken)
        try:
            from_file(path)
        except ep.FileError as error:
            assert str(path) in str(error), name
            told.add(name)
        write(path, name, values)
    assert {name for name in kept if name.startswith(("scene/", "record/paths/", "record/hits/"))} <= told
    assert from_file(path).paths.num_paths == frame.paths.num_paths


def write(path, name: str, values) -> None:
    with h5py.File(path, "r+") as file:
        file[name][()] = values
        file[name].attrs[CHECK_SUM] = np.uint32(zlib.crc32(values.tobytes()))


def test_boxes_have_edges_and_round_bodies_none():
    box, ball = pv.Box().triangulate().clean(), pv.Sphere(theta_resolution=30, phi_resolution=30)
    scene = ep.Scene()
    for name, shape in (("box", box), ("ball", ball)):
        scene.add(ep.Mesh(np.asarray(shape.points, float), np.asarray(shape.regular_faces)), name=name, material="metal")
    plotter = pv.Plotter(off_screen=True)
    layer = MeshLayer(plotter, scene, mesh_palette(scene), 0.0)
    assert list(layer._outlines) == [0] and layer._outlines[0].GetMapper().GetInput().GetNumberOfCells() == 12
    plotter.close()


def test_towns_are_drawn_without_going_through_all_actors_for_each_mesh(monkeypatch):
    """Thousands of meshes had taken minutes to be shown or selected."""
    looks, property_of = [], pv.Renderer.actors
    monkeypatch.setattr(pv.Renderer, "actors", property(lambda renderer: looks.append(1) or property_of.fget(renderer)))
    scene, plotter = ep.Scene(), pv.Plotter(off_screen=True)
    for number in range(60):
        scene.add(ep.actors.box(size=(1.0, 1.0, 1.0)), name=f"box {number}", material="metal", position=(2.0 * number, 0.0, 0.0))
    for _ in range(2):  # the second takes the place of the first
        layer = MeshLayer(plotter, scene, mesh_palette(scene), 0.0)
        layer.show(set(), range(60))
    assert len(looks) < 20
    assert len(plotter.actors) == 3 * 60  # bodies, outlines, creases
    plotter.close()


def test_planes_are_named_where_rays_meet_them():
    """Their middle may lie far outside the picture."""
    points = np.array([[9.0, 9, 9], [1, 2, 0], [3, 2, 0]])
    drawn = SimpleNamespace(points=points, hits=np.array([1, 2]), hit_mesh=np.array([0, 0]))
    plane = SimpleNamespace(material=SimpleNamespace(mirror=True))
    session = SimpleNamespace(scene=SimpleNamespace(meshes=[plane]), segments=lambda rays: drawn, shown_rays=lambda: None)
    assert NameLayer(None, None)._place(session, [0]) == pytest.approx([2.0, 2.0, 0.0])


def test_the_title_of_a_scale_stands_over_none_of_its_labels():
    pictures = []
    for title in ("", "Radial speed in m/s (away: +)"):
        plotter = pv.Plotter(off_screen=True, window_size=(300, 300))  # narrow: the labels are near each other and the title
        plotter.set_background("white")
        LegendLayer(plotter).show(Legend(title, clim=(-140.0, -100.0), cmap="coolwarm"))
        pictures.append(plotter.screenshot(None, return_img=True).astype(int))
        plotter.close()
    is_title = np.abs(pictures[1] - pictures[0]).max(axis=-1) > 60
    assert is_title.sum() > 200 and pictures[0][is_title].min() > 200


def test_scales_are_round_and_never_longer_than_their_room():
    for room in np.geomspace(1e-3, 1e4, 300):
        found = nice_below(room)
        assert 0.4 * room <= found <= room * (1.0 + 1e-6)  # steps of 1, 2, 5
        assert round(found / 10.0 ** np.floor(np.log10(found) + 1e-9)) in (1, 2, 5)
    assert (nice_below(4.15), nice_below(5.0), nice_below(0.2)) == (2.0, 5.0, pytest.approx(0.2))


def test_small_numbers_stand_as_print_has_them():
    assert scientific_text(-3.42e-06) == "−3.4·10⁻⁶" and tick_text(-85.0) == "−85"
