#include "echopath/trace/mirrors/plane_images.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "echopath/base/constants.h"

namespace echopath {
namespace {

constexpr double kSamePoint = 1e-3;                            // m: paths whose points lie so near to each other are one
constexpr double kNearSheet = 4.0;                             // tolerances: from so near a sheet is looked at
constexpr double kAboutCorner = 4.0;                           // half Fresnel zones between bounces at the same corner
constexpr size_t kMostInAnyOrder = 4;                          // bounces of a chain whose other orders are tried, too
constexpr size_t kMostTriedPoints = 1 << 20;                   // 24 MiB
const Vec3 kLine = Vec3(0.5127, 0.6271, 0.5864).normalized();  // along no wall
constexpr double kZoneShare = 1.0 - 1e-9;                      // of the Fresnel zone that each surface must cover

// Shoots a ray at the point, or right beside it: at edges and corners, which rays know in single precision, what is beside
// the point tells whether the surface is there.
class RayLocator final : public PointLocator {
 public:
  RayLocator(const EmbreeScene& geometry, double tolerance) : geometry_(geometry), tolerance_(tolerance) {}
  std::optional<Hit> locate(const Mirror& mirror, const Vec3& from, const Vec3& point) const override {
    std::optional<Hit> hit = met_at(mirror, from, point);
    const Vec3 first = mirror.normal.unitOrthogonal(), second = mirror.normal.cross(first);
    for (int k = 0; k < kLooksBeside && !hit; ++k) {
      const double angle = kTwoPi * (k + 0.5) / kLooksBeside, aside = kAsideOfEdge * geometry_.lift();
      hit = met_at(mirror, from, point + aside * (std::cos(angle) * first + std::sin(angle) * second));
    }
    return hit;
  }

 private:
  static constexpr auto kHit = EmbreeScene::Verdict::kHit;
  static constexpr int kLooksBeside = 8;
  static constexpr double kAsideOfEdge = 4.0;  // lifts

  std::optional<Hit> met_at(const Mirror& mirror, const Vec3& from, const Vec3& point) const {
    const Vec3 line = point - from;
    const double length = line.norm();
    RayHit met;
    const Vec3 direction = line / length;
    const bool meets = geometry_.is_sheet(mirror.mesh_id) ? meets_sheet(mirror, from, direction, length, met)
                                                          : geometry_.intersect(from, direction, met) == kHit;
    if (!meets) return std::nullopt;
    const bool is_there = std::abs(met.distance - length) * std::abs(direction.dot(mirror.normal)) < tolerance_;
    if (!is_there || met.hit.mesh_id != mirror.mesh_id || met.is_smooth) return std::nullopt;
    for (const Vec3& corner : geometry_.corners(met.hit.mesh_id, met.hit.triangle_id)) {
      if (std::abs(mirror.height(corner)) > tolerance_) return std::nullopt;
    }
    return met.hit;
  }

  // Looks at the sheet from right before it, because others may lie on the way.
  bool meets_sheet(const Mirror& sheet, const Vec3& from, const Vec3& direction, double length, RayHit& met) const {
    const double before = std::max(0.0, length - kNearSheet * tolerance_ / std::abs(direction.dot(sheet.normal)));
    const Vec3 start = from + before * direction;
    if (geometry_.occluded(from, start)) return false;
    if (geometry_.intersect_from_surface(start, direction, met, Sees::kAll) != kHit) return false;
    met.distance += before;
    return true;
  }

  const EmbreeScene& geometry_;
  double tolerance_;
};

bool reaches_plane(const Box& box, const Plane& plane, double tolerance) {
  return !box.isEmpty() &&
         std::abs(plane.height(box.center())) <= 0.5 * plane.normal.cwiseAbs().dot(box.sizes()) + tolerance;
}

// Returns which vertices lie in a plane, [V] 1 or 0; empty: none of them.
std::vector<uint8_t> vertices_in(const Plane& plane, const std::vector<Vec3>& vertices, double tolerance) {
  std::vector<uint8_t> lies_in(vertices.size());
  uint8_t any = 0;
  for (size_t i = 0; i < vertices.size(); ++i) {
    lies_in[i] = std::abs(plane.height(vertices[i])) <= tolerance;
    any |= lies_in[i];
  }
  return any ? lies_in : std::vector<uint8_t>();
}

// Gives the triangles with all three corners in a plane its number, unless they have one.
void name_triangles(const std::vector<Triangle>& triangles, const std::vector<uint8_t>& lies_in, int plane,
                    std::vector<int>& plane_of_triangle) {
  for (size_t i = 0; i < triangles.size(); ++i) {
    const auto& [a, b, c] = triangles[i];
    if (!(lies_in[a] & lies_in[b] & lies_in[c])) continue;
    if (plane_of_triangle.empty()) plane_of_triangle.assign(triangles.size(), -1);
    if (plane_of_triangle[i] < 0) plane_of_triangle[i] = plane;
  }
}

// Returns whether two bounces in a row are at the common edge of their planes: each of their orders has its share of the
// path then. A path through the seam of a plane, or through its rim, has the field that the surface about the point leaves,
// once.
bool bounces_at_corner(const std::vector<Vec3>& points) {
  return std::ranges::adjacent_find(points, [](const Vec3& a, const Vec3& b) { return (a - b).norm() < kAtEdge; }) !=
         points.end();
}

bool is_near(const std::vector<Vec3>& points, const std::vector<Vec3>& others) {
  return std::equal(points.begin(), points.end(), others.begin(), others.end(),
                    [](const Vec3& a, const Vec3& b) { return (a - b).norm() < kSamePoint; });
}

}  // namespace

PlaneImages::PlaneImages(const Scene& scene, const EmbreeScene& geometry, const SbrSettings& settings,
                         PosedAntenna transmitter, PosedAntenna receiver)
    : scene_(scene), geometry_(geometry), settings_(settings), transmitter_(std::move(transmitter)),
      receiver_(std::move(receiver)), wavelength_(kSpeedOfLight / settings.frequency),
      tolerance_(geometry.plane_tolerance(wavelength_)) {
  transmitter_.position = settings.transmitter;
  receiver_.position = settings.receiver;
}

void PlaneImages::add_chains(const PathBlock& block) {
  const size_t first = facets_.size();
  for (const Hit& hit : block.chain_hits) facets_.push_back({hit.mesh_id, hit.triangle_id});
  for (const PathBlock::HitChain& chain : block.chains) chains_.push_back({first + chain.first, chain.count});
}

// Sorts the chains by their facets, so that they do not depend on the order of the rays, and keeps each once.
void PlaneImages::sort_chains() {
  const auto compare = [&](const RayChain& a, const RayChain& b) {
    const Facets one = facets_of(a), other = facets_of(b);
    return std::lexicographical_compare_three_way(one.begin(), one.end(), other.begin(), other.end());
  };
  std::ranges::sort(chains_, [&](const auto& a, const auto& b) { return compare(a, b) < 0; });
  const auto end =
      std::unique(chains_.begin(), chains_.end(), [&](const auto& a, const auto& b) { return compare(a, b) == 0; });
  chains_.erase(end, chains_.end());
}

// Sets planes_ to the planes of the chain, and returns their indices in travel order; returns none where a surface has no
// plane that lasts.
std::vector<int> PlaneImages::planes_of(Facets chain) {
  planes_.clear();
  std::vector<int> sequence;
  for (const auto& [mesh_id, triangle_id] : chain) {
    const Node& node = scene_.node_of(mesh_id);
    if (node.deformation || node.material->mirror) return {};
    const auto [a, b, c] = geometry_.corners(mesh_id, triangle_id);
    Mirror plane;
    plane.point = a;
    plane.normal = cross_of_sides(a, b, c).normalized() * (scene_.is_mirrored(scene_.meshes()[mesh_id].node) ? -1.0 : 1.0);
    plane.mesh_id = mesh_id;
    plane.material = node.material.get();
    plane.outline = {a, b, c};
    sequence.push_back(static_cast<int>(planes_.size()));
    planes_.push_back(std::move(plane));
  }
  return sequence;
}

// Returns whether a path through these points was tried before, as far as there is room to remember it.
bool PlaneImages::is_known(const std::vector<int>& sequence, const std::vector<Vec3>& points) {
  std::vector<uint32_t> meshes;
  std::vector<Vec3> places = points;  // planes of one mesh through one edge differ by their normals
  for (size_t k = 0; k < sequence.size(); ++k) {
    const Mirror& plane = planes_[sequence[k]];
    meshes.push_back(plane.mesh_id);
    places.push_back(points[k] + (plane.normal.dot(kLine) < 0 ? -plane.normal : plane.normal));
  }
  const double place = kLine.dot(points.front());  // points lie no nearer to each other than their places
  if (const auto tried = tried_.find(meshes); tried != tried_.end()) {
    const auto begin = tried->second.lower_bound(place - kSamePoint), end = tried->second.upper_bound(place + kSamePoint);
    if (std::any_of(begin, end, [&](const auto& old) { return is_near(places, old.second); })) return true;
  }
  if (num_tried_points_ > kMostTriedPoints) return false;
  num_tried_points_ += places.size();
  tried_[meshes].emplace(place, std::move(places));
  return false;
}

// Returns the share of its field that the edges of its surfaces leave to a path; nothing where one does not cover its
// Fresnel zone.
std::optional<std::complex<double>> PlaneImages::field_beside_edges(const PlaneBounces& bounces,
                                                                    int64_t& num_queries) const {
  for (size_t k = 0; k < bounces.size(); ++k) {
    if (cover_of_zone(geometry_, bounces.view(k), nullptr, wavelength_, num_queries).share < kZoneShare) return std::nullopt;
  }
  return bounces.field_beside_edges(wavelength_, num_queries);
}

bool PlaneImages::is_same_plane(const Mirror& plane, const Mirror& other) const {
  return std::ranges::all_of(other.outline,
                             [&](const Vec3& corner) { return std::abs(plane.height(corner)) <= tolerance_; });
}

// Returns the planes of the sequence among joined_, of which planes that differ by little are one.
std::vector<int> PlaneImages::joined(const std::vector<int>& sequence) {
  std::vector<int> out;
  for (const int index : sequence) {
    const Mirror& plane = planes_[index];
    const auto same = std::ranges::find_if(joined_, [&](const Mirror& old) { return is_same_plane(old, plane); });
    out.push_back(static_cast<int>(same - joined_.begin()));
    if (same == joined_.end()) joined_.push_back(plane);
  }
  return out;
}

PathBlock PlaneImages::find(const Job* job) {
  PathBlock block;
  sort_chains();
  for (const RayChain& of_ray : chains_) {
    if (job) job->throw_if_cancelled();
    std::vector<int> order = planes_of(facets_of(of_ray));  // ascending
    if (order.empty()) continue;
    do try_order(order, block);
    while (order.size() <= kMostInAnyOrder && std::ranges::next_permutation(order).found);
  }
  find_triangles();
  return block;
}

// Writes the path over some of planes_ to the block, unless there is none or it is there already.
void PlaneImages::try_order(const std::vector<int>& sequence, PathBlock& block) {
  const RayLocator locator(geometry_, tolerance_);
  ImageMethod images(geometry_, planes_, locator, settings_);
  std::vector<Vec3> points;
  if (!images.find_points(sequence, points) || is_known(sequence, points)) return;
  std::optional<ImagePath> path = images.path_over(sequence);
  block.statistics.num_queries += images.num_queries();
  if (!path) return;
  PlaneBounces bounces(geometry_, transmitter_, receiver_);
  for (size_t k = 0; k < sequence.size(); ++k) bounces.add(path->hits[k], path->points[k], planes_[sequence[k]].normal);
  const std::optional<std::complex<double>> share = field_beside_edges(bounces, block.statistics.num_queries);
  if (!share) return;
  path->weight *= *share;
  if (!bounces_at_corner(path->points)) path->share = 1.0;
  const std::vector<int> planes = joined(sequence);
  if (!sequences_.insert(planes).second) return;
  add_path(*path, block);
  if (*share != 1.0) block.rows.flags[block.rows.size() - 1] |= beside_edge_flags(*share);
  leave_out(planes, path->points, bounces, block.statistics.num_queries);
}

// Leaves out the sequence, and its other orders of bounces that lie about a corner: what rays send over those by physical
// optics is the part of the same field beyond the corner's edge. Where planes end before the corner, it is not: these edges
// have taken it from the image.
void PlaneImages::leave_out(const std::vector<int>& planes, const std::vector<Vec3>& points, const PlaneBounces& bounces,
                            int64_t& num_queries) {
  OrdersAboutCorners orders{planes, {}};
  for (size_t begin = 0, end; begin < planes.size(); begin = end) {
    for (end = begin + 1; end < planes.size(); ++end) {
      const double before = (points[end] - settings_.transmitter).norm(), behind = (points[end] - settings_.receiver).norm();
      const double half_zone = std::sqrt(wavelength_ * before * behind / (before + behind));
      if ((points[end] - points[end - 1]).norm() > kAboutCorner * half_zone) break;
      if (!bounces.is_corner_closed(end - 1, wavelength_, num_queries)) break;
    }
    orders.ends.push_back(static_cast<int64_t>(end));
  }
  doubles_.add(std::move(orders));
}

// Finds the triangles of the joined planes.
void PlaneImages::find_triangles() {
  doubles_.plane_of_triangle.resize(scene_.meshes().size());
  for (uint32_t mesh_id = 0; !joined_.empty() && mesh_id < scene_.meshes().size(); ++mesh_id) {
    const Node& node = scene_.node_of(mesh_id);
    if (node.material->mirror || node.deformation) continue;
    std::vector<int>& of_triangle = doubles_.plane_of_triangle[mesh_id];
    for (size_t plane = 0; plane < joined_.size(); ++plane) {
      if (!reaches_plane(geometry_.box(mesh_id), joined_[plane], tolerance_)) continue;
      const std::vector<uint8_t> lies_in = vertices_in(joined_[plane], geometry_.vertices(mesh_id), tolerance_);
      if (!lies_in.empty()) name_triangles(node.mesh->triangles(), lies_in, static_cast<int>(plane), of_triangle);
    }
  }
}

}  // namespace echopath
