"""Which powers the rays of a trace know, of each object and ghost family, and what would make them know the others."""

import dataclasses
import functools
import math
import sys
from typing import NamedTuple

import numpy as np

from .. import _core
from ..arguments.checks import Progress, checked, real
from ..arguments.objects import Objects, objects_rule
from ..base.classes.made_by import made_by
from ..base.numerics.decibels import in_dbm
from ..scene.large_planes import large_planes
from .families import Families, families as families_of
from .visibility import visibility_in_trace

RESOLVED_DB = 0.3       # the 95 % interval of a resolved power reaches no further to either side
MOST_TIMES = 100.0      # of the rays: what needs more is not a matter of rays
UNSEEN_HITS = 3.0       # rays that may have met what none has met (95 % limit of a Poisson count)
UNMET_DIRECTIONS = 512  # on each object: what is seen of it in slivers counts, too
FAINT = 0.01            # of the upper end of an interval
MOST_PRINTED = 12       # of a list of echoes, the strongest of objects first
SURROUNDINGS = "the surroundings"  # what belongs to no object


class Interval(NamedTuple):
    """A mean received power and its 95 % interval, of bias and chance together.

    power: W; low, high: W, the ends of the interval
    """

    power: float
    low: float
    high: float

    @property
    def resolved(self) -> bool:
        """The interval reaches no further than 0.3 dB to either side."""
        factor = 10.0 ** (0.1 * RESOLVED_DB)
        return 0.0 < self.power <= factor * self.low and self.high <= factor * self.power

    @property
    def is_in_doubt(self) -> bool:
        """There is or may be something, and it is not resolved."""
        return self.high > 0.0 and not self.resolved

    def __str__(self) -> str:
        if not self.high > 0.0:
            return "nothing"
        if self.resolved:
            return f"{in_dbm(self.power):.2f} dBm"
        high = f"{in_dbm(self.high):.1f} dBm"
        if self.low > 0.0:
            return f"{in_dbm(self.power):.1f} dBm, {in_dbm(self.low):.1f} to {high}"
        if self.power < FAINT * self.high:  # so far below what may be there that it tells nothing
            return f"below {high}" if self.power > 0.0 else f"no power yet, below {high}"
        return f"{in_dbm(self.power):.1f} dBm, below {high}"


@made_by("ep.unresolved")
@dataclasses.dataclass(frozen=True, repr=False)
class Unresolved:
    """An echo whose power the rays do not know to 0.3 dB.

    name: of the object, or "the surroundings"; via: names of what mirrored it, () for the object itself
    ghost_type: 1 (last bounce on the object), 2 (last bounce on a mirror), 0 for the object itself; order: number of bounces
    interval: Interval in W; advice: what would resolve it
    """

    name: str
    via: tuple[str, ...]
    ghost_type: int
    order: int
    interval: Interval
    advice: str

    @property
    def title(self) -> str:
        """The name, and for ghosts the way, type and order."""
        return f"{self.name} via {', '.join(self.via)}, type {self.ghost_type}/{self.order}" if self.via else self.name

    def __str__(self) -> str:
        return f"{self.title}: {self.interval}; {self.advice}"

    def __repr__(self) -> str:
        return f"Unresolved({self})"


class UnresolvedList(list):
    """A list of Unresolved that prints no more than its first ones: a closed room has thousands."""

    def __repr__(self) -> str:
        more = [f"and {len(self) - MOST_PRINTED} more"] if len(self) > MOST_PRINTED else []
        return f"[{', '.join([*map(repr, self[:MOST_PRINTED]), *more])}]"


def interval_of(power) -> Interval:
    """Of an ep.ReceivedPower, in W."""
    return Interval(power.power, power.low, power.high)


class MeanPowers(NamedTuple):
    """of_families: list [F] of ep.ReceivedPower, in W; of_parts: {partition: list [part] of the same}

    of_paths, lengths: power [P] in W and length [P] in m of each path, at the trace time for the first antennas
    """

    of_families: list
    of_parts: dict
    of_paths: np.ndarray
    lengths: np.ndarray


def mean_powers(paths, families, groups: dict, progress=None) -> MeanPowers:
    """Of ghost families and of the parts of partitions, from one pass over the paths.

    families: Families of the paths; groups: {partition: (part_of_path [P], number of parts)}
    """
    sortings = [(families.family_of_path, len(families.families)), *groups.values()]
    (of_families, *of_parts), of_paths, lengths = _core.received_powers_of_sortings(paths, sortings, progress)
    return MeanPowers(of_families, dict(zip(groups, of_parts)), of_paths, lengths)


class FamilyPowers(NamedTuple):
    """families: Families of some paths; powers: list [F] of ep.ReceivedPower of these, in W"""

    families: Families
    powers: list

    @property
    def resolved(self) -> set:
        """The families whose power the rays know."""
        return {family for family, power in zip(self.families, self.powers) if power.resolved}


def family_powers(paths, objects=None, progress=None) -> FamilyPowers:
    """Of the families of paths; objects: as in `families`; progress: callable (stage, fraction) or None"""
    families = families_of(paths, objects)
    return FamilyPowers(families, mean_powers(paths, families, {}, progress).of_families)


@checked(objects=objects_rule, least_power=real(0.0, unit="W"))
def unresolved(paths: _core.Paths, objects: Objects = None, *, least_power: float = 0.0,
               progress: Progress = None) -> list[Unresolved]:
    """The objects, surroundings and ghost families whose mean received power the rays do not know to 0.3 dB.

    paths: of a trace; objects: as in `families`
    least_power: W, echoes whose interval ends below it are left out, such as those far below the noise
    progress: callable (stage, fraction), True for bars, or None
    Returns a list of Unresolved: first what took no mirror, then ghosts, strongest first; of many it prints the first. An
    object in sight of the radar that no ray has met is among them, with what three rays might have brought back from it
    as its upper end; so is one whose paths a selection or a file leaves out. Raises ValueError for bad names and for
    globs that take no mesh, KeyboardInterrupt on Ctrl-C.
    """
    found = family_powers(paths, objects, progress)
    return unresolved_of(paths, found, objects, least_power=least_power, progress=progress)


def unresolved_of(paths, found: FamilyPowers, objects=None, *, least_power=0.0, progress=None) -> list:
    """`unresolved` from powers that are known. found: of the paths and objects"""
    families, powers = found
    in_doubt = [(family, power) for family, power in zip(families.families, powers)
                if power.num_coherent_paths + power.num_diffuse_hits and not power.resolved]
    flagged = set(large_planes(paths.scene, paths.radar, paths.frame.trace_time) if in_doubt else ())
    planes = _Planes([mesh.name for mesh in paths.scene.meshes if mesh.id in flagged], families.objects)
    found = [Unresolved(family.object or SURROUNDINGS, tuple(family.via), family.ghost_type, family.order,
                        interval_of(power), _advice(paths, family, power, planes)) for family, power in in_doubt]
    met = {family.object for family, power in zip(families.families, powers) if not family.is_ghost and power.high > 0.0}
    found += _unseen(paths, objects, [name for name in families.objects if name not in met], progress)
    return UnresolvedList(sorted((one for one in found if one.interval.high > least_power),
                                 key=lambda one: (bool(one.via), -one.interval.power, -one.interval.high)))


# --- advice ---

class _Planes:
    """The meshes that `mark_mirrors` would flag, by what they belong to."""

    def __init__(self, names: list[str], objects):
        """names: of these meshes; objects: names of the objects"""
        self._of_node: dict[str, list] = {}  # numbers of those at a node and below it
        self._names = names
        for number, name in enumerate(names):
            for node in _nodes_of(name):
                self._of_node.setdefault(node, []).append(number)
        of_objects = {number for one in objects for number in self._of_node.get(one, ())}
        self._of_surroundings = [number for number in range(len(names)) if number not in of_objects]

    def touched_by(self, family) -> list[str]:
        """Names of those that a family touches and nobody marked; an object's own have images without being marked."""
        if not family.object:
            return [self._names[number] for number in self._of_surroundings]
        touched = {number for name in family.via for number in self._of_node.get(name, ())}
        return [self._names[number] for number in sorted(touched)]


def _nodes_of(name: str) -> list[str]:
    """Full names of a mesh's node and of all above it."""
    return ["/".join(name.split("/")[:depth + 1]) for depth in range(name.count("/") + 1)]


def _advice(paths, family, power, planes: _Planes) -> str:
    """What would resolve a power: mirrors for large planes, else as many rays as its interval asks for."""
    wide = [] if power.diffuse > power.coherent else planes.touched_by(family)
    if wide:
        return f"mirror=True for {', '.join(wide)}"
    if paths.frame.footprint == "none" and power.bias > power.chance:
        return "a footprint: without one nothing tells how coarse the rays are"
    if _is_known_but_for_the_mesh(power):
        return "a finer mesh; more rays hardly mend what facets, and edges behind other bounces, leave open"
    times = _times_the_rays(power)
    if times > MOST_TIMES:
        return f"more than {MOST_TIMES:g} times the rays"
    return _rays(paths, times)


def _rays(paths, times: float) -> str:
    """So many times the rays of the paths, in words of two digits."""
    rays = paths.frame.statistics.num_rays * times
    step = 10.0 ** (math.floor(math.log10(max(rays, 10.0))) - 1)
    return f"{round(rays / step) * step:,.0f} rays or more"


def _is_known_but_for_the_mesh(power) -> bool:
    bias, chance = _missing(power)
    return math.hypot(bias, chance) < 1.0


def _times_the_rays(power) -> float:
    """How many times the rays make the interval narrow enough where bias falls as their root, as chance does: of one surface it
    falls faster, of bodies of many panels or limbs as that at best."""
    bias, chance = _missing(power)
    return max(2.0, bias ** 2 + chance ** 2) if power.low > 0.0 else math.inf


def _missing(power) -> tuple[float, float]:
    """Bias and chance that more rays mend, over what a resolved power may have; infinite where it has none, or next to none."""
    wanted = power.power * (10.0 ** (0.1 * RESOLVED_DB) - 1.0)
    if wanted < sys.float_info.min:
        return math.inf, math.inf
    return power.bias_of_rays / wanted, 2.0 * power.chance / wanted


# --- what no ray has met ---

def _unseen(paths, objects, names, progress) -> list:
    """Unresolved for those `names` of the objects that the radar sees."""
    if not names:
        return []
    unmet, names, found = Unmet(paths), set(names), []
    for seen in visibility_in_trace(paths, paths.radar, objects, num_directions=UNMET_DIRECTIONS, progress=progress):
        interval = unmet.interval(seen) if seen.name in names else Interval(0.0, 0.0, 0.0)
        if interval.high > 0.0:
            found.append(Unresolved(seen.name, (), 0, 1, interval, unmet.advice(seen)))
    return found


class Unmet:
    """What no ray of some paths has met: what it may send, and what would meet it, object by object."""

    def __init__(self, paths):
        self._paths = paths

    def interval(self, seen) -> Interval:
        """Of the mean power in W of an object that no ray of the paths has met. seen: its ObjectVisibility

        From 0, to the power of the largest surface that the rays may have missed, facing the radar: as large as three launch
        cells there, or as all that is seen of the object; sigma = 4 pi A^2 / lambda^2 where it may reflect as a mirror does, as
        far as that is below pi d^2 of a mirror without end, and 4 A (Lambert). [0, 0] where nothing of the object is in sight.
        """
        if not (seen.transmitter.in_view and seen.receiver.in_view and seen.visible_share > 0.0):
            return Interval(0.0, 0.0, 0.0)
        density, radar = self._ray_density(seen.mesh_ids), self._paths.radar
        solid_angle = min(_visible_angle(seen), UNSEEN_HITS / max(density, 1e-300))
        distances = seen.transmitter.distance, max(seen.receiver.distance, 1e-3)
        wavelength = _core.speed_of_light / radar.waveform.start_frequency
        area = solid_angle * distances[0] ** 2
        most = math.pi * distances[0] * distances[1]  # of a mirror without end, whatever its area
        is_rough = all(self._meshes[mesh].material.scattering == 1.0 for mesh in seen.mesh_ids)
        cross_section = 4.0 * area + (0.0 if is_rough else min(4.0 * math.pi * area ** 2 / wavelength ** 2, most))
        gain = math.prod(max(one.pattern.peak_gain for one in antennas) for antennas in (radar.transmitters, radar.receivers))
        high = (radar.transmit_power * gain * wavelength ** 2 * cross_section
                / ((4.0 * math.pi) ** 3 * max(distances[0], 1e-3) ** 2 * distances[1] ** 2))
        return Interval(0.0, 0.0, high)

    def advice(self, seen) -> str:
        if self._paths.num_paths < self._paths.frame.statistics.num_paths:
            return "its paths may be among those that were left out of this record"
        times = max(2.0, UNSEEN_HITS / max(self._ray_density(seen.mesh_ids) * _visible_angle(seen), 1e-9))
        return f"{_rays(self._paths, times)} to meet it"

    def _ray_density(self, mesh_ids) -> float:
        """Rays per sr of the stratum that aims at an object, the thinnest of those at its things, or the field of view."""
        own = [density for node in self._nodes_above(mesh_ids) if (density := self._densities.get(node)) is not None]
        return min(own) if own else self._strata[-1].ray_density if self._strata else 0.0

    def _nodes_above(self, mesh_ids) -> set:
        """Indices of the nodes of meshes and of all above them."""
        above = set()
        for mesh in mesh_ids:
            node = self._meshes[mesh].node
            while node >= 0 and node not in above:
                above.add(node)
                node = self._nodes[node].parent
        return above

    @functools.cached_property
    def _nodes(self) -> list:
        return self._paths.scene.nodes  # a list that is made anew when it is asked for, as the next two

    @functools.cached_property
    def _meshes(self) -> list:
        return self._paths.scene.meshes

    @functools.cached_property
    def _strata(self) -> list:
        return self._paths.frame.strata

    @functools.cached_property
    def _densities(self) -> dict:
        """{index of a node: rays per sr of the thinnest stratum that aims at it}"""
        densities = {}
        for stratum in self._strata:
            if not stratum.num_mirrors and stratum.focus_of < 0:
                density = stratum.ray_density
                densities[stratum.object] = min(density, densities.get(stratum.object, density))
        return densities


def _visible_angle(seen) -> float:
    return seen.transmitter.solid_angle * seen.transmitter.visible_share
