"""The C++ core of echopath; use it through the package.

Written by python/bindings/make_stubs.py: do not edit.
"""
from __future__ import annotations
from collections.abc import Sequence
from numpy.typing import ArrayLike
import types
from echopath.base.classes.foreign_types import Axes, DataArray, DataFrame, Dataset
from echopath.effects.rules import Effect
from echopath.frame_file.frame import LeftOut
from echopath.receiver import Receiver
from typing import Literal
import collections.abc
import numpy
import numpy.typing
import os
import typing
bench: types.ModuleType
__all__: list[str] = ['AngleEstimates', 'AngleSpectrum', 'Antenna', 'AntennaPattern', 'BeamPower', 'CfarResult', 'ChirpSequence', 'CoplanarOverlap', 'CosinePower', 'Curve', 'CurveMotion', 'DEFAULT_MAX_RAYS', 'Deformation', 'DeviceError', 'Family', 'FileError', 'GainTable', 'GaussianBeam', 'Grouping', 'HIGHEST_FREQUENCY', 'Isotropic', 'Joint', 'KeptGeometry', 'KeptStillRays', 'KeyframeMotion', 'LOWEST_FREQUENCY', 'Layer', 'LinearMotion', 'LiveTrace', 'MESH_SUFFIXES', 'MOST_RAYS', 'Material', 'Mesh', 'MeshTable', 'MorphTargets', 'Motion', 'Node', 'NumBounces', 'ObjectValidity', 'PHASE_TOLERANCE', 'PartPass', 'Paths', 'Power', 'RECORD_SETTINGS', 'Radar', 'RangeAzimuth', 'RangeDoppler', 'ReceivedPower', 'Renewal', 'Scene', 'SceneMesh', 'Selection', 'SignalProbe', 'Skin', 'Stratum', 'TraceFrame', 'TraceStatistics', 'Validity', 'ValidityShares', 'VertexSequence', 'VirtualArray', 'add_noise', 'amplitude_tolerance', 'angle_fft', 'are_clear', 'beamform', 'bench', 'boltzmann', 'cell_masks', 'cell_noise_power', 'cfar', 'check_axes', 'check_beams', 'check_cfar', 'check_objects', 'check_part_names', 'coherent_meshes', 'coherent_share', 'compensate_tdm', 'decompose', 'echo_histories', 'estimate_angles', 'find_families', 'find_peaks', 'first', 'glob_takes', 'hits', 'instruction_set', 'label_regions', 'last', 'legs_around_edges', 'load_frames', 'load_mesh', 'load_meshes', 'load_surfaces', 'look_at_bodies', 'looks_for_signals', 'main_lobe_half_width', 'may_appear_in_frame', 'mean_power', 'meant_name', 'mesh_names', 'mesh_traits', 'mesh_widths', 'meshes_cut_from_mirrors', 'meshes_of_large_planes', 'meshes_of_objects', 'meshes_of_usual_objects', 'middle_phases', 'mie_rcs', 'nearest_names', 'noise_power', 'noise_power_in_cell', 'num_bounces', 'num_threads', 'partition_groups', 'power', 'power_shares', 'range_azimuth', 'range_doppler', 'rcs', 'received_power', 'received_powers', 'received_powers_of_sortings', 'reference_temperature', 'remember_geometry', 'renew', 'set_num_threads', 'share_errors', 'slot_phasors', 'speed_of_light', 'strongest_edge', 'strongest_part', 'surface_centroid', 'synthesize', 'synthesize_echoes', 'tessellation', 'trace', 'triangles_of_polygons', 'vacuum_permittivity', 'validity', 'virtual_array', 'visibility', 'visibility_in_trace', 'warn_of_turns', 'weighted_row_sums', 'window']
class DeviceError(RuntimeError):
    """
    A device failed; a RuntimeError.
    """
class FileError(OSError):
    """
    A file cannot be read or written; an OSError.
    """
class Motion:
    """
    Time -> rigid transform, in the axes of the node's parent about the node's own origin.
    """
    def at(self, time: float) -> numpy.typing.NDArray[numpy.float64]:
        """
        Transform [4, 4] (translation in m) at `time` in s. Raises ValueError outside `span`.
        """
    def turn_rate(self, begin: float, end: float) -> float:
        """
        Bound in rad/s of how fast what it does comes and goes between `begin` and `end` (s).

        That of its angular speed or, where it goes to and fro between samples, pi by the shortest time from one turning point to the
        next: the larger. 0: it goes straight on. Raises TypeError or ValueError naming the argument.
        """
    @property
    def breakpoints(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Times [N] in s, ascending, where it is not smooth; of a loop those of one run.
        """
    @property
    def span(self) -> tuple[float, float]:
        """
        (begin, end) in s of the times it is defined on; infinite where unlimited.
        """
class LinearMotion(Motion):
    """
    Constant velocity and rotation.

    velocity: [3] in m/s
    angular_velocity: [3] in rad/s, right-handed about its own direction
    Raises TypeError or ValueError naming the argument.
    """
    def __eq__(self, other: object) -> bool:
        """
        Whether the other one is made of the same values.
        """
    def __getstate__(self) -> typing.Any:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, velocity: ArrayLike = (0.0, 0.0, 0.0), angular_velocity: ArrayLike = (0.0, 0.0, 0.0)) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: typing.Any) -> None:
        ...
    def replace(self, *, velocity: ArrayLike = ..., angular_velocity: ArrayLike = ...) -> LinearMotion:
        """
        A copy with other values of some arguments.

        changes: arguments of the constructor, by name
        Raises TypeError or ValueError as the constructor does.
        """
    @property
    def angular_velocity(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [3] in rad/s
        """
    @property
    def velocity(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [3] in m/s
        """
class KeyframeMotion(Motion):
    """
    Motion through keys.

    times: [T] in s, ascending, T >= 2
    translations: [T, 3] in m, or None for none
    rotations: [T, 4] unit quaternions (w, x, y, z), or None for none
    interpolation: "cubic" (C2 splines, smooth everywhere, which swing past what stops or starts at once), "monotone" (C1 cubics
        after Fritsch and Butland, which rest between equal keys and do not pass those on a line; their acceleration jumps) or
        "linear" (and slerp; the velocity jumps). Of the latter two each inner time is a breakpoint
    Between two keys a rotation goes the shorter way. Raises TypeError or ValueError naming the argument.
    """
    def __eq__(self, other: object) -> bool:
        """
        Whether the other one is made of the same values.
        """
    def __getstate__(self) -> typing.Any:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, times: ArrayLike, translations: ArrayLike | None = None, rotations: ArrayLike | None = None, interpolation: Literal['cubic', 'linear', 'monotone'] = 'cubic') -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: typing.Any) -> None:
        ...
    def replace(self, *, times: ArrayLike = ..., translations: ArrayLike | None = ..., rotations: ArrayLike | None = ..., interpolation: Literal['cubic', 'linear', 'monotone'] = ...) -> KeyframeMotion:
        """
        A copy with other values of some arguments.

        changes: arguments of the constructor, by name
        Raises TypeError or ValueError as the constructor does.
        """
    @property
    def interpolation(self) -> str:
        """
        "cubic", "linear" or "monotone"
        """
    @property
    def rotations(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [T, 4] (w, x, y, z), neighbours in one half space; [0, 4] where none were given
        """
    @property
    def times(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [T] in s
        """
    @property
    def translations(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [T, 3] in m, [0, 3] where none were given
        """
class Deformation:
    """
    Time -> vertices, which replace those of a mesh, in the node's own frame.
    """
    def at(self, time: float) -> numpy.typing.NDArray[numpy.float64]:
        """
        Vertices [V, 3] in m at `time` in s. Raises ValueError outside `span`.
        """
    def turn_rate(self, begin: float, end: float) -> float:
        """
        Bound in rad/s of how fast what it does comes and goes between `begin` and `end` (s).

        That of its angular speed or, where it goes to and fro between samples, pi by the shortest time from one turning point to the
        next: the larger. 0: it goes straight on. Raises TypeError or ValueError naming the argument.
        """
    @property
    def breakpoints(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Times [N] in s, ascending, where it is not smooth; of a loop those of one run.
        """
    @property
    def num_vertices(self) -> int:
        """
        V, of each instant
        """
    @property
    def span(self) -> tuple[float, float]:
        """
        (begin, end) in s of the times it is defined on; infinite where unlimited.
        """
class VertexSequence(Deformation):
    """
    Deforming mesh: time -> vertices.

    times: [T] in s, ascending, T >= 2
    vertices: [T, V, 3] in m, in the node's frame and in the order of the vertices the mesh was made from
    interpolation: "cubic" (C2 splines, which swing past what stops or starts at once), "monotone" or "linear" (each inner time
        is a breakpoint), as of KeyframeMotion
    period: s; what the sequence does from 0 s to this time, which `times` must hold, is repeated without end. Frames before and
        behind shape the splines: a loop whose outer frames repeat its inner ones goes on smoothly. None: it is defined on `span`
    offset: s, the time of a loop at time 0
    Raises TypeError or ValueError naming the argument. All but linear sequences take twice the memory of their vertices.
    """
    def __eq__(self, other: object) -> bool:
        """
        Whether the other one is made of the same values.
        """
    def __getstate__(self) -> typing.Any:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, times: ArrayLike, vertices: ArrayLike, interpolation: Literal['cubic', 'linear', 'monotone'] = 'cubic', *, period: float | None = None, offset: float = 0.0) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: typing.Any) -> None:
        ...
    def replace(self, *, times: ArrayLike = ..., vertices: ArrayLike = ..., interpolation: Literal['cubic', 'linear', 'monotone'] = ..., period: float | None = ..., offset: float = ...) -> VertexSequence:
        """
        A copy with other values of some arguments.

        changes: arguments of the constructor, by name
        Raises TypeError or ValueError as the constructor does.
        """
    @property
    def interpolation(self) -> str:
        """
        "cubic", "linear" or "monotone"
        """
    @property
    def offset(self) -> float:
        """
        s, time of the loop at time 0
        """
    @property
    def period(self) -> float | None:
        """
        s, or None where it is no loop
        """
    @property
    def times(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [T] in s
        """
    @property
    def vertices(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [T, V, 3] in m, a copy
        """
class Curve:
    """
    Numbers through keys, as animation files have them (glTF 2.0, appendix C).

    times: [T] in s, ascending, T >= 1
    values: [T, C], in the unit of what they stand for
    interpolation: "step" (the earlier key holds until the next), "linear", or "hermite" (cubic splines with given tangents)
    in_tangents, out_tangents: [T, C] per s, before and behind each key; for "hermite" alone
    Before its first key and after its last one it holds their values. Raises TypeError or ValueError naming the argument.
    """
    def __eq__(self, other: object) -> bool:
        """
        Whether the other one is made of the same values.
        """
    def __getstate__(self) -> typing.Any:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, times: ArrayLike, values: ArrayLike, interpolation: str = 'linear', *, in_tangents: ArrayLike | None = None, out_tangents: ArrayLike | None = None) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: typing.Any) -> None:
        ...
    def at(self, time: float) -> numpy.typing.NDArray[numpy.float64]:
        """
        Values [C] at `time` in s, column by column. Raises ValueError.
        """
    def replace(self, *, times: ArrayLike = ..., values: ArrayLike = ..., interpolation: str = ..., in_tangents: ArrayLike | None = ..., out_tangents: ArrayLike | None = ...) -> Curve:
        """
        A copy with other values of some arguments.

        changes: arguments of the constructor, by name
        Raises TypeError or ValueError as the constructor does.
        """
    @property
    def in_tangents(self) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        [T, C] per s, or None
        """
    @property
    def interpolation(self) -> str:
        """
        "step", "linear" or "hermite"
        """
    @property
    def out_tangents(self) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        [T, C] per s, or None
        """
    @property
    def times(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [T] in s
        """
    @property
    def values(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [T, C]
        """
class CurveMotion(Motion):
    """
    Motion of curves: an animation.

    translation: Curve of [T, 3] in m; rotation: Curve of [T, 4] quaternions (w, x, y, z), which go the shorter way between linear
        keys; scale: Curve of [T, 3], for joints of a Skin alone. None: none
    period: s; it begins anew after this time. None: it is played once, held before and after
    offset: s, the time of the curves at time 0
    It is defined at every time; each key, and each end of a loop, is a breakpoint. Raises TypeError or ValueError naming the
    argument.
    """
    def __eq__(self, other: object) -> bool:
        """
        Whether the other one is made of the same values.
        """
    def __getstate__(self) -> typing.Any:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, translation: Curve | None = None, rotation: Curve | None = None, scale: Curve | None = None, *, period: float | None = None, offset: float = 0.0) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: typing.Any) -> None:
        ...
    def replace(self, *, translation: Curve | None = ..., rotation: Curve | None = ..., scale: Curve | None = ..., period: float | None = ..., offset: float = ...) -> CurveMotion:
        """
        A copy with other values of some arguments.

        changes: arguments of the constructor, by name
        Raises TypeError or ValueError as the constructor does.
        """
    @property
    def offset(self) -> float:
        """
        s, time of its curves at time 0
        """
    @property
    def period(self) -> float | None:
        """
        s, or None where it is no loop
        """
    @property
    def rotation(self) -> Curve | None:
        """
        Curve of [T, 4] (w, x, y, z), or None
        """
    @property
    def scale(self) -> Curve | None:
        """
        Curve of [T, 3], or None
        """
    @property
    def translation(self) -> Curve | None:
        """
        Curve of [T, 3] in m, or None
        """
class MorphTargets(Deformation):
    """
    Deforming mesh: shares of other shapes.

    v(t) = vertices + sum over targets of weight(t) * target, exact at every time.
    vertices: [V, 3] in m, in the node's frame and in the order of the vertices the mesh was made from
    targets: [K, V, 3] in m, displacements
    weights: Curve of [T, K]
    period, offset: s, as of a CurveMotion
    A Skin moves its result with `Skin(..., shape=...)`. Raises TypeError or ValueError naming the argument.
    """
    def __eq__(self, other: object) -> bool:
        """
        Whether the other one is made of the same values.
        """
    def __getstate__(self) -> typing.Any:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, vertices: ArrayLike, targets: ArrayLike, weights: Curve, *, period: float | None = None, offset: float = 0.0) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: typing.Any) -> None:
        ...
    def replace(self, *, vertices: ArrayLike = ..., targets: ArrayLike = ..., weights: Curve = ..., period: float | None = ..., offset: float = ...) -> MorphTargets:
        """
        A copy with other values of some arguments.

        changes: arguments of the constructor, by name
        Raises TypeError or ValueError as the constructor does.
        """
    @property
    def offset(self) -> float:
        """
        s, time of its curves at time 0
        """
    @property
    def period(self) -> float | None:
        """
        s, or None where it is no loop
        """
    @property
    def targets(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [K, V, 3] in m, a copy
        """
    @property
    def vertices(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [V, 3] in m
        """
    @property
    def weights(self) -> Curve:
        """
        Curve of [T, K]
        """
class Layer:
    """
    One layer of a sheet (Material.layers). Cannot be changed.

    thickness: m; permittivity: complex, relative, eps' - j eps'' (imaginary part <= 0); conductivity: S/m, adds to the
    permittivity
    Raises TypeError or ValueError naming the field, the rule and the value.
    """
    def __eq__(self, other: object) -> bool:
        """
        Whether the other one is made of the same values.
        """
    def __getstate__(self) -> typing.Any:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, thickness: float, permittivity: complex, conductivity: float = 0.0) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: typing.Any) -> None:
        ...
    def replace(self, *, thickness: float = ..., permittivity: complex = ..., conductivity: float = ...) -> Layer:
        """
        A copy with other values of some arguments.

        changes: arguments of the constructor, by name
        Raises TypeError or ValueError as the constructor does.
        """
    @property
    def conductivity(self) -> float:
        """
        S/m
        """
    @property
    def permittivity(self) -> complex:
        """
        complex, relative
        """
    @property
    def thickness(self) -> float:
        """
        m, across the layer
        """
class Material:
    """
    What a surface does to a wave. Cannot be changed.

    Exactly one of
    conductor: True for a perfect conductor
    permittivity: complex, relative, eps' - j eps'' (imaginary part <= 0)
    reflectivity: share of power in [0, 1] that is reflected at every angle
    layers: [K] ep.Layer of a sheet, from the side of the surface's normals on, through which waves pass; `mirror` must be False
    and further
    conductivity: S/m, adds to the permittivity
    roughness_height: rms height in m (Ament), or scattering: S in [0, 1], S^2 is the diffuse share of power
    cross_polarization: K in [0, 0.5], share of diffuse power that leaves in the cross polarisation (polarised traces); 0.5 is
    full depolarisation, the most a reciprocal surface without a preferred axis does
    mirror: True for planes larger than their Fresnel zone, which are treated by images whatever they meet; of a mesh that is no
        plane each of its planes
    lobe_exponent: of the lobe of diffuse power about the direction of mirroring (Degli-Esposti 2007), a whole number up to 100;
        0: Lambert's lobe
    backscatter_share: of a lobe, share in [0, 1] of what goes back to where the wave comes from; backscatter_exponent: of that
        part, up to 100, 0: as lobe_exponent
    Raises TypeError or ValueError naming the field, the rule and the value.
    """
    @staticmethod
    def metal(mirror: bool = False) -> Material:
        """
        A perfect conductor; mirror: a plane larger than its Fresnel zone. Raises TypeError naming the argument.
        """
    def __eq__(self, other: object) -> bool:
        """
        Whether the other one is made of the same values.
        """
    def __getstate__(self) -> typing.Any:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, conductor: bool = False, permittivity: complex | None = None, conductivity: float = 0.0, reflectivity: float | None = None, layers: typing.Sequence[Layer] = (), roughness_height: float = 0.0, scattering: float | None = None, cross_polarization: float = 0.0, mirror: bool = False, lobe_exponent: int = 0, backscatter_share: float = 0.0, backscatter_exponent: int = 0) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: typing.Any) -> None:
        ...
    def backscatter(self, grazing: ArrayLike, *, frequency: float) -> numpy.typing.NDArray[numpy.float64]:
        """
        Co-polar radar cross section per area of what a surface scatters back diffusely, sigma0 [N], without its coherent echo.

        grazing: [N] rad in [0, pi/2], from the surface; frequency: Hz
        Raises TypeError or ValueError naming the argument.
        """
    def replace(self, *, conductor: bool = ..., permittivity: complex | None = ..., conductivity: float = ..., reflectivity: float | None = ..., layers: typing.Sequence[Layer] = ..., roughness_height: float = ..., scattering: float | None = ..., cross_polarization: float = ..., mirror: bool = ..., lobe_exponent: int = ..., backscatter_share: float = ..., backscatter_exponent: int = ...) -> Material:
        """
        A copy with other values of some arguments.

        changes: arguments of the constructor, by name
        Raises TypeError or ValueError as the constructor does.
        """
    @property
    def backscatter_exponent(self) -> int:
        """
        0: as lobe_exponent
        """
    @property
    def backscatter_share(self) -> float:
        """
        of the lobe, in [0, 1]
        """
    @property
    def conductivity(self) -> float:
        """
        S/m
        """
    @property
    def conductor(self) -> bool:
        """
        bool
        """
    @property
    def cross_polarization(self) -> float:
        """
        K in [0, 0.5]
        """
    @property
    def layers(self) -> tuple[Layer, ...]:
        """
        tuple [K] of ep.Layer, empty unless a sheet
        """
    @property
    def lobe_exponent(self) -> int:
        """
        of a directive lobe, 0: Lambert's
        """
    @property
    def mirror(self) -> bool:
        """
        bool
        """
    @property
    def permittivity(self) -> complex | None:
        """
        complex, relative, or None
        """
    @property
    def reflectivity(self) -> float | None:
        """
        share of power in [0, 1], or None
        """
    @property
    def roughness_height(self) -> float:
        """
        rms height in m
        """
    @property
    def scattering(self) -> float | None:
        """
        S in [0, 1], or None
        """
class Mesh:
    """
    One labelled surface. Cannot be changed; its arrays are views.

    vertices: [V, 3] in m
    triangles: [F, 3] indices of vertices
    original_triangle: [F] integers, what `.original_triangle` shall name instead of the rows of `triangles`
    No face is lost except those without area, which are counted in `num_removed_triangles`. Sheets that meet in a
    non-manifold edge or vertex get vertices of their own there, appended to `vertices`. Vertices that no face uses are left
    out. Raises TypeError or ValueError naming the argument, also for indices out of range, for a vertex of a face that is not
    finite, and where no face has an area.
    """
    @staticmethod
    def _part_of(whole: Mesh, triangles: typing.Any) -> Mesh:
        ...
    def __eq__(self, other: object) -> bool:
        """
        Whether the other one is made of the same values.
        """
    def __getstate__(self) -> typing.Any:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, vertices: ArrayLike, triangles: ArrayLike, original_triangle: ArrayLike | None = None) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: typing.Any) -> None:
        ...
    def part(self, triangles: ArrayLike) -> Mesh:
        """
        Some triangles as a mesh of their own, to be labelled.

        triangles: [N] indices of triangles, or a mask [F] of bool
        Returns a Mesh of these in their order. A smooth surface keeps its vertex normals across the cut, and a deformation of the
        whole deforms each part. Raises ValueError for none or one out of range.
        """
    @property
    def area(self) -> float:
        """
        m^2
        """
    @property
    def is_closed(self) -> bool:
        """
        no boundary edge, no duplicated vertex
        """
    @property
    def num_duplicated_vertices(self) -> int:
        """
        added where sheets meet
        """
    @property
    def num_input_vertices(self) -> int:
        """
        what a Deformation must have
        """
    @property
    def num_removed_triangles(self) -> int:
        """
        faces without area, left out
        """
    @property
    def original_triangle(self) -> numpy.typing.NDArray[numpy.uint32]:
        """
        [F] face of the input or file
        """
    @property
    def original_vertex(self) -> numpy.typing.NDArray[numpy.uint32]:
        """
        [V] vertex of the input
        """
    @property
    def triangles(self) -> numpy.typing.NDArray[numpy.uint32]:
        """
        [F, 3] indices of vertices
        """
    @property
    def vertices(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [V, 3] in m
        """
    @property
    def whole(self) -> Mesh:
        """
        the Mesh that this is a part of, None for a whole
        """
    @property
    def whole_triangle(self) -> numpy.typing.NDArray[numpy.uint32]:
        """
        [F] triangle of `whole`, [0] for a whole
        """
class MeshTable:
    """
    Keeps a value for each Mesh while it lives, no part of the public interface.
    """
    def __init__(self) -> None:
        ...
    def __len__(self) -> int:
        """
        Number of meshes that live and have a value.
        """
    def get(self, mesh: Mesh, otherwise: typing.Any) -> typing.Any:
        """
        What is kept for the mesh, or `otherwise`.
        """
    def set(self, mesh: Mesh, value: typing.Any) -> None:
        """
        Keeps a value for the mesh.
        """
class Node:
    """
    A node of a scene; cannot be changed.
    """
    def __eq__(self, other: object) -> bool:
        """
        Whether the other one is made of the same values.
        """
    def __getstate__(self) -> typing.Any:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, name: str, parent: int = -1, placement: ArrayLike | None = None, motion: Motion | None = None, mesh: Mesh | None = None, deformation: Deformation | None = None, material: Material | None = None, material_name: str = '', smooth: bool = False, visible: bool = True, lifetime: typing.Sequence[float] | None = None) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: typing.Any) -> None:
        ...
    def replace(self, *, name: str = ..., parent: int = ..., placement: ArrayLike | None = ..., motion: Motion | None = ..., mesh: Mesh | None = ..., deformation: Deformation | None = ..., material: Material | None = ..., material_name: str = ..., smooth: bool = ..., visible: bool = ..., lifetime: typing.Sequence[float] | None = ...) -> Node:
        """
        A copy with other values of some arguments.

        changes: arguments of the constructor, by name
        Raises TypeError or ValueError as the constructor does.
        """
    @property
    def deformation(self) -> Deformation:
        """
        a VertexSequence, a Skin or None
        """
    @property
    def lifetime(self) -> tuple[float, float] | None:
        """
        (begin, end) in s: it is part of the frames that this covers wholly; None: of all
        """
    @property
    def material(self) -> Material:
        """
        a Material or None
        """
    @property
    def material_name(self) -> str:
        """
        as given, "" for a material without a name
        """
    @property
    def mesh(self) -> Mesh:
        """
        a Mesh or None
        """
    @property
    def motion(self) -> Motion:
        """
        a motion or None
        """
    @property
    def name(self) -> str:
        """
        full name, "street/pedestrian/head"
        """
    @property
    def parent(self) -> int:
        """
        index of the parent, -1 for a child of the root
        """
    @property
    def placement(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [4, 4] at rest, relative to the parent, m
        """
    @property
    def smooth(self) -> bool:
        """
        whether the mesh stands for a curved surface
        """
    @property
    def visible(self) -> bool:
        """
        False: neither it nor what is below it takes part in anything
        """
class SceneMesh:
    """
    A mesh of a scene with its mesh ID.
    """
    def __eq__(self, arg0: object) -> bool:
        ...
    def __getstate__(self) -> dict[typing.Any, typing.Any]:
        ...
    def __hash__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: dict[typing.Any, typing.Any]) -> None:
        ...
    @property
    def id(self) -> int:
        """
        mesh ID
        """
    @property
    def material(self) -> Material:
        """
        the Material
        """
    @property
    def material_name(self) -> str:
        """
        as given, "" for a material without a name
        """
    @property
    def mesh(self) -> Mesh:
        """
        the Mesh
        """
    @property
    def name(self) -> str:
        """
        full name of its node
        """
    @property
    def node(self) -> int:
        """
        index into scene.nodes
        """
    @property
    def triangles(self) -> numpy.typing.NDArray[numpy.uint32]:
        """
        [F, 3] indices of vertices
        """
class Scene:
    """
    A tree of named nodes with placements, motions and meshes.
    """
    def __contains__(self, name: object) -> bool:
        """
        Whether there is a node with that full name.
        """
    def __copy__(self) -> Scene:
        ...
    def __deepcopy__(self, memo: dict[int, object]) -> Scene:
        """
        Shares meshes, motions and materials, which cannot change.
        """
    def __getitem__(self, name: str) -> Node:
        """
        The Node with that full name, "street/car". Raises KeyError naming the nearest names.
        """
    def __getstate__(self) -> tuple[list[Node]]:
        ...
    @typing.overload
    def __init__(self) -> None:
        ...
    @typing.overload
    def __init__(self, scene: Scene) -> None:
        """
        A copy.
        """
    def __iter__(self) -> collections.abc.Iterator[str]:
        """
        Full names, parents first.
        """
    def __len__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: typing.Any) -> None:
        ...
    def _add_nodes(self, nodes: collections.abc.Sequence[Node]) -> None:
        ...
    def _change(self, index: int, node: Node) -> None:
        ...
    def _hide_absent(self, begin: float, end: float) -> None:
        ...
    def _index_of(self, name: typing.Any) -> int:
        """
        Raises KeyError naming the nearest names.
        """
    def _lifetime(self, index: int) -> tuple[float, float]:
        ...
    def _node(self, index: int) -> Node:
        ...
    def _remove(self, index: int) -> None:
        ...
    def _takes_part(self, index: int) -> bool:
        ...
    def coplanar_overlaps(self, *, time: float = 0.0, max_distance: float = 1e-05) -> list[CoplanarOverlap]:
        """
        Where meshes lie on each other, or a mesh lies on itself.

        time: s; max_distance: m, up to which two triangles count that are nowhere further apart where one lies over the other
        Which of the two a ray meets is decided by rounding. The level of the echo stays that of one surface; its material and the
        label are those of the one that is met. Where no ray reaches, as under a box on the ground, it does no harm.
        Triangles that merely touch, overlap by less than max_distance, or cross do not count.
        Of meshes that are copies of each other at the same place, the first stands for all: each copy is listed with it and with
        nothing else.
        Returns a list of CoplanarOverlap, by mesh IDs. Takes about a second for a million triangles. Raises ValueError, also for a
        time outside a motion.
        """
    def find(self, name: str) -> int | None:
        """
        Index of the node with that full name, None where there is none.
        """
    def is_moving(self, mesh_id: int) -> bool:
        """
        Whether the mesh moves or deforms at some time. Raises IndexError.
        """
    def require_times(self, begin: float, end: float) -> None:
        """
        Raises ValueError naming the node whose motion is not defined on all of [begin, end] (s) within its lifetime.
        """
    def world_vertices(self, mesh_id: int, time: float = 0.0) -> numpy.typing.NDArray[numpy.float64]:
        """
        Vertices [V, 3] in m of a mesh at `time` in s, in world coordinates. Raises IndexError, ValueError.
        """
    @property
    def _has_lifetimes(self) -> bool:
        ...
    @property
    def breakpoints(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Times [N] in s, ascending, where some motion is not smooth.
        """
    @property
    def meshes(self) -> list[SceneMesh]:
        """
        list of SceneMesh that take part, by mesh ID
        """
    @property
    def nodes(self) -> list[Node]:
        """
        list of Node, parents first
        """
    @property
    def num_triangles(self) -> int:
        ...
class CoplanarOverlap:
    """
    Where two meshes, or a mesh and itself, lie on each other.
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __eq__(self, arg0: object) -> bool:
        ...
    def __getstate__(self) -> dict[typing.Any, typing.Any]:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: dict[typing.Any, typing.Any]) -> None:
        ...
    @property
    def area(self) -> float:
        """
        m^2, summed over pairs of triangles
        """
    @property
    def distance(self) -> float:
        """
        m, largest between the two
        """
    @property
    def mesh_ids(self) -> tuple[int, int]:
        """
        their mesh IDs, the lower one first
        """
    @property
    def names(self) -> tuple[str, str]:
        """
        full names of the two meshes; twice the same for a mesh that lies on itself
        """
    @property
    def num_triangles(self) -> int:
        """
        of both meshes, that lie on one of the other
        """
class Joint:
    """
    A joint of a skin. Cannot be changed.

    name: unique within its skin; the part of a mesh that it moves is named after it
    parent: name of an earlier joint; None: it moves in the frame of the skin
    position [3] in m, or transform [4, 4]: at rest, relative to the parent
    motion: LinearMotion, KeyframeMotion or CurveMotion about its own origin, as of a node of a scene; None: at rest
    inverse_bind: [4, 4] frame of the skin -> frame of the joint where the vertices were bound to it; None: as the joints rest
    With transform none and inverse_bind given, a motion is the joint's transform relative to its parent, as in glTF files.
    Raises TypeError or ValueError naming the argument.
    """
    def __eq__(self, other: object) -> bool:
        """
        Whether the other one is made of the same values.
        """
    def __getstate__(self) -> typing.Any:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, name: str, parent: str | None = None, *, position: ArrayLike | None = None, transform: ArrayLike | None = None, motion: Motion | None = None, inverse_bind: ArrayLike | None = None) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: typing.Any) -> None:
        ...
    def replace(self, *, name: str = ..., parent: str | None = ..., position: ArrayLike | None = ..., transform: ArrayLike | None = ..., motion: Motion | None = ..., inverse_bind: ArrayLike | None = ...) -> Joint:
        """
        A copy with other values of some arguments.

        changes: arguments of the constructor, by name
        Raises TypeError or ValueError as the constructor does.
        """
    @property
    def inverse_bind(self) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        [4, 4], or None where it follows from the joints at rest
        """
    @property
    def motion(self) -> Motion:
        """
        a motion or None
        """
    @property
    def name(self) -> str:
        """
        of the joint
        """
    @property
    def parent(self) -> str | None:
        """
        name of the parent, or None
        """
    @property
    def transform(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [4, 4] at rest, relative to the parent, m
        """
class Skin(Deformation):
    """
    Deforming mesh: its vertices follow joints.

    Linear blend skinning: v(t) = sum over joints of weight * skin_from_joint(t) * inverse_bind * v, exact at every time.
    vertices: [V, 3] in m as bound, in the node's frame and in the order of the vertices the mesh was made from
    joints: list [J] of Joint, parents first
    weights: [V, J], or [V, K] with joint_indices; >= 0, and each row adds up to 1 (less than 1e-4 off is scaled)
    joint_indices: [V, K] which joint each weight is of; None: column j of weights is joint j
    shape: MorphTargets or VertexSequence that replaces v at each time before the joints move it; None: none
    Raises TypeError or ValueError naming the argument.
    """
    def __eq__(self, other: object) -> bool:
        """
        Whether the other one is made of the same values.
        """
    def __getstate__(self) -> typing.Any:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, vertices: ArrayLike, joints: typing.Sequence[Joint], weights: ArrayLike, joint_indices: ArrayLike | None = None, shape: Deformation | None = None) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: typing.Any) -> None:
        ...
    def joint_transforms(self, time: float) -> numpy.typing.NDArray[numpy.float64]:
        """
        What moves the vertices that follow one joint alone: skin_from_joint(time) * inverse_bind.

        time: s. Returns [J, 4, 4], translations in m. Raises ValueError outside `span`.
        """
    def parts(self, mesh: Mesh) -> list[tuple[str, Mesh]]:
        """
        The regions of a skinned mesh: triangles by dominant joint.

        mesh: a Mesh made from as many vertices [V] as the skin has
        Returns a list of (name of joint, Mesh) of those joints that dominate any triangle; all are parts of `mesh`.
        Raises ValueError for another number of vertices.
        """
    def replace(self, *, vertices: ArrayLike = ..., joints: typing.Sequence[Joint] = ..., weights: ArrayLike = ..., joint_indices: ArrayLike | None = ..., shape: Deformation | None = ...) -> Skin:
        """
        A copy with other values of some arguments.

        changes: arguments of the constructor, by name
        Raises TypeError or ValueError as the constructor does.
        """
    @property
    def joint_indices(self) -> numpy.typing.NDArray[numpy.uint32]:
        """
        [V, K] joint of each weight
        """
    @property
    def joints(self) -> list[Joint]:
        """
        list [J] of Joint, each with its inverse_bind
        """
    @property
    def shape(self) -> Deformation:
        """
        the Deformation before the joints move it, or None
        """
    @property
    def vertices(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [V, 3] in m, as bound
        """
    @property
    def weights(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [V, K], K the most joints that a vertex follows; filled up with 0
        """
class ChirpSequence:
    """
    A frame of linear chirps, which rise or fall.

    start_frequency: Hz, at the first sample
    bandwidth: Hz, swept by the samples of a chirp; negative where chirps fall, from start_frequency down
    num_samples: of a chirp; 1: a radar that tells no ranges apart, whose one cell, c / (2 |bandwidth|), is as far as it hears
    sampling_rate: Hz
    num_chirps: per transmitter
    chirp_interval: s between neighbouring slots, at least num_samples / sampling_rate
    real: real IF samples instead of complex ones
    extra_idle: s, 0 or more, by which the slot after this one begins later: slot i takes entry i modulo their number (staggered
        pulse repetition); () for none
    frequency_steps: Hz added to the start frequency of a slot, likewise (frequency hopping)
    bandwidth_steps: Hz added to the bandwidth of a slot, likewise; all rise or all fall, and maps keep the axes of the waveform
        without steps
    Raises TypeError or ValueError naming the argument, for a start_frequency below 1 MHz, too. Warns (RuntimeWarning) of a
    bandwidth above start_frequency or below 5 kHz and of a chirp_interval above 1 s, which look like other units.
    """
    def __eq__(self, other: object) -> bool:
        """
        Whether the other one is made of the same values.
        """
    def __getstate__(self) -> typing.Any:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, start_frequency: float = 77000000000.0, bandwidth: float = 1000000000.0, num_samples: int = 512, sampling_rate: float = 20000000.0, num_chirps: int = 128, chirp_interval: float = 6e-05, real: bool = False, extra_idle: ArrayLike = (), frequency_steps: ArrayLike = (), bandwidth_steps: ArrayLike = ()) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: typing.Any) -> None:
        ...
    def max_velocity(self, num_slots: int = 1) -> float:
        """
        m/s, unambiguous up to +- this, when `num_slots` transmitters take turns. Raises TypeError or ValueError naming the argument.
        """
    def replace(self, *, start_frequency: float = ..., bandwidth: float = ..., num_samples: int = ..., sampling_rate: float = ..., num_chirps: int = ..., chirp_interval: float = ..., real: bool = ..., extra_idle: ArrayLike = ..., frequency_steps: ArrayLike = ..., bandwidth_steps: ArrayLike = ...) -> ChirpSequence:
        """
        A copy with other values of some arguments.

        changes: arguments of the constructor, by name
        Raises TypeError or ValueError as the constructor does.
        """
    def slot_start(self, slot: int) -> float:
        """
        When a slot begins.

        slot: index, 0 or more
        Returns s after the start of the first slot. Raises TypeError or ValueError naming the argument.
        """
    def velocity_resolution(self, num_slots: int = 1) -> float:
        """
        m/s, when `num_slots` transmitters take turns. Raises TypeError or ValueError naming the argument.
        """
    @property
    def band(self) -> tuple[float, float]:
        """
        (lowest, highest) Hz, of all chirps with their steps
        """
    @property
    def bandwidth(self) -> float:
        """
        Hz, sampled, negative where chirps fall
        """
    @property
    def bandwidth_steps(self) -> tuple[float, ...]:
        """
        Hz, of each slot, repeated
        """
    @property
    def centre_frequency(self) -> float:
        """
        Hz
        """
    @property
    def chirp_duration(self) -> float:
        """
        s, sampled
        """
    @property
    def chirp_interval(self) -> float:
        """
        s, between neighbouring slots
        """
    @property
    def extra_idle(self) -> tuple[float, ...]:
        """
        s, after each slot, repeated
        """
    @property
    def falls(self) -> bool:
        """
        whether chirps fall, with a negative bandwidth
        """
    @property
    def frequency_steps(self) -> tuple[float, ...]:
        """
        Hz, of each slot, repeated
        """
    @property
    def max_range(self) -> float:
        """
        m, unambiguous
        """
    @property
    def mean_interval(self) -> float:
        """
        s, between neighbouring slots in the mean
        """
    @property
    def num_chirps(self) -> int:
        """
        per transmitter
        """
    @property
    def num_samples(self) -> int:
        """
        of a chirp
        """
    @property
    def range_resolution(self) -> float:
        """
        m, c / (2 |bandwidth|)
        """
    @property
    def real(self) -> bool:
        """
        whether samples are real
        """
    @property
    def sampling_rate(self) -> float:
        """
        Hz
        """
    @property
    def slope(self) -> float:
        """
        Hz/s, negative where chirps fall
        """
    @property
    def start_frequency(self) -> float:
        """
        Hz, at the first sample
        """
    @property
    def wavelength(self) -> float:
        """
        m, at the centre frequency
        """
    @property
    def window_centre(self) -> float:
        """
        s from the first sample to the middle
        """
class AntennaPattern:
    """
    Power gain over direction; made by Isotropic, CosinePower, GaussianBeam or GainTable.
    """
    def __eq__(self, other: object) -> bool:
        """
        Whether the other one is made of the same values.
        """
    def __getstate__(self) -> typing.Any:
        ...
    def __hash__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: typing.Any) -> None:
        ...
    def field(self, directions: ArrayLike) -> numpy.typing.NDArray[numpy.complex128]:
        """
        sqrt(gain) e^{j phase} [N], complex, toward unit directions [N, 3] in the antenna's frame. Raises TypeError or ValueError naming the argument.
        """
    def gain(self, cos_boresight: float) -> float:
        """
        Linear power gain where cos_boresight is the cosine of the angle from the boresight, from -1 to 1. A table raises ValueError.
        """
    def replace(self, **kwargs: object) -> AntennaPattern:
        """
        A copy with other values of some arguments.

        changes: arguments of the constructor, by name
        Raises TypeError or ValueError as the constructor does.
        """
    @property
    def azimuth(self) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        [A] rad of a table, else None
        """
    @property
    def efficiency(self) -> float:
        """
        integral of the gain over the sphere / 4 pi; at most 1 for a power gain
        """
    @property
    def elevation(self) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        [E] rad of a table, else None
        """
    @property
    def exponent(self) -> float:
        """
        of the cosine; 0 when isotropic
        """
    @property
    def kind(self) -> str:
        """
        "isotropic", "cosine_power" or "table"
        """
    @property
    def peak_gain(self) -> float:
        """
        linear; of a table its largest sample
        """
    @property
    def table_gain(self) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        [E, A] linear power gain of a table, else None
        """
    @property
    def table_phase(self) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        [E, A] rad of a table with phases, else None
        """
class Antenna:
    """
    One element of a radar.

    position: [3] m, in the radar's frame
    yaw: rad about the radar's z, left positive, as in scene.add: where the boresight points, +x of the antenna's frame
    pitch: rad, -pi/2 to pi/2, up positive: then about the antenna's own +y, which stays level
    orientation: [4] unit quaternion (w, x, y, z), radar from antenna, instead of yaw and pitch, for antennas that are rolled, too
    pattern: Isotropic(gain), CosinePower(exponent, peak_gain), GaussianBeam(...), GainTable(...) or load_antenna(path); None is
        Isotropic(1)
    polarization: [3] unit vector in the antenna's frame
    Antennas of equal arguments are equal, and pickle.
    Raises ValueError or TypeError naming the argument. Warns (RuntimeWarning) of a yaw beyond a turn, which looks like degrees.
    """
    def __eq__(self, other: object) -> bool:
        """
        Whether the other one is made of the same values.
        """
    def __getstate__(self) -> typing.Any:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, position: ArrayLike = (0.0, 0.0, 0.0), *, yaw: float = 0.0, pitch: float = 0.0, orientation: ArrayLike | None = None, pattern: AntennaPattern | None = None, polarization: ArrayLike = (0.0, 0.0, 1.0)) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: typing.Any) -> None:
        ...
    def replace(self, *, position: ArrayLike = ..., yaw: float = ..., pitch: float = ..., orientation: ArrayLike | None = ..., pattern: AntennaPattern | None = ..., polarization: ArrayLike = ...) -> Antenna:
        """
        A copy with some arguments of the constructor changed.

        changes: keywords of Antenna; yaw or pitch alone keep the other one
        Returns an Antenna. Raises what Antenna raises, and ValueError for yaw and pitch of an antenna that is rolled.
        """
    @property
    def orientation(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [4] (w, x, y, z), radar from antenna
        """
    @property
    def pattern(self) -> AntennaPattern:
        """
        AntennaPattern
        """
    @property
    def pitch(self) -> float:
        """
        rad, of the boresight in the radar's frame, up positive
        """
    @property
    def polarization(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [3], unit, in the antenna's frame
        """
    @property
    def position(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [3] m, in the radar's frame
        """
    @property
    def yaw(self) -> float:
        """
        rad, of the boresight in the radar's frame, left positive
        """
class Radar:
    """
    Waveform, antennas, and where the radar that carries them is.

    waveform: ChirpSequence
    transmitters, receivers: Antenna, at least one each, placed in the radar's frame: x ahead, y left, z up
    position: [3] m, in the world: the origin of the radar's frame
    yaw: rad about the world's z, left positive, as in scene.add: yaw = pi / 2 looks along +y
    pitch: rad, -pi/2 to pi/2, up positive: then about the radar's own +y, which stays level. The radar's +x becomes
        (cos pitch cos yaw, cos pitch sin yaw, sin pitch) in the world.
    motion: Motion of the placed radar, or None at rest. Its axes are the world's, wherever the radar looks, as those of what
        scene.add places at the root are: at time t a point p of the radar's frame is at position + translation(t) +
        rotation(t) R_z(yaw) R_y(-pitch) p.
    speed: m/s ahead, instead of a motion: level, along (cos yaw, sin yaw, 0), negative backwards; `motion` is then the
        LinearMotion of that velocity, which a later change of yaw leaves as it is
    transmit_power: W per transmitter
    noise_figure_db: dB, single sideband
    multiplexing: "tdm": transmitters take turns, one slot each. With the others all send in every slot, and `synthesize` gives
        what a receiver has, [1, rx, slots, sample], until `demultiplex` takes it apart: "bpm": signs of a Hadamard matrix over
        num_slots slots, which make one of the num_chirps; "ddm": transmitter m turns by m / (transmitters + empty_slots) of a
        cycle from chirp to chirp; "cdm": by code_phases
    empty_slots: of "ddm", at least 1: shares of the Doppler axis to which no transmitter is moved, which tell velocities apart;
        num_chirps must be a multiple of transmitters + empty_slots
    code_phases: of "cdm", [tx, slots] rad: transmitter m turns by code_phases[m, i] in slot i, repeated
    receiver: Receiver, the faults of the front end and the converter that follow the ideal signal, or None
    Angles that are estimated count in the radar's axes. Radars of equal arguments are equal, and pickle.
    Raises ValueError or TypeError naming the argument, for a speed of light or more, too. Warns (RuntimeWarning) of a yaw beyond
    a turn, which looks like degrees.
    """
    def __eq__(self, other: object) -> bool:
        """
        Whether the other one is made of the same values.
        """
    def __getstate__(self) -> typing.Any:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, waveform: ChirpSequence, *, transmitters: typing.Sequence[Antenna], receivers: typing.Sequence[Antenna], position: ArrayLike = (0.0, 0.0, 0.0), yaw: float = 0.0, pitch: float = 0.0, motion: Motion | None = None, speed: float | None = None, transmit_power: float = 0.01, noise_figure_db: float = 12.0, multiplexing: Literal['tdm', 'bpm', 'ddm', 'cdm'] = 'tdm', empty_slots: int = 1, code_phases: ArrayLike | None = None, receiver: Receiver | None = None) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: typing.Any) -> None:
        ...
    def _repr_html_(self) -> str:
        """
        A table for notebooks.
        """
    def chirp_time(self, tx: int, chirp: int) -> float:
        """
        Time of the middle of a chirp.

        tx, chirp: indices of the transmitter and of its chirp
        Returns s after the frame's start. Raises IndexError.
        """
    def middle_of_frame(self, start_time: float = 0.0) -> float:
        """
        When the rays of a frame see the scene.

        start_time: s, of the frame. Returns its middle in s. Raises TypeError or ValueError unless that is a finite number.
        """
    def replace(self, *, waveform: ChirpSequence = ..., transmitters: typing.Sequence[Antenna] = ..., receivers: typing.Sequence[Antenna] = ..., position: ArrayLike = ..., yaw: float = ..., pitch: float = ..., motion: Motion | None = ..., speed: float | None = ..., transmit_power: float = ..., noise_figure_db: float = ..., multiplexing: Literal['tdm', 'bpm', 'ddm', 'cdm'] = ..., empty_slots: int = ..., code_phases: ArrayLike | None = ..., receiver: Receiver | None = ...) -> Radar:
        """
        A copy with some arguments of the constructor changed.

        changes: keywords of Radar; a speed takes the place of the motion
        Returns a Radar. Raises what Radar raises.
        """
    def world_from_radar(self, time: float) -> numpy.typing.NDArray[numpy.float64]:
        """
        Where the radar's frame is in the world.

        time: s
        Returns [4, 4], translation in m. Raises ValueError where `motion` is not defined.
        """
    @property
    def code_phases(self) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        [tx, slots] rad of "cdm", or None
        """
    @property
    def empty_slots(self) -> int:
        """
        of "ddm": shares of the Doppler axis without a transmitter
        """
    @property
    def frame_duration(self) -> float:
        """
        s, from the first sample to the last
        """
    @property
    def is_moving(self) -> bool:
        """
        Whether it has a motion that moves it: one of 0 m/s does not
        """
    @property
    def motion(self) -> Motion | None:
        """
        Motion of the placed radar in world axes, or None
        """
    @property
    def multiplexing(self) -> str:
        """
        "tdm", "bpm", "ddm" or "cdm"
        """
    @property
    def noise_figure_db(self) -> float:
        """
        dB, single sideband
        """
    @property
    def num_slots(self) -> int:
        """
        slots that make one of the num_chirps: of "tdm" one per transmitter, of "bpm" the length of its code, else 1
        """
    @property
    def pitch(self) -> float:
        """
        rad, up positive, without `motion`
        """
    @property
    def position(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [3] m, in the world, without `motion`
        """
    @property
    def receiver(self) -> Receiver | None:
        """
        Receiver, or None
        """
    @property
    def receivers(self) -> list[Antenna]:
        """
        list of Antenna, a copy
        """
    @property
    def transmit_power(self) -> float:
        """
        W per transmitter
        """
    @property
    def transmitters(self) -> list[Antenna]:
        """
        list of Antenna, a copy
        """
    @property
    def waveform(self) -> ChirpSequence:
        """
        ChirpSequence
        """
    @property
    def yaw(self) -> float:
        """
        rad, left positive, without `motion`
        """
class RangeDoppler:
    """
    Range-Doppler maps with their axes; made by range_doppler.
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __eq__(self, arg0: object) -> bool:
        ...
    def __getstate__(self) -> dict[typing.Any, typing.Any]:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: dict[typing.Any, typing.Any]) -> None:
        ...
    def _repr_html_(self) -> str:
        """
        A table for notebooks.
        """
    def plot(self, *, ax: Axes | None = None, vmin: float | None = None, vmax: float | None = None, title: str = 'Received power by range and radial velocity') -> Axes:
        """
        Draws the map, the mean over the channels, cropped to where there is signal.

        ax: Matplotlib axes to draw in, None: new ones; title: what stands above the map
        vmin, vmax: ends of the colour scale in dBm, None: from the noise, or 70 dB below the peak, to the peak
        Returns the axes: range in m across, radial velocity in m/s up (receding positive). Raises TypeError or
        ValueError naming the argument.
        """
    def to_xarray(self) -> DataArray:
        """
        The map as an xarray.DataArray, without a copy: complex values in sqrt(W).

        Axes: tx, rx, velocity (m/s, receding positive) and range (m).

        Units stand in `attrs["units"]` of values and coordinates. Needs xarray, raises ModuleNotFoundError without it.
        """
    @property
    def is_tdm_compensated(self) -> bool:
        """
        whether compensate_tdm took out the phase between transmit slots
        """
    @property
    def range(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [range] in m, ascending from 0
        """
    @property
    def values(self) -> numpy.typing.NDArray[numpy.complex128]:
        """
        [tx, rx, velocity, range] complex in sqrt(W), read-only
        """
    @property
    def velocity(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [velocity] in m/s, ascending, receding positive
        """
    @property
    def window(self) -> str | tuple[str, float] | tuple[str | tuple[str, float], str | tuple[str, float]]:
        """
        as range_doppler takes it: a name or ("chebyshev", "taylor" or "kaiser", sidelobe level in dB) of both axes, or those of (range, velocity)
        """
    @property
    def zero_pad(self) -> int:
        """
        of both axes
        """
class VirtualArray:
    """
    Where the channels of a radar lie as one array; made by virtual_array.

    Elements are ordered by row and column of their grid. A grid's rows count up and its columns count up to the left, as far
    as the array's plane allows.
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __eq__(self, arg0: object) -> bool:
        ...
    def __getstate__(self) -> dict[typing.Any, typing.Any]:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: dict[typing.Any, typing.Any]) -> None:
        ...
    def default_angles(self, largest_step: float = 0.017453292519943295) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        (azimuth [A], elevation [E]) in rad: the directions that the array tells apart.

        Azimuths up to +-90 degrees about the direction across the array on the side of the antennas' boresights, and elevations up to
        +-45 degrees, within the unambiguous field of its grid, in steps of a quarter of wavelength / extent, or of largest_step in rad
        where that is less; one alone where it tells none apart. Azimuths of antennas that look behind go on beyond pi. Raises TypeError
        or ValueError naming the argument, or the angle of which there would be more than 200,000.
        """
    @property
    def boresight(self) -> float:
        """
        rad, mean azimuth of the antennas' boresights in the radar's frame; 0 where they look to all sides
        """
    @property
    def centre(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [3] m, mean of the elements
        """
    @property
    def element_of_channel(self) -> numpy.typing.NDArray[numpy.int64]:
        """
        [tx, rx] index into elements
        """
    @property
    def elements(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [N, 3] m, the positions that differ by 0.01 wavelengths or more
        """
    @property
    def gaps(self) -> numpy.typing.NDArray[numpy.int64]:
        """
        [G, 2] rows and columns of the grid without an element
        """
    @property
    def grid_axes(self) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        [2, 3] unit vectors along which rows and columns count up, or None
        """
    @property
    def grid_deviation(self) -> float | None:
        """
        m, largest distance of an element from its point of the grid, or None
        """
    @property
    def grid_index(self) -> numpy.typing.NDArray[numpy.int64] | None:
        """
        [N, 2] row and column of each element, or None
        """
    @property
    def grid_shape(self) -> tuple[int, int] | None:
        """
        (rows, columns) of the grid of equal steps, or None
        """
    @property
    def grid_spacing(self) -> tuple[float, float] | None:
        """
        (row, column) step in m, 0 where there is one, or None
        """
    @property
    def has_default_azimuths(self) -> bool:
        """
        whether `default_angles` has azimuths: no more than 200,000 differ
        """
    @property
    def num_overlaps(self) -> int:
        """
        channels beyond the first of each element
        """
    @property
    def num_receivers(self) -> int:
        """
        receivers of the radar
        """
    @property
    def num_transmitters(self) -> int:
        """
        transmitters of the radar
        """
    @property
    def positions(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [tx, rx, 3] m, sums of the antennas' positions
        """
    @property
    def tells_azimuths(self) -> bool:
        """
        whether azimuths differ: it has a horizontal extent of 0.1 wavelengths or more, and is no upright line
        """
    @property
    def tells_elevations(self) -> bool:
        """
        whether elevations differ: it has a vertical extent of 0.1 wavelengths or more, and is no line that is more level than upright
        """
    @property
    def wavelength(self) -> float:
        """
        m, at the centre frequency
        """
class CfarResult:
    """
    Cells of a range-Doppler map that exceed their thresholds; made by cfar.
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __eq__(self, arg0: object) -> bool:
        ...
    def __getstate__(self) -> dict[typing.Any, typing.Any]:
        ...
    def __len__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: dict[typing.Any, typing.Any]) -> None:
        ...
    @property
    def cells(self) -> numpy.typing.NDArray[numpy.int64]:
        """
        [D, 2] (velocity, range) indices of the cells found, ascending
        """
    @property
    def factor(self) -> float:
        """
        power over noise, linear, from which a cell away from the ends of the range axis is found, in a beam where these are
        """
    @property
    def false_alarm_rate(self) -> float:
        """
        of one cell
        """
    @property
    def guard(self) -> tuple[int, int]:
        """
        half widths along (velocity, range) in cells
        """
    @property
    def mask(self) -> numpy.typing.NDArray[numpy.bool]:
        """
        [velocity, range] bool, true in the cells found
        """
    @property
    def method(self) -> str:
        """
        "ca", "os", "go" or "so"
        """
    @property
    def noise(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [D] W, mean power of the noise about each cell found, as its training cells tell it
        """
    @property
    def num_beams(self) -> int:
        """
        in which each cell was tested, 0: its channels were summed
        """
    @property
    def power(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [velocity, range] W, mean over channels; with beams that of the strongest
        """
    @property
    def training(self) -> tuple[int, int]:
        """
        cells beyond the guard cells on each side, along (velocity, range)
        """
class AngleSpectrum:
    """
    Angle spectra with their axes; made by angle_fft.

    Axes are direction cosines along the columns and rows of the array's grid: for antennas in the y-z plane
    sin(azimuth) cos(elevation) and sin(elevation).
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __eq__(self, arg0: object) -> bool:
        ...
    def __getstate__(self) -> dict[typing.Any, typing.Any]:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: dict[typing.Any, typing.Any]) -> None:
        ...
    def plot(self, range: float | None = None, velocity: float | None = None, *, ax: Axes | None = None, title: str = 'Received power by direction') -> Axes:
        """
        Draws the power by direction in one cell of the map: a curve, or a map where the array is a plane.

        range: m, velocity: m/s, of the cell, the nearest is taken; None: those of the strongest cell
        ax: Matplotlib axes to draw in, None: new ones; title: what stands above, the cell is added
        Returns the axes: azimuth in degrees across (left positive); up power in dBm, or elevation in degrees. Raises TypeError or ValueError
        naming the argument, and for a map of several cells without range and velocity.
        """
    def to_xarray(self) -> DataArray:
        """
        The spectra as an xarray.DataArray, without a copy: complex values in sqrt(W).

        Axes: sin_elevation, sin_azimuth (direction cosines, 1), velocity (m/s, receding positive) and range (m).

        Units stand in `attrs["units"]` of values and coordinates. Needs xarray, raises ModuleNotFoundError without it.
        """
    @property
    def azimuth(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [azimuth] rad at elevation 0, arcsin of sin_azimuth; NaN beyond +-1
        """
    @property
    def elevation(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [elevation] rad, arcsin of sin_elevation; NaN beyond +-1
        """
    @property
    def range(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [range] m
        """
    @property
    def sin_azimuth(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [azimuth] ascending, left positive
        """
    @property
    def sin_elevation(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [elevation] ascending, up positive
        """
    @property
    def values(self) -> numpy.typing.NDArray[numpy.complex128]:
        """
        [elevation, azimuth, velocity, range] complex in sqrt(W), read-only; phase as at the array's centre
        """
    @property
    def velocity(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [velocity] m/s, receding positive
        """
class BeamPower:
    """
    Power of beams with their axes; made by beamform.
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __eq__(self, arg0: object) -> bool:
        ...
    def __getstate__(self) -> dict[typing.Any, typing.Any]:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: dict[typing.Any, typing.Any]) -> None:
        ...
    @property
    def azimuth(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [azimuth] rad, left positive
        """
    @property
    def elevation(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [elevation] rad, up positive
        """
    @property
    def power(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [elevation, azimuth, velocity, range] in W, read-only; of cells [elevation, azimuth, cell]
        """
    @property
    def range(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [range] m, or [cell]
        """
    @property
    def velocity(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [velocity] m/s, or [cell]
        """
class RangeAzimuth:
    """
    A range-azimuth map with its axes; made by range_azimuth.
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __eq__(self, arg0: object) -> bool:
        ...
    def __getstate__(self) -> dict[typing.Any, typing.Any]:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: dict[typing.Any, typing.Any]) -> None:
        ...
    def plot(self, *, ax: Axes | None = None, vmin: float | None = None, vmax: float | None = None, title: str = 'Received power from above') -> Axes:
        """
        Draws the map as a sector seen from above, the radar below, cropped to where there is signal.

        ax: Matplotlib axes to draw in, None: new ones; title: what stands above the map
        vmin, vmax: ends of the colour scale in dBm, None: from the noise, or 70 dB below the peak, to the peak
        Returns the axes: metres to the left across (right negative), metres ahead up, in the radar's frame. Raises
        TypeError or ValueError naming the argument.
        """
    def to_xarray(self) -> DataArray:
        """
        The map as an xarray.DataArray, without a copy: power in W.

        Axes: azimuth (rad, left positive) and range (m); attributes elevation (rad, of the beams) and velocity (m/s, of the cells, where
        only some were taken).

        Units stand in `attrs["units"]` of values and coordinates. Needs xarray, raises ModuleNotFoundError without it.
        """
    @property
    def azimuth(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [azimuth] rad, ascending, left positive
        """
    @property
    def elevation(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [elevation] rad, of the beams
        """
    @property
    def power(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [azimuth, range] in W, read-only: the largest over elevation
        """
    @property
    def range(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [range] m
        """
    @property
    def velocity(self) -> float | None:
        """
        m/s, of the cells taken; None: all velocities together
        """
class AngleEstimates:
    """
    Directions of echoes, arrays over all peaks; made by estimate_angles.
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __eq__(self, arg0: object) -> bool:
        ...
    def __getstate__(self) -> dict[typing.Any, typing.Any]:
        ...
    def __len__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: dict[typing.Any, typing.Any]) -> None:
        ...
    @property
    def azimuth(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [M] rad, left positive
        """
    @property
    def cell(self) -> numpy.typing.NDArray[numpy.int64]:
        """
        [M] index into the cells given, ascending; the strongest peak of a cell first
        """
    @property
    def elevation(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [M] rad, up positive
        """
    @property
    def points(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [M, 3] m, in the radar's frame
        """
    @property
    def power(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [M] W
        """
    @property
    def range(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [M] m, of the cell
        """
    @property
    def velocity(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [M] m/s, of the cell and its fold
        """
class Selection:
    """
    Which paths are meant: path expressions joined by & | ~.

    text: path expressions, and power > 1e-15 (W, at the trace time for the first antennas; also < <= >=), joined by
        ~ (not, binds tightest), & (and), | (or) and parentheses. A path expression is a regular expression over the hits of a
        path between T and R. A hit is . (any), 'glob' (a mesh, by its full name or that of a group above it), S, D or E (specular,
        diffuse, a point on a sharp edge), S'glob', ['a*' 'b'] or [^ 'a*']; operators are * + ? | ( ) {m,n}.
        Instead, another Selection to copy.
    Text stands wherever a Selection is asked for. Raises ValueError with a caret under the fault; matching raises one when a glob
    takes no mesh of the scene.
    """
    def __and__(self, arg0: Selection | str) -> Selection:
        ...
    def __bool__(self) -> bool:
        ...
    def __eq__(self, arg0: object) -> bool:
        ...
    def __getstate__(self) -> str:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, text: Selection | str) -> None:
        ...
    def __invert__(self) -> Selection:
        ...
    def __or__(self, arg0: Selection | str) -> Selection:
        ...
    def __rand__(self, arg0: Selection | str) -> Selection:
        ...
    def __repr__(self) -> str:
        ...
    def __ror__(self, arg0: Selection | str) -> Selection:
        ...
    def __setstate__(self, arg0: str) -> None:
        ...
    def __str__(self) -> str:
        ...
    def check(self, scene: Scene) -> None:
        """
        Raises ValueError naming near meshes where a glob takes no mesh of `scene`: to know before a long trace.
        """
    def matches(self, paths: Paths) -> numpy.typing.NDArray[numpy.bool]:
        """
        Bool [P]: which of the paths are selected. Raises TypeError naming the argument, ValueError for names that no mesh has.
        """
    @property
    def text(self) -> str:
        """
        as written; joined ones as (T . R) & ~(T . . R)
        """
class Power:
    """
    The power of a path in W, at the trace time for the first antennas of the radar that traced.

    ep.power > 1e-15 is a Selection; `paths.power` has the values.
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __bool__(self) -> bool:
        ...
    def __eq__(self, arg0: object) -> bool:
        ...
    def __ge__(self, arg0: float) -> Selection:
        ...
    def __gt__(self, arg0: float) -> Selection:
        ...
    def __le__(self, arg0: float) -> Selection:
        ...
    def __lt__(self, arg0: float) -> Selection:
        ...
    def __ne__(self, arg0: object) -> bool:
        ...
    def __reduce__(self) -> str:
        ...
    def __repr__(self) -> str:
        ...
class NumBounces:
    """
    The number of hits of a path: ep.num_bounces >= 2 is a Selection.
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __bool__(self) -> bool:
        ...
    def __eq__(self, arg0: object) -> Selection:  # type: ignore[override]
        ...
    def __ge__(self, arg0: int) -> Selection:
        ...
    def __gt__(self, arg0: int) -> Selection:
        ...
    def __le__(self, arg0: int) -> Selection:
        ...
    def __lt__(self, arg0: int) -> Selection:
        ...
    def __ne__(self, arg0: object) -> Selection:  # type: ignore[override]
        ...
    def __reduce__(self) -> str:
        ...
    def __repr__(self) -> str:
        ...
class Stratum:
    """
    One launch stratum: directions in a cone, or in a strip along a great circle (half_azimuth > 0), rays evenly over them. Raises TypeError or ValueError naming the argument.
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __eq__(self, arg0: object) -> bool:
        ...
    def __getstate__(self) -> dict[typing.Any, typing.Any]:
        ...
    def __init__(self, *, axis: ArrayLike, versine: float, across: ArrayLike = (0.0, 0.0, 0.0), half_azimuth: float = 0.0, low: float = 0.0, high: float = 0.0, num_rays: int, ray_density: float, name: str, object: int = -1, num_mirrors: int = 0, focus_of: int = -1) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: dict[typing.Any, typing.Any]) -> None:
        ...
    @property
    def across(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [3] unit, world axes, along the great circle of a strip; zeros of a cone
        """
    @property
    def axis(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [3] unit, world axes
        """
    @property
    def focus_of(self) -> int:
        """
        index of the stratum of which it takes over a part, with rays that lie closer; -1: none
        """
    @property
    def half_azimuth(self) -> float:
        """
        rad along the great circle on both sides of the axis; 0 of a cone
        """
    @property
    def high(self) -> float:
        """
        largest sine of the elevation
        """
    @property
    def low(self) -> float:
        """
        least sine of the elevation over the great circle, toward axis x across
        """
    @property
    def name(self) -> str:
        """
        what it aims at
        """
    @property
    def num_mirrors(self) -> int:
        """
        over which it aims there
        """
    @property
    def num_rays(self) -> int:
        """
        launched in it
        """
    @property
    def object(self) -> int:
        """
        index of the scene's node that it aims at; -1: none
        """
    @property
    def ray_density(self) -> float:
        """
        rays per sr
        """
    @property
    def solid_angle(self) -> float:
        """
        sr
        """
    @property
    def versine(self) -> float:
        """
        1 - cos of the half angle of a cone; 2 is the whole sphere
        """
class TraceStatistics:
    """
    What a trace did. Raises TypeError or ValueError naming the argument.
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __eq__(self, arg0: object) -> bool:
        ...
    def __getstate__(self) -> dict[typing.Any, typing.Any]:
        ...
    def __init__(self, *, num_rays: int = 0, num_queries: int = 0, num_hits: int = 0, num_paths: int = 0, num_near_antenna: int = 0, num_grazing: int = 0, num_small_mirrors: int = 0, num_false_hits: int = 0, num_unaimed: int = 0, num_unfollowed_frusta: int = 0, num_unsplit_rays: int = 0, num_stopped_passes: int = 0, num_faint_paths: int = 0) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: dict[typing.Any, typing.Any]) -> None:
        ...
    @property
    def num_faint_paths(self) -> int:
        """
        left out by lot, because others count for them
        """
    @property
    def num_false_hits(self) -> int:
        """
        not confirmed in double precision
        """
    @property
    def num_grazing(self) -> int:
        """
        dropped: cosine of incidence below 1e-3
        """
    @property
    def num_hits(self) -> int:
        """
        surface points found
        """
    @property
    def num_near_antenna(self) -> int:
        """
        dropped: within 1 mm of an antenna
        """
    @property
    def num_paths(self) -> int:
        """
        recorded; selections have fewer
        """
    @property
    def num_queries(self) -> int:
        """
        closest-hit and shadow queries
        """
    @property
    def num_rays(self) -> int:
        """
        launched
        """
    @property
    def num_small_mirrors(self) -> int:
        """
        rays without a field ended behind an unflagged mirror of less than half its Fresnel zone
        """
    @property
    def num_stopped_passes(self) -> int:
        """
        legs that are taken to end at a sheet, behind 64 others
        """
    @property
    def num_unaimed(self) -> int:
        """
        objects and images without a stratum, because there are too many of them
        """
    @property
    def num_unfollowed_frusta(self) -> int:
        """
        sequences of mirrors whose further mirrors were not looked for, for want of memory
        """
    @property
    def num_unsplit_rays(self) -> int:
        """
        rays that only went on at a sheet, because they had split at too many before
        """
class TraceFrame:
    """
    What amplitudes and lengths of paths are relative to. Raises TypeError or ValueError naming the argument.
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __eq__(self, arg0: object) -> bool:
        ...
    def __getstate__(self) -> dict[typing.Any, typing.Any]:
        ...
    def __init__(self, *, start_time: float, trace_time: float, transmitter: ArrayLike, receiver: ArrayLike, strata: typing.Sequence[Stratum], statistics: TraceStatistics, target_error_db: float = 0.0, error_db: float = 0.0, objects_time: float | None = None, seed: int = 1, max_bounces: int = 4, polarization: str = 'scalar', footprint: str = 'second_order', sampler: str = 'lattice', num_batches: int = 1, scatterers: str = 'rays', edges: bool = False, attenuation: float = 0.0, faint_power: float = 0.0) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: dict[typing.Any, typing.Any]) -> None:
        ...
    @property
    def attenuation(self) -> float:
        """
        Np/m of fields in the air, along every path
        """
    @property
    def edges(self) -> bool:
        """
        whether echoes of sharp edges were looked for
        """
    @property
    def error_db(self) -> float:
        """
        dB, the one that was reached, above the target where max_rays did not do; 0: not looked at
        """
    @property
    def faint_power(self) -> float:
        """
        W, below which some of the diffuse paths were kept for all of them; 0: all were
        """
    @property
    def footprint(self) -> str:
        """
        "second_order", "edges", "first_order" or "none"
        """
    @property
    def max_bounces(self) -> int:
        """
        hits of a path at most
        """
    @property
    def num_batches(self) -> int:
        """
        independent parts of the rays
        """
    @property
    def objects_time(self) -> float | None:
        """
        s, when objects are told from what surrounds the antenna: in the first frame of a sequence; None: trace_time
        """
    @property
    def polarization(self) -> str:
        """
        "scalar" or "jones"
        """
    @property
    def receiver(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [3] m, where hits were connected to, world
        """
    @property
    def sampler(self) -> str:
        """
        "lattice", "fibonacci", "r2" or "random"
        """
    @property
    def scatterers(self) -> str:
        """
        "rays" or "surface": what the scatterers of rough surfaces are
        """
    @property
    def seed(self) -> int:
        """
        of directions and random phases
        """
    @property
    def start_time(self) -> float:
        """
        s, first sample of the frame
        """
    @property
    def statistics(self) -> TraceStatistics:
        """
        TraceStatistics
        """
    @property
    def strata(self) -> list[Stratum]:
        """
        list of Stratum
        """
    @property
    def target_error_db(self) -> float:
        """
        dB, error of the received power that was asked for; 0: none
        """
    @property
    def trace_time(self) -> float:
        """
        s, the time that the rays saw
        """
    @property
    def transmitter(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [3] m, where rays started, world
        """
class Paths:
    """
    The record of a trace: what every ray touched. Cannot be changed; its arrays are views.

    Path i has the hits offsets[i] to offsets[i] + num_bounces[i], in order of travel from transmitter to receiver. Paths may
    share hits; selections share all hits of their trace.
    """
    @staticmethod
    def from_arrays(*, hits: ArrayLike, offsets: ArrayLike, num_bounces: ArrayLike, diffuse: ArrayLike, weight: ArrayLike, stratum: ArrayLike, batch: ArrayLike, flags: ArrayLike, curved_cell: ArrayLike | None = None, jones: ArrayLike | None = None, passes: ArrayLike | None = None, pass_offsets: ArrayLike | None = None, scene: Scene, radar: Radar, frame: TraceFrame) -> Paths:
        """
        Paths of arrays as the properties give them.

        hits: [H] structured; offsets, num_bounces, diffuse, weight, stratum, batch, flags: [P]; curved_cell: [P, 7] or None; jones:
        [P, 2, 2] complex or None; passes: [N] structured and pass_offsets: [P + 1], or None
        scene, radar, frame: what they belong to
        Raises ValueError where an index leads nowhere.
        """
    @staticmethod
    def load(path: str | os.PathLike[str]) -> Paths:
        """
        Reads the paths of a frame file at `path`: the same bits that were written. Raises ep.FileError.
        """
    def __getstate__(self) -> dict[typing.Any, typing.Any]:
        ...
    def __len__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: dict[typing.Any, typing.Any]) -> None:
        ...
    def _echoes_at_receivers(self, time: float, tx: int, receivers: typing.Sequence[int]) -> tuple[typing.Any, ...]:
        """
        Lengths and amplitudes of the paths for several receivers, which take little more time than one.

        time: s; tx: index of the transmitter; receivers: indices [R]
        Returns (lengths in m, amplitudes in sqrt(W)), [R, P] each, as `lengths` and `amplitudes` give them. Raises TypeError or
        ValueError naming the argument, also for times outside a motion, and IndexError for antennas that are not there.
        """
    def _echoes_together(self, times: ArrayLike, tx: int, rx: int, begin: int, end: int) -> tuple[typing.Any, ...]:
        """
        Lengths and amplitudes of some paths at several times, which take little more time than one.

        times: [T] s; tx, rx: indices of the transmitter and the receiver; begin, end: of the N paths, by index
        Returns (lengths in m, amplitudes in sqrt(W)), [T, N] each, as `lengths` and `amplitudes` give them but for the rounding of
        amplitudes. Raises TypeError or ValueError naming the argument, also for times outside a motion, and IndexError for antennas that
        are not there.
        """
    def _placed_echoes(self, times: ArrayLike, radars: typing.Sequence[Radar], replay: str = 'material') -> tuple[typing.Any, ...]:
        """
        Echoes of the paths for antennas of which each moves by itself.

        times: [T] s; radars: [T] Radar with as many antennas as that of the paths, where they stand in the world at each time
        replay: as in `synthesize`
        Returns (delays in s, amplitudes in sqrt(W)), [tx, rx, T, P] each. Raises TypeError or ValueError naming the argument, also for
        times outside a motion.
        """
    def _repr_html_(self) -> str:
        """
        A table for notebooks.
        """
    def _select_with_own_hits(self, selection: ArrayLike) -> Paths:
        """
        The paths where a mask, bool [P], is true, with only the hits that they use.
        """
    def amplitudes(self, times: ArrayLike, tx: int = 0, rx: int = 0, replay: Literal['material', 'fermat'] = 'material') -> numpy.typing.NDArray[numpy.complex128]:
        """
        Complex amplitudes of the paths over time.

        times: [T] s; tx, rx: indices of the transmitter and the receiver; replay: as in `synthesize`
        Returns [T, P] in sqrt(W), without the phases of the lengths. Raises TypeError or ValueError naming the argument, also for
        times outside a motion, and IndexError for antennas that are not there.
        """
    def lengths(self, times: ArrayLike, transmitter: int | ArrayLike = 0, receiver: int | ArrayLike = 0, replay: Literal['material', 'fermat'] = 'material') -> numpy.typing.NDArray[numpy.float64]:
        """
        Lengths of the paths over time.

        times: [T] s; transmitter, receiver: indices of antennas, or positions [3] in m in the radar's frame; replay: as in
        `synthesize`
        Returns [T, P] in m. Raises TypeError or ValueError naming the argument, also for times outside a motion, and IndexError for
        antennas that are not there.
        """
    def partition(self, parts: dict[str, Selection | str]) -> dict[str, Paths]:
        """
        The paths of disjoint parts: the first that takes a path has it, the rest is "other".

        parts: {name: selection}
        Returns {name: Paths}. Raises TypeError or ValueError naming the argument, also for names that are empty, "other" or twice.
        """
    def points(self, time: float) -> numpy.typing.NDArray[numpy.float64]:
        """
        Hits [H, 3] in m in the world at `time` in s. Raises TypeError or ValueError naming the argument.
        """
    def save(self, path: str | os.PathLike[str], min_power: float = 0.0) -> LeftOut:
        """
        Writes the paths with their scene and radar to an HDF5 file.

        path: of the file, written whole or not at all; min_power: in W at the trace time for the first antennas, paths
        below it are left out and counted. Returns what was left out. Raises ep.FileError when the file cannot be written.
        """
    def select(self, selection: Selection | str | ArrayLike) -> Paths:
        """
        The paths that a selection takes, over the same hits.

        selection: a Selection, its text, or a mask bool [P] that is true where a path is taken
        Returns Paths. Raises TypeError or ValueError naming the argument, for faults of the text with a caret under them, and for
        names that no mesh has.
        """
    def to_dataframe(self) -> DataFrame:
        """
        A table with a row for each path, as a pandas.DataFrame.

        Columns: bounces (number of hits), meshes (their names in order of travel, "wall > walker/arm"), events (S specular,
        D diffuse, E on an edge, a letter a hit), kind ("coherent" or "diffuse"), object, ghost_type and order (as `families` has them for the
        objects of the scene), length in m and power in W at the trace time for the first antennas, stratum (what its ray was aimed
        at, "" for paths by images), batch (255: of all batches) and is_reversed; units in `attrs["units"]`.
        Needs pandas, raises ModuleNotFoundError without it.
        """
    def to_xarray(self) -> Dataset:
        """
        The record as an xarray.Dataset, without a copy of its arrays.

        Dimensions path [P] and hit [H]; variables offsets, num_bounces, diffuse, weight, stratum, batch, flags, length (m) and
        power (W) at the trace time for the first antennas, [P] each, and mesh_id, triangle_id, u, v [H]; names of the meshes in
        attrs["mesh_names"]. Needs xarray, raises ModuleNotFoundError without it.
        """
    @property
    def amplitude(self) -> numpy.typing.NDArray[numpy.complex128]:
        """
        [P] complex, sqrt(W), at the trace time for the first antennas; without the phase of the length
        """
    @property
    def batch(self) -> numpy.typing.NDArray[numpy.uint8]:
        """
        [P] batch of rays, 255: all of them (image method)
        """
    @property
    def curved_cell(self) -> numpy.typing.NDArray[numpy.float32]:
        """
        [P, 7] or [0, 7]: launch cells behind curved specular bounces (record/paths.h); zeros on flat chains
        """
    @property
    def diffuse(self) -> numpy.typing.NDArray[numpy.uint64]:
        """
        [P] bit k: hit k is diffuse; 0: coherent
        """
    @property
    def effects(self) -> list[Effect]:
        """
        list of Effect: what the trace modelled, what not, and why
        """
    @property
    def flags(self) -> numpy.typing.NDArray[numpy.uint32]:
        """
        [P] bits: 1, recorded as the reversal of another path; 2, of the second half of the rays; 4, with points on 1 + (flags >> 3 & 3) edges: hit flags >> 8 & 63 is the first, for one of flags >> 16 pieces of it; 32, beside 4, around an edge to a mirror; 64, diffuse, and counts for others that were left out; 128, an image over unmarked planes beside an edge, which leaves (flags >> 20) / 1024 of the field of endless ones with the phase (flags >> 8 & 4095) / 4096 of a turn. Without 4 and 128, flags >> 8 & 63 is the place of its ray among its neighbours in the lattice: 1 to 63 over and over, 0 not known
        """
    @property
    def frame(self) -> TraceFrame:
        """
        times, antenna positions, strata and settings of the trace
        """
    @property
    def hits(self) -> numpy.typing.NDArray[numpy.void]:
        """
        [H] structured: mesh_id, triangle_id, u, v
        """
    @property
    def jones(self) -> numpy.typing.NDArray[numpy.complex64]:
        """
        [P, 2, 2] or [0, 2, 2] complex: (horizontal, vertical) at the receiver from the same at the transmitter
        """
    @property
    def mesh_id(self) -> numpy.typing.NDArray[numpy.uint32]:
        """
        [H]
        """
    @property
    def num_bounces(self) -> numpy.typing.NDArray[numpy.uint8]:
        """
        [P]
        """
    @property
    def num_hits(self) -> int:
        """
        H, of all paths of the trace
        """
    @property
    def num_paths(self) -> int:
        """
        P, their number
        """
    @property
    def offsets(self) -> numpy.typing.NDArray[numpy.int64]:
        """
        [P] first hit
        """
    @property
    def pass_offsets(self) -> numpy.typing.NDArray[numpy.int64]:
        """
        [P + 1] or [0]: path i has the passes pass_offsets[i] to pass_offsets[i + 1]
        """
    @property
    def passes(self) -> numpy.typing.NDArray[numpy.void]:
        """
        [N] structured: mesh_id, triangle_id, u, v and leg of each pass through a sheet, in order of travel, path by path; leg k ends at hit k, the last one at the receiver
        """
    @property
    def power(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [P] W, |amplitude|^2
        """
    @property
    def radar(self) -> Radar:
        """
        snapshot of the radar
        """
    @property
    def scene(self) -> Scene:
        """
        snapshot of the scene
        """
    @property
    def stratum(self) -> numpy.typing.NDArray[numpy.uint16]:
        """
        [P] index into frame.strata, 65535: image method
        """
    @property
    def triangle_id(self) -> numpy.typing.NDArray[numpy.uint32]:
        """
        [H] triangle within the mesh
        """
    @property
    def u(self) -> numpy.typing.NDArray[numpy.float32]:
        """
        [H] barycentric: p = (1 - u - v) v0 + u v1 + v v2
        """
    @property
    def v(self) -> numpy.typing.NDArray[numpy.float32]:
        """
        [H] barycentric
        """
    @property
    def weight(self) -> numpy.typing.NDArray[numpy.complex64]:
        """
        [P] complex, what neither motion nor antennas change
        """
class ReceivedPower:
    """
    Mean received power of a set of paths and how well the rays know it; all powers in W.

    At the trace time, between two antennas, at the start frequency; the mean is over the random phases of diffuse
    hits. [low, high] is the 95 % interval, of bias and chance together: what the footprint filter takes away, told by what
    half the density of rays would take, and the spread of the batches or, of one batch, of the hits. The power is resolved if it
    reaches no further than 0.3 dB to either side. Standard errors come from the batches of a trace (`trace(batches=8)`) alone
    and are NaN for one batch.
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __eq__(self, arg0: object) -> bool:
        ...
    def __getstate__(self) -> dict[typing.Any, typing.Any]:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: dict[typing.Any, typing.Any]) -> None:
        ...
    @property
    def between_rays(self) -> float:
        """
        W, coherent power that launch cells may hold between rays: of points of reflection and of edges
        """
    @property
    def bias(self) -> float:
        """
        W, that finer launch cells may add to the coherent power
        """
    @property
    def bias_of_rays(self) -> float:
        """
        W, the part of it that more rays mend: not what facets that stray from a smooth surface leave open, and edges behind other bounces
        """
    @property
    def chance(self) -> float:
        """
        W, standard error; of one batch estimated from the record
        """
    @property
    def coherent(self) -> float:
        """
        W, |field|^2 of coherent paths; with batches free of bias by noise, which can take it below zero
        """
    @property
    def coherent_error(self) -> float:
        """
        W, standard error
        """
    @property
    def diffuse(self) -> float:
        """
        W, sum over diffuse hits of |field of all paths over that hit|^2
        """
    @property
    def diffuse_error(self) -> float:
        """
        W, standard error
        """
    @property
    def error_db(self) -> float:
        """
        dB, 10 log10(1 + standard_error / power); infinite of one batch, which has no standard error, and where that is more than half the power
        """
    @property
    def field(self) -> complex:
        """
        sqrt(W), sum of the coherent paths as they arrive
        """
    @property
    def half_density_field(self) -> complex:
        """
        sqrt(W), the same through the footprint filter of launch cells sqrt(2) wider
        """
    @property
    def high(self) -> float:
        """
        W, upper end of it
        """
    @property
    def interval_db(self) -> float:
        """
        dB, half the interval, the larger one of its sides; infinite where it reaches down to nothing
        """
    @property
    def low(self) -> float:
        """
        W, lower end of the 95 % interval, of bias and chance together
        """
    @property
    def num_batches(self) -> int:
        """
        independent parts of the rays behind the errors
        """
    @property
    def num_coherent_paths(self) -> int:
        """
        number of coherent paths
        """
    @property
    def num_diffuse_hits(self) -> int:
        """
        number of diffuse hits
        """
    @property
    def power(self) -> float:
        """
        W, coherent + diffuse
        """
    @property
    def resolved(self) -> bool:
        """
        the interval reaches no further than 0.3 dB to either side
        """
    @property
    def standard_error(self) -> float:
        """
        W, of the power
        """
    @property
    def strongest_share(self) -> float:
        """
        share of the diffuse power of its strongest hit
        """
    @property
    def unfiltered(self) -> float:
        """
        W, sum of |a|^2 of the coherent paths without the filter
        """
class KeptGeometry:
    """
    Geometry that goes from one trace of a scene to the next, no part of the public interface.
    """
    def __init__(self) -> None:
        ...
class KeptStillRays:
    """
    Rays of what stands still, for all frames of a scene, no part of the public interface.
    """
    def __init__(self) -> None:
        ...
    def __reduce__(self) -> tuple[type, tuple[typing.Any, ...]]:
        """
        A copy keeps none yet: what it keeps is the same.
        """
class LiveTrace:
    """
    The record of a scene that is changed again and again, no part of the public interface.
    """
    def __init__(self, whole_scenes: bool = False) -> None:
        ...
    def paths(self, progress: typing.Any = None) -> Paths:
        """
        The whole record, Paths.
        """
    def update(self, scene: Scene, radar: Radar, *, num_rays: int, start_time: float, progress: typing.Any = None, seed: int = 1, max_bounces: int = 4, polarization: str = 'scalar', footprint: str = 'second_order', sampler: str = 'lattice', num_batches: int = 1, scatterers: str = 'rays', edges: bool = False, attenuation: float = 0.0, faint_power: float = 0.0) -> dict[typing.Any, typing.Any]:
        """
        What ep.Live calls. Returns is_whole, num_rays_shot, and the Paths removed and added.
        """
class Renewal:
    """
    A record brought up to another time; made by `renew`.
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __eq__(self, arg0: object) -> bool:
        ...
    def __getstate__(self) -> dict[typing.Any, typing.Any]:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: dict[typing.Any, typing.Any]) -> None:
        ...
    @property
    def num_blocked(self) -> int:
        """
        Paths left out because something stands in the way of a leg.
        """
    @property
    def num_lost(self) -> int:
        """
        Paths left out because a point of reflection has left its surface.
        """
    @property
    def num_moved(self) -> int:
        """
        Paths whose points of reflection were found anew.
        """
    @property
    def paths(self) -> Paths:
        """
        Paths that are still there, in their order.
        """
class ValidityShares:
    """
    What one trace does not serve, as shares of the power of some paths.
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __eq__(self, arg0: object) -> bool:
        ...
    def __getstate__(self) -> dict[typing.Any, typing.Any]:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: dict[typing.Any, typing.Any]) -> None:
        ...
    @property
    def beside_edges(self) -> float:
        """
        share: what edges of unmarked planes leave of images over them changes by more than 0.3 of the field
        """
    @property
    def blocked(self) -> float:
        """
        share: something comes in the way
        """
    @property
    def left(self) -> float:
        """
        share: points of reflection that leave the surface around their hit
        """
    @property
    def new_surface(self) -> float:
        """
        share of single echoes of all that is seen: of what was hidden from the trace
        """
    @property
    def power(self) -> float:
        """
        W, what the shares are of
        """
    @property
    def slid(self) -> float:
        """
        share: phase error of points of reflection above 0.3 rad
        """
    @property
    def turned(self) -> float:
        """
        share: a cosine of incidence or departure changes its sign or by more than a factor of two, or an image's coefficient by more than 0.3
        """
class ObjectValidity(ValidityShares):
    """
    What one trace does not serve of an object: of the paths that scattered on it last.
    """
    __hash__: typing.ClassVar[None] = None
    def __eq__(self, arg0: object) -> bool:
        ...
    def __getstate__(self) -> dict[typing.Any, typing.Any]:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: dict[typing.Any, typing.Any]) -> None:
        ...
    @property
    def disappears(self) -> float:
        """
        share of its power that is lost, mean over the times of the check
        """
    @property
    def error_db(self) -> float:
        """
        dB, of its power over the frame: the replay over what is there with new surface; 0: not known
        """
    @property
    def has_paths(self) -> bool:
        """
        False: it has no path that carries power
        """
    @property
    def in_range(self) -> bool:
        """
        at most 60 dB below the strongest object, and above the noise of a range-Doppler cell
        """
    @property
    def name(self) -> str:
        """
        of the object
        """
    @property
    def ok(self) -> bool:
        """
        it is served, or out of the dynamic range
        """
    @property
    def seen_power(self) -> float:
        """
        W, largest power with which the times of the check see it
        """
    @property
    def turn(self) -> float:
        """
        rad, how far it turns within the frame at most
        """
class Validity:
    """
    Whether one trace serves a whole frame and a whole array; `str` tells it in words.

    Shares are of the power that the replay carries; a warning is due above 1 %. The power of a path is the mean of |a|^2 over
    the trace time and the times of the check; physical-optics paths are scaled to the power of their sum over the band. An object
    within 60 dB of the strongest and above the noise of a range-Doppler cell is not ok where one of its shares exceeds 5 %, its power
    over the frame is off by more than 0.5 dB, or it is seen but has no path.
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __eq__(self, arg0: object) -> bool:
        ...
    def __getstate__(self) -> dict[typing.Any, typing.Any]:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: dict[typing.Any, typing.Any]) -> None:
        ...
    def __str__(self) -> str:
        ...
    def _repr_html_(self) -> str:
        """
        A table for notebooks.
        """
    @property
    def beside_edges_share(self) -> float:
        """
        share of the power of images of which edges of unmarked planes leave another share of the field
        """
    @property
    def blocked(self) -> numpy.typing.NDArray[numpy.uint64]:
        """
        [P] bit k: something comes in the way of the leg that arrives at hit k
        """
    @property
    def cosine_change(self) -> numpy.typing.NDArray[numpy.float32]:
        """
        [P] largest of a cosine, linear
        """
    @property
    def edge_change(self) -> numpy.typing.NDArray[numpy.float32]:
        """
        [P] largest of what edges leave of an image's field, over the larger of both
        """
    @property
    def keyframes(self) -> int:
        """
        traces, each for its own part of the frame, that serve it: the error by motion is then below 0.3 rad, and echoes that come, go or change their strength have 16 parts or more
        """
    @property
    def largest_cosine_change(self) -> float:
        """
        largest change of a cosine, linear
        """
    @property
    def largest_edge_change(self) -> float:
        """
        largest change of what edges of unmarked planes leave of a field, over the larger of both
        """
    @property
    def largest_phase_error(self) -> float:
        """
        rad, over paths, times and antennas
        """
    @property
    def left(self) -> numpy.typing.NDArray[numpy.uint64]:
        """
        [P] bit k: the point of reflection of hit k leaves the surface around it
        """
    @property
    def left_share(self) -> float:
        """
        share of the power whose points of reflection leave the surface around their hit
        """
    @property
    def motion_phase_error(self) -> float:
        """
        rad, largest for the trace's own antennas
        """
    @property
    def new_surface_share(self) -> float:
        """
        share of single echoes of all that is seen: of what was hidden from the trace
        """
    @property
    def num_paths(self) -> int:
        """
        P, their number
        """
    @property
    def objects(self) -> dict[str, ObjectValidity]:
        """
        {name: ObjectValidity} by the object that a path scattered on last (mirrors by images apart), by strength
        """
    @property
    def occluded_share(self) -> float:
        """
        share of the power that something blocks
        """
    @property
    def ok(self) -> bool:
        """
        no warnings: every object in the dynamic range is served
        """
    @property
    def path_stepped_phase_error(self) -> numpy.typing.NDArray[numpy.float32]:
        """
        [P] rad, what a Newton step leaves
        """
    @property
    def phase_error(self) -> numpy.typing.NDArray[numpy.float32]:
        """
        [P] rad, largest where no point of reflection has left its surface
        """
    @property
    def phase_error_share(self) -> float:
        """
        share of the power whose points of reflection make an error above 0.3 rad
        """
    @property
    def power(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [P] W
        """
    @property
    def receiver_blocked(self) -> numpy.typing.NDArray[numpy.uint8]:
        """
        [P] 1: something comes in the way of the leg to the receiver
        """
    @property
    def replay(self) -> str:
        """
        "material" or "fermat": the replay that was certified
        """
    @property
    def rms_phase_error(self) -> float:
        """
        rad, weighted by power
        """
    @property
    def shares(self) -> ValidityShares:
        """
        ValidityShares of all paths
        """
    @property
    def stepped_phase_error(self) -> float:
        """
        rad, largest that a Newton step to the moved points of reflection leaves
        """
    @property
    def times(self) -> list[float]:
        """
        [T] s, of the check
        """
    @property
    def turned(self) -> numpy.typing.NDArray[numpy.uint8]:
        """
        [P] 1: a cosine or a coefficient changes too much
        """
    @property
    def turned_share(self) -> float:
        """
        share of the power of surfaces that turn to or away from the rays, or reflect otherwise
        """
    @property
    def warnings(self) -> list[str]:
        """
        list of sentences; empty where one trace serves
        """
class Family:
    """
    Paths of one object that went the same way.

    After the Radar Ghost Dataset (Kraus et al. 2021).

    object: name, "" for the background: paths that touch no object
    ghost_type: 0 for real echoes (and the background), 1 for ghosts whose last bounce is on the object, 2 on something else
    order: number of bounces; hits that follow each other on one object are one. 1 for real echoes, 0 for the background
    via: names of what mirrored it, each once, in the order of the first bounce there
    Raises TypeError or ValueError naming the argument.
    """
    def __eq__(self, arg0: object) -> bool:
        ...
    def __getstate__(self) -> tuple[str, int, int, tuple[typing.Any, ...]]:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, object: str, ghost_type: int, order: int, via: typing.Sequence[str]) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: tuple[typing.Any, ...]) -> None:
        ...
    def __str__(self) -> str:
        ...
    @property
    def class_code(self) -> int:
        """
        Label of the Radar Ghost Dataset without the object's class, to which 1000 C is to be added
        (C: 1 pedestrian, 2 cyclist, 3 car, 4 large vehicle, 5 motorcycle): 111 real, 112 type 1 of order 2, 122 type 2 of order
        2, 124 type 2 of order 3; 100 every other ghost, which the dataset leaves undecided; 0 background (no class).
        """
    @property
    def ghost_type(self) -> int:
        """
        0: real echo or background; 1, 2: of a ghost
        """
    @property
    def is_ghost(self) -> bool:
        """
        neither real nor background
        """
    @property
    def object(self) -> str:
        """
        name of the object, "" for the background
        """
    @property
    def order(self) -> int:
        """
        number of bounces; 0: background
        """
    @property
    def via(self) -> tuple[str, ...]:
        """
        tuple of the names of what mirrored it
        """
class Grouping:
    """
    A rule that sorts the paths of any record of a scene into parts, for decompose.
    """
    @staticmethod
    def all_of(groupings: collections.abc.Sequence[Grouping]) -> Grouping:
        """
        Combinations that occur. Keys: tuples of keys.
        """
    @staticmethod
    def batches() -> Grouping:
        """
        Keys: (batch, "coherent") and (batch, "diffuse"); last (None, "coherent"), paths by images, which stand in each batch's estimate in full.
        """
    @staticmethod
    def selections(parts: collections.abc.Sequence[tuple[str, Selection]]) -> Grouping:
        """
        parts: [(name, selection), ...]; the first that takes a path has it. Keys: names, "other" last.
        """
    def __getstate__(self) -> tuple[typing.Any, ...]:
        ...
    def __setstate__(self, arg0: tuple[typing.Any, ...]) -> None:
        ...
class _RayShare:
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __eq__(self, arg0: object) -> bool:
        ...
    def __getstate__(self) -> dict[typing.Any, typing.Any]:
        ...
    def __setstate__(self, arg0: dict[typing.Any, typing.Any]) -> None:
        ...
class _ProbedChirp:
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __eq__(self, arg0: object) -> bool:
        ...
    def __getstate__(self) -> dict[typing.Any, typing.Any]:
        ...
    def __setstate__(self, arg0: dict[typing.Any, typing.Any]) -> None:
        ...
class SignalProbe:
    """
    Spot checks of a signal, which `synthesize` and `decompose` fill: SignalProbe(seed=1).

    A chirp of the frame, or two of an array's (of each stretch, where it is traced anew), drawn by `seed`: eight samples of each
    as direct sums of all echoes, and moving echoes, the strongest and random ones of all blocks of paths, evaluated exactly
    there. Raises TypeError or ValueError naming the argument.
    """
    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    def __eq__(self, arg0: object) -> bool:
        ...
    def __getstate__(self) -> dict[typing.Any, typing.Any]:
        ...
    def __init__(self, *, seed: int = 1) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: dict[typing.Any, typing.Any]) -> None:
        ...
    @property
    def amplitude_error(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [N] rms of the differences of amplitudes in sqrt(W) over that of their largest in the frame, which count no less than a thousandth of the noise of a range-Doppler cell
        """
    @property
    def amplitude_sum(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [N] in sqrt(W), sum of |amplitude| of all echoes in the chirp
        """
    @property
    def chirp(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        [N] index of the chirp in the frame
        """
    @property
    def largest_phase_error(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [N] in rad
        """
    @property
    def num_echoes(self) -> numpy.typing.NDArray[numpy.int64]:
        """
        [N] moving echoes that were evaluated exactly
        """
    @property
    def phase_error(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [N] in rad at the start frequency, rms over these echoes, weighted by power
        """
    @property
    def power_sum(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [N] in W, sum of |amplitude|^2 of all paths
        """
    @property
    def rx(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        [N] index of the receiver
        """
    @property
    def sample(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        [N, 8] indices of samples
        """
    @property
    def seed(self) -> int:
        """
        of the chirps and samples that are drawn
        """
    @property
    def share_field(self) -> numpy.typing.NDArray[numpy.complex128]:
        """
        [2 batches + 1, 8] in sqrt(W): sums of the coherent paths at the samples of the first chirp, of both halves of the rays of each batch in turn, then of the paths that rays did not find
        """
    @property
    def share_power(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [2 batches + 1] in W: sums of |amplitude|^2 of the paths over rough surfaces, likewise
        """
    @property
    def strongest(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [N] in W, the largest |amplitude|^2 of a path that rays found
        """
    @property
    def tx(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        [N] index of the transmitter
        """
    @property
    def value(self) -> numpy.typing.NDArray[numpy.complex128]:
        """
        [N, 8] in sqrt(W), what the samples should be
        """
class PartPass:
    """
    The signals of many groups of paths, some of them at a time.

    Each path is replayed when its group is asked for; signals that are asked for while adds_up is set add up to the whole, each
    of which is to be asked for once.
    """
    def __init__(self, paths: Paths, radar: Radar, group: typing.Any, num_groups: int, *, tolerance: float, method: str, replay: str, evaluate: str, phase_tolerance: float, probe: SignalProbe | None = None) -> None:
        """
        group: uint32 [P] below num_groups; the other arguments are those of ep.synthesize.
        """
    def bounds(self, sets: collections.abc.Sequence[collections.abc.Sequence[int]], window: typing.Any, zero_pad: int, progress: typing.Any) -> numpy.ndarray[typing.Any, typing.Any]:
        """
        Adds sets of groups to the whole and bounds what each can show, [set, R] in W, at any velocity or azimuth.

        cpp/echopath/sim/cells/cell_bounds.h has the rule.
        """
    def cubes(self, sets: collections.abc.Sequence[collections.abc.Sequence[int]], progress: typing.Any) -> list[typing.Any]:
        """
        Signals [tx, rx, chirp, sample] of sets of groups.
        """
    def finish_probe(self) -> None:
        """
        Fills the probe; to be called once, when all groups were added.
        """
    def powers(self, sets: collections.abc.Sequence[collections.abc.Sequence[int]], window: typing.Any, zero_pad: int, least: float, progress: typing.Any, ranges: collections.abc.Sequence[collections.abc.Sequence[int]] = []) -> list[typing.Any]:
        """
        Powers of sets of groups in the cells of a range-Doppler map.

        sets: lists of groups whose fields add up; least: cells at ranges where one can show no more than that, in W, may be 0;
        ranges: of each set[typing.Any], 1 or 0 [R], whether cells of that range are asked for: the others may have no power; empty: all are.
        Returns for each (power [V * R] in W, mean over the channels, mean square of its
        samples in W, which sets of several groups do not have: 0).
        """
    def set_adds_up(self, adds_up: bool) -> None:
        """
        Whether signals add to the whole; at first they do.
        """
    def whole(self) -> numpy.ndarray[typing.Any, typing.Any]:
        """
        The sum of the signals that were added, [tx, rx, chirp, sample] in sqrt(W).
        """
    @property
    def group_bytes(self) -> int:
        """
        memory of one group while its signal is made
        """
def CosinePower(exponent: float, peak_gain: float | None = None) -> AntennaPattern:
    """
    Gain peak_gain cos^exponent of the angle from the boresight, nothing behind.

    exponent: 0 or more
    peak_gain: linear, None for that of a lossless antenna, 2 (exponent + 1), which is the most
    Raises ValueError naming the argument.
    """
def GainTable(*, azimuth: ArrayLike, elevation: ArrayLike, gain: ArrayLike, phase: ArrayLike | None = None, normalize: bool = False) -> AntennaPattern:
    """
    Gain sampled over direction; there is none outside the table.

    azimuth: [A] rad, ascending, about z from the boresight +x to the left, over at most a turn
    elevation: [E] rad, ascending, from the xy-plane, in [-pi/2, pi/2]
    gain: [E, A] linear power gain
    phase: [E, A] rad of the far field (e^{+jwt}) relative to the antenna's position, or None: 0 everywhere. It turns the
        amplitudes of paths by e^{j phase}, in transmission and in reception.
    normalize: True scales the gain to a mean of 1 over the sphere, that of an antenna without losses, as for tables whose level
        is unknown; False takes the gain as it is
    The field sqrt(gain) e^{j phase} is interpolated by bicubics; phases of neighbours should differ by less than 1 rad.
    Azimuths that cover the whole turn up to one step are closed to a ring.
    Returns an AntennaPattern. Raises TypeError or ValueError naming the argument, also where the mean gain over the sphere is more
    than 1.02 (0.09 dB): an antenna cannot radiate more power than it is fed.
    """
def GaussianBeam(*, azimuth: float, elevation: float, peak_gain: float | None = None) -> AntennaPattern:
    """
    A beam of which the widths at half the power are known: it falls as 2^{-(2 angle/width)^2} along both angles.

    azimuth, elevation: rad, whole widths at half the power, from 1e-6 to pi
    peak_gain: linear, None for that of a beam without losses, which is the most: 16 ln 2/(azimuth elevation) of narrow ones
    There is no gain behind, nor beyond 2.6 widths, 81 dB below the peak: for side lobes take a table. Beams of more than 69 degrees
    end at 90 degrees aside, 6.8 dB below the peak for 120 degrees.
    Returns an AntennaPattern, a table. Raises TypeError or ValueError naming the argument.
    """
def Isotropic(gain: float = 1.0) -> AntennaPattern:
    """
    The same linear power gain in every direction.

    gain: linear, at most 1 (1.02 for rounding): without a direction to prefer it is the efficiency of the antenna
    Raises TypeError or ValueError naming the argument.
    """
def _sheet_coefficients(material: Material, frequency: float, incidence: ArrayLike, from_behind: bool = False, bandwidth: float = 0.0) -> numpy.typing.NDArray[numpy.complex128]:
    ...
def _wait(seconds: float, progress: typing.Any = None) -> None:
    ...
def add_noise(cube: typing.Any, radar: Radar, *, seed: int, start_time: float) -> numpy.ndarray[typing.Any, typing.Any]:
    """
    What ep.add_noise calls.
    """
def amplitude_tolerance(phase_tolerance: float) -> float:
    """
    Aim for interpolated amplitudes, relative to the largest of each path, beside one for phases in rad.
    """
def angle_fft(spectrum: RangeDoppler, radar: Radar, *, window: typing.Any = 'hann', zero_pad: int = 4, overlaps: str = 'average', compensate: bool = True, progress: typing.Any = None) -> AngleSpectrum:
    """
    What ep.angle_fft calls.
    """
def are_clear(scene: Scene, time: float, origin: ArrayLike, points: ArrayLike) -> numpy.typing.NDArray[numpy.bool]:
    """
    Whether nothing of the scene lies between `origin` [3] and each of `points` [N, 3], m at `time` in s; [N].
    """
def beamform(spectrum: RangeDoppler, radar: Radar, azimuth: typing.Any = None, elevation: typing.Any = 0.0, *, cells: typing.Any = None, method: str = 'bartlett', window: typing.Any = 'rect', overlaps: str = 'average', compensate: bool = True, diagonal_loading: float = 0.01, velocity_neighbours: int = 1, range_neighbours: int = 2, forward_backward: bool = False, progress: typing.Any = None) -> BeamPower:
    """
    What the function of that name in ep calls.
    """
def cell_masks(power: typing.Any, noise_floor: float, dynamic_range: float) -> tuple[typing.Any, ...]:
    """
    (above_noise, labelled), bool [V, R], of powers [V, R].
    """
def cell_noise_power(radar: Radar, window: typing.Any) -> float:
    """
    Mean power of the receiver's noise in a cell of a range-Doppler map, W.
    """
def cfar(spectrum: RangeDoppler, radar: Radar, *, method: str = 'ca', false_alarm_rate: float = 1e-06, guard_velocity: int | None = None, guard_range: int | None = None, training_velocity: int | None = None, training_range: int | None = None, rank: float = 0.75, beams: bool = False, noise_shape: collections.abc.Sequence[float] = [], progress: typing.Any = None) -> CfarResult:
    """
    What ep.cfar calls.
    """
def check_axes(spectrum: RangeDoppler, radar: Radar) -> None:
    """
    Raises ValueError unless the axes of a range-Doppler map are those of the radar's chirps.
    """
def check_beams(radar: Radar, false_alarm_rate: float) -> None:
    """
    Raises what cfar would in the beams of this radar, at no cost.
    """
def check_cfar(spectrum: RangeDoppler, radar: Radar, *, method: str = 'ca', false_alarm_rate: float = 1e-06, guard_velocity: int | None = None, guard_range: int | None = None, training_velocity: int | None = None, training_range: int | None = None, rank: float = 0.75, beams: bool = False) -> None:
    """
    Raises what cfar would for these settings, at no cost.
    """
def check_objects(scene: Scene, objects: collections.abc.Sequence[tuple[str, collections.abc.Sequence[str]]]) -> None:
    """
    Raises what find_families would for objects [(name, [glob, ...]), ...].
    """
def check_part_names(parts: collections.abc.Sequence[tuple[str, Selection]]) -> None:
    """
    Raises ValueError where a name of [(name, selection), ...] is empty, "other" or given twice.
    """
def coherent_meshes(scene: Scene, wavelength: float, least_share: float, without_planes: bool = False) -> list[int]:
    """
    IDs of the meshes that reflect this share of the power in phase at a wavelength in m, mirrors left out.
    """
def coherent_share(material: Material, wavelength: float) -> float:
    """
    What echopath.tracing.polarization.coherent_share calls.
    """
def compensate_tdm(spectrum: RangeDoppler, radar: Radar, fold: int = 0) -> RangeDoppler:
    """
    What ep.compensate_tdm calls.
    """
def decompose(paths: Paths, radar: Radar, views: collections.abc.Sequence[Grouping], *, tolerance: float = 1e-07, method: str = 'auto', replay: str = 'material', evaluate: str = 'interpolated', phase_tolerance: float = 1e-05, retrace: str = 'never', keyframes: int = 0, progress: typing.Any = None, probe: SignalProbe | None = None) -> list[typing.Any]:
    """
    The signals of parts of the paths, several views of them replayed once.

    views: list of Grouping
    Returns a list of {key: cube}, one for each view, the cubes [tx, rx, chirp, sample] of each adding up to the whole. The other
    arguments are those of ep.synthesize.
    """
def echo_histories(paths: Paths, index: ArrayLike, times: ArrayLike, middle: float) -> tuple[typing.Any, ...]:
    """
    (fields over the largest c64 [N, T], m farther away than at `middle` f32 [N, T], largest [N] in sqrt(W)) of the paths of an index [N] at times [T] in s, between the first antennas.
    """
def estimate_angles(spectrum: RangeDoppler, radar: Radar, azimuth: typing.Any = None, elevation: typing.Any = None, *, cells: typing.Any, velocity: typing.Any = None, range: typing.Any = None, max_peaks: int = 1, peak_range_db: float = 10.0, folds: int = 0, method: str = 'bartlett', window: typing.Any = 'rect', overlaps: str = 'average', compensate: bool = True, diagonal_loading: float = 0.01, velocity_neighbours: int = 1, range_neighbours: int = 2, forward_backward: bool = False, progress: typing.Any = None) -> AngleEstimates:
    """
    What the function of that name in ep calls.
    """
def find_families(paths: Paths, objects: collections.abc.Sequence[tuple[str, collections.abc.Sequence[str]]] | None) -> tuple[typing.Any, ...]:
    """
    The family of each path.

    objects: [(name, [glob, ...]), ...] or None for the children of the scene's root that do not surround the antenna
    Returns the names of the objects, the families that occur (background last), uint32 [P] indices into them, and the
    Grouping by them.
    """
def find_peaks(spectrum: RangeDoppler, radar: Radar, found: CfarResult, progress: typing.Any = None) -> dict[typing.Any, typing.Any]:
    """
    Local maxima among the cells found, and where between the cells they lie.

    found: CfarResult of that spectrum [tx, rx, velocity, range]; progress: callable(stage, fraction) or None
    Returns a dict of arrays [N]: cells [N, 2], velocity (m/s), range (m, as the map shows it), power and noise (W, mean over
    channels, or of the beam that found the cell), velocity_offset, range_offset (cells); and beam_weights [N, tx, rx], whose sum
    with the values of a cell is the field of the beam that found it, or None without beams. Raises ValueError.
    """
def first(glob: str) -> Selection:
    """
    What ep.first calls.
    """
def glob_takes(glob: str, full_name: str) -> bool:
    """
    Whether a glob takes a mesh name: its full name or an ancestor's; * is any text, / too, and ? one character.
    """
def hits(glob: str) -> Selection:
    """
    What ep.hits calls.
    """
def instruction_set() -> str:
    """
    That of the inner loops: baseline, avx2 or avx512; the environment variable ECHOPATH_INSTRUCTION_SET forces one.
    """
def label_regions(label: typing.Any, power: typing.Any, num_labels: int, rows_wrap: bool) -> list[typing.Any]:
    """
    Cells, peak and box of each label: list of dict or None.
    """
def last(glob: str) -> Selection:
    """
    What ep.last calls.
    """
def legs_around_edges(scene: Scene, time: float, frequency: float, antenna: ArrayLike, polarization: ArrayLike, points: ArrayLike, edges: bool = True, progress: typing.Any = None) -> dict[typing.Any, typing.Any]:
    """
    The strongest leg around one edge from an antenna to each of some points, and what all such legs bring there.

    time: s; frequency: Hz; antenna: [3], m, world; polarization: [3], unit vector, world; points: [N, 3], m, world
    edges: whether legs around edges are looked for, or only whether the points are seen
    Returns a dict of mesh_id [N] (of the edge; 4294967295: none, or nothing in the way), point [N, 3] on it in m, length [N] in
    m, share [N] of the field that would arrive were nothing in its way, around all edges together.
    """
def load_frames(paths: collections.abc.Sequence[os.PathLike[str] | str | bytes], unit: float = 1.0) -> tuple[typing.Any, ...]:
    """
    Surfaces of the first of some mesh files as of load_surfaces, and vertices [T, V, 3] in m of each over all files.

    Raises FileError naming a file whose faces, groups or materials are others.
    """
def load_mesh(path: os.PathLike[str] | str | bytes, unit: float = 1.0) -> Mesh:
    """
    What ep.load_mesh calls.
    """
def load_meshes(path: os.PathLike[str] | str | bytes, unit: float = 1.0) -> list[typing.Any]:
    """
    What ep.load_meshes calls.
    """
def load_surfaces(path: os.PathLike[str] | str | bytes, unit: float = 1.0) -> tuple[typing.Any, ...]:
    """
    Groups of a mesh file by material, and what its lines `mtllib` name.

    Each is (object, name, name of the material, vertices [V, 3] in m, triangles [F, 3], face of the file [F], unit normals of the
    corners [3 F, 3] or None where the file says nothing of them). Triangles without area are still there.
    """
def look_at_bodies(scene: Scene, radar: typing.Any, time: float) -> tuple[typing.Any, ...]:
    """
    Of the children of the root: (node [N]; sides [N, 2] in m, shortest and longest; closed [N]; those in which the first transmitter stands, or the first receiver, [(node, whether it is the receiver)]).
    """
def looks_for_signals() -> bool:
    """
    Whether work of the core is looking for signals right now: an exception that a handler raises then ends it.
    """
def main_lobe_half_width(samples: typing.Any) -> float:
    """
    Bins from a tone to the first null of its response under a window [n], to 1/64.
    """
def may_appear_in_frame(paths: Paths, radar: Radar, objects: collections.abc.Sequence[tuple[str, collections.abc.Sequence[str]]] | None, hidden: collections.abc.Sequence[str], shares: collections.abc.Sequence[float], hidden_share: float) -> list[str]:
    """
    Of the objects named in hidden, those that may be in sight at shares of the frame: the others are not.
    """
def mean_power(spectrum: RangeDoppler) -> numpy.ndarray[typing.Any, typing.Any]:
    """
    Mean over the channels of |value|^2, [V, R] in W.
    """
def meant_name(word: str, known: collections.abc.Sequence[str]) -> str:
    """
    The name among `known` that was most likely meant by `word`, "" where none is alike.
    """
def mesh_names(scene: Scene, mesh_ids: collections.abc.Sequence[int]) -> list[str]:
    """
    Full names by mesh IDs.
    """
def mesh_traits(scene: Scene) -> tuple[typing.Any, ...]:
    """
    Of all meshes: (materials, each once; index of each mesh's [M]; whether it is smooth [M], moves [M], deforms [M]).
    """
def mesh_widths(scene: Scene, mesh_ids: collections.abc.Sequence[int], time: float) -> list[float]:
    """
    Middle extents in m along the principal axes of meshes by their IDs, at a time in s: the diameter of a rod. Parts of a surface have that of the whole.
    """
def meshes_cut_from_mirrors(scene: Scene) -> list[int]:
    """
    IDs of the meshes that are parts of one mesh with the flagged mirror above them.
    """
def meshes_of_large_planes(scene: Scene, radar: typing.Any, wavelength: float, time: float, least_coherent: float, least_area: float, least_extent: float, least_area_of_short: float, vehicle_length: float, vehicle_width: float, most_small_planes: int) -> list[tuple[int, list[int]]]:
    """
    Meshes that planes larger than their Fresnel zone make up at a wavelength in m and a time in s: [(ID, triangles of their other planes, none where these are few)].
    """
def meshes_of_objects(scene: Scene, objects: collections.abc.Sequence[tuple[str, collections.abc.Sequence[str]]]) -> dict[typing.Any, typing.Any]:
    """
    {name: IDs of its meshes} of objects [(name, [glob, ...]), ...]; raises what find_families would.
    """
def meshes_of_usual_objects(scene: Scene, radar: Radar, time: float) -> dict[typing.Any, typing.Any]:
    """
    {name: IDs of its meshes} of the objects that find_families has where none are named, at a time in s.
    """
def middle_phases(lengths: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], waveform: ChirpSequence) -> numpy.ndarray[typing.Any, typing.Any]:
    """
    Phase factors, complex of the shape of the lengths in m, of the signals of echoes in the middle of a chirp.
    """
def mie_rcs(radius: float, frequency: float, bistatic_angle: float = 0.0, plane: str = 'H') -> float:
    """
    What ep.mie_rcs calls.
    """
def nearest_names(word: str, candidates: collections.abc.Sequence[str], count: int = 3) -> list[str]:
    """
    The candidates most like `word` by edit distance, best first, at most `count`.
    """
def noise_power(radar: Radar) -> float:
    """
    Noise power of one IF sample, W.
    """
def noise_power_in_cell(radar: Radar) -> float:
    """
    Noise power of the range-Doppler cell that all samples of a frame make with even weights, W, against the received power of an echo there.
    """
def num_threads() -> int:
    """
    Number of threads of the parallel loops.
    """
def partition_groups(paths: typing.Any, parts: collections.abc.Sequence[tuple[str, Selection]]) -> tuple[typing.Any, ...]:
    """
    The part of each path in a partition.

    parts: [(name, selection), ...]; the first that takes a path has it
    Returns the names with "other" last, and uint32 [P], indices into them. Raises ValueError for names that are empty,
    "other" or given twice.
    """
def power_shares(power: typing.Any) -> numpy.ndarray[typing.Any, typing.Any]:
    """
    Shares of the powers [K, V, R] in their sums.
    """
def range_azimuth(spectrum: RangeDoppler, radar: Radar, azimuth: typing.Any = None, elevation: typing.Any = 0.0, *, velocity: float | None = None, combine: str = 'sum', velocity_gate: typing.Annotated[collections.abc.Sequence[float], "FixedSize(2)"] | None = None, method: str = 'bartlett', window: typing.Any = 'rect', overlaps: str = 'average', compensate: bool = True, diagonal_loading: float = 0.01, velocity_neighbours: int = 1, range_neighbours: int = 2, forward_backward: bool = False, progress: typing.Any = None) -> RangeAzimuth:
    """
    What the function of that name in ep calls.
    """
def range_doppler(cube: typing.Any, radar: Radar, window: typing.Any = 'hann', zero_pad: int = 1) -> RangeDoppler:
    """
    What ep.range_doppler calls.
    """
def rcs(scene: Scene, *, frequency: float, incidence: typing.Any, observation: typing.Any = None, polarization: typing.Any = (0, 0, 1), num_rays: int | None = None, max_bounces: int = 4, seed: int = 1, footprint: str = 'second_order', sampler: str = 'lattice', batches: int | None = None, target_error_db: float | None = None, max_rays: int = 16777216, edges: bool = False, components: bool = False, return_error: bool = False, cavities: collections.abc.Sequence[tuple[collections.abc.Sequence[int], typing.Annotated[collections.abc.Sequence[float], "FixedSize(3)"], typing.Annotated[collections.abc.Sequence[float], "FixedSize(3)"]]] = [], progress: typing.Any = None) -> typing.Any:
    """
    What ep.rcs calls. cavities: list of (mesh IDs of the walls, a point of the mouth, its normal); with any, returns {field: complex, m; diffuse: m^2} of what stays outside of them and, each [E, 3], unit vectors of all E waves: incidence, observation, transmitted, received.
    """
def received_power(paths: Paths, *, tx: int = 0, rx: int = 0, progress: typing.Any = None) -> ReceivedPower:
    """
    What ep.received_power calls.
    """
def received_powers(paths: Paths, group_of_path: typing.Annotated[numpy.typing.ArrayLike, numpy.uint32], num_groups: int, *, tx: int = 0, rx: int = 0, progress: typing.Any = None) -> list[ReceivedPower]:
    """
    What ep.received_powers calls.
    """
def received_powers_of_sortings(paths: Paths, sortings: collections.abc.Sequence[tuple[typing.Annotated[numpy.typing.ArrayLike, numpy.uint32], int]], progress: typing.Any = None) -> tuple[typing.Any, ...]:
    """
    received_powers of several (group_of_path, num_groups) in one pass: (list [sorting, group] of ReceivedPower in W, power [P] in W, length [P] in m), the last two of each path at the trace time for the first antennas.
    """
def remember_geometry(paths: Paths, kept: KeptGeometry) -> bool:
    """
    Has visibility_in_trace and may_appear_in_frame keep geometry there, unless the trace kept its own. Returns whether.
    """
def renew(paths: Paths, radar: Radar | None = None, *, time: float, progress: typing.Any = None) -> Renewal:
    """
    What ep.renew calls.
    """
def set_num_threads(num_threads: int) -> None:
    """
    What ep.set_num_threads calls.
    """
def share_errors(cross: typing.Any, coherent: typing.Any, diffuse: typing.Any, dominant: typing.Any) -> tuple[typing.Any, ...]:
    """
    (power, its error, share, its error [K, V, R], certain [V, R]) from sums of batches [K, B, V, R].
    """
def slot_phasors(radar: Radar, velocity: typing.Any) -> typing.Any:
    """
    [tx, V], which take out the phase that velocities [V] in m/s add in the slots of the transmitters.
    """
def strongest_edge(scene: Scene, radar: Radar, time: float) -> float:
    """
    What edges="auto" compares with the noise: W that the strongest sharp edge would carry at a time in s.
    """
def strongest_part(power: typing.Any, mask: typing.Any) -> numpy.ndarray[typing.Any, typing.Any]:
    """
    Index of the largest of [K, V, R], -1 outside.
    """
def surface_centroid(scene: Scene, mesh_ids: collections.abc.Sequence[int], time: float) -> typing.Annotated[list[float], "FixedSize(3)"]:
    """
    Centroid [3] in m of the surface of meshes by their IDs together, in the world at a time in s.
    """
def synthesize(paths: Paths, radar: Radar | None = None, *, tolerance: float = 1e-07, method: str = 'auto', replay: str = 'material', evaluate: str = 'interpolated', phase_tolerance: float = 1e-05, retrace: str = 'never', keyframes: int = 0, progress: typing.Any = None, probe: SignalProbe | None = None) -> numpy.ndarray[typing.Any, typing.Any]:
    """
    What ep.synthesize calls.
    """
def synthesize_echoes(waveform: ChirpSequence, delays: typing.Any, amplitudes: typing.Any, *, method: str = 'auto', tolerance: float = 1e-07, num_slots: int = 1) -> numpy.ndarray[typing.Any, typing.Any]:
    """
    The IF signal of echoes given by their delays and amplitudes, for one channel.

    delays: [1, P] (at rest) or [chirps, P] (at the middle of each chirp) in s, round trip
    amplitudes: the same shape, complex in sqrt(W), without the phase of the delay
    method: "auto", "direct" (the reference), "recurrence" or "nufft"
    tolerance: rms error over the samples relative to the sum of |amplitudes|, 1e-13 to 0.1
    num_slots: transmitters that take turns; rows are num_slots * chirp_interval apart
    Returns [chirp, sample], complex128 in sqrt(W). Raises ValueError naming the argument.
    """
def tessellation(mesh: Mesh) -> typing.Annotated[list[float], "FixedSize(4)"] | None:
    """
    What echopath.tracing.tessellation.tessellation calls.
    """
def trace(scene: Scene, radar: Radar, *, num_rays: int | None = None, start_time: float = 0.0, target_error_db: float | None = None, max_rays: int = 16777216, progress: typing.Any = None, kept: KeptGeometry | None = None, kept_still: KeptStillRays | None = None, objects_time: float | None = None, seed: int = 1, max_bounces: int = 4, polarization: str = 'scalar', footprint: str = 'second_order', sampler: str = 'lattice', num_batches: int = 1, scatterers: str = 'rays', edges: bool = False, attenuation: float = 0.0, faint_power: float = 0.0) -> Paths:
    """
    What ep.trace calls. kept: KeptGeometry of the scene, or None; kept_still: KeptStillRays of the scene, radar and settings, whatever the start, or None; objects_time: s, as of TraceFrame.
    """
def triangles_of_polygons(vertices: typing.Any, corners: typing.Any, counts: typing.Any) -> tuple[typing.Any, ...]:
    """
    Polygons cut into triangles as load_mesh cuts those of files.

    vertices: [V, 3] in m; corners: [N] indices of vertices, polygon by polygon; counts: [F] corners of each, three or more
    Returns the triangles [T, 3], the polygon of each [T] and the places [T, 3] of their corners in `corners`. Raises ValueError.
    """
def validity(paths: Paths, radar: Radar | None = None, *, replay: str = 'material', times: typing.Any = None, arrays: bool = False, progress: typing.Any = None) -> Validity:
    """
    What ep.validity calls.
    """
def virtual_array(radar: Radar) -> VirtualArray:
    """
    What ep.virtual_array calls.
    """
def visibility(scene: Scene, radar: Radar, objects: collections.abc.Sequence[tuple[str, collections.abc.Sequence[str]]] | None, time: float | None, num_directions: int, progress: typing.Any) -> list[typing.Any]:
    """
    [(name, mesh IDs, of the transmitter, of the receiver), ...], the last two each a tuple of the fields of echopath.VisibilityFromEnd.
    """
def visibility_in_trace(paths: Paths, radar: Radar, objects: collections.abc.Sequence[tuple[str, collections.abc.Sequence[str]]] | None, time: float | None, num_directions: int, progress: typing.Any) -> list[typing.Any]:
    """
    As visibility, of the objects that find_families has for a trace; time: s, None: that of the trace.
    """
def warn_of_turns(yaw: float) -> None:
    """
    Warns of a yaw (rad) beyond a turn, which looks like degrees.
    """
def weighted_row_sums(table: typing.Annotated[numpy.typing.ArrayLike, numpy.complex64], rows: typing.Annotated[numpy.typing.ArrayLike, numpy.int32], weights: typing.Annotated[numpy.typing.ArrayLike, numpy.complex64]) -> numpy.ndarray[typing.Any, typing.Any]:
    """
    Sums over rows [K] of a table c64 [N, T] with each of some weights c64 [W, T]: c64 [W, K].
    """
def window(name: str, n: int, sidelobe_db: float | None = None) -> numpy.typing.NDArray[numpy.float64]:
    """
    Samples [n] of a window: cosines periodic; "chebyshev", "taylor" and "kaiser" symmetric, sidelobes `sidelobe_db` dB down (80, 35 and 60 if not given).
    """
DEFAULT_MAX_RAYS: int = 16777216
HIGHEST_FREQUENCY: float = 100000000000000.0
LOWEST_FREQUENCY: float = 1000000.0
MESH_SUFFIXES: tuple[typing.Any, ...] = ('.obj', '.ply', '.stl', '.off')
MOST_RAYS: int = 10000000000
PHASE_TOLERANCE: float = 1e-05
RECORD_SETTINGS: dict[typing.Any, typing.Any] = {'seed': 1, 'max_bounces': 4, 'polarization': 'scalar', 'footprint': 'second_order', 'sampler': 'lattice', 'num_batches': 1, 'scatterers': 'rays', 'edges': False, 'attenuation': 0.0, 'faint_power': 0.0}
__version__: str = '0.1.0'
boltzmann: float = 1.380649e-23
num_bounces: NumBounces
power: Power
reference_temperature: float = 290.0
speed_of_light: float = 299792458.0
vacuum_permittivity: float = 8.8541878128e-12
