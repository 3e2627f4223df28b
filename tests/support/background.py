"""Processes that a test starts and stops."""
import signal


def heed_ctrl_c() -> None:
    """To be run in a new process: one that is started in the background, as tests often are, inherits that Ctrl-C is ignored."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


def heed_signals() -> None:
    """Likewise, and to be ended by a terminal that closes, which a process below `nohup` is not."""
    heed_ctrl_c()
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
