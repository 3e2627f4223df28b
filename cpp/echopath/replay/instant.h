#pragma once
// Scene and antennas at one time, relative to the origin of the trace.
#include <vector>

#include "echopath/trace/paths.h"

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
  // The radar must outlive the instant. Raises invalid_argument when a motion is not defined at `time` (s).
  Instant(const Scene& scene, const Radar& radar, const Vec3& origin, double time);

  std::vector<PosedAntenna> transmitters, receivers;

  // Mesh frame -> world relative to the origin.
  const Mat3& rotation(uint32_t mesh_id) const { return rotation_[mesh_id]; }
  const Vec3& translation(uint32_t mesh_id) const { return translation_[mesh_id]; }
  // Normals of the mesh's frame -> normals in the world, not normalised (cofactors: follows the winding of the triangles).
  const Mat3& normal_matrix(uint32_t mesh_id) const { return normal_matrix_[mesh_id]; }
  // Unit vertex normals in the mesh's frame of a smooth mesh that deforms; empty otherwise.
  const std::vector<Vec3>& deformed_normals(uint32_t mesh_id) const { return deformed_normals_[mesh_id]; }
  // Vertices in the mesh's frame, deformed at this time.
  const std::vector<Vec3>& local_vertices(uint32_t mesh_id) const { return pose_.local_vertices(mesh_id); }

 private:
  Pose pose_;
  std::vector<Mat3> rotation_, normal_matrix_;
  std::vector<Vec3> translation_;
  std::vector<std::vector<Vec3>> deformed_normals_;
};

}  // namespace echopath
