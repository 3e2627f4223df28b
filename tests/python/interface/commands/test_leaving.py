"""Python may end while other threads are at work in the core: the process ends quietly, with the exit code of its own."""
import subprocess
import sys

import pytest

BEGIN = """
import sys, threading, time
import numpy as np
import echopath as ep
from echopath import _core

def at_once(work):
    threading.Thread(target=work, daemon=True).start()
    time.sleep(0.1)
"""
WORK = {
    "waiting": "at_once(lambda: _core._wait(600.0))",
    "with progress": "at_once(lambda: _core._wait(600.0, lambda stage, fraction: time.sleep(0.002)))",
    "again and again": """
def work():
    while True:
        try:
            _core._wait(0.001)
        except Exception:
            pass
at_once(work)
""",
    "over soon": """
points, corners = np.random.default_rng(1).uniform(0, 1, (60000, 3)), np.arange(60000, dtype=np.uint32).reshape(-1, 3)
def work():
    while True:
        ep.Mesh(points, corners)
for _ in range(3):
    at_once(work)
""",
    "in an exit handler": """
import atexit
at_once(lambda: _core._wait(600.0))
atexit.register(_core._wait, 0.01)
atexit.register(print, "done")
""",
}


@pytest.mark.parametrize("name", WORK)
def test_python_ends_while_a_daemon_thread_works(name):
    done = subprocess.run([sys.executable, "-c", BEGIN + WORK[name] + "\nsys.exit(7)"], capture_output=True, text=True,
                          timeout=60)
    assert (done.returncode, done.stderr) == (7, "")
