"""Labelled frames by the thousand: a template, whose values are drawn for each scene, and the folder that they are kept in."""
from .exports.carrada import write_carrada
from .exports.osi import write_osi
from .exports.radar_scenes import write_radar_scenes
from .folder import SceneRecord
from .making import Forecast, MadeScene, make
from .opened import Dataset, DatasetFrame, open
from .report import write_report
from .template import DatasetTable, DrawnScene, Template

__all__ = ["Dataset", "DatasetFrame", "DatasetTable", "DrawnScene", "Forecast", "MadeScene", "SceneRecord", "Template", "make",
           "open", "write_carrada", "write_osi", "write_radar_scenes", "write_report"]


def __dir__() -> list[str]:
    """What users need, as completion at a prompt shows it; the modules behind it are there, but do not show."""
    return __all__
