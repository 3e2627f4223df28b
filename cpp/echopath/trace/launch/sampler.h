#pragma once
// Says how the rays of one stratum are spread over it.
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

namespace echopath {

enum class Sampler {
  kLattice,    // shifted algebraic lattice (launch_lattice.h): even, and the same everywhere
  kFibonacci,  // spherical Fibonacci spiral about the cone's axis
  kR2,         // additive recurrence of the plastic number: any first part of it is even
  kRandom,     // independent uniform points, the yardstick for even sets
};

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

// Returns the standard deviation, in launch cells per axis, of the Gaussian that stands for one ray in the second-order
// footprint: the wider it is, the less the gaps between rays show; the narrower, the less is lost where the surface bends
// within a cell. The values are the best of a scan over spheres of ka 161 and 3228 and an ellipsoid of a car's size (2^10 to
// 2^16 rays): on the spheres the lattice errs by 0.3 dB at 0.4, 0.06 at 0.5, below 0.01 from 0.6 to 0.8; on the ellipsoid
// the loss at few rays grows with the square. R2 and random points have wide gaps for which no spread makes up.
double footprint_spread(Sampler sampler);

}  // namespace echopath
