"""glTF 2.0 files, .gltf and .glb (Khronos Group, "glTF 2.0 Specification", 2021; ISO/IEC 12113)."""
from .read import read

__all__ = ["read"]
