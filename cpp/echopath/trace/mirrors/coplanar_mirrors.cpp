#include "echopath/trace/mirrors/coplanar_mirrors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "echopath/base/box_tree.h"
#include "echopath/trace/frusta/frustum_shadows.h"

namespace echopath {
namespace {

constexpr double kLifts = 4.0;         // of EmbreeScene::lift: shadow queries tell what is farther apart
constexpr double kOnePlane = 1e-8;     // m: mirrors this near are in one plane
constexpr double kOverlap = 1e-6;      // m: mirrors whose rims overlap by less lie beside each other
constexpr double kAlongPlane = 0.999;  // cosine, of normals: what is less parallel is not looked at
constexpr uint32_t kMirrorsOfLeaf = 4;

double farthest_from(const Plane& plane, const std::vector<Vec3>& points) {
  double farthest = 0.0;
  for (const Vec3& point : points) farthest = std::max(farthest, std::abs(plane.height(point)));
  return farthest;
}

// Returns whether the outlines overlap, one of which is at most `distance` (m) off the plane of the other.
bool lie_on_each_other(const Mirror& one, const Mirror& other, double distance) {
  if (std::abs(one.normal.dot(other.normal)) < kAlongPlane) return false;
  if (std::min(farthest_from(one, other.outline), farthest_from(other, one.outline)) > distance) return false;
  const Vec3 apex = one.point + one.normal;
  std::vector<Vec3> common = other.outline, spare;
  for (const Vec3& rim : rims_of(one.outline, apex)) clip(common, rim, rim.dot(apex) + kOverlap, spare);
  return !common.empty();
}

}  // namespace

// Holds mirrors, and finds those at a point.
class MirrorsInPlane {
 public:
  MirrorsInPlane(std::vector<int> mirrors, const std::vector<Box>& boxes)
      : mirrors_(std::move(mirrors)),
        tree_(static_cast<uint32_t>(mirrors_.size()), [&](uint32_t i) { return boxes[mirrors_[i]]; }, kMirrorsOfLeaf) {}

  // Calls body(mirror) for all whose boxes hold the point, in an order that depends on where the mirrors are alone.
  template <class Body>
  void at(const Vec3& point, const Body& body) const {
    tree_.for_each([&](const Box& box) { return box.contains(point); }, [&](uint32_t i) { body(mirrors_[i]); });
  }

 private:
  std::vector<int> mirrors_;
  BoxTree tree_;
};

void find_coplanar(const EmbreeScene& geometry, std::vector<Mirror>& mirrors) {
  const double distance = kLifts * geometry.lift();
  std::vector<Box> boxes;
  for (const Mirror& mirror : mirrors) {
    const Box box = box_about(mirror.outline);
    boxes.emplace_back(box.min().array() - distance, box.max().array() + distance);
  }
  const BoxTree tree(static_cast<uint32_t>(boxes.size()), [&](uint32_t index) { return boxes[index]; }, kMirrorsOfLeaf);
  std::vector<std::vector<int>> coplanar(mirrors.size());
  for (uint32_t index = 0; index < mirrors.size(); ++index) {
    const auto meets = [&](const Box& box) { return box.intersects(boxes[index]); };
    tree.for_each(meets, [&](uint32_t other) {
      if (other <= index || !meets(boxes[other]) || !lie_on_each_other(mirrors[index], mirrors[other], distance)) return;
      coplanar[index].push_back(static_cast<int>(other));
      coplanar[other].push_back(static_cast<int>(index));
    });
  }
  for (size_t index = 0; index < mirrors.size(); ++index) {
    if (coplanar[index].empty()) continue;
    mirrors[index].coplanar = std::make_shared<const MirrorsInPlane>(std::move(coplanar[index]), boxes);
  }
}

std::optional<Hit> hit_in_front(const std::vector<Mirror>& mirrors, int index, const Vec3& from, const Vec3& point) {
  std::optional<Hit> front;
  if (!mirrors[index].coplanar) return front;
  int last = index;
  double highest = 0.0;  // m, above the point
  mirrors[index].coplanar->at(point, [&](int other) {
    const double height = mirrors[other].normal_toward(from).dot(mirrors[other].point - point);
    if (height < highest - kOnePlane || (height <= highest + kOnePlane && other < last)) return;
    const std::optional<Hit> hit = mirrors[other].mesh.locate(point);
    if (!hit) return;
    front = hit;
    last = other;
    highest = height;
  });
  return front;
}

}  // namespace echopath
