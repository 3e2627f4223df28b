"""Rules of arguments that actors share: what they refuse would need more memory or digits than there are."""
from __future__ import annotations

from ..arguments.checks import real

LARGEST = 1000.0        # m, of a thing in a street
LONGEST_ROW = 10_000.0  # m, of a rail

size_rule = real(above=0.0, high=LARGEST, unit="m")
row_rule = real(above=0.0, high=LONGEST_ROW, unit="m")
