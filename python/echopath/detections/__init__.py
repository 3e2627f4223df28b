"""Detections: echoes above the noise with their place, their label and the paths behind them."""
from .detect import detect, detected
from .detections import Detections

__all__ = ["Detections", "detect", "detected"]
