"""Whether materials by name have their values at the frequency of the radar."""
from __future__ import annotations

from .. import _core
from ..arguments.names import first_names
from ..base.materials import LIBRARY_FREQUENCY, MaterialLibrary, is_near_library, materials
from ..scene.adapted_materials import library_name
from .rules import Case, rule


@rule("materials over frequency")
def _over_frequency(case: Case):
    named = [(name, node.material) for node in case.scene.nodes if (name := library_name(node))]
    if not named:
        return False, "no material is one of ep.materials by its name"
    frequency = case.radar.waveform.centre_frequency
    library = materials.at(frequency)
    is_near = is_near_library(frequency)
    libraries = (materials, library) if is_near else (library,)
    there, in_library = f"at {frequency * 1e-9:.3g} GHz", f"at {LIBRARY_FREQUENCY * 1e-9:g} GHz"
    names = {name for name, _ in named}
    kept = sorted(names.intersection(library.not_given))
    nobody = f"; nobody gives {first_names(kept)} {there}" if kept else ""
    differ = sorted({name for name, material in named if not any(_is_of(one, name, material) for one in libraries)})
    if differ:
        return False, (f"ep.adapt_materials(scene, radar), adapt_materials = true in a scene file, gives {first_names(differ)} "
                       f"the values {there}, in the place of those at another frequency{nobody}")
    if is_near:
        return True, f"named materials have their values {in_library}, which are within a tenth of the radar's frequency"
    return len(kept) < len(names), f"named materials have their values {there if len(kept) < len(names) else in_library}{nobody}"


def _is_of(library: MaterialLibrary, name: str, material: _core.Material) -> bool:
    """Whether a material has the values that a library has under a name, be it a mirror or not."""
    return material == library[name].replace(**{"mirror": True} if material.mirror else {})
