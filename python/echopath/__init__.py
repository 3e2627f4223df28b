"""Echopath: FMCW radar simulation by shooting and bouncing rays that remember what they touched.

    scene = ep.Scene()
    scene.add(ep.load_mesh("wall.obj"), name="wall", material="concrete")
    paths = ep.trace(scene, radar, num_rays=1_000_000)                     # once
    cube = ep.synthesize(paths, radar)                                     # [tx, rx, chirp, sample]
    parts = ep.decompose(paths, radar, {"ghosts": "T .* 'wall' .* R"})     # and "other"
"""
from ._startup import answer_ctrl_c_while_loading

answer_ctrl_c_while_loading()

from . import _core
from ._core import (
    AngleEstimates, AngleSpectrum, Antenna, AntennaPattern, BeamPower, CfarResult, ChirpSequence, CoplanarOverlap,
    CosinePower, Deformation, DeviceError, Family, FileError, GainTable, Isotropic, Joint, KeyframeMotion, LinearMotion,
    Material, Mesh, Motion, ObjectValidity, Paths, Radar, RangeAzimuth, RangeDoppler, ReceivedPower, Renewal, Selection,
    SignalProbe, Skin, Stratum, TraceFrame, TraceStatistics, Validity, ValidityShares, VertexSequence, VirtualArray,
    __version__, add_noise, angle_fft, beamform, boltzmann, cfar, compensate_tdm, estimate_angles, first, hits, last,
    load_mesh, load_meshes, mie_rcs, num_bounces, num_threads, power, range_azimuth, range_doppler, received_power,
    received_powers, renew, set_num_threads, speed_of_light, synthesize, validity, virtual_array,
)
from .antennas import load_antenna
from .materials import materials
from .scene import Scene
from .tessellation import TessellationWarning
from .tracing import rcs, trace
from .effects import Effect, effects
from . import actors
from .actors import Actor, Part
from .detections import Detections, detect, detect_frame
from .families import Families, families
from .guard import Check, GuardWarning, check_rays, check_signal
from .labels import GhostLabel, Labels, ObjectLabel, annotate, annotate_frame, save_label_images
from .measures import power_by_chirp
from .parts import Parts, decompose
from .path_cells import PathCells, path_cells
from .resolution import Interval, Unresolved, unresolved
from .simulate import Frame, simulate
from .visibility import ObjectVisibility, Sight, visibility
from .frame_file import load_frame, load_labels, save_frame, save_labels
from .scene_file import SceneFile, load_scene
from .xarray_maps import to_xarray


def view(*arguments, **keywords):
    """Opens the viewer: view(scene, paths, parts), view(frame) or view("frame.h5").

    It comes with `pip install echopath[viewer]`.
    arguments, keywords: those of the viewer's own `view`.
    """
    return _viewer().view(*arguments, **keywords)


def plot_rays(*arguments, **keywords):
    """Draws a scene with its strongest rays: plot_rays(scene, paths, off_screen=True, screenshot="rays.png").

    Needs no screen; comes with `pip install echopath[viewer]`.
    arguments, keywords: those of the viewer's own `plot_rays`.
    """
    return _viewer().plot_rays(*arguments, **keywords)


def _viewer():
    import echopath_viewer

    return echopath_viewer


__all__ = [
    "Actor", "AngleEstimates", "AngleSpectrum", "Antenna", "AntennaPattern", "BeamPower", "CfarResult", "Check",
    "ChirpSequence", "CoplanarOverlap", "CosinePower", "Deformation", "Detections", "DeviceError", "Effect", "Families",
    "Family", "FileError", "Frame", "GainTable", "GhostLabel", "GuardWarning", "Interval", "Isotropic", "Joint",
    "KeyframeMotion", "Labels", "LinearMotion", "Material", "Mesh", "Motion", "ObjectLabel", "ObjectValidity",
    "ObjectVisibility", "Part", "Parts", "PathCells", "Paths", "Radar", "RangeAzimuth", "RangeDoppler", "ReceivedPower",
    "Renewal", "Scene", "SceneFile", "Selection", "Sight", "SignalProbe", "Skin", "Stratum", "TessellationWarning",
    "TraceFrame", "TraceStatistics", "Unresolved", "Validity", "ValidityShares", "VertexSequence", "VirtualArray", "actors",
    "add_noise", "angle_fft", "annotate", "annotate_frame", "beamform", "boltzmann", "cfar", "check_rays", "check_signal",
    "compensate_tdm", "decompose", "detect", "detect_frame", "effects", "estimate_angles", "families", "first", "hits",
    "last", "load_antenna", "load_frame", "load_labels", "load_mesh", "load_meshes", "load_scene", "materials", "mie_rcs",
    "num_bounces", "num_threads", "path_cells", "plot_rays", "power", "power_by_chirp", "range_azimuth", "range_doppler",
    "rcs", "received_power", "received_powers", "renew", "save_frame", "save_label_images", "save_labels",
    "set_num_threads", "simulate", "speed_of_light", "synthesize", "to_xarray", "trace", "unresolved", "validity", "view",
    "virtual_array", "visibility",
]
