"""Names of materials in foreign files, and which of ours they mean."""
from __future__ import annotations

foreign_materials: dict[str, str] = {}
