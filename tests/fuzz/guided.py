"""`python -m fuzz.guided TARGET [OPTIONS OF LIBFUZZER]` in tests/: files that reach new lines of readers are kept and mutated.

Needs `pip install atheris` (Google's coverage-guided fuzzer for Python), and runs by hand alone. The corpus begins with the seeds
of the target and stays in the folder build/guided/TARGET; `-max_total_time=300` and the like go to libFuzzer. A finding ends the
run, with its traceback, and is kept as a file beside the corpus, which the same command takes as an argument to run it again.
"""
from __future__ import annotations

import hashlib
import sys
import warnings
from pathlib import Path

import atheris

with atheris.instrument_imports(include=["echopath.readers"]):
    import echopath.readers.bvh
    import echopath.readers.frames
    import echopath.readers.gltf
    import echopath.readers.mitsuba
    import echopath.readers.obj
    import echopath.readers.usd

import echopath as ep
from fuzz.targets import TARGETS

CORPORA = Path(__file__).resolve().parents[2] / "build" / "guided"


def main() -> None:
    """Runs until libFuzzer is told to end, or a file breaks the promise of its target."""
    name = sys.argv[1] if len(sys.argv) > 1 else ""
    case = TARGETS[name]() if name in TARGETS else None
    if not hasattr(case, "read"):
        raise SystemExit(f"TARGET must be one that reads one file, got '{name}'")
    ep.set_num_threads(1)
    warnings.simplefilter("ignore")
    corpus = CORPORA / name
    corpus.mkdir(parents=True, exist_ok=True)
    for seed in case.seeds:
        (corpus / hashlib.sha1(seed, usedforsecurity=False).hexdigest()).write_bytes(seed)

    def feed(content: bytes) -> None:
        case.file.write_bytes(content)
        case.read()

    atheris.Setup([sys.argv[0], f"-artifact_prefix={corpus.parent / name}-", "-timeout=20", "-rss_limit_mb=6000", str(corpus),
                   *sys.argv[2:]], feed)
    atheris.Fuzz()


if __name__ == "__main__":
    main()
