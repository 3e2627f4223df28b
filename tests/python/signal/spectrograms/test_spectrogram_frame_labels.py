"""Labels of spectrograms that follow from frames: parts, objects and ghosts, as the maps of these frames have them."""
from __future__ import annotations

import pickle

import numpy as np
import pytest

import echopath as ep
from echopath.in_time import views
from support.radars import build_radar

SPEEDS = {"slow": 2.0, "fast": -5.0}
PLACES = {"slow": (6.0, -0.8, 0.0), "fast": (8.0, 0.8, 0.0)}  # neither hides the other
PARTS = {"goes": "T 'fast' R"}


def make_radar():
    return build_radar(receivers=((0, 0.001, 0), (0, 0.003, 0)), num_chirps=64, bandwidth=0.5e9, transmit_power=100.0)


def make_scene(names=tuple(SPEEDS), wall: bool = False) -> ep.Scene:
    scene = ep.Scene()
    for name in names:
        scene.add(ep.actors.sphere(0.1), name=name, material="metal", smooth=True, position=PLACES[name],
                  motion=ep.LinearMotion((SPEEDS[name], 0, 0)))
    if wall:
        scene.add(ep.actors.plate(30.0, 4.0), name="wall", material=ep.Material.metal(mirror=True), position=(5, 2.5, 0),
                  yaw=-np.pi / 2)
    return scene


def frames_of(scene, count: int = 3, first: int = 0, **keywords) -> list[ep.Frame]:
    radar = make_radar()
    length = radar.waveform.num_chirps * radar.waveform.chirp_interval
    return [ep.simulate(scene, radar, num_rays=1500, start_time=(first + number) * length, guard=False, **keywords)
            for number in range(count)]


@pytest.fixture(scope="module")
def frames() -> list[ep.Frame]:
    return frames_of(make_scene(), parts=PARTS)


@pytest.fixture(scope="module")
def found(frames) -> ep.Spectrogram:
    return ep.spectrogram(frames, window_length=32, hop=16, labels=True)


def test_parts_without_cells_are_counted_and_not_named(found):
    """Of a room there are a hundred families, most of which make no cell."""
    labels = found.labels["objects"]
    assert "ghosts" in labels.part_names and "ghosts" not in repr(labels) and "fast: " in repr(labels)
    num_empty = len(labels.part_names) - len(np.unique(labels.dominant[labels.dominant >= 0]))
    assert repr(labels).endswith(f", {num_empty} parts without cells)")


def test_each_object_owns_the_cells_of_its_velocity(found):
    labels = found.labels["objects"]
    assert labels.part_names[:2] == ["slow", "fast"] and labels.part_names[-1] == "other"
    assert np.array_equal(labels.times, found.times) and labels.mask.any()
    for name, speed in SPEEDS.items():
        cell = np.argmin(np.abs(labels.velocity - speed))
        assert np.all(labels.dominant[:, cell] == labels.part_names.index(name))
        assert np.all(labels.share[labels.part_names.index(name), :, cell] > 0.99)
    assert np.all(labels.dominant[~labels.mask] == -1)


def test_they_are_those_of_spectrograms_of_each_part(frames, found):
    settings = {"window_length": 32, "hop": 16}
    by_hand = {name: ep.spectrogram(frames, part=name, **settings) for name in SPEEDS}
    labels = found.labels["objects"]
    for name, one in by_hand.items():
        mine = labels.power[labels.part_names.index(name)]
        assert np.allclose(mine, one.power, rtol=1e-9, atol=1e-12 * one.power.max())
    parts = found.labels["parts"]
    assert parts.part_names == ["goes", "other"]
    for number, name in enumerate(parts.part_names):
        one = ep.spectrogram(frames, part=name, **settings)
        assert np.allclose(parts.power[number], one.power, rtol=1e-9, atol=1e-12 * one.power.max())
    again = ep.spectrogram_labels({name: ep.spectrogram(frames, part=name, **settings) for name in parts.part_names})
    assert np.mean(again.dominant == parts.dominant) > 0.98  # where parts interfere the whole is not the sum of their powers


@pytest.mark.parametrize("retrace", ["never", "always"])
def test_labels_of_a_channel_are_those_of_its_antennas(retrace):
    """The second transmitter looks aside, so that it hears both balls far weaker."""
    left = ep.Antenna((0, 0.01, 0), yaw=np.arctan2(0.8, 8.0) + 0.9, pattern=ep.CosinePower(30.0))
    radar = build_radar([(0, 0, 0), left], num_chirps=32, bandwidth=0.5e9, transmit_power=100.0)
    frame = ep.simulate(make_scene(), radar, num_rays=1500, guard=False, retrace=retrace, keyframes=1)
    for channel in ((0, 0), (1, 0)):
        labels = ep.spectrogram(frame, window_length=32, labels=True, channel=channel).labels["objects"]
        for name in SPEEDS:
            alone = ep.spectrogram(frame, part=name, window_length=32, channel=channel).power
            assert labels.power[labels.part_names.index(name)] == pytest.approx(alone, rel=1e-6, abs=1e-9 * alone.max())


@pytest.mark.parametrize("place", [-0.4, 0.1])  # m, in mid-frame: before one ball then, or before the other first
def test_objects_that_come_out_of_hiding_in_a_renewed_frame_keep_their_own_echoes(place):
    """Each has what its selection takes, though its records have other families, or have them in another order."""
    scene, radar = make_scene(), make_radar()
    scene.add(ep.actors.plate(0.3, 0.3), name="screen", material="metal", position=(3, place + 0.25, 0), yaw=np.pi,
              motion=ep.LinearMotion((0, -0.5 / radar.frame_duration, 0)))
    frame = ep.simulate(scene, radar, num_rays=1500, guard=False, retrace="always", keyframes=4)
    labels = ep.spectrogram(frame, window_length=32, labels=True).labels["objects"]
    for name in (*SPEEDS, "screen"):
        alone = ep.spectrogram(frame, part=name, window_length=32).power
        assert labels.power[labels.part_names.index(name)] == pytest.approx(alone, rel=1e-6, abs=1e-9 * alone.max()), name


def test_ghosts_are_told_apart_as_in_maps():
    frames = frames_of(make_scene(["fast"], wall=True), 2, labels=True)
    labels = ep.spectrogram(frames, window_length=32, labels={"noise": False}, channel=(0, 1)).labels
    assert labels["objects"].part_names == ["fast", "ghosts", "other"]
    names = labels["families"].part_names
    assert names[0] == "fast" and names[-1] == "other" and all("via wall" in name for name in names[1:-1]) and len(names) > 2
    kinds = {(label.object, label.order, label.via) for frame in frames for label in frame.labels["parts"].ghosts}
    assert {name.split(", ")[2].removesuffix(" via wall") for name in names[1:-1]} == {f"order {order}" for _, order, _ in kinds}
    whole = labels["families"].whole
    assert np.array_equal(whole, labels["objects"].whole)
    ghosts = labels["objects"].power[1]
    assert ghosts.max() > 1e-6 * whole.max()


@pytest.mark.parametrize("retrace", ["never", "invalid"])
def test_ghosts_that_no_cell_shows_are_other_and_leave_all_labels_as_they_are(monkeypatch, retrace):
    frames = frames_of(make_scene(["fast"], wall=True), 2, retrace=retrace)
    some = ep.spectrogram(frames, window_length=32, labels=True).labels
    monkeypatch.setattr(views, "FAINT", 0.0)
    every = ep.spectrogram(frames, window_length=32, labels=True).labels
    assert 2 < len(some["families"].part_names) < len(every["families"].part_names)
    assert some["objects"].part_names == every["objects"].part_names
    for view, labels in some.items():
        other = every[view]
        assert np.array_equal(labels.mask, other.mask) and labels.mask.any()
        names, others = (np.array(one.part_names)[one.dominant[labels.mask]] for one in (labels, other))
        assert np.array_equal(names, others)
    assert np.allclose(some["objects"].power, every["objects"].power, rtol=1e-9, atol=1e-12 * some["objects"].power.max())


def test_what_comes_later_has_no_power_before():
    frames = frames_of(make_scene(["slow"]), 2) + frames_of(make_scene(), 2, first=2)
    labels = ep.spectrogram(frames, window_length=64, hop=64, labels=True, span_frames=False).labels["objects"]
    assert labels.part_names == ["slow", "fast", "ghosts", "other"] and labels.power.shape[1] == 4
    power = labels.power.max(axis=2)
    assert np.all(power[1, :2] == 0.0) and np.all(power[1, 2:] > 1e-3 * power[0, 2:])


def test_settings_are_those_of_maps_and_results_travel(frames, found):
    few = ep.spectrogram(frames, window_length=32, hop=16, labels={"objects": {"ball": "fast"}, "noise_margin_db": 20.0,
                                                                    "dynamic_range_db": 6.0}).labels["objects"]
    assert few.part_names[0] == "ball" and (few.noise_margin_db, few.dynamic_range_db) == (20.0, 6.0)
    assert 0 < few.mask.sum() < found.labels["objects"].mask.sum()
    assert ep.spectrogram(frames, labels={"noise": False}).labels["parts"].above_noise.all()
    assert pickle.loads(pickle.dumps(found)) == found and ep.spectrogram(frames).labels is None
    assert found.labels["objects"].plot().get_xlabel() == "Time in s"


def test_what_they_cannot_tell_is_refused_by_name(frames):
    with pytest.raises(TypeError, match="^labels: must be None for cubes"):
        ep.spectrogram([frame.cube for frame in frames], frames[0].radar, labels=True)
    with pytest.raises(ValueError, match="^part: must be None with labels"):
        ep.spectrogram(frames, part="slow", labels=True)
    with pytest.raises(ValueError, match="^labels.plane: must be 'range_doppler'"):
        ep.spectrogram(frames, labels={"plane": "range_azimuth"})
    with pytest.raises(TypeError, match="^labels: unknown keyword 'margin'"):
        ep.spectrogram(frames, labels={"margin": 3.0})
    for name in ("other", "ghosts", "rain"):  # an object of the name of another part would not be there
        with pytest.raises(ValueError, match="^labels.objects: must be {another name: glob} for objects whose names other parts"):
            ep.spectrogram(frames, labels={"objects": {name: "fast"}})
    with pytest.raises(ValueError, match="^labels: must be None for frames whose partitions are called"):
        ep.spectrogram(frames_of(make_scene(), 1, parts={"objects": {"goes": "T 'fast' R"}}), labels=True)
