"""Path lengths in plain NumPy, from what scenes and motions were made of: no pose, no replay of the core."""
import numpy as np

import echopath as ep

from ..signals.placed_radar import product, turn as turned

CREASE_COSINE = np.cos(np.radians(30))


def lengths(paths, time, transmitter, receiver):
    """[P] in m at `time` in s between two antennas [3], in the radar's frame."""
    scene, radar = paths.scene, paths.radar
    shift, turn = rigid(radar.motion, time)
    turn = turn @ turned(radar.yaw, radar.pitch)
    start, end = (radar.position + shift + turn @ antenna for antenna in (transmitter, receiver))
    posed = {mesh.id: _with_facets(*surface(scene, mesh, time, paths.frame.trace_time)) for mesh in scene.meshes}
    mirrors = {mesh.id for mesh in scene.meshes if mesh.material.mirror}
    return np.array([_length(paths, path, posed, mirrors, start, end) for path in range(paths.num_paths)])


def _with_facets(vertices, triangles, *of_smooth):
    """What `surface` tells, and unit normals [F, 3] of the triangles."""
    corners = vertices[triangles]
    return vertices, triangles, *of_smooth, _unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))


def _length(paths, path, posed, mirrors, start, end):
    first = paths.offsets[path]
    rows = range(first, first + paths.num_bounces[path])
    planes, points = [], [start]
    total = 0.0
    for bit, row in enumerate(rows):
        point, normal = _hit(paths, row, posed)
        if paths.mesh_id[row] in mirrors and not int(paths.diffuse[path]) >> bit & 1:
            planes.append((point, normal))
            continue
        total += np.linalg.norm(point - _image(points[-1], planes))
        points.append(point)
        planes = []
    return total + np.linalg.norm(end - _image(points[-1], planes))


def _image(point, planes):
    for anchor, normal in planes:
        point = point - 2 * normal @ (point - anchor) * normal
    return point


def _hit(paths, row, posed):
    """Point and normal of a hit, on the curved surface where its triangle stands for one."""
    vertices, triangles, normals, smooth, facets = posed[paths.mesh_id[row]]
    triangle = paths.triangle_id[row]
    corners = vertices[triangles[triangle]]
    u, v = float(paths.u[row]), float(paths.v[row])
    weights = np.array([1 - u - v, u, v])
    point = weights @ corners
    if normals is not None and smooth[triangle]:
        of_corners = normals[triangles[triangle]]
        lift = np.einsum("ij,ij->i", corners - point, of_corners)
        point = point + 0.5 * (weights * lift) @ of_corners
    return point, facets[triangle]


def surface(scene, mesh, time, trace_time):
    """World vertices [V, 3], triangles [F, 3]; of smooth meshes vertex normals [V, 3] and which triangles are [F], else
    None."""
    node = scene.nodes[mesh.node]
    matrix, shift = world_from_node(scene, mesh.node, time)
    triangles = np.asarray(mesh.triangles, int)
    vertices = local_vertices(node, node.mesh, time) @ matrix.T + shift
    if not node.smooth:
        return vertices, triangles, None, None
    cofactors = np.linalg.det(matrix) * np.linalg.inv(matrix)
    normals = _unit(_surface_normals(node, time) @ cofactors)
    # Creases are where they were seen by the rays: at rest, or as deformed at the trace.
    at = trace_time if node.deformation is not None else None
    seen, seen_normals = local_vertices(node, node.mesh, at), _surface_normals(node, at)
    corners = seen[triangles]
    facet = _unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    smooth = (np.einsum("fkj,fj->fk", seen_normals[triangles], facet) >= CREASE_COSINE).all(axis=1)
    return vertices, triangles, normals, smooth


def _surface_normals(node, time):
    """[V, 3] in the node's frame, by the weights of Max (1999), from the whole surface that the mesh is a part of."""
    mesh = node.mesh
    whole = mesh if mesh.whole is None else mesh.whole
    vertices, triangles = local_vertices(node, whole, time), np.asarray(whole.triangles, int)
    sums = np.zeros_like(vertices)
    for k in range(3):
        corner = vertices[triangles[:, k]]
        one, two = vertices[triangles[:, (k + 1) % 3]] - corner, vertices[triangles[:, (k + 2) % 3]] - corner
        weight = (one**2).sum(axis=1) * (two**2).sum(axis=1)
        np.add.at(sums, triangles[:, k], np.cross(one, two) / weight[:, None])
    normals = _unit(sums)
    if mesh.whole is None:
        return normals
    mine = np.zeros((len(mesh.vertices), 3))
    mine[mesh.triangles] = normals[triangles[mesh.whole_triangle]]
    return mine


def local_vertices(node, mesh, time):
    """[V, 3] of a mesh in the frame of its node; time None: at rest."""
    if node.deformation is None or time is None:
        return np.array(mesh.vertices)
    return deformed(node.deformation, time)[mesh.original_vertex]


def deformed(deformation, time):
    """[V, 3] of a skin or of a linear vertex sequence."""
    if isinstance(deformation, ep.Skin):
        return _blended(deformation, time)
    assert deformation.interpolation == "linear"
    return _between(deformation.times, deformation.vertices, time)


def _blended(skin, time):
    names = [joint.name for joint in skin.joints]
    moved = []
    out = np.zeros((skin.num_vertices, 3))
    for index, joint in enumerate(skin.joints):
        local = np.eye(4)
        shift, turn = rigid(joint.motion, time)
        local[:3, :3] = turn @ joint.transform[:3, :3]
        local[:3, 3] = joint.transform[:3, 3] + shift
        moved.append(local if joint.parent is None else moved[names.index(joint.parent)] @ local)
        matrix = moved[-1] @ joint.inverse_bind
        weight = (skin.weights * (skin.joint_indices == index)).sum(axis=1)
        out += weight[:, None] * (skin.vertices @ matrix[:3, :3].T + matrix[:3, 3])
    return out


def world_from_node(scene, index, time):
    """Linear part [3, 3] and translation [3]."""
    matrix, shift = np.eye(3), np.zeros(3)
    while index >= 0:
        node = scene.nodes[index]
        step, turn = rigid(node.motion, time)
        linear, offset = turn @ node.placement[:3, :3], node.placement[:3, 3] + step
        matrix, shift = linear @ matrix, linear @ shift + offset
        index = node.parent
    return matrix, shift


def rigid(motion, time):
    """Translation [3] and rotation [3, 3] of a motion; keyframes must be linear."""
    if motion is None:
        return np.zeros(3), np.eye(3)
    if isinstance(motion, ep.LinearMotion):
        return time * motion.velocity, rodrigues(time * motion.angular_velocity)
    assert motion.interpolation == "linear"
    shift = _between(motion.times, motion.translations, time) if len(motion.translations) else np.zeros(3)
    return shift, _slerp(motion, time) if len(motion.rotations) else np.eye(3)


def rodrigues(rotation):
    """Rotation matrix of a rotation vector in rad."""
    angle = np.linalg.norm(rotation)
    if angle == 0:
        return np.eye(3)
    x, y, z = rotation / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def _slerp(motion, time):
    k, share = _place(motion.times, time)
    first, second = motion.rotations[k], motion.rotations[k + 1]
    if first @ second < 0:
        second = -second
    conjugate = first * [1, -1, -1, -1]
    step = product(second, conjugate)
    sine = np.linalg.norm(step[1:])
    axis = step[1:] / sine if sine > 0 else np.array([1.0, 0, 0])
    start = rodrigues(_rotation_vector(first))
    return rodrigues(share * 2 * np.arctan2(sine, step[0]) * axis) @ start


def _rotation_vector(q):
    sine = np.linalg.norm(q[1:])
    return 2 * np.arctan2(sine, q[0]) * q[1:] / sine if sine > 0 else np.zeros(3)


def _between(times, values, time):
    k, share = _place(times, time)
    return (1 - share) * values[k] + share * values[k + 1]


def _place(times, time):
    k = int(np.clip(np.searchsorted(times, time, side="right") - 1, 0, len(times) - 2))
    return k, (time - times[k]) / (times[k + 1] - times[k])


def _unit(rows):
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)
