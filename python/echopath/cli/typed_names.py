"""Errors name what was typed on the command line: "--rays", where the functions behind it call it num_rays."""
from __future__ import annotations

from argparse import Namespace

from ..arguments.shown import shown

# Arguments of functions that have another name on the command line. Others are called alike: seed is --seed.
_TYPED_AS = {"num_rays": "rays", "path": "out", "dynamic_range_db": "dynamic_range", "noise_margin_db": "noise_margin",
             "objects": "object"}
# What a command is given without a name, as its usage calls it.
_UNNAMED = {"file": "FILE", "scene": "SCENE.toml", "frame": "FRAME.h5", "template": "DATASET.toml"}


def with_typed_name(message: str, options: Namespace) -> str:
    """A message "argument: rule, got value" with what the argument was typed as; others, as those of scene files, as they are.

    options: of the command
    """
    argument, colon, rest = message.partition(": ")
    unnamed = next((name for name in _UNNAMED if hasattr(options, name)), "")
    out = str(getattr(options, "out", None))
    is_of_out = f"'{out}'" in rest or shown(out) in rest  # messages of files repeat names whole, others may cut them
    if unnamed and argument in ("path", unnamed) and not is_of_out:
        return f"{_UNNAMED[unnamed]}{colon}{rest}"
    typed = _TYPED_AS.get(argument, argument)
    return f"--{typed.replace('_', '-')}{colon}{rest}" if colon and typed in _typed(options) else message


def typed_arguments(options: Namespace) -> set[str]:
    """The arguments of functions that were typed, in the words of the functions."""
    typed = _typed(options)
    return typed | {argument for argument, option in _TYPED_AS.items() if option in typed}


def _typed(options: Namespace) -> set[str]:
    return {name for name, value in vars(options).items() if value is not None and value != []}
