"""Faults whose closed form is no level of a tone: shifts, gains, extents in time; and other radars."""
from __future__ import annotations

import warnings
from collections.abc import Iterator

import numpy as np

import echopath as ep

from .faults import CELL, COUNT, RATE, SLOPE, tone

LIMIT = 0.01  # relative


def rows(*, quick: bool) -> list[dict]:
    """[what, unit, closed form, measured, relative error, whether it holds] of each; quick: nothing, all of them are small."""
    return [{"what": what, "unit": unit, "form": float(form), "measured": float(measured),
             "error": float(measured / form - 1.0), "holds": bool(abs(measured / form - 1.0) <= LIMIT)}
            for what, unit, form, measured in _measured()]


def describe(rows: list[dict]) -> list[str]:
    """Lines for people."""
    lines = [f"{'fault':<46}{'closed form':>14}{'measured':>14}{'error':>9}"]
    return lines + [f"{row['what'] + ', ' + row['unit']:<46}{row['form']:14.6g}{row['measured']:14.6g}"
                    f"{100 * row['error']:8.3f}%  {'holds' if row['holds'] else 'MISSED'}" for row in rows]


def _measured() -> Iterator[tuple[str, str, float, float]]:
    yield from _oscillator()
    yield from _channels()
    yield from _converter()
    for ratio in (0.9, 1.1):
        yield from _crossing(ratio)
    yield from _moving_image()


def _radar(receiver: ep.Receiver | None = None, receivers: int = 1, **settings) -> ep.Radar:
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=SLOPE * COUNT / RATE, num_samples=COUNT, sampling_rate=RATE,
                                num_chirps=4)
    return ep.Radar(waveform, transmitters=[ep.Antenna()], receivers=[ep.Antenna()] * receivers, receiver=receiver, **settings)


def _oscillator():
    """A slope that is off by a thousandth moves a beat frequency by a thousandth of the slope times the delay."""
    cell = 60
    cube = ep.receive(tone(cell), _radar(ep.Receiver(frequency_error=(0.0, 1e-3 * SLOPE))), seed=None).cube[0, 0, 0, 32:-32]
    beat = np.polyfit(np.arange(len(cube)), np.unwrap(np.angle(cube)), 1)[0] * RATE / (2.0 * np.pi)
    yield "slope 0.1 % off at a beat of 2.3 MHz", "Hz", 1e-3 * cell * CELL, beat - cell * CELL


def _channels():
    cube = np.concatenate([tone(50), np.zeros_like(tone(50))], axis=1)
    coupled = ep.receive(cube, _radar(ep.Receiver(coupling_db=[[0.0, -20.0], [0.0, 0.0]]), 2), seed=None).cube
    yield "coupling of -20 dB, field in the other", "sqrt(W)", 0.1, np.abs(coupled[0, 1]).mean()
    drift = ep.Receiver(receiver_gain_db=[1.0], gain_drift_db=[2.0])
    drifted = ep.receive(tone(50), _radar(drift), seed=None, start_time=3.0).cube
    yield "1 dB that drifts by 2 dB/s, after 3 s", "dB", 7.0, 20.0 * np.log10(np.abs(drifted[0, 0, 0]).mean())
    offset = ep.receive(tone(50), _radar(ep.Receiver(dc_offset=(0.3, 0.4))), seed=None).cube
    yield "offsets of 0.3 and 0.4, line at 0 Hz", "sqrt(W)", 0.5, np.abs(offset.mean())


def _converter():
    """A sine clipped at 1/k of its amplitude keeps (2 / pi) (asin 1/k + sqrt(1 - 1/k^2) / k) of it."""
    k = 10.0 ** (10.0 / 20.0)
    adc = ep.Adc(bits=16, full_scale_dbm=0.0, gain_db=0.0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # that it clips is what is measured
        clipped = ep.receive(tone(37, 1e-2), _radar(ep.Receiver(adc=adc)), seed=None).cube
    line = np.abs(np.fft.fft(clipped[0, 0, 0])[37]) / COUNT
    yield "a tone 10 dB over full scale, its line", "sqrt(W)", 0.2 / np.pi * (np.arcsin(1 / k) + np.sqrt(1 - 1 / k**2) / k), line
    adapted = ep.receive(tone(37, 1e-2), _radar(ep.Receiver(adc=adc.replace(automatic_gain=True, gain_step_db=0.0))), seed=None)
    yield "automatic gain of that tone, 6 dB below", "dB", -16.0, adapted.gain_db


def _crossing(ratio: float):
    """Another radar 20 m ahead crosses in the middle of each chirp."""
    distance, power, middle = 20.0, 0.05, 12.8e-6
    start = 77e9 + SLOPE * middle - ratio * SLOPE * (middle - distance / ep.speed_of_light)
    waveform = ep.ChirpSequence(start_frequency=start, bandwidth=ratio * SLOPE * COUNT / RATE, num_samples=COUNT,
                                sampling_rate=RATE, num_chirps=4)
    other = ep.Radar(waveform, transmitters=[ep.Antenna()], receivers=[ep.Antenna()], transmit_power=power,
                     position=(distance, 0.0, 0.0), yaw=np.pi)
    received = np.abs(ep.interference(_radar(), other)[0, 0, 0]) ** 2
    level = power * (ep.speed_of_light / start / (4.0 * np.pi * distance)) ** 2
    heard = np.flatnonzero(received > 0.25 * level)
    yield f"another radar of {ratio:g} times the slope, level", "W", level, received[heard[20:-20]].mean()
    yield f"another radar of {ratio:g} times the slope, extent", "s", RATE / abs((1.0 - ratio) * SLOPE), \
        np.sum(received) / level / RATE


def _moving_image():
    """Another radar of parallel chirps comes nearer at 20 m/s; a conductor 6 m aside brings it from its image 12 m aside."""
    distance, aside, speed = 30.0, 6.0, 20.0
    waveform = _radar().waveform.replace(num_chirps=128, num_samples=128, bandwidth=0.25 * _radar().waveform.bandwidth)
    radar = _radar().replace(waveform=waveform)
    other = radar.replace(position=(distance, 0.0, 0.0), yaw=np.pi, motion=ep.LinearMotion(velocity=(-speed, 0.0, 0.0)))
    scene = ep.Scene(interferers=[ep.Interferer(radar=other, over="paths")])
    scene.add(ep.actors.plate(60.0, 10.0), name="wall", material=ep.Material.metal(mirror=True), yaw=-np.pi / 2,
              position=(0.5 * distance, aside, 0.0))
    cube = ep.simulate(scene, radar, num_rays=2000, max_bounces=1).interference_cube[0, 0, :, 64]
    turned = np.angle(np.sum(cube[1:] * np.conj(cube[:-1])))
    ends = distance - speed * waveform.chirp_interval * np.array([0.0, 127.0])
    form = np.diff(np.hypot(ends, 2.0 * aside))[0] / (127.0 * waveform.chirp_interval)
    turn = 2.0 * np.pi * waveform.centre_frequency / ep.speed_of_light * waveform.chirp_interval
    yield "another radar at 20 m/s over a wall, Doppler", "m/s", form, form + np.angle(np.exp(1j * (turned - turn * form))) / turn
