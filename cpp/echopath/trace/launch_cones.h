#pragma once
// The cones of a launch plan, made ready to be asked for every ray: where its rays go, and how dense all rays are somewhere.
#include <vector>

#include "echopath/trace/paths.h"

namespace echopath {

// A cone as the equal-area (Lambert) projection of the unit disc.
class ConeFrame {
 public:
  explicit ConeFrame(const Stratum& stratum);
  Vec3 direction(const Eigen::Vector2d& point) const;  // unit

 private:
  Vec3 axis_, first_, second_;
  double versine_;
};

class LaunchCones {
 public:
  // The last one is the defensive stratum.
  explicit LaunchCones(const std::vector<Stratum>& strata);
  Vec3 direction(int stratum, const Eigen::Vector2d& point) const { return frames_[static_cast<size_t>(stratum)].direction(point); }
  // Expected rays per sr toward `direction`, of all strata together (balance heuristic). `aimed_share`: of the rays of the
  // cones that count.
  double density(const Vec3& direction, double aimed_share = 1.0) const;
  // Likewise toward a ray of the stratum `own`, which is counted in any case: a ray at the rim of its cone must not fall out of
  // it by rounding.
  double density_of_ray(const Vec3& direction, int own, double aimed_share = 1.0) const;

 private:
  struct Cone {
    Vec3 axis;
    double twice_versine, density;
    bool is_aimed;
    double part(double aimed_share) const { return is_aimed ? aimed_share * density : density; }
    double part_toward(const Vec3& direction, double aimed_share) const {
      return (direction - axis).squaredNorm() <= twice_versine ? part(aimed_share) : 0.0;
    }
  };
  std::vector<ConeFrame> frames_;
  std::vector<Cone> cones_;
  std::vector<std::vector<int>> meeting_;  // of each cone: which others share a direction with it
};

}  // namespace echopath
