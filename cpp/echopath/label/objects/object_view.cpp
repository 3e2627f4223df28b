#include "echopath/label/objects/object_view.h"

#include <algorithm>
#include <cmath>

#include "echopath/trace/launch/fit_stratum.h"

namespace echopath {
namespace {

constexpr double kBoxMargin = 16.0;   // lifts of the geometry: the rounding of vertices and rays in single precision
constexpr double kEndMargin = 1e-6;   // relative to a distance, likewise
constexpr size_t kFewVertices = 512;  // are as good as the corners of boxes

bool is_any(const EmbreeScene::Stretches& stretches) {
  for (int lane = 0; lane < kPacketSize; ++lane) {
    if (stretches.end[lane] > stretches.begin[lane]) return true;
  }
  return false;
}

void add_corners(const Eigen::AlignedBox3d& box, std::vector<Vec3>& corners) {
  for (int corner = 0; corner < 8; ++corner)
    corners.push_back(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
}

}  // namespace

ObjectView::ObjectView(const EmbreeScene& geometry, const SurfaceMap& surfaces, uint32_t object, const Vec3& apex)
    : geometry_(geometry), surfaces_(surfaces), object_(object), apex_(apex), mesh_ids_(surfaces.meshes_of(object)) {
  for (const uint32_t mesh : mesh_ids_) {
    box_.extend(geometry.box(mesh));
    mask_ |= geometry.mask_of(mesh);
  }
  const double margin = kBoxMargin * geometry.lift();
  box_.extend((box_.max().array() + margin).matrix().eval());
  box_.extend((box_.min().array() - margin).matrix().eval());
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
  const std::optional<Stratum> found = fit_stratum(points, apex_, surfaces_.names[object_]);
  if (!found && by_boxes) return stratum(true);
  return found.value_or(Stratum{});
}

// Returns the stretches of the rays in the object's box.
EmbreeScene::Stretches ObjectView::stretches_in_box(const LaneVectors& directions, int count) const {
  EmbreeScene::Stretches stretches;
  for (int lane = 0; lane < kPacketSize; ++lane) {
    double begin = 0.0, end = lane < count ? std::numeric_limits<double>::infinity() : 0.0;
    const Vec3 direction = directions[lane];
    for (int axis = 0; axis < 3; ++axis) {
      const double low = box_.min()[axis] - apex_[axis], high = box_.max()[axis] - apex_[axis];
      if (direction[axis] == 0.0) {
        if (low > 0.0 || high < 0.0) end = 0.0;
        continue;
      }
      const double one = low / direction[axis], other = high / direction[axis];
      begin = std::max(begin, std::min(one, other));
      end = std::min(end, std::max(one, other));
    }
    stretches.begin[lane] = begin * (1.0 - kEndMargin);
    stretches.end[lane] = end >= begin ? end * (1.0 + kEndMargin) : 0.0;
  }
  return stretches;
}

void ObjectView::look(const LaneVectors& directions, int count, Seen& seen) const {
  EmbreeScene::Stretches in_box = stretches_in_box(directions, count), whole = in_box;
  seen.surface.fill(kNothing);
  seen.mesh.fill(kNothing);
  seen.hiding.fill(kNothing);
  if (!is_any(in_box)) return;
  for (int lane = 0; lane < kPacketSize; ++lane) {
    if (whole.end[lane] > whole.begin[lane]) whole.begin[lane] = 0.0;
  }
  EmbreeScene::Looks first;
  geometry_.look(apex_, directions, whole, ~uint32_t{0}, first);
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const auto k = static_cast<size_t>(lane);
    if (first.mesh_id[k] != kNothing && !is_own(first.mesh_id[k])) {
      in_box.begin[lane] = std::max(in_box.begin[lane], first.distance[lane] * (1.0 - 2.0 * kSameDepth));
      seen.hiding[k] = first.mesh_id[k];
      continue;
    }
    in_box.end[lane] = 0.0;  // the object itself, or nothing
    if (first.mesh_id[k] == kNothing) continue;
    seen.surface[k] = object_;
    seen.mesh[k] = first.mesh_id[k];
    seen.distance[lane] = first.distance[lane];
  }
  find_object(directions, in_box, seen);
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const auto k = static_cast<size_t>(lane);
    if (seen.hiding[k] == kNothing) continue;
    const bool is_there = seen.mesh[k] != kNothing;
    const bool is_hidden = is_there && first.distance[lane] < seen.distance[lane] * (1.0 - kSameDepth);
    if (is_there) seen.surface[k] = is_hidden ? surfaces_.of_mesh[seen.hiding[k]] : object_;
    if (!is_hidden) seen.hiding[k] = kNothing;
  }
}

// Finds the object in stretches that begin at what is nearer. Others may share its bit: behind these the search goes on.
void ObjectView::find_object(const LaneVectors& directions, EmbreeScene::Stretches stretches, Seen& seen) const {
  EmbreeScene::Looks next;
  while (is_any(stretches)) {
    geometry_.look(apex_, directions, stretches, mask_, next);
    for (int lane = 0; lane < kPacketSize; ++lane) {
      const auto k = static_cast<size_t>(lane);
      if (next.mesh_id[k] == kNothing) {
        stretches.end[lane] = 0.0;
      } else if (!is_own(next.mesh_id[k])) {
        stretches.begin[lane] = next.distance[lane] * kAfter;
      } else {
        seen.mesh[k] = next.mesh_id[k];
        seen.distance[lane] = next.distance[lane];
        stretches.end[lane] = 0.0;
      }
    }
  }
}

}  // namespace echopath
