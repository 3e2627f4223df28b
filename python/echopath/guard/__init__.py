"""The guard of a run: what it computed, held against slower ways at a few random places, and its rays against each other.

What it cannot see: places that were not drawn, paths that no ray found, and what all rays do wrong in the same way. A
disagreement is always worth a look; agreement is no proof.
"""
from .check import Check, GuardWarning, warn_of
from .plane_checks import check_planes
from .ray_checks import check_rays
from .signal_checks import check_signal

__all__ = ["Check", "GuardWarning", "check_planes", "check_rays", "check_signal", "warn_of"]
