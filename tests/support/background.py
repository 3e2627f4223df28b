"""Processes that a test starts and stops."""
import signal


def heed_ctrl_c() -> None:
    """To be run in a new process: one that is started in the background, as tests often are, inherits that Ctrl-C is ignored."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
