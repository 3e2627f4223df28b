#pragma once
// Finds the legs between a point on an edge and an antenna over planes that nobody flagged, by the image method.
#include <complex>
#include <optional>
#include <vector>

#include "echopath/trace/edges/lit_planes.h"
#include "echopath/trace/sbr/sbr_settings.h"

namespace echopath {

// Describes a leg between a point on an edge and an antenna over planes, and the field that it carries.
struct PlaneLeg {
  std::vector<RayHit> bounces;      // from the point toward the antenna, each with its normal on the lit side
  double length = 0.0;              // m, unfolded
  Vec3 to_antenna, at_antenna;      // unit: from the point toward the image of the antenna, and from the antenna
  std::complex<double> gain = 1.0;  // field factor: product of Gamma s of the planes, as of flagged mirrors (legs.h)
  double share = 1.0;               // of the field: half at the rim of a plane, less where a plane is smaller than its zone
  double first_cover = 1.0;         // share of the Fresnel zone that the plane next to the antenna covers
};

// Finds legs over planes. Its functions are thread-safe. All arguments must outlive it.
class PlaneLegFinder {
 public:
  PlaneLegFinder(const Scene& scene, const EmbreeScene& geometry, const LitPlanes& lit, const SbrSettings& settings)
      : scene_(scene), geometry_(geometry), lit_(lit), settings_(settings) {}
  // Returns the leg over the mirrors of `over` to the antenna where it is free; the point is lifted along `outward` first. A
  // leg through the rim of a plane, or past the edge of what hides it, has half of the field, so that it does not depend on
  // rounding.
  std::optional<PlaneLeg> find(const Vec3& point, const Vec3& outward, const Vec3& antenna, const LitPlane& over,
                               int64_t& num_queries) const;
  // Returns the share of its Fresnel zone that a surface covers as a mirror, for a wave that arrives along `arrival`.
  double cover_of(const RayHit& point, const Vec3& arrival, double before, double behind, int64_t& num_queries) const;

  // Returns the field that a wave from the point has behind the first bounce, over that of an endless plane: what the rims
  // of the surface leave of it, where the inside of a corner counts as a rim too.
  std::complex<double> field_beside_rims(const Vec3& point, const Vec3& antenna, const PlaneLeg& leg,
                                         int64_t& num_queries) const;

 private:
  const Plane& plane(int index) const { return lit_.planes()[index]; }
  bool follow(const Vec3& point, const Vec3& lift, const Vec3& antenna, const std::vector<Vec3>& images,
              const LitPlane& over, PlaneLeg& leg, int64_t& num_queries) const;
  bool bounce(const Vec3& from, const Vec3& position, const Vec3& image, int index, RayHit& met, int64_t& num_queries) const;
  void weigh(const Vec3& point, const Vec3& antenna, PlaneLeg& leg, int64_t& num_queries) const;

  const Scene& scene_;
  const EmbreeScene& geometry_;
  const LitPlanes& lit_;
  const SbrSettings& settings_;
};

}  // namespace echopath
