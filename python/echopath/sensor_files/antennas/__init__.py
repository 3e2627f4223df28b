"""Antenna patterns in files: tables over two angles, as of field solvers, and pairs of cuts, as of antenna makers."""
from .load import load_antenna

__all__ = ["load_antenna"]
