#include "echopath/sim/ray_allocation.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "echopath/base/constants.h"
#include "echopath/replay/received_power.h"
#include "echopath/sim/find_glints.h"
#include "echopath/signal/noise.h"
#include "echopath/trace/aim.h"

namespace echopath {
namespace {

constexpr double kDynamicRange = 1e-6;  // of the strongest echo
constexpr double kLeastGrowth = 1.0 / 16.0;
constexpr double kUnseenGrowth = 0.25;  // of strata that send nothing back
constexpr double kMovingTarget = 0.25;  // of the target: what moves is what a radar looks for
constexpr double kImageWeight = 0.5;    // beside that of the aim
constexpr double kServedFirst = 0.75;   // of the rays
constexpr int64_t kPilotDivisor = 8;
constexpr double kMiss = 0.5;           // cells of the pilot, by which a glint may be elsewhere
constexpr double kZones = 2.0;          // of a glint, up to which its focus has it alone
constexpr double kWidestFocus = 0.5;    // rad
constexpr double kLeastGain = 1.5;      // of a focus over the density of rays without it
constexpr double kFaintest = 1e-3;      // of the strongest glint of a stratum
constexpr size_t kMostFoci = 12;        // in a stratum
constexpr double kLargestPart = 0.25;   // of the stratum's solid angle
constexpr double kFocusShare = 0.5;     // of its rays

constexpr int64_t kFewestPilotRays = 2048;

// Of the echoes of each, with its foci.
std::vector<ReceivedPower> power_of_strata(const Paths& paths, Job* job) {
  const size_t num_strata = paths.frame.strata.size();
  std::vector<uint32_t> group(paths.stratum.size());
  std::transform(paths.stratum.begin(), paths.stratum.end(), group.begin(), [&](uint16_t stratum) {
    if (stratum >= num_strata) return static_cast<uint32_t>(num_strata);
    const Stratum& of = paths.frame.strata[stratum];
    return static_cast<uint32_t>(of.is_focus() ? of.focus_of : stratum);
  });
  return received_powers(paths, Sorting{group, num_strata + 1}, job);
}

double strongest_of(const std::vector<ReceivedPower>& powers) {
  double strongest = 0.0;
  for (const ReceivedPower& power : powers) strongest = std::max(strongest, power.power);
  return strongest;
}

// Half the interval relative to the power, in dB; what lies below the floor counts as if it were as strong as that.
double missing_db(const ReceivedPower& power, double least) {
  const double level = std::max(power.power, least), half = std::max(power.high - power.power, power.power - power.low);
  return level > 0 ? 10.0 * std::log10(1.0 + half / level) : 0.0;
}

// By node: whether something below it moves.
std::vector<bool> moving_objects(const Scene& scene) {
  std::vector<bool> moves(scene.nodes().size());
  for (uint32_t mesh = 0; mesh < scene.meshes().size(); ++mesh) {
    if (scene.is_moving(mesh)) moves[static_cast<size_t>(scene.meshes()[mesh].object)] = true;
  }
  return moves;
}

RayNeed need_of(const Stratum& stratum, double num_rays, const ReceivedPower& power, double missing, double target_db) {
  RayNeed need;
  need.stratum = stratum.name;
  need.power = power.power;
  need.weight = weight_of_aim(stratum.num_mirrors) * (stratum.num_mirrors > 0 ? kImageWeight : 1.0);
  double growth = power.high > 0 ? std::clamp(missing / target_db, kLeastGrowth, kMostGrowth) : kUnseenGrowth;
  // The field of view sees many surfaces, of which the strongest would speak for all: it keeps what it has.
  if (stratum.object < 0) growth = 1.0;
  need.is_bounded = growth < kMostGrowth;
  need.rays = growth * num_rays;
  return need;
}

}  // namespace

double RayNeeds::num_rays() const {
  double sum = 0.0;
  for (const RayNeed& need : strata) sum += need.rays;
  return sum;
}

RayNeeds ray_needs(const Paths& paths, double target_db, EchoFloor floor, Job* job) {
  const std::vector<ReceivedPower> powers = power_of_strata(paths, job);
  const double least = floor == EchoFloor::kNoise ? noise_power_in_cell(paths.radar) : kDynamicRange * strongest_of(powers);
  const std::vector<bool> moves = moving_objects(*paths.scene);
  const RayShares launched = shares_of(paths.frame.strata);
  RayNeeds needs;
  for (size_t k = 0; k < paths.frame.strata.size(); ++k) {
    const Stratum& stratum = paths.frame.strata[k];
    if (stratum.is_focus()) continue;
    const double missing = missing_db(powers[k], least);
    const bool is_moving = stratum.object >= 0 && moves[static_cast<size_t>(stratum.object)];
    needs.strata.push_back(need_of(stratum, launched.at(stratum.name), powers[k], missing, is_moving ? kMovingTarget * target_db : target_db));
    if (powers[k].high > least) needs.worst_db = std::max(needs.worst_db, missing);
  }
  return needs;
}

RayShares share_out(const RayNeeds& needs, double num_rays) {
  double bounded = 0.0, others = 0.0;
  for (const RayNeed& need : needs.strata) (need.is_bounded ? bounded : others) += need.is_bounded ? need.rays : need.weight;
  const bool is_scarce = needs.num_rays() > num_rays && others > 0;
  const double to_bounded = std::min(bounded, kServedFirst * num_rays);
  const double of_bounded = is_scarce && bounded > 0 ? to_bounded / bounded : 1.0;
  RayShares shares;
  for (const RayNeed& need : needs.strata) {
    const bool shares_rest = is_scarce && !need.is_bounded;
    shares[need.stratum] = shares_rest ? need.weight * (num_rays - to_bounded) / others : need.rays * of_bounded;
  }
  return shares;
}

namespace {

// Rays of a trace to come and what their echoes are like.
struct StratumPlan {
  double rays = 0.0;         // with those of its foci
  double solid_angle = 0.0;  // sr
  double power = 0.0;        // W, of its echo, as far as it is known
  double of_glints = 0.0, of_foci = 0.0;  // W, of glints one by one
  std::vector<LaunchFocus> foci;
};

// The cone about a glint in which rays are to lie closer. It asks for rays by its zones; the fainter it is, the less its own
// error counts.
LaunchFocus focus_on(const Glint& glint) {
  LaunchFocus focus;
  focus.of = glint.of;
  focus.axis = glint.direction;
  const double radius = (kMiss * glint.cell + kZones * glint.wide) / kFocusCore;
  focus.versine = 1.0 - std::cos(std::min(radius, kWidestFocus));
  focus.share = focus.versine / (glint.narrow * glint.narrow) * std::sqrt(glint.power);
  return focus;
}

double radius_of(const LaunchFocus& focus) { return std::acos(1.0 - focus.versine); }
double angle_between(const Vec3& a, const Vec3& b) { return 2.0 * std::asin(0.5 * (a - b).norm()); }

// Whether the glint in the middle of `other` lies where `focus` fades, with its first zone.
bool cuts(const LaunchFocus& focus, const LaunchFocus& other) {
  return angle_between(focus.axis, other.axis) < radius_of(focus) + 0.5 * kFocusCore * radius_of(other);
}

// The cone that holds both, with the closer rays of the two.
LaunchFocus around(const LaunchFocus& a, const LaunchFocus& b) {
  const double away = angle_between(a.axis, b.axis), first = radius_of(a), second = radius_of(b);
  LaunchFocus both = first >= second ? a : b;
  const double radius = std::max({first, second, 0.5 * (away + first + second)});
  if (radius > std::max(first, second)) {
    const double from_a = (radius - first) / away;
    both.axis = ((1.0 - from_a) * a.axis + from_a * b.axis).normalized();
  }
  both.versine = 1.0 - std::cos(radius);
  both.share = both.versine * std::max(a.share / a.versine, b.share / b.versine);
  return both;
}

// Glints come strongest first. One that another focus would cut shares one with it, if that is still small.
void add_glint(const Glint& glint, StratumPlan& plan) {
  plan.of_glints += glint.power;
  if (glint.power < kFaintest * std::max(plan.power, plan.of_glints)) return;
  const auto fits = [&](const LaunchFocus& focus) { return kTwoPi * focus.versine <= kLargestPart * plan.solid_angle; };
  const LaunchFocus focus = focus_on(glint);
  if (!fits(focus)) return;
  for (LaunchFocus& other : plan.foci) {
    const LaunchFocus both = around(other, focus);
    if (!cuts(other, focus) || !fits(both)) continue;
    other = both;
    plan.of_foci += glint.power;
    return;
  }
  if (plan.foci.size() == kMostFoci) return;
  plan.of_foci += glint.power;
  plan.foci.push_back(focus);
}

// Rays for the foci of a stratum, by their part of its field; none for those that would have them hardly closer than without.
void give_rays(StratumPlan& plan) {
  const double part = std::sqrt(plan.of_foci / std::max({plan.power, plan.of_glints, 1e-300}));
  const double given = kFocusShare * std::min(1.0, part) * plan.rays;
  double asked = 0.0;
  for (const LaunchFocus& focus : plan.foci) asked += focus.share;
  for (LaunchFocus& focus : plan.foci) focus.share *= given / asked;
  const double density = plan.rays / plan.solid_angle;
  std::erase_if(plan.foci, [&](const LaunchFocus& focus) { return focus.share < kLeastGain * density * kTwoPi * focus.versine; });
}

}  // namespace

LaunchGuide guide_rays(const Paths& paths, const RayNeeds& needs, int64_t num_rays, Job* job) {
  LaunchGuide guide;
  guide.shares = share_out(needs, static_cast<double>(num_rays));
  double all = 0.0;
  for (const auto& [name, share] : guide.shares) all += share;
  for (auto& [name, share] : guide.shares) share *= static_cast<double>(num_rays) / all;
  std::map<std::string, StratumPlan> plans;
  for (const Stratum& stratum : paths.frame.strata) {
    if (!stratum.is_focus()) plans[stratum.name] = {guide.shares.at(stratum.name), stratum.solid_angle(), 0.0, 0.0, 0.0, {}};
  }
  for (const RayNeed& need : needs.strata) plans.at(need.stratum).power = need.power;
  for (const Glint& glint : find_glints(paths, job)) add_glint(glint, plans.at(glint.of));
  for (auto& [name, plan] : plans) {
    give_rays(plan);
    for (const LaunchFocus& focus : plan.foci) guide.shares.at(name) -= focus.share;
    std::move(plan.foci.begin(), plan.foci.end(), std::back_inserter(guide.foci));
  }
  return guide;
}

Paths trace_by_need(const Scene& scene, const Radar& radar, const TraceSettings& settings, Job* job, KeptGeometry* kept) {
  TraceSettings launch = settings;
  launch.num_rays = settings.num_rays / kPilotDivisor;
  if (!settings.guide.shares.empty() || launch.num_rays < kFewestPilotRays) return trace(scene, radar, settings, job, kept);
  KeptGeometry own;
  if (!kept) kept = &own;
  Job unseen(job);  // its progress is that of the trace
  const Paths pilot = trace(scene, radar, launch, &unseen, kept);
  const auto num_launched = std::count_if(pilot.frame.strata.begin(), pilot.frame.strata.end(),
                                          [](const Stratum& stratum) { return stratum.num_rays > 0; });
  if (num_launched < 2) return trace(scene, radar, settings, job, kept);
  launch.num_rays = settings.num_rays;
  launch.guide = guide_rays(pilot, ray_needs(pilot, kResolvedDb, EchoFloor::kNoise, &unseen), settings.num_rays, &unseen);
  return trace(scene, radar, launch, job, kept);
}

}  // namespace echopath
