#include "echopath/replay/evaluate/inner_part.h"

#include <cmath>

#include "echopath/base/constants.h"

namespace echopath {
namespace {

constexpr double kLambert = 1.0 / kPi;

// Returns the area of the triangles over that at the trace, multiplied over all diffuse hits.
double diffuse_area_ratio(const LocalPath& path, const PosedHit* hits) {
  double ratio = 1.0;
  for (int k = path.first_material; k <= path.last_material; ++k) {
    if (path.is_diffuse(k)) ratio *= hits[k].area_ratio;
  }
  return ratio;
}

}  // namespace

InnerPart inner_part(const LocalPath& path, const PosedHit* hits) {
  InnerPart inner;
  inner.first_diffuse = path.is_diffuse(path.first_material) ? path.first_material : -1;
  double since_diffuse = 0.0, cos_out = 0.0;
  int previous = path.first_material;
  for (int k = previous + 1; k <= path.last_material; ++k) {
    if (path.is_image(k)) continue;
    const UnfoldedLeg leg = inner_leg(hits, previous, k);
    inner.length += leg.length;
    since_diffuse += leg.length;
    if (path.is_diffuse(previous)) {
      cos_out = hits[previous].normal.dot(leg.departure);
      if (previous == inner.first_diffuse) inner.cos_out_first = cos_out;
      else if (cos_out * inner.cos_in_last <= 0) inner.is_lit = false;
    }
    if (path.is_diffuse(k)) {
      const double cos_in = -hits[k].normal.dot(leg.arrival);
      if (inner.first_diffuse < 0) {
        inner.first_diffuse = k;
        inner.to_first_diffuse = since_diffuse;
        inner.cos_in_first = cos_in;
      } else {
        inner.power_factor *= kLambert * std::abs(cos_out * cos_in) / (since_diffuse * since_diffuse);
        inner.cos_in_last = cos_in;
      }
      since_diffuse = 0.0;
    }
    inner.last_arrival = leg.arrival;
    previous = k;
  }
  return inner;
}

DiffuseInner diffuse_inner(const LocalPath& path, const PosedHit* hits, const InnerPart& inner) {
  DiffuseInner out;
  out.begins_specular = inner.first_diffuse != path.first_material;
  out.is_single = inner.first_diffuse == path.last_material;
  out.to_first = inner.to_first_diffuse;
  out.root_cos_first = std::copysign(std::sqrt(std::abs(inner.cos_in_first)), inner.cos_in_first);
  out.factor = inner.is_lit ? std::sqrt(inner.power_factor * diffuse_area_ratio(path, hits)) : 0.0;
  out.first_sign = std::copysign(1.0, inner.cos_out_first);
  out.last_sign = std::copysign(1.0, inner.cos_in_last);
  return out;
}

}  // namespace echopath
