"""Sionna RT, a ray tracer of radio channels, where it is installed: its scenes, its paths in them and its seconds."""
from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

SCRIPT = Path(__file__).with_name("sionna_script.py")
WHERE = "import importlib.util as u; print(u.find_spec('sionna.rt').submodule_search_locations[0])"


def require_python(python: str | None, name: str) -> None:
    """Raises ValueError naming the argument `name` for what is not a Python that can be run; None: this one."""
    try:
        runs = python is None or _run(python, "-c", "").returncode == 0
    except OSError:
        runs = False
    if not runs:
        raise ValueError(f"{name}: must be a Python that can be run, got {python}")


def scenes_of(python: str | None) -> Path | None:
    """The folder of the scenes that the peer ships; None where this interpreter has no sionna-rt.

    python: an interpreter, None: this one
    """
    done = _run(python, "-c", WHERE)
    lines = done.stdout.splitlines()  # packages may greet in those before the last
    folder = Path(lines[-1].strip(), "scenes") if lines and not done.returncode else None
    return folder if folder is not None and folder.is_dir() else None


def missing(python: str | None) -> str:
    """Says that an interpreter has no sionna-rt."""
    return "sionna-rt is not installed" if python is None else f"{python} has no sionna-rt"


def asked(python: str | None, request: dict) -> dict:
    """What `sionna_script.answer` says to a request. Raises RuntimeError with what the peer said where it failed."""
    with tempfile.TemporaryDirectory() as folder:
        question, answer = Path(folder, "request.json"), Path(folder, "answer.json")
        question.write_text(json.dumps(request), encoding="utf-8")
        done = _run(python, SCRIPT, question, answer)
        if done.returncode:
            raise RuntimeError(f"Sionna RT ended with {done.returncode}: {done.stderr.strip()[-500:]}")
        return json.loads(answer.read_text(encoding="utf-8"))


def _run(python: str | None, *arguments) -> subprocess.CompletedProcess:
    """Runs an interpreter that finds no modules beside the script, nor in the working folder (from Python 3.11 on)."""
    return subprocess.run([python or sys.executable, *arguments], capture_output=True, text=True,
                          env=os.environ | {"PYTHONSAFEPATH": "1"})
