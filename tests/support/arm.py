"""A skinned arm: one smooth tube with a shoulder at the origin and an elbow, hanging along -z."""
import numpy as np

import echopath as ep

LENGTH, ELBOW, RADIUS, BEND = 0.6, 0.3, 0.05, 0.06  # m; BEND: how far along the arm both joints share the skin


def tube(num_rings=25, num_around=12):
    """Closed capsule-like mesh along -z."""
    heights = np.linspace(0.0, LENGTH, num_rings)
    profile = RADIUS * np.sqrt(1 - (2 * heights / LENGTH - 1) ** 8)
    angles = 2 * np.pi * np.arange(num_around) / num_around
    rings = [[(r * np.cos(a), r * np.sin(a), -h) for a in angles] for h, r in zip(heights[1:-1], profile[1:-1])]
    vertices = np.vstack([*rings, [[0, 0, 0], [0, 0, -LENGTH]]])
    top, bottom = len(vertices) - 2, len(vertices) - 1
    triangles = []
    for k in range(num_around):
        after = (k + 1) % num_around
        triangles.append([top, k, after])
        for ring in range(len(rings) - 1):
            a, b = ring * num_around + k, ring * num_around + after
            triangles += [[a, a + num_around, b + num_around], [a, b + num_around, b]]
        last = (len(rings) - 1) * num_around
        triangles.append([last + k, bottom, last + after])
    return ep.Mesh(vertices, triangles)


def arm_weights(vertices):
    """[V, 2] of upper arm and forearm."""
    forearm = np.clip(0.5 + (-vertices[:, 2] - ELBOW) / BEND, 0.0, 1.0)
    return np.column_stack([1 - forearm, forearm])


def make_arm(motions=(None, None)):
    """(mesh, skin) with the motions of shoulder and elbow."""
    mesh = tube()
    joints = [ep.Joint("upper", motion=motions[0]), ep.Joint("fore", "upper", position=(0, 0, -ELBOW), motion=motions[1])]
    return mesh, ep.Skin(mesh.vertices, joints, arm_weights(mesh.vertices))
