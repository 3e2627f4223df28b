"""Detections: echoes above the noise with their place, their label and the paths behind them."""
from .detect import detect
from .detections import Detections
from .of_frame import detect_frame

__all__ = ["Detections", "detect", "detect_frame"]
