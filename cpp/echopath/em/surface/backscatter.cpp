#include "echopath/em/surface/backscatter.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/em/surface/surface_response.h"

namespace echopath {

double backscatter_coefficient(const Material& material, double frequency, double cos_incidence) {
  const SurfaceModel model(material, frequency);
  const SurfaceResponse response = model.respond(cos_incidence, PolarizationMode::kTe);
  const double scattered = response.facet * response.diffuse;
  const Vec3 back(std::sqrt(std::max(0.0, 1.0 - cos_incidence * cos_incidence)), 0.0, cos_incidence);
  const double co_polar = 1.0 - material.cross_polarization;
  return 4.0 * kPi * co_polar * cos_incidence * scattered * scattered * model.lobe()({-back, Vec3::UnitZ(), back});
}

}  // namespace echopath
