"""Labels of the cells of a map: which part of the paths made each, and what the map shows of each object."""
from .annotate import annotate
from .images import save_label_images
from .labels import AzimuthBox, AzimuthPeak, Box, GhostLabel, Labels, ObjectLabel, Peak

__all__ = ["AzimuthBox", "AzimuthPeak", "Box", "GhostLabel", "Labels", "ObjectLabel", "Peak", "annotate", "save_label_images"]
