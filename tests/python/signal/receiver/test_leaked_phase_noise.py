"""Phase noise of what transmitters leak into receivers, against the range correlation, over the whole band."""

import numpy as np
import pytest

import echopath as ep
from support.signals.received_tones import COUNT, LEVEL, RATE, db, one_channel

SLOPE = 1e9 * RATE / COUNT
ROUNDING = 1e-8  # relative: -250 dBc/Hz over 20 MHz turn the leakage by 2e-9 rad
DELAY = 4.7e-9  # no whole number of cycles in a chirp
BAND, EDGE = COUNT // 16, 14 * COUNT // 16  # cells; the filter before the converter cuts at 15/16


def leaked(num_chirps, phase_noise, delay=DELAY, **waveform):
    """What leaks at -40 dB of 1 W, with phase noise of one level in dBc/Hz or None: [chirp, sample]."""
    noise = None if phase_noise is None else ep.PhaseNoise(offsets=[1e4, 1e7], levels=[phase_noise, phase_noise])
    radar = one_channel(num_chirps, receiver=ep.Receiver(leakage_db=[[-40.0]], leakage_delay=delay, phase_noise=noise),
                        transmit_power=1.0, noise_figure_db=0.0, **waveform)
    silent = np.zeros((1, 1, num_chirps, COUNT))
    return (ep.receive(silent, radar, seed=1).cube - ep.receive(silent, radar.replace(receiver=None), seed=1).cube)[0, 0]


@pytest.mark.parametrize("waveform", [{}, {"real": True}, {"bandwidth_steps": [0.0, 2e8]}])
@pytest.mark.parametrize("delay", [0.3e-9, DELAY])
def test_phase_noise_that_vanishes_leaves_the_leakage_as_it_is(waveform, delay):
    plain, noisy = (leaked(4, level, delay, **waveform) for level in (None, -250.0))
    np.testing.assert_allclose(noisy, plain, rtol=0.0, atol=ROUNDING * np.abs(plain).max())


def test_phase_noise_lies_at_the_velocities_of_its_offsets():
    """In the map of an echo at rest, 500 frames long, against the integral of L(f) 4 sin^2(pi f d) over the response of a cell.

    Noise that each chirp had for itself was 1.1 dB low at the highest velocities in the echo's range.
    """
    count, chirps, interval, cell = 64, 16, 10e-6, 15
    masks = [1e3, 1e4, 1e5, 1e6, 1e7], [-70, -85, -105, -115, -135]
    waveform = ep.ChirpSequence(start_frequency=76.5e9, bandwidth=1e9, num_samples=count, sampling_rate=RATE / 2,
                                num_chirps=chirps, chirp_interval=interval)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna()], receivers=[ep.Antenna()], noise_figure_db=0.0,
                     receiver=ep.Receiver(phase_noise=ep.PhaseNoise(offsets=masks[0], levels=masks[1])))
    echo = np.broadcast_to(np.exp(2j * np.pi * cell * np.arange(count) / count), (1, 1, chirps, count))
    maps = [np.fft.fft2(ep.receive(echo, radar, seed=seed).cube[0, 0]) / (count * chirps) for seed in range(500)]
    power = np.mean(np.abs(maps) ** 2, axis=0)
    offset = np.linspace(-5e6, 5e6, 1_000_001) + 0.1
    delay = cell * waveform.sampling_rate / count / waveform.slope
    density = 10 ** (0.1 * np.interp(np.log10(np.maximum(np.abs(offset), 1e3)), np.log10(masks[0]), masks[1]))
    density *= 4.0 * np.sin(np.pi * offset * delay) ** 2

    def response(cycles, terms):
        return (np.sin(np.pi * terms * cycles) / (terms * np.sin(np.pi * cycles))) ** 2

    for distance, velocities in ((0, (1, 2)), (0, (6, 7)), (1, (1, 2)), (1, (6, 7))):
        measured = [power[side * velocity, cell + side * distance] for velocity in velocities for side in (-1, 1)]
        wanted = [np.trapezoid(density * response(offset / waveform.sampling_rate - distance / count, count)
                               * response(offset * interval - velocity / chirps, chirps), offset) for velocity in velocities]
        assert db(np.mean(measured) / np.mean(wanted)) == pytest.approx(0.0, abs=0.5), (distance, velocities)


def test_frames_too_long_for_phase_noise_are_refused():
    """One sample a chirp and a thousand chirps of a millisecond had taken all memory."""
    waveform = ep.ChirpSequence(num_samples=1, sampling_rate=10e6, num_chirps=1000, chirp_interval=1e-3)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna()], receivers=[ep.Antenna()],
                     receiver=ep.Receiver(phase_noise=ep.PhaseNoise(offsets=[1e4], levels=[-90])))
    with pytest.raises(ValueError, match="^receiver.phase_noise: must have frames of at most 0"):
        ep.receive(np.ones((1, 1, 1000, 1)), radar, seed=1)


def test_leakage_has_no_line_at_the_edge_of_the_band():
    """L(f) 4 sin^2(pi f d) at every range up to the edge, sixteenths of the band each over 400 chirps, and less beyond."""
    steady = leaked(400, -130.0) * np.exp(-2j * np.pi * SLOPE * DELAY * np.arange(COUNT) / RATE)
    window = np.sin(np.pi * np.arange(COUNT) / COUNT) ** 2
    density = np.mean(np.abs(np.fft.fft(steady * window)) ** 2, axis=0) / (RATE * np.sum(window ** 2))
    wanted = 1e-4 * 1e-13 * 4.0 * np.sin(np.pi * np.arange(COUNT) * RATE / COUNT * DELAY) ** 2
    for begin in range(BAND, EDGE, BAND):
        cells = slice(begin, begin + BAND)
        assert db(density[cells].mean() / wanted[cells].mean()) == pytest.approx(0.0, abs=LEVEL)
    beyond = slice(EDGE, COUNT - 4)  # the window spreads the leakage itself over the last ones
    assert np.all(density[beyond] < 1.5 * wanted[beyond])
