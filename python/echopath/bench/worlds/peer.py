"""Sionna RT, a ray tracer of radio channels, where it is installed: its scenes, its paths in them and its seconds."""
from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from pathlib import Path

SCRIPT = Path(__file__).with_name("sionna_script.py")
WHERE = "import importlib.util as u; print(u.find_spec('sionna.rt').submodule_search_locations[0])"
NOT_INSTALLED = "sionna-rt is not installed"


def scenes_of(python: str | None) -> Path | None:
    """The folder of the scenes that the peer ships; None where this interpreter has no sionna-rt.

    python: an interpreter, None: this one
    """
    done = subprocess.run([python or sys.executable, "-c", WHERE], capture_output=True, text=True)
    return None if done.returncode else Path(done.stdout.strip()) / "scenes"


def asked(python: str | None, request: dict) -> dict:
    """What `sionna_script.answer` says to a request. Raises RuntimeError with what the peer said where it failed."""
    with tempfile.TemporaryDirectory() as folder:
        question, answer = Path(folder, "request.json"), Path(folder, "answer.json")
        question.write_text(json.dumps(request), encoding="utf-8")
        done = subprocess.run([python or sys.executable, SCRIPT, question, answer], capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f"Sionna RT ended with {done.returncode}: {done.stderr.strip()[-500:]}")
        return json.loads(answer.read_text(encoding="utf-8"))
