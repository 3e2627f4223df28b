"""Where rays are drawn, in which colours, and which one a click takes."""
from __future__ import annotations

import matplotlib
import numpy as np
import pytest

import echopath as ep
from echopath_viewer.model import ray_segments
from echopath_viewer.model.antennas import world_from_antenna
from echopath_viewer.model.rays.picking import nearest_segment
from support.signals.placed_radar import make_radars

ROUNDING = 1e-9
SHADE = 0.2 * 255   # of a mesh of two from the colour of their object
BORDER = 0.01    # of a colour of 256: single precision
SINGLE = 2e-6    # relative, of positions kept in single precision


def test_segments_lead_from_the_transmitter_by_all_hits_to_the_receiver(frame):
    rng = np.random.default_rng(5)
    chosen = rng.choice(frame.paths.num_paths, 200, replace=False)  # in no order
    time = frame.radar.chirp_time(0, 3)
    tx, rx = np.array([0.0, 0.0, 0.0]), np.array([0.0, 0.01, 0.0])
    segments = ray_segments(frame.paths, chosen, time, tx, rx)
    points, row = frame.paths.points(time), 0
    for number, path in enumerate(chosen):
        first, count = frame.paths.offsets[path], frame.paths.num_bounces[path]
        corners = np.vstack([tx, points[first:first + count], rx])
        meshes = list(frame.paths.mesh_id[first:first + count])
        for bounce in range(count + 1):
            assert segments.ray[row] == number and segments.bounce[row] == bounce
            assert segments.mesh_id[row] == (meshes + meshes[-1:])[bounce]
            begin, end = segments.points[segments.ends[row]]
            assert begin == pytest.approx(corners[bounce], rel=SINGLE, abs=SINGLE)
            assert end == pytest.approx(corners[bounce + 1], rel=SINGLE, abs=SINGLE)
            row += 1
    assert row == segments.num_segments
    assert segments.num_segments_of(10) == sum(frame.paths.num_bounces[chosen[:10]] + 1)


def test_rays_have_the_length_that_replay_gives_them(session, frame):
    for chirp in (0, 31):
        session.set_chirp(chirp)
        rays = session.shown_rays(100)
        segments = session.segments(rays)
        ends = segments.points[segments.ends].astype(float)
        pieces = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        lengths = np.bincount(segments.ray, pieces)
        assert lengths == pytest.approx(frame.paths.lengths([session.time], 0, 0)[0][rays], rel=SINGLE, abs=0)


def test_a_selection_without_rays_has_no_segments(session):
    segments = session.segments(session.lit_rays())
    assert segments.num_segments == 0 and len(session.colouring(segments).rgb) == 0


@pytest.mark.parametrize("mode", ["bounces", "mesh", "power", "range", "speed"])
def test_every_segment_has_the_colour_of_its_legend(session, mode):
    session.set_color_by(mode)
    segments = session.segments(session.shown_rays(300))
    colouring = session.colouring(segments)
    assert colouring.rgb.shape == (segments.num_segments, 3) and colouring.rgb.dtype == np.uint8
    for row in range(0, segments.num_segments, 37):
        path = segments.rays[segments.ray[row]]
        if mode == "bounces":
            assert dict(colouring.legend.rows)[str(session.paths.num_bounces[path])] == tuple(colouring.rgb[row])
        elif mode == "mesh":
            of_object = dict(colouring.legend.rows)[session.mesh_names[segments.mesh_id[row]].partition("/")[0]]
            assert np.abs(np.subtract(of_object, colouring.rgb[row].astype(int))).max() <= SHADE
        else:
            columns = session.columns
            value = {"power": columns.power_dbm(), "range": columns.range, "speed": columns.velocity}[mode][path]
            assert_colour_of_scale(colouring.rgb[row], value, colouring.legend)


def assert_colour_of_scale(rgb, value: float, legend) -> None:
    """One look-up in matplotlib's own way; a value at the border of two of the 256 colours may have either."""
    low, high = legend.clim
    assert low < high
    colours = matplotlib.colormaps[legend.cmap]
    shares = [(value - low) / (high - low) * 255 + off for off in (-BORDER, BORDER)]
    rows = [int(np.clip(np.floor(share), 0, 255)) for share in shares]
    assert tuple(rgb) in [tuple(colours(row, bytes=True)[:3]) for row in rows]


def test_a_scale_of_ones_own_is_taken(session):
    session.set_color_by("power")
    segments = session.segments(session.shown_rays(10))
    rgb = session.colouring(segments, cmap="gray", clim=(-1000.0, -900.0)).rgb
    assert np.all(rgb == 255)
    for wrong in ("greyish", 3, ["red", "blue"]):
        with pytest.raises(ValueError, match="cmap"):
            session.colouring(segments, cmap=wrong)
    with pytest.raises(ValueError, match="clim"):
        session.colouring(segments, clim=(-900.0, -1000.0))


@pytest.mark.parametrize("cmap", ["tab10", "twilight", matplotlib.colormaps["plasma"].resampled(5),
                                  matplotlib.colors.ListedColormap(["red", "lime", "blue"])], ids=str)
def test_colour_maps_of_any_number_of_colours_span_the_scale(session, cmap):
    session.set_color_by("range")
    segments = session.segments(session.shown_rays())
    found = session.colouring(segments, cmap=cmap)
    (low, high), colours = found.legend.clim, matplotlib.colormaps[cmap] if isinstance(cmap, str) else cmap
    shares = (session.columns.range[segments.rays[segments.ray]].astype(float) - low) / (high - low)
    steps = [np.clip(np.floor(255.0 * shares + off), 0.0, 255.0) / 255.0 for off in (-BORDER, BORDER)]
    below, above = (colours(step, bytes=True)[:, :3] for step in steps)
    assert np.all((found.rgb == below).all(axis=1) | (found.rgb == above).all(axis=1))
    assert tuple(found.rgb[shares.argmin()]) == tuple(colours(0.0, bytes=True)[:3])
    assert tuple(found.rgb[shares.argmax()]) == tuple(colours(1.0, bytes=True)[:3])


def test_the_picked_segment_is_the_one_whose_picture_is_nearest():
    rng = np.random.default_rng(6)
    points, ends = rng.uniform(-1.0, 1.0, (60, 3)), np.arange(60).reshape(30, 2)
    clip_from_world = np.array([[1.2, 0, 0, 0], [0, 1.5, 0, 0], [0, 0, -1, -0.1], [0, 0, -1, 3.0]])  # eye at z = 3
    size = (400, 300)
    for cursor in rng.uniform((0, 0), size, (50, 2)):
        slow = []
        for begin, end in ends:
            dense = points[begin] + np.linspace(0, 1, 4001)[:, None] * (points[end] - points[begin])
            clip = np.column_stack([dense, np.ones(len(dense))]) @ clip_from_world.T
            x, y = clip[:, 0] / clip[:, 3], clip[:, 1] / clip[:, 3]
            slow.append(np.hypot((0.5 + 0.5 * x) * 400 - cursor[0], (0.5 - 0.5 * y) * 300 - cursor[1]).min())
        found = nearest_segment(points, ends, clip_from_world, size, cursor, reach=6.0)
        assert (found is None) == (min(slow) > 6.0)
        assert found is None or slow[found] == pytest.approx(min(slow), abs=0.2)


def test_segments_behind_the_eye_are_not_picked():
    clip_from_world = np.array([[1.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, -0.1], [0, 0, -1, 0.0]])  # looks along -z
    behind, across = [[0, 0, 1.0], [0, 0, 2.0]], [[0, 0, 3.0], [0.5, 0, -1.0]]
    ends = np.array([[0, 1]])
    assert nearest_segment(np.array(behind), ends, clip_from_world, (100, 100), (50, 50), 5.0) is None
    assert nearest_segment(np.array(across), ends, clip_from_world, (100, 100), (75, 50), 5.0) == 0


def test_antennas_stand_and_look_where_the_placed_radar_takes_them():
    placed, by_hand = make_radars((3.0, -2.0, 1.2), 0.5, 0.1, motion=ep.LinearMotion(velocity=(4.0, 1.0, 0.0)))
    for one, other in zip(placed.receivers, by_hand.receivers, strict=True):
        for time in (0.0, 0.7):
            np.testing.assert_allclose(world_from_antenna(placed, one, time), world_from_antenna(by_hand, other, time),
                                       atol=ROUNDING)
