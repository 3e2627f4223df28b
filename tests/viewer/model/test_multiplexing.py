"""Radars whose transmitters take turns or send at once: the viewer shows the signal of each transmitter alone."""
from __future__ import annotations

import numpy as np
import pytest

import echopath as ep
from echopath_viewer.model import CellBox, Filters, Session, from_frame, from_paths
from echopath_viewer.model.frames import preview
from echopath_viewer.model.frames.time_line import time_line_of

SYNTHESIS = 1e-6  # relative to the largest: the synthesis promises 1e-7 of all amplitudes, which other paths share
GHOSTS = "T .* 'walker' .* R"
TX, RX = 1, 0     # the transmitter that no sum over transmitters has


def radar_of(frame, multiplexing: str):
    """The radar of the frame; its 30 chirps are a multiple of the three shares that "ddm" has for two transmitters."""
    return frame.radar.replace(waveform=frame.radar.waveform.replace(num_chirps=30), multiplexing=multiplexing)


@pytest.fixture(scope="module", params=["tdm", "bpm", "ddm"])
def made(request, frame):
    """The scene of all viewer tests without noise, where the simulation itself gives the signals that are looked for."""
    return ep.simulate(frame.scene, radar_of(frame, request.param), num_rays=800, max_bounces=3, seed=3, noise_seed=None,
                       parts={"route": {"ghost": GHOSTS}})


@pytest.fixture
def session(made):
    session = Session(from_frame(made))
    session.set_channel(TX, RX)
    return session


def assert_ghosts(part, made) -> None:
    wanted = ep.range_doppler(made.parts["route"]["ghost"], made.radar).values
    assert part.spectrum.values.shape == wanted.shape
    assert np.abs(part.spectrum.values - wanted).max() <= SYNTHESIS * np.abs(wanted).max()


def test_parts_named_in_the_viewer_are_those_of_the_frame(session, made):
    session.set_filters(Filters(expression=GHOSTS))
    assert_ghosts(session.add_part("mine"), made)


def test_the_map_of_a_mesh_is_that_of_the_paths_over_it(session, made):
    session.set_part(("route", "ghost"))
    session.select_node("walker")  # all ghosts touch the walker
    part, = session.parts.of_group("mesh")
    assert_ghosts(part, made)


@pytest.mark.parametrize("tx", [0, TX])
def test_all_rays_of_the_map_have_the_power_of_the_whole_from_chirp_to_chirp(session, made, tx):
    session.set_channel(tx, RX)
    whole = session.slow_time_power()
    session.select_cells(CellBox(0, 127, 0, 29))
    wanted = made.cube[tx, RX]
    assert session.lit.all()
    mean_power = 10.0 * np.log10(np.mean(np.abs(wanted) ** 2, axis=-1)) + 30.0
    found = session.slow_time_power()
    assert found.shape == whole.shape == (30,)
    assert found == pytest.approx(mean_power, rel=0, abs=1e-3)


def test_paths_alone_have_the_signal_of_the_frame(made):
    view_input = from_paths(made.scene, made.paths)
    assert np.abs(view_input.cube - made.cube).max() <= SYNTHESIS * np.abs(made.cube).max()


def test_large_files_are_previewed(made, tmp_path, monkeypatch):
    monkeypatch.setattr(preview, "LARGE", 1)
    path = tmp_path / "large.h5"
    ep.save_frame(made, path)
    shown = preview.preview_of(path)
    assert np.array_equal(shown.parts.whole.spectrum.values, made.spectrum.values)
    assert shown.cube.shape == made.cube.shape


@pytest.mark.parametrize("multiplexing", ["tdm", "bpm", "ddm"])
def test_frames_of_maps_alone_are_shown(frame, multiplexing, tmp_path):
    run = ep.Sequence(frame.scene, radar_of(frame, multiplexing), frames=2, interval=0.1, num_rays=300, max_bounces=1)
    stored = run.save(tmp_path / "maps", keep="maps")
    shown = time_line_of(stored.path).read(1)
    power = np.abs(shown.parts.whole.spectrum.values[TX, RX]) ** 2
    assert power == pytest.approx(stored[1].power, rel=1e-5, abs=0)
    assert shown.cube.shape == (2, 2, 30, 128)


def test_a_beam_of_maps_alone_selects_the_strongest_velocity_at_its_range(tmp_path):
    """All channels have the same values there, which the beam toward the ball took for an echo from straight ahead: it left that
    out, and selected noise 19 dB below the ball."""
    chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=64, sampling_rate=10e6, num_chirps=16,
                              chirp_interval=1e-4)
    radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0.0078 * m, 0)) for m in range(2)],
                     receivers=[ep.Antenna((0, 0.00195 * n, 0)) for n in range(4)])
    azimuth = np.arcsin(0.25)  # where eight elements half a wavelength apart hear nothing of what is straight ahead
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.2), name="ball", material="metal", smooth=True,
              position=(5.0 * np.cos(azimuth), 5.0 * np.sin(azimuth), 0.0))
    stored = ep.Sequence(scene, radar, frames=1, interval=0.1, num_rays=1000, guard=False).save(tmp_path / "maps", keep="maps")
    session = Session(time_line_of(stored.path).read(0))
    velocity, distance = (int(index) for index in np.unravel_index(stored[0].power.argmax(), stored[0].power.shape))
    session.select_beam(distance, azimuth, 0.0)
    assert session.cell == (distance, velocity) and stored[0].velocity[velocity] == 0.0
