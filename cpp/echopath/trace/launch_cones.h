#pragma once
// The cones of a launch plan, made ready to be asked for every ray: where its rays go, and how dense all rays are somewhere.
#include <vector>

#include "echopath/base/scalar_math.h"
#include "echopath/trace/packet.h"
#include "echopath/trace/paths.h"

namespace echopath {

// A cone as the equal-area (Lambert) projection of the unit disc.
class ConeFrame {
 public:
  explicit ConeFrame(const Stratum& stratum);
  // Unit, of a point of the disc. In a Lambert projection the versine is proportional to the squared radius: sine / radius =
  // sqrt(V (2 - versine)).
  ECHOPATH_INLINE VectorOf<double> direction(double x, double y) const {
    const double here = versine_ * ScalarMath::smaller(1.0, x * x + y * y);
    const double scale = ScalarMath::root(versine_ * (2.0 - here));
    const VectorOf<double> out = (1.0 - here) * axis_ + (scale * x) * first_ + (scale * y) * second_;
    return (1.0 / ScalarMath::root(dot(out, out))) * out;
  }

 private:
  VectorOf<double> axis_, first_, second_;
  double versine_;
};

// How dense its rays are.
struct LaunchCone {
  VectorOf<double> axis;
  double twice_versine, density;
  bool is_aimed;
  double part(double aimed_share) const { return is_aimed ? aimed_share * density : density; }
  // `part` where a direction is in the cone, else 0.
  ECHOPATH_INLINE double toward(const VectorOf<double>& direction, double part) const {
    const VectorOf<double> off = direction - axis;
    return dot(off, off) <= twice_versine ? part : 0.0;
  }
};

class LaunchCones {
 public:
  // The last one is the defensive stratum.
  explicit LaunchCones(const std::vector<Stratum>& strata);
  Vec3 direction(int stratum, const Eigen::Vector2d& point) const {
    return packed(frames_[static_cast<size_t>(stratum)].direction(point.x(), point.y()));
  }
  // Of rays of one packet and one stratum, in the given lanes: where they go, given their points of the disc, and rays per sr of
  // all strata together there, as `density_of_ray` has it.
  void launch(int stratum, const LaneValues& x, const LaneValues& y, LaneRange lanes, LaneVectors& directions,
              LaneValues& densities) const;
  // Expected rays per sr toward `direction`, of all strata together (balance heuristic). `aimed_share`: of the rays of the
  // cones that count.
  double density(const Vec3& direction, double aimed_share = 1.0) const;
  // Likewise toward a ray of the stratum `own`, which is counted in any case: a ray at the rim of its cone must not fall out of
  // it by rounding.
  double density_of_ray(const Vec3& direction, int own, double aimed_share = 1.0) const;

 private:
  std::vector<ConeFrame> frames_;
  std::vector<LaunchCone> cones_;
  std::vector<std::vector<int>> meeting_;  // of each cone: which others share a direction with it
};

}  // namespace echopath
