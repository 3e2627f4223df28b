"""What a real receiver makes of the ideal signal: `Receiver`, a value of the Radar, and `receive`, which applies it.

Order of the stages, each of which costs nothing where it is off:
1. gain and phase errors of the transmitters, before they add up where they send at once
2. leakage of the transmitters into the receivers, one more echo each
3. the oscillator: phase noise and error of its frequency, both as the difference between now and an echo's delay ago
4. coupling between the receivers, then gain and phase errors of each
5. thermal noise of the radar's noise figure
6. compression of the amplifiers
7. high-pass and low-pass filters of the intermediate frequency
8. imbalance of the two branches of the mixer, and their offsets
9. the converter: gain, clock jitter, saturation and quantisation
What is linear in both branches alike commutes with the imbalance, so that filters may stand before it. `receive_parts` sends
the parts of a signal through the same stages.
"""
from .chain import Reception, receive
from .parts import receive_parts
from .settings import Adc, PhaseNoise, Receiver

__all__ = ["Adc", "PhaseNoise", "Receiver", "Reception", "receive", "receive_parts"]
