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
// Glints behind several bounces send little, but in phase or out of it with all the rest, so that they get what resolves
// them before the power would earn it them.
constexpr double kChainShare = 0.25;  // of the stratum's rays, at most
constexpr double kCellsInZone = 1.5;  // of a focus, in the half width of a Fresnel zone, which resolve it
// Where a focus fades the cells of its stratum count in part. The phase of another glint may turn by so many cycles within
// one of them, beyond which its footprint would leave the rest of that glint out.
constexpr double kCyclesInCell = 0.1;

// Describes a glint behind several bounces with the focus that it needs, whose share is in rays.
struct ChainFocus {
  LaunchFocus focus;
  double power = 0.0;  // W

  double field_per_ray() const { return std::sqrt(power) / focus.share; }
};

// Describes a glint of one bounce with the focus that would have it to itself.
struct SingleGlint {
  LaunchFocus focus;
  double power = 0.0;   // W
  double narrow = 0.0;  // rad, half width of the Fresnel zone
};

// Describes a stratum of the trace to come.
struct StratumPlan {
  std::string name;
  double rays = 0.0;  // including those of its foci
  int num_batches = 1;
  double solid_angle = 0.0;  // sr
  double cell = 0.0;         // rad, side of the stratum's own launch cells when foci have their rays
  KnownEcho echo;
  double of_glints = 0.0, of_foci = 0.0;  // W, powers of all glints added up, and of those in a focus
  double power() const { return std::max(echo.power, of_glints); }
  std::vector<LaunchFocus> foci;
  std::vector<SingleGlint> singles;  // all that are not faint, with foci or without
  std::vector<ChainFocus> chains;
};

double size_of(const LaunchFocus& focus) { return kTwoPi * focus.versine; }  // sr

// Returns the cone about a glint in which rays are to lie closer. Its share is relative to other foci of the stratum.
LaunchFocus focus_on(const Glint& glint, double power, const StratumPlan& plan) {
  LaunchFocus focus;
  focus.of = plan.name;
  focus.axis = glint.direction;
  focus.versine = versine_of(std::min((kZones * glint.wide + kCells * plan.cell + glint.blur) / kFocusCore, kWidest));
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
  if (!(power >= kFaintest * plan.power())) return;
  plan.singles.push_back({focus, power, glint.narrow});
  if (!fits(focus)) return;
  const auto shared = std::ranges::find_if(
      plan.foci, [&](const LaunchFocus& other) { return cuts(other, focus) && fits(around(other, focus)); });
  if (shared == plan.foci.end() && plan.foci.size() == kMaxFoci) return;
  plan.of_foci += power;
  if (shared == plan.foci.end()) plan.foci.push_back(focus);
  else *shared = around(*shared, focus);
}

void add_chain(const Glint& glint, StratumPlan& plan) {
  LaunchFocus focus = focus_on(glint, glint.power, plan);
  const double cell = glint.narrow / kCellsInZone;
  focus.share = size_of(focus) * plan.num_batches / (cell * cell);
  plan.chains.push_back({focus, std::min(glint.power, plan.echo.high)});
}

// Returns whether a focus would fade where a stronger glint of one bounce, which has none, turns its phase within the cells
// of the stratum: the parts on both sides would no longer add up to that glint.
bool would_cut_stronger(const ChainFocus& chain, const StratumPlan& plan) {
  const double reach = radius_of(chain.focus) * plan.cell;
  return std::ranges::any_of(plan.singles, [&](const SingleGlint& single) {
    return single.power > chain.power && reach > kCyclesInCell * single.narrow * single.narrow &&
           cuts(chain.focus, single.focus);
  });
}

// Sets a focus about a glint behind several bounces with the rays that it needs, or with those that are `left` of those for
// such glints, unless they would lie hardly closer than without it. One that another focus would cut shares a focus with it,
// if that is still small and has rays as close as before. Returns the rays that it takes.
double serve_chain(const ChainFocus& chain, double left, StratumPlan& plan) {
  const LaunchFocus& wanted = chain.focus;
  const auto fits = [&](const LaunchFocus& focus) { return size_of(focus) <= kLargestPart * plan.solid_angle; };
  const auto shared = std::ranges::find_if(plan.foci, [&](const LaunchFocus& other) { return cuts(other, wanted); });
  const bool is_new = shared == plan.foci.end();
  if (is_new && would_cut_stronger(chain, plan)) return 0.0;
  LaunchFocus focus = is_new ? wanted : around(*shared, wanted);
  if (!fits(focus) || (is_new && plan.foci.size() == kMaxFoci)) return 0.0;
  const double before = is_new ? 0.0 : shared->share;
  focus.share = std::min(focus.share, before + left);
  const double least = is_new ? kMinGain * plan.rays / plan.solid_angle : shared->share / size_of(*shared);  // rays per sr
  if (!(focus.share > least * size_of(focus))) return 0.0;
  if (is_new) plan.foci.push_back(focus);
  else *shared = focus;
  return focus.share - before;
}

// Serves those first that make most of the field known for a ray.
void serve_chains(StratumPlan& plan) {
  std::ranges::stable_sort(plan.chains,
                           [](const ChainFocus& a, const ChainFocus& b) { return a.field_per_ray() > b.field_per_ray(); });
  double left = kChainShare * plan.rays;
  for (const ChainFocus& chain : plan.chains) {
    if (chain.power >= kFaintest * plan.power()) left -= serve_chain(chain, left, plan);
  }
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

double rounded_rays(double rays, double up) {
  constexpr double kSteps = 64.0;  // of the mantissa, which is 1/2 to 1
  int exponent = 0;
  const double mantissa = std::frexp(rays, &exponent);
  return std::ldexp(std::floor(kSteps * mantissa + up) / kSteps, exponent);
}

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
    const double of_each_batch = (1.0 - kLargestShare) * std::max(plan.rays, 1.0) / frame.batches;
    plan.cell = std::sqrt(plan.solid_angle / of_each_batch);
    plan.num_batches = frame.batches;
    plan.echo = echoes[k];
  }
  for (const Glint& glint : glints) {
    StratumPlan& plan = plans[glint.stratum];
    glint.is_chain ? add_chain(glint, plan) : add_glint(glint, plan);
  }
  for (StratumPlan& plan : plans) {
    if (!plan.foci.empty()) give_rays(plan);
    serve_chains(plan);
    for (LaunchFocus& focus : plan.foci) {
      focus.share = rounded_rays(focus.share);
      guide.shares.at(plan.name) -= focus.share;
    }
    std::move(plan.foci.begin(), plan.foci.end(), std::back_inserter(guide.foci));
  }
}

}  // namespace echopath
