"""`python -m fuzz [SECONDS] [--first N] [TARGET ...]` in tests/: runs the fuzzers in Python for so long each."""
from __future__ import annotations

import argparse
import sys

from fuzz.targets import TARGETS
from fuzz.worker import run


def main() -> int:
    """Prints the runs of each target and its findings; returns 1 where there are any."""
    parser = argparse.ArgumentParser(prog="fuzz", description=__doc__)
    parser.add_argument("seconds", type=float, nargs="?", default=60.0, help="for each target")
    parser.add_argument("--first", type=int, default=0, help="number of the first case")
    parser.add_argument("targets", nargs="*", help=f"of {', '.join(TARGETS)}; none: all")
    options = parser.parse_intermixed_args()
    failed = False
    for target in options.targets or TARGETS:
        count, findings = run(target, range(options.first, sys.maxsize), options.seconds)
        print(f"{target}: {count} runs, {len(findings)} findings; --first {options.first + count} goes on", flush=True)
        for finding in findings:
            print(f"  case {finding.number}: {finding.what}")
        failed = failed or bool(findings)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
