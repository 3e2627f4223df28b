// Everything that makes the matrices of polarised paths (Paths::jones) along a ray.
//
// Coherent paths hold the true reflections and the vector form of physical optics. Diffuse paths hold the true reflections of
// their mirrors and specular bounces, and at each diffuse hit the split of power between both polarisations
// (em/jones.h, scattered_field). In a chain of diffuse hits these matrices are multiplied: the mean power is that of every
// split in turn, the phases between two polarisations are those of one chance.
#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/trace/sbr_state.h"

namespace echopath {
namespace {

constexpr double kPolarizedGrazing = 0.05;  // cosine of incidence over that of radiation, below which coherent_matrix stays bounded

// Fields behind a mirror or specular bounce of the given specular share of power.
void reflect_all(FieldPair& fields, const Vec3& direction, const Vec3& normal, const Material& material, double frequency,
                 double specular_share) {
  const ModeCoefficients modes = mode_coefficients(material, frequency, -direction.dot(normal));
  for (FieldVector& field : fields) field = std::sqrt(specular_share) * reflected_field(field, direction, normal, modes);
}

}  // namespace

// Before the ray's direction changes.
void RayShooter::reflect_polarized(const Ray& ray, const Surface& surface, FieldPair& fields) const {
  const double coherent = surface.response.coherent;
  reflect_all(fields, ray.direction, surface.point.normal, *surface.material, settings_.frequency, coherent * coherent);
}

void RayShooter::scatter_polarized(Ray& ray, const Surface& surface, const Vec3& out) const {
  ray.polarized = scattered(surface, ray.polarized, ray.direction, out);
}

// What a diffuse hit makes of fields that travel along `in`. Its random axis is bound to the hit, like its phase.
FieldPair RayShooter::scattered(const Surface& surface, const FieldPair& fields, const Vec3& in,
                                const Vec3& out) const {
  const double cos_incidence = -in.dot(surface.point.normal);
  const double reflection = diffuse_coefficient(surface.model->respond(cos_incidence, PolarizationMode::kTe));
  Depolarization turn{surface.material->cross_polarization, 0.0};
  if (turn.cross_share > 0) turn.axis = kPi * surface.chance.axis_coin;
  FieldPair out_fields;
  for (size_t launch = 0; launch < 2; ++launch) {
    out_fields[launch] = scattered_field(fields[launch], in, out, reflection, turn);
  }
  return out_fields;
}

// The transpose of what the hit makes of fields that come along -`out` and leave along -`in`: a chain of such hits, read
// from its other end.
FieldPair RayShooter::scattered_back(const Surface& surface, const FieldPair& fields, const Vec3& in,
                                     const Vec3& out) const {
  const FieldPair axes = launched_fields(out);
  const FieldPair back = scattered(surface, axes, -out, -in);
  FieldPair out_fields;
  for (size_t launch = 0; launch < 2; ++launch) {
    const std::complex<double> along[] = {back[0].transpose() * fields[launch], back[1].transpose() * fields[launch]};
    out_fields[launch] = along[0] * axes[0] + along[1] * axes[1];
  }
  return out_fields;
}

// What fields at the antenna become on the way over a leg to its surface point.
FieldPair RayShooter::fields_over(const Leg& leg, FieldPair fields) const {
  Vec3 direction = leg.at_antenna;
  for (int k = leg.num_bounces; k-- > 0;) {
    const LegBounce& bounce = leg.bounces[static_cast<size_t>(k)];
    const Mirror& mirror = mirrors_[static_cast<size_t>(bounce.mirror)];
    reflect_all(fields, direction, bounce.normal, *mirror.material, settings_.frequency, bounce.specular_share);
    direction = mirror.reflect(direction);
  }
  return fields;
}

// Fields at a surface point of launches along a leg to it.
FieldPair RayShooter::incident_over(const Leg& leg) const { return fields_over(leg, launched_fields(leg.at_antenna)); }

// Along which of the fields that leave a surface point a receiver at the end of a leg sees its two components: by
// reciprocity what its own axes become on the way to the point.
FieldPair RayShooter::axes_over(const Leg& leg) const { return fields_over(leg, launched_fields(-leg.at_antenna)); }

// Components at the receiver of fields that leave a surface point along a leg.
JonesMatrix RayShooter::received_over(const Leg& leg, const FieldPair& fields) const {
  return components(fields, axes_over(leg));
}

JonesMatrix RayShooter::coherent_matrix(const Ray& ray, const Surface& surface, const Leg& leg) const {
  const ModeCoefficients modes = mode_coefficients(*surface.material, settings_.frequency, surface.cos_incidence);
  // Replay multiplies by cos_i; a conductor's TM part goes with the cosine of radiation instead, so the quotient is bounded.
  const double bound = kPolarizedGrazing * surface.point.normal.dot(leg.to_antenna);
  const double scale = surface.response.coherent / std::max(surface.cos_incidence, bound);
  FieldPair fields;
  for (size_t launch = 0; launch < 2; ++launch) {
    fields[launch] = scale * radiated_field(ray.polarized[launch], ray.direction, surface.point.normal, leg.to_antenna, modes);
  }
  return received_over(leg, fields);
}

JonesMatrix RayShooter::diffuse_matrix(const Ray& ray, const Surface& surface, const Leg& leg) const {
  return received_over(leg, scattered(surface, ray.polarized, ray.direction, leg.to_antenna));
}

// From the receiver along the ray's way to the transmitter at the end of `leg`, for the opposite order of its chain.
JonesMatrix RayShooter::opposite_matrix(const Ray& ray, const Surface& surface, const Leg& leg, const Chain& chain) const {
  return received_over(leg, scattered_back(surface, chain.fields, ray.direction, leg.to_antenna));
}

// Of all pairs of legs, each of which is followed once. The ray's own way to the hit is one of the transmit legs.
void RayShooter::follow_legs(const Ray& ray, Scratch& scratch) const {
  scratch.incident.clear();
  scratch.axes.clear();
  for (const Leg& in : scratch.transmit) scratch.incident.push_back(in.sequence == ray.sequence ? ray.polarized : incident_over(in));
  for (const Leg& out : scratch.receive) scratch.axes.push_back(axes_over(out));
}

JonesMatrix RayShooter::pair_matrix(const Surface& surface, const Scratch& scratch, size_t in, size_t out) const {
  const Vec3 arrival = -scratch.transmit[in].to_antenna;
  return components(scattered(surface, scratch.incident[in], arrival, scratch.receive[out].to_antenna), scratch.axes[out]);
}

}  // namespace echopath
