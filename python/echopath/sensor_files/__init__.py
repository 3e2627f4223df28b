"""Files of sensors: their configurations, the antennas of their boards, patterns, and raw data as they write it."""
from .load import SensorConfig, load_radar, load_sensor
from .raw import load_raw, raw_bytes, save_raw

__all__ = ["SensorConfig", "load_radar", "load_raw", "load_sensor", "raw_bytes", "save_raw"]
