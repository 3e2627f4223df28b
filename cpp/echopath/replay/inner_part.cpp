#include "echopath/replay/inner_part.h"

#include <cmath>

#include "echopath/base/constants.h"

namespace echopath {
namespace {

constexpr double kLambert = 1.0 / kPi;

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
      else if (cos_out * inner.cos_in_last <= 0) inner.lit = false;
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

}  // namespace echopath
