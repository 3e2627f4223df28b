"""Changes of bytes and of text, as damage and mistakes make them."""
from __future__ import annotations

from random import Random

WORDS = ["0", "-0.1", "1e308", "-1e308", "1e-320", "1e400", "nan", "inf", "-inf", "1e19", "9223372036854775807",
         "9223372036854775808", "18446744073709551616", "-1", "true", "false", '""', '"\\u0000"', '"x"', "[]", "{}", "[[]]",
         "[0, 0, 0]", "[5, -0.1]", "[1e300, 0, 0]", "1979-05-27", "07:32:00", '"' + "a" * 300 + '"', "0x7fffffff", "1_0",
         "'wall*'", "T . R", "\"T (.{64}){64} R\"", "1.0", "1000000000", "1e9", "\ufeff", "\x00", "\ud83d", "\u2028", "#", "="]


def damaged(content: bytes, random: Random) -> bytes:
    """Some bytes of a file changed, lost or added."""
    content = bytearray(content)
    for _ in range(random.choice((1, 1, 1, 2, 4))):
        _damage(content, random)
    return bytes(content)


def _damage(content: bytearray, random: Random) -> None:
    if not content:
        content += random.randbytes(8)
        return
    size = len(content)
    at, length = random.randrange(size), random.choice((1, 2, 4, 8, 64, 512, 4096))
    kind = random.randrange(8)
    if kind <= 2:
        content[at] ^= 1 << random.randrange(8)
    elif kind == 3:
        content[at] = random.randrange(256)
    elif kind == 4:
        content[at:at + length] = bytes([random.choice((0, 255))]) * len(content[at:at + length])
    elif kind == 5:
        content[at:at + length] = random.randbytes(len(content[at:at + length]))
    elif kind == 6:
        source = random.randrange(size)
        content[at:at + length] = content[source:source + length][:len(content[at:at + length])]
    elif random.random() < 0.3:
        del content[max(1, at):]
    else:
        content[at:at] = random.randbytes(length)


def mistaken(text: str, others: list, random: Random) -> str:
    """A text with words, lines or letters changed, or with lines of other texts."""
    for _ in range(random.choice((1, 1, 2, 3, 6))):
        text = _mistake(text, others, random) or text
    return text


def _mistake(text: str, others: list, random: Random) -> str:
    lines = text.split("\n")
    at = random.randrange(len(lines))
    kind = random.randrange(9)
    if kind <= 3:
        lines[at] = _other_value(lines[at], random)
    elif kind == 4:
        del lines[at]
    elif kind == 5:
        lines.insert(at, random.choice(random.choice(others).split("\n")))
    elif kind == 6:
        lines.insert(at, lines[random.randrange(len(lines))])
    elif kind == 7:
        begin = random.randrange(len(text) + 1)
        return text[:begin] + random.choice(WORDS) + text[begin + random.choice((0, 1, 3)):]
    else:
        begin = random.randrange(len(text) + 1)
        return text[:begin] + chr(random.choice((random.randrange(128), random.randrange(0xD800)))) + text[begin:]
    return "\n".join(lines)


def _other_value(line: str, random: Random) -> str:
    """A line `key = value`, or of comma separated values, with another value."""
    key, sign, _ = line.partition("=")
    if sign:
        return f"{key}= {random.choice(WORDS)}"
    values = line.split(",")
    values[random.randrange(len(values))] = random.choice(WORDS)
    return ",".join(values)
