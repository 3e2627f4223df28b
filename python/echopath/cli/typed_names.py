"""Errors name what was typed on the command line: "--rays", where the functions behind it call it num_rays."""
from __future__ import annotations

from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager

# Arguments of functions that have another name on the command line. Others are called alike: seed is --seed.
_TYPED_AS = {"num_rays": "rays", "path": "out", "dynamic_range_db": "dynamic_range", "noise_margin_db": "noise_margin",
             "objects": "object"}


@contextmanager
def told_as(**names: str) -> Iterator[None]:
    """Errors "argument: rule, got value" within the block name an argument as the usage of the command does.

    names: by argument, as path="SCENE.toml" where a file is read: elsewhere a `path` is that of --out
    """
    try:
        yield
    except (ValueError, OSError) as error:
        argument, _, rest = str(error).partition(": ")
        if argument not in names:
            raise
        raise type(error)(f"{names[argument]}: {rest}") from None


def with_typed_name(message: str, options: Namespace) -> str:
    """A message "argument: rule, got value" with what the argument was typed as; others, as those of scene files, as they are.

    options: of the command
    """
    argument, colon, rest = message.partition(": ")
    typed = _TYPED_AS.get(argument, argument)
    return f"--{typed.replace('_', '-')}{colon}{rest}" if colon and typed in _typed(options) else message


def typed_arguments(options: Namespace) -> set[str]:
    """The arguments of functions that were typed, in the words of the functions."""
    typed = _typed(options)
    return typed | {argument for argument, option in _TYPED_AS.items() if option in typed}


def _typed(options: Namespace) -> set[str]:
    return {name for name, value in vars(options).items() if value is not None and value != []}
