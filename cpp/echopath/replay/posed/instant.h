#pragma once
// Scene and antennas at one time, relative to the origin of the trace.
#include <vector>

#include "echopath/scene/surface_patch.h"
#include "echopath/trace/record/paths.h"

namespace echopath {

struct PosedAntenna {
  Vec3 position;    // m, relative to the origin
  Vec3 boresight;   // unit, world axes
  Vec3 polarization;  // world axes
  const AntennaPattern* pattern = nullptr;
  Mat3 antenna_from_world = Mat3::Identity();  // only tables need it

  // Toward a unit direction in the world, outward.
  AntennaGain toward(const Vec3& direction) const {
    if (pattern->kind != AntennaPattern::Kind::kTable) return {pattern->gain(boresight.dot(direction)), 0.0};
    return pattern->toward(antenna_from_world * direction);
  }
};

class Instant {
 public:
  // patches: by mesh ID (replay/posed/hit_patches.h), what of deforming meshes is posed. The radar must outlive the instant.
  // Raises invalid_argument when a motion is not defined at `time` (s).
  Instant(const Scene& scene, const Radar& radar, const std::vector<SurfacePatch>& patches, const Vec3& origin, double time);

  std::vector<PosedAntenna> transmitters, receivers;

  // Mesh frame -> world relative to the origin.
  const Mat3& rotation(uint32_t mesh_id) const { return rotation_[mesh_id]; }
  const Vec3& translation(uint32_t mesh_id) const { return translation_[mesh_id]; }
  // Normals of the mesh's frame -> normals in the world, not normalised (cofactors: follows the winding of the triangles).
  const Mat3& normal_matrix(uint32_t mesh_id) const { return normal_matrix_[mesh_id]; }
  // Of deforming meshes, by place in their patch: vertices in the mesh's frame, m, and where the mesh is smooth their unit
  // normals (right at the corners of triangles that were hit).
  const std::vector<Vec3>& deformed_vertices(uint32_t mesh_id) const { return deformed_vertices_[mesh_id]; }
  const std::vector<Vec3>& deformed_normals(uint32_t mesh_id) const { return deformed_normals_[mesh_id]; }

 private:
  void add_mesh(const Node& node, const SurfacePatch& patch, const Transform& world_from_mesh, const Vec3& origin, double time);

  std::vector<Mat3> rotation_, normal_matrix_;
  std::vector<Vec3> translation_;
  std::vector<std::vector<Vec3>> deformed_vertices_, deformed_normals_;
};

}  // namespace echopath
