#include "echopath/trace/launch/launch.h"

#include <algorithm>
#include <map>
#include <utility>

#include "echopath/base/random.h"
#include "echopath/record/paths.h"
#include "echopath/trace/launch/launch_directions.h"
#include "echopath/trace/launch/launch_shares.h"
#include "echopath/trace/launch/rays_by_object.h"
#include "echopath/trace/strata/ray_targets.h"

namespace echopath {
namespace {

// Returns the shifts: each batch has one of its own in each stratum, which is known by a number.
std::vector<Eigen::Vector2d> shifts_of(uint64_t seed, int64_t stratum, int batches) {
  std::vector<Eigen::Vector2d> shifts;
  for (int batch = 0; batch < batches; ++batch) {
    const auto k = static_cast<uint64_t>(stratum);
    const auto shift = uniform2(seed, Stream::kLaunchShift, k, static_cast<uint32_t>(batch));
    shifts.emplace_back(shift[0], shift[1]);
  }
  return shifts;
}

void add_stratum(LaunchPlan& plan, Stratum stratum, int64_t num_rays, const LaunchSettings& settings) {
  const int64_t number = settings.by_name ? first_number_of(stratum.name) : std::ssize(plan.strata);
  if (settings.by_name) plan.first_number.push_back(number);
  const LaunchDomain domain = domain_of(stratum);
  plan.points.push_back(launch_points(settings.sampler, domain, num_rays, shifts_of(plan.seed, number, plan.batches)));
  stratum.num_rays = plan.points.back()->size();
  if (stratum.num_rays > 0) stratum.ray_density = domain.area() / plan.points.back()->cell_area() / stratum.solid_angle();
  plan.first_ray.push_back(plan.first_ray.back() + stratum.num_rays);
  plan.strata.push_back(std::move(stratum));
}

// Returns the foci that are asked for in existing strata, up to the number of strata that a record can tell apart.
std::vector<FocusOfTarget> foci_of(const std::vector<LaunchFocus>& asked, const std::vector<RayTarget>& targets,
                                   const Stratum& field) {
  std::map<std::string, size_t> index{{field.name, targets.size()}};
  for (size_t k = 0; k < targets.size(); ++k) index.emplace(targets[k].stratum.name, k);
  std::vector<FocusOfTarget> foci;
  for (const LaunchFocus& one : asked) {
    const auto found = index.find(one.of);
    if (found != index.end() && targets.size() + foci.size() + 1 < kNoStratum) foci.push_back({&one, found->second});
  }
  return foci;
}

// The name counts the foci of one stratum.
Stratum focus_stratum(const LaunchFocus& asked, const Stratum& owner, int index_of_owner, int number) {
  Stratum cone;
  cone.axis = asked.axis;
  cone.versine = asked.versine;
  cone.name = owner.name + ", focus " + std::to_string(number);
  cone.object = owner.object;
  cone.num_mirrors = owner.num_mirrors;
  cone.focus_of = index_of_owner;
  return cone;
}

Stratum field_of_view(const LaunchSettings& settings) {
  Stratum field;
  field.axis = settings.boresight;
  field.versine = settings.field_versine;
  field.name = "field of view";
  return field;
}

}  // namespace

LaunchPlan plan_launch(const Scene& scene, const EmbreeScene& geometry, const std::vector<Mirror>& mirrors,
                       const LaunchSettings& settings) {
  const Stratum field = field_of_view(settings);
  const RayTargetSettings aims{settings.transmitter,      settings.frusta,
                               0.5 * field.solid_angle(), settings.sampler == Sampler::kLattice,
                               settings.is_steady,        settings.num_rays / (LaunchPlan::kFewestRays - 1),
                               settings.fitted,           settings.job};
  RayTargets found = find_ray_targets(scene, geometry, mirrors, aims);
  std::vector<FocusOfTarget> foci;
  if (!settings.guide.shares.empty()) foci = foci_of(settings.guide.foci, found.targets, field);
  const bool any_still_mirror =
      std::ranges::any_of(mirrors, [&](const Mirror& mirror) { return scene.stands_still(mirror.mesh_id); });
  const FieldOwns owns{found.any_unaimed || !mirrors.empty(), found.any_still_unaimed || any_still_mirror};
  const LaunchShares shares(scene, found, owns, settings);
  std::vector<int64_t> rays = shares.rays(foci, field.name);
  for (size_t i = 0; i < foci.size(); ++i) {  // a stratum without rays owns nothing
    if (foci[i].of < found.targets.size() && rays[foci[i].of] == 0)
      rays.back() += std::exchange(rays[found.targets.size() + i], 0);
  }
  LaunchPlan plan;
  plan.seed = settings.seed;
  plan.batches = settings.batches;
  plan.num_unaimed = found.num_left_out;
  plan.first_ray.assign(1, 0);
  const int field_of_view = static_cast<int>(found.targets.size() + foci.size());
  plan.owners = RayOwners(std::move(found.object_of_mesh), found.num_objects, field_of_view);
  for (size_t k = 0; k < found.targets.size(); ++k) {
    add_stratum(plan, found.targets[k].stratum, rays[k], settings);
    if (plan.strata[k].num_rays == 0) continue;
    for (const MirrorSequence sequence : found.targets[k].sequences)
      plan.owners.assign(found.targets[k].object, sequence, static_cast<int>(k));
  }
  std::map<size_t, int> numbers;
  for (size_t i = 0; i < foci.size(); ++i) {
    const bool is_in_field = foci[i].of == found.targets.size();
    const Stratum& owner = is_in_field ? field : found.targets[foci[i].of].stratum;
    const int index_of_owner = is_in_field ? field_of_view : static_cast<int>(foci[i].of);
    const Stratum cone = focus_stratum(*foci[i].asked, owner, index_of_owner, ++numbers[foci[i].of]);
    add_stratum(plan, cone, rays[found.targets.size() + i], settings);
  }
  add_stratum(plan, field, rays.back(), settings);
  plan.foci = LaunchFoci(plan.strata);
  plan.default_density = shares.default_densities(plan.strata);
  return plan;
}

int LaunchPlan::stratum_of(int64_t ray) const {
  return static_cast<int>(std::ranges::upper_bound(first_ray, ray) - first_ray.begin()) - 1;
}

int64_t LaunchPlan::number_of(int64_t ray) const {
  if (first_number.empty()) return ray;
  const auto k = static_cast<size_t>(stratum_of(ray));
  return first_number[k] + ray - first_ray[k];
}

std::vector<std::pair<int64_t, int64_t>> LaunchPlan::pieces(int64_t size) const {
  std::vector<std::pair<int64_t, int64_t>> bounds;
  const auto add = [&](int64_t begin, int64_t end) {
    for (; begin < end; begin += size) bounds.emplace_back(begin, std::min(end, begin + size));
  };
  for (size_t k = 0; k < strata.size(); ++k) add(first_ray[k], first_ray[k + 1]);
  add(first_point, first_point + std::ssize(surface_scatterers));
  return bounds;
}

int LaunchPlan::batch_of(int stratum, int64_t ray) const { return points[stratum]->batch_of(ray - first_ray[stratum]); }

Eigen::Vector2d LaunchPlan::point_of(int stratum, int64_t ray) const {
  return points[stratum]->point(ray - first_ray[stratum]);
}

void LaunchPlan::place(int64_t begin, int count, Places& out) const {
  int stratum = stratum_of(begin);
  for (int lane = 0; lane < count; ++stratum) {
    const int end = static_cast<int>(std::min<int64_t>(count, first_ray[stratum + 1] - begin));
    points[stratum]->points(begin + lane - first_ray[stratum], end - lane, out.x.lanes + lane, out.y.lanes + lane);
    for (; lane < end; ++lane) {
      out.strata[lane] = stratum;
      out.batches[lane] = batches == 1 ? 0 : batch_of(stratum, begin + lane);
    }
  }
}

}  // namespace echopath
