"""What sheets, materials of layers, do to waves."""
from __future__ import annotations

import dataclasses
from collections.abc import Iterator

import numpy as np

from .. import _core
from ..arguments.checks import ArrayLike, an, anything, array, carrier, checked, flag, real
from ..base.classes.equality import has_same_fields
from ..base.classes.made_by import made_by
from ..base.radar.antennas import polarization_across
from ..base.text.counts import counted


@made_by("ep.sheet_coefficients")
@dataclasses.dataclass(frozen=True, eq=False)
class SheetCoefficients:
    """Fields that a sheet reflects and lets pass, over that of the wave; made by `sheet_coefficients`.

    incidence: rad from the normal [N]
    te_reflection, tm_reflection: complex [N], at the face that the wave meets
    te_transmission, tm_transmission: complex [N], from that face to the other one, at the same point of both
    te_delay, tm_delay: m [N], by how much longer the way seems to be than through air, the mean over the band
    TE has its electric field across the plane of incidence, TM in it; signs are those of Fresnel's coefficients here.
    """

    incidence: np.ndarray
    te_reflection: np.ndarray
    tm_reflection: np.ndarray
    te_transmission: np.ndarray
    tm_transmission: np.ndarray
    te_delay: np.ndarray
    tm_delay: np.ndarray

    @checked(self=anything, te_share=real(0.0, 1.0))
    def passed_power(self, te_share: float = 0.5) -> np.ndarray:
        """Share of the power that passes [N].

        te_share: of the wave's power that is TE, in [0, 1]
        Raises TypeError or ValueError naming the argument.
        """
        te, tm = np.abs(self.te_transmission) ** 2, np.abs(self.tm_transmission) ** 2
        return te_share * te + (1.0 - te_share) * tm

    def __repr__(self) -> str:
        first, last = np.degrees([self.incidence.min(), self.incidence.max()]) if self.incidence.size else (np.nan, np.nan)
        return f"SheetCoefficients({counted(self.incidence.size, 'angle')} from {first:.4g} to {last:.4g} degrees)"

    def __eq__(self, other) -> bool:
        return has_same_fields(self, other) if isinstance(other, SheetCoefficients) else NotImplemented

    __hash__ = None


@checked(material=an(_core.Material), frequency=carrier, incidence=array("[]", "[N]", finite=True), from_behind=flag,
         bandwidth=real(0.0))
def sheet_coefficients(material: _core.Material, *, frequency: float, incidence: ArrayLike,
                       from_behind: bool = False, bandwidth: float = 0.0) -> SheetCoefficients:
    """What a sheet reflects and lets pass: Airy's sums over all bounces within its layers.

    material: one with layers
    frequency: Hz
    incidence: rad from the normal, in [0, pi/2], a number or [N]
    from_behind: the wave meets the last layer first
    bandwidth: Hz, of the band from `frequency` on over which delays are the mean, as they are of a radar; 0: at `frequency`
        alone. Fields are those at `frequency`.
    Returns SheetCoefficients, [N] each. Raises TypeError or ValueError naming the argument.
    """
    angles = np.atleast_1d(np.array(incidence, np.float64))  # a copy, which the result keeps
    rows = _core._sheet_coefficients(material, frequency, angles, from_behind, bandwidth)
    return SheetCoefficients(angles, *rows[:4], rows[4].real, rows[4].imag)


_SAME_PLACE = 1e-9  # of a way: where it meets two triangles of a sheet at their common edge


def passed_field(scene, *, time: float, begin: np.ndarray, end: np.ndarray, frequency: float, polarization: np.ndarray) -> float:
    """What the sheets of a scene leave of the size of a field on a straight way between two places.

    time: s; begin, end: [3] m; frequency: Hz; polarization: [3], of the field
    """
    way = (end - begin) / np.linalg.norm(end - begin)
    field, left = polarization_across(polarization[None], way[None])[0], 1.0
    for material, normal in _crossings(scene, time, begin, end):
        across = np.cross(way, normal)
        incidence = np.arctan2(np.linalg.norm(across), abs(way @ normal))
        te_share = (field @ across) ** 2 / max(across @ across, _SAME_PLACE ** 2)
        sheet = sheet_coefficients(material, frequency=frequency, incidence=float(incidence))
        left *= float(np.sqrt(sheet.passed_power(min(te_share, 1.0))[0]))
    return left


def _crossings(scene, time: float, begin, end) -> Iterator[tuple]:
    """(material, unit normal [3]) of each sheet that a way from `begin` to `end` goes through."""
    for one in scene.meshes:
        if not one.material.layers:
            continue
        corners = np.asarray(scene.world_vertices(one.id, time))[one.triangles]
        first, second, away = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], begin - corners[:, 0]
        normals = np.cross(first, second)
        with np.errstate(divide="ignore", invalid="ignore"):  # of ways along a triangle
            scale = -1.0 / (normals @ (end - begin))
            share = np.sum(normals * away, axis=1) * scale
            turn = np.cross(end - begin, away)
            u, v = -np.sum(turn * second, axis=1) * scale, np.sum(turn * first, axis=1) * scale
            is_met = (share > 0.0) & (share < 1.0) & (np.minimum(u, v) >= -_SAME_PLACE) & (u + v <= 1.0 + _SAME_PLACE)
        met = np.flatnonzero(is_met)
        met = met[np.argsort(share[met])]
        for triangle in met[np.diff(share[met], prepend=-1.0) > _SAME_PLACE]:
            yield one.material, normals[triangle] / np.linalg.norm(normals[triangle])
