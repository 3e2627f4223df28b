"""Maps over time of frames in a row: spectrograms with their labels, range and azimuth over time."""
from .columns import angle_time, range_time
from .maps import AngleTime, RangeTime, Spectrogram
from .spectrogram import spectrogram
from .spectrogram_labels import SpectrogramLabels, spectrogram_labels

__all__ = ["AngleTime", "RangeTime", "Spectrogram", "SpectrogramLabels", "angle_time", "range_time", "spectrogram",
           "spectrogram_labels"]
