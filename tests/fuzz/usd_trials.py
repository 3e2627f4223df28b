"""Trials of USD stages by forks of one process that has USD's library ready: a new process for each takes ten times as long.

A fork runs the text that a new process would run, under the same limits, so that what ends the one ends the other. USD has one
thread there, as threads do not survive a fork.
"""
from __future__ import annotations

import importlib
import json
import os
import select
import signal
import subprocess
import sys
from pathlib import Path

_server: subprocess.Popen | None = None


def fork_trials() -> None:
    """From now on USD stages are tried by forks in this process."""
    from echopath.readers.usd import trial  # not in the server, whose forks would have to copy what it brings

    trial._opened_apart = opened_by_fork


def opened_by_fork(path: Path, seconds: float, memory: int) -> subprocess.CompletedProcess:
    """As `trial._opened_apart`: how the process ended that opened a stage, and what it printed. Raises TimeoutExpired."""
    from echopath.readers.usd.trial import _OPEN

    global _server
    if _server is None or _server.poll() is not None:
        environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path)), "PXR_WORK_THREAD_LIMIT": "1"}
        _server = subprocess.Popen([sys.executable, "-m", "fuzz.usd_trials"], env=environment, stdin=subprocess.PIPE,
                                   stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    _server.stdin.write(json.dumps([_OPEN, str(path), str(memory), seconds]) + "\n")
    _server.stdin.flush()
    code, told = json.loads(_server.stdout.readline())
    if code is None:
        raise subprocess.TimeoutExpired(str(path), seconds)
    return subprocess.CompletedProcess(str(path), code, told)


def _serve() -> None:
    """Tries each stage that a line of the input names, and prints a line with its end."""
    from pxr import Plug, Sdf

    for module in ("pxr.Tf", "pxr.Usd"):  # what each fork would have to load and to find by itself
        importlib.import_module(module)
    Plug.Registry().GetAllPlugins()
    Sdf.FileFormat.FindByExtension("usdc")
    for line in sys.stdin:
        print(json.dumps(_tried(*json.loads(line))), flush=True)


def _tried(text: str, path: str, memory: str, seconds: float) -> tuple[int | None, str]:
    reading, writing = os.pipe()
    pid = os.fork()
    if pid == 0:
        _run(text, path, memory, writing)
    os.close(writing)
    told = b""
    while select.select([reading], [], [], seconds)[0]:
        more = os.read(reading, 65536)
        if not more:
            break
        told += more
    else:
        os.kill(pid, signal.SIGKILL)
    os.close(reading)
    code = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
    return (None if code == -signal.SIGKILL else code), told.decode(errors="replace")


def _run(text: str, path: str, memory: str, output: int) -> None:
    """Runs a text as a program of its own would, and ends this process as that would end."""
    code = 1
    try:
        os.dup2(output, 1)
        sys.argv = ["-c", path, memory]
        exec(text, {"__name__": "__main__"})
        code = 0
    except SystemExit as end:
        code = end.code
    finally:
        sys.stdout.flush()
        os._exit(code)


if __name__ == "__main__":
    _serve()
