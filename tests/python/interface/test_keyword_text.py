"""Keywords that are no Unicode text are refused; wording another error about them once ended the process."""
import subprocess
import sys

import pytest

CALLS = {
    "constructor": "ep.Mesh([[0, 0, 0]], [[0, 0, 0]], **word)",
    "constructor without others": "ep.Selection('T . R', **word)",
    "method": "ep.Isotropic(1.0).gain(1.0, **word)",
    "static method": "ep.Paths.from_arrays(**word)",
    "function": "ep.synthesize(None, **word)",
}


@pytest.mark.parametrize("name", CALLS)
def test_a_keyword_with_a_lone_surrogate_is_refused(name):
    script = f"import echopath as ep\nword = {{'a\\ud800': 1}}\n{CALLS[name]}"
    done = subprocess.run([sys.executable, "-c", script.encode("ascii", "backslashreplace").decode()], capture_output=True,
                          text=True, timeout=60)
    assert done.returncode == 1 and done.stderr.splitlines()[-1].startswith("TypeError: ") and "\\ud800" in done.stderr
