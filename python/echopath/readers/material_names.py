"""Names of materials in foreign files, and which of ours they mean."""
from __future__ import annotations

from collections.abc import Mapping

foreign_materials: dict[str, str] = {}
DEFAULT = "plastic"


def material_of(name: str, materials: Mapping[str, object]) -> tuple:
    """(material, note or None) for a name in a file, "" where the file gives none.

    materials: the caller's {name: Material or a name in ep.materials}, asked first
    """
    for known in (materials, foreign_materials):
        if name in known:
            return known[name], None
    named = f"the material '{name}' is not known" if name else "a mesh without a material"
    return DEFAULT, f"{named}, taken as {DEFAULT}"
