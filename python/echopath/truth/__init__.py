"""What is true of the objects of frames: where they are, how they move, how much of them the radar sees."""
from .boxes import Boxes, boxes_at
from .cross_section import isotropic_power
from .record import Truth
from .truth import joined, truth_of_frame

__all__ = ["Boxes", "Truth", "boxes_at", "isotropic_power", "joined", "truth_of_frame"]
