#include "echopath/trace/launch.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/base/random.h"

namespace echopath {
namespace {

constexpr double kDefensiveShare = 0.15;
constexpr size_t kMaxCones = 254;

struct Sphere {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;
};

Sphere bounding_sphere(const EmbreeScene& geometry, const std::vector<uint32_t>& mesh_ids) {
  Eigen::AlignedBox3d box;
  for (const uint32_t id : mesh_ids) {
    for (const Vec3& vertex : geometry.vertices(id)) box.extend(vertex);
  }
  Sphere sphere{box.center(), 0.0};
  for (const uint32_t id : mesh_ids) {
    for (const Vec3& vertex : geometry.vertices(id)) sphere.radius = std::max(sphere.radius, (vertex - sphere.centre).norm());
  }
  return sphere;
}

Stratum cone_around(const Sphere& sphere, const Vec3& apex, std::string name) {
  const Vec3 line = sphere.centre - apex;
  const double distance = line.norm();
  const double sine = std::min(1.0, sphere.radius / distance);
  Stratum stratum;
  stratum.axis = line / distance;
  // Without cancellation, and widened a little so that single precision loses no edge.
  stratum.versine = std::min(2.0, sine * sine / (1.0 + std::sqrt(1.0 - sine * sine)) * (1.0 + 1e-4));
  stratum.name = std::move(name);
  return stratum;
}

// No wider than the vertices need, as seen from `apex`, in `mirror` where there is one: a long object seen end-on fills
// little of its bounding sphere.
void tighten(Stratum& cone, const EmbreeScene& geometry, const std::vector<uint32_t>& mesh_ids, const Vec3& apex,
             const Mirror* mirror) {
  double widest = 0.0;
  for (const uint32_t id : mesh_ids) {
    for (const Vec3& vertex : geometry.vertices(id)) {
      const Vec3 toward = ((mirror ? mirror->image(vertex) : vertex) - apex).normalized();
      widest = std::max(widest, 0.5 * (toward - cone.axis).squaredNorm());
    }
  }
  cone.versine = std::min(cone.versine, widest * (1.0 + 1e-4));
}

bool image_is_in_reach(const Mirror& mirror, const Sphere& sphere, const Vec3& transmitter) {
  const double antenna_side = mirror.signed_distance(transmitter);
  const double object_side = mirror.signed_distance(sphere.centre);
  return antenna_side != 0 && object_side * antenna_side > -std::abs(antenna_side) * sphere.radius;
}

// Meshes that are not mirrors, by child of the root.
std::vector<std::pair<int, std::vector<uint32_t>>> objects_of(const Scene& scene) {
  std::vector<std::pair<int, std::vector<uint32_t>>> objects;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    if (scene.node_of(id).material->mirror) continue;
    const int object = scene.meshes()[id].object;
    const auto found = std::find_if(objects.begin(), objects.end(), [&](const auto& entry) { return entry.first == object; });
    if (found == objects.end()) {
      objects.emplace_back(object, std::vector<uint32_t>{id});
    } else {
      found->second.push_back(id);
    }
  }
  return objects;
}

struct Cones {
  std::vector<Stratum> objects, images;
};

Cones aim(const Scene& scene, const EmbreeScene& geometry, const std::vector<Mirror>& mirrors, const LaunchSettings& settings) {
  Cones cones;
  for (const auto& [object, mesh_ids] : objects_of(scene)) {
    const Sphere sphere = bounding_sphere(geometry, mesh_ids);
    if ((sphere.centre - settings.transmitter).norm() <= sphere.radius) continue;
    const std::string& name = scene.nodes()[static_cast<size_t>(object)].name;
    cones.objects.push_back(cone_around(sphere, settings.transmitter, name));
    tighten(cones.objects.back(), geometry, mesh_ids, settings.transmitter, nullptr);
    if (!settings.with_images) continue;
    for (const Mirror& mirror : mirrors) {
      if (!image_is_in_reach(mirror, sphere, settings.transmitter)) continue;
      const Sphere image{mirror.image(sphere.centre), sphere.radius};
      cones.images.push_back(cone_around(image, settings.transmitter, name + " over " + scene.node_of(mirror.mesh_id).name));
      tighten(cones.images.back(), geometry, mesh_ids, settings.transmitter, &mirror);
    }
  }
  return cones;
}

std::vector<Stratum> limited(Cones cones) {
  const auto wider = [](const Stratum& a, const Stratum& b) { return a.versine > b.versine; };
  if (cones.objects.size() > kMaxCones) {
    std::stable_sort(cones.objects.begin(), cones.objects.end(), wider);
    cones.objects.resize(kMaxCones);
  }
  std::vector<Stratum> strata = std::move(cones.objects);
  if (strata.size() + cones.images.size() <= kMaxCones) {
    strata.insert(strata.end(), cones.images.begin(), cones.images.end());
  }
  return strata;
}

// Each batch has a shift of its own in each stratum.
std::vector<Eigen::Vector2d> shifts_of(uint64_t seed, int64_t stratum, int batches) {
  std::vector<Eigen::Vector2d> shifts;
  for (int batch = 0; batch < batches; ++batch) {
    const auto k = static_cast<uint64_t>(stratum);
    const auto shift = uniform2(seed, Stream::kLaunchShift, k, static_cast<uint32_t>(batch));
    shifts.emplace_back(shift[0], shift[1]);
  }
  return shifts;
}

void share_rays(LaunchPlan& plan, int64_t num_rays, Sampler sampler) {
  const auto num_cones = static_cast<int64_t>(plan.strata.size()) - 1;
  const auto aimed = num_cones > 0 ? static_cast<int64_t>(std::llround((1.0 - kDefensiveShare) * static_cast<double>(num_rays))) : 0;
  plan.first_ray.assign(1, 0);
  for (int64_t k = 0; k <= num_cones; ++k) {
    const int64_t share = k < num_cones ? aimed * (k + 1) / num_cones - aimed * k / num_cones : num_rays - aimed;
    Stratum& stratum = plan.strata[static_cast<size_t>(k)];
    plan.points.push_back(disc_points(sampler, share, shifts_of(plan.seed, k, plan.batches)));
    stratum.num_rays = plan.points.back()->size();
    if (stratum.num_rays > 0) stratum.ray_density = kPi / plan.points.back()->cell_area() / stratum.solid_angle();
    plan.first_ray.push_back(plan.first_ray.back() + stratum.num_rays);
  }
}

}  // namespace

LaunchPlan plan_launch(const Scene& scene, const EmbreeScene& geometry, const std::vector<Mirror>& mirrors,
                       const LaunchSettings& settings) {
  LaunchPlan plan;
  plan.seed = settings.seed;
  plan.batches = settings.batches;
  plan.strata = limited(aim(scene, geometry, mirrors, settings));
  Stratum& defensive = plan.strata.emplace_back();
  defensive.axis = settings.boresight;
  defensive.versine = settings.field_versine;
  defensive.name = "field of view";
  share_rays(plan, settings.num_rays, settings.sampler);
  return plan;
}

int LaunchPlan::stratum_of(int64_t ray) const {
  return static_cast<int>(std::upper_bound(first_ray.begin(), first_ray.end(), ray) - first_ray.begin()) - 1;
}

int LaunchPlan::batch_of(int stratum, int64_t ray) const {
  const auto k = static_cast<size_t>(stratum);
  return points[k]->batch_of(ray - first_ray[k]);
}

Vec3 LaunchPlan::direction(int index, int64_t ray) const {
  const auto k = static_cast<size_t>(index);
  const Stratum& stratum = strata[k];
  const Eigen::Vector2d point = points[k]->point(ray - first_ray[k]);
  // In a Lambert projection the versine is proportional to the squared radius: sine / radius = sqrt(V (2 - versine)).
  const double versine = stratum.versine * std::min(1.0, point.squaredNorm());
  const Eigen::Vector2d across = point * std::sqrt(stratum.versine * (2.0 - versine));
  const Vec3 first = stratum.axis.unitOrthogonal(), second = stratum.axis.cross(first);
  return ((1.0 - versine) * stratum.axis + across[0] * first + across[1] * second).normalized();
}

double LaunchPlan::ray_density(const Vec3& direction, int own) const {
  double density = 0.0;
  for (int k = 0; k < static_cast<int>(strata.size()); ++k) {
    const Stratum& stratum = strata[static_cast<size_t>(k)];
    if (stratum.num_rays > 0 && (k == own || stratum.contains(direction))) density += stratum.ray_density;
  }
  return density;
}

}  // namespace echopath
