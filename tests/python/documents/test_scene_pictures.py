"""Pictures of scenes: what hides what, which names stand where, and how much is drawn."""
from __future__ import annotations

import itertools

import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.transforms import Bbox
from mpl_toolkits.mplot3d.proj3d import proj_transform

import echopath as ep
from echopath.plots import plot_scene, save_png
from echopath.plots.scene_view import drawing
from support.radars import build_radar


def test_a_picture_of_a_scene_names_its_objects():
    scene = ep.Scene()
    scene.add(ep.actors.ground(20.0), name="ground", material=ep.Material.metal(mirror=True))
    for k in range(3):
        scene.add(ep.actors.plate(0.3, 0.3), name=f"plate{k}", material="metal", position=(5.0 + k, k, 1.0))
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    paths = ep.trace(scene, radar, num_rays=500)
    figure = plot_scene(scene, paths)
    for axes in figure.axes[:2]:  # in perspective, from above
        assert {text.get_text().strip() for text in axes.texts} >= {"plate0", "plate1", "plate2"}
    assert "ground" in {text.get_text().strip() for text in figure.axes[0].texts}


def on_a_field(length: float, width: float, height: float, box_size: float = 0.5):
    """A picture of a box that hovers above the farther end of a field, which is no mirror."""
    scene = ep.Scene()
    scene.add(ep.actors.ground((length, width)), name="field", material="grass", position=(0.5 * length, 0, 0))
    middle = 0.8 * length, 0.2 * width, height - 0.5 * box_size
    scene.add(ep.actors.box(box_size), name="box", material="metal", position=middle)
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    return plot_scene(scene, ep.trace(scene, radar, num_rays=200), objects=["field", "box"])


def test_a_field_hides_neither_what_stands_on_its_farther_half_nor_rays():
    """As seen where the box and the way to it are on the page, which have other colours than the field."""
    figure = on_a_field(120.0, 20.0, 4.0, box_size=3.0)
    figure.canvas.draw()
    axes = figure.axes[0]
    picture = np.asarray(figure.canvas.buffer_rgba())[..., :3].astype(int)

    def colour(*place) -> np.ndarray:
        across, up = axes.transData.transform(proj_transform(*place, axes.get_proj())[:2])
        return picture[int(len(picture) - up), int(across)]

    field = colour(60.0, -5.0, 0.0)
    assert np.abs(colour(60.0, -7.0, 0.0) - field).max() == 0
    assert np.abs(colour(94.5, 4.0, 2.5) - field).max() > 10    # the side of the box that faces the radar
    assert np.abs(colour(47.25, 2.0, 1.75) - field).max() > 10  # half-way between the radar and that side


@pytest.mark.parametrize("view, dark_side", [(0, (-0.5, -0.7, -0.5)), (1, (0.6, 0.5, 0.6))])
def test_a_hill_hides_neither_what_stands_on_it_nor_rays(view, dark_side):
    """A road of 10 % whose middle lies above the ball at its foot, in perspective and from above, as seen on the page."""
    corners = [(x, y, max(0.0, 0.1 * (x - 30.0))) for x in (-20.0, 30.0, 110.0) for y in (-15.0, 15.0)]
    scene = ep.Scene()
    scene.add(ep.Mesh(corners, [(0, 2, 3), (0, 3, 1), (2, 4, 5), (2, 5, 3)]), name="hill", material="grass")
    scene.add(ep.actors.sphere(1.0), name="ball", material="grass", position=(36.0, 4.0, 1.6))
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=200), objects=["hill", "ball"])
    figure.canvas.draw()
    axes = figure.axes[view]
    picture = np.asarray(figure.canvas.buffer_rgba())[..., :3].astype(int)

    def colour(*place) -> np.ndarray:
        across, up = axes.transData.transform(place[:2] if view else proj_transform(*place, axes.get_proj())[:2])
        return picture[int(len(picture) - up), int(across)]

    slope, flat = colour(60.0, -10.0, 3.0), colour(10.0, -10.0, 0.0)
    assert np.abs(colour(*(36.0, 4.0, 1.6) + np.array(dark_side)) - slope).max() > 30
    assert np.abs(colour(17.5, 1.945, 1.29) - flat).max() > 10  # half-way between the radar and the side that faces it


@pytest.mark.parametrize("size", [(120.0, 20.0, 6.0), (20.0, 20.0, 6.0), (20.0, 60.0, 6.0), (5.0, 2.0, 1.5)])
def test_names_of_axes_stand_beside_their_numbers_and_titles_above_names(size):
    """As measured on the page once it is drawn: of long scenes the name of x stood on a number, that of a field in a title."""
    figure = on_a_field(*size)
    figure.draw_without_rendering()
    perspective, from_above = figure.axes[:2]
    for axis in (perspective.xaxis, perspective.yaxis, perspective.zaxis):
        numbers = [tick.label1.get_window_extent() for tick in axis.get_major_ticks() if tick.label1.get_text()]
        assert numbers and not axis.label.get_window_extent().count_overlaps(numbers)
    names = [text.get_window_extent() for text in from_above.texts]
    assert not from_above.title.get_window_extent().count_overlaps(names)


@pytest.mark.parametrize("size", [(600.0, 4.0, 2.0), (3.0, 300.0, 2.0), (0.3, 0.04, 0.03)])
def test_numbers_and_names_of_the_axes_of_thin_scenes_stand_apart(size):
    """As measured on the page once it is drawn: all numbers and names of each view beside each other."""
    figure = on_a_field(*size, box_size=0.4 * size[2])
    figure.draw_without_rendering()
    for axes in figure.axes:
        shown = []
        for axis in (getattr(axes, name) for name in ("xaxis", "yaxis", "zaxis") if hasattr(axes, name)):
            low, high = sorted(axis.get_view_interval())
            shown += [tick.label1 for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high and tick.label1.get_text()]
            shown += [axis.label] if axis.label.get_visible() else []
        assert len(shown) > 3
        boxes = [text.get_window_extent() for text in shown]
        for number, one in enumerate(boxes):
            assert not one.count_overlaps(boxes[number + 1:]), [text.get_text() for text in shown]


def test_a_scene_of_a_hand_fills_its_picture():
    """The radar stands 1 m above a field of 0.3 m in `on_a_field`; here nothing is farther than 0.3 m."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.02, 0.02), name="plate", material="metal", position=(0.3, 0.0, 0.0))
    radar = build_radar([(0, 0, 0)], [(0, 0, 0)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    left, right = plot_scene(scene, ep.trace(scene, radar, num_rays=500)).axes[1].get_xlim()
    assert left < 0.0 and right > 0.3 and right - left < 0.6


def test_a_slope_hides_neither_what_stands_on_it_nor_rays():
    """As `test_a_field_hides_...`, of a field that rises by 12 m."""
    scene, rise = ep.Scene(), 0.2
    corners = np.array([[0.0, -10.0, 0.0], [60.0, -10.0, 12.0], [60.0, 10.0, 12.0], [0.0, 10.0, 0.0]])
    scene.add(ep.Mesh(corners, np.array([[0, 1, 2], [0, 2, 3]])), name="slope", material="grass")
    scene.add(ep.actors.box(2.0), name="box", material="metal", position=(48.0, 4.0, 48.0 * rise + 1.0))
    radar = build_radar([(0, 0, 2)], [(0, 0, 2)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=500))
    figure.canvas.draw()
    axes, picture = figure.axes[0], np.asarray(figure.canvas.buffer_rgba())[..., :3].astype(int)

    def colours(*place) -> np.ndarray:
        across, up = axes.transData.transform(proj_transform(*place, axes.get_proj())[:2])
        return picture[int(len(picture) - up) - 4:int(len(picture) - up) + 5, int(across)]

    field = colours(30.0, -5.0, 30.0 * rise)[4]
    assert np.abs(colours(47.0, 4.0, 48.0 * rise + 1.0) - field).max() > 10  # the side of the box that faces the radar
    assert np.abs(colours(23.5, 2.0, 24.0 * rise + 1.5) - field).max() > 10  # half-way between the radar and that side


def test_names_of_objects_behind_each_other_stand_apart():
    """As measured on the page once it is drawn."""
    scene = ep.Scene()
    for k in range(6):
        scene.add(ep.actors.plate(0.3, 0.3), name=f"motorcycle_{k}", material="metal", position=(5.0 + 0.1 * k, 0.05 * k, 1.0))
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=500))
    figure.draw_without_rendering()
    for axes in figure.axes[:2]:  # in perspective, from above
        names = [text for text in axes.texts if text.get_text().startswith("motorcycle")]
        boxes = [_box_of_first_line(text) for text in names]
        assert len(boxes) == 6
        assert not any(one.overlaps(other) for one, other in itertools.combinations(boxes, 2))


def test_of_a_street_full_of_objects_the_strongest_bear_names_that_stand_near_them():
    """As measured on the page once it is drawn: 30 plates in a row of 60 m, of which every third is 3 m wide."""
    scene = ep.Scene()
    for k in range(30):
        name, size = (f"large_{k}", 3.0) if k % 3 == 0 else (f"small_{k}", 0.2)
        scene.add(ep.actors.plate(size, size), name=name, position=(5.0 + 2.0 * k, 3.0, 1.0),
                  material=ep.Material(reflectivity=0.3, scattering=1.0))
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=5000))
    figure.draw_without_rendering()
    from_above = figure.axes[1]
    names = [text for text in from_above.texts if text.get_text() != "radar"]
    boxes = [text.get_window_extent() for text in names]
    assert 5 < len(boxes) <= 20 and sum(text.get_text().startswith("large") for text in names) >= 8
    assert not any(one.overlaps(other) for one, other in itertools.combinations(boxes, 2))
    line = boxes[0].height
    for text, box in zip(names, boxes):
        assert 0.0 <= box.y0 - from_above.transData.transform(text.xy)[1] < 5.0 * line
    assert max(box.y1 for box in boxes) <= from_above.title.get_window_extent().y0


def test_names_of_a_dozen_objects_at_one_place_stay_below_the_title():
    """As many as all find room: three of them left the page, and one stood on its title."""
    scene = ep.Scene()
    for k in range(12):
        scene.add(ep.actors.box(1.0), name=f"box_{k}", position=(10.0, 0.01 * k, 0.8), yaw=0.1 * k,
                  material=ep.Material(reflectivity=0.3, scattering=1.0))
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=2000))
    figure.draw_without_rendering()
    boxes = [_box_of_first_line(text) for text in figure.axes[0].texts if text.get_text().startswith("box")]
    assert len(boxes) == 12 and max(box.y1 for box in boxes) < figure._suptitle.get_window_extent().y0


def test_names_of_mirrors_of_objects_and_of_the_radar_stand_apart():
    """As measured on the page once it is drawn: two rows of facades, with cars before them, one of them near the radar."""
    scene = ep.Scene()
    for k in range(16):
        scene.add(ep.actors.plate(4.0, 3.0), name=f"facade_{k}", position=(8.0 + 6.0 * k, 12.0 * (-1) ** k, 1.5), yaw=0.5 * np.pi,
                  material=ep.materials["concrete"].replace(mirror=True))
    for k in range(6):
        scene.add(ep.actors.box(1.0), name=f"car_{k}", position=(3.0 + 15.0 * k, 11.0 * ((k + 1) % 3 - 1), 0.5),
                  material=ep.Material(reflectivity=0.3, scattering=1.0))
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=1000))
    figure.draw_without_rendering()
    for axes in figure.axes[:2]:  # in perspective, from above
        texts = [text for text in axes.texts if text.get_text()]
        boxes = [_box_of_first_line(text) for text in texts]
        names = [text.get_text().split("_")[0] for text in texts]
        assert names.count("car") == 6 and names.count("facade") >= 2
        assert not any(one.overlaps(other) for one, other in itertools.combinations([*boxes, axes.title.get_window_extent()], 2))


def _box_of_first_line(text) -> Bbox:
    """On the page; texts in perspective are put where they are drawn."""
    if hasattr(text, "get_position_3d"):
        text.set_position(proj_transform(*text.get_position_3d(), text.axes.get_proj())[:2])
    box = text.get_window_extent()
    return Bbox.from_extents(box.x0, box.y1 - box.height / len(text.get_text().split("\n")), box.x1, box.y1)


def test_a_picture_of_a_town_names_the_objects_of_its_labels_and_shows_rays_to_each():
    scene = ep.Scene()
    town = scene.add(None, name="town")
    rough = ep.Material(reflectivity=0.3, scattering=1.0)
    for k, size in enumerate((2.0, 0.4)):
        scene.add(ep.actors.plate(size, size), name=f"plate{k}", material=rough, position=(6.0, 2.0 * k, 1.0), parent=town)
    scene.add(ep.actors.plate(0.3, 0.3), name="rest", material=rough, position=(5.0, -2.0, 1.0), parent=town)
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    paths = ep.trace(scene, radar, num_rays=2000)
    figure = plot_scene(scene, paths, objects={"large": "town/plate0", "small": ["town/plate1"]})
    names = {text.get_text().strip() for text in figure.axes[1].texts}
    assert {"large", "small"} <= names and not names & {"town", "rest"}
    drawn = np.concatenate([segment for lines in figure.axes[1].collections if hasattr(lines, "get_segments")
                            for segment in lines.get_segments()])
    assert np.any(np.hypot(*(drawn - (6.0, 2.0)).T) < 0.3)  # at the small one, whose echo is the weakest


@pytest.mark.parametrize("size", [(20.0, 20.0), (0.3, 40.0), (40.0, 0.3)])
@pytest.mark.filterwarnings("error:constrained_layout")
def test_high_scenes_have_room_for_their_labels(size, tmp_path):
    scene = ep.Scene()
    corners = np.array([[0.0, 0.0, 0.0], [0.0, size[0], 0.0], [0.0, 0.0, size[1]]])
    scene.add(ep.Mesh(corners, np.array([[0, 2, 1]])), name="sail", material="metal", position=(3.0, 0.0, 0.0))
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=500))
    save_png(figure, tmp_path / "scene.png")
    boxes = [axes.get_tightbbox() for axes in figure.axes]
    assert boxes[0].y0 > max(box.y1 for box in boxes[1:])  # that in perspective stands above the others


@pytest.mark.filterwarnings("error:constrained_layout")
def test_a_radar_that_stands_far_from_the_origin_leaves_room_for_the_pictures(tmp_path):
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.5, 0.5), name="plate", material="metal", position=(20.0, 500.0, 1.0))
    radar = build_radar([(0, 0, 0)], [(0, 0, 0)], num_samples=16, num_chirps=2, chirp_interval=1e-4, position=(-3.0, 500.0, 1.0))
    save_png(plot_scene(scene, ep.trace(scene, radar, num_rays=500)), tmp_path / "scene.png")


def test_what_is_smaller_than_a_dot_of_the_picture_is_drawn_as_dots():
    """A ball of 20,480 triangles in a scene of 100 m, which covers some 20 dots across, and is seen whole."""
    scene = ep.Scene()
    rough = ep.Material(reflectivity=0.3, scattering=1.0)
    scene.add(ep.actors.sphere(0.5, subdivisions=32), name="ball", material=rough, position=(50.0, 0.0, 1.0))
    scene.add(ep.actors.plate(2.0, 2.0), name="plate", material="metal", position=(100.0, 10.0, 1.0))
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=500))
    figure.set_dpi(300)
    figure.canvas.draw()
    from_above = figure.axes[1]
    assert max(len(some.get_paths()) for some in from_above.collections if isinstance(some, PolyCollection)) < 4000
    page = np.asarray(figure.canvas.buffer_rgba())[..., :3]
    to_page = from_above.transData.transform
    (left, low), (right, high) = to_page((49.65, -0.35)), to_page((50.35, 0.35))  # a square within the ball
    column, row = slice(int(np.ceil(left)), int(right)), slice(-int(high), -int(np.ceil(low)))
    assert page[row, column].size > 0 and page[row, column].max() < 200


def test_a_ground_of_too_many_triangles_is_drawn_whole_of_fewer(monkeypatch):
    """20,000 triangles of 0.4 m, which are larger than dots, in a picture that may have 3000."""
    monkeypatch.setattr(drawing, "MOST_TRIANGLES", 3000)
    side = np.linspace(-20.0, 20.0, 101)
    x, y = np.meshgrid(side + 25.0, side, indexing="ij")
    corner = np.arange(101 * 101).reshape(101, 101)
    a, b, c, d = (part.ravel() for part in (corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]))
    ground = ep.Mesh(np.stack([x, y, 0.1 * np.sin(x)], axis=-1).reshape(-1, 3),
                     np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)]))
    scene = ep.Scene()
    scene.add(ground, name="ground", material=ep.Material(reflectivity=0.3, scattering=1.0))
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=500))
    figure.canvas.draw()
    from_above = figure.axes[1]
    assert max(len(some.get_paths()) for some in from_above.collections if isinstance(some, PolyCollection)) <= 3000
    page = np.asarray(figure.canvas.buffer_rgba())[..., :3]
    (left, low), (right, high) = from_above.transData.transform(((7.0, 2.0), (43.0, 18.0)))  # beside rays and names
    assert page[-int(high):-int(np.ceil(low)), int(np.ceil(left)):int(right)].min(axis=-1).max() < 200  # nothing is white


@pytest.mark.parametrize("num_poles", [45, 100])
def test_poles_on_a_ground_of_too_many_triangles_stay_where_and_as_high_as_they_are(monkeypatch, num_poles):
    """One pole in each metre of a row, of 32 triangles of 4 m by 1 cm: fewer in all than the share of their mesh, and more."""
    monkeypatch.setattr(drawing, "MOST_TRIANGLES", 3000)
    angle = 2.0 * np.pi * np.arange(16) / 16
    ring = 0.03 * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    foot = (ring + np.stack([1.0 + np.arange(num_poles), np.zeros(num_poles)], axis=-1)[:, None]).reshape(-1, 2)
    this = np.arange(len(foot))
    following, count = np.where(this % 16 == 15, this - 15, this + 1), len(foot)
    poles = ep.Mesh(np.concatenate([np.column_stack([foot, np.zeros(count)]), np.column_stack([foot, np.full(count, 4.0)])]),
                    np.concatenate([np.column_stack([this, following, following + count]),
                                    np.column_stack([this, following + count, this + count])]))
    scene, rough = ep.Scene(), ep.Material(reflectivity=0.3, scattering=1.0)
    scene.add(ep.actors.ground(110.0, edge=1.0), name="ground", position=(50, 0, 0), material=rough)
    scene.add(poles, name="poles", material=rough)
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=500))
    drawn = np.concatenate([path.vertices for some in figure.axes[2].collections if isinstance(some, PolyCollection)
                            for path in some.get_paths()])
    assert drawn[:, 1].max() == pytest.approx(4.0)
    assert set(1 + np.arange(num_poles)) <= set(drawn[drawn[:, 1] > 3.9, 0].round())


def test_many_meshes_of_few_triangles_are_thinned_as_one_of_many_is(monkeypatch):
    monkeypatch.setattr(drawing, "MOST_TRIANGLES", 1000)
    scene, rough = ep.Scene(), ep.Material(reflectivity=0.3, scattering=1.0)
    for place in range(16):
        scene.add(ep.actors.sphere(1.0, subdivisions=4), name=f"ball {place}", position=(10 + 3 * place, 0, 0), material=rough)
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    assert scene.num_triangles > 2000
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=500))
    assert sum(len(some.get_paths()) for some in figure.axes[1].collections if isinstance(some, PolyCollection)) <= 1000


def test_the_name_of_a_bent_object_stands_at_the_object():
    """In its box that of a rail along a curve would be as far beside it as the curve is deep, 8 m here."""
    scene = ep.Scene()
    scene.add(ep.actors.guard_rail(points=[(5.0, 0.0), (15.0, 1.0), (25.0, 8.0), (30.0, 16.0)]), name="rail")
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    from_above = plot_scene(scene, ep.trace(scene, radar, num_rays=500)).axes[1]
    (name,) = (text for text in from_above.texts if text.get_text() == "rail")
    x, y = name.xy if hasattr(name, "xy") else name.get_position()
    assert 16.0 < x < 19.0 and 1.0 < y < 4.0


def test_a_body_of_mirrors_is_shown_whole_and_a_road_as_far_as_the_rest_goes():
    scene = ep.Scene()
    scene.add(ep.actors.ground(200.0), name="road", material=ep.Material.metal(mirror=True))
    scene.add(ep.actors.plate(0.3, 0.3), name="plate", material="metal", position=(5.0, 0.0, 1.0))
    scene.add(ep.actors.plate(2.0, 1.5), name="van", material=ep.Material.metal(mirror=True), position=(5.5, 0.1, 1.0),
              yaw=0.5 * np.pi)  # reaches from x = 4.5 to 6.5 m
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    left, right = plot_scene(scene, ep.trace(scene, radar, num_rays=500)).axes[1].get_xlim()
    assert (left, right) == pytest.approx((-0.6, 6.5 + 0.6))


@pytest.mark.parametrize("view, yaw", [(1, 0.0), (1, 0.5), (2, 0.0)])
def test_what_is_seen_edge_on_is_shown_as_a_line(view, yaw):
    """An upright pane from above, along an axis and aslant, and from the side, halfway from its middle to its right edge."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(4.0, 2.0), name="pane", material="glass_pane", position=(5.0, 0.0, 1.0), yaw=yaw)
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=100))
    figure.canvas.draw()
    place = (5.0 + np.sin(yaw), -np.cos(yaw)) if view == 1 else (5.0, 1.5)
    column, row = np.round(figure.axes[view].transData.transform(place)).astype(int)
    page = np.asarray(figure.canvas.buffer_rgba())[..., :3]
    assert page[-row - 2:-row + 1, column - 1:column + 2].min() < 150  # of 255: darker than the page and than pale rays
