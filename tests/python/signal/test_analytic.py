"""Real samples as complex ones, and what comes before a chirp, against tones that are known at all times."""
import numpy as np
import pytest

import echopath as ep
from echopath.base.numerics.analytic import analytic, as_samples, turned
from echopath.base.numerics.past import models_of, past_of

ROUNDING = 1e-12
REAL, COMPLEX = (ep.ChirpSequence(real=real) for real in (True, False))
FORETOLD = 1e-5  # of a tone's amplitude: what the least rest of a model makes of it over a chirp


def tones(frequencies, samples):
    """Sum of tones of amplitude 1 [1, 1, 1, N], frequencies in turns a sample, at samples [N] of any sign."""
    return sum(np.exp(2j * np.pi * frequency * np.asarray(samples)) for frequency in frequencies)[None, None, None]


@pytest.mark.parametrize("count", [16, 17])
def test_real_samples_are_the_real_part_of_positive_frequencies(count):
    samples = np.random.default_rng(count).normal(size=(1, 2, 3, count)) + 0j
    found = analytic(samples, REAL)
    assert as_samples(found, True) == pytest.approx(samples, abs=ROUNDING)
    assert np.abs(np.fft.fft(found)[..., count // 2 + 1:]).max() < ROUNDING * count
    assert analytic(samples, COMPLEX) is samples


def test_a_tone_has_the_power_of_its_real_samples():
    tone = tones([3 / 16], range(16))
    assert analytic(np.sqrt(2.0) * tone.real + 0j, REAL) == pytest.approx(tone, abs=ROUNDING)


@pytest.mark.parametrize("waveform", [REAL, REAL.replace(bandwidth=-1e9)], ids=["rising", "falling"])
@pytest.mark.parametrize("frequency", [0.1, 0.173, 0.31])
def test_a_phase_turns_tones_between_the_cells_up_to_the_ends_of_a_chirp(frequency, waveform):
    """Those of chirps that fall have negative frequencies."""
    tone, turn = tones([-frequency if waveform.falls else frequency], range(64)), np.exp(0.7j)
    real = np.sqrt(2.0) * tone.real + 0j
    expected = np.sqrt(2.0) * (tone * turn).real
    assert np.abs(turned(real, np.full((1, 1, 1, 1), turn), waveform) - expected).max() < 0.01
    part = 0.3 * real
    of_part = turned(part, np.array(turn), waveform, whole=real)
    assert of_part == pytest.approx(0.3 * turned(real, np.array(turn), waveform), abs=ROUNDING)
    assert turned(real, np.array(2.0), waveform) == pytest.approx(2.0 * real, abs=0.0)


@pytest.mark.parametrize("frequencies, most", [((0.113,), FORETOLD), ((0.11, -0.27), 0.2)])
@pytest.mark.parametrize("past", [40, 301])
def test_what_came_before_a_chirp_of_tones_is_these_tones(past, frequencies, most):
    """The second half is the past of its begin alone, and the first sample goes on from the end; several tones keep nearly their
    frequencies."""
    chirp = tones(frequencies, range(64))
    found = past_of(chirp.reshape(1, -1), models_of(chirp), past)
    expected = tones(frequencies, range(-past, 0)).reshape(1, -1)
    late = slice(past // 2, None)
    assert found.shape == expected.shape and np.abs(found - expected)[:, late].max() < most
    after = tones(frequencies, range(64, 65)).item()
    assert abs(found[0, 0] - after) < 0.01


def test_parts_have_pasts_that_add_up_by_the_model_of_the_whole():
    random = np.random.default_rng(1)
    parts = random.normal(size=(2, 1, 1, 3, 32)) + 1j * random.normal(size=(2, 1, 1, 3, 32))
    model = models_of(parts.sum(axis=0))
    of_parts = sum(past_of(part.reshape(3, 32), model, 50) for part in parts)
    whole = past_of(parts.sum(axis=0).reshape(3, 32), model, 50)
    assert of_parts == pytest.approx(whole, abs=1e-10 * np.abs(whole).max())
