"""Materials of whole scenes at the frequency of the radar."""
from __future__ import annotations

from .. import _core
from ..arguments.checks import an, checked
from ..base.materials import MaterialLibrary, materials
from .scene import Scene, changed_scene


@checked(scene=changed_scene, radar=an(_core.Radar))
def adapt_materials(scene: Scene, radar: _core.Radar) -> tuple[str, ...]:
    """Gives materials by name their values at the middle of the radar's band, in the place of those at 77 GHz.

    These are the materials of `ep.materials` that were given by their name or as they are there or in `ep.materials.at`, by
    actors and readers, too, and those at 77 GHz as mirrors. What was made of them by other changes, as a roughness of one's
    own, stays as it is: `ep.materials.at(frequency)` has them to start from, and `frequency` beside `base` in a table of a
    scene file. Names are kept, from which a second call, for another radar, starts again.

    scene: is changed
    radar: its waveform says the frequency
    Returns the names of the materials in the scene that nobody gives at this frequency, which keep their values at 77 GHz, in
    order of name (`ep.materials.source` says where values come from). Raises TypeError naming the argument.
    """
    library = materials.at(radar.waveform.centre_frequency)
    with scene._edit():
        nodes = scene.nodes
        kinds = {index: (node.material_name, node.material) for index, node in enumerate(nodes) if node.mesh is not None}
        named = {kind: name for kind in set(kinds.values()) if (name := library_name(*kind))}
        adapted = {kind: as_in(library, name, kind[1].mirror) for kind, name in named.items()}
        for index, kind in kinds.items():
            if kind in named:
                scene._change(index, nodes[index].replace(material=adapted[kind], material_name=named[kind]))
    return tuple(sorted(set(named.values()).intersection(library.not_given)))


def as_in(library: MaterialLibrary, name: str, mirror: bool) -> _core.Material:
    """The material of a name in a library, also as a mirror."""
    return library[name].replace(mirror=True) if mirror else library[name]


def library_name(material_name: str, material: _core.Material) -> str:
    """The name in `ep.materials` of a material that a scene has under a name, "" for any other."""
    if material_name or not material.mirror:
        return material_name if material_name in materials else ""
    as_object = material.replace(mirror=False)
    return next((name for name, known in materials.items() if known == as_object), "")
