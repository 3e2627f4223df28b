"""What the tables of a scene file are made of: kinds of numbers and names, rules of several keys, and the strict table itself."""
from __future__ import annotations

import difflib
import math
import sys
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, model_validator
from pydantic_core import PydanticCustomError

from ... import _core
from ...arguments.checks import Rule
from ...arguments.frame_times import lifetime_rule
from ...arguments.shown import writable

Number = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]
Pitch = Annotated[float, Field(ge=-90, le=90, allow_inf_nan=False)]
Vector3 = Annotated[list[Number], Field(min_length=3, max_length=3)]
Quaternion = Annotated[list[Number], Field(min_length=4, max_length=4)]
Matrix4 = Annotated[list[Quaternion], Field(min_length=4, max_length=4)]


def nearest_key(key: str, candidates) -> str:
    """What to say about an unknown key: the nearest known one, or all of them when none is near."""
    candidates = list(candidates)
    near = _core.meant_name(writable(key), candidates) or next(
        iter(difflib.get_close_matches(key.lower(), candidates, n=1, cutoff=0.5)), "")
    if near:
        return f"did you mean '{near}'?"
    return "known keys: " + ", ".join(candidates)


def yaw_of(degrees: float | None) -> float:
    """The yaw in rad of a key in degrees, without whole turns beyond the first, which a caller in rad would be warned of."""
    degrees = degrees or 0.0
    return math.radians(math.fmod(degrees, 360.0) if abs(degrees) > 360.0 else degrees)


def is_number(value) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) <= sys.float_info.max


def by_check(check: Rule) -> AfterValidator:
    """Holds a value to the rule of an argument, and says of a wrong one what the call would, behind the key."""
    def checked(value):
        try:
            return check("", value)
        except (TypeError, ValueError) as error:
            raise PydanticCustomError("refused", "{told}", {"told": str(error)}) from None
    return AfterValidator(checked)


Lifetime = Annotated[Any, by_check(lifetime_rule)]


class Table(BaseModel):
    """A TOML table: only known keys, strict types."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, arbitrary_types_allowed=True)

    @model_validator(mode="before")
    @classmethod
    def _know_every_key(cls, data):
        if isinstance(data, dict):
            for key in data:
                if key not in cls.model_fields:
                    raise PydanticCustomError("unknown_key", "unknown key", {"key": key, "table": cls,
                                                                             "advice": cls._advice(key, data)})
        return data

    @classmethod
    def _advice(cls, key: str, data: dict) -> str:
        """What this table alone says about an unknown key, "" for nothing."""
        return ""


def broken_rule(key: str, rule: str, value=None) -> PydanticCustomError:
    """An error of several keys together, reported at `key` of the table that raises it."""
    return PydanticCustomError("broken_rule", "{rule}", {"key": key, "rule": rule, "value": value})


def by_kind(kind: str):
    """Chooses the table of a union by its key `kind`."""
    def tag(data):
        return f"<{data.get(kind)}>" if isinstance(data, dict) else None
    return tag


def _name(value: str) -> str:
    if "\0" in value:
        raise ValueError("must not hold a NUL character")
    return value


Name = Annotated[str, Field(min_length=1), AfterValidator(_name)]
