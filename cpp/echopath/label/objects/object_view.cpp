#include "echopath/label/objects/object_view.h"

#include <algorithm>

#include "echopath/base/lanes/scalar_math.h"
#include "echopath/base/lanes/simd.h"
#include "echopath/trace/strata/fit_stratum.h"

namespace echopath {
namespace {

constexpr double kBoxMargin = 16.0;   // lifts of the geometry: the rounding of vertices and rays in single precision
constexpr double kEndMargin = 1e-6;   // relative to a distance, likewise
constexpr double kLeast = 1e-300;     // stands for a direction's part that is zero
constexpr size_t kMostBoxes = 32;     // of meshes; one box holds more of them
constexpr size_t kFewVertices = 512;  // are as good as the corners of boxes
constexpr auto kHiding = static_cast<uint32_t>(Sees::kOpaque);  // sheets let waves pass
constexpr int kFewTurns = 6;  // of strips: a stratum a little too wide costs fewer looks than the narrowest one

bool is_any(const EmbreeScene::Stretches& stretches) {
  for (int lane = 0; lane < kPacketSize; ++lane) {
    if (stretches.end[lane] > stretches.begin[lane]) return true;
  }
  return false;
}

ECHOPATH_INLINE void invert_lanes(const LaneVectors* directions, LaneVectors* inverse) {
  const auto inverted = [](double value) __attribute__((always_inline)) { return 1.0 / (value == 0.0 ? kLeast : value); };
  ECHOPATH_SIDE_BY_SIDE
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const VectorOf<double> direction = directions->at(lane);
    inverse->set(lane, {inverted(direction.x), inverted(direction.y), inverted(direction.z)});
  }
}

// Extends the stretches by those in a box, whose corners are relative to where the rays begin.
ECHOPATH_INLINE void cross_box(VectorOf<double> low, VectorOf<double> high, const LaneVectors* inverse,
                               EmbreeScene::Stretches* stretches) {
  const auto smaller = [](double a, double b) __attribute__((always_inline)) { return ScalarMath::smaller(a, b); };
  const auto larger = [](double a, double b) __attribute__((always_inline)) { return ScalarMath::larger(a, b); };
  ECHOPATH_SIDE_BY_SIDE
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const VectorOf<double> by = inverse->at(lane);
    const double x0 = low.x * by.x, x1 = high.x * by.x, y0 = low.y * by.y, y1 = high.y * by.y;
    const double z0 = low.z * by.z, z1 = high.z * by.z;
    const double begin = larger(larger(smaller(x0, x1), smaller(y0, y1)), larger(smaller(z0, z1), 0.0)) * (1.0 - kEndMargin);
    const double end = smaller(smaller(larger(x0, x1), larger(y0, y1)), larger(z0, z1)) * (1.0 + kEndMargin);
    const bool is_met = end >= begin && end > 0.0;
    stretches->begin[lane] = is_met ? smaller(stretches->begin[lane], begin) : stretches->begin[lane];
    stretches->end[lane] = is_met ? larger(stretches->end[lane], end) : stretches->end[lane];
  }
}

void add_corners(const Box& box, std::vector<Vec3>& corners) {
  for (int corner = 0; corner < 8; ++corner) corners.push_back(box.corner(static_cast<Box::CornerType>(corner)));
}

}  // namespace

ObjectView::ObjectView(const EmbreeScene& geometry, const SurfaceMap& surfaces, uint32_t object, const Vec3& apex)
    : geometry_(geometry), surfaces_(surfaces), object_(object), apex_(apex), mesh_ids_(surfaces.meshes_of(object)) {
  Box all;
  for (const uint32_t mesh : mesh_ids_) {
    all.extend(geometry.box(mesh));
    boxes_.push_back(geometry.box(mesh));
    mask_ |= geometry.mask_of(mesh);
  }
  if (boxes_.size() > kMostBoxes) boxes_ = {all};
  const Vec3 margin = Vec3::Constant(kBoxMargin * geometry.lift());
  for (Box& box : boxes_) box = {box.min() - margin, box.max() + margin};
}

double ObjectView::extent() const {
  Box all;
  for (const Box& box : boxes_) all.extend(box);
  return all.isEmpty() ? 0.0 : all.diagonal().norm();
}

Stratum ObjectView::stratum(bool closely) const {
  size_t num_vertices = 0;
  for (const uint32_t mesh : mesh_ids_) num_vertices += geometry_.vertices(mesh).size();
  const bool by_boxes = !closely && num_vertices > kFewVertices;
  std::vector<Vec3> points;
  for (const uint32_t mesh : mesh_ids_) {
    const std::vector<Vec3>& vertices = geometry_.vertices(mesh);
    if (by_boxes) add_corners(geometry_.box(mesh), points);
    else points.insert(points.end(), vertices.begin(), vertices.end());
  }
  const std::optional<Stratum> found =
      fit_stratum(points, apex_, surfaces_.names[object_], closely ? kManyTurns : kFewTurns);
  if (!found && by_boxes) return stratum(true);
  return found.value_or(Stratum{});
}

// Returns the stretches of the rays from the first of the object's boxes to the end of the last.
EmbreeScene::Stretches ObjectView::stretches_in_boxes(const LaneVectors& directions, int count) const {
  EmbreeScene::Stretches stretches;
  for (int lane = 0; lane < kPacketSize; ++lane) {
    stretches.begin[lane] = std::numeric_limits<double>::infinity();
    stretches.end[lane] = 0.0;
  }
  LaneVectors inverse;
  run_simd<&invert_lanes>(&directions, &inverse);
  for (const Box& box : boxes_) {
    run_simd<&cross_box>(unpacked(box.min() - apex_), unpacked(box.max() - apex_), &inverse, &stretches);
  }
  for (int lane = count; lane < kPacketSize; ++lane) stretches.end[lane] = 0.0;
  return stretches;
}

void ObjectView::look(const LaneVectors& directions, int count, Seen& seen) const {
  EmbreeScene::Stretches in_box = stretches_in_boxes(directions, count), whole = in_box;
  seen.surface.fill(kNothing);
  seen.mesh.fill(kNothing);
  seen.hiding.fill(kNothing);
  if (!is_any(in_box)) return;
  for (int lane = 0; lane < kPacketSize; ++lane) {
    if (whole.end[lane] > whole.begin[lane]) whole.begin[lane] = 0.0;
  }
  EmbreeScene::MeshHits first;
  geometry_.intersect_meshes(apex_, directions, whole, kHiding, first);
  const bool has_sheets = (mask_ & static_cast<uint32_t>(Sees::kSheets)) != 0;
  for (int lane = 0; lane < kPacketSize; ++lane) {
    if (first.mesh_id[lane] != kNothing && !is_own(first.mesh_id[lane])) {
      if (!has_sheets) in_box.begin[lane] = std::max(in_box.begin[lane], first.distance[lane] * (1.0 - 2.0 * kSameDepth));
      seen.hiding[lane] = first.mesh_id[lane];
      continue;
    }
    if (has_sheets) continue;  // one of its sheets may be nearer
    in_box.end[lane] = 0.0;    // the object itself, or nothing
    if (first.mesh_id[lane] == kNothing) continue;
    seen.surface[lane] = object_;
    seen.mesh[lane] = first.mesh_id[lane];
    seen.distance[lane] = first.distance[lane];
  }
  find_object(directions, in_box, seen);
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const bool is_there = seen.mesh[lane] != kNothing;
    if (is_there && seen.hiding[lane] == kNothing) seen.surface[lane] = object_;
    if (seen.hiding[lane] == kNothing) continue;
    const bool is_hidden = is_there && first.distance[lane] < seen.distance[lane] * (1.0 - kSameDepth);
    if (is_there) seen.surface[lane] = is_hidden ? surfaces_.of_mesh[seen.hiding[lane]] : object_;
    if (!is_hidden) seen.hiding[lane] = kNothing;
  }
}

void ObjectView::look_from(const Vec3& from, const LaneVectors& directions, const Seen& seen, int count,
                           uint32_t* surface) const {
  EmbreeScene::Stretches way{};
  LaneVectors turned = directions;
  for (int lane = 0; lane < count; ++lane) {
    surface[lane] = kNothing;
    if (seen.mesh[lane] == kNothing) continue;
    const Vec3 line = apex_ + seen.distance[lane] * directions[lane] - from;
    const double distance = line.norm();
    turned.set(lane, unpacked(line / distance));
    way.end[lane] = distance * (1.0 - kSameDepth);
    surface[lane] = object_;
  }
  if (!is_any(way)) return;
  EmbreeScene::MeshHits first;
  geometry_.intersect_meshes(from, turned, way, kHiding, first);
  for (int lane = 0; lane < count; ++lane) {
    const uint32_t mesh = first.mesh_id[lane];
    if (mesh != kNothing) surface[lane] = surfaces_.of_mesh[mesh];  // another part of the object is as good as the point
  }
}

// Finds the object in stretches that begin at what is nearer. Others may share its bit: behind these the search goes on.
void ObjectView::find_object(const LaneVectors& directions, EmbreeScene::Stretches stretches, Seen& seen) const {
  EmbreeScene::MeshHits next;
  while (is_any(stretches)) {
    geometry_.intersect_meshes(apex_, directions, stretches, mask_, next);
    for (int lane = 0; lane < kPacketSize; ++lane) {
      if (next.mesh_id[lane] == kNothing) {
        stretches.end[lane] = 0.0;
      } else if (!is_own(next.mesh_id[lane])) {
        stretches.begin[lane] = next.distance[lane] * kAfter;
      } else {
        seen.mesh[lane] = next.mesh_id[lane];
        seen.distance[lane] = next.distance[lane];
        stretches.end[lane] = 0.0;
      }
    }
  }
}

}  // namespace echopath
