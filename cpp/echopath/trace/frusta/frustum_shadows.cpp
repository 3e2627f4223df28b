#include "echopath/trace/frusta/frustum_shadows.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace echopath {
namespace {

constexpr double kSameCorner = 1e-6;  // m: the edge between corners this near has no direction
constexpr double kOffPlane = 1e-6;    // m: occluders lie this far before the mirror's plane and behind that of the last one
constexpr double kBefore = 1e-3;      // m: a surface this near to the mirror does not hide it
constexpr int kMaxLooks = 24;         // rays for one window; parts that they do not look at count as seen,
                                      // so that no path is lost
constexpr size_t kMaxPieces = 24;     // parts into which shadows cut one window; further shadows are not cut out

using Polygons = std::vector<std::vector<Vec3>>;

Vec3 centre_of(const std::vector<Vec3>& polygon) {
  Vec3 centre = Vec3::Zero();
  for (const Vec3& corner : polygon) centre += corner / static_cast<double>(polygon.size());
  return centre;
}

bool is_same_corner(const Vec3& a, const Vec3& b) { return (a - b).squaredNorm() <= kSameCorner * kSameCorner; }

// Appends a corner, unless it coincides with the one before.
void add_corner(const Vec3& corner, std::vector<Vec3>& polygon) {
  if (polygon.empty() || !is_same_corner(corner, polygon.back())) polygon.push_back(corner);
}

// Ends a polygon of such corners; a mere line is left empty.
void close(std::vector<Vec3>& polygon) {
  if (polygon.size() > 1 && is_same_corner(polygon.front(), polygon.back())) polygon.pop_back();
  if (polygon.size() < 3) polygon.clear();
}

// Returns the polygon without corners that coincide.
std::vector<Vec3> without_twins(const std::vector<Vec3>& polygon) {
  std::vector<Vec3> out;
  for (const Vec3& corner : polygon) add_corner(corner, out);
  close(out);
  return out;
}

// Cuts a shadow, the cone from `apex` whose inward normals are `rims`, out of a polygon; appends the parts outside.
void cut_out(std::vector<Vec3> polygon, const Vec3& apex, const std::vector<Vec3>& rims, Polygons& outside) {
  thread_local std::vector<Vec3> spare;
  for (const Vec3& rim : rims) {
    std::vector<Vec3> beside = clipped(polygon, -rim, -rim.dot(apex));
    if (!beside.empty()) outside.push_back(std::move(beside));
    clip(polygon, rim, rim.dot(apex), spare);
    if (polygon.empty()) return;
  }
}

}  // namespace

void clip(std::vector<Vec3>& polygon, const Vec3& normal, double offset, std::vector<Vec3>& spare) {
  const auto is_inside = [&](const Vec3& corner) { return normal.dot(corner) >= offset; };
  const auto num_inside = std::ranges::count_if(polygon, is_inside);
  if (num_inside == 0 || polygon.size() < 3) return polygon.clear();
  if (num_inside == std::ssize(polygon)) return;
  std::vector<Vec3>& inside = spare;
  inside.clear();
  double before = normal.dot(polygon.front()) - offset;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &from = polygon[i], &to = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    const double behind = normal.dot(to) - offset;
    if (before >= 0) add_corner(from, inside);
    if ((before < 0) != (behind < 0)) add_corner(from + before / (before - behind) * (to - from), inside);
    before = behind;
  }
  close(inside);
  std::swap(polygon, spare);
}

std::vector<Vec3> clipped(const std::vector<Vec3>& polygon, const Vec3& normal, double offset) {
  std::vector<Vec3> inside = polygon, spare;
  clip(inside, normal, offset, spare);
  return inside;
}

std::vector<Vec3> rims_of(const std::vector<Vec3>& polygon, const Vec3& apex) {
  const Vec3 centre = centre_of(polygon);
  std::vector<Vec3> rims;
  rims.reserve(polygon.size());
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 rim = (polygon[i] - apex).cross(polygon[i + 1 < polygon.size() ? i + 1 : 0] - apex);
    rims.push_back((rim.dot(centre - apex) < 0 ? -1.0 : 1.0) * rim.normalized());
  }
  return rims;
}

FrustumShadows::FrustumShadows(const EmbreeScene& geometry, const std::vector<Mirror>& mirrors, ShadowCasters casters)
    : geometry_(geometry), mirrors_(mirrors), mirror_of_(mirrors, geometry), casters_(std::move(casters)) {}

// Returns whether a ray meets a surface that casts shadows within `reach` (m), and sets `met` to the closest hit on one.
bool FrustumShadows::meets(const Vec3& from, const Vec3& direction, double reach, bool is_on_surface, RayHit& met) const {
  auto verdict =
      is_on_surface ? geometry_.intersect_from_surface(from, direction, met) : geometry_.intersect(from, direction, met);
  while (verdict == EmbreeScene::Verdict::kHit && met.distance <= reach) {
    if (casters_.empty() || casters_[met.hit.mesh_id]) return true;
    const double begin = geometry_.behind(met.distance, met.reported);
    verdict = geometry_.intersect_from_surface(from, direction, met, Sees::kOpaque, begin);
  }
  return false;
}

// Returns whether something stands between the source and a point of the target. Sets `occluder` to a polygon of it, as far
// as that lies between the two planes, or to none where its shadow cannot be told.
bool FrustumShadows::look(const FrustumSource& source, const Mirror& target, const Vec3& point,
                          std::vector<Vec3>& occluder) const {
  Vec3 from = source.apex;
  if (source.lit_normal) {
    const double behind = source.offset - source.lit_normal->dot(from),
                 ahead = source.lit_normal->dot(point) - source.offset;
    if (ahead <= kOffPlane) return false;
    from = geometry_.lifted(from + behind / (behind + ahead) * (point - from), *source.lit_normal);
  }
  RayHit met;
  const double length = (point - from).norm();
  const Vec3 direction = (point - from) / length;
  if (!meets(from, direction, length - kBefore, source.lit_normal != nullptr, met)) return false;
  const uint32_t mesh = met.hit.mesh_id;
  const int mirror = mirror_of_(mesh, met.hit.triangle_id);
  if (mirror >= 0 && mirrors_[mirror].is_solid) {
    occluder = mirrors_[mirror].outline;
  } else {
    const auto corners = geometry_.corners(mesh, met.hit.triangle_id);
    occluder.assign(corners.begin(), corners.end());
  }
  if (source.lit_normal) occluder = clipped(occluder, *source.lit_normal, source.offset + kOffPlane);
  const double side = target.height(source.apex) > 0 ? 1.0 : -1.0;
  occluder = clipped(occluder, side * target.normal, side * target.normal.dot(target.point) + kOffPlane);
  if (occluder.empty()) return true;
  const Vec3 normal = cross_of_sides(occluder[0], occluder[1], occluder[2]).normalized();
  if (std::abs(normal.dot(source.apex - occluder[0])) < kOffPlane) occluder.clear();
  return true;
}

void FrustumShadows::shrink(const FrustumSource& source, const Mirror& target, std::vector<Vec3>& window) const {
  std::vector<Vec3> occluder;
  const auto is_hidden = [&](const Vec3& point) { return look(source, target, point, occluder) && !occluder.empty(); };
  if (!is_hidden(centre_of(window))) return;
  Polygons unseen, seen, left;
  cut_out(window, source.apex, rims_of(occluder, source.apex), unseen);
  for (int looks = 1; !unseen.empty() && looks < kMaxLooks && unseen.size() < kMaxPieces; ++looks) {
    if (!is_hidden(centre_of(unseen.back()))) {
      seen.push_back(std::move(unseen.back()));
      unseen.pop_back();
      continue;
    }
    const std::vector<Vec3> rims = rims_of(occluder, source.apex);
    left.clear();
    for (std::vector<Vec3>& piece : unseen) cut_out(std::move(piece), source.apex, rims, left);
    std::swap(unseen, left);
  }
  seen.insert(seen.end(), unseen.begin(), unseen.end());
  if (seen.empty()) {
    window.clear();
    return;
  }
  std::vector<Vec3> corners;
  for (const std::vector<Vec3>& piece : seen) corners.insert(corners.end(), piece.begin(), piece.end());
  window = seen.size() == 1 ? seen.front() : without_twins(outline_of(target, corners));
}

}  // namespace echopath
