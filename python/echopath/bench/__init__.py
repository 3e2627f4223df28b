"""Benchmarks: `run_physics(folder)` of levels against closed forms, `run_replay(folder)` of replay against new traces,
`run_labels(folder)` of parts and path expressions, `hard.run_hard(folder)` of the hard cases, `run_speed(folder)` of
synthesis, frames and memory, `run_crowd(folder)` of the objects of crowded scenes, `run_certificate(folder)` of what moves,
`run_published(folder)` of levels beside published ones, `run_actors(folder)` of the actors over aspect,
`run_measured(folder)` of metal targets beside measurements, `run_worlds(folder)` of cities and crowds, `run_live(folder)` of
scenes that change and go on in time, `run_receiver(folder)` of the faults of receivers and the codes of transmitters,
`run_dataset(folder)` of datasets, their stages and workers."""
from .actors import run_actors
from .certificate import run_certificate
from .crowd import run_crowd
from .dataset import run_dataset
from .labels import run_labels
from .live import run_live
from .measured import run_measured
from .physics import run_physics
from .published import run_published
from .receiver import run_receiver
from .replay import run_replay
from .speed import run_speed
from .worlds import run_worlds

__all__ = ["run_actors", "run_certificate", "run_crowd", "run_dataset", "run_labels", "run_live", "run_measured", "run_physics",
           "run_published", "run_receiver", "run_replay", "run_speed", "run_worlds"]
