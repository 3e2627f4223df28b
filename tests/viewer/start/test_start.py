"""What a start need not wait for."""
from __future__ import annotations

import os
import subprocess
import sys

SCRIPT = """
import sys
import echopath_viewer.scene_builder
assert "pyvista.plotting" in sys.modules
loaded = [name for name in ("matplotlib.pyplot", "matplotlib.backends.backend_agg") if name in sys.modules]
assert not loaded, loaded
import matplotlib.pyplot as plt
import pyvista
assert plt.figure().axes == []
assert pyvista.plotting.colors.get_matplotlib_theme_cycler() == plt.rcParams["axes.prop_cycle"]
chart = pyvista.ChartMPL(plt.figure())
assert type(chart._canvas).__name__ == "FigureCanvasAgg"
"""


def test_pyvista_comes_without_pyplot_which_works_when_it_is_asked_for():
    # Without a backend that asks for the screen: a virtual one resets when its last program leaves, and refuses the next then.
    done = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=False,
                          env=os.environ | {"MPLBACKEND": "agg"})
    assert done.returncode == 0, done.stderr
