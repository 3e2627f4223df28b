#pragma once
// Sets foci into strata: cones in which rays lie closer, because the stratum's own rays are too far apart there.
#include <string>
#include <vector>

#include "echopath/record/stratum.h"

namespace echopath {

// Asks for a cone. `share` is that of the rays, in the units of RayShares.
struct LaunchFocus {
  std::string of;  // name of the stratum that it is a part of
  Vec3 axis = Vec3::UnitX();
  double versine = 0.0;
  double share = 0.0;
};

// Says how to launch rays: RayShares of the strata and the foci inside them.
struct LaunchGuide {
  RayShares shares;
  std::vector<LaunchFocus> foci;

  // Raises invalid_argument naming the field, the rule and the value.
  void validate() const;
  double num_rays() const;  // the sum of all shares, where these count rays
};

// Returns the guide that repeats a plan that was carried out.
LaunchGuide guide_like(const std::vector<Stratum>& strata);

// Returns how much of a direction belongs to a focus: 1 up to kFocusCore of its radius, and from there on smoothly (with two
// continuous derivatives) down to 0 at its rim. An edge there would cut the surface, and radiate.
double focus_weight(const Stratum& focus, const Vec3& direction);
inline constexpr double kFocusCore = 0.6;

// Holds the foci of a launch plan. A direction belongs in parts that add up to one to its owner (the stratum in which the
// foci are) and to the foci: to the first focus with its weight w1, to the second with (1 - w1) w2, and so on, and to the
// owner with the rest. Each is an even lattice, and a ray of it counts with its part of the direction, so that together they
// are as unbiased as the owner would be alone.
class LaunchFoci {
 public:
  LaunchFoci() = default;
  explicit LaunchFoci(const std::vector<Stratum>& strata);
  // Returns the stratum whose echoes the rays of a stratum count; for a focus this is its owner.
  int owner(int stratum) const { return owner_.empty() ? stratum : owner_[stratum]; }
  // Returns how many rays of its owner one ray of this stratum stands for in that direction; it is 1 where there are no
  // foci.
  double rays_of_owner(int stratum, const Vec3& direction) const;
  bool has_any(int stratum) const { return !owner_.empty() && !foci_[owner(stratum)].empty(); }

 private:
  struct Focus {
    int stratum;
    Stratum cone;
    double spacing;  // density of the owner over its own
  };
  std::vector<int> owner_;                // [strata]; empty: no stratum has foci
  std::vector<std::vector<Focus>> foci_;  // by owner
};

}  // namespace echopath
