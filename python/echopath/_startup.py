"""What the command line answers while the package is still loading; in other programs nothing here does anything.

Loading takes a fifth of a second, more from a slow disk, and any entry point `echopath.cli:main` runs `echopath/__init__.py`
first. So that module asks here, before its imports: Ctrl-C ends in one line and exit code 130, not in the stack of an import;
the bare command `echopath --version` is answered and ends the process (SystemExit 0), without the extension and without NumPy.
"""
import os
import signal
import sys
import threading

EXIT_INTERRUPTED = 130
VERSION_ONLY = ["--version"]
STOPPED = "echopath: stopped; no file was left half written"


def answer_ctrl_c_while_loading() -> None:
    """Called first when the package loads; does something only where the program is echopath's own command line."""
    if (_is_command_line() and threading.current_thread() is threading.main_thread()
            and signal.getsignal(signal.SIGINT) is signal.default_int_handler):
        signal.signal(signal.SIGINT, _stop)


def answer_version_before_loading() -> None:
    """Called when the package loads: the command `echopath --version` prints what the parser would and needs nothing else."""
    if _is_command_line() and sys.orig_argv[-1:] == VERSION_ONLY and sys.orig_argv[-2].endswith("echopath"):
        from importlib.metadata import version

        print(f"echopath {version('echopath')}", flush=True)
        raise SystemExit(0)


def loading_is_over() -> None:
    """From here on Ctrl-C is a KeyboardInterrupt again."""
    if signal.getsignal(signal.SIGINT) is _stop:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def _is_command_line() -> bool:
    """The command `echopath`, or `python -m echopath`, whose package loads while argv[0] is still "-m"."""
    if sys.argv[:1] == ["-m"]:
        arguments = sys.orig_argv
        return "-m" in arguments and arguments[arguments.index("-m") + 1:][:1] == ["echopath"]
    return os.path.basename(sys.argv[0] if sys.argv else "") == "echopath"


def _stop(signal_number, frame) -> None:
    os.write(2, f"\n{STOPPED}\n".encode())
    os._exit(EXIT_INTERRUPTED)  # nothing is open yet, and an import cannot catch it
