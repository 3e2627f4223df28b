"""Echopath: FMCW radar simulation by shooting and bouncing rays that remember what they touched.

    scene = ep.Scene()
    scene.add(ep.load_mesh("wall.obj"), name="wall", material="concrete")
    paths = ep.trace(scene, radar, num_rays=1_000_000)                                     # once
    cube = ep.synthesize(paths, radar)                                                     # [tx, rx, chirp, sample]
    parts = ep.decompose(paths, radar, {"ghosts": "T .* 'wall' .* R & ~(T 'wall'+ R)"})    # and "other"
"""
from ._startup import answer_ctrl_c_while_loading, answer_version_before_loading

answer_ctrl_c_while_loading()
answer_version_before_loading()

from typing import TYPE_CHECKING

from . import actors, plots
from ._core import (
    AngleEstimates,
    AngleSpectrum,
    Antenna,
    AntennaPattern,
    BeamPower,
    CfarResult,
    ChirpSequence,
    CoplanarOverlap,
    CosinePower,
    Curve,
    CurveMotion,
    Deformation,
    DeviceError,
    Family,
    FileError,
    GainTable,
    GaussianBeam,
    Isotropic,
    Joint,
    KeyframeMotion,
    Layer,
    LinearMotion,
    Material,
    Mesh,
    MorphTargets,
    Motion,
    ObjectValidity,
    Paths,
    Radar,
    RangeAzimuth,
    RangeDoppler,
    ReceivedPower,
    Renewal,
    Selection,
    SignalProbe,
    Skin,
    Stratum,
    TraceFrame,
    TraceStatistics,
    Validity,
    ValidityShares,
    VertexSequence,
    VirtualArray,
    __version__,
    boltzmann,
    speed_of_light,
)
from .actors import Actor, Part
from .arguments.settings import LabelSettings, SignalSettings, TraceSettings
from .base.materials import materials
from .base.process.threads import num_threads, set_num_threads
from .cavities.cavity import Cavity
from .detections import Detections, detect
from .effects import Effect, effects
from .frame.detections import detect_frame
from .frame.frame import Frame
from .frame.labels import annotate_frame
from .frame.maps import FrameMaps
from .frame.simulate import simulate
from .frame_file import load_frame, load_labels, save_frame, save_labels
from .guard import Check, GuardWarning, check_rays, check_signal
from .in_time import (
    AngleTime,
    RangeTime,
    Spectrogram,
    SpectrogramLabels,
    angle_time,
    range_time,
    spectrogram,
    spectrogram_labels,
)
from .labels import GhostLabel, Labels, ObjectLabel, annotate, save_label_images
from .live import Live, LiveView, Watch
from .paths.cells import PathCells, path_cells
from .paths.families import Families, families
from .paths.powers import received_power, received_powers
from .paths.resolution import Interval, Unresolved, unresolved
from .paths.selections import first, hits, last, num_bounces, passes, power
from .paths.visibility import ObjectVisibility, VisibilityFromEnd, visibility
from .readers import Model, ModelNode, foreign_materials, load_model
from .receiver import Adc, PhaseNoise, Receiver, Reception, receive, receive_parts
from .scene.adapted_materials import adapt_materials
from .scene.foreign import mesh_from
from .scene.found_objects import find_objects
from .scene.interferers import Interferer
from .scene.large_planes import mark_mirrors
from .scene.meshes import load_mesh, load_meshes
from .scene.node import SceneNode
from .scene.scene import Scene
from .scene.sheets import SheetCoefficients, sheet_coefficients
from .scene.traffic import Traffic, add_traffic
from .scene_file import SceneFile, load_scene
from .sensor_files import SensorConfig, load_radar, load_raw, load_sensor, save_raw
from .sensor_files.antennas import load_antenna
from .sequence import SavedFrame, Sequence, StoredSequence, load_sequence
from .signals.around_corners import synthesize_around_corners
from .signals.if_signal import add_noise, noise_power, synthesize
from .signals.interference import interference
from .signals.interference_ways import interference_radar
from .signals.measures import power_by_chirp
from .signals.parts import Parts, decompose
from .signals.point_targets import point_targets
from .spectra.angles import angle_fft, beamform, compensate_tdm, estimate_angles, range_azimuth, virtual_array
from .spectra.backprojection import backproject, calibrate
from .spectra.clutter_removal import remove_clutter
from .spectra.music import music
from .spectra.range_doppler import cfar, range_doppler
from .tracing.around_corners import AroundCorner, around_corners
from .tracing.tessellation import TessellationWarning
from .tracing.traces import mie_rcs, rcs, trace
from .tracing.validity import renew, validity
from .tracks import Tracks, track
from .trajectories import Lane, Trajectory, read_trajectories
from .transmit import demultiplex
from .truth import Truth
from .viewing.viewer import plot_rays, view
from .weather import Weather

# isort: split
from .frame.truth import truth  # the function, which comes behind the package of its name: type checkers take the last one

__all__ = [
    "Actor", "Adc", "AngleEstimates", "AngleSpectrum", "AngleTime", "Antenna", "AntennaPattern", "AroundCorner", "BeamPower",
    "Cavity", "CfarResult", "Check", "ChirpSequence", "CoplanarOverlap", "CosinePower", "Curve", "CurveMotion", "Deformation",
    "Detections", "DeviceError", "Effect", "Families", "Family", "FileError", "Frame", "FrameMaps", "GainTable",
    "GaussianBeam", "GhostLabel", "GuardWarning", "Interferer", "Interval", "Isotropic", "Joint", "KeyframeMotion",
    "LabelSettings", "Labels", "Lane", "Layer", "LinearMotion", "Live", "LiveView", "Material", "Mesh", "Model", "ModelNode",
    "MorphTargets", "Motion", "ObjectLabel", "ObjectValidity", "ObjectVisibility", "Part", "Parts", "PathCells",
    "Paths", "PhaseNoise", "Radar", "RangeAzimuth", "RangeDoppler", "RangeTime", "ReceivedPower", "Receiver",
    "Reception", "Renewal", "SavedFrame", "Scene", "SceneFile", "SceneNode", "Selection", "SensorConfig", "Sequence",
    "SheetCoefficients", "SignalProbe", "SignalSettings", "Skin", "Spectrogram", "SpectrogramLabels",
    "StoredSequence", "Stratum", "TessellationWarning", "TraceFrame", "TraceSettings", "TraceStatistics", "Tracks",
    "Traffic", "Trajectory", "Truth", "Unresolved", "Validity", "ValidityShares", "VertexSequence", "VirtualArray",
    "VisibilityFromEnd", "Watch", "Weather", "actors", "add_noise", "add_traffic", "angle_fft", "angle_time", "annotate",
    "annotate_frame", "around_corners",
    "adapt_materials", "backproject", "beamform", "boltzmann", "calibrate", "cfar", "check_rays", "check_signal",
    "compensate_tdm", "decompose", "demultiplex",
    "detect", "detect_frame", "effects", "estimate_angles", "families", "find_objects", "first", "foreign_materials", "hits",
    "interference", "interference_radar", "last", "load_antenna", "load_frame", "load_labels", "load_mesh", "load_meshes",
    "load_model", "load_radar", "load_raw", "load_scene", "load_sensor", "load_sequence", "mark_mirrors", "materials",
    "mesh_from", "mie_rcs", "music", "noise_power", "num_bounces", "num_threads", "passes", "path_cells", "plot_rays", "plots",
    "point_targets",
    "power", "power_by_chirp", "range_azimuth", "range_doppler", "range_time", "rcs", "read_trajectories", "receive",
    "receive_parts",
    "received_power", "received_powers", "remove_clutter", "renew", "save_frame", "save_label_images", "save_labels",
    "save_raw", "set_num_threads", "sheet_coefficients", "simulate", "spectrogram", "spectrogram_labels",
    "speed_of_light", "synthesize", "synthesize_around_corners", "trace", "track", "truth", "unresolved", "validity",
    "view", "virtual_array", "visibility",
]


if TYPE_CHECKING:
    from . import dataset as dataset
else:  # to type checkers it would have every name
    def __getattr__(name: str):
        """`ep.dataset`, which takes its time to import, when it is asked for."""
        if name == "dataset":
            from importlib import import_module

            return import_module(".dataset", __name__)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    """What users need; the modules behind it are there, but do not show."""
    return [*__all__, "__version__", "dataset"]
