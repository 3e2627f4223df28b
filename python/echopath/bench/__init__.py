"""Benchmarks: `run_physics(folder)` of levels against closed forms, `run_replay(folder)` of replay against new traces."""
from .physics import run_physics
from .replay import run_replay

__all__ = ["run_physics", "run_replay"]
