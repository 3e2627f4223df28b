#include "echopath/trace/launch/launch_focus.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/errors.h"

namespace echopath {

void LaunchGuide::validate() const {
  double sum = 0.0;
  for (const auto& [name, share] : shares) {
    require(std::isfinite(share) && share >= 0.0, "guide.shares", "must be finite and not negative", share);
    sum += share;
  }
  require(shares.empty() || sum > 0.0, "guide.shares", "must not all be zero", sum);
  require(foci.empty() || !shares.empty(), "guide.foci", "need the shares of the strata", foci.size());
  for (const LaunchFocus& focus : foci) {
    require(std::abs(focus.axis.norm() - 1.0) < 1e-9, "guide.foci", "must have axes of unit length", focus.axis.norm());
    require(focus.versine > 0.0 && focus.versine <= 2.0, "guide.foci", "must have versines in (0, 2]", focus.versine);
    require(std::isfinite(focus.share) && focus.share >= 0.0, "guide.foci", "must have finite shares", focus.share);
  }
}

double LaunchGuide::num_rays() const {
  double sum = 0.0;
  for (const auto& [name, share] : shares) sum += share;
  for (const LaunchFocus& focus : foci) sum += focus.share;
  return sum;
}

LaunchGuide guide_like(const std::vector<Stratum>& strata) {
  LaunchGuide guide;
  for (const Stratum& stratum : strata) {
    const auto rays = static_cast<double>(stratum.num_rays);
    if (!stratum.is_focus()) {
      guide.shares[stratum.name] = rays;
    } else {
      guide.foci.push_back({strata[stratum.focus_of].name, stratum.axis, stratum.versine, rays});
    }
  }
  return guide;
}

double focus_weight(const Stratum& focus, const Vec3& direction) {
  const double radius = std::sqrt(0.5 * (direction - focus.axis).squaredNorm() / focus.versine);
  const double x = std::clamp((1.0 - radius) / (1.0 - kFocusCore), 0.0, 1.0);
  return std::min(x * x * x * (10.0 + x * (6.0 * x - 15.0)), 1.0);  // rounding would leave others a part below zero
}

LaunchFoci::LaunchFoci(const std::vector<Stratum>& strata) {
  if (std::ranges::none_of(strata, [](const Stratum& stratum) { return stratum.is_focus(); })) return;
  foci_.resize(strata.size());
  for (size_t k = 0; k < strata.size(); ++k) {
    const Stratum& stratum = strata[k];
    owner_.push_back(stratum.is_focus() ? stratum.focus_of : static_cast<int>(k));
    if (!stratum.is_focus() || stratum.num_rays == 0) continue;
    const auto of = static_cast<size_t>(stratum.focus_of);
    foci_[of].push_back({static_cast<int>(k), stratum, strata[of].ray_density / stratum.ray_density});
  }
}

double LaunchFoci::rays_of_owner(int stratum, const Vec3& direction) const {
  if (!has_any(stratum)) return 1.0;
  double rest = 1.0;
  for (const Focus& focus : foci_[owner(stratum)]) {
    const double weight = focus_weight(focus.cone, direction);
    if (focus.stratum == stratum) return rest * weight * focus.spacing;
    rest *= 1.0 - weight;
  }
  return rest;
}

}  // namespace echopath
