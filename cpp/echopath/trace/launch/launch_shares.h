#pragma once
// Shares the rays of a launch out among its strata.
#include <cstdint>
#include <string>
#include <vector>

#include "echopath/scene/scene.h"
#include "echopath/trace/launch/launch.h"
#include "echopath/trace/strata/ray_targets.h"

namespace echopath {

// Names a focus and the target that it is in; where `of` is the number of targets, it is in the field of view.
struct FocusOfTarget {
  const LaunchFocus* asked;
  size_t of;
};

// Says whether the field of view owns any echoes, and any of what stands still.
struct FieldOwns {
  bool any = false, still = false;
};

// Follows the rule of LaunchPlan, that of rays_by_object, or a guide. All arguments must outlive it.
class LaunchShares {
 public:
  LaunchShares(const Scene& scene, const RayTargets& found, const FieldOwns& field, const LaunchSettings& settings);

  // Returns the rays of the strata in the order of the plan: targets, foci, and the field of view, which has this name.
  std::vector<int64_t> rays(const std::vector<FocusOfTarget>& foci, const std::string& field) const;
  // Returns LaunchPlan::default_density of the strata of the plan; foci have none.
  std::vector<double> default_densities(const std::vector<Stratum>& strata) const;

 private:
  bool is_guided() const { return !settings_.guide.shares.empty(); }
  bool is_by_object() const { return settings_.by_object && !is_guided(); }
  double field_share() const;
  double moving_share() const;
  std::vector<double> of_rule() const;
  double rays_of_still(const std::vector<Stratum>& strata) const;

  const Scene& scene_;
  const RayTargets& found_;
  FieldOwns field_;
  const LaunchSettings& settings_;
  double moving_ = 0.0, still_ = 0.0;  // weights of the targets
};

}  // namespace echopath
