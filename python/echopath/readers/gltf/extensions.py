"""Extensions that a file may require: which of them change no shape, and which are read."""
from __future__ import annotations

from .animations import POINTER
from .document import Document
from .instances import INSTANCING
from .packed import DRACO, MESHOPT

READ = ("KHR_mesh_quantization", "KHR_node_visibility", DRACO, MESHOPT, INSTANCING, POINTER)
WITHOUT_SHAPE = ("KHR_materials_", "KHR_texture_", "EXT_texture_", "MSFT_texture_", "MSFT_packing_", "EXT_materials_",
                 "ADOBE_materials_", "KHR_lights_", "EXT_lights_", "KHR_xmp", "KHR_audio", "EXT_mesh_features",
                 "EXT_structural_metadata", "KHR_node_selectability", "KHR_node_hoverability", "KHR_technique")


def check_extensions(document: Document) -> None:
    """Raises FileError for a required extension that is not read."""
    for item in document.json["extensionsRequired"].entries():
        name = item.text()
        if name not in READ and not name.startswith(WITHOUT_SHAPE):
            item.fail(f"the file requires the extension {name[:80]}, which is not read")
