"""Effects of the air, fog and rain of a scene."""
from __future__ import annotations

import numpy as np

from ..arguments.effects import ATTENUATION, RAIN_ECHOES, is_on
from ..base.numerics.decibels import in_dbm
from ..signals.rain_echoes import rain_power
from ..weather.weather import DB_PER_NEPER, attenuation_of_weather
from .rules import Case, rule


@rule(ATTENUATION, "Scene.weather", "trace.effects")
def _attenuation(case: Case):
    if case.paths is not None:
        attenuation = case.paths.frame.attenuation
        return attenuation > 0, _of_paths(case.paths, attenuation) if attenuation > 0 else _why_off(case)
    if case.weather is None:
        return False, "the scene has no weather"
    if not is_on(case.settings.effects, ATTENUATION, True, ""):
        return False, "effects has it off"
    parts = case.weather.attenuation_db_per_km(case.radar)
    return True, f"{sum(parts.values()):.2g} dB/km: " + ", ".join(f"{name} {value:.2g}" for name, value in parts.items())


def _of_paths(paths, attenuation: float) -> str:
    powers, lengths = np.asarray(paths.power), paths.lengths([paths.frame.trace_time], 0, 0)[0]
    without = np.sum(powers * np.exp(2.0 * attenuation * lengths))
    lost = f", {10.0 * np.log10(without / powers.sum()):.2g} dB of the power" if powers.sum() > 0 else ""
    return f"{1e3 * DB_PER_NEPER * attenuation:.2g} dB/km{lost}"


def _why_off(case: Case) -> str:
    return "effects has it off" if dict(case.settings.effects).get(ATTENUATION) is False else "the scene has no weather"


@rule(RAIN_ECHOES, "Scene.weather")
def _rain(case: Case):
    if case.rain_cube is not None:
        return True, f"{in_dbm(float(np.mean(np.abs(case.rain_cube)**2))):.1f} dBm, on the whole alone"
    if case.weather is None or case.weather.rain_mm_per_hour == 0:
        return False, case.why_none("rain")
    power = rain_power(case.radar, case.weather, attenuation_of_weather(case.weather, case.radar, case.settings.effects))
    text = f"{in_dbm(power):.1f} dBm where nothing hides it"
    if not is_on(case.settings.effects, RAIN_ECHOES, True, ""):
        return False, f"effects has them off; they would carry {text}"
    if case.paths is not None:
        return False, f"paths have none; simulate adds them, {text}"
    return True, text
