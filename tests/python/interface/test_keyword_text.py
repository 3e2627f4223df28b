"""Keywords that are no Unicode text are refused; wording another error about them once ended the process."""
import subprocess
import sys

CALLS = {
    "constructor": "ep.Mesh([[0, 0, 0]], [[0, 0, 0]], **word)",
    "constructor without others": "ep.Selection('T . R', **word)",
    "method": "ep.Isotropic(1.0).gain(1.0, **word)",
    "static method": "ep.Paths.from_arrays(**word)",
    "function": "ep.synthesize(None, **word)",
}


SCRIPT = """
import echopath as ep
word = {'a\\ud800': 1}
for call in %r:
    try:
        eval(call)
    except TypeError as error:
        print(ascii(error))
"""


def test_a_keyword_with_a_lone_surrogate_is_refused():
    done = subprocess.run([sys.executable, "-c", SCRIPT % list(CALLS.values())], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stderr) == (0, "")
    told = dict(zip(CALLS, done.stdout.splitlines(), strict=True))
    assert all(line.startswith("TypeError(") and "\\ud800" in line for line in told.values()), told
