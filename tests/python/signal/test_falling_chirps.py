"""Falling chirps, as of triangular modulation, from rising ones of a scene that runs backwards (page of the limits)."""
import numpy as np
import pytest

import echopath as ep

START, SPEED = 20.0, -3.0  # m, m/s: of a metal plane before the radar
CHIRPS = ep.ChirpSequence(start_frequency=24e9, bandwidth=250e6, num_samples=64, sampling_rate=0.5e6, num_chirps=5,
                          chirp_interval=0.3e-3)
# rad: beat signals of moving echoes have one frequency over a chirp
PHASE_TOLERANCE = 2.0 * np.pi * CHIRPS.slope * 2.0 * abs(SPEED) / ep.speed_of_light * (
    CHIRPS.num_samples / CHIRPS.sampling_rate / 2.0) ** 2


def test_a_falling_chirp_is_a_rising_one_of_a_scene_that_runs_backwards():
    last = (CHIRPS.num_chirps - 1) * CHIRPS.chirp_interval + (CHIRPS.num_samples - 1) / CHIRPS.sampling_rate  # s
    scene = ep.Scene()
    scene.add(ep.actors.plate(30.0, 30.0), name="plane", material="metal", position=(START + SPEED * last, 0, 0),
              motion=ep.LinearMotion(velocity=(-SPEED, 0, 0)))
    radar = ep.Radar(CHIRPS, transmitters=[ep.Antenna()], receivers=[ep.Antenna()])
    paths = ep.trace(scene, radar, num_rays=20_000, max_bounces=1)
    falling = ep.synthesize(paths, radar)[0, 0, ::-1, ::-1]

    chirp, sample = np.meshgrid(np.arange(CHIRPS.num_chirps), np.arange(CHIRPS.num_samples), indexing="ij")
    time = sample / CHIRPS.sampling_rate                                                      # s, in the chirp
    delay = 2.0 * (START + SPEED * (chirp * CHIRPS.chirp_interval + time)) / ep.speed_of_light
    top = CHIRPS.start_frequency + CHIRPS.slope * time.max()
    sent_over_received = 2.0 * np.pi * (top * delay - CHIRPS.slope * (time * delay - delay**2 / 2.0))
    residual = 2.0 * np.pi * CHIRPS.slope * delay**2
    turn = np.angle(falling * np.exp(-1j * (sent_over_received - residual)))
    assert np.pi - np.abs(turn) == pytest.approx(np.zeros(turn.shape), abs=PHASE_TOLERANCE)  # metal turns the field round
    assert np.abs(falling) == pytest.approx(np.full(falling.shape, np.abs(falling).mean()), rel=1e-3)
    assert residual.min() > 100 * PHASE_TOLERANCE
