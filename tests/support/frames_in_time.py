"""A small scene in which something moves, and sequences of it."""
from __future__ import annotations

import numpy as np

import echopath as ep

SPEED, INTERVAL, DISTANCE = 3.0, 0.1, 9.0  # m/s away from the radar, s, m at time 0
SETTINGS = {"num_rays": 500, "guard": False, "labels": True, "detections": True, "parts": {"plate": "T 'plate' R"}}


def make_radar(**keywords) -> ep.Radar:
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=0.5e9, num_samples=64, sampling_rate=10e6, num_chirps=32,
                                chirp_interval=50e-6)
    return ep.Radar(waveform, transmitters=[ep.Antenna()], receivers=[ep.Antenna()], **keywords)


def make_scene(speed: float = SPEED) -> ep.Scene:
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.5, 0.5), name="plate", material="metal", position=(DISTANCE, 0.0, 0.0),
              motion=ep.LinearMotion((speed, 0.0, 0.0)))
    return scene


def make_sequence(frames: int = 4, **keywords) -> ep.Sequence:
    return ep.Sequence(make_scene(), make_radar(), **{"frames": frames, "interval": INTERVAL} | SETTINGS | keywords)


def make_walk(frames: int) -> ep.Sequence:
    """A walking person, whose surfaces are rough, with labels and truth: frames that follow each other without a gap."""
    scene, radar = ep.Scene(), make_radar(transmit_power=10.0)
    scene.add(ep.actors.pedestrian(speed=1.4, duration=1.0), name="walker", position=(5.0, 0.5, -1.0), yaw=np.pi)
    return ep.Sequence(scene, radar, frames=frames, interval=radar.waveform.num_chirps * radar.waveform.chirp_interval,
                       start_time=0.2, num_rays=2000, guard=False, labels=True, detections=True, truth=True)


def signal_of(frame: ep.Frame) -> bytes:
    """All bits of the noisy signal, the map, the labels and the hits of a frame."""
    labels = frame.labels["parts"]
    arrays = (frame.noisy_cube, frame.spectrum.values, labels.power, labels.dominant, labels.object_map, frame.paths.u,
              frame.paths.weight, frame.detections.power)
    return b"".join(np.ascontiguousarray(array).tobytes() for array in arrays)


# Of a process that writes frames: as `progress`, it kills the process while the third is made or written.
KILL_SOON = """
import os, signal, threading

def kill_soon(stage, fraction):
    done.append(fraction)
    if len(done) == 2:
        threading.Timer(0.01, os.kill, (os.getpid(), signal.SIGKILL)).start()
    if len(done) == 4:
        os.kill(os.getpid(), signal.SIGKILL)

done = []
"""
