"""Path expressions without an automaton, written from the grammar alone: by backtracking over their syntax, and for many
paths at once by the sets of places that it reaches.

    slow_matches("T S+ 'wall*' R", [("floor", "S"), ("wall_left", "D")])
    Words([[("floor", "S"), ("wall_left", "D")], ...]).taken_by("T S+ 'wall*' R")

A hit is (full mesh name, "S" or "D").
"""
import re

import numpy as np

TOKEN = re.compile(r"\s*('[^']*'|\{\s*\d+\s*(?:,\s*\d*\s*)?\}|\[\s*\^|[][TRSD.*+?|()])")


def slow_matches(text: str, hits) -> bool:
    """Whether the expression takes the path with these hits, a list of (mesh name, event)."""
    tree = parse(text)
    return any(end == len(hits) for end in ends(tree, hits, 0))


def glob_takes(glob: str, name: str) -> bool:
    """A glob takes a mesh if it takes its full name or that of an ancestor; * crosses /, ? is one character."""
    pattern = "".join({"*": ".*", "?": "."}.get(character, re.escape(character)) for character in glob)
    parts = name.split("/")
    return any(re.fullmatch(pattern, "/".join(parts[:count])) for count in range(1, len(parts) + 1))


def parse(text: str):
    """The syntax tree between T and R, as tuples ("hit", ...), ("sequence", ...), ("choice", ...), ("repeat", ...)."""
    tokens = tokenise(text)
    assert tokens[0] == "T" and tokens[-1] == "R", text
    if len(tokens) == 2:
        return ("sequence", [])
    tree, rest = parse_choice(tokens[1:-1])
    assert not rest, text
    return tree


def tokenise(text: str) -> list[str]:
    tokens, position, text = [], 0, text.strip()
    while position < len(text):
        found = TOKEN.match(text, position)
        assert found, (text, position)
        tokens.append(found[1] if found[1].startswith("'") else re.sub(r"\s", "", found[1]))
        position = found.end()
    return tokens


def parse_choice(tokens):
    branch, tokens = parse_sequence(tokens)
    branches = [branch]
    while tokens and tokens[0] == "|":
        branch, tokens = parse_sequence(tokens[1:])
        branches.append(branch)
    return ("choice", branches), tokens


def parse_sequence(tokens):
    items = []
    while tokens and tokens[0] not in ("|", ")"):
        item, tokens = parse_atom(tokens)
        if tokens and (tokens[0] in ("*", "+", "?") or tokens[0].startswith("{")):
            item, tokens = ("repeat", item, *bounds(tokens[0])), tokens[1:]
        items.append(item)
    return ("sequence", items), tokens


def bounds(operator: str):
    """Least and largest number of repeats; None: no largest."""
    if operator in ("*", "+", "?"):
        return {"*": (0, None), "+": (1, None), "?": (0, 1)}[operator]
    low, comma, high = operator[1:-1].partition(",")
    return int(low), (int(high) if high else None) if comma else int(low)


def parse_atom(tokens):
    if tokens[0] == "(":
        inner, tokens = parse_choice(tokens[1:])
        return inner, tokens[1:]
    events = "SD"
    if tokens[0] in ("S", "D"):
        events, tokens = tokens[0], tokens[1:]
        if not tokens or not (tokens[0].startswith("'") or tokens[0].startswith("[")):
            return ("hit", events, ["*"], False), tokens
    if tokens[0] == ".":
        return ("hit", events, ["*"], False), tokens[1:]
    if tokens[0].startswith("'"):
        return ("hit", events, [tokens[0][1:-1]], False), tokens[1:]
    closing = tokens.index("]")
    return ("hit", events, [glob[1:-1] for glob in tokens[1:closing]], tokens[0] == "[^"), tokens[closing + 1:]


def ends(tree, hits, start):
    """Every index that `tree` can read up to when it begins at hit `start`."""
    kind = tree[0]
    if kind == "hit":
        if start < len(hits) and hit_fits(tree, *hits[start]):
            yield start + 1
    elif kind == "choice":
        for branch in tree[1]:
            yield from ends(branch, hits, start)
    elif kind == "sequence":
        reached = {start}
        for item in tree[1]:
            reached = {end for begin in reached for end in ends(item, hits, begin)}
        yield from reached
    else:
        yield from repeat_ends(tree, hits, start)


def hit_fits(tree, name, event) -> bool:
    _, events, globs, negated = tree
    return event in events and any(glob_takes(glob, name) for glob in globs) != negated


def repeat_ends(tree, hits, start):
    _, item, low, high = tree
    reached = {start}
    for _ in range(low):
        reached = {end for begin in reached for end in ends(item, hits, begin)}
    seen, rounds = set(reached), 0
    while reached and (high is None or rounds < high - low):
        reached = {end for begin in reached for end in ends(item, hits, begin)} - seen
        seen |= reached
        rounds += 1
    yield from seen


class Words:
    """Paths [P] of at most 15 hits: bit k of a u16 stands for the place before hit k, of all paths at once."""

    def __init__(self, routes):
        self.num_hits = np.array([len(route) for route in routes], np.uint16)
        self.places_of = {}  # (mesh name, event) -> u16 [P], where a path has such a hit
        for path, route in enumerate(routes):
            for k, hit in enumerate(route):
                self.places_of.setdefault(hit, np.zeros(len(routes), np.uint16))[path] |= 1 << k

    def taken_by(self, text):
        """Bool [P]: which of the paths the expression takes."""
        reached = self._reached(parse(text), np.ones(len(self.num_hits), np.uint16))
        return (reached >> self.num_hits & 1).astype(bool)

    def _reached(self, tree, start):
        """The places that `tree` can read up to from any of the places `start` [P]."""
        kind = tree[0]
        if kind == "hit":
            fits = [places for hit, places in self.places_of.items() if hit_fits(tree, *hit)]
            return self._after(fits, start)
        if kind == "choice":
            return np.bitwise_or.reduce([self._reached(branch, start) for branch in tree[1]])
        if kind == "sequence":
            for item in tree[1]:
                start = self._reached(item, start)
            return start
        return self._repeated(tree, start)

    @staticmethod
    def _after(fits, start):
        places = np.bitwise_or.reduce(fits) if fits else np.zeros_like(start)
        return (places & start) << 1

    def _repeated(self, tree, start):
        _, item, low, high = tree
        for _ in range(low):
            start = self._reached(item, start)
        seen, rounds = start, 0
        while high is None or rounds < high - low:
            start = self._reached(item, start) & ~seen
            if not start.any():
                break
            seen, rounds = seen | start, rounds + 1
        return seen
