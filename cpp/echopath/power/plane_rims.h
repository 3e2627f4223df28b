#pragma once
// Bounds what the planes of a mesh send straight back aslant: the waves of their rims.
#include <limits>
#include <optional>
#include <vector>

#include "echopath/posed/posed_scene.h"
#include "echopath/radar/radar.h"
#include "echopath/scene/scene.h"

namespace echopath {

// A plane of which no point reflects the wave sends back, by physical optics, what its rim does: the integral of
// cos(theta) exp(-2jkR) / (lambda R^2) over it is, to first order in 1/k, one along its rim (divergence theorem), and that
// one, along straight sides, is a wave from each end and one from the point next to the antennas.
struct RimWaves {
  double own = 0.0;  // 1/m, sum of the sizes of these waves; infinite where the plane reflects, or is not known
  // This is the most, 1/m, that the rim of a shadow on the plane is taken to have. What hides a part of it is upright then,
  // or has sides along those of the plane.
  double of_shadow = 0.0;
  double solid_angle = 0.0;  // sr
};

// Holds the planes of a mesh, but for those on the far side of a closed body.
struct PlaneWaves {
  static constexpr uint32_t kFarSide = 0xFFFFFFFFu;
  std::vector<RimWaves> planes;
  std::vector<uint32_t> plane_of;  // [F] index into planes or kFarSide; empty where the waves of the mesh are not known

  // Returns the most that the planes send back, 1/m. `num_rays` [F] of an even `density` (rays per sr), with which all of
  // the mesh was aimed at, have met each triangle: what is hidden of a plane adds rims.
  double at_most(const std::vector<int64_t>& num_rays, double density) const;
};

// Finds the waves of the meshes of a scene when they are asked for. The scene must outlive it.
class PlaneRims {
 public:
  static constexpr size_t kMostTriangles = 4096;  // of meshes that are looked at

  // The wave goes from the first transmitter to the first receiver of `radar` at `time` (s).
  PlaneRims(const Scene& scene, const Radar& radar, double time);
  // Returns the waves of a mesh of flat facets, as if mirrored in full. They are not known for meshes of too many triangles,
  // for smooth ones, and where the antennas are far from each other, seen from there.
  const PlaneWaves& of(uint32_t mesh_id);

 private:
  PlaneWaves found(uint32_t mesh_id);

  const Scene& scene_;
  const double wavenumber_;  // rad/m
  const double time_;
  Vec3 middle_ = Vec3::Zero();  // of the two antennas, m
  double apart_ = 0.0;          // m
  std::optional<PosedScene> pose_;
  std::vector<std::optional<PlaneWaves>> found_;  // by mesh ID
};

}  // namespace echopath
