#include "echopath/replay/new_surface.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "echopath/base/parallel.h"
#include "echopath/trace/launch.h"
#include "echopath/trace/launch_directions.h"

namespace echopath {
namespace {

constexpr int64_t kRaysPerTask = 1024;

struct SeenPoint {
  Vec3 position, normal;
  bool faces(const Vec3& point) const { return normal.dot(point - position) > 0; }
};

SeenPoint point_of(const Hit& hit, const EmbreeScene& geometry) {
  const auto [a, b, c] = geometry.corners(hit.mesh_id, hit.triangle_id);
  return {a + double{hit.u} * (b - a) + double{hit.v} * (c - a), (b - a).cross(c - a).normalized()};
}

// Whether the same side of the point faces the antenna, and nothing stands between.
bool sees(const EmbreeScene& geometry, SeenPoint point, bool front, const Vec3& antenna) {
  if (!front) point.normal = -point.normal;
  return point.faces(antenna) && !geometry.occluded(geometry.lifted(point.position, point.normal), antenna);
}

class Look {
 public:
  Look(const Scene& scene, double frequency, const std::vector<PosedAntenna>& receivers, const EmbreeScene& geometry,
       const TraceView& trace)
      : scene_(scene), frequency_(frequency), receivers_(receivers), geometry_(geometry), trace_(trace) {}

  // A ray of a stratum of the plan, which counts the surface that it owns.
  void shoot(const PosedAntenna& transmitter, const Vec3& direction, const LaunchPlan& plan, int stratum, SurfaceSeen& seen) const {
    RayHit met;
    if (geometry_.intersect(transmitter.position, direction, met) != EmbreeScene::Verdict::kHit) return;
    if (plan.owners.owner(met.hit.mesh_id, kDirect) != stratum) return;
    const SeenPoint now = point_of(met.hit, geometry_);
    const bool front = now.faces(transmitter.position);
    const double arriving = transmitter.toward(direction).power * reflected(met.hit, now, direction) / plan.density(stratum);
    std::optional<bool> is_hidden;
    for (const PosedAntenna& receiver : receivers_) {
      if (!sees(geometry_, now, front, receiver.position)) continue;
      if (!is_hidden) is_hidden = was_hidden(met.hit, front);
      add(met.hit.mesh_id, arriving * received(now, receiver), *is_hidden, seen);
    }
  }

 private:
  bool was_hidden(const Hit& hit, bool front) const {
    const SeenPoint then = point_of(hit, trace_.geometry);
    return !sees(trace_.geometry, then, front, trace_.transmitter) || !sees(trace_.geometry, then, front, trace_.receiver);
  }

  double reflected(const Hit& hit, const SeenPoint& point, const Vec3& direction) const {
    const Material& material = *scene_.node_of(hit.mesh_id).material;
    return std::norm(respond(material, frequency_, std::abs(point.normal.dot(direction)), PolarizationMode::kTe).gamma);
  }

  double received(const SeenPoint& point, const PosedAntenna& receiver) const {
    const Vec3 line = receiver.position - point.position;
    const double length = line.norm();
    return receiver.toward(-line / length).power * std::abs(point.normal.dot(line)) / (length * length * length);
  }

  void add(uint32_t mesh_id, double power, bool hidden, SurfaceSeen& seen) const {
    const auto object = static_cast<size_t>(scene_.meshes()[mesh_id].object);
    seen.power += power;
    seen.power_of[object] += power;
    if (!hidden) return;
    seen.hidden += power;
    seen.hidden_of[object] += power;
  }

  const Scene& scene_;
  double frequency_;
  const std::vector<PosedAntenna>& receivers_;
  const EmbreeScene& geometry_;
  const TraceView& trace_;
};

LaunchPlan plan_rays(const Scene& scene, const EmbreeScene& geometry, const Vec3& from, int64_t num_rays) {
  LaunchSettings settings;
  settings.num_rays = num_rays;
  settings.max_image_mirrors = 0;
  settings.transmitter = from;
  return plan_launch(scene, geometry, {}, settings);
}

}  // namespace

void SurfaceSeen::add(const SurfaceSeen& other) {
  power += other.power;
  hidden += other.hidden;
  for (size_t i = 0; i < power_of.size(); ++i) {
    power_of[i] += other.power_of[i];
    hidden_of[i] += other.hidden_of[i];
  }
}

SurfaceSeen look_for_new_surface(const Scene& scene, double frequency, const Instant& antennas, const EmbreeScene& geometry,
                                 const TraceView& trace, int64_t num_rays, Job* job) {
  SurfaceSeen sum(scene);
  const Look look(scene, frequency, antennas.receivers, geometry, trace);
  for (const PosedAntenna& transmitter : antennas.transmitters) {
    if (job) job->throw_if_cancelled();
    const LaunchPlan plan = plan_rays(scene, geometry, transmitter.position, num_rays);
    const LaunchDirections directions(plan.strata);
    const int64_t count = plan.first_ray.back();
    std::vector<SurfaceSeen> parts(static_cast<size_t>((count + kRaysPerTask - 1) / kRaysPerTask), SurfaceSeen(scene));
    parallel_for(static_cast<int64_t>(parts.size()), [&](int64_t i) {
      for (int64_t ray = i * kRaysPerTask; ray < std::min(count, (i + 1) * kRaysPerTask); ++ray) {
        const int stratum = plan.stratum_of(ray);
        const Vec3 direction = directions.direction(stratum, plan.point_of(stratum, ray));
        look.shoot(transmitter, direction, plan, stratum, parts[static_cast<size_t>(i)]);
      }
    });
    for (const SurfaceSeen& part : parts) sum.add(part);
  }
  return sum;
}

}  // namespace echopath
