// Everything that makes the matrices of polarised paths (Paths::jones) along a ray.
#include <algorithm>
#include <cmath>

#include "echopath/trace/sbr_state.h"

namespace echopath {
namespace {

constexpr double kPolarizedGrazing = 0.05;  // cosine of incidence that bounds the quotient of coherent_matrix

}  // namespace

// Specular bounce, before the ray's direction changes.
void RayShooter::reflect_polarized(Ray& ray, const Surface& surface) const {
  const ModeCoefficients modes = mode_coefficients(*surface.material, settings_.frequency, surface.cos_incidence);
  for (FieldVector& field : ray.polarized) {
    field = surface.response.coherent * reflected_field(field, ray.direction, surface.point.normal, modes);
  }
}

// Components at the receiver of fields that leave the last material point along a leg.
JonesMatrix RayShooter::received_over(const Leg& leg, FieldPair fields) const {
  if (leg.mirror >= 0) {
    const Material& material = *mirrors_[static_cast<size_t>(leg.mirror)].material;
    const double cos_mirror = -leg.to_antenna.dot(leg.mirror_normal);
    const ModeCoefficients modes = mode_coefficients(material, settings_.frequency, cos_mirror);
    for (FieldVector& field : fields) {
      field = std::sqrt(leg.specular_share) * reflected_field(field, leg.to_antenna, leg.mirror_normal, modes);
    }
  }
  return arriving_components(fields, -leg.at_antenna);
}

JonesMatrix RayShooter::coherent_matrix(const Ray& ray, const Surface& surface, const Leg& leg) const {
  const ModeCoefficients modes = mode_coefficients(*surface.material, settings_.frequency, surface.cos_incidence);
  // Replay multiplies by cos_i; a conductor's TM part does not vanish with it, so the quotient is bounded.
  const double scale = surface.response.coherent / std::max(surface.cos_incidence, kPolarizedGrazing);
  FieldPair fields;
  for (size_t launch = 0; launch < 2; ++launch) {
    fields[launch] = scale * radiated_field(ray.polarized[launch], ray.direction, surface.point.normal, leg.to_antenna, modes);
  }
  return received_over(leg, fields);
}

}  // namespace echopath
