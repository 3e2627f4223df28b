#include "echopath/replay/diffuse_chain.h"

#include <cmath>

#include "echopath/base/constants.h"

namespace echopath {
namespace {

// Area of the triangles over that at the trace, of all diffuse hits together.
double diffuse_area_ratio(const LocalPath& path, const PosedHit* hits) {
  double ratio = 1.0;
  for (int k = path.first_material; k <= path.last_material; ++k) {
    if (path.is_diffuse(k)) ratio *= hits[k].area_ratio;
  }
  return ratio;
}

}  // namespace

DiffuseInner diffuse_inner(const LocalPath& path, const PosedHit* hits, const InnerPart& inner) {
  DiffuseInner out;
  out.begins_specular = inner.first_diffuse != path.first_material;
  out.is_single = inner.first_diffuse == path.last_material;
  out.to_first = inner.to_first_diffuse;
  out.root_cos_first = std::copysign(std::sqrt(std::abs(inner.cos_in_first)), inner.cos_in_first);
  out.factor = inner.lit ? std::sqrt(inner.power_factor * diffuse_area_ratio(path, hits)) : 0.0;
  out.first_sign = std::copysign(1.0, inner.cos_out_first);
  out.last_sign = std::copysign(1.0, inner.cos_in_last);
  return out;
}

double diffuse_scale(const RadioConstants& radio) {
  return std::sqrt(radio.transmit_power / kPi) * radio.wavelength / (4.0 * kPi);
}

}  // namespace echopath
