#pragma once
// Finds the meshes whose planes are mirrors at a wavelength, so that nobody has to flag the walls of a city one by one.
#include <vector>

#include "echopath/scene/scene.h"

namespace echopath {

struct LargePlaneRule {
  std::vector<Vec3> antennas;   // world positions in m, at `time`
  double wavelength = 0.0;      // m
  double time = 0.0;            // s
  double least_coherent = 0.0;  // share of the reflected power that keeps its phase, from which on a surface is a mirror
  double least_area = 0.0;      // share of a mesh's area that large planes must make up
  double least_extent = 0.0;    // m, longest side of the box about a wall or a house; what is shorter may be a body
  double least_area_of_short = 0.0;  // the same share of what is shorter
  // m: what is no longer and no deeper than road vehicles and containers, and has large planes on three sides, is a body,
  // unless the antennas stand within it: then it is a room.
  double vehicle_length = 0.0, vehicle_width = 0.0;
  int most_small_planes = 0;  // that stay with the large ones
};

// Describes a mesh that large planes make up.
struct MeshOfLargePlanes {
  uint32_t mesh_id;
  std::vector<uint32_t> small;  // triangles of its other planes, ascending; empty where these are few
};

// Returns the meshes that large planes make up, by ascending IDs. A plane is large where it is at least twice as wide as the
// first Fresnel zone of a wave that is reflected at normal incidence at the vertex farthest from the antennas and then goes
// to infinity: 2 sqrt(wavelength distance). Its edges then matter almost nowhere. The width is four times the area over the
// length of the rim, the side of a square and twice that of a long strip; holes count to the rim, so a front full of windows
// is as wide as what is between them. Flagged mirrors, smooth meshes, sheets, what has a motion, also one at rest, and what
// deforms are left out. A plane that several meshes share is measured in each mesh by itself.
std::vector<MeshOfLargePlanes> meshes_of_large_planes(const Scene& scene, const LargePlaneRule& rule);

// Returns whether a mesh was cut from the flagged mirror above it, as the windows of a front are: both are parts of one
// mesh.
bool is_cut_from_mirror(const Scene& scene, uint32_t mesh_id);

}  // namespace echopath
