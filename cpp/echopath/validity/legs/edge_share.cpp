#include "echopath/validity/legs/edge_share.h"

#include <algorithm>
#include <array>

#include "echopath/trace/mirrors/plane_bounces.h"

namespace echopath {

bool is_over_unflagged_planes(const LocalPath& path, const PathPreparer& preparer) {
  return path.count > 0 && path.first_material < 0 && !preparer.is_mirror(path.hits[0].mesh_id);
}

std::optional<EdgeShare> find_edge_share(const EmbreeScene& geometry, const LocalPath& path, const PosedHit* hits,
                                         const PosedAntenna& start, const PosedAntenna& end, double wavelength) {
  LegTester tester(geometry, path, hits);
  tester.test_images(start.position, end.position);
  if (!tester.meets_all_images()) return std::nullopt;
  PlaneBounces bounces(geometry, start, end);
  for (int k = 0; k < path.count; ++k) bounces.add(tester.image_hit(k), tester.image_point(k), hits[k].normal);
  EdgeShare found;
  for (int k = 0; k < path.count; ++k) {
    const Vec3 shift = tester.image_point(k) - hits[k].point;
    Eigen::Vector2d zones;
    const std::array<ZoneAxis, 2> axes = zone_axes(bounces.view(k), wavelength);
    for (int i = 0; i < 2; ++i) zones[i] = shift.dot(axes[i].along) / axes[i].half;
    found.slide = std::max(found.slide, zones.norm());
  }
  int64_t num_queries = 0;  // of which no statistics are kept here
  found.share = bounces.field_beside_edges(wavelength, num_queries);
  return found;
}

}  // namespace echopath
