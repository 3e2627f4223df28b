"""How transmitters share the chirps of a frame: codes of simultaneous transmission, and what undoes them.

Model: transmitters that send at once add up at each receiver. The core gives the signal of each transmitter alone for every
slot, at the slot's own time; the code of slot i multiplies it by e^{j phase} as it is added.
"""
from .code import code_of, code_signal, is_coded, signal_shape, slots_radar
from .demultiplex import demultiplex, mixes_of_turns
from .noise import noise_apart, radar_of_noise
from .signals import coded_cube, synthesize_slots

__all__ = ["code_of", "code_signal", "coded_cube", "demultiplex", "is_coded", "mixes_of_turns", "noise_apart", "radar_of_noise",
           "signal_shape", "slots_radar", "synthesize_slots"]
