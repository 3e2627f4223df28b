"""Frames in time: places, times, bits, and where what moves is in each."""
import gc
import inspect
import pickle
import warnings
import weakref

import numpy as np
import pytest

import echopath as ep
from support.frames_in_time import DISTANCE, INTERVAL, SETTINGS, SPEED, make_radar, make_scene, make_sequence, signal_of

# m: a fortieth of a cell of 0.3 m, to which the parabola through the peak of a Hann window is exact.
RANGE_TOLERANCE = 0.008
# Of the correlation of N independent circular Gaussian samples, whose rms is 1 / sqrt(N).
MOST_CORRELATION = 5.0 / np.sqrt(64 * 32)


@pytest.fixture(scope="module")
def in_order() -> list[bytes]:
    return [signal_of(frame) for frame in make_sequence()]


def test_frames_alone_have_the_bits_of_those_in_order(in_order):
    sequence = make_sequence()
    assert [signal_of(sequence[place]) for place in (2, 0, -1, 1)] == [in_order[place] for place in (2, 0, 3, 1)]


def test_frames_in_reverse_have_the_bits_of_those_in_order(in_order):
    assert [signal_of(frame) for frame in reversed(make_sequence())] == in_order[::-1]
    assert [signal_of(frame) for frame in make_sequence()[::-1]] == in_order[::-1]


def test_slices_have_the_bits_and_times_of_the_whole(in_order):
    sequence = make_sequence()
    part = sequence[1:][::2]
    assert len(part) == 2 and part.times.tolist() == sequence.times[1::2].tolist()
    assert part.interval == 2 * INTERVAL
    assert [signal_of(frame) for frame in part] == in_order[1::2]


def test_a_frame_is_that_of_simulate_at_its_time(in_order):
    alone = ep.simulate(make_scene(), make_radar(), start_time=2 * INTERVAL, scatterers="surface", **SETTINGS)
    assert signal_of(alone) == in_order[2]


def test_a_pickled_sequence_gives_the_same_bits(in_order):
    travelled = pickle.loads(pickle.dumps(make_sequence()[1:]))
    assert signal_of(travelled[0]) == in_order[1] and travelled.times[0] == INTERVAL


def test_later_changes_of_the_scene_do_not_matter(in_order):
    scene = make_scene()
    sequence = ep.Sequence(scene, make_radar(), frames=2, interval=INTERVAL, **SETTINGS)
    scene["plate"].position = (4.0, 0.0, 0.0)
    sequence.scene["plate"].visible = False
    assert signal_of(sequence[1]) == in_order[1]


@pytest.mark.parametrize("kind", [np.array, list])
def test_later_changes_of_the_arguments_do_not_matter(kind):
    azimuth, objects, parts = kind([-0.2, 0.1]), ["plate"], {"plate": "T 'plate' R"}
    receivers = [ep.Antenna((0.0, k * 0.002, 0.0)) for k in range(4)]
    sequence = ep.Sequence(make_scene(), make_radar().replace(receivers=receivers), frames=1, interval=INTERVAL, **SETTINGS | {
        "parts": parts, "labels": {"objects": objects}, "angles": {"azimuth": azimuth}})
    azimuth[1], objects[0], parts["plate"] = 0.4, "nobody", "T 'nobody' R"
    assert sequence[0].azimuth.tolist() == [-0.2, 0.1]
    assert [label.name for label in sequence[0].labels["parts"].objects] == ["plate"]
    frame = sequence[0]
    frame.angle_settings["azimuth"], frame.spectrum_settings["zero_pad"] = [0.0, 0.1, 0.2], 2
    assert sequence[0].azimuth.tolist() == [-0.2, 0.1] and sequence[0].spectrum.zero_pad == 1


@pytest.mark.parametrize("scene_speed, radar_speed", [(SPEED, None), (0.0, 5.0), (SPEED, 5.0)])
def test_ranges_follow_the_closed_form(scene_speed, radar_speed):
    """The plate is where distance + (its speed - that of the radar) t puts it at mid-frame."""
    radar = make_radar(speed=radar_speed) if radar_speed else make_radar()
    sequence = ep.Sequence(make_scene(scene_speed), radar, frames=4, interval=INTERVAL, start_time=0.05, **SETTINGS)
    for place, frame in enumerate(sequence):
        middle = 0.05 + place * INTERVAL + 0.5 * radar.frame_duration
        expected = DISTANCE + (scene_speed - (radar_speed or 0.0)) * middle
        strongest = frame.detections.power.argmax()
        assert frame.detections.range[strongest] == pytest.approx(expected, abs=RANGE_TOLERANCE)
        assert frame.detections.object[strongest] == "plate"


def test_objects_keep_their_ids():
    frames = list(make_sequence(frames=2))
    assert [[mesh.name for mesh in frame.scene.meshes] for frame in frames] == [["plate"], ["plate"]]


def test_noise_differs_from_frame_to_frame():
    noises = [(frame.noisy_cube - frame.cube).ravel() for frame in make_sequence(frames=3)]
    for index, noise in enumerate(noises):
        for other in noises[:index]:
            assert abs(np.vdot(noise, other)) < MOST_CORRELATION * np.linalg.norm(noise) * np.linalg.norm(other)


def test_no_frame_is_kept():
    sequence = make_sequence(frames=3)
    seen = []
    for frame in sequence:
        seen.append(weakref.ref(frame))
        del frame
    gc.collect()
    assert [one() for one in seen] == [None] * 3


def test_times_and_lengths():
    sequence = make_sequence(frames=5, start_time=0.3)
    assert len(sequence) == 5 and sequence.times.dtype == np.float64
    assert sequence.times.tolist() == [0.3 + place * INTERVAL for place in range(5)]
    assert repr(sequence) == "Sequence(5 frames from 0.3 to 0.7 s, every 0.1 s)"
    assert "0.3 to 0.7 s" in sequence._repr_html_()
    assert len(sequence[5:]) == 0 and repr(sequence[5:]).startswith("Sequence(0 frames none")
    assert list(sequence[5:]) == []


def test_settings_objects_and_keywords_are_the_same():
    trace, signal = ep.TraceSettings(num_rays=500, start_time=0.2), ep.SignalSettings(window="rect", zero_pad=2)
    one = ep.Sequence(make_scene(), make_radar(), frames=1, interval=INTERVAL, trace=trace, signal=signal)
    other = ep.Sequence(make_scene(), make_radar(), frames=1, interval=INTERVAL, num_rays=500, start_time=0.2, window="rect",
                        zero_pad=2)
    assert one.times.tolist() == [0.2] and np.array_equal(one[0].spectrum.values, other[0].spectrum.values)


def test_an_interval_may_be_the_duration_of_a_frame():
    radar = make_radar()
    # 31 chirp intervals of 50 us and 63 sampling intervals of 0.1 us
    durations = [radar.frame_duration, np.nextafter(radar.frame_duration, 0.0)]
    assert [len(ep.Sequence(make_scene(), radar, frames=2, interval=interval)) for interval in durations] == [2, 2]
    with pytest.raises(ValueError, match=r"^interval: must be at least 0\.0015563 s, the duration of a frame, got 0\.001$"):
        ep.Sequence(make_scene(), radar, frames=2, interval=0.001)


def test_motions_that_end_too_early_are_refused_before_the_work():
    scene = ep.Scene()
    motion = ep.KeyframeMotion([0.0, 1.0], [[0, 0, 0], [1, 0, 0]])
    scene.add(ep.actors.plate(1.0, 1.0), name="plate", material="metal", position=(5.0, 0.0, 0.0), motion=motion)
    assert len(ep.Sequence(scene, make_radar(), frames=9, interval=INTERVAL)) == 9
    with pytest.raises(ValueError, match="^frames: must all lie within the motions, got 11 frames every 0.1 s: .*node plate"):
        ep.Sequence(scene, make_radar(), frames=11, interval=INTERVAL)
    with pytest.raises(ValueError, match="^frames: .*1"):
        ep.Sequence(make_scene(), make_radar(motion=motion), frames=11, interval=INTERVAL)


@pytest.mark.parametrize("place, error", [(4, IndexError), (-5, IndexError), (True, TypeError), (1.0, TypeError),
                                          ("a", TypeError), (None, TypeError)])
def test_wrong_places_are_refused_by_name(place, error):
    with pytest.raises(error, match="^frame: must be"):
        make_sequence()[place]


def test_unknown_keywords_are_refused_with_the_nearest():
    with pytest.raises(TypeError, match="^Sequence: unknown keyword 'frame', the nearest right one is 'frames'"):
        ep.Sequence(make_scene(), make_radar(), frame=3, interval=INTERVAL)
    with pytest.raises(TypeError, match="^interval: must be in s .* got None"):
        ep.Sequence(make_scene(), make_radar(), frames=3)


def test_every_keyword_of_simulate_is_one_of_a_sequence():
    known, simulated = inspect.signature(ep.Sequence).parameters, inspect.signature(ep.simulate).parameters
    assert set(simulated) - set(known) == {"progress"}
    assert all(known[name].default == simulated[name].default for name in set(simulated) - {"progress"})


def test_why_nothing_is_heard_is_told_once():
    """A ball that goes away beyond the last range, met by other numbers of rays in some frames."""
    scene = ep.Scene()
    scene.add(ep.actors.sphere(1.0), name="ball", material="metal", position=(50.0, 0.0, 1.0),
              motion=ep.LinearMotion(velocity=(10.0, 30.0, 0.0)))
    radar = ep.Radar(ep.ChirpSequence(num_samples=256, num_chirps=8), transmitters=[ep.Antenna()], position=(0, 0, 1),
                     receivers=[ep.Antenna((0, 0.01, 0))])
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        numbers = {frame.paths.num_paths for frame in ep.Sequence(scene, radar, frames=3, interval=1.0, num_rays=2000)}
    told = [str(one.message) for one in said if "no signal of" in str(one.message)]
    assert len(numbers) > 1 and len(told) == 1 and "beyond the last range" in told[0]
