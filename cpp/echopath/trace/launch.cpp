#include "echopath/trace/launch.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/base/random.h"
#include "echopath/trace/scene_objects.h"

namespace echopath {
namespace {

constexpr double kDefensiveShare = 0.15;
constexpr size_t kMaxCones = 254;
// Difference of axes and versines, relative to the latter: planes at right angles have one image in both orders.
constexpr double kSameCone = 1e-9;

// As the antenna sees it over a sequence of mirrors (in travel order from there).
Vec3 image_of(Vec3 point, const std::vector<Mirror>& mirrors, const std::vector<int>& sequence) {
  for (size_t k = sequence.size(); k-- > 0;) point = mirrors[static_cast<size_t>(sequence[k])].image(point);
  return point;
}

struct Cone {
  Stratum stratum;
  int num_mirrors = 0;  // between the antenna and the object

  bool is_same(const Cone& other) const {
    const double difference = (stratum.axis - other.stratum.axis).norm() + std::abs(stratum.versine - other.stratum.versine);
    return difference < kSameCone * stratum.versine;
  }
  // Of the rays, relative to other cones.
  int64_t share() const { return num_mirrors < 2 ? kWholeShare : kWholeShare >> 2 * (num_mirrors - 1); }
  static constexpr int64_t kWholeShare = int64_t{1} << 2 * (kMaxLegMirrors - 1);
};

// A cone around each image of an object that a beam may show.
std::vector<Cone> aim_at_images(const Scene& scene, const VerticesOf& vertices_of, const std::vector<Mirror>& mirrors,
                                const std::vector<Beam>& beams, const std::vector<uint32_t>& mesh_ids, const Sphere& sphere,
                                const Cone& direct, const Vec3& apex) {
  std::vector<Cone> cones;
  for (const Beam& beam : beams) {
    if (!beam.reaches(sphere.centre, sphere.radius)) continue;
    const auto image = [&](const Vec3& point) { return image_of(point, mirrors, beam.mirrors); };
    std::string name = direct.stratum.name;
    for (size_t k = beam.mirrors.size(); k-- > 0;) {
      name += " over " + scene.node_of(mirrors[static_cast<size_t>(beam.mirrors[k])].mesh_id).name;
    }
    Cone cone{cone_around({image(sphere.centre), sphere.radius}, apex, name), static_cast<int>(beam.mirrors.size())};
    tighten(cone.stratum, vertices_of, mesh_ids, apex, image);
    const bool is_new = std::none_of(cones.begin(), cones.end(), [&](const Cone& other) { return cone.is_same(other); });
    if (is_new) cones.push_back(std::move(cone));
  }
  return cones;
}

struct Cones {
  std::vector<Cone> objects, images;
};

Cones aim(const Scene& scene, const EmbreeScene& geometry, const std::vector<Mirror>& mirrors, const LaunchSettings& settings) {
  Cones cones;
  const Vec3& apex = settings.transmitter;
  const std::vector<Beam> beams = find_beams(apex, mirrors, settings.max_image_mirrors);
  const VerticesOf vertices_of = [&](uint32_t id) -> const std::vector<Vec3>& { return geometry.vertices(id); };
  for (const auto& [object, mesh_ids] : objects_of(scene)) {
    const Sphere sphere = bounding_sphere(vertices_of, mesh_ids);
    if (sphere.holds(apex)) continue;
    Cone direct{cone_around(sphere, apex, scene.nodes()[static_cast<size_t>(object)].name)};
    tighten(direct.stratum, vertices_of, mesh_ids, apex, [](const Vec3& vertex) { return vertex; });
    const std::vector<Cone> images = aim_at_images(scene, vertices_of, mirrors, beams, mesh_ids, sphere, direct, apex);
    cones.objects.push_back(std::move(direct));
    cones.images.insert(cones.images.end(), images.begin(), images.end());
  }
  return cones;
}

std::vector<Cone> limited(Cones cones) {
  const auto wider = [](const Cone& a, const Cone& b) { return a.stratum.versine > b.stratum.versine; };
  if (cones.objects.size() > kMaxCones) {
    std::stable_sort(cones.objects.begin(), cones.objects.end(), wider);
    cones.objects.resize(kMaxCones);
  }
  for (int too_many = kMaxLegMirrors; too_many > 0 && cones.objects.size() + cones.images.size() > kMaxCones; --too_many) {
    std::erase_if(cones.images, [&](const Cone& cone) { return cone.num_mirrors >= too_many; });
  }
  std::vector<Cone> all = std::move(cones.objects);
  all.insert(all.end(), cones.images.begin(), cones.images.end());
  return all;
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

void add_stratum(LaunchPlan& plan, Stratum stratum, int64_t num_rays, Sampler sampler) {
  const auto k = static_cast<int64_t>(plan.strata.size());
  plan.points.push_back(disc_points(sampler, num_rays, shifts_of(plan.seed, k, plan.batches)));
  stratum.num_rays = plan.points.back()->size();
  if (stratum.num_rays > 0) stratum.ray_density = kPi / plan.points.back()->cell_area() / stratum.solid_angle();
  plan.first_ray.push_back(plan.first_ray.back() + stratum.num_rays);
  plan.strata.push_back(std::move(stratum));
}

}  // namespace

LaunchPlan plan_launch(const Scene& scene, const EmbreeScene& geometry, const std::vector<Mirror>& mirrors,
                       const LaunchSettings& settings) {
  LaunchPlan plan;
  plan.seed = settings.seed;
  plan.batches = settings.batches;
  plan.first_ray.assign(1, 0);
  const std::vector<Cone> cones = limited(aim(scene, geometry, mirrors, settings));
  int64_t shares = 0, shared = 0;
  for (const Cone& cone : cones) shares += cone.share();
  const double aimed_share = cones.empty() ? 0.0 : 1.0 - kDefensiveShare;
  const auto aimed = static_cast<int64_t>(std::llround(aimed_share * static_cast<double>(settings.num_rays)));
  for (const Cone& cone : cones) {
    const int64_t before = aimed * shared / shares;
    shared += cone.share();
    add_stratum(plan, cone.stratum, aimed * shared / shares - before, settings.sampler);
  }
  Stratum defensive;
  defensive.axis = settings.boresight;
  defensive.versine = settings.field_versine;
  defensive.name = "field of view";
  add_stratum(plan, std::move(defensive), settings.num_rays - aimed, settings.sampler);
  return plan;
}

int LaunchPlan::stratum_of(int64_t ray) const {
  return static_cast<int>(std::upper_bound(first_ray.begin(), first_ray.end(), ray) - first_ray.begin()) - 1;
}

int LaunchPlan::batch_of(int stratum, int64_t ray) const {
  const auto k = static_cast<size_t>(stratum);
  return points[k]->batch_of(ray - first_ray[k]);
}

Eigen::Vector2d LaunchPlan::point_of(int stratum, int64_t ray) const {
  const auto k = static_cast<size_t>(stratum);
  return points[k]->point(ray - first_ray[k]);
}

void LaunchPlan::place(int64_t begin, int count, Places& out) const {
  int stratum = stratum_of(begin);
  for (int lane = 0; lane < count; ++stratum) {
    const auto k = static_cast<size_t>(stratum);
    const int end = static_cast<int>(std::min<int64_t>(count, first_ray[k + 1] - begin));
    points[k]->points(begin + lane - first_ray[k], end - lane, out.x.lanes + lane, out.y.lanes + lane);
    for (; lane < end; ++lane) {
      out.strata[static_cast<size_t>(lane)] = stratum;
      out.batches[static_cast<size_t>(lane)] = batches == 1 ? 0 : batch_of(stratum, begin + lane);
    }
  }
}

}  // namespace echopath
