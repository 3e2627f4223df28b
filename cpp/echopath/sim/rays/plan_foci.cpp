#include "echopath/sim/rays/plan_foci.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "echopath/base/constants.h"

namespace echopath {
namespace {

// A focus has a glint to itself up to so many Fresnel zones and so many cells of its stratum, whose second-order footprints
// reach that far and would count the glint once more.
constexpr double kZones = 2.0, kCells = 1.5;
constexpr double kWidest = 0.5;        // rad
constexpr double kFaintest = 1e-3;     // of the power of a stratum
constexpr size_t kMaxFoci = 12;        // in a stratum
constexpr double kLargestPart = 0.25;  // of the stratum's solid angle
constexpr double kLargestShare = 0.5;  // of the stratum's rays, for all its foci
constexpr double kMinGain = 1.5;       // of the density of rays in a focus, over that without it

// Describes a stratum of the trace to come.
struct StratumPlan {
  std::string name;
  double rays = 0.0;         // including those of its foci
  double solid_angle = 0.0;  // sr
  double cell = 0.0;         // rad, side of the stratum's own launch cells when foci have their rays
  KnownEcho echo;
  double of_glints = 0.0, of_foci = 0.0;  // W, powers of all glints added up, and of those in a focus
  double power() const { return std::max(echo.power, of_glints); }
  std::vector<LaunchFocus> foci;
};

// Returns the cone about a glint in which rays are to lie closer. Its share is relative to other foci of the stratum.
LaunchFocus focus_on(const Glint& glint, double power, const StratumPlan& plan) {
  LaunchFocus focus;
  focus.of = plan.name;
  focus.axis = glint.direction;
  focus.versine = versine_of(std::min((kZones * glint.wide + kCells * plan.cell) / kFocusCore, kWidest));
  // Zones narrower than the cells of all those rays together stay unresolved anyway.
  const double finest = kTwoPi * focus.versine / (kLargestShare * std::max(plan.rays, 1.0));
  focus.share = focus.versine / std::max(glint.narrow * glint.narrow, finest) * std::sqrt(power);
  return focus;
}

double radius_of(const LaunchFocus& focus) { return half_angle_of(focus.versine); }
double angle_between(const Vec3& a, const Vec3& b) { return 2.0 * std::asin(0.5 * (a - b).norm()); }

// Returns whether the glint in the middle of `other`, with its first zone, lies where `focus` fades.
bool cuts(const LaunchFocus& focus, const LaunchFocus& other) {
  return angle_between(focus.axis, other.axis) < radius_of(focus) + 0.5 * kFocusCore * radius_of(other);
}

// Returns the cone that holds both, with the closer rays of the two.
LaunchFocus around(const LaunchFocus& a, const LaunchFocus& b) {
  const double away = angle_between(a.axis, b.axis), first = radius_of(a), second = radius_of(b);
  LaunchFocus both = first >= second ? a : b;
  const double radius = std::max({first, second, 0.5 * (away + first + second)});
  if (radius > std::max(first, second)) {
    const double from_a = (radius - first) / away;
    both.axis = ((1.0 - from_a) * a.axis + from_a * b.axis).normalized();
  }
  both.versine = versine_of(radius);
  both.share = both.versine * std::max(a.share / a.versine, b.share / b.versine);
  return both;
}

// Adds a glint. One that another focus would cut shares a focus with it, if that is still small.
void add_glint(const Glint& glint, StratumPlan& plan) {
  // By stationary phase a surface that is smaller than its zone, or that focuses, would send more than there is.
  const double power = std::min(glint.power, plan.echo.high);
  plan.of_glints += power;
  const auto fits = [&](const LaunchFocus& focus) { return kTwoPi * focus.versine <= kLargestPart * plan.solid_angle; };
  const LaunchFocus focus = focus_on(glint, power, plan);
  if (!fits(focus) || !(power >= kFaintest * plan.power())) return;
  const auto shared = std::find_if(plan.foci.begin(), plan.foci.end(), [&](const LaunchFocus& other) {
    return cuts(other, focus) && fits(around(other, focus));
  });
  if (shared == plan.foci.end() && plan.foci.size() == kMaxFoci) return;
  plan.of_foci += power;
  if (shared == plan.foci.end()) plan.foci.push_back(focus);
  else *shared = around(*shared, focus);
}

// Shares rays among the foci and drops those whose rays would lie hardly closer than without them.
void give_rays(StratumPlan& plan) {
  const double part = std::sqrt(plan.of_foci / std::max(plan.power(), 1e-300));
  const double given = kLargestShare * std::min(1.0, part) * plan.rays, density = plan.rays / plan.solid_angle;
  double asked = 0.0;
  for (const LaunchFocus& focus : plan.foci) asked += focus.share;
  for (LaunchFocus& focus : plan.foci) focus.share *= given / asked;
  std::erase_if(plan.foci,
                [&](const LaunchFocus& focus) { return !(focus.share >= kMinGain * density * kTwoPi * focus.versine); });
}

}  // namespace

void set_foci(const TraceFrame& frame, const std::vector<KnownEcho>& echoes, const std::vector<Glint>& glints,
              LaunchGuide& guide) {
  std::vector<StratumPlan> plans(frame.strata.size());
  for (size_t k = 0; k < plans.size(); ++k) {
    const Stratum& stratum = frame.strata[k];
    if (stratum.is_focus()) continue;
    StratumPlan& plan = plans[k];
    plan.name = stratum.name;
    plan.rays = guide.shares.at(stratum.name);
    plan.solid_angle = stratum.solid_angle();
    const double of_each_batch = (1.0 - kLargestShare) * std::max(plan.rays, 1.0) / frame.num_batches;
    plan.cell = std::sqrt(plan.solid_angle / of_each_batch);
    plan.echo = echoes[k];
  }
  for (const Glint& glint : glints) add_glint(glint, plans[static_cast<size_t>(glint.stratum)]);
  for (StratumPlan& plan : plans) {
    if (plan.foci.empty()) continue;
    give_rays(plan);
    for (const LaunchFocus& focus : plan.foci) guide.shares.at(plan.name) -= focus.share;
    std::move(plan.foci.begin(), plan.foci.end(), std::back_inserter(guide.foci));
  }
}

}  // namespace echopath
