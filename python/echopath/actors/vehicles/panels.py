"""Names of the panels of cars and vans: what each face of the lattice (outline.py) belongs to."""
from .outline import ARCH, AT, BELT, COLUMNS, SHOULDER

LAST_COLUMN = len(COLUMNS) - 2
SIDES = {-1: "right", 1: "left"}


def label_of(outline):
    """A function Face -> (sheet, part name) for lattice.cage_of."""
    def label(face):
        if not face.outer:
            return "underside", "underside/arches"
        if face.axis == 2 and face.side < 0:
            return "underside", "underside/floor"
        if face.axis == 1:
            return "skin", _side(outline, face)
        if face.axis == 2:
            return "skin", _top(outline, face)
        return "skin", _nose(face) if face.side > 0 else _tail(outline, face)

    return label


def _side(outline, face):
    side, (i, _, k) = SIDES[face.side], face.cell
    if i >= AT["cowl"]:
        return _front_side(side, i, k)
    if i < AT["rear_arch_3"]:
        return _rear_side(outline, side, i, k)
    if k >= BELT:
        return _window(outline, side, i)
    return f"body/door_front_{side}" if i >= AT["pillar_0"] else _behind_door(outline, side)


def _front_side(side, i, k):
    ahead = i >= AT["front_arch_3"]
    if ahead and k < ARCH:
        return "bumper/front"
    return f"lamp/head_{side}" if i >= AT["nose_in"] and k == SHOULDER else f"body/fender_{side}"


def _rear_side(outline, side, i, k):
    if i < AT["rear_arch_0"] and k < ARCH:
        return "bumper/rear"
    if i < AT["tail_in"] and k == SHOULDER:
        return f"lamp/tail_{side}"
    is_window = k >= BELT and outline.glazed and (outline.deck is None and AT["tail_in"] <= i)
    return f"glass/quarter_{side}" if is_window else f"body/quarter_{side}"


def _window(outline, side, i):
    if i >= AT["pillar_1"]:
        return f"glass/door_front_{side}"
    if i == AT["pillar_0"]:
        return f"body/pillar_{side}"
    return f"glass/door_rear_{side}" if outline.glazed else _behind_door(outline, side)


def _behind_door(outline, side):
    return f"body/door_rear_{side}" if outline.glazed else f"body/panel_{side}"


def _top(outline, face):
    i = face.cell[0]
    if i >= AT["nose_in"]:
        return "bumper/front"
    if i >= AT["cowl"]:
        return "body/hood"
    if i >= AT["screen_top"]:
        return "glass/windscreen"
    if outline.deck is None or i >= AT["rear_arch_2"]:
        return "body/roof"
    return "glass/rear_window" if i >= AT["rear_arch_0"] else "body/tailgate"


def _nose(face):
    _, j, k = face.cell
    if k == SHOULDER and (j < 2 or j > LAST_COLUMN - 2):
        return f"lamp/head_{'right' if j < 2 else 'left'}"
    if ARCH <= k <= SHOULDER and 1 < j < LAST_COLUMN - 1:
        return "bumper/grille"
    return "bumper/front"


def _tail(outline, face):
    _, j, k = face.cell
    if k < ARCH:
        return "bumper/rear"
    if k == SHOULDER and j in (0, LAST_COLUMN):
        return f"lamp/tail_{'right' if j == 0 else 'left'}"
    is_window = k >= BELT and outline.deck is None and outline.glazed and 0 < j < LAST_COLUMN
    return "glass/rear_window" if is_window else "body/tailgate"
