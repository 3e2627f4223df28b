"""Signals of parts in the viewer: made as the frame was made, and never put to paths that are not theirs."""
from __future__ import annotations

import numpy as np
import pytest

import echopath as ep
from echopath_viewer.model import OWN_GROUP, CellBox, Filters, Session, from_frame, from_paths
from echopath_viewer.model.frames.live_session import input_of_view, live_of
from support.radars import build_radar

SYNTHESIS = 1e-6    # relative to the largest: the synthesis promises 1e-7 of all amplitudes, which other paths share
SLOW_CHIRPS = 4e-3  # s: the walker goes most of a metre in the frame
CLEARLY = 1e-3      # relative: what another setting changes
GHOSTS = "T .* 'walker' .* R"


def simulated_anew(frame, **settings):
    """The scene of the frame with few rays, in so long a frame that those traced anew differ."""
    radar = radar_like(frame.radar, waveform={"chirp_interval": SLOW_CHIRPS})
    parts = {"route": {"direct": "T 'walker' R", "ghost": GHOSTS}}
    made = ep.simulate(frame.scene, radar, num_rays=400, max_bounces=2, seed=3, noise_seed=None, parts=parts, **settings)
    made.keyframes = settings.get("keyframes", 0)
    return made


@pytest.mark.parametrize("settings", [
    {"retrace": "invalid"}, {"retrace": "invalid", "keyframes": 3}, {"retrace": "always", "keyframes": 3},
])
def test_a_part_named_in_the_viewer_is_made_as_the_frame_was(frame, settings):
    made = simulated_anew(frame, **settings)
    session = Session(from_frame(made))
    session.set_filters(Filters(expression=f"{GHOSTS} & ~(T 'walker' R)"))
    part = session.add_part("mine")
    wanted = made.part_spectra["route"]["ghost"].values
    largest = np.abs(wanted).max()
    assert np.abs(part.spectrum.values - wanted).max() <= SYNTHESIS * largest
    assert session.signals.settings == {"evaluate": "interpolated", "keyframes": 0, "replay": "material"} | settings
    if settings["retrace"] == "always":  # this scene has no path that "invalid" renews
        plain = ep.range_doppler(ep.synthesize(made.paths.select(session.visible)), made.radar).values
        assert np.abs(plain - wanted).max() > CLEARLY * largest


def test_moving_echoes_are_evaluated_as_in_the_frame(frame):
    made = simulated_anew(frame, evaluate="samples")
    session = Session(from_frame(made))
    session.select_cells(CellBox(0, 127, 0, 31))
    cube = ep.synthesize(made.paths.select(session.lit), evaluate="samples")
    assert session.lit.any() and np.array_equal(session.signals.cube(session.lit), cube)
    assert not np.array_equal(ep.synthesize(made.paths.select(session.lit)), cube)


def frame_of_a_ball_along_a_wall(**settings) -> ep.Frame:
    """The wall is not flagged: the way over it has another point of reflection in each chirp."""
    scene = ep.Scene()
    scene.add(ep.actors.wall(30.0, 4.0), name="wall", material="metal", position=(10, 3, 0), yaw=-np.pi / 2)
    scene.add(ep.actors.sphere(0.4, edge=0.06), name="ball", material="metal", smooth=True, position=(8, 0, 0.8),
              motion=ep.LinearMotion((20.0, 0.0, 0.0)))
    radar = build_radar([(0, 0, 0.7)], [(0, 0.01, 0.7)], num_chirps=32, bandwidth=5e8, chirp_interval=2e-4)
    return ep.simulate(scene, radar, num_rays=4000, max_bounces=2, replay="fermat", guard=False, **settings)


def test_points_of_reflection_slide_as_in_the_frame():
    ghosts = "T 'ball' 'wall' R | T 'wall' 'ball' R"
    made = frame_of_a_ball_along_a_wall(parts={"ghost": ghosts})
    session = Session(from_frame(made))
    session.set_filters(Filters(expression=ghosts))
    found, wanted = session.add_part("mine").spectrum.values, made.part_spectra["parts"]["ghost"].values
    assert np.abs(found - wanted).max() <= SYNTHESIS * np.abs(wanted).max()


def test_signals_of_a_scene_that_becomes_live_are_made_as_before():
    live = live_of(Session(from_frame(frame_of_a_ball_along_a_wall(evaluate="samples"))), num_rays=4000)
    view = live.update()
    made = ep.synthesize(live.paths(), replay="fermat", evaluate="samples")
    largest = np.abs(made).max()
    assert np.abs(view.cube - made).max() <= SYNTHESIS * largest
    assert np.abs(input_of_view(live, view).signals.whole() - made).max() <= SYNTHESIS * largest
    for other in ({"replay": "fermat"}, {"evaluate": "samples"}):
        assert np.abs(ep.synthesize(live.paths(), **other) - made).max() > 10 * SYNTHESIS * largest


def test_a_map_within_a_part_is_of_that_part_where_the_scene_is_traced_anew(frame):
    made = simulated_anew(frame, retrace="always", keyframes=2)
    session = Session(from_frame(made))
    session.set_part(("route", "ghost"))
    session.select_node("walker")
    wanted = made.part_spectra["route"]["ghost"].values  # all ghosts touch the walker
    part, = session.parts.of_group("mesh")
    assert np.abs(part.spectrum.values - wanted).max() <= SYNTHESIS * np.abs(wanted).max()


def test_rays_without_words_have_no_signal_where_the_scene_is_traced_anew(frame):
    session = Session(from_frame(simulated_anew(frame, retrace="always", keyframes=2)))
    session.select_cells(CellBox(0, 60, 0, 31))
    with pytest.raises(ValueError, match="traced anew"):
        session.slow_time_power()
    session.select_node("walker")
    session.set_filters(Filters(min_power_dbm=-200.0))
    with pytest.raises(ValueError, match="traced anew"):
        session.add_part("strong")
    with pytest.raises(ValueError, match="traced anew"):
        session.refresh_node()
    assert session.node == "walker" and not session.parts.of_group("mesh")  # rather none than one of other filters
    assert (OWN_GROUP, "strong") not in session.parts


def test_paths_are_synthesised_as_asked(frame):
    paths = simulated_anew(frame).paths
    settings = {"evaluate": "chirps", "retrace": "invalid", "keyframes": 2}
    view_input = from_paths(None, paths, {"ghost": GHOSTS}, **settings)
    assert np.array_equal(view_input.cube, ep.synthesize(paths, **settings))
    wanted = ep.range_doppler(ep.decompose(paths, None, {"ghost": GHOSTS}, **settings)["ghost"], paths.radar).values
    assert np.array_equal(view_input.parts["parts", "ghost"].spectrum.values, wanted)


@pytest.mark.parametrize("change", [
    {"waveform": {"bandwidth": 5e8}}, {"waveform": {"start_frequency": 60e9}}, {"transmit_power": 1.0},
    {"receivers": [ep.Antenna((0, 0.02, 0)), ep.Antenna((0, -0.4, 0.2))]},
    {"receivers": [ep.Antenna((0, 0.01, 0)), ep.Antenna((0, -0.4, 0.2), pattern=ep.Isotropic(gain=0.5))]},
    {"motion": ep.LinearMotion(velocity=(1.0, 0.0, 0.0))},
])
def test_parts_for_another_radar_are_refused(frame, change):
    name = next(iter(change["waveform"])) if "waveform" in change else next(iter(change))
    parts = ep.decompose(frame.paths, radar_like(frame.radar, **change), {"ghost": GHOSTS})
    with pytest.raises(ValueError, match=f"parts: must be of the radar that traced the paths.* {name}"):
        from_paths(None, frame.paths, parts)


@pytest.mark.parametrize("change", [{}, {"receiver": ep.Receiver(low_pass=8e6), "noise_figure_db": 15.0}], ids=str)
def test_parts_for_a_radar_of_the_same_echoes_are_taken(frame, change):
    parts = ep.decompose(frame.paths, radar_like(frame.radar, **change), {"ghost": GHOSTS})
    assert from_paths(None, frame.paths, parts).parts["parts", "ghost"].mask.any()


def radar_like(radar, waveform=(), **change):
    names = ("start_frequency", "bandwidth", "num_samples", "sampling_rate", "num_chirps", "chirp_interval", "real")
    fields = {name: getattr(radar.waveform, name) for name in names} | dict(waveform)
    keywords = {"transmitters": radar.transmitters, "receivers": radar.receivers, "transmit_power": radar.transmit_power}
    return ep.Radar(ep.ChirpSequence(**fields), **(keywords | change))


def test_signals_given_without_selections_light_no_rays(frame):
    cubes = dict(ep.decompose(frame.paths, frame.radar, {"ghost": GHOSTS}))
    session = Session(from_paths(None, frame.paths, cubes))
    session.set_part(("parts", "ghost"))
    assert not session.part.is_known and not session.visible.any()
    session.select_cells(CellBox(0, 127, 0, 31))
    assert len(session.lit_rays()) == len(session.shown_rays()) == 0
    assert np.array_equal(session.part.spectrum.values, ep.range_doppler(cubes["ghost"], frame.radar).values)
