#include "echopath/sim/rays/ray_allocation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string_view>
#include <utility>

#include "echopath/power/received_power.h"
#include "echopath/radar/noise_power.h"
#include "echopath/sim/rays/beam_foci.h"
#include "echopath/sim/rays/hits_per_cell.h"
#include "echopath/sim/rays/thinned_trace.h"
#include "echopath/trace/launch/launch.h"
#include "echopath/trace/strata/fitted_strata.h"
#include "echopath/trace/strata/ray_targets.h"

namespace echopath {
namespace {

constexpr double kDynamicRange = 1e-6;            // of the strongest echo
constexpr double kUnseenGrowth = 0.25;            // of strata that send nothing back
constexpr double kMovingTarget = 0.25;            // of the target: what moves is what a radar looks for
constexpr double kImageWeight = 0.5;              // beside that of the target
constexpr double kObjectsFirst = 0.65;            // of the rays, where they are too few for objects and images
constexpr double kServedFirst = 0.75;             // of the rays of either
constexpr double kForCells = 0.15;                // of the rays, at most, where needs leave no more
constexpr double kLeftForCells = 0.5;             // of the rays that needs leave
constexpr double kPlannedDb = 0.8 * kResolvedDb;  // a margin: what a pilot foretells may come out larger
constexpr double kFocusFieldShare = 0.1;          // of the field of view, at least, where it has a focus and is not resolved
constexpr int64_t kPilotDivisor = 8;
constexpr int64_t kFewestPilotRays = 2048;

double sum_of(const RayShares& shares) {
  return std::accumulate(shares.begin(), shares.end(), 0.0,
                         [](double sum, const auto& share) { return sum + share.second; });
}

// Holds what is received of each stratum with its foci.
struct StrataPowers {
  std::vector<ReceivedPower> powers;
  std::vector<double> growth_by_cells;
};

// `of_map`: the cells of the map count.
StrataPowers power_of_strata(const Paths& paths, bool of_map, Job* job) {
  const size_t num_strata = paths.frame.strata.size();
  std::vector<uint32_t> group(paths.stratum.size());
  std::ranges::transform(paths.stratum, group.begin(), [&](uint16_t stratum) {
    if (stratum >= num_strata) return static_cast<uint32_t>(num_strata);
    const Stratum& of = paths.frame.strata[stratum];
    return static_cast<uint32_t>(of.is_focus() ? of.focus_of : stratum);
  });
  const Sorting sorting{group, num_strata + 1};
  StrataPowers found{{}, std::vector<double>(sorting.num_groups, 0.0)};
  const bool cells_ask = of_map && paths.frame.scatterers != Scatterers::kSurface;
  PowerAndLength of_paths;
  found.powers = received_powers(paths, std::span(&sorting, 1), job, {}, cells_ask ? &of_paths : nullptr)[0];
  if (cells_ask) found.growth_by_cells = growth_by_cells(paths, group, sorting.num_groups, of_paths.power, kMaxGrowth, job);
  return found;
}

double strongest_of(const std::vector<ReceivedPower>& powers) {
  double strongest = 0.0;
  for (const ReceivedPower& power : powers) strongest = std::max(strongest, power.power);
  return strongest;
}

// Returns half the interval relative to the power, in dB; a power below the floor counts as if it were as strong as the
// floor.
double missing_db(const ReceivedPower& power, double least) {
  const double level = std::max(power.power, least),
               half = std::max(power.high_of_rays - power.power, power.power - power.low_of_rays);
  return level > 0 ? 10.0 * std::log10(1.0 + half / level) : 0.0;
}

// Marks the nodes at which or below which something moves.
std::vector<bool> moving_nodes(const Scene& scene) {
  std::vector<bool> moves;
  for (uint32_t mesh = 0; mesh < scene.meshes().size(); ++mesh) moves.push_back(scene.is_moving(mesh));
  return scene.nodes_above(moves);
}

// Returns how many times the rays bring an error to the target.
double growth_of(double missing_db, double target_db, RayLaw law) {
  if (law == RayLaw::kByDecibels) return missing_db / target_db;
  return (std::pow(10.0, 0.1 * missing_db) - 1.0) / (std::pow(10.0, 0.1 * target_db) - 1.0);
}

// `growth` is that of the error, `by_cells` that of hits in cells, and `least` that of what needs no more rays.
RayNeed need_of(const Stratum& stratum, double num_rays, const ReceivedPower& power, double growth, double by_cells,
                double least) {
  RayNeed need;
  need.stratum = stratum.name;
  need.echo = {power.power, power.high_of_rays};
  need.is_image = stratum.num_mirrors > 0;
  need.weight = weight_of_target(stratum.num_mirrors) * (need.is_image ? kImageWeight : 1.0);
  growth = power.high_of_rays > 0 ? std::clamp(growth, least, kMaxGrowth) : std::max(kUnseenGrowth, least);
  // The field of view sees many surfaces, of which the strongest would speak for all, so it keeps the rays that it has.
  if (stratum.object < 0) growth = 1.0;
  else num_rays = std::max(num_rays, static_cast<double>(LaunchPlan::kFewestRays));
  need.is_bounded = growth < kMaxGrowth;
  need.rays = growth * num_rays;
  need.more_for_cells = std::max(by_cells - growth, 0.0) * num_rays;
  return need;
}

double rays_of(const RayNeeds& needs, bool is_image) {
  double sum = 0.0;
  for (const RayNeed& need : needs.strata) sum += need.is_image == is_image ? need.rays : 0.0;
  return sum;
}

// Shares `left` rays out by weight, but gives no bounded need more than it asks: what that leaves goes to the others.
void fill_by_weight(std::vector<const RayNeed*> unserved, double left, RayShares& shares) {
  double weights = 0.0;
  for (bool has_changed = true; has_changed;) {
    weights = std::accumulate(unserved.begin(), unserved.end(), 0.0,
                              [](double sum, const RayNeed* need) { return sum + need->weight; });
    const double level = left / weights;
    const auto met = std::stable_partition(unserved.begin(), unserved.end(), [&](const RayNeed* need) {
      return !need->is_bounded || need->rays >= need->weight * level;
    });
    for (auto need = met; need != unserved.end(); ++need) left -= shares[(*need)->stratum] = (*need)->rays;
    has_changed = met != unserved.end();
    unserved.erase(met, unserved.end());
  }
  for (const RayNeed* need : unserved) shares[need->stratum] = need->weight * left / weights;
}

// Shares out `num_rays` rays among images, or among what is none.
void share_out_among(const RayNeeds& needs, bool is_image, double num_rays, RayShares& shares) {
  std::vector<const RayNeed*> all;
  for (const RayNeed& need : needs.strata) {
    if (need.is_image == is_image) all.push_back(&need);
  }
  std::ranges::stable_sort(all, [](const RayNeed* a, const RayNeed* b) {
    return std::pair(!a->is_bounded, a->rays) < std::pair(!b->is_bounded, b->rays);
  });
  const bool is_scarce = rays_of(needs, is_image) > num_rays;
  double to_serve = kServedFirst * num_rays, left = num_rays;
  std::vector<const RayNeed*> unserved;
  for (const RayNeed* need : all) {
    if (is_scarce && !(need->is_bounded && need->rays <= to_serve)) {
      unserved.push_back(need);
      continue;
    }
    shares[need->stratum] = need->rays;
    to_serve -= need->rays;
    left -= need->rays;
  }
  fill_by_weight(std::move(unserved), left, shares);
}

// Raises the rays of the field of view where its echo is not resolved and a glint makes it, or a narrow beam.
void raise_field_of_view(const TraceFrame& frame, const RayNeeds& needs, const std::vector<Glint>& glints,
                         const BeamFoci& beam_foci, RayShares& shares) {
  const int field = static_cast<int>(frame.strata.size()) - 1;
  const std::string& name = frame.strata.back().name;
  const bool has_glints = std::ranges::any_of(glints, [&](const Glint& glint) { return glint.stratum == field; });
  const bool is_resolved =
      std::ranges::all_of(needs.strata, [&](const RayNeed& need) { return need.stratum != name || need.is_resolved; });
  if ((has_glints || beam_foci.fits(frame.strata.back())) && !is_resolved)
    shares.at(name) = std::max(shares.at(name), kFocusFieldShare * sum_of(shares));
}

// Returns the echoes by index of the strata.
std::vector<KnownEcho> echoes_of(const TraceFrame& frame, const RayNeeds& needs) {
  std::map<std::string_view, KnownEcho> known;
  for (const RayNeed& need : needs.strata) known[need.stratum] = need.echo;
  std::vector<KnownEcho> echoes;
  for (const Stratum& stratum : frame.strata) echoes.push_back(known[stratum.name]);
  return echoes;
}

// Puts the rays of what stands still in the place of those that a guide has for it.
void put_in(const StillRays& still, LaunchGuide& guide) {
  for (const auto& [name, rays] : still.guide.shares) guide.shares[name] = rays;
  std::erase_if(guide.foci, [&](const LaunchFocus& focus) { return still.holds(focus.of); });
  guide.foci.insert(guide.foci.begin(), still.guide.foci.begin(), still.guide.foci.end());
}

}  // namespace

double RayNeeds::num_rays_for_cells() const {
  double sum = 0.0;
  for (const RayNeed& need : strata) sum += need.more_for_cells;
  return sum;
}

double RayNeeds::num_rays() const {
  double sum = 0.0;
  for (const RayNeed& need : strata) sum += need.rays;
  return sum;
}

RayNeeds ray_needs(const Paths& paths, const WantedError& wanted, const StillRays& still, Job* job) {
  const auto [powers, by_cells] = power_of_strata(paths, wanted.floor == EchoFloor::kNoise, job);
  const double floor =
      wanted.floor == EchoFloor::kNoise ? noise_power_in_cell(paths.radar) : kDynamicRange * strongest_of(powers);
  const double least = std::max(floor, wanted.least_power);
  const std::vector<bool> moves = moving_nodes(*paths.scene);
  const RayShares launched = shares_of(paths.frame.strata);
  RayNeeds needs;
  for (size_t k = 0; k < paths.frame.strata.size(); ++k) {
    const Stratum& stratum = paths.frame.strata[k];
    if (stratum.is_focus() || still.holds(stratum.name)) continue;
    const double missing = missing_db(powers[k], least);
    const bool is_moving = stratum.object >= 0 && moves[stratum.object];
    const double target = is_moving && stratum.num_mirrors == 0 ? kMovingTarget * wanted.db : wanted.db;
    const double growth = growth_of(missing, target, wanted.law);
    needs.strata.push_back(need_of(stratum, launched.at(stratum.name), powers[k], growth, by_cells[k], wanted.least_growth));
    needs.strata.back().is_resolved = missing <= target || powers[k].high_of_rays <= least;
    if (powers[k].high_of_rays > least) needs.worst_db = std::max(needs.worst_db, missing);
  }
  return needs;
}

RayShares share_out(const RayNeeds& needs, double num_rays) {
  const double asked_for_cells = needs.num_rays_for_cells();
  const double most_for_cells = std::max(kForCells * num_rays, kLeftForCells * (num_rays - needs.num_rays()));
  const double to_cells = std::min(asked_for_cells, most_for_cells), left = num_rays - to_cells;
  const double of_objects = rays_of(needs, false), of_images = rays_of(needs, true);
  const double to_objects = std::min(of_objects, std::max(kObjectsFirst * left, left - of_images));
  RayShares shares;
  share_out_among(needs, false, to_objects, shares);
  share_out_among(needs, true, left - to_objects, shares);
  if (to_cells == 0.0) return shares;
  const double per_ray = sum_of(shares) / left / asked_for_cells * to_cells;  // shares that do not add up are stretched
  for (const RayNeed& need : needs.strata)
    if (need.more_for_cells > 0.0) shares.at(need.stratum) += per_ray * need.more_for_cells;
  return shares;
}

LaunchGuide guide_rays(const Paths& paths, const RayNeeds& needs, int64_t num_rays, const StillRays& still, Job* job) {
  LaunchGuide guide;
  const double left = static_cast<double>(num_rays) - still.guide.num_rays();
  if (!needs.strata.empty()) guide.shares = share_out(needs, left);
  const std::vector<Glint> glints = find_glints(paths, job);
  const BeamFoci beam_foci(paths);
  if (!still.any()) raise_field_of_view(paths.frame, needs, glints, beam_foci, guide.shares);
  const double shared = sum_of(guide.shares);  // 0 where nothing but what stands still is there
  const double rays_per_share = shared > 0.0 ? left / shared : 0.0;
  // Shares that persist count rays (LaunchSettings::by_name), of which there are not to be more than num_rays.
  const double up = paths.frame.scatterers == Scatterers::kSurface ? 0.0 : 0.5;
  for (auto& [name, share] : guide.shares) share = rounded_rays(rays_per_share * share, up);
  put_in(still, guide);
  set_foci(paths.frame, echoes_of(paths.frame, needs), glints, guide);
  beam_foci.set(guide);
  put_in(still, guide);  // without the foci that this frame would have set
  return guide;
}

Paths trace_by_need(const SceneSnapshot& scene, const Radar& radar, const TraceSettings& settings, Job* job,
                    KeptGeometry* kept, KeptStillRays* kept_still) {
  settings.validate();
  if (!settings.guide.shares.empty() || settings.num_rays / kPilotDivisor < kFewestPilotRays)
    return thinned_trace(scene, radar, settings, job, kept);
  KeptGeometry own;
  if (!kept) kept = &own;
  FittedStrata fitted;
  Job unseen(job);  // its progress is that of the trace
  // Pilots have as many rays with and without what moves: the number of objects at which rays are aimed depends on it.
  const auto pilot_of = [&](const SceneSnapshot& seen, KeptGeometry* geometry, FittedStrata* strata) {
    TraceSettings launch = settings;
    launch.num_rays = settings.num_rays / kPilotDivisor;
    // Of faint paths only few are kept: how many is known when the record is made.
    if (settings.faint_power == 0.0) launch.num_rays_to_come = settings.num_rays;
    launch.edges = false;  // their echoes need no rays
    return trace(seen, radar, launch, &unseen, geometry, strata);
  };
  const auto guide_by = [&](const Paths& pilot, int64_t num_rays, const StillRays& still) {
    const WantedError wanted{.db = kPlannedDb, .floor = EchoFloor::kNoise, .law = RayLaw::kByPower};
    return guide_rays(pilot, ray_needs(pilot, wanted, still, &unseen), num_rays, still, &unseen);
  };
  const auto still = still_rays(*scene, radar, settings, kept_still, [&](const SceneSnapshot& standing) {
    const Paths pilot = pilot_of(standing, nullptr, nullptr);
    return StillRays(guide_by(pilot, settings.num_rays / 2, {}));
  });
  TraceSettings launch = settings;
  launch.guide = guide_by(pilot_of(scene, kept, &fitted), settings.num_rays, *still);
  return thinned_trace(scene, radar, launch, job, kept, &fitted);
}

}  // namespace echopath
