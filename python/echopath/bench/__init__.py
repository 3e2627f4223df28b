"""Benchmarks against closed forms: `run_physics(folder)`."""
from .physics import run_physics

__all__ = ["run_physics"]
