#pragma once
// Estimates how well a sum over the scatterers of surfaces is known, from how many of them share a triangle.
#include <cstdint>
#include <vector>

#include "echopath/record/paths.h"

namespace echopath {

// Takes what scatterers that stay on their surfaces (Scatterers::kSurface) send back, triangle by triangle, and estimates
// the variance of the sum.
//
// Each triangle has even points of its own, so that n of equal power p err as a lattice does along an outline: by a variance
// of kOfEven sqrt(n) p^2. Where the power changes over a triangle, as on a ground about the radar, points are dense here and
// sparse there: those of powers within a factor of four stand for an even set each. Measured variances are .4 to .6 of
// sqrt(n) p^2 for crowns of trees, up to .93 for grounds, and below .15 for plates, balls and animals.
class TrianglePoints {
 public:
  // Adds a scatterer of some power, W. Those of a triangle come one after the other.
  void add(const Hit& hit, double power);
  // Returns the variance of the sum of all that was added, W^2.
  double variance() const;

 private:
  struct Level {
    int exponent = 0;  // of four
    double count = 0.0, squares = 0.0;
  };
  double of_triangle() const;

  uint32_t mesh_id_ = 0, triangle_id_ = 0;
  std::vector<Level> levels_;  // of the triangle
  double before_ = 0.0;        // of the triangles before
};

}  // namespace echopath
