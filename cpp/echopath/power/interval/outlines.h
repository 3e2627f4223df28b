#pragma once
// Estimates how well a sum over even directions is known of which neighbours are not known, from what the pieces of meshes
// send back.
#include <cstdint>
#include <map>
#include <vector>

#include "echopath/scene/scene.h"

namespace echopath {

// Numbers the pieces of the meshes of a scene, whose triangles hang together by edges: leaves of a crown, spokes of a wheel.
// The scene must outlive it.
class MeshPieces {
 public:
  explicit MeshPieces(const Scene& scene) : scene_(scene), found_(scene.meshes().size()) {}
  // Returns the number of the piece within its mesh.
  uint32_t of(uint32_t mesh_id, uint32_t triangle_id);

 private:
  const Scene& scene_;
  std::vector<std::vector<uint32_t>> found_;  // [mesh ID, triangle], of meshes asked for
};

// Takes what diffuse hits send back, and estimates the variance of the sum.
//
// Even directions err along the outline of each piece that they meet, so that n hits of equal power p have the variance
// n p^2 / (1 + (sqrt(n) - 1) / kOutline^2): that of a single hit, which chance finds, and kOutline^2 sqrt(n) p^2 of many.
class Outlines {
 public:
  // Adds a hit of some power, W.
  void add(uint32_t mesh_id, uint32_t piece, double power);
  // Returns the variance of the sum of all that was added, W^2.
  double variance() const;

 private:
  struct Sums {
    double power = 0.0, squares = 0.0;  // W, W^2
  };
  std::map<uint64_t, Sums> pieces_;
};

}  // namespace echopath
