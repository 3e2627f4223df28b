"""A thread that shows the changes of a live scene, the latest first."""
from __future__ import annotations

import math
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING

from ..arguments.checks import anything, checked, optional, positive
from ..base.classes.made_by import made_by
from ..base.process.callers import at_line_of_user
from .changes import Changes
from .view import LiveView

if TYPE_CHECKING:
    from .live import Live

FIRST_PREVIEW_RAYS, FEWEST_PREVIEW_RAYS = 4096, 512
QUIET = 0.1         # s without a change after a preview, before the full view begins: what is dragged would end it at once
LONGEST_WAIT = 0.1  # s, until a thread that waits for changes looks whether it is to end
_QUICK_SHARE = 0.4  # of the budget; a preview of all rays that takes less gets twice as many, which then take less than all of it
_AIM = 0.8          # of the budget, that previews aim at whose rays go by the time of another view


class _Superseded(Exception):
    """Another change came while a view was made."""


@made_by("Live.watch")
class Watch:
    """Shows the views of a Live from a thread of its own: `with live.watch(show) as watch: live.change(...); watch.wait()`.

    After a change comes a preview with as many rays as the budget allows, where the last full view took longer than that or
    another change ended it, and then, once nothing has changed for 0.1 s, the full view; where it took no longer, the full view
    at once. A change that comes meanwhile ends a full view, so that the latest change is shown first; changes in between may
    not be shown at all.
    Warnings of its views name the line that called `Live.watch`.
    What a view or `show` raises ends the watch, is told to `failed` and raised by `wait` and `stop`. Made by `Live.watch`.
    """

    def __init__(self, live: Live, changes: Changes, show: Callable[[LiveView], object], budget: float,
                 failed: Callable[[Exception], object] | None = None):
        self._live, self._changes, self._show, self._budget, self._failed = live, changes, show, budget, failed
        self._preview_rays, self._full_seconds = self._as_previews_have(FIRST_PREVIEW_RAYS), 0.0
        self._has_shown_preview = False
        self._shown, self._error = -1, None  # number of the change whose full view was shown
        self._stopping, self._shown_one = False, threading.Condition()
        self._thread = threading.Thread(target=at_line_of_user(self._run), name="echopath.Watch", daemon=True)
        self._thread.start()

    def __enter__(self) -> Watch:
        return self

    def __exit__(self, kind, error, trace) -> None:
        self.stop()

    def __repr__(self) -> str:
        ended = f"ended by {self._error!r}" if self._error is not None else "stopped" if self._stopping else "running"
        return f"Watch({ended}, {f'change {self._shown}' if self._shown >= 0 else 'nothing'} shown in full)"

    @checked(self=anything, timeout=optional(positive("s")))
    def wait(self, timeout: float | None = None) -> bool:
        """Waits until the full view of the latest change was shown. timeout: s, None: for ever. Returns whether it was.

        Raises what ended the watch, and RuntimeError in `show`, which it would wait for, unless the watch was stopped.
        """
        if threading.current_thread() is self._thread and self._error is None and not self._stopping:
            raise RuntimeError("wait: must not be called by what shows the views of this watch")
        with self._shown_one:
            done = self._shown_one.wait_for(
                lambda: self._error is not None or self._stopping or self._shown == self._changes.number, timeout)
        if self._error is not None:
            raise self._error
        return done and self._shown == self._changes.number

    def stop(self) -> None:
        """Ends the thread, and the view that it makes. Raises what had ended the watch before."""
        self._stopping = True
        with self._shown_one:
            self._shown_one.notify_all()
        if threading.current_thread() is not self._thread:
            self._thread.join()
        if self._error is not None:
            raise self._error

    def _run(self) -> None:
        try:
            while not self._stopping:
                self._try_to_show_change()
                while not self._stopping and not self._changes.wait_for_other(self._shown, LONGEST_WAIT):
                    pass
        except BaseException as error:  # sys.exit() in `show`, too
            self._error = error
        with self._shown_one:
            self._shown_one.notify_all()
        if self._error is not None and self._failed is not None:
            self._failed(self._error)

    def _try_to_show_change(self) -> None:
        try:
            self._show_change()
        except _Superseded:
            pass

    def _show_change(self) -> None:
        if self._full_seconds > self._budget and self._changes.wait_for_other(self._show_preview(), QUIET):
            return
        number = self._changes.number
        try:
            view = self._live.update(progress=lambda stage, fraction: self._go_on(number))
        except _Superseded:
            self._full_seconds = math.inf  # changes come quicker: the next one has a preview, or none would ever be shown
            raise
        self._full_seconds = view.seconds
        if not self._has_shown_preview and view.num_rays_shot == view.num_rays:
            self._preview_rays = min(self._preview_rays, self._rays_within_budget(view))
        self._show(view)
        with self._shown_one:
            self._shown = view.number
            self._shown_one.notify_all()

    def _show_preview(self) -> int:
        """Returns the number of the change that it shows."""
        view = self._live.preview(num_rays=self._preview_rays, progress=lambda stage, fraction: self._go_on(None))
        self._has_shown_preview = True
        self._show(view)
        if view.seconds > self._budget:
            self._preview_rays = min(self._preview_rays, self._rays_within_budget(view))
        elif view.num_rays_shot == view.num_rays and view.seconds < _QUICK_SHARE * self._budget:
            self._preview_rays = self._as_previews_have(2 * self._preview_rays)
        return view.number

    def _rays_within_budget(self, view: LiveView) -> int:
        """As many as would keep within the budget, were the time of a view in proportion to its rays."""
        return self._as_previews_have(int(view.num_rays * _AIM * self._budget / view.seconds))

    def _as_previews_have(self, num_rays: int) -> int:
        return min(max(num_rays, FEWEST_PREVIEW_RAYS), self._live.num_rays)

    def _go_on(self, number: int | None) -> None:
        if self._stopping or (number is not None and number != self._changes.number):
            raise _Superseded
