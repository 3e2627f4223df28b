"""Traces and cross sections: the model of polarisation chosen, and what is wrong with the scene said."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal

import numpy as np

from .. import _core
from ..arguments.checks import ArrayLike, Progress, array, carrier, checked, flag, one_of, optional, positive, real, shown
from ..arguments.effects import Choices
from ..arguments.frame_times import require_frame
from ..arguments.number_rules import HIGHEST_FREQUENCY
from ..arguments.settings import Edges, FaintPower, Footprint, Polarization, Sampler, Scatterers, TraceSettings, settings_among
from ..cavities.cavity import Cavity
from ..cavities.cross_sections import rcs_with_cavities
from ..scene.bodies import warn_of_bodies
from ..scene.lifetimes import scene_at, scene_in_frame, warn_of_absence
from ..weather.weather import attenuation_of
from .edge_paths import warn_of_edge_paths
from .edges import looks_for_edges
from .faint_paths import faint_power_of
from .lost_rays import warn_of_record
from .polarization import FIELD_VECTORS, SCALAR, chosen_model
from .tessellation import warn_of_coarse_meshes

Channel = Literal["vv", "hh", "vh", "hv"]  # transmitted, received
CrossSections = Any  # float of one direction, array of several; dicts of them by polarisation or component; pairs with errors


@checked({"settings": TraceSettings}, **TraceSettings.RULES)
def trace(scene: _core.Scene, radar: _core.Radar, *, num_rays: int | float | None = TraceSettings.num_rays,
          max_bounces: int = TraceSettings.max_bounces, seed: int = TraceSettings.seed,
          start_time: float = TraceSettings.start_time, polarization: Polarization = TraceSettings.polarization,
          footprint: Footprint = TraceSettings.footprint, sampler: Sampler = TraceSettings.sampler,
          batches: int | None = TraceSettings.batches, target_error_db: float | None = TraceSettings.target_error_db,
          max_rays: int | float = TraceSettings.max_rays, scatterers: Scatterers = TraceSettings.scatterers,
          edges: Edges = TraceSettings.edges, faint_power: FaintPower = TraceSettings.faint_power,
          effects: Choices = TraceSettings.effects,
          settings: TraceSettings | None = None, progress: Progress = None) -> _core.Paths:
    """Shoots rays from the radar through the scene at mid-frame and records what they hit.

    scene: what is traced, without objects whose lifetimes do not cover the frame wholly; radar: that looks at it
    num_rays: a budget of rays. They go where the error is: a pilot of an eighth as many beside them, which is thrown away,
        tells how many the echo of each object, and of each of its images, needs to be known to 0.3 dB; moving objects get
        more; up to half of those of each lie closer about its points of reflection, and up to a quarter about those that echo
        over several surfaces (strata with focus_of). Unless scatterers stay on their surfaces, up to 15 % of all rays, or half of
        those that these needs leave, go where cells of the map above the noise hold few diffuse hits, as of a ground far away.
        Unless given, and without target_error_db, there are as many as bring the echo of each object that stands above the
        noise to 0.3 dB (95 % interval of bias and chance), and up to as many again where cells ask for them, 1 000 000 at most
    max_bounces: 1 to 64, hits on mirrors count. Between a target and an antenna there are images over up to two mirrors each
        way; over mirrors alone, over as many as max_bounces
    seed: the same seed gives the same bits
    start_time: s, first sample of the frame
    polarization: "scalar" (one coefficient a hit, TE or TM by the transmit polarisation; all antennas count as
        co-polarised), "jones" (field vectors, co- and cross-polar echoes; 32 bytes a path more), or "auto": field vectors
        where the scene has coherent surfaces that are no flagged mirrors, rough ones that turn the polarisation, metal
        mirrors met in TM, as floors below upright antennas, or antennas of several polarisations; `paths.effects` tells
    footprint: filter of the ray's footprint on coherent echoes, "second_order", "first_order" or "none"; "edges" is a
        flatter second order, for curved surfaces whose edges make the echo (a dish along its axis)
    sampler: spreads the rays over the cone of each object, "lattice", "fibonacci", "r2" or "random"
    batches: 1 to 64 independent lattices that share the rays, from which `received_power` tells standard errors; each is as
        fine as its share of the rays; None: 1
    target_error_db: dB; adds rays where they are missing, from num_rays (16 384 unless given) to at most max_rays, until the
        echo of each object and image, down to 60 dB below the strongest, is known that well: half its 95 % interval
        (`received_power`), without what facets of a coarse mesh and edges behind other bounces leave there, which
        more rays hardly mend. A RuntimeWarning and `paths.frame.error_db` tell where max_rays did not do
    scatterers: of rough surfaces: "rays", the points that rays happen to meet, other ones in each trace; "surface", points of
        the surfaces, the same in all traces of a scene with one seed, so that the speckle of what moves goes on from frame
        to frame; or "auto": "surface" in a `Sequence`, else "rays". Points of surfaces are less even: 5000 of them tell the
        mean power of a body to 0.5 %, as many rays to 0.1 %. What rays meet straight from the transmitter persists; second
        and further diffuse hits are drawn from there, and places that only flagged mirrors show are left to rays. With
        "surface", rays persist too: before a radar at rest half of num_rays go to what stands still, the same in all traces.
        What stands still of an object that moves, as the pole of a fan, has rays of its own, too
    edges: whether the echoes of sharp edges are looked for, too: what physical optics leaves out where two faces of a conductor
        meet at 30 degrees or more, and at rims (`E` in path expressions), directly from the radar, over flagged mirrors and
        over unflagged planes that rays found, and on from edge to edge over flat faces of up to 40 wavelengths (`E E`).
        Where the strongest edge stands out of the noise of a cell of the map, those 40 dB below that noise are left out.
        Dielectrics, and meshes that deform or change their scale, have none. "auto": where the strongest edge, were nothing
        in its way, stands out of the noise of a cell of the map; `paths.effects` says how strong it is
    faint_power: W; of diffuse paths that carry at most a quarter of it, one in 4, 16 or 64 is kept at random, with the power
        of all (`paths.frame.statistics.num_faint_paths` were left out): the expected power of every cell stays what it is, but
        for half of what paths over one hit add in phase of which unlike shares are kept, and cells that are stronger than a
        few faint paths fluctuate as with all of them. 0: all paths are kept; "auto": a fortieth of the noise of a cell of
        the map, once all channels of the array are added in phase. "auto" saves most of the time of signals and labels where
        rough bodies stand among mirrors, and is not for levels below the noise
    effects: {name: True, False or "auto"} of effects that `Scene.weather` asks for: "attenuation by weather", "echoes of rain"
        (of `simulate`); those that are left out are "auto", on where the weather has them
    settings: TraceSettings that give the keywords which the call leaves out, or None
    progress: callable (stage, fraction), True for bars, or None
    From a scene's second trace on, and from the first of `simulate(labels=True)`, what has not moved since is not built again,
    for about 200 bytes a triangle while the scene lives.
    Returns Paths. Raises TypeError or ValueError naming the argument, also for smooth mirrors that are not flat and motions
    that do not cover the frame. Warns (TessellationWarning, once) of curved meshes that err by more than 0.3 dB, with the
    edge length in m that would do, and (RuntimeWarning) where over 1 % of the rays are lost to a surface that the radar
    touches, not every sequence of mirrors was tried, objects have no rays of their own, the scene is empty, or all that has a
    lifetime is absent, the radar stands in a closed body that hides the rest, the lengths of an object look like those of
    another unit, or paths around sharp edges are so many that signals of them take long.
    """
    warn_of_absence(scene, radar, start_time, start_time + radar.frame_duration)
    return traced(scene, radar, settings_among(TraceSettings, locals()), progress=progress)


def traced(scene: _core.Scene, radar: _core.Radar, settings: TraceSettings, *, objects_time: float | None = None,
           still_rays: _core.KeptStillRays | None = None, progress: Progress = None) -> _core.Paths:
    """What `trace` returns, warns of and raises, for settings that hold everything.

    objects_time: s, when the objects of the record are told from what surrounds the antenna; None: at mid-frame
    still_rays: where those of what stands still are kept for calls that differ in the start alone, or None
    """
    start_time = settings.start_time
    require_frame("radar", radar, start_time)
    wavelength = _core.speed_of_light / radar.waveform.start_frequency
    is_first, geometry = _remembered(scene)
    scene = scene_in_frame(scene, radar, start_time)
    if is_first:
        warn_of_bodies(scene, radar, start_time)
    warn_of_coarse_meshes(scene, radar.waveform.start_frequency)
    model = chosen_model(settings.polarization, scene, wavelength, radar, radar.middle_of_frame(start_time))
    paths = _core.trace(scene, radar, num_rays=settings.num_rays, max_bounces=settings.max_bounces, seed=settings.seed,
                        start_time=start_time, polarization=model, footprint=settings.footprint, sampler=settings.sampler,
                        num_batches=settings.batches or 1, target_error_db=settings.target_error_db,
                        max_rays=settings.max_rays,
                        scatterers="rays" if settings.scatterers == "auto" else settings.scatterers,
                        edges=looks_for_edges(settings.edges, scene, radar, start_time),
                        faint_power=faint_power_of(settings.faint_power, radar),
                        attenuation=attenuation_of(scene, radar, settings.effects), progress=progress, kept=geometry,
                        kept_still=still_rays, objects_time=objects_time)
    warn_of_record(paths.frame)
    warn_of_edge_paths(paths)
    return paths


def _polarization(argument: str, value):
    """One vector [3], two [2, 3], the name of a channel, or a list of names and pairs of vectors."""
    if isinstance(value, str):
        return one_of(Channel)(argument, value)
    if _depth(value) == 3 or isinstance(value, (list, tuple)) and any(isinstance(one, str) for one in value):
        return [one_of(Channel)(argument, one) if isinstance(one, str) else array("[2, 3]", finite=True)(argument, one)
                for one in value]
    return array("[3]", "[2, 3]", finite=True)(argument, value)


def _depth(value) -> int:
    """How deep lists or arrays are nested, by their first entries."""
    if isinstance(value, np.ndarray):
        return value.ndim
    return 1 + _depth(value[0]) if isinstance(value, (list, tuple)) and value else 0


def _cavities(argument: str, value) -> tuple[Cavity, ...]:
    """None, a Cavity or several."""
    if value is None or isinstance(value, Cavity):
        return () if value is None else (value,)
    if not isinstance(value, (list, tuple)) or not all(isinstance(one, Cavity) for one in value):
        raise TypeError(f"{argument}: must be a Cavity, a list of them or None, got {shown(value)}")
    return tuple(value)


_DIRECTIONS = array("[3]", "[N, 3]", finite=True)


@checked(**TraceSettings.RULES | {
    "frequency": carrier, "incidence": _DIRECTIONS, "observation": optional(_DIRECTIONS), "polarization": _polarization,
    "model": one_of(Polarization), "edges": flag, "cavities": _cavities, "components": flag, "return_error": flag})
def rcs(scene: _core.Scene, *, frequency: float, incidence: ArrayLike, observation: ArrayLike | None = None,
        polarization: ArrayLike | Channel | Sequence[Channel | ArrayLike] = (0.0, 0.0, 1.0), model: Polarization = "auto",
        num_rays: int | float | None = None, max_bounces: int = TraceSettings.max_bounces, seed: int = TraceSettings.seed,
        footprint: Footprint = TraceSettings.footprint, sampler: Sampler = TraceSettings.sampler, batches: int | None = None,
        target_error_db: float | None = None, max_rays: int | float = TraceSettings.max_rays,
        edges: bool = False, cavities: Cavity | Sequence[Cavity] | None = None, components: bool = False,
        return_error: bool = False, progress: Progress = None) -> CrossSections:
    """Radar cross section of a scene in m^2, far field, at time 0, without what is absent then (`SceneNode.lifetime`).

    Model: physical optics at every bounce, both antennas isotropic. Coherent echoes add as fields; diffuse ones as powers,
    the mean over realisations of the roughness.
    scene: the target
    frequency: Hz, 1e6 to 1e14
    incidence: toward the transmitter, seen from the target, [3] or [N, 3], any length
    observation: toward the receiver, likewise; None: monostatic
    polarization: [3] of both antennas; or, with field vectors: [2, 3] of transmitter and receiver, "vv", "hh", "vh", "hv"
        (transmitted, received: "v" points up, "h" lies in the xy-plane, both across the line of sight), or a list [C] of
        such pairs [2, 3] and names. Of a vector its part across the line of sight counts
    model: with a polarization of [3], "scalar" (one coefficient a hit), "jones" (field vectors) or "auto", as in `trace`
    num_rays: rays per direction and transmit polarization, for all batches together; 131 072 for each batch unless given;
        max_bounces: 1 to 64
    seed, footprint, sampler, edges: as in `trace`; edges is not "auto", because there is no noise
    batches: as in `trace`; None: 8 for return_error, else 1
    target_error_db: dB; doubles the rays, from num_rays (16 384 unless given) to at most max_rays, as `trace` does, until
        each cross section, of a list of polarizations the first with each transmitter, is known that well, or to be a null:
        below a hundredth of the wavelength squared, -68 dBsm at 77 GHz, physical optics knows nothing
    cavities: hollows in perfect conductors, of which rays know little where they are a few wavelengths wide: a Cavity or
        several. Rays go on outside of them, and their edges count at the mouth alone; what the mouth lets in is a wave, whose
        currents on the walls an equation of twice as many unknowns as there are facets of a quarter of a wavelength tells (at
        most 8000 facets; time goes as their cube, memory as their square). What stands in a mouth's way is not seen by
        these waves, nor do they go from one cavity to another. Not with several batches, return_error or target_error_db
    components: True returns {"coherent": ..., "diffuse": ...}, which add up to the cross section
    return_error: True returns (cross section, standard error), alike in shape; the error, in m^2, is that of the batches and,
        as root sum of squares, what the footprints of too few rays may leave out. Each batch has a part of the rays alone,
        so give enough of them. An estimate from batches is free of bias by chance, so that it may fall below zero where it
        is smaller than its error
    progress: callable (stage, fraction), True for bars, or None; it tells of rays alone, not of the waves in cavities,
        which are computed after these
    Returns a number, or [N] where directions are [N, 3], with a last axis [C] for a list of polarizations. Each direction
    and transmit polarization costs a trace of its own. Raises TypeError or ValueError naming the argument, also for a zero
    direction, one along the polarization, an empty scene, and mirrors, which have no cross section. Warns
    (TessellationWarning) of curved meshes that err by more than 0.3 dB, with the edge length in m that would do, and
    (RuntimeWarning) where max_rays did not do, of nulls that rays were added for, or, without target_error_db, where the
    footprints of the rays are too wide to know cross sections to 3 dB; of nulls between lobes they need not.
    """
    scene = scene_at(scene, 0.0)
    warn_of_coarse_meshes(scene, frequency)
    chosen = chosen_model(model, scene, _core.speed_of_light / frequency)
    is_one = not isinstance(polarization, list) and np.shape(polarization) == (3,)
    if not is_one and model == SCALAR:
        raise ValueError(f"model: 'scalar' takes one vector for both antennas as polarization, got {shown(polarization)}")
    both = np.array([polarization, polarization]) if is_one and chosen == FIELD_VECTORS else polarization
    if cavities:
        if return_error or target_error_db is not None or (batches or 1) > 1:
            raise ValueError("cavities: must be left out with return_error, target_error_db or several batches")
        return rcs_with_cavities(scene, cavities, frequency=frequency, incidence=incidence, observation=observation,
                                 polarization=both, num_rays=num_rays, max_bounces=max_bounces, seed=seed,
                                 footprint=footprint, sampler=sampler, edges=edges, components=components, progress=progress)
    return _core.rcs(scene, frequency=frequency, incidence=incidence, observation=observation, polarization=both,
                     num_rays=num_rays, max_bounces=max_bounces, seed=seed, footprint=footprint, sampler=sampler,
                     batches=batches, target_error_db=target_error_db, max_rays=max_rays, edges=edges, components=components,
                     return_error=return_error, progress=progress)


@checked(radius=positive("m"), frequency=real(above=0.0, high=HIGHEST_FREQUENCY, unit="Hz"),
         bistatic_angle=real(0.0, np.pi, "rad"), plane=one_of(Literal["E", "H"]))
def mie_rcs(radius: float, frequency: float, bistatic_angle: float = 0.0, plane: Literal["E", "H"] = "H") -> float:
    """Exact radar cross section of a perfectly conducting sphere in m^2, co-polarised, far field.

    The Mie series, to 1e-9: the reference for curved metal. For ka = 2 pi radius frequency / c up to 1e6.
    radius: m; frequency: Hz
    bistatic_angle: rad in [0, pi] between the directions to transmitter and receiver, 0 is monostatic
    plane: "E" or "H": the field that the plane of both directions holds (alike in the monostatic case)
    Raises TypeError or ValueError naming the argument. Source: Mie 1908; Harrington, Time-Harmonic Electromagnetic Fields,
    1961, section 6-9.
    """
    return _core.mie_rcs(radius, frequency, bistatic_angle, plane)


def _remembered(scene: _core.Scene) -> tuple[bool, _core.KeptGeometry | None]:
    """(whether this is a scene's first trace, where its geometry is kept).

    A scene that is traced once keeps nothing, unless `keep_geometry` was asked for. Plain scenes of the core never do: each of
    their traces is a first one.
    """
    memory = getattr(scene, "__dict__", None)
    if memory is None:
        return True, None
    is_first = "_was_traced" not in memory
    if not is_first:
        keep_geometry(scene)
    memory["_was_traced"] = True
    return is_first, memory.get("_geometry")


def keep_geometry(scene: _core.Scene, kept: _core.KeptGeometry | None = None) -> None:
    """Has the next trace of a scene keep its geometry: for later ones, or for who looks at the scene again afterwards.

    kept: where; None: where the last trace kept it, or a new place
    """
    memory = getattr(scene, "__dict__", None)
    if memory is not None and (kept is not None or "_geometry" not in memory):
        memory["_geometry"] = kept or _core.KeptGeometry()
