"""Which frame of a time line is shown: reads frames in a thread, plays them, and finds those that are written."""
from __future__ import annotations

import echopath as ep
from echopath.base.storage.files import file_state

from ...model.frames.carried import make_ready, session_like
from ...model.frames.overview import glance_at, no_glance
from ..background_work import BackgroundWork
from ..qt import QtCore, Signal

POLL_MS = 1000      # between looks for new frames
FILM_MS = 100       # from frame to frame at least
REST_MS = 500       # without a next frame of a film, after which the one on display is shown whole
MOST_GLANCES = 4    # that are read in one piece of work
GONE = "{}: its files are gone; what is shown is the last frame that was read"


class TimeControl(QtCore.QObject):
    """Goes through a TimeLine; at most two frames are held: that on display and the one that is read."""

    # read: Session; mended: what `failed` has told and no longer is; stopped: the film, or its next frame is long in coming.
    read, failed, mended, glanced, stopped = Signal(object), Signal(str), Signal(str), Signal(), Signal()

    def __init__(self, bar, state_now, is_behind):
        """bar: FrameBar; state_now: callable () -> state of the view to be taken over; is_behind: callable () -> whether the
        frame before is still to be drawn"""
        super().__init__(bar)
        self.bar, self._state_now, self._is_behind = bar, state_now, is_behind
        self.line, self.place, self._wanted, self._glances = None, 0, None, {}
        self._gaps = {}  # {Moment: (state of its file, what was wrong with it)} of frames that the strip has a gap for
        self._way, self._num_failed = 0, 0  # 1 or -1: from frame to frame, 0: to a place; frames in a row that could not be read
        self._shown, self._trouble = None, ""  # Moment on display; what the last look has found wrong
        self._reading, self._unread = None, None  # (Moment, state of its file) that is read; that and what was wrong with it
        self.work, self._glancing = BackgroundWork(self), BackgroundWork(self)
        self._poll, self._film = QtCore.QTimer(self, interval=POLL_MS), QtCore.QTimer(self, interval=FILM_MS)
        self._poll.timeout.connect(self.look)
        self._film.timeout.connect(self._play_on)
        self._rest = QtCore.QTimer(self, singleShot=True, interval=REST_MS)
        self._rest.timeout.connect(self._rest_there)
        self.work.done.connect(self._take)
        self.work.failed.connect(self._pass_over)
        self._glancing.done.connect(self._take_glances)
        self._glancing.failed.connect(self.failed)
        bar.wanted.connect(self.go)
        bar.stepped.connect(self.step)
        bar.play_toggled.connect(self._play)

    @property
    def is_playing(self) -> bool:
        """Whether the frames are played."""
        return self._film.isActive()

    @property
    def is_busy(self) -> bool:
        """Whether a frame is read that was asked for."""
        return self.work.is_running

    @property
    def is_glancing(self) -> bool:
        """Whether frames are read of which the strip shows nothing yet."""
        return self._glancing.is_running

    def show(self, line) -> None:
        """Takes over a time line whose first frame is on display already; None: there is none."""
        self.stop()
        self.line, self.place, self._glances = line, 0 if line is None else line.first, {}
        self._gaps = {}
        self.bar.setVisible(line is not None)
        self.bar.strip.show_glances([])
        if line is not None:
            self._shown, self._trouble, self._num_failed, self._unread = line.moments[self.place], "", 0, None
            self._show_place()
            self._poll.start()
            self._read_glances()

    def stop(self) -> None:
        """Ends the film, the reading and what makes frames."""
        self.pause()
        for timer in (self._poll, self._film, self._rest):
            timer.stop()
        for work in (self.work, self._glancing):
            work.stop()
        self._wanted = None
        if self.line is not None:
            self.line.close()
        self.line = None

    def pause(self) -> None:
        """Ends the film at the frame on display."""
        self.bar.play_button.setChecked(False)

    def hold(self) -> None:
        """Ends the film and lets go of the frame that is being read: the one on display stays."""
        self.work.stop()
        self._wanted = None
        self.pause()

    def step(self, by: int) -> None:
        """To a frame before or after; over those that cannot be read."""
        if self.line is not None:
            self._num_failed = 0
            self.go(self.place + by if self._wanted is None else self._wanted + by, 1 if by > 0 else -1)

    def go(self, place: int, way: int = 0) -> None:
        """Shows the frame at a place, kept within those that are there, as soon as it is read.

        way: 1 or -1 to the next or last one where it cannot be read, 0: to no other
        """
        if self.line is None:
            return
        if not len(self.line):
            self._fail(GONE.format(self.line.title))
            return
        place = min(max(place, 0), len(self.line) - 1)
        if place == self.place and self._wanted is None:
            return
        self._wanted, self._way = place, way
        if not self.work.is_running:
            self._start(place)

    def reload(self) -> None:
        """Finds frames that were written since, and reads that on display anew."""
        if self.line is None:
            return
        self.look()
        if len(self.line) and not self.work.is_running:
            self._wanted, self._way = self.place, 0
            self._start(self.place)

    def look(self) -> None:
        """Finds frames that were written since."""
        if self.line.failure:
            self.failed.emit(self.line.failure)
            self.line.failure = ""
        is_other = self._has_found_others()
        self._try_gaps_again()
        if not is_other:
            self._try_newest_again()
            return
        if not len(self.line):
            self._fail(GONE.format(self.line.title))
            return
        self.place = self._place_of(self._shown)
        self._show_place()
        self._read_glances()
        if self.bar.follow_check.isChecked():
            self.go(len(self.line) - 1)

    def _has_found_others(self) -> bool:
        """Whether there are other frames now; what keeps them from being found is told once."""
        try:
            is_other, trouble = self.line.refresh(), ""
        except (ep.FileError, OSError) as error:
            is_other, trouble = False, str(error)
        if trouble not in ("", self._trouble):
            self.failed.emit(trouble)
        self._trouble = trouble
        return is_other

    def _try_newest_again(self) -> None:
        """Where it could not be read, as while it is copied here, and its file is another one now."""
        if self._unread is not None and len(self.line) and self.bar.follow_check.isChecked() and not self.is_busy:
            newest = self.line.moments[-1]
            if newest == self._unread[0] and file_state(newest.path) != self._unread[1]:
                self.go(len(self.line) - 1)

    def _place_of(self, moment) -> int:
        """Where it is now, or was before it was gone."""
        moments = self.line.moments
        return moments.index(moment) if moment in moments else max(min(self.place, len(moments) - 1), 0)

    # --- reading ---

    def _start(self, place: int) -> None:
        moment, state, is_passing = self.line.moments[place], self._state_now(), self.is_playing
        meshes, self._reading = self.line.meshes, (moment, file_state(moment.path))
        self.work.start(lambda progress: make_ready(session_like(state, moment.read(meshes)), is_passing))

    def _take(self, session) -> None:
        self._shown, wanted, self._wanted, self._num_failed = self._reading[0], self._wanted, None, 0
        unread, self._unread = self._unread, None
        if unread is not None and unread[0] == self._shown:
            self.mended.emit(unread[2])
        self.place = self._place_of(self._shown)
        self.read.emit(session)
        if self.is_playing:
            self._rest.start()
        self._show_place()
        if wanted is not None:
            self.go(wanted, self._way)

    def _pass_over(self, text: str) -> None:
        """Tells of a frame that cannot be read; whoever goes from frame to frame comes to the one behind it."""
        place, wanted, self._num_failed = self._place_of(self._reading[0]), self._wanted, self._num_failed + 1
        self._unread = *self._reading, text
        if wanted == place:
            wanted = place + self._way
        if self.is_playing and wanted == len(self.line):
            wanted = 0
        if wanted != place and 0 <= wanted < len(self.line) and self._num_failed < len(self.line):
            self._wanted = None
            self.failed.emit(text)
            self.go(wanted, self._way)
        else:
            self._fail(text)

    def _fail(self, text: str) -> None:
        self._wanted = None
        self.pause()
        self._show_place()
        self.failed.emit(text)

    def _show_place(self) -> None:
        if len(self.line):
            self.bar.show_place(self.place, self.line.moments, self.line.expected)

    def _play(self, is_on: bool) -> None:
        if is_on and self.line is not None:
            self._num_failed = 0
            self._film.start()
        elif self._film.isActive():
            self._film.stop()
            self._rest.stop()
            self.stopped.emit()

    def _play_on(self) -> None:
        if self._is_behind() or self.is_busy:
            return
        is_last = self.place == len(self.line) - 1
        if is_last and self.line.expected not in (None, len(self.line)):
            return  # further ones are being written
        if self._rest.isActive():
            self._rest.start()  # a frame may take long to be drawn: what counts is how long the next one is read
        self.go(0 if is_last else self.place + 1, 1)

    def _rest_there(self) -> None:
        """The film waits for its next frame."""
        if self._is_behind():
            self._rest.start()
        else:
            self.stopped.emit()

    # --- all at a glance ---

    def _try_gaps_again(self) -> None:
        """Frames that could not be read, whose files are others now."""
        mended = [moment for moment, (state, _) in self._gaps.items() if file_state(moment.path) != state]
        for moment in mended:
            self._glances.pop(moment, None)
        if mended:
            self._read_glances()

    def _read_glances(self) -> None:
        missing = [moment for moment in self.line.moments if moment not in self._glances][:MOST_GLANCES]
        if missing and not self.is_glancing:
            self._glancing.start(lambda progress: _glances_at(missing))

    def _take_glances(self, taken: tuple) -> None:
        found, trouble = taken
        self._glances |= found
        for moment in found:
            _, told = self._gaps.pop(moment, (None, ""))
            if moment not in trouble:
                self.mended.emit(told)
        self._gaps |= trouble
        if trouble:
            self.failed.emit(next(iter(trouble.values()))[1])
        there = []
        for moment in self.line.moments:
            if moment not in self._glances:
                break
            there.append(self._glances[moment])
        self.bar.strip.show_glances(there)
        self.glanced.emit()
        self._read_glances()


def _glances_at(moments) -> tuple:
    """({Moment: Glance}, {Moment: (state of its file, what was wrong with it)} of those that could not be read)."""
    found, trouble = {}, {}
    for moment in moments:
        state = file_state(moment.path)
        try:
            found[moment] = glance_at(moment)
        except (ep.FileError, OSError) as error:
            found[moment], trouble[moment] = no_glance(moment), (state, str(error))
    return found, trouble
