"""The command line: echopath demo | run | view | info | scene | labels | dataset | dataset-report | bench."""
from __future__ import annotations

import os
import sys
from contextlib import ExitStack, contextmanager, redirect_stderr, redirect_stdout, suppress

from .. import DeviceError
from .._startup import EXIT_INTERRUPTED, STOPPED, loading_is_over
from ..base.process.interrupts import ends_as_by_ctrl_c, interrupts_are_kept
from .parser import command_parser
from .resumable import Unread
from .typed_names import with_typed_name
from .warned import warnings_in_lines

EXIT_BAD_INPUT = 2
EXIT_UNREAD = 141  # what a shell reports of other programs that write to a closed pipe
EXIT_BY_SIGNAL = 128  # and the number of the signal is what a shell reports of other programs that a signal ends


def main(arguments=None) -> int:
    """Runs one command and returns its exit code: 0, 2 for bad input, 130 after Ctrl-C, 143 after SIGTERM, 129 after SIGHUP, 141
    where nobody reads its output before its work is done."""
    with _outputs_that_are_there(), ends_as_by_ctrl_c() as ended_by:
        code = _run(arguments)
    return EXIT_BY_SIGNAL + ended_by[0] if ended_by and code == EXIT_INTERRUPTED else code


def _run(arguments) -> int:
    _print_what_the_output_lacks()
    try:
        options = command_parser().parse_args(arguments)
        loading_is_over()
        with interrupts_are_kept(), warnings_in_lines():
            options.command(options)
        sys.stdout.flush()
    except KeyboardInterrupt:
        exec("")  # after a Ctrl-C within the text of an `exec`, Python ends by the signal, until another text has run
        print(f"\n{STOPPED}", file=sys.stderr)
        return EXIT_INTERRUPTED
    except BrokenPipeError as error:
        if isinstance(error, Unread):
            with suppress(BrokenPipeError):  # nobody may read this, either
                print(f"echopath: {error}", file=sys.stderr)
            return EXIT_UNREAD
    except (ValueError, OSError, ModuleNotFoundError, DeviceError) as error:
        print(f"echopath: {with_typed_name(_text_of(error), options)}", file=sys.stderr)
        return EXIT_BAD_INPUT
    except MemoryError:
        print("echopath: not enough memory; fewer rays (--rays), samples and chirps need less", file=sys.stderr)
        return EXIT_BAD_INPUT
    finally:
        _let_go_of_unread_outputs()
    return 0


def _text_of(error: Exception) -> str:
    """Errors of the system begin with the name of the file, as others do."""
    told = [str(part) for part in (getattr(error, "filename", None), getattr(error, "strerror", None)) if part]
    return ": ".join(told) or str(error)


@contextmanager
def _outputs_that_are_there():
    """What is printed within the block goes nowhere where the program was started without outputs (`>&-`)."""
    with ExitStack() as stack:
        if sys.stdout is None:
            stack.enter_context(redirect_stdout(stack.enter_context(open(os.devnull, "w"))))
        if sys.stderr is None:
            stack.enter_context(redirect_stderr(stack.enter_context(open(os.devnull, "w"))))
        yield


def _print_what_the_output_lacks() -> None:
    """Letters of names and titles that the encoding of the output does not have are printed by number, as on standard error: they
    are no reason to end a long run."""
    if getattr(sys.stdout, "errors", None) in ("strict", "surrogateescape") and hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="backslashreplace")


def _let_go_of_unread_outputs() -> None:
    """What is left in the buffers of outputs that nobody reads goes nowhere: Python would end with 120 because of it."""
    for output in (sys.stdout, sys.stderr):
        try:
            output.flush()
        except BrokenPipeError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), output.fileno())
