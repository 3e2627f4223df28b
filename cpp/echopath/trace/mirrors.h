#pragma once
// The planes flagged `mirror`, their images and the legs between a surface point and an antenna.
#include <vector>

#include "echopath/em/surface_response.h"
#include "echopath/trace/embree_scene.h"

namespace echopath {

struct Mirror {
  uint32_t mesh_id = 0;
  Vec3 point;   // on the plane, relative to the trace origin
  Vec3 normal;  // unit
  const Material* material = nullptr;

  double signed_distance(const Vec3& p) const { return normal.dot(p - point); }
  Vec3 image(const Vec3& p) const { return p - 2.0 * signed_distance(p) * normal; }
  Vec3 reflect(const Vec3& direction) const { return direction - 2.0 * normal.dot(direction) * normal; }
};

// All mirror meshes of the scene. Raises invalid_argument naming a mesh that is not flat (0.1 mm plus 1e-6 of its size).
std::vector<Mirror> find_mirrors(const Scene& scene, const EmbreeScene& geometry);

// A straight leg or one over a mirror, between a surface point and an antenna, as seen from the point.
struct Leg {
  int mirror = -1;            // index into the mirrors, -1: direct
  double length = 0.0;        // m, unfolded
  Vec3 to_antenna;            // unit, from the point toward the antenna or its image
  Vec3 at_antenna;            // unit, from the antenna toward the point or its image
  std::complex<double> gain = 1.0;  // field factor Gamma_m s_m of the mirror
  Vec3 mirror_normal;               // unit, on the lit side, if mirror >= 0
  double specular_share = 1.0;      // s_m^2: the probability with which a ray goes on specularly
  Hit mirror_hit{};           // where the leg meets the mirror, if mirror >= 0
};

// Decides between TE and TM at a hit by the transmit polarisation (scalar mode): TE where the part of `polarization`
// across `direction` lies within 45 degrees of the normal of the plane of incidence. TM where the field would lie
// along the direction of travel: only bounces in the plane of the field turn a ray that way.
PolarizationMode polarization_mode(const Vec3& polarization, const Vec3& direction, const Vec3& normal);

class LegFinder {
 public:
  LegFinder(const EmbreeScene& geometry, const std::vector<Mirror>& mirrors, double frequency, const Vec3& polarization)
      : geometry_(geometry), mirrors_(mirrors), frequency_(frequency), polarization_(polarization) {}

  // All visible legs between `point` (unit normal on the lit side) and `antenna`; over mirrors only if `with_mirrors`.
  // The order is fixed: direct first, then by mirror index. `skip`: a leg that is left out (index of a mirror, -1 the direct
  // one), -2 for none. Queries made are added to `num_queries`.
  void find(const Vec3& point, const Vec3& normal, const Vec3& antenna, bool with_mirrors, int skip,
            std::vector<Leg>& legs, int64_t& num_queries) const;

 private:
  bool over_mirror(int mirror, const Vec3& point, const Vec3& normal, const Vec3& antenna, Leg& leg,
                   int64_t& num_queries) const;

  const EmbreeScene& geometry_;
  const std::vector<Mirror>& mirrors_;
  double frequency_;
  Vec3 polarization_;
};

}  // namespace echopath
