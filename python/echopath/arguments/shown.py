"""Values as error messages repeat them."""
from __future__ import annotations

import reprlib


class _Short(reprlib.Repr):
    def __init__(self):
        super().__init__()
        self.maxstring = self.maxother = self.maxlong = 60

    def repr1(self, value, level):
        """Scalars of NumPy as the numbers that they are, -30.0, not np.float64(-30.0)."""
        is_scalar = type(value).__module__ == "numpy" and getattr(value, "shape", None) == ()
        plain = value.item() if is_scalar else value
        return super().repr1(plain if isinstance(plain, (bool, int, float, complex, str)) else value, level)

    def repr_ndarray(self, value, level):
        return f"an array {list(value.shape)} of {value.dtype}" if value.ndim else repr(value[()])


_short = _Short()


def shown(value) -> str:
    """A value as a message repeats it: short, on one line, and text that every terminal can print."""
    try:
        text = _short.repr(value)
    except Exception:  # whatever a foreign __repr__ raises
        text = f"a {type(value).__name__}"
    return " ".join(writable(text).split())


def writable(text: str) -> str:
    """Text with its lone surrogates written out."""
    return text.encode("utf-8", "backslashreplace").decode("utf-8")


def refused(kind: type[Exception], argument: str, rule: str, value) -> Exception:
    """The error to raise: "argument: must be rule, got value"."""
    return kind(f"{argument}: must be {rule}, got {shown(value)}")
