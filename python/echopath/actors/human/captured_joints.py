"""Which joints of a motion capture are those of the body, by the names that usual skeletons give them."""
from __future__ import annotations

import re

# our name -> words of theirs behind "left" or "right", the more telling first (CMU, Mixamo, Poser, Rokoko, 3ds Max, SMPL,
# Kinect): a skeleton with ankles and feet has its feet at the balls, and hands behind wrists are at the palms
_OF_SIDES = {
    "hip": ("upleg", "upperleg", "thigh", "hip", "hipjoint", "femur"),
    "knee": ("leg", "lowerleg", "lowleg", "knee", "shin", "calf", "tibia"),
    "ankle": ("ankle", "foot"),
    "toe": ("toebase", "toe", "toes", "ball", "toe0", "footend", "toeend", "foot"),
    "shoulder": ("arm", "upperarm", "uparm", "shldr", "humerus", "shoulder"),
    "elbow": ("forearm", "lowerarm", "lowarm", "elbow", "radius"),
    "wrist": ("wrist", "hand"),
}
_OF_THE_MIDDLE = {"head": ("head",)}
OPTIONAL = ("left_toe", "right_toe")


def plain(name: str) -> str:
    """A name without what comes before it in some programs: "mixamorig:LeftUpLeg" -> "leftupleg"."""
    name = re.sub(r"^.*[:|]", "", name)
    name = re.sub(r"^(mixamorig\d*_?|bip0*1?[ _]?|character\d*_|def[-_.]|b_)", "", name, flags=re.IGNORECASE)
    side = re.search(r"(?:^|[ _.\-])([lLrR])(?:[ _.\-]|$)|^([lr])(?=[A-Z])|^([LR])(?=[A-Z][a-z])", name)
    if side:
        letter = next(filter(None, side.groups())).lower()
        name = {"l": "left", "r": "right"}[letter] + name[:side.start()] + name[side.end():]
    elif last := re.search(r"(?:[ _.\-]([Ll]eft|[Rr]ight)|(?<=[a-z0-9])(Left|Right))$", name):
        name = next(filter(None, last.groups())) + name[:last.start()]
    return re.sub(r"[^a-z0-9]", "", name.lower())


def find_joints(names: list[str]) -> dict[str, int]:
    """{our name: index} of the joints that are there: left_hip, left_knee, ... right_wrist, head."""
    index: dict[str, int] = {}
    for number, name in enumerate(names):
        index.setdefault(plain(name), number)
    found = {}
    wanted = {f"{side}_{ours}": [side + word for word in theirs]
              for side in ("left", "right") for ours, theirs in _OF_SIDES.items()}
    for ours, theirs in {**wanted, **_OF_THE_MIDDLE}.items():
        match = next((index[word] for word in theirs if word in index), None)
        if match is not None and match not in found.values():
            found[ours] = match
    return found


def missing_joints(found: dict[str, int]) -> list[str]:
    """Our names of the joints that a body needs and that were not found."""
    wanted = [f"{side}_{ours}" for side in ("left", "right") for ours in _OF_SIDES] + list(_OF_THE_MIDDLE)
    return [name for name in wanted if name not in found and name not in OPTIONAL]
