// Finds the matrices of polarised paths (Paths::jones) along a ray.
#include <cmath>

#include "echopath/em/polarization/mirrored_fields.h"
#include "echopath/em/polarization/transverse_formula.h"
#include "echopath/record/hit_points.h"
#include "echopath/trace/sbr/weight.h"

namespace echopath {
namespace {

void reflect_at(const SurfaceHit& surface, const Vec3& direction, FieldPair& fields) {
  reflect_fields(fields, direction, surface.point.normal, *surface.model, surface.response.coherent);
}

// Returns the fields that a diffuse hit scatters when fields travel along `in`. Its random axis is bound to the hit, as its
// phase is.
FieldPair scattered(const SurfaceHit& surface, const FieldPair& fields, const Vec3& in, const Vec3& out) {
  const double cos_incidence = -in.dot(surface.point.normal);
  const double reflection = diffuse_coefficient(surface.model->respond(cos_incidence, PolarizationMode::kTe));
  Depolarization turn{surface.material->cross_polarization, 0.0};
  if (turn.cross_share > 0) turn.axis = kPi * surface.samples.axis_sample;
  FieldPair out_fields;
  for (size_t launch = 0; launch < 2; ++launch) {
    out_fields[launch] = scattered_field(fields[launch], in, out, reflection, turn);
  }
  return out_fields;
}

// Applies the transpose of the scattering of fields that come along -`out` and leave along -`in`: so a chain of such hits is
// read from its other end.
FieldPair scattered_back(const SurfaceHit& surface, const FieldPair& fields, const Vec3& in, const Vec3& out) {
  const FieldPair axes = launched_fields(out);
  const FieldPair back = scattered(surface, axes, -out, -in);
  FieldPair out_fields;
  for (size_t launch = 0; launch < 2; ++launch) {
    const std::complex<double> along[] = {back[0].transpose() * fields[launch], back[1].transpose() * fields[launch]};
    out_fields[launch] = along[0] * axes[0] + along[1] * axes[1];
  }
  return out_fields;
}

// Returns the components along the axes of `to` of the axes of `from` after the least rotation between both directions.
Eigen::Matrix2d carried_axes(const Vec3& from, const Vec3& to) {
  const AxesAcross<double> behind = axes_across<ScalarMath>(unpacked(to));
  const auto [horizontal, vertical] = basis_across(unpacked(from));
  const TransverseOf<double> of_horizontal = transverse_of<ScalarMath>(horizontal, unpacked(from), behind);
  const TransverseOf<double> of_vertical = transverse_of<ScalarMath>(vertical, unpacked(from), behind);
  return Eigen::Matrix2d{{of_horizontal.horizontal, of_vertical.horizontal}, {of_horizontal.vertical, of_vertical.vertical}};
}

// Returns a matrix whose axes at both ends were carried.
JonesMatrix with_carried_axes(const JonesMatrix& matrix, const Eigen::Matrix2d& at_start, const Eigen::Matrix2d& at_end) {
  Eigen::Matrix2cd entries;
  for (int i = 0; i < 4; ++i) entries(i / 2, i % 2) = std::complex<double>(matrix[i]);
  entries = at_end.cast<std::complex<double>>() * entries * at_start.transpose().cast<std::complex<double>>();
  JonesMatrix out;
  for (int i = 0; i < 4; ++i) out[i] = std::complex<float>(entries(i / 2, i % 2));
  return out;
}

}  // namespace

void JonesWeight::reflect(Ray& ray, const SurfaceHit& surface) const {
  reflect_at(surface, ray.direction, ray.fields);
  if (!ray.coherent && ray.chain.back) reflect_at(surface, ray.direction, ray.chain.fields);
}

void JonesWeight::begin_chain(Ray& ray) const {
  if (!ray.chain.back) return;
  ray.chain.fields = ray.sequence == kOther ? ray.fields : incident_over(*ray.chain.back);
}

void JonesWeight::scatter(Ray& ray, const SurfaceHit& surface, const Vec3& out) const {
  DiffuseChain& chain = ray.chain;
  if (chain.back) {
    const bool is_first = ray.depth - 1 == chain.first;
    const Vec3 in = is_first ? Vec3(-chain.back->to_antenna) : ray.direction;
    chain.fields = scattered_back(surface, chain.fields, in, out);
  }
  ray.fields = scattered(surface, ray.fields, ray.direction, out);
}

// Carries fields at the antenna over a leg to its surface point.
FieldPair JonesWeight::fields_over(const Leg& leg, FieldPair fields) const {
  Vec3 direction = leg.at_antenna;
  for (int k = leg.num_bounces; k-- > 0;) {
    const LegBounce& bounce = leg.bounces[k];
    const Mirror& mirror = context_.mirrors[bounce.mirror];
    const SurfaceModel& model = context_.surfaces.model(mirror.mesh_id);
    reflect_fields(fields, direction, bounce.normal, model, std::sqrt(bounce.specular_share));
    direction = mirror.mirrored(direction);
  }
  return fields;
}

// Returns the fields of both launches along a leg at its surface point.
FieldPair JonesWeight::incident_over(const Leg& leg) const { return fields_over(leg, launched_fields(leg.at_antenna)); }

// Returns those fields at a surface point along which a receiver at the end of a leg sees its two components: by reciprocity
// they are its own axes carried to the point.
FieldPair JonesWeight::axes_over(const Leg& leg) const { return fields_over(leg, launched_fields(-leg.at_antenna)); }

void JonesWeight::find_receive_axes(Connection& at) const {
  at.fields.axes.clear();
  for (const Leg& leg : at.legs.receive) at.fields.axes.push_back(axes_over(leg));
}

void JonesWeight::set_coherent_matrix(Connection& at, const Leg& leg) const {
  const SurfaceHit& surface = at.surface;
  const Vec3& normal = surface.point.normal;
  const double scale = surface.response.coherent * polarized_scale(surface.cos_incidence, normal.dot(leg.to_antenna));
  FieldPair fields = at.ray.fields;
  radiate_fields(fields, at.ray.direction, normal, leg.to_antenna, *surface.model, scale);
  at.block.set_jones(components(fields, at.axes_of(leg)));
}

void JonesWeight::set_diffuse_matrix(Connection& at, const Leg& leg) const {
  const FieldPair fields = scattered(at.surface, at.ray.fields, at.ray.direction, leg.to_antenna);
  at.block.set_jones(components(fields, at.axes_of(leg)));
}

void JonesWeight::exchange_antennas(Connection& at, const Leg& leg) const {
  const Vec3 &transmitter = context_.settings.transmitter, &receiver = context_.settings.receiver;
  if (transmitter == receiver) return;
  std::vector<int> mirrors;
  // Returns the direction in which a wave leaves an antenna that reaches a point over the mirrors.
  const auto departure = [&](const Vec3& antenna, const Vec3& point) {
    const auto chain = chain_of(context_.mirrors, mirrors);
    return mirrored_over_reversed(chain, (point - image_over(chain, antenna)).normalized());
  };
  const Hit* hit = at.ray.hits.data();
  for (; context_.surfaces.mirror(*hit) >= 0; ++hit) mirrors.push_back(context_.surfaces.mirror(*hit));
  const Vec3 first = hit_point(context_.geometry.corners(hit->mesh_id, hit->triangle_id), *hit);
  const Eigen::Matrix2d at_start = carried_axes(departure(transmitter, first), departure(receiver, first));
  mirrors.clear();
  for (int k = leg.num_bounces; k-- > 0;) mirrors.push_back(leg.bounces[k].mirror);
  const Eigen::Matrix2d at_end = carried_axes(-leg.at_antenna, -departure(transmitter, at.surface.point.position));
  at.block.set_jones(with_carried_axes(at.block.jones.back(), at_start, at_end));
}

// Follows the ray's way from the receiver to the transmitter at the end of `leg`, for the opposite order of its chain.
void JonesWeight::set_reversed_matrix(Connection& at, const Leg& leg) const {
  const FieldPair fields = scattered_back(at.surface, at.ray.chain.fields, at.ray.direction, leg.to_antenna);
  at.block.set_jones(components(fields, axes_over(leg)));
}

}  // namespace echopath
