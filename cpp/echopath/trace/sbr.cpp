#include "echopath/trace/sbr.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/base/random.h"
#include "echopath/em/jones.h"
#include "echopath/scene/smooth.h"
#include "echopath/trace/ray_differential.h"

namespace echopath {
namespace {

constexpr int kRouletteBounce = 3;     // rays leave this bounce and later ones by Russian roulette
constexpr double kGrazing = 1e-3;      // cosine below which a hit is dropped
constexpr double kNearAntenna = 1e-3;  // m
// Product of material areas (m^2 each) beyond which a ray ends: its square root is part of the weight, in single precision.
constexpr double kLargestArea = 1e60;
constexpr double kPolarizedGrazing = 0.05;  // cosine
constexpr int kDirect = -1;            // transmit chains, besides the index of a mirror
constexpr int kOther = -2;

Vec3 cosine_lobe(const Vec3& normal, const std::array<double, 2>& random) {
  const double sine = std::sqrt(random[0]);
  const Vec3 first = normal.unitOrthogonal();
  const Vec3 second = normal.cross(first);
  return (std::sqrt(1.0 - random[0]) * normal + sine * std::cos(kTwoPi * random[1]) * first +
          sine * std::sin(kTwoPi * random[1]) * second)
      .normalized();
}

// Curvature of a hit in the plane of incidence, 1/m; 0 on facets.
double curvature_along(const RayHit& point, const Vec3& direction) {
  if (!point.is_smooth) return 0.0;
  const Vec3 along = (direction - point.normal.dot(direction) * point.normal).normalized();
  return along.dot(point.curvature * along);
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

// A specular bounce off an unflagged surface.
struct RayShooter::MirrorBounce {
  int mesh = -1;               // -1: none
  double cos_incidence = 1.0;
  double curvature = 0.0;      // 1/m, in the plane of incidence, positive where convex
};

struct RayShooter::Ray {
  int64_t index = 0;
  int stratum = 0;
  Vec3 from, direction, launch_direction;
  std::array<Hit, 64> hits;
  int depth = 0;              // hits so far
  uint64_t diffuse = 0;       // bit per hit
  bool coherent = true;       // regime C
  int chain = kDirect;        // how the transmitter was left: directly, over one mirror, otherwise
  double chain_share = 1.0;   // s_m^2 of that mirror
  // Since the last anchor (the transmitter or the last diffuse hit): unfolded length in m and rays per sr, continuation
  // probabilities included.
  double leg_length = 0.0, leg_density = 0.0;
  std::complex<double> field = 1.0;        // product of Gamma s / q; regime C
  std::complex<double> coefficient = 1.0;  // product of Gamma s and |Gamma| S, without q
  FieldVector polarized[2];   // fields of a horizontal and a vertical launch with 1/q; regime C, where polarised
  RayDifferential rays;       // regime C, where the scene has smooth meshes
  bool is_curved = false;     // some bounce so far was on a curved surface
  MirrorBounce mirror;            // the last specular bounce off an unflagged surface since the last anchor
  bool last_was_mirror = false;   // and it was the last bounce
  double area = 1.0;                       // product of the material areas of the diffuse anchors
};

struct RayShooter::Surface {
  RayHit point;
  const Material* material = nullptr;
  double cos_incidence = 0.0;
  SurfaceResponse response;
  double area = 0.0;  // m^2: surface that this hit stands for, seen from the last anchor
  double tube_area = 0.0;  // m^2/sr: D of the ray tube behind curved bounces
};

struct RayShooter::Odds {
  double specular = 0.0, diffuse = 0.0;
};

struct RayShooter::Scratch {
  std::vector<Leg> transmit, receive;
};

RayShooter::RayShooter(const Scene& scene, const EmbreeScene& geometry, const std::vector<Mirror>& mirrors,
                       const LaunchPlan& plan, const SbrSettings& settings)
    : scene_(scene), geometry_(geometry), mirrors_(mirrors), plan_(plan), settings_(settings),
      legs_(geometry, mirrors, settings.frequency, settings.polarization), mirror_of_mesh_(scene.meshes().size(), -1),
      wavelength_(kSpeedOfLight / settings.frequency) {
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) mesh_width_.push_back(middle_extent(geometry.vertices(id)));
  for (const Node& node : scene.nodes()) has_smooth_ = has_smooth_ || (node.mesh && node.smooth && !node.material->mirror);
  for (size_t i = 0; i < mirrors.size(); ++i) mirror_of_mesh_[mirrors[i].mesh_id] = static_cast<int>(i);
}

void RayShooter::shoot(int64_t index, PathBlock& block) const {
  Ray ray;
  ray.index = index;
  ray.stratum = plan_.stratum_of(index);
  ray.from = settings_.transmitter;
  ray.direction = ray.launch_direction = plan_.direction(ray.stratum, index);
  block.current_batch = static_cast<uint8_t>(plan_.batch_of(ray.stratum, index));
  ray.leg_density = plan_.ray_density(ray.direction, ray.stratum);
  if (settings_.is_polarized) {
    const TransverseBasis basis = transverse_basis(ray.direction);
    ray.polarized[0] = basis.horizontal.cast<std::complex<double>>();
    ray.polarized[1] = basis.vertical.cast<std::complex<double>>();
  }
  if (has_smooth_) ray.rays = RayDifferential::from_point(ray.direction);
  thread_local Scratch scratch;
  Surface surface;
  while (ray.depth < settings_.max_bounces && advance(ray, surface, block)) {
    connect(ray, surface, scratch, block);
    if (!bounce(ray, surface)) break;
  }
  block.end_ray(ray.hits.data());
}

bool RayShooter::advance(Ray& ray, Surface& surface, PathBlock& block) const {
  ++block.statistics.num_queries;
  const EmbreeScene::Verdict verdict = geometry_.intersect(ray.from, ray.direction, surface.point);
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
  surface.material = scene_.node_of(surface.point.hit.mesh_id).material.get();
  surface.response = respond(*surface.material, settings_.frequency, surface.cos_incidence,
                             polarization_mode(settings_.polarization, ray.direction, surface.point.normal));
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

// Whether the way back, over this hit as a mirror, would have to be dropped.
bool RayShooter::opposite_is_invalid(const Surface& surface, const Vec3& direction, double to_receiver) const {
  const MirrorBounce mirror{static_cast<int>(surface.point.hit.mesh_id), surface.cos_incidence,
                            curvature_along(surface.point, direction)};
  return !suffices(mirror, to_receiver, surface.point.distance);
}

// Carries the ray tube to the surface; caustics on the way turn the phase of the field.
void RayShooter::follow_tube(Ray& ray, Surface& surface) const {
  const double distance = surface.point.distance;
  if (ray.is_curved) {
    for (int n = ray.rays.num_caustics(ray.direction, distance); n > 0; --n) ray.field *= std::complex<double>(0.0, 1.0);
    // Geometrical optics is singular at a caustic: no tube is narrower than the wave allows.
    surface.tube_area = std::max(std::abs(ray.rays.area(ray.direction, distance)), wavelength_ * ray.leg_length);
  }
  ray.rays.transfer(ray.direction, distance, surface.point.normal);
}

void RayShooter::connect(const Ray& ray, const Surface& surface, Scratch& scratch, PathBlock& block) const {
  const Vec3& point = surface.point.position;
  if ((point - settings_.receiver).norm() < kNearAntenna || (point - settings_.transmitter).norm() < kNearAntenna) {
    ++block.statistics.num_near_antenna;
    return;
  }
  const bool radiates_field = ray.coherent && !surface.material->mirror && surface.response.coherent > 0;
  const bool radiates_power = surface.response.diffuse > 0;
  if (!radiates_field && !radiates_power) return;
  legs_.find(point, surface.point.normal, settings_.receiver, ray.depth < settings_.max_bounces, kOther, scratch.receive,
             block.statistics.num_queries);
  if (scratch.receive.empty()) return;
  if (radiates_field) connect_coherent(ray, surface, scratch, block);
  if (!radiates_power) return;
  if (ray.coherent && ray.chain != kOther) {
    connect_all_pairs(ray, surface, scratch, block);
  } else {
    connect_diffuse(ray, surface, scratch, block);
  }
}

void RayShooter::connect_coherent(const Ray& ray, const Surface& surface, const Scratch& scratch, PathBlock& block) const {
  // `field` holds 1/q for each bounce, the area of the launch alone must not: hence field and not coefficient, and the
  // density without the probabilities.
  const double tube_area = ray.is_curved ? surface.tube_area : ray.leg_length * ray.leg_length;
  const double launch_area = tube_area / (plan_.ray_density(ray.launch_direction, ray.stratum) * surface.cos_incidence);
  // Polarised, all coefficients are in the matrix.
  const std::complex<double> scalar = settings_.is_polarized ? 1.0 : ray.field * surface.response.gamma * surface.response.coherent;
  const std::complex<double> weight = std::complex<double>(0.0, 1.0) * scalar * launch_area;
  for (const Leg& leg : scratch.receive) {
    const bool with_reversal = ray.mirror.mesh >= 0 && opposite_is_invalid(surface, ray.direction, leg.length);
    record(ray, surface, leg, 0, settings_.is_polarized ? weight : weight * leg.gain, with_reversal, block);
  }
}

// One path over the ray's own hits and a receive leg, and its reversal.
void RayShooter::record(const Ray& ray, const Surface& surface, const Leg& leg, uint64_t bits, std::complex<double> weight,
                        bool with_reversal, PathBlock& block) const {
  std::array<Hit, 65> hits;
  std::copy_n(ray.hits.begin(), ray.depth, hits.begin());
  int count = ray.depth;
  if (leg.mirror >= 0) hits[static_cast<size_t>(count++)] = leg.mirror_hit;
  if (leg.mirror < 0) block.add_prefix(0, count, bits, weight, ray.stratum);
  else block.add(hits.data(), count, bits, weight, ray.stratum);
  if (bits == 0) set_columns(ray, surface, leg, block);
  if (!with_reversal) return;
  block.add_reversal(hits.data(), count, bits, weight, ray.stratum);
  if (bits == 0) set_columns(ray, surface, leg, block);
}

// What the last path needs beside its weight, if the scene asks for it.
void RayShooter::set_columns(const Ray& ray, const Surface& surface, const Leg& leg, PathBlock& block) const {
  if (ray.is_curved) block.set_curved_cell(cell_behind_curves(ray, surface));
  if (settings_.is_polarized) block.set_jones(jones_matrix(ray, surface, leg));
}

// From the launched components to those that arrive at the receiver (Paths::jones).
JonesMatrix RayShooter::jones_matrix(const Ray& ray, const Surface& surface, const Leg& leg) const {
  const double frequency = settings_.frequency;
  const ModeCoefficients here = mode_coefficients(*surface.material, frequency, surface.cos_incidence);
  // Replay multiplies by cos_i; a conductor's TM part does not vanish with it, so the quotient is bounded.
  const double scale = surface.response.coherent / std::max(surface.cos_incidence, kPolarizedGrazing);
  const TransverseBasis arrival = transverse_basis(-leg.at_antenna);
  JonesMatrix matrix;
  for (size_t column = 0; column < 2; ++column) {
    FieldVector field = scale * radiated_field(ray.polarized[column], ray.direction, surface.point.normal, leg.to_antenna, here);
    if (leg.mirror >= 0) {
      const Material& material = *mirrors_[static_cast<size_t>(leg.mirror)].material;
      const double cos_mirror = -leg.to_antenna.dot(leg.mirror_normal);
      field = std::sqrt(leg.specular_share) *
              reflected_field(field, leg.to_antenna, leg.mirror_normal, mode_coefficients(material, frequency, cos_mirror));
    }
    matrix[column] = std::complex<float>(field.transpose() * arrival.horizontal.cast<std::complex<double>>());
    matrix[2 + column] = std::complex<float>(field.transpose() * arrival.vertical.cast<std::complex<double>>());
  }
  return matrix;
}

// The launch cell of the ray's own stratum on the triangle that was hit (Paths::curved_cell).
std::array<float, 7> RayShooter::cell_behind_curves(const Ray& ray, const Surface& surface) const {
  const Hit& hit = surface.point.hit;
  const auto [a, b, c] = geometry_.corners(hit.mesh_id, hit.triangle_id);
  const double side = 1.0 / std::sqrt(plan_.lattice_density(ray.stratum));
  // A tube that the caustic limit widened keeps its proportions.
  const double widened = std::sqrt(surface.tube_area / std::max(std::abs(ray.rays.area(ray.direction, 0.0)), 1e-30));
  const double scale = side * std::min(widened, 1e6);
  std::array<float, 7> cell{};
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d at = edge_coordinates(b - a, c - a, surface.point.normal, ray.rays.point[axis] * scale);
    cell[2 * axis] = static_cast<float>(at[0]);
    cell[2 * axis + 1] = static_cast<float>(at[1]);
  }
  const auto turn = [&](int i, int j) { return side * scale * ray.rays.point[i].dot(ray.rays.turn[j]); };
  cell[4] = static_cast<float>(turn(0, 0));
  cell[5] = static_cast<float>(0.5 * (turn(0, 1) + turn(1, 0)));
  cell[6] = static_cast<float>(turn(1, 1));
  return cell;
}

void RayShooter::connect_diffuse(const Ray& ray, const Surface& surface, const Scratch& scratch, PathBlock& block) const {
  const double magnitude = std::sqrt(ray.area * surface.area) * std::abs(surface.response.gamma) * surface.response.diffuse;
  const std::complex<double> weight = ray.coefficient * magnitude * phase_factor(ray);
  const uint64_t bits = ray.diffuse | uint64_t{1} << (ray.depth - 1);
  // Behind a diffuse hit the opposite order is sampled by itself.
  const bool with_reversal = ray.coherent && ray.mirror.mesh >= 0;
  for (const Leg& leg : scratch.receive) record(ray, surface, leg, bits, weight * leg.gain, with_reversal, block);
}

Leg RayShooter::own_leg(const Ray& ray) const {
  Leg leg;
  leg.mirror = ray.chain;
  leg.length = ray.leg_length;
  leg.to_antenna = -ray.direction;
  leg.at_antenna = ray.launch_direction;
  leg.gain = ray.coefficient;
  leg.specular_share = ray.chain_share;
  leg.mirror_hit = ray.hits[0];
  return leg;
}

// The balance weight: one over the number of hits per m^2 that all visible transmit legs together make here.
double RayShooter::material_area(const Ray& ray, const Surface& surface, const std::vector<Leg>& legs) const {
  double hits_per_area = 0.0;
  for (const Leg& leg : legs) {
    const int own_stratum = leg.mirror == ray.chain ? ray.stratum : -1;
    hits_per_area += plan_.ray_density(leg.at_antenna, own_stratum) * leg.specular_share *
                     surface.point.normal.dot(leg.to_antenna) / (leg.length * leg.length);
  }
  return 1.0 / hits_per_area;
}

void RayShooter::connect_all_pairs(const Ray& ray, const Surface& surface, Scratch& scratch, PathBlock& block) const {
  legs_.find(surface.point.position, surface.point.normal, settings_.transmitter, settings_.max_bounces > 1, ray.chain,
             scratch.transmit, block.statistics.num_queries);
  std::erase_if(scratch.transmit, [&](const Leg& leg) { return surface.point.normal.dot(leg.to_antenna) < kGrazing; });
  scratch.transmit.push_back(own_leg(ray));
  const double root_area = std::sqrt(material_area(ray, surface, scratch.transmit));
  const std::complex<double> phase = phase_factor(ray);

  for (const Leg& in : scratch.transmit) {
    const Vec3 arrival = -in.to_antenna;
    const SurfaceResponse response =
        respond(*surface.material, settings_.frequency, surface.point.normal.dot(in.to_antenna),
                polarization_mode(settings_.polarization, arrival, surface.point.normal));
    const std::complex<double> weight = root_area * std::abs(response.gamma) * response.diffuse * in.gain * phase;
    const int first = in.mirror >= 0 ? 1 : 0;
    const uint64_t bits = uint64_t{1} << first;
    for (const Leg& out : scratch.receive) {
      const int count = first + 1 + (out.mirror >= 0 ? 1 : 0);
      if (count > settings_.max_bounces) continue;
      if (out.mirror < 0 && in.mirror == ray.chain) {
        block.add_prefix(0, count, bits, weight, ray.stratum);
      } else if (out.mirror < 0 && in.mirror < 0) {
        block.add_prefix(ray.depth - 1, count, bits, weight, ray.stratum);
      } else {
        std::array<Hit, 3> hits{in.mirror_hit};
        hits[static_cast<size_t>(first)] = surface.point.hit;
        if (out.mirror >= 0) hits[static_cast<size_t>(first + 1)] = out.mirror_hit;
        block.add(hits.data(), count, bits, weight * out.gain, ray.stratum);
      }
    }
  }
}

RayShooter::Odds RayShooter::odds_of(const Surface& surface) const {
  const SurfaceResponse& response = surface.response;
  const Odds shares{response.coherent * response.coherent, response.diffuse * response.diffuse};
  const bool is_asked = settings_.specular_probability > 0 && shares.specular > 0 && shares.diffuse > 0;
  // The balance weight over the legs of mirrors (LegFinder) counts on their shares.
  if (!is_asked || surface.material->mirror) return shares;
  return {settings_.specular_probability, 1.0 - settings_.specular_probability};
}

bool RayShooter::bounce(Ray& ray, const Surface& surface) const {
  const SurfaceResponse& response = surface.response;
  const Odds odds = odds_of(surface);
  const double survival = ray.depth < kRouletteBounce ? 1.0 : std::min(1.0, std::norm(response.gamma));
  const auto dimension = static_cast<uint32_t>(2 * ray.depth);
  const bool is_open = odds.specular > 0 && odds.diffuse > 0;
  bool specular = odds.diffuse == 0;
  if (is_open || survival < 1) {
    const auto coin = uniform2(settings_.seed, Stream::kBounce, static_cast<uint64_t>(ray.index), dimension);
    if (coin[1] >= survival) return false;
    if (is_open) specular = coin[0] < odds.specular;
  }
  ray.from = geometry_.lifted(surface.point.position, surface.point.normal);
  if (specular) bounce_specular(ray, surface, odds.specular * survival);
  else bounce_diffuse(ray, surface, odds.diffuse * survival);
  if (specular) ray.chain_share = odds.specular;
  return std::norm(ray.coefficient) > 0 && ray.area < kLargestArea;
}

// `probability`: with which the ray goes on this way.
void RayShooter::bounce_specular(Ray& ray, const Surface& surface, double probability) const {
  const SurfaceResponse& response = surface.response;
  const RayHit& point = surface.point;
  if (ray.coherent) reflect_field(ray, surface, probability);
  const MirrorBounce bounced{static_cast<int>(point.hit.mesh_id), surface.cos_incidence, curvature_along(point, ray.direction)};
  ray.direction = (ray.direction + 2.0 * surface.cos_incidence * point.normal).normalized();
  ray.coefficient *= response.gamma * response.coherent;
  ray.leg_density *= probability;
  const int mirror = mirror_of_mesh_[point.hit.mesh_id];
  ray.chain = ray.depth == 1 && mirror >= 0 ? mirror : kOther;
  ray.last_was_mirror = mirror < 0;
  if (mirror < 0) ray.mirror = bounced;
}

// Field, polarisation and tube of a coherent ray, before its direction changes.
void RayShooter::reflect_field(Ray& ray, const Surface& surface, double probability) const {
  const SurfaceResponse& response = surface.response;
  const RayHit& point = surface.point;
  ray.field *= response.gamma * response.coherent / probability;
  if (settings_.is_polarized) {
    const ModeCoefficients modes = mode_coefficients(*surface.material, settings_.frequency, surface.cos_incidence);
    for (FieldVector& field : ray.polarized) {
      field = response.coherent / probability * reflected_field(field, ray.direction, point.normal, modes);
    }
  }
  if (has_smooth_) {
    const Mat3 flat = Mat3::Zero();
    ray.rays.reflect(ray.direction, point.normal, point.is_smooth ? point.curvature : flat);
    ray.is_curved = ray.is_curved || point.is_smooth;
  }
}

void RayShooter::bounce_diffuse(Ray& ray, const Surface& surface, double probability) const {
  const Vec3& normal = surface.point.normal;
  ray.coefficient *= std::abs(surface.response.gamma) * surface.response.diffuse;
  ray.area *= surface.area;
  ray.diffuse |= uint64_t{1} << (ray.depth - 1);
  ray.coherent = false;
  ray.chain = kOther;
  ray.mirror = MirrorBounce{};
  ray.last_was_mirror = false;
  const auto dimension = static_cast<uint32_t>(2 * ray.depth + 1);
  const auto random = uniform2(settings_.seed, Stream::kBounce, static_cast<uint64_t>(ray.index), dimension);
  ray.direction = cosine_lobe(normal, random);
  ray.leg_length = 0.0;
  ray.leg_density = probability * std::max(normal.dot(ray.direction), 1e-9) / kPi;
}

std::complex<double> RayShooter::phase_factor(const Ray& ray) const {
  const double turn = uniform2(settings_.seed, Stream::kPhase, static_cast<uint64_t>(ray.index),
                               static_cast<uint32_t>(ray.depth))[0];
  return std::polar(1.0, kTwoPi * turn);
}

}  // namespace echopath
