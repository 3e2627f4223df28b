#include "echopath/trace/geometry/box_hierarchy.h"

#include <algorithm>
#include <utility>

namespace echopath {
namespace {

constexpr uint32_t kBoxesOfLeaf = 4;

}  // namespace

bool reaches_into(const Box& box, const std::vector<HalfSpace>& region) {
  for (const HalfSpace& half : region) {
    double farthest = 0.0;
    for (int axis = 0; axis < 3; ++axis)
      farthest += std::max(half.normal[axis] * box.min()[axis], half.normal[axis] * box.max()[axis]);
    if (farthest < half.offset) return false;
  }
  return true;
}

BoxHierarchy::BoxHierarchy(std::vector<Box> boxes)
    : boxes_(std::move(boxes)),
      tree_(static_cast<uint32_t>(boxes_.size()), [this](uint32_t i) { return boxes_[i]; }, kBoxesOfLeaf) {}

void BoxHierarchy::find(const std::vector<HalfSpace>& region, std::vector<int>& found) const {
  found.clear();
  const auto is_in = [&](const Box& box) { return reaches_into(box, region); };
  tree_.for_each(is_in, [&](uint32_t index) {
    if (is_in(boxes_[index])) found.push_back(static_cast<int>(index));
  });
  std::ranges::sort(found);
}

}  // namespace echopath
