"""Whether materials by name have their values at the frequency of the radar."""
from __future__ import annotations

import numpy as np

from ..arguments.names import first_names
from ..base.materials import LIBRARY_FREQUENCY, is_near_library, materials
from ..scene.adapted_materials import as_in, library_name
from .rules import Case, rule

ALIKE = 0.02  # share by which values may differ, as they do a hundredth of the frequency beside


@rule("materials over frequency")
def _over_frequency(case: Case):
    named = [(name, material) for given, material in case.named_materials if (name := library_name(given, material))]
    if not named:
        return False, "no material is one of ep.materials by its name"
    frequency, names = case.radar.waveform.centre_frequency, {name for name, _ in named}
    there, in_library = f"at {frequency * 1e-9:.3g} GHz", f"at {LIBRARY_FREQUENCY * 1e-9:g} GHz"
    is_near, library = is_near_library(frequency), materials.at(frequency)
    kept = sorted(names.intersection(library.not_given))
    nobody = f"; nobody gives {first_names(kept)} {there}" if kept else ""
    if others := _in_none_of([library, materials] if is_near else [library], named):
        return False, (f"ep.adapt_materials(scene, radar), adapt_materials = true in a scene file, gives {first_names(others)} "
                       f"the values {there}, in the place of others{nobody}")
    if is_near:
        return True, f"named materials have their values {there}, or those {in_library}, which are within a tenth of that"
    return len(kept) < len(names), f"named materials have their values {there if len(kept) < len(names) else in_library}{nobody}"


def _in_none_of(libraries: list, named: list) -> list[str]:
    """Names of materials that none of the libraries has alike, in order. named: [(name, Material)]"""
    return sorted({name for name, material in named
                   if not any(_are_alike(material, as_in(library, name, material.mirror)) for library in libraries)})


def _are_alike(one, other) -> bool:
    mine, theirs = _numbers(one), _numbers(other)
    return mine.shape == theirs.shape and np.allclose(mine, theirs, rtol=ALIKE, atol=0.0)


def _numbers(material) -> np.ndarray:
    """What laws over frequency change of a material."""
    layers = [layer.permittivity for layer in material.layers]
    values = [material.permittivity or 0.0, material.roughness_height, material.backscatter_share, *layers]
    return np.array(values, complex).view(float)
