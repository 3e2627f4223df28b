"""Selections written as text: path expressions joined by & | ~ and parentheses, as `Selection.text` writes them."""
from __future__ import annotations

import echopath as ep


def parse_selection(text: str):
    """The selection that a text describes.

    text: a path expression, T .* 'wall' .* R, or several joined by ~ (not, binds tightest), & (and) and | (or), with
        parentheses where wanted: T 'walker' R | ~(T . R) & (T .* 'wall' .* R)
    Returns a Selection. Raises ValueError with a caret under the fault.
    """
    parser = _Parser(text)
    selection = parser.alternatives()
    if parser.next_symbol():
        parser.fail("&, | or the end")
    return selection


class _Parser:
    """Recursive descent; `at` is the index of the next character."""

    def __init__(self, text: str):
        self.text = text
        self.at = 0

    def alternatives(self):
        selection = self._conjunction()
        while self._take("|"):
            selection = selection | self._conjunction()
        return selection

    def _conjunction(self):
        selection = self._operand()
        while self._take("&"):
            selection = selection & self._operand()
        return selection

    def _operand(self):
        if self._take("~"):
            return ~self._operand()
        if self._take("("):
            selection = self.alternatives()
            if not self._take(")"):
                self.fail("&, | or ) after it")
            return selection
        if self.next_symbol() != "T":
            self.fail("a path expression T ... R, ~ or (")
        return self._path_expression()

    def _path_expression(self):
        """From T to the first R outside of quotes, or to the end for the message of what is missing."""
        begin, quoted = self.at, False
        while self.at < len(self.text):
            letter = self.text[self.at]
            self.at += 1
            quoted ^= letter == "'"
            if letter == "R" and not quoted:
                break
        return self._selection(begin, self.text[begin:self.at])

    def _selection(self, begin: int, expression: str):
        try:
            return ep.Selection(expression)
        except ValueError as error:
            what = str(error).splitlines()[0].removeprefix("path expression: ")
            caret = str(error).splitlines()[-1].find("^") - 2  # below an indent of two
            raise _fault(self.text, begin + max(caret, 0), what) from None

    def next_symbol(self) -> str:
        while self.at < len(self.text) and self.text[self.at].isspace():
            self.at += 1
        return self.text[self.at:self.at + 1]

    def _take(self, symbol: str) -> bool:
        found = self.next_symbol() == symbol
        self.at += found
        return found

    def fail(self, expected: str) -> None:
        raise _fault(self.text, self.at, f"expected {expected}, got {self.next_symbol() or 'the end'}")


def _fault(text: str, position: int, what: str) -> ValueError:
    """On one line with its caret, whatever white space the text has."""
    line = "".join(" " if letter.isspace() else letter for letter in text)
    return ValueError(f"path expression: {what}\n  {line}\n  {' ' * position}^")
