"""Echopath: FMCW radar simulation by shooting and bouncing rays that remember what they touched.

    scene = ep.Scene()
    paths = ep.trace(scene, radar, num_rays=1_000_000)      # once
    cube = ep.synthesize(paths, radar)                      # [tx, rx, chirp, sample]
    parts = ep.decompose(paths, radar, {"wall": "T .* 'wall' .* R"})
"""
from importlib.util import find_spec

from . import _core
from ._core import (DeviceError, FileError, KeyframeMotion, LinearMotion, Material, Mesh, Motion, VertexSequence, __version__,
                    boltzmann, load_mesh, load_meshes, num_threads, set_num_threads, speed_of_light)
from .materials import materials
from .scene import Scene

# TEMPORARY: what is not there yet is left out.
for _name in ("Antenna", "ChirpSequence", "CosinePower", "Isotropic", "Paths", "Radar", "RangeDoppler", "Selection", "Stratum",
              "TraceFrame", "TraceStatistics", "add_noise", "decompose", "hits", "num_bounces", "range_doppler", "synthesize",
              "trace"):
    if hasattr(_core, _name):
        globals()[_name] = getattr(_core, _name)

if find_spec("echopath.actors"):
    from . import actors
if find_spec("echopath.actors.actor"):
    from .actors.actor import Actor, Part
if find_spec("echopath.simulate"):
    from .simulate import Frame, simulate
if find_spec("echopath.frame_file") and find_spec("h5py"):
    from .frame_file import load_frame, save_frame
if find_spec("echopath.scene_file") and find_spec("pydantic"):
    from .scene_file import SceneFile, load_scene


def view(*arguments, **keywords):
    """Opens the viewer: view(scene, paths, parts). Needs the packages of `pip install echopath[viewer]`."""
    from echopath_viewer import view as open_viewer

    return open_viewer(*arguments, **keywords)
