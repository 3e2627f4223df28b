"""Makes a dataset, on the command line."""
from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from ..base.text.counts import counted
from ..dataset import Forecast, MadeScene, make
from ..dataset.folder import MANIFEST
from ..dataset.unresolved import UnresolvedEchoes, summary
from .numbers import duration_words


def lines_of(options) -> Iterator[str]:
    """Makes what the options ask for; yields a line for each scene that is made, and what came of all."""
    counts: Counter[str] = Counter()
    unresolved: dict[int, UnresolvedEchoes] = {}
    for told in make(options.template, options.out, workers=options.workers, shard=options.shard, frames=options.frames,
                     only_failed=options.only_failed, scheduler=options.scheduler):
        if isinstance(told, Forecast):
            yield _forecast_line(told)
            continue
        counts["there" if told.was_there and told.record.state == "done" else told.record.state] += 1
        if told.unresolved is not None:
            unresolved[told.scene] = told.unresolved
        if not told.was_there:
            yield _line(told)
    told_counts = [f"{counted(count, 'scene')} {state}" for state, count in sorted(counts.items())]
    yield ", ".join(told_counts) or "no scene was to be made"
    yield from summary(one for _, one in sorted(unresolved.items()))  # scenes are told as workers end them
    if counts["failed"]:
        yield f"{options.out}/{MANIFEST} says why; --only-failed tries again"


def _forecast_line(forecast: Forecast) -> str:
    if forecast.frames == 0:
        return "all frames are there"
    time = "a time that depends on the workers" if forecast.seconds is None else f"about {duration_words(forecast.seconds)}"
    return (f"{counted(forecast.frames, 'frame')} to be made, in {time}, {max(1, forecast.bytes >> 20)} MiB, "
            "if all are like the first one")


def _line(made: MadeScene) -> str:
    text = f"{made.done} of {made.total}: scene {made.scene} ({made.split}) {made.record.state}"
    if made.record.reason:
        text += f": {made.record.reason}"
    return text if not made.seconds_left else f"{text}, {duration_words(made.seconds_left)} left"
