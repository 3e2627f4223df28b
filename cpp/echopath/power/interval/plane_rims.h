#pragma once
// Bounds what the planes of a mesh send from one antenna to another where none reflects: the waves of their rims.
#include <array>
#include <span>
#include <vector>

#include "echopath/base/plane.h"
#include "echopath/scene/mesh/adjacency.h"

namespace echopath {

// Holds where a wave comes from and where it goes, m: antennas, or their images over mirrors.
struct AntennaPair {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
};

// A plane of which no point reflects the wave sends on, by physical optics, what its rim does: the integral of
// cos(theta) exp(-jk(R1 + R2)) / (lambda R1 R2) over it is, to first order in 1/k, one along its rim (divergence theorem).
// That one, along straight sides, is a wave from each end and one from the point over which the way is the shortest.
struct RimWaves {
  double own = 0.0;  // 1/m, sum of the sizes of these waves; infinite where the plane reflects, or is not known
  // This is the most, 1/m, that the rim of a shadow on the plane is taken to have. What hides a part of it is upright then,
  // or has sides along those of the plane.
  double of_shadow = 0.0;
  double solid_angle = 0.0;  // sr, where the wave comes from
};

// Returns the most that planes send on, 1/m. `seen` is the solid angle, sr, in which rays have met each of the planes; none
// have met those behind its end. What is hidden of a plane adds rims.
double rims_at_most(std::span<const RimWaves> planes, std::span<const double> seen);

// Holds the planes of a mesh at one time. The triangles must outlive it.
class FacetedBody {
 public:
  // `vertices`: [V], m. `is_closed`: the body has an inside, from which no wave meets it.
  FacetedBody(std::vector<Vec3> vertices, const std::vector<Triangle>& triangles, bool is_closed);

  const std::vector<Vec3>& vertices() const { return vertices_; }
  uint32_t plane_at(uint32_t triangle) const { return patch_of_[triangle]; }
  const Plane& plane(uint32_t index) const { return planes_[index]; }
  std::array<Vec3, 3> corners(uint32_t triangle) const;  // m
  // Returns the waves of each plane, as if mirrored in full; planes that do not face both antennas have none.
  std::vector<RimWaves> waves(const AntennaPair& antennas, double wavenumber) const;

 private:
  RimWaves waves_of(const std::vector<uint32_t>& patch, const Plane& plane, const AntennaPair& antennas,
                    double wavenumber) const;
  bool is_rim(uint32_t triangle, size_t side) const;

  std::vector<Vec3> vertices_;
  const std::vector<Triangle>& triangles_;
  std::vector<std::array<uint32_t, 3>> neighbours_;
  std::vector<std::vector<uint32_t>> patches_;
  std::vector<Plane> planes_;       // of the patches
  std::vector<uint32_t> patch_of_;  // [F]
  double outside_ = 0.0;            // 1 or -1: the side of closed bodies on which the normals are; 0: there is no inside
};

}  // namespace echopath
