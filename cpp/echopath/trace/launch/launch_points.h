#pragma once
// Spreads the rays of one stratum over it, as a sampler says.
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "echopath/record/sampler.h"

namespace echopath {

// The points of a stratum lie in the unit disc, from which the equal-area projection of a cone makes directions, or in a
// rectangle of twice these half lengths about 0, from which that of a strip does.
struct LaunchDomain {
  Eigen::Vector2d half = Eigen::Vector2d::Zero();  // zero: the unit disc

  bool is_disc() const { return half[0] == 0.0; }
  double area() const;
};

// Holds points in a domain, uniform in area.
class LaunchPoints {
 public:
  virtual ~LaunchPoints() = default;
  virtual int64_t size() const = 0;
  virtual double cell_area() const = 0;                    // area for which one point stands
  virtual Eigen::Vector2d point(int64_t index) const = 0;  // index in [0, size())
  // Finds the coordinates [count] of points in a row.
  virtual void points(int64_t first, int64_t count, double* x, double* y) const {
    for (int64_t i = 0; i < count; ++i) {
      const Eigen::Vector2d one = point(first + i);
      x[i] = one[0];
      y[i] = one[1];
    }
  }
  virtual int batch_of(int64_t index) const = 0;  // index of its shift
};

// Returns exactly num_points points, in as many independent batches, one after the other, as there are shifts [2] in [0, 1).
// A shift moves its batch (lattice, R2: Cranley and Patterson 1976), turns it and moves it along the spiral (Fibonacci) or
// seeds it (random). Only the lattice serves rectangles too.
std::unique_ptr<const LaunchPoints> launch_points(Sampler sampler, const LaunchDomain& domain, int64_t num_points,
                                                  const std::vector<Eigen::Vector2d>& shifts);

}  // namespace echopath
