"""Outer shapes of cars and vans: stations along the body, at which its lines stand, and the lattice through them.

Lengths in m; x forward from the middle of the length, y left, z up from the road.
"""
from dataclasses import dataclass

import numpy as np

ARCH_CLEARANCE = 0.055     # m between tyre and wheel arch
ARCH_INSIDE = 0.10         # m by which an arch is deeper than the tyre is wide
WHEEL_INSET = 0.065        # m from the widest place of the body to the outer side of the tyre
SIDE_BOW = 0.040           # by which the sides draw in from the middle to the axles, as seen from above, of the half width
CORNER = 0.10              # m, least way along x from a wheel arch to the end of the body
COLUMNS = np.array([-1.0, -0.82, -0.58, -0.30, 0.0, 0.30, 0.58, 0.82, 1.0])    # lines across, as shares of the half width
SILL, LOW, ARCH, SHOULDER, BELT, WINDOW, RAIL = range(7)   # lines of the side, from below; RAIL is under the roof
ROWS = RAIL
STATIONS = ("tail", "tail_in", "tail_side", "rear_arch_0", "rear_arch_1", "rear_arch_2", "rear_arch_3", "pillar_0", "pillar_1",
            "screen_top", "screen_high", "screen_low", "cowl", "front_arch_1", "front_arch_2", "front_arch_3", "nose_in", "nose")
AT = {name: index for index, name in enumerate(STATIONS)}


@dataclass(frozen=True)
class Outline:
    """Published: length, width without mirrors, height, wheelbase, front_overhang, tyre_diameter and tyre_width. Drawn after
    side views: heights of the lines and places of the pillars.

    clearance: of the underside; bonnet, cowl: height of the bonnet's front edge and rear end; deck: height of the boot lid, or
    None for a body whose roof goes on to the tail; tail_roof: height of the roof's rear end as a share of the height;
    tail_rake: how far the tail leans ahead at its top; belt: height of the windows' lower edge in front and behind; screen:
    length of the windscreen along x; roof_width: of its rails, as a share of the width; pillar: place of the middle pillar
    as a share of the way from the front to the rear axle; glazed: whether windows go on behind it; levels: subdivisions of
    the lattice's faces, so that their triangles follow the surface at 77 GHz.
    """

    length: float
    width: float
    height: float
    wheelbase: float
    front_overhang: float
    tyre_diameter: float
    tyre_width: float
    clearance: float
    bonnet: float
    cowl: float
    belt: tuple
    screen: float
    roof_width: float
    deck: float | None = None
    tail_roof: float = 0.97
    tail_rake: float = 0.16
    pillar: float = 0.56
    glazed: bool = True
    levels: int = 1

    @property
    def front_axle(self):
        """x of the front axle."""
        return self.length / 2 - self.front_overhang

    @property
    def rear_axle(self):
        return self.front_axle - self.wheelbase

    @property
    def arch_radius(self):
        return self.tyre_diameter / 2 + ARCH_CLEARANCE

    @property
    def wheel_y(self):
        """Distance of a wheel's middle plane from that of the body."""
        return self.width / 2 - WHEEL_INSET - self.tyre_width / 2


def full_cells():
    """Full cells [X, Y, Z]: all but those of the four wheel arches."""
    full = np.ones((len(STATIONS) - 1, len(COLUMNS) - 1, ROWS), dtype=bool)
    for first in (AT["rear_arch_0"], AT["cowl"]):
        for side in (0, -1):
            full[first:first + 3, side, :ARCH] = False
    return full


def lattice_points(outline):
    """Corners of the lattice's cells [X + 1, Y + 1, Z + 1, 3]; those inside are meaningful about the arches only."""
    x = _stations(outline)
    z, half = _side_lines(outline, x)
    share = np.broadcast_to(COLUMNS[None, :, None], (len(x), len(COLUMNS), ROWS + 1)).copy()
    points = np.empty(share.shape + (3,))
    points[..., 0] = x[:, None, None]
    points[..., 1] = share * half[:, None, :]
    points[..., 2] = z[:, None, :]
    points[:, :, SILL, 2] = np.where(np.abs(COLUMNS) < 0.99, outline.clearance, points[:, :, SILL, 2])
    crown = np.where(np.arange(len(x)) >= AT["front_arch_1"], 0.055, 0.045)
    points[:, :, RAIL, 2] += crown[:, None] * (1.0 - COLUMNS**2)
    _round_ends(outline, points)
    _bend_arches(outline, points)
    return points


def _stations(o):
    radius = 1.06 * o.arch_radius
    rear, front, half = o.rear_axle, o.front_axle, o.length / 2
    pillar = front - o.pillar * o.wheelbase
    cowl = front - radius
    screen_top = cowl - o.screen
    return np.array([-half, -half + 0.26 * (rear - radius + half),
                     -half + 0.6 * (rear - radius + half), rear - radius, rear - 0.42 * radius,
                     rear + 0.42 * radius, rear + radius, pillar - 0.05, pillar + 0.07, screen_top, cowl - 0.67 * o.screen,
                     cowl - 0.33 * o.screen, cowl, front - 0.42 * radius, front + 0.42 * radius, front + radius,
                     half - 0.42 * (half - front - radius), half])


def _side_lines(o, x):
    """Heights z [X, Z + 1] and half widths [X, Z + 1] of the lines of the side at the stations."""
    top = _roof_line(o, x)
    cabin = ((x <= x[AT["cowl"]]) & (top > o.belt[1] + 0.02))[:, None]
    belt = np.minimum(np.interp(x, [x[0], x[AT["cowl"]]], [o.belt[1], o.belt[0]]), top - 0.09)
    sill = o.clearance + 0.035
    arch = np.minimum(o.tyre_diameter / 2 + 0.83 * o.arch_radius, np.where(cabin[:, 0], belt - 0.12, top - 0.12))
    rail = np.interp(top - o.belt[1], [0.05, 0.93 * (o.height - 0.045 - o.belt[1])], [0.80, o.roof_width])
    lower = np.stack([np.full_like(x, sill), 0.42 * arch + 0.58 * sill, arch], axis=-1)
    upper = np.stack([0.4 * arch + 0.6 * belt - 0.02, belt, 0.42 * belt + 0.58 * top, top], axis=-1)
    wide = np.stack([np.full_like(x, 0.985), np.full_like(x, 0.943), 0.342 + 0.64 * rail, rail], axis=-1)
    angle = np.radians([22.0, 45.0, 68.0, 90.0])    # of a quarter ellipse: the shoulder of bonnet and boot
    round_z = arch[:, None] + (top - arch)[:, None] * np.sin(angle)
    round_wide = rail[:, None] + (1.0 - rail)[:, None] * np.cos(angle)
    z = np.concatenate([lower, np.where(cabin, upper, round_z)], axis=1)
    share = np.concatenate([np.tile([0.955, 0.99, 1.0], (len(x), 1)), np.where(cabin, wide, round_wide)], axis=1)
    return z, 0.5 * o.width * share * _taper(o, x)[:, None]


def _taper(o, x):
    """Half width over that of the middle: the plan narrows towards nose and tail."""
    ahead = np.clip((x - o.front_axle) / (o.length / 2 - o.front_axle), 0.0, 1.0)
    behind = np.clip((o.rear_axle - x) / (o.rear_axle + o.length / 2), 0.0, 1.0)
    middle = 0.5 * (o.front_axle + o.rear_axle)
    bow = np.minimum(np.abs(x - middle) / (0.5 * o.wheelbase), 1.2) ** 2
    return 1.0 - SIDE_BOW * bow - 0.12 * ahead**2.5 - 0.08 * behind**2.5


def _roof_line(o, x):
    """Height of the line under the roof, the bonnet and the boot at the stations."""
    crown = 0.045
    knots = {"nose": o.bonnet - 0.04, "nose_in": o.bonnet, "front_arch_3": 0.65 * o.bonnet + 0.35 * o.cowl, "cowl": o.cowl,
             "screen_low": 0.65 * o.cowl + 0.35 * (o.height - crown),
             "screen_high": 0.29 * o.cowl + 0.71 * (o.height - crown), "screen_top": o.height - crown - 0.035,
             "pillar_1": o.height - crown, "pillar_0": o.height - crown}
    if o.deck is None:
        knots |= {"rear_arch_2": 0.5 * (1.0 + o.tail_roof) * o.height - crown, "tail_in": o.tail_roof * o.height - crown - 0.01,
                  "tail": o.tail_roof * o.height - crown - 0.05}
    else:
        knots |= {"rear_arch_3": o.height - crown - 0.03, "rear_arch_2": 0.42 * o.deck + 0.58 * o.height,
                  "rear_arch_0": o.deck, "tail_in": o.deck, "tail": o.deck - 0.025}
    order = sorted(knots, key=AT.get)
    return np.interp(x, [x[AT[name]] for name in order], [knots[name] for name in order])


def _round_ends(o, points):
    """Bends nose and tail backwards at the sides, as seen from above, and leans them, as seen from the side."""
    across = np.abs(COLUMNS)[:, None]
    nose = -np.array([0.045, 0.007, 0.0, 0.022, 0.068, 0.095, 0.135])[None, :] - 0.18 * across**2.5 - 0.10 * across**2
    tail = np.array([0.05, 0.015, 0.0, 0.02, 0.045, 0.065, 0.10])[None, :] + 0.05 * across**2.5 + 0.06 * across**2
    tail = tail + (o.tail_rake * np.array([0, 0, 0.02, 0.09, 0.28, 0.60, 1.0])[None, :] if o.deck is None else 0.0)
    ends = ((AT["nose"], AT["nose_in"], AT["front_arch_3"], nose), (AT["tail"], AT["tail_in"], AT["rear_arch_0"], tail))
    for end, inner, arch, shift in ends:
        forward = np.sign(points[end, 0, 0, 0])
        edge = points[arch, 0, 0, 0]
        room = forward * (points[end, 0, 0, 0] - edge)
        room = room + forward * shift * min(1.0, (room - CORNER) / np.abs(shift).max())
        points[end, :, :, 0] = edge + forward * room
        points[inner, :, :, 0] = edge + forward * np.minimum(forward * (points[inner, :, :, 0] - edge), 0.6 * room)


def _bend_arches(o, points):
    """Puts the lines about each wheel on its arch, and the inner wall of the arch behind the tyre."""
    radius, axle_z = 1.05 * o.arch_radius, o.tyre_diameter / 2
    inner = o.wheel_y - o.tyre_width / 2 - ARCH_INSIDE
    turned = {(0, LOW): (-0.98, 0.10), (0, ARCH): (-0.80, 0.78), (1, ARCH): (-0.36, 1.04), (2, ARCH): (0.36, 1.04),
              (3, ARCH): (0.80, 0.78), (3, LOW): (0.98, 0.10)}
    for first, axle in ((AT["rear_arch_0"], o.rear_axle), (AT["cowl"], o.front_axle)):
        for (step, row), (along, up) in turned.items():
            points[first + step, (0, 1, -2, -1), row, 0] = axle + along * radius
            points[first + step, (0, 1, -2, -1), row, 2] = axle_z + up * radius
        for column, sign in ((1, -1.0), (-2, 1.0)):
            points[first:first + 4, column, :ARCH + 1, 1] = sign * inner
