#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "echopath/base/constants.h"
#include "echopath/base/random.h"
#include "echopath/trace/sbr_state.h"
#include "echopath/trace/scatter_points.h"

namespace echopath {
namespace {

static_assert(kMaxLegMirrors < kRouletteBounce, "the balance weight over legs knows of no roulette on mirrors");
// Product of material areas (m^2 each) beyond which a ray ends: its square root is part of the weight, in single precision.
constexpr double kLargestArea = 1e60;

// The direction over a surface whose components along two axes across the unit normal and along it are given. The axes turn
// smoothly but for one line (Duff et al. 2017, "Building an orthonormal basis, revisited").
Vec3 over_surface(const Vec3& normal, const Vec3& local) {
  const double sign = std::copysign(1.0, normal.z());
  const double a = -1.0 / (sign + normal.z()), b = normal.x() * normal.y() * a;
  const Vec3 first(1.0 + sign * normal.x() * normal.x() * a, sign * b, -sign * normal.x());
  const Vec3 second(b, sign + normal.y() * normal.y() * a, -normal.y());
  return local.x() * first + local.y() * second + local.z() * normal;
}

// The middle one of the extents along the principal axes of the vertices: the width of a plate, the diameter of a sphere.
double middle_extent(const std::vector<Vec3>& vertices) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& vertex : vertices) mean += vertex / static_cast<double>(vertices.size());
  Mat3 covariance = Mat3::Zero();
  for (const Vec3& vertex : vertices) covariance += (vertex - mean) * (vertex - mean).transpose();
  const Mat3 axes = Eigen::SelfAdjointEigenSolver<Mat3>(covariance).eigenvectors();
  Eigen::AlignedBox3d box;
  for (const Vec3& vertex : vertices) box.extend(Vec3(axes.transpose() * (vertex - mean)));
  std::array<double, 3> extents = {box.sizes()[0], box.sizes()[1], box.sizes()[2]};
  std::sort(extents.begin(), extents.end());
  return extents[1];
}

}  // namespace

// Curvature of a hit in the plane of incidence, 1/m; 0 on facets.
double curvature_along(const RayHit& point, const Vec3& direction) {
  if (!point.is_smooth) return 0.0;
  const Vec3 along = (direction - point.normal.dot(direction) * point.normal).normalized();
  return along.dot(point.curvature * along);
}

RayShooter::RayShooter(const Scene& scene, const EmbreeScene& geometry, const std::vector<Mirror>& mirrors,
                       const LaunchPlan& plan, const SbrSettings& settings)
    : scene_(scene), geometry_(geometry), mirrors_(mirrors), plan_(plan), cones_(plan.strata), settings_(settings),
      legs_(geometry, mirrors, settings.frequency, settings.polarization), transmitter_(legs_.view_of(settings.transmitter)),
      receiver_(legs_.view_of(settings.receiver)), mirror_of_mesh_(scene.meshes().size(), -1),
      wavelength_(kSpeedOfLight / settings.frequency) {
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) mesh_width_.push_back(middle_extent(geometry.vertices(id)));
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) models_.emplace_back(*scene.node_of(id).material, settings.frequency);
  for (const Node& node : scene.nodes()) has_smooth_ = has_smooth_ || (node.mesh && node.smooth && !node.material->mirror);
  for (size_t i = 0; i < mirrors.size(); ++i) mirror_of_mesh_[mirrors[i].mesh_id] = static_cast<int>(i);
}

void RayShooter::shoot(int64_t begin, int64_t end, PathBlock& block) const {
  thread_local Scratch scratch;
  thread_local Packet packet;
  for (int64_t first = begin; first < end; first += kPacketSize) {
    shoot_packet(first, static_cast<int>(std::min<int64_t>(kPacketSize, end - first)), packet, scratch, block);
  }
  block.statistics.num_queries += std::exchange(scratch.search.num_queries, 0);
}

// Together to their first hits, each on its own from there.
void RayShooter::shoot_packet(int64_t begin, int count, Packet& packet, Scratch& scratch, PathBlock& block) const {
  launch_packet(begin, count, packet);
  geometry_.intersect(settings_.transmitter, packet.directions.data(), count, packet.verdicts.data(), packet.hits.data());
  block.statistics.num_queries += count;
  look_at_receiver(count, packet, block);
  Surface surface;
  for (int k = 0; k < count; ++k) {
    if (packet.verdicts[k] == EmbreeScene::Verdict::kMiss) continue;
    Ray ray = launched(begin + k, packet.strata[k], packet.directions[k]);
    block.current_batch = static_cast<uint8_t>(packet.batches[k]);
    block.current_half = half_of_ray(ray.index);
    surface.point = packet.hits[k];
    surface.receiver = packet.receiver[k];
    surface.chance = packet.chance.hit(k);
    surface.packet = &packet.chance;
    surface.lane = k;
    if (arrive(ray, packet.verdicts[k], surface, block)) follow(ray, surface, scratch, block);
    block.end_ray(ray.hits.data());
  }
}

// Directions, and what chance decides where rays arrive.
void RayShooter::launch_packet(int64_t begin, int count, Packet& packet) const {
  plan_.points_of(begin, count, {packet.strata.data(), packet.batches.data(), packet.points.data()});
  for (int k = 0; k < count; ++k) packet.directions[k] = cones_.direction(packet.strata[k], packet.points[k]);
  packet.chance.draw(settings_.seed, begin, count, packet.batches.data());
}

// From all first hits together: they lie beside each other. What a mirror needs depends on more.
void RayShooter::look_at_receiver(int count, Packet& packet, PathBlock& block) const {
  std::array<int, kPacketSize> asked;
  size_t num_asked = 0;
  for (int k = 0; k < count; ++k) {
    const RayHit& hit = packet.hits[k];
    packet.receiver[k] = Sight::kUnknown;
    if (packet.verdicts[k] != EmbreeScene::Verdict::kHit || models_[hit.hit.mesh_id].material().mirror) continue;
    if (hit.normal.dot(settings_.receiver - hit.position) <= 0) continue;
    packet.segments[num_asked] = {geometry_.lifted(hit.position, hit.normal), settings_.receiver};
    asked[num_asked++] = k;
  }
  if (num_asked == 0) return;
  geometry_.occluded(packet.segments.data(), num_asked, packet.blocked.data());
  block.statistics.num_queries += static_cast<int64_t>(num_asked);
  for (size_t i = 0; i < num_asked; ++i) packet.receiver[asked[i]] = packet.blocked[i] ? Sight::kBlocked : Sight::kOpen;
}

RayShooter::Ray RayShooter::launched(int64_t index, int stratum, const Vec3& direction) const {
  Ray ray;
  ray.index = index;
  ray.stratum = stratum;
  ray.from = settings_.transmitter;
  ray.direction = ray.launch_direction = direction;
  ray.leg_density = ray.launch_density = cones_.density_of_ray(direction, stratum);
  if (settings_.is_polarized) ray.polarized = launched_fields(direction);
  if (has_smooth_) ray.rays = RayDifferential::from_point(direction);
  return ray;
}

// From its first hit on.
void RayShooter::follow(Ray& ray, Surface& surface, Scratch& scratch, PathBlock& block) const {
  do {
    connect(ray, surface, scratch, block);
    if (ray.depth == settings_.max_bounces || !bounce(ray, surface, scratch, block)) break;
  } while (advance(ray, surface, block));
}

bool RayShooter::advance(Ray& ray, Surface& surface, PathBlock& block) const {
  ++block.statistics.num_queries;
  if (!arrive(ray, geometry_.intersect(ray.from, ray.direction, surface.point), surface, block)) return false;
  surface.receiver = Sight::kUnknown;
  surface.packet = nullptr;
  surface.chance = hit_chance(settings_.seed, ray.index, ray.depth);
  return true;
}

// At the point of `surface`, if it is one.
bool RayShooter::arrive(Ray& ray, EmbreeScene::Verdict verdict, Surface& surface, PathBlock& block) const {
  if (verdict == EmbreeScene::Verdict::kFalseHit) ++block.statistics.num_false_hits;
  if (verdict != EmbreeScene::Verdict::kHit) return false;
  surface.cos_incidence = -surface.point.normal.dot(ray.direction);
  if (surface.cos_incidence < kGrazing) {
    ++block.statistics.num_grazing;
    return false;
  }
  if (ray.last_was_mirror && !suffices(ray.mirror, ray.leg_length, surface.point.distance)) {
    ++block.statistics.num_small_mirrors;
    return false;
  }
  ++block.statistics.num_hits;
  ray.hits[static_cast<size_t>(ray.depth++)] = surface.point.hit;
  ray.leg_length += surface.point.distance;
  if (has_smooth_ && ray.coherent) follow_tube(ray, surface);
  surface.model = &models_[surface.point.hit.mesh_id];
  surface.material = &surface.model->material();
  const bool is_dielectric = surface.model->is_dielectric();
  surface.mode = mode_along(*surface.model, settings_.polarization, ray.direction, surface.point.normal);
  surface.response = surface.model->respond(surface.cos_incidence, surface.mode);
  if (!surface.material->mirror) {
    ray.has_dielectric_tm |= surface.mode == PolarizationMode::kTm;
    ray.has_odd_conductors ^= !is_dielectric;
  }
  surface.area = ray.leg_length * ray.leg_length / (ray.leg_density * surface.cos_incidence);
  return true;
}

// A mirror must hold the first Fresnel zone between what lies `before` and `behind` it (unfolded lengths, m). A point a
// distance x off the specular one makes the way longer by x^2/2 [cos^2 (1/before + 1/behind) + 2 cos/radius], in the plane
// of incidence; the zone ends where that is half a wavelength.
bool RayShooter::suffices(const MirrorBounce& mirror, double before, double behind) const {
  const double flat = mirror.cos_incidence * mirror.cos_incidence * (1.0 / before + 1.0 / behind);
  const double bend = std::max(std::abs(flat + 2.0 * mirror.cos_incidence * mirror.curvature), 1e-12);
  return mesh_width_[static_cast<size_t>(mirror.mesh)] >= 2.0 * std::sqrt(wavelength_ / bend);
}

// Carries the ray tube to the surface; caustics on the way turn the phase of the field.
void RayShooter::follow_tube(Ray& ray, Surface& surface) const {
  const double distance = surface.point.distance;
  if (ray.is_curved) {
    for (int n = ray.rays.num_caustics(ray.direction, distance); n > 0; --n) ray.field_factor *= std::complex<double>(0.0, 1.0);
    // Geometrical optics is singular at a caustic: no tube is narrower than the wave allows.
    surface.tube_area = std::max(std::abs(ray.rays.area(ray.direction, distance)), wavelength_ * ray.leg_length);
  }
  ray.rays.transfer(ray.direction, distance, surface.point.normal);
}

double RayShooter::survival_of(const SurfaceResponse& response, int num_bounces) {
  return num_bounces < kRouletteBounce ? 1.0 : std::min(1.0, std::norm(response.gamma));
}

RayShooter::Odds RayShooter::odds_of(const Surface& surface, const SurfaceResponse& response) const {
  const Odds shares{response.coherent * response.coherent, response.diffuse * response.diffuse};
  const bool is_asked = settings_.specular_probability > 0 && shares.specular > 0 && shares.diffuse > 0;
  // The balance weight over the legs of mirrors (LegFinder) counts on their shares.
  if (!is_asked || surface.material->mirror) return shares;
  return {settings_.specular_probability, 1.0 - settings_.specular_probability};
}

bool RayShooter::bounce(Ray& ray, const Surface& surface, Scratch& scratch, PathBlock& block) const {
  const SurfaceResponse& response = surface.response;
  const Odds odds = odds_of(surface, response);
  const int num_bounces = ray.coherent ? ray.depth : ray.depth - scratch.chain.first;
  const double survival = survival_of(response, num_bounces);
  const bool is_open = odds.specular > 0 && odds.diffuse > 0;
  bool specular = odds.diffuse == 0;
  if (surface.chance.survival_coin >= survival) return false;
  if (is_open) specular = surface.chance.lobe_coin < odds.specular;
  ray.from = geometry_.lifted(surface.point.position, surface.point.normal);
  if (specular) bounce_specular(ray, surface, odds.specular * survival, scratch.chain);
  else bounce_diffuse(ray, surface, odds.diffuse * survival, scratch, block);
  if (specular) ray.chain_share *= odds.specular;
  return std::norm(ray.coefficient) > 0 && ray.area < kLargestArea;
}

// `probability`: with which the ray goes on this way.
void RayShooter::bounce_specular(Ray& ray, const Surface& surface, double probability, Chain& chain) const {
  const SurfaceResponse& response = surface.response;
  const RayHit& point = surface.point;
  ray.field_factor /= probability;
  if (ray.coherent && has_smooth_) reflect_tube(ray, surface);
  if (settings_.is_polarized) reflect_polarized(ray, surface, ray.polarized);
  if (settings_.is_polarized && !ray.coherent && chain.back) reflect_polarized(ray, surface, chain.fields);
  const MirrorBounce bounced{static_cast<int>(point.hit.mesh_id), surface.cos_incidence, curvature_along(point, ray.direction)};
  const int mirror = mirror_of_mesh_[point.hit.mesh_id];
  if (mirror >= 0) {
    ray.coefficient *= mirror_sign(*surface.material, surface.mode, settings_.polarization, ray.direction, point.normal);
  }
  ray.direction = (ray.direction + 2.0 * surface.cos_incidence * point.normal).normalized();
  ray.coefficient *= response.gamma * response.coherent;
  ray.leg_density *= probability;
  const bool is_leg = mirror >= 0 && ray.sequence != kOther && ray.depth <= kMaxLegMirrors;
  ray.sequence = is_leg ? extended(ray.sequence, mirror, mirrors_.size()) : kOther;
  ray.last_was_mirror = mirror < 0;
  if (mirror < 0) ray.mirror = bounced;
  if (!ray.coherent) leave_specular(ray, surface, probability, chain);
}

// The tube of a coherent ray, before its direction changes.
void RayShooter::reflect_tube(Ray& ray, const Surface& surface) const {
  const RayHit& point = surface.point;
  const Mat3 flat = Mat3::Zero();
  ray.rays.reflect(ray.direction, point.normal, point.is_smooth ? point.curvature : flat);
  ray.is_curved = ray.is_curved || point.is_smooth;
}

// The direction in which the ray leaves its hit diffusely, the normal along z. Neighbours are neighbours no more deeper in a
// chain.
Vec3 RayShooter::scatter_lobe(const Ray& ray, const Surface& surface, int batch) const {
  if (surface.packet) return surface.packet->lobe(surface.lane);
  if (ray.coherent) return cosine_lobe(scatter_point(settings_.seed, batch, ray.index, ray.depth - 1));
  const auto index = static_cast<uint64_t>(ray.index);
  return cosine_lobe(uniform2(settings_.seed, Stream::kBounce, index, static_cast<uint32_t>(ray.depth)));
}

void RayShooter::bounce_diffuse(Ray& ray, const Surface& surface, double probability, Scratch& scratch,
                                PathBlock& block) const {
  const Vec3& normal = surface.point.normal;
  const Vec3 out = over_surface(normal, scatter_lobe(ray, surface, block.current_batch));
  if (ray.coherent) begin_chain(ray, surface, probability, scratch);
  ray.coefficient *= diffuse_coefficient(surface.response);
  ray.area *= surface.area;
  ray.diffuse |= uint64_t{1} << (ray.depth - 1);
  ray.coherent = false;
  ray.sequence = kOther;
  ray.mirror = MirrorBounce{};
  ray.last_was_mirror = false;
  leave_diffuse(ray, surface, out, probability, scratch.chain);
  if (settings_.is_polarized) scatter_polarized(ray, surface, out);
  ray.direction = out;
  ray.leg_length = 0.0;
  ray.leg_density = probability * std::max(normal.dot(ray.direction), 1e-9) / kPi;
}

}  // namespace echopath
