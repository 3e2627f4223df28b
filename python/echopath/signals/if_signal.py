"""The IF signal of paths, and the receiver's noise."""
from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..arguments.checks import ArrayLike, MapWindow, Progress, an, checked, one_of, optional, real
from ..arguments.settings import Evaluate, Method, Replay, Retrace, SignalSettings
from ..base.process.callers import warn_user
from ..receiver.chain import transmitted_code
from ..receiver.filters import has_filters
from ..tracing.faint_paths import warn_of_other_noise
from ..transmit import code_signal, is_coded, radar_of_noise, slots_radar, synthesize_slots
from .silence import warn_of_silence

NoiseOf = Literal["cell", "sample"]
RULES = SignalSettings.RULES | {"radar": optional(an(_core.Radar)), "probe": optional(an(_core.SignalProbe))}


@checked({"settings": SignalSettings}, **RULES)
def synthesize(paths: _core.Paths, radar: _core.Radar | None = None, *, tolerance: float = SignalSettings.tolerance,
               method: Method = SignalSettings.method, replay: Replay = SignalSettings.replay,
               evaluate: Evaluate = SignalSettings.evaluate, phase_tolerance: float = SignalSettings.phase_tolerance,
               retrace: Retrace = SignalSettings.retrace, keyframes: int = SignalSettings.keyframes,
               settings: SignalSettings | None = None, probe: _core.SignalProbe | None = None,
               progress: Progress = None) -> NDArray[np.complex128]:
    """The noise-free IF signal of paths.

    paths: of `trace`
    radar: another waveform, array or motion than that of the trace, or None
    tolerance: rms error of the samples relative to the sum of all |amplitudes|, 1e-13 to 0.1
    method: "auto", "direct" (the reference), "recurrence" or "nufft"
    replay: where specular hits on surfaces that are no mirrors stand: "material" (where the trace found them, moving with
        their triangles) or "fermat" (one Newton step from there to the moved point of reflection, for each antenna)
    evaluate: "interpolated" (by polynomials in time: lengths to phase_tolerance in rad, amplitudes to ten times that of the
        largest of each path, at most 1e-4), "chirps" (in every chirp: the reference), or "samples" (interpolated, and moving
        echoes with the delay of every sample: for fast rotors, a sine and a cosine per path and sample)
    retrace: for each of `keyframes` stretches of chirps, "never" (one record serves the frame), "invalid" (shadows and points
        of reflection are renewed, see `renew`; surface that comes into view gets paths of its own if `paths` are those of a
        whole trace, and none if they are a selection) or "always" (the scene is traced anew with the same settings and seed;
        random phases of rough surfaces then differ from one stretch to the next, which suits coherent echoes; not for
        selections)
    keyframes: number of stretches, 1 to num_chirps; 0: as many as `validity` suggests
    settings: SignalSettings that give the keywords which the call leaves out, or None
    probe: a SignalProbe, filled with spot checks of this signal, or None
    progress: callable (stage, fraction), True for bars, or None
    Returns the cube [tx, rx, chirp, sample], complex128 in sqrt(W); of transmitters that send at once [1, rx, slots, sample],
    which `demultiplex` takes apart, with the errors of their chains where the Receiver has some: it needs the memory of all
    transmitters. Waveforms whose slots differ cost one synthesis for each kind of chirp, and take no probe. Warns
    (RuntimeWarning) of what will take over 10 s, where there are paths and no signal, and where faint paths were left out for
    a radar that hears less. Raises TypeError or ValueError naming the argument, KeyboardInterrupt on Ctrl-C.
    """
    radar = paths.radar if radar is None else radar
    warn_of_other_noise(paths, radar)
    made_by = dict(tolerance=tolerance, method=method, replay=replay, evaluate=evaluate, phase_tolerance=phase_tolerance,
                   retrace=retrace, keyframes=keyframes, progress=progress)
    separate = synthesize_slots(paths, slots_radar(radar) if is_coded(radar) else radar, **made_by, probe=probe)
    warn_of_silence(paths, radar, separate)
    return code_signal(separate, transmitted_code(radar), radar.waveform) if is_coded(radar) else separate


@checked(of=one_of(NoiseOf))
def noise_power(radar: _core.Radar, window: MapWindow = SignalSettings.window, *, of: NoiseOf = "cell") -> float:
    """Mean power of the receiver's thermal noise, W.

    In a cell it is k T0 F fs Br Bv / (N M) of N samples and M chirps, whose windows have the noise bandwidths Br and Bv in cells.
    An echo whose `received_power` is as much has a signal-to-noise ratio of 0 dB at its peak.
    radar: whose noise figure, sampling rate, samples and chirps count
    window: of the map, as in `range_doppler`; a sample has none
    of: "cell" of a range-Doppler map of one channel, or "sample" of the IF signal [tx, rx, chirp, sample], as `add_noise` draws
        it: of "bpm" the mean over the num_slots slots of a chirp, each of which has num_slots times as much
    Returns W. Raises TypeError or ValueError naming the argument.
    """
    return _core.noise_power(radar) if of == "sample" else _core.cell_noise_power(radar, window)


@checked(start_time=real(unit="s"))
def add_noise(cube: ArrayLike, radar: _core.Radar, *, seed: int, start_time: float = 0.0) -> NDArray[np.complex128]:
    """Adds the receiver's thermal noise to a cube.

    Circular Gaussian of k T0 F fs per complex sample, half of it for real samples, independent between samples and between
    frames that start at different times.
    cube: [tx, rx, chirp, sample] in sqrt(W), of that radar, or [1, rx, slots, sample] before `demultiplex`
    radar: whose noise figure and sampling rate count
    seed: 0 or more; start_time: s, first sample of the frame (`paths.frame.start_time`): the noise is drawn from both, so
        that frames in a row have one seed and noise of their own, and each the same noise whether it is made alone or not.
        Without start_time every frame has the noise of one that starts at 0: the same in all frames of one seed
    Returns a new cube of that shape in sqrt(W). Raises TypeError or ValueError naming the argument, also unless the cube has
    the shape that the radar gives it. Warns (RuntimeWarning) where filters of `radar.receiver` would shape the noise, as
    those of sensor files do: `receive` gives the signal and the noise behind them.
    """
    receiver = radar.receiver
    if is_coded(radar) and np.shape(cube)[0] == 1:
        radar = radar_of_noise(radar)
    noisy = _core.add_noise(cube, radar, seed=seed, start_time=start_time)
    if receiver is not None and has_filters(receiver):
        warn_user("radar: has a receiver whose filters shape its noise, which is white here, so that detections that go by this "
                  "radar find false ones; take ep.receive(cube, radar, seed=1).cube, or radar.replace(receiver=None) for all")
    return noisy
