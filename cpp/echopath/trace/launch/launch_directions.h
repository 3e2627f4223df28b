#pragma once
// Turns the points of a lattice into directions of the strata of a launch plan.
#include <vector>

#include "echopath/base/lanes/phasor.h"
#include "echopath/base/lanes/scalar_math.h"
#include "echopath/record/stratum.h"
#include "echopath/trace/embree/packet.h"
#include "echopath/trace/launch/launch_points.h"

namespace echopath {

// Maps a cone by the equal-area (Lambert) projection of the unit disc, or a strip by that of Archimedes' cylinder: x is the
// azimuth along the great circle in rad, y the sine of the elevation over the middle of the strip.
class StratumFrame {
 public:
  explicit StratumFrame(const Stratum& stratum);
  bool is_strip() const { return is_strip_; }
  // Returns a unit vector. In a Lambert projection the versine is proportional to the squared radius: sine / radius = sqrt(V
  // (2 - versine)).
  ECHOPATH_INLINE VectorOf<double> in_cone(double x, double y) const {
    const double here = size_ * ScalarMath::smaller(1.0, x * x + y * y);
    const double scale = ScalarMath::root(size_ * (2.0 - here));
    return unit((1.0 - here) * axis_ + (scale * x) * first_ + (scale * y) * second_);
  }
  ECHOPATH_INLINE VectorOf<double> in_strip(double x, double y) const {
    const double height = size_ + y, level = ScalarMath::root(1.0 - height * height);
    const Phasor turn = phasor_of_cycles(kPerTurn * x);
    return unit((level * turn.re) * axis_ + (level * turn.im) * first_ + height * second_);
  }

 private:
  static constexpr double kPerTurn = 0.15915494309189535;  // 1 / (2 pi)
  ECHOPATH_INLINE static VectorOf<double> unit(const VectorOf<double>& out) {
    return (1.0 / ScalarMath::root(dot(out, out))) * out;
  }

  VectorOf<double> axis_, first_, second_;
  double size_;  // versine of the cone; sine of the elevation of the strip's middle
  bool is_strip_;
};

// Returns the domain in which the points of a stratum's lattice lie.
LaunchDomain domain_of(const Stratum& stratum);

class LaunchDirections {
 public:
  explicit LaunchDirections(const std::vector<Stratum>& strata) : frames_(strata.begin(), strata.end()) {}
  // Returns the unit direction of a point of the stratum's lattice.
  Vec3 direction(int stratum, const Eigen::Vector2d& point) const;
  // Finds the directions of rays of one packet and one stratum, in the given lanes.
  void launch(int stratum, const LaneValues& x, const LaneValues& y, LaneRange lanes, LaneVectors& directions) const;

 private:
  std::vector<StratumFrame> frames_;
};

}  // namespace echopath
