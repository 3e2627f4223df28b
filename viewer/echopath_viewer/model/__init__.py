"""What the viewer knows and shows, in NumPy: no VTK, no Qt."""
from .colours import COLOUR_MODES, Colouring, Legend, colour_rays
from .frames.inputs import ViewInput, from_file, from_frame, from_paths, whole_part
from .maps.cell_index import CellBox, CellIndex
from .maps.part_set import MESH_GROUP, OWN_GROUP, WHOLE, Part, PartSet
from .maps.signals import Signals
from .palette import mesh_palette
from .rays.columns import Columns, read_columns
from .rays.filters import FilterError, Filters
from .rays.ray_sample import SAMPLINGS
from .rays.segments import Segments, ray_segments
from .session import Session

__all__ = [
    "COLOUR_MODES", "CellBox", "CellIndex", "Colouring", "Columns", "FilterError", "Filters", "Legend", "MESH_GROUP",
    "OWN_GROUP", "Part", "PartSet", "SAMPLINGS", "Segments", "Session", "Signals", "ViewInput", "WHOLE", "colour_rays",
    "from_file", "from_frame", "from_paths", "mesh_palette", "ray_segments", "read_columns", "whole_part",
]
