"""What stands in records and answers where there is nothing to name (cpp/echopath/record/paths.h)."""
from __future__ import annotations

NO_STRATUM, NO_BATCH = 65535, 255  # of paths of the image method, which no ray made
NO_MESH = 2 ** 32 - 1              # of a ray that hits nothing, and of a way about which there is no edge
