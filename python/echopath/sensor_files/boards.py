"""Antennas of known boards, from data/radars/*.toml."""
from __future__ import annotations

import tomllib
from typing import NamedTuple

from .. import _core
from ..arguments.checks import refused
from ..base.storage.data_folder import data_folder


class Board(NamedTuple):
    """A board.

    name: of its file; transmitters, receivers: Antenna, in the order of its channels; transmit_power: W; noise_figure_db: dB
    band: Hz, first and last that it sends; platforms: what configurations call it; lanes: of its serial port
    """

    name: str
    transmitters: tuple
    receivers: tuple
    transmit_power: float
    noise_figure_db: float
    band: tuple[float, float]
    platforms: tuple
    lanes: int


def board_names() -> list[str]:
    """Names of the boards that come with echopath."""
    return sorted(file.name.removesuffix(".toml") for file in data_folder("radars").iterdir() if file.name.endswith(".toml"))


def read_board(name: str) -> Board:
    """The board of a name. Raises ValueError for unknown ones."""
    if name not in board_names():
        raise refused(ValueError, "board", "one of " + ", ".join(board_names()), name)
    table = tomllib.loads((data_folder("radars") / f"{name}.toml").read_text(encoding="utf-8"))
    step = 0.5 * _core.speed_of_light / table["design_frequency"]
    return Board(name, *(_antennas(table[side], step) for side in ("transmitters", "receivers")),
                 table["transmit_power"], table["noise_figure_db"], tuple(table["band"]), tuple(table["platforms"]),
                 table["lanes"])


def board_of_platform(platform: str) -> Board | None:
    """The board that configurations call so, None: unknown."""
    return next((board for board in map(read_board, board_names()) if platform in board.platforms), None)


def _antennas(places, step: float) -> tuple:
    """Patches that look ahead, with a beam of some 100 degrees each way."""
    pattern = _core.CosinePower(1.0)
    return tuple(_core.Antenna((0.0, left * step, up * step), pattern=pattern) for left, up in places)
