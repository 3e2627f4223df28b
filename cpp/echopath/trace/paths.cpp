#include "echopath/trace/paths.h"

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"

namespace echopath {
namespace {

template <class T>
std::vector<T> kept(const std::vector<T>& values, const std::vector<uint8_t>& keep) {
  std::vector<T> out;
  for (size_t i = 0; i < keep.size(); ++i) {
    if (keep[i]) out.push_back(values[i]);
  }
  return out;
}

}  // namespace

double Stratum::solid_angle() const { return kTwoPi * versine; }

double Stratum::ray_density() const { return static_cast<double>(num_rays) / solid_angle(); }

bool Stratum::contains(const Vec3& direction) const { return 0.5 * (direction - axis).squaredNorm() <= versine; }

Paths Paths::select(const std::vector<uint8_t>& keep) const {
  require(static_cast<int64_t>(keep.size()) == num_paths(), "keep", "must have one entry per path", keep.size());
  Paths out;
  out.hits = hits;
  out.offsets = kept(offsets, keep);
  out.num_bounces = kept(num_bounces, keep);
  out.diffuse = kept(diffuse, keep);
  out.weight = kept(weight, keep);
  out.stratum = kept(stratum, keep);
  out.batch = kept(batch, keep);
  out.flags = kept(flags, keep);
  out.scene = scene;
  out.radar = radar;
  out.frame = frame;
  return out;
}

}  // namespace echopath
