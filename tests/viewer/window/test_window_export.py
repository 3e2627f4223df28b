"""Pictures, maps, films and pages of what the window shows."""
from __future__ import annotations

import base64
import contextlib
import io
import re
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest
from PIL import Image

import echopath as ep
from echopath.base.storage.film import write_film
from echopath_viewer.model import WHOLE, Session, from_paths
from echopath_viewer.scene_builder.export import export_rays
from echopath_viewer.scene_builder.web_page import MESH_OPACITY, MIRROR_OPACITY, ScenePage
from echopath_viewer.window.files.exporting import export
from echopath_viewer.window.qt import QtCore, QtGui
from support import shapes

NUM_PICTURES = 4  # of the film, of a frame of more chirps


def test_a_picture_of_twice_the_resolution_shows_the_same(qtbot, window, tmp_path):
    window.settle()
    for scale in (1, 2):
        export(window, tmp_path / f"{scale}.png", scale)
    small, large = (Image.open(tmp_path / f"{scale}.png").convert("RGB") for scale in (1, 2))
    assert large.size == (2 * small.width, 2 * small.height)
    shrunk = np.asarray(large.resize(small.size, Image.Resampling.BOX), float)
    assert np.abs(shrunk - np.asarray(small, float)).mean() < 8.0
    blown_up = np.asarray(small.resize(large.size, Image.Resampling.NEAREST), float)
    view = window.view3d.geometry().translated(window.view3d.mapTo(window, window.view3d.rect().topLeft()) - window.view3d.pos())
    box = tuple(2 * length for length in (view.left(), view.top(), view.right(), view.bottom()))
    scene, coarse = (np.asarray(Image.fromarray(np.uint8(image)).crop(box), float) for image in (np.asarray(large), blown_up))
    assert np.abs(scene - coarse).max() > 40.0  # edges lie finer than the pixels of the screen
    assert small.text if hasattr(small, "text") else Image.open(tmp_path / "1.png").text


def test_maps_are_drawings(qtbot, window, tmp_path):
    before = window.map_area.palette()
    for kind in ("svg", "pdf"):
        export(window, tmp_path / f"maps.{kind}")
    texts = [node.text.strip() for node in ElementTree.parse(tmp_path / "maps.svg").iter() if node.tag.endswith("text")]
    assert texts.count("Range in m") == len(window.map_area.panels) and "dBm" in texts
    assert any(text.startswith("every") and text.endswith("eived") for text in texts)  # cut in the middle, if at all
    assert (tmp_path / "maps.pdf").read_bytes().startswith(b"%PDF")
    assert window.map_area.palette() == before


def test_drawn_maps_show_the_part_that_is_seen(qtbot, window, tmp_path):
    """Whole maps had been drawn over the axes of the part."""
    area = window.map_area
    panel = area.panels[WHOLE, WHOLE]
    ranges, velocities = panel.range_axis, panel.velocity_axis
    step, slow = ranges[1] - ranges[0], velocities[1] - velocities[0]
    area.set_view(QtCore.QRectF(ranges[9] + 0.3 * step, velocities[4] + 0.3 * slow, 12.0 * step, 8.0 * slow))
    export(window, tmp_path / "maps.svg")
    drawn = next(node for node in ElementTree.parse(tmp_path / "maps.svg").iter() if node.tag.endswith("image"))
    data = next(value for name, value in drawn.attrib.items() if name.endswith("href"))
    image = Image.open(io.BytesIO(base64.b64decode(data.partition(",")[2]))).convert("RGB")
    for distance in range(11, 21):
        for velocity in range(6, 12):
            at = ((ranges[distance] - panel.view.left()) / panel.view.width() * image.width,
                  (panel.view.bottom() - velocities[velocity]) / panel.view.height() * image.height)
            assert image.getpixel(tuple(map(int, at))) == QtGui.QColor(
                panel.image.pixel(distance, len(velocities) - 1 - velocity)).getRgb()[:3]


@contextlib.contextmanager
def full_disk(room: int = 4096):
    """No file grows beyond `room` bytes."""
    resource = pytest.importorskip("resource")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (room, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.parametrize("kind", ["png", "svg", "pdf", "vtp"])
def test_files_that_find_no_room_are_not_written(qtbot, window, tmp_path, kind):
    window.settle()
    path = tmp_path / f"file.{kind}"
    with pytest.raises(ep.FileError, match="cannot be written"), full_disk():
        export_rays(window.session, path) if kind == "vtp" else export(window, path)
    assert not list(tmp_path.iterdir())


def test_films_go_through_the_chirps_and_back(qtbot, window, tmp_path, monkeypatch):
    monkeypatch.setattr("echopath_viewer.window.files.exporting.FILM_PICTURES", NUM_PICTURES)
    window.session.set_chirp(7)
    told = []
    export(window, tmp_path / "film.gif", progress=lambda stage, share: told.append(share))
    with Image.open(tmp_path / "film.gif") as film:
        assert film.size == (window.width(), window.height()) and 2 <= film.n_frames <= NUM_PICTURES
    assert len(told) == NUM_PICTURES and told[-1] == 1.0 and window.session.chirp == 7


def test_films_in_mp4_have_all_pictures(tmp_path):
    ffmpeg = pytest.importorskip("imageio_ffmpeg")
    pictures = [np.full((37, 51, 3), level, np.uint8) for level in (0, 120, 250)]
    write_film(tmp_path / "film.mp4", pictures, 10.0)
    reader = ffmpeg.read_frames(str(tmp_path / "film.mp4"))
    assert next(reader)["size"] == (50, 36)
    levels = [np.frombuffer(frame, np.uint8).mean() for frame in reader]
    assert levels == pytest.approx([0, 120, 250], rel=0, abs=6)


def test_other_kinds_and_empty_films_are_refused(qtbot, window, tmp_path):
    with pytest.raises(ValueError, match=r"picture: must end in one of \.png, .*\.htm, got .*a\.bmp"):
        export(window, tmp_path / "a.bmp")
    with pytest.raises(ValueError, match="pictures: must be at least one"):
        write_film(tmp_path / "film.gif", [], 10.0)
    with pytest.raises(ValueError, match="scale: must be 1 to 8, got 9"):
        export(window, tmp_path / "a.png", 9)
    assert not list(tmp_path.iterdir())


def test_a_page_holds_all_it_needs_and_knows_each_ray(qtbot, window, tmp_path):
    pytest.importorskip("plotly")
    window.session.set_max_rays(20)
    export(window, tmp_path / "scene.html")
    text = (tmp_path / "scene.html").read_text(encoding="utf-8")
    assert not re.findall(r"<(?:script|link)[^>]+(?:src|href)=", text) and "plotly_click" in text
    for ray in window.session.listed_rays():
        assert f'"{ray}": "path: {ray:,}<br>hit 1: ' in text
    for name in ("walker", "wall_left", "wall_right"):
        assert f'"name":"{name}"' in text
    rays = next(trace for trace in ScenePage(window.session)._traces if trace.name == "rays")
    assert "bdata" not in rays.to_json()  # packed arrays, which the script of a click cannot go through


def test_walls_of_a_page_are_clear_where_windows_were_cut_from_them(frame):
    """A house had hidden all rays behind it: its windows are no mirrors. Both are one row of the legend."""
    pytest.importorskip("plotly")
    scene = ep.Scene()
    mirror = ep.Material.metal().replace(mirror=True)
    scene.add(shapes.plate((9.0, 0.0, 0.0), (-1.0, 0.0, 0.0), 4.0), name="house", material=mirror)
    scene.add(shapes.plate((8.9, 0.0, 0.0), (-1.0, 0.0, 0.0), 1.0), name="windows", parent="house", material="metal")
    paths = ep.trace(scene, frame.radar, num_rays=300, max_bounces=1, seed=1)
    bodies = [trace for trace in ScenePage(Session(from_paths(scene, paths)))._traces if trace.type == "mesh3d"]
    assert sorted((body.opacity, body.showlegend) for body in bodies) == [(MIRROR_OPACITY, False), (MESH_OPACITY, True)]
    assert {body.legendgroup for body in bodies} == {"house"}


def test_frames_show_themselves_in_notebooks(frame, tmp_path):
    pytest.importorskip("plotly")
    page = frame.show(num_rays=5, color_by="power", selection="T 'walker' R")
    assert page._repr_html_().startswith("<iframe srcdoc=")
    page.save(tmp_path / "page.html")
    assert "Power in dBm" in (tmp_path / "page.html").read_text(encoding="utf-8")
