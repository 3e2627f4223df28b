"""The whole chain beside the slow reference of the tests; only in a checkout of the sources, where that is."""
from __future__ import annotations

import functools
import sys
from pathlib import Path

from .case import Cases

cases = Cases("A slow reference of the equations")
TESTS = Path(__file__).resolve().parents[4] / "tests"
NUM_SCENES, NUM_ARRAYS = 20, 8  # each of the latter is four channels


@functools.lru_cache
def _deviations(kind: str) -> tuple:
    if str(TESTS) not in sys.path:
        sys.path.append(str(TESTS))
    from support.references import reference_scenes

    measure = getattr(reference_scenes, f"{kind}_deviation")
    return tuple(measure(seed) for seed in range(NUM_ARRAYS if kind == "array" else NUM_SCENES))


def field() -> float:
    return max(one.field for one in _deviations("coherent"))


def samples() -> float:
    return max(one.cube for one in _deviations("coherent"))


def polarized() -> float:
    return max(max(one.field, one.cube) for one in _deviations("polarized"))


def channels() -> float:
    return max(one.cube for one in _deviations("array"))


def power() -> float:
    return max(one.power for one in _deviations("diffuse"))


if (TESTS / "support").is_dir():
    cases("fields of 20 random scenes",
          "up to three moving smooth plates of metal or dielectrics, in each other's shadow, beside a large "
          "plane: complex field at mid-frame, currents summed over a grid", bound=0.01, unit="of the field",
          broken="no shadow rays: 0.25; the other root of a lossy permittivity: 0.12", heavy=True)(field)
    cases("IF samples of 20 random scenes", "the same with the delays of the equations at every sample, three "
          "chirps (edges of shadows fall between cells of the reference, 1 mm)", bound=0.01, unit="of the signal",
          broken="no shadow rays: 0.30; the other root of a lossy permittivity: 0.051", heavy=True)(samples)
    cases("field vectors of 20 random scenes",
          "the same between antennas of any two linear polarisations: field and IF samples", bound=0.01, unit="of either",
          broken="the other root of a lossy permittivity: 1.2", heavy=True)(polarized)
    cases("channels of 8 random scenes",
          "two transmitters, which take turns, and two receivers on a moving, turning radar: IF samples", bound=0.01,
          unit="of the signal", broken="all transmitters at the time of the first: 1.4", heavy=True)(channels)
    cases("diffuse powers of 20 random scenes",
          "rough plates, all pairs of legs with one phase a point: mean power, beyond 1 %", bound=4.0,
          unit="standard errors", broken="no shadow rays: 8.7", heavy=True)(power)
