"""Labels of echoes that stand far below what leaks into the receivers or what other radars send."""
import numpy as np
import pytest

import echopath as ep
from echopath.in_time import sliding
from support.scenes.small_spheres import TARGETS, radar_with, scene_of

LEAKY = {"leakage_db": np.full((1, 8), -20.0), "leakage_delay": 0.3e-9}
MOVES = 1.5  # m/s, beyond which the window leaves nothing of the leakage, which is at rest


@pytest.fixture(scope="module")
def frames():
    """(without faults, with leakage 60 dB and more above all echoes)"""
    return [frame_of(radar) for radar in radars()]


def radars():
    """(without faults, with leakage)"""
    plain = radar_with()
    return plain, plain.replace(receiver=ep.Receiver(**LEAKY))


def frame_of(radar, start_time=0.0):
    return ep.simulate(scene_of(TARGETS), radar, num_rays=6000, max_bounces=1, labels=True, noise_seed=None,
                       start_time=start_time)


def test_the_dynamic_range_counts_from_the_echoes(frames):
    """What leaks is added to the rest: among the velocities where it has nothing, objects have the cells that they have without
    it."""
    clean, leaky = (frame.labels["parts"] for frame in frames)
    assert leaky.whole.max() > 1e6 * clean.whole.max()
    assert [label.status for label in leaky.objects] == ["seen"] * len(TARGETS)
    moves = np.abs(leaky.velocity) > MOVES
    assert np.any(clean.object_map[moves] >= 0)
    np.testing.assert_array_equal(leaky.mask[moves], clean.mask[moves])
    np.testing.assert_array_equal(leaky.object_map[moves], clean.object_map[moves])
    assert leaky.part_names[leaky.dominant[32, 0]] == "leakage"


def test_frames_are_labelled_alike_later_on(frames):
    again = ep.annotate_frame(frames[1])["parts"]
    assert again == frames[1].labels["parts"]


def test_spectrograms_count_from_the_echoes_too(frames):
    clean, leaky = (ep.spectrogram([frame], labels=True).labels["objects"] for frame in frames)
    moves = np.abs(clean.velocity) > MOVES
    assert clean.mask[:, moves].any()
    assert np.all(leaky.mask[:, moves] >= clean.mask[:, moves])


@pytest.mark.parametrize("places", [(0, 0), (0, 1), (1, 0)], ids=["never", "later", "first"])
def test_spectrograms_transform_echoes_by_themselves_only_beside_something(monkeypatch, places):
    """The mask goes down from the strongest cell of the echoes of all frames; without leakage the whole is these echoes."""
    made, copy_of = [], sliding.Stft.copy
    monkeypatch.setattr(sliding.Stft, "copy", lambda self: made.append(copy_of(self)) or made[-1])
    both = radars()
    length = both[0].waveform.num_chirps * both[0].num_slots * both[0].waveform.mean_interval
    row = [frame_of(both[place], number * length) for number, place in enumerate(places)]
    settings = {"window_length": 32, "hop": 32}
    labels = ep.spectrogram(row, labels={"dynamic_range_db": 40.0}, **settings).labels["objects"]
    echoes = ep.spectrogram([frame.cube for frame in row], both[0], start_times=[0.0, length], **settings).power
    assert echoes.shape == labels.whole.shape and len(made) == (1 in places)
    wanted = (labels.whole > labels.noise_floor) & (labels.whole >= 1e-4 * echoes.max())
    np.testing.assert_array_equal(labels.mask, wanted)
