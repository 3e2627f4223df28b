"""Maps over time as pictures: where their colours begin, and what frames and the gaps between them look like."""
import matplotlib
import numpy as np
import pytest

import echopath as ep

matplotlib.use("Agg")


@pytest.mark.parametrize("noise_dbm", [-110.0, -90.0])
def test_maps_over_time_that_are_full_of_echoes_begin_at_the_noise(noise_dbm):
    """Half of the cells at -80 dBm, the others at -100 dBm: none of them tells how strong the noise is."""
    power = np.full((4, 8), 1e-11)
    power[:, ::2] = 1e-13
    noise = 10.0 ** (0.1 * noise_dbm - 3.0)
    full = ep.AngleTime(times=np.arange(4.0), power=power, noise_power=noise, window="hann", zero_pad=1,
                        azimuth=np.linspace(-1.0, 1.0, 8), combine="sum", velocity_gate=(-1.0, 1.0), range_gate=(0.0, 10.0))
    low, high = full.plot().collections[0].get_clim()
    assert high == -80.0 and low == max(-150.0, min(noise_dbm + 5.0, high - 10.0))


def test_a_spectrogram_shows_wide_cells_whole():
    """One echo in a cell of 5 m/s, ten times the margin in m/s."""
    power = np.full((4, 16), 1e-15)
    power[:, 8] = 1e-11
    found = ep.Spectrogram(times=np.arange(4.0), power=power, noise_power=1e-15, window="hann", zero_pad=1,
                           velocity=5.0 * (np.arange(16) - 8), train=np.zeros(4, np.int32), trains=np.array([[-0.5, 3.5]]),
                           window_length=16, hop=4, range_gate=(0.0, 10.0))
    assert found.plot().get_ylim() == pytest.approx((-7.5, 7.5))  # its cell and one on either side


def spectrogram_of_frames(starts, duration: float) -> ep.Spectrogram:
    """One window in each frame, whose only echo is the stronger the later it is."""
    power = np.full((len(starts), 8), 1e-15)
    power[:, 4] = np.geomspace(1e-13, 1e-11, len(starts))
    return ep.Spectrogram(times=starts + duration / 2.0, power=power, noise_power=1e-15, window="hann", zero_pad=1,
                          velocity=np.arange(8.0) - 4.0, train=np.arange(len(starts), dtype=np.int32),
                          trains=np.stack([starts, starts + duration], axis=1), window_length=64, hop=16, range_gate=(0.0, 10.0))


def level_at(mesh, time: float) -> float:
    """Colour value of a picture over time at a time and 0 m/s, NaN where it is blank."""
    across, up = mesh.get_coordinates()[0, :, 0], mesh.get_coordinates()[:, 0, 1]
    column, row = np.searchsorted(across, time) - 1, np.searchsorted(up, 0.0) - 1
    return float(np.ma.filled(mesh.get_array().astype(float), np.nan)[row, column])


def test_a_spectrogram_of_short_frames_shows_each_of_them():
    """Two films of 200 frames of 6.4 ms, 20 a second: a frame is a third of a pixel wide. Between the films nothing was heard."""
    starts = np.concatenate([0.05 * np.arange(200), 30.0 + 0.05 * np.arange(200)])
    found = spectrogram_of_frames(starts, 6.4e-3)
    mesh, = [one for one in found.plot().collections if one.get_array() is not None]
    level = 10.0 * np.log10(found.power[:, 4]) + 30.0
    for later in (0.001, 0.025, 0.049):
        assert [level_at(mesh, start + later) for start in starts] == pytest.approx(level)
    assert all(np.isnan(level_at(mesh, time)) for time in (10.01, 20.0, 29.99))
    labels = ep.spectrogram_labels({"echo": found}, found)
    assert not any(np.isnan(level_at(mesh, 12.34 - 10.0)) for mesh in labels.plot().collections if mesh.get_array() is not None)


def test_a_spectrogram_leaves_gaps_between_long_frames_blank():
    starts = 0.5 * np.arange(6)
    mesh, = [one for one in spectrogram_of_frames(starts, 0.2).plot().collections if one.get_array() is not None]
    assert not any(np.isnan(level_at(mesh, start + 0.1)) for start in starts)
    assert all(np.isnan(level_at(mesh, start + 0.3)) for start in starts[:-1])


@pytest.mark.parametrize("columns", [1, 3])
def test_ranges_and_azimuths_over_time_leave_gaps_between_frames_blank(columns):
    """Two drives of eight frames of 20 ms, and one frame that is lost: nobody knows what was there between them."""
    starts = np.concatenate([0.02 * np.delete(np.arange(8), 3), 0.3 + 0.02 * np.arange(8)])
    times = (starts[:, None] + 1e-3 * np.arange(columns)).ravel()  # of columns within 3 ms of a frame
    power = np.tile(np.geomspace(1e-13, 1e-11, len(times))[:, None], 8)
    common = {"times": times, "power": power, "noise_power": 1e-15, "window": "hann", "zero_pad": 1, "combine": "sum",
              "velocity_gate": (-1.0, 1.0)}
    for found in (ep.RangeTime(range=np.arange(8.0) - 4.0, **common),
                  ep.AngleTime(azimuth=np.radians(np.arange(8.0) - 4.0), range_gate=(0.0, 10.0), **common)):
        mesh, = [one for one in found.plot().collections if one.get_array() is not None]
        shown = [level_at(mesh, time) for time in times]
        assert shown == pytest.approx(10.0 * np.log10(power[:, 0]) + 30.0)
        assert all(np.isnan(level_at(mesh, time)) for time in (0.0635, 0.2, 0.285))
