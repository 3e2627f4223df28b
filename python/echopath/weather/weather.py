"""What the air does to a radar: the gases, fog and rain of a scene."""
from __future__ import annotations

import math
from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from .. import _core
from ..arguments.checks import Rule, anything, checked, real, refused, vector
from ..arguments.effects import ATTENUATION, Choices, is_on
from ..arguments.settings import Settings, settings_class
from ..base.radar.antennas import polarization_of
from .drops import reflectivities
from .fog import fog_attenuation
from .gas import gas_attenuation, saturation_pressure
from .rain import rain_attenuation

DB_PER_NEPER = 20.0 / math.log(10.0)
FASTEST_WIND = 1000.0  # m/s, beyond any storm
BAND = 1e9, 1e12  # Hz, in which the recommendations hold: fits to them go anywhere beyond


def _wind(argument: str, value) -> tuple[float, float, float]:
    wind = tuple(vector(argument, value).tolist())
    if max(map(abs, wind)) > FASTEST_WIND:
        raise refused(ValueError, argument, f"[3], each of at most {FASTEST_WIND:g} m/s", value)
    return wind


@settings_class
class Weather(Settings):
    """The air of a scene (`Scene.weather`): it weakens echoes along their whole way, and rain has echoes of its own.

    rain_mm_per_hour: 0 to 300; fog_g_per_m3: water in fog, 0 to 10 (0.05: sight of 300 m, 0.5: of 50 m)
    temperature: K; pressure: Pa; humidity: of the air, share in [0, 1] of saturation
    wind: [3] in m/s, each at most 1000, world axes, of the drops beside their fall; turbulence: m/s, spread of each velocity
    Attenuation by gases is that of Recommendation ITU-R P.676-12 (line by line), by fog P.840-8 (droplets), by rain P.838-3, all
    for 1 GHz to 1 THz (fog: 200 GHz), on level paths. The echoes of rain are those of spheres of water with the sizes of
    Marshall and Palmer 1948.
    Raises TypeError or ValueError naming the keyword. Values are frozen; two with equal values are equal.
    """

    rain_mm_per_hour: float = 0.0
    fog_g_per_m3: float = 0.0
    temperature: float = 288.15
    pressure: float = 101325.0
    humidity: float = 0.6
    wind: tuple[float, float, float] = (0.0, 0.0, 0.0)
    turbulence: float = 0.5

    RULES: ClassVar[Mapping[str, Rule]] = {
        "rain_mm_per_hour": real(0.0, 300.0, "mm/h"), "fog_g_per_m3": real(0.0, 10.0, "g/m^3"),
        "temperature": real(200.0, 340.0, "K"), "pressure": real(1e4, 1.2e5, "Pa"), "humidity": real(0.0, 1.0),
        "wind": _wind, "turbulence": real(0.0, 100.0, "m/s")}

    def __post_init__(self) -> None:
        super().__post_init__()
        boiling = 100.0 * saturation_pressure(self.temperature, 1e-2 * self.pressure)  # Pa
        if self.humidity * boiling > self.pressure:
            raise refused(ValueError, "humidity", f"at most {self.pressure / boiling:.3g} at {self.temperature:g} K and "
                          f"{self.pressure:g} Pa, where vapour is all of the air", self.humidity)

    @checked(self=anything)
    def attenuation_db_per_km(self, radar: _core.Radar) -> dict[str, float]:
        """{"gases", "fog", "rain"}: dB/km one way at the middle of the radar's band, for its first transmitter's polarisation.

        radar: whose echoes are weakened. Raises TypeError or ValueError naming the argument, also beyond 1 GHz to 1 THz.
        """
        frequency = radar.waveform.centre_frequency
        if not BAND[0] <= frequency <= BAND[1]:
            raise refused(ValueError, "radar", f"of {BAND[0]:g} to {BAND[1]:g} Hz for attenuation by weather, which "
                          f"effects={{{ATTENUATION!r}: False}} leaves out", frequency)
        vapour = self.humidity * saturation_pressure(self.temperature, 1e-2 * self.pressure)
        return {"gases": gas_attenuation(frequency, self.temperature, 1e-2 * self.pressure - vapour, vapour),
                "fog": fog_attenuation(frequency, self.fog_g_per_m3, self.temperature) if self.fog_g_per_m3 else 0.0,
                "rain": rain_attenuation(frequency, self.rain_mm_per_hour, _tilt(radar))}

    @checked(self=anything)
    def rain_reflectivity(self, radar: _core.Radar) -> float:
        """Radar cross section of rain per volume, 1/m, at the middle of the radar's band.

        radar: that sees it. Raises TypeError naming the argument.
        """
        return float(reflectivities(radar.waveform.centre_frequency, self.rain_mm_per_hour, self.temperature).sum())


def _tilt(radar) -> float:
    """rad, of the first transmitter's polarisation from the horizontal, where the radar stands level."""
    polarization = polarization_of(radar.transmitters[0])
    return math.asin(min(1.0, abs(float(polarization[2])) / float(np.linalg.norm(polarization))))


def weather_of(scene) -> Weather | None:
    """Of a scene; records keep scenes without."""
    return getattr(scene, "weather", None)


def weather_text(weather: Weather | None) -> str:
    """What differs from the air of a clear day, in words."""
    if weather is None:
        return "none"
    usual = Weather()
    found = [f"{name} {value:g}" if isinstance(value, float) else f"{name} {value}"
             for name, value in weather.keywords().items() if value != getattr(usual, name)]
    return ", ".join(found) or "clear"


def attenuation_of(scene, radar: _core.Radar, effects: Choices = ()) -> float:
    """Np/m of fields; 0 without weather, or where `effects` switch it off."""
    return attenuation_of_weather(weather_of(scene), radar, effects)


def attenuation_of_weather(weather: Weather | None, radar: _core.Radar, effects: Choices = ()) -> float:
    """The same of a scene's weather."""
    if weather is None and dict(effects).get(ATTENUATION) is not True:
        return 0.0
    if not is_on(effects, ATTENUATION, weather is not None, "Scene.weather"):
        return 0.0
    assert weather is not None
    return 1e-3 * sum(weather.attenuation_db_per_km(radar).values()) / DB_PER_NEPER
