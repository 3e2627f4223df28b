"""Where the feet are: planted and rolling in stance, on a smooth arc in swing.

The walking model bends the joints of a leg without regard to the floor, so that its feet slide and sink. Here the
foot comes first: its pitch agrees with the model at the strike and, within bounds, as the toes leave; in between the
sole rolls over the floor (foot.Sole), and the leg is bent to reach it (gait.py). The constants that shape the way
between were chosen so that the knee of a walk at 1.4 m/s bends as measured ones do: about 20 deg under load, 60 deg
in swing.
"""
import numpy as np

from ..curves import quintic

MODEL_FLAT = 0.30                                 # phase at which the model's foot is nearest to flat
STRIKE_RATE = 1.2                                 # pitch rate at the strike, over the mean rate until the sole is down
TOE_OFF_RATE = 2.5                                # pitch rate as the toes leave, over the mean rate since heel off
STRIKE_PITCH = (np.radians(4.0), np.radians(30.0))  # bounds of the pitch at heel strike
TOE_OFF_PITCH = (np.radians(-57.0), np.radians(-15.0))  # bounds of the pitch as the toes leave
CORNER = np.radians(16.0)                         # pitch within which a swinging foot is kept off its own corner
STEP = 1e-4                                       # phase step of numerical derivatives


class Steps:
    """Motion of one foot over its phase; its stances start at whole phases.

    sole: foot.Sole; walk: boulic.Walk; cycle: boulic.Cycle. Lengths in m, angles in rad. The attributes of the class are
    those of walking; running has its own (running.py).
    """

    flat_begin = 0.075                # phase at which the whole sole is down
    heel_off = 0.25                   # phase at which the heel begins to rise
    detour = (-0.015, -0.185)         # even and odd part of the swing's lead, in cycle lengths
    pitch_detour = (0.0, 0.5)         # likewise of the swing's pitch, over the pitch as the toes leave
    toe_lift = (0.012, 2.5, 6.0)      # rise of the sole early in swing, in cycle lengths, and the powers of its shape
    heel_lift = (0.016, 5.0, 2.5)     # likewise late in swing

    def __init__(self, sole, walk, cycle):
        self.sole, self.support, self.stride = sole, cycle.support, cycle.length
        self.opening = walk.foot_opening()
        self.strike_pitch, self.toe_off_pitch = self._bounds(walk)
        self._corner = max(-CORNER, self.toe_off_pitch), min(CORNER, self.strike_pitch)
        ends = (cycle.support, 0.0)
        self._pitch_ends = [self._by_swing(_jet(self._stance_pitch, end)) for end in ends]
        self._ends = [self._by_swing(_jet(lambda part: self._rolled(self._stance_pitch(part)), end)) for end in ends]
        self._ends[1][0] = self._ends[1][0] + [self.stride, 0.0]

    def _bounds(self, walk):
        """Pitch of the foot at its strike and as its toes leave."""
        rise = _model_pitch(walk, self.support) - _model_pitch(walk, MODEL_FLAT)
        return float(np.clip(_model_pitch(walk, 0.0), *STRIKE_PITCH)), float(np.clip(rise, *TOE_OFF_PITCH))

    def at(self, phase):
        """Ankle [T, 3] (x forward, y outwards, z above the floor) and pitch [T] at phases [T].

        The ankle is relative to its place over the flat foot in the stance of phase 0; each cycle adds a stride to x.
        """
        phase = np.asarray(phase, dtype=float)
        cycle = np.floor(phase)
        part = phase - cycle
        swings = part > self.support
        s = np.clip((part - self.support) / (1.0 - self.support), 0.0, 1.0)
        pitch = np.where(swings, self._swing_pitch(s), self._stance_pitch(part))
        plane = np.where(swings[:, None], self._swing(s), self._rolled(pitch))
        lift = self.stride * (_lift(s, *self.toe_lift) + _lift(s, *self.heel_lift))
        height = np.where(swings, self.sole.ankle_clear_of_floor(pitch, *self._corner) + lift,
                          self.sole.ankle_above_floor(pitch))
        return np.column_stack([plane[:, 0] + cycle * self.stride, plane[:, 1], height]), pitch

    def _stance_pitch(self, part):
        landing = quintic(part / self.flat_begin, (self.strike_pitch, -STRIKE_RATE * self.strike_pitch, 0), (0, 0, 0))
        leaving = quintic((part - self.heel_off) / (self.support - self.heel_off), (0, 0, 0),
                          (self.toe_off_pitch, TOE_OFF_RATE * self.toe_off_pitch, 0))
        return np.where(part < self.flat_begin, landing, 0.0) + np.where(part > self.heel_off, leaving, 0.0)

    def _swing_pitch(self, s):
        return quintic(s, *self._pitch_ends) + self.toe_off_pitch * _bump(s, 3, 3) * (
            self.pitch_detour[0] + self.pitch_detour[1] * (2.0 * s - 1.0))

    def _rolled(self, pitch):
        """Displacement [T, 2] of the ankle by rolling along the foot's axis."""
        return np.multiply.outer(self.sole.ankle_lead(pitch), [np.cos(self.opening), np.sin(self.opening)])

    def _swing(self, s):
        """Displacement [T, 2] of the ankle at a share s [T] of the swing."""
        plane = quintic(s, *self._ends)
        plane[:, 0] += self.stride * _bump(s, 3, 3) * (self.detour[0] + self.detour[1] * (2.0 * s - 1.0))
        return plane

    def _by_swing(self, jet):
        """Derivatives by phase to derivatives by the share of the swing."""
        return [value * (1.0 - self.support) ** order for order, value in enumerate(jet)]


def _model_pitch(walk, phase):
    """Pitch of the model's foot when its pelvis is upright."""
    return float(walk.hip(phase) - walk.knee(phase) + walk.ankle(phase))


def _lift(s, height, rise, fall):
    return height * _bump(s, rise, fall)


def _bump(s, rise, fall):
    """s^rise (1 - s)^fall, scaled to a maximum of 1. Powers above 2 leave and reach the ends without acceleration."""
    top = rise / (rise + fall)
    return s**rise * (1.0 - s) ** fall / (top**rise * (1.0 - top) ** fall)


def _jet(function, at):
    """Value, first and second derivative of function [T] -> [T, ...] at one argument."""
    before, here, after = (np.asarray(function(np.array(at + d)), dtype=float) for d in (-STEP, 0.0, STEP))
    return here, (after - before) / (2 * STEP), (after - 2 * here + before) / STEP**2
