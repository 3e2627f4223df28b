#include "echopath/trace/launch/launch_shares.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "echopath/trace/launch/rays_by_object.h"

namespace echopath {
namespace {

constexpr double kFieldShare = 0.15;
constexpr double kMovingShare = 0.5;  // of the rays that are aimed, at least

// Returns the shares of the strata in the order of the plan.
std::vector<double> named_shares(const std::vector<RayTarget>& targets, const std::vector<FocusOfTarget>& foci,
                                 const std::string& field, const RayShares& shares) {
  double mean = 0.0;
  for (const auto& [name, share] : shares) mean += share / static_cast<double>(shares.size());
  const auto share_of = [&](const std::string& name) {
    const auto found = shares.find(name);
    return found == shares.end() ? mean : found->second;
  };
  std::vector<double> out;
  for (const RayTarget& target : targets) out.push_back(share_of(target.stratum.name));
  for (const FocusOfTarget& focus : foci) out.push_back(focus.asked->share);
  out.push_back(share_of(field));
  return out;
}

// Returns the rays of the strata in the order of the plan. What the guide does not name, as where there were too many
// objects for its own trace to aim at, gets its mean at most: what stands still out of the rays of the field of view, which
// met it there, and what moves out of those that the guide leaves of `num_rays`.
std::vector<double> named_rays(const std::vector<RayTarget>& targets, const std::vector<FocusOfTarget>& foci,
                               const std::string& field, const LaunchGuide& guide, double num_rays) {
  double of_strata = 0.0, num_still = 0.0, num_moving = 0.0;  // the latter of those that it does not name
  for (const auto& [name, rays] : guide.shares) of_strata += rays;
  const double mean = of_strata / static_cast<double>(guide.shares.size());
  for (const RayTarget& target : targets)
    if (!guide.shares.contains(target.stratum.name)) ++(target.moves ? num_moving : num_still);
  const auto found = guide.shares.find(field);
  double of_field = found == guide.shares.end() ? 0.0 : found->second;
  const double to_still = std::min(mean, of_field > 0.0 ? of_field / (1.0 + num_still) : mean / num_still);
  const double to_moving = std::min(mean, std::max(mean, num_rays - guide.num_rays()) / num_moving);
  std::vector<double> out;
  for (const RayTarget& target : targets) {
    const auto known = guide.shares.find(target.stratum.name);
    out.push_back(known != guide.shares.end() ? known->second : target.moves ? to_moving : to_still);
  }
  for (const FocusOfTarget& focus : foci) out.push_back(focus.asked->share);
  if (of_field > 0.0) of_field -= num_still * to_still;
  out.push_back(of_field);
  return out;
}

// Returns whole rays, which add up; a share that is too small for a stratum falls to the last one.
std::vector<int64_t> whole_rays(const std::vector<double>& shares, int64_t num_rays) {
  double all = 0.0, before = 0.0;
  for (const double share : shares) all += share;
  std::vector<int64_t> rays;
  int64_t done = 0, given = 0;
  for (size_t k = 0; k + 1 < shares.size(); ++k) {
    before += shares[k];
    const auto end = static_cast<int64_t>(std::llround(before / all * static_cast<double>(num_rays)));
    const int64_t here = end - done >= LaunchPlan::kFewestRays ? end - done : 0;
    done = end;
    given += here;
    rays.push_back(here);
  }
  rays.push_back(num_rays - given);
  return rays;
}

// Returns whole rays, each number rounded by itself. What is too little for a stratum falls to the last one where that would
// have none.
std::vector<int64_t> rounded_one_by_one(const std::vector<double>& rays) {
  std::vector<int64_t> whole;
  double dropped = 0.0;
  for (size_t k = 0; k + 1 < rays.size(); ++k) {
    const int64_t here = std::llround(rays[k]);
    const bool is_enough = here >= LaunchPlan::kFewestRays;
    whole.push_back(is_enough ? here : 0);
    if (!is_enough) dropped += rays[k];
  }
  const int64_t of_last = std::llround(rays.back());
  whole.push_back(of_last == 0 && dropped > 0.0 ? std::max<int64_t>(1, std::llround(dropped)) : of_last);
  return whole;
}

// Gives what is missing from num_rays, or takes what is too much, to the target that has the most rays of those that move,
// which have others in every frame anyway, or of all where they may be still.
void add_remainder(const std::vector<RayTarget>& targets, bool may_be_still, int64_t num_rays, std::vector<int64_t>& rays) {
  size_t most = targets.size();
  for (size_t k = 0; k < targets.size(); ++k) {
    const bool may_serve = may_be_still || targets[k].moves;
    if (may_serve && (most == targets.size() || rays[k] > rays[most])) most = k;
  }
  if (most == targets.size()) return;
  const int64_t missing = num_rays - std::accumulate(rays.begin(), rays.end(), int64_t{0});
  if (rays[most] + missing >= LaunchPlan::kFewestRays) rays[most] += missing;
}

std::vector<double> mean_densities(const std::vector<Stratum>& strata) {
  std::vector<double> densities;
  for (const Stratum& one : strata) densities.push_back(static_cast<double>(one.num_rays) / one.solid_angle());
  return densities;
}

}  // namespace

LaunchShares::LaunchShares(const Scene& scene, const RayTargets& found, const FieldOwns& field,
                           const LaunchSettings& settings)
    : scene_(scene), found_(found), field_(field), settings_(settings) {
  for (const RayTarget& target : found.targets) (target.moves ? moving_ : still_) += target.weight;
}

// Returns the share of the field of view. A steady one is the same while nothing is there that rays are aimed at.
double LaunchShares::field_share() const {
  const bool aims_at_any = settings_.is_steady ? found_.num_objects > 0 : !found_.targets.empty();
  if (!aims_at_any) return 1.0;
  return field_.any ? kFieldShare : 0.0;
}

// Returns the share of what moves, of the rays that are aimed.
double LaunchShares::moving_share() const {
  if (still_ == 0.0) return 1.0;
  if (settings_.is_steady) return kMovingShare;
  return moving_ == 0.0 ? 0.0 : std::max(moving_ / (moving_ + still_), kMovingShare);
}

// Returns the shares of the targets and the field of view by the rule. Steady shares leave that of what moves where none of
// it is there, and what moves alone gives up that of a field of view which owns nothing that stands still.
std::vector<double> LaunchShares::of_rule() const {
  const double aimed = 1.0 - field_share(), of_moving = moving_share();
  const bool is_field_of_moving = settings_.is_steady && !field_.still;
  const double to_still = is_field_of_moving ? 1.0 : aimed;  // of which what moves leaves a part
  const double to_moving = is_field_of_moving ? (aimed - 1.0 + of_moving) / of_moving : aimed;
  std::vector<double> shares;
  for (const RayTarget& target : found_.targets) {
    const double by_weight = target.moves ? of_moving / moving_ : (1.0 - of_moving) / still_;
    shares.push_back((target.moves ? to_moving : to_still) * by_weight * target.weight);
  }
  shares.push_back(1.0 - aimed);
  return shares;
}

std::vector<int64_t> LaunchShares::rays(const std::vector<FocusOfTarget>& foci, const std::string& field) const {
  if (is_by_object()) return rays_by_object(scene_, found_.targets, field_.any, kFieldShare, settings_.num_rays);
  const auto all = static_cast<double>(settings_.num_rays);
  if (!settings_.by_name) {
    return whole_rays(is_guided() ? named_shares(found_.targets, foci, field, settings_.guide.shares) : of_rule(),
                      settings_.num_rays);
  }
  if (is_guided()) return rounded_one_by_one(named_rays(found_.targets, foci, field, settings_.guide, all));
  std::vector<double> shares = of_rule();
  std::ranges::for_each(shares, [&](double& share) { share *= all; });
  std::vector<int64_t> rays = rounded_one_by_one(shares);
  add_remainder(found_.targets, !settings_.is_steady, settings_.num_rays, rays);
  return rays;
}

// Returns the rays of what stands still where they are steady: the same in all frames, whatever others there are.
double LaunchShares::rays_of_still(const std::vector<Stratum>& strata) const {
  const auto stands = [&](size_t k) { return k < found_.targets.size() ? !found_.targets[k].moves : field_.still; };
  double sum = 0.0;
  for (size_t k = 0; settings_.is_steady && k < strata.size(); ++k) {
    const size_t owner = strata[k].is_focus() ? static_cast<size_t>(strata[k].focus_of) : k;
    if (stands(owner)) sum += static_cast<double>(strata[k].num_rays);
  }
  return sum;
}

std::vector<double> LaunchShares::default_densities(const std::vector<Stratum>& strata) const {
  if (is_by_object()) return mean_densities(strata);
  const std::vector<double> shares = of_rule();
  const auto all = static_cast<double>(settings_.num_rays);
  const double own = rays_of_still(strata), for_still = own > 0.0 ? own / (1.0 - kMovingShare) : all;
  std::vector<double> densities(strata.size(), 0.0);
  const auto set = [&](size_t stratum, double rays) { densities[stratum] = rays / strata[stratum].solid_angle(); };
  for (size_t k = 0; k < found_.targets.size(); ++k) set(k, shares[k] * (found_.targets[k].moves ? all : for_still));
  set(strata.size() - 1, shares.back() * for_still);
  return densities;
}

}  // namespace echopath
