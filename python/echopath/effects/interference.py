"""Effects of the other radars of a scene."""
from __future__ import annotations

import numpy as np

from ..arguments.effects import INTERFERENCE, is_on
from ..base.numerics.decibels import in_dbm
from .rules import Case, rule


@rule(INTERFERENCE, "Scene.interferers")
def _interference(case: Case):
    if case.interference_cube is not None:
        if not np.any(case.interference_cube):
            return True, "no other radar is heard in the frame"
        return True, f"{in_dbm(float(np.mean(np.abs(case.interference_cube)**2))):.1f} dBm of other radars, on the whole alone"
    if not case.interferers:
        return False, case.why_none("other radars")
    radars = "another radar" if len(case.interferers) == 1 else f"{len(case.interferers)} other radars"
    if not is_on(case.settings.effects, INTERFERENCE, True, ""):
        return False, f"effects has it off: {radars}"
    if case.paths is not None:
        return False, f"paths have none; simulate adds it, of {radars}"
    return True, f"of {radars}"
