"""A view that goes on from one frame to the next."""
from __future__ import annotations

from ..session import Session
from ..view_state import apply_state
from .inputs import from_file


def make_ready(session: Session, is_passing: bool = False) -> Session:
    """The session, once it has made what its picture and its lists need: for a thread. is_passing: its picture alone."""
    if not is_passing:
        session.node_counts()
    session.segments(session.shown_rays())
    return session


def session_like(state: dict | None, view_input) -> Session:
    """A session of a frame that shows what another one did, as far as it fits: colours, filters, layers, cells, not the ray.

    state: of `state_of`, None: there was none; view_input: model.ViewInput
    """
    session = Session(view_input)
    if state is not None:
        apply_state(session, state | {"ray": None, "frame": session.title})
    return session


def read_session(path, state: dict | None, progress) -> Session:
    """A session of a frame file, ready to be drawn, which shows what `state` says, or everything. Raises ep.FileError.

    progress: callable (stage, fraction)
    """
    progress("file", 0.05)
    view_input = from_file(path)
    progress("paths", 0.5)
    session = session_like(state, view_input)
    progress("rays", 0.85)
    return make_ready(session)
