#include "echopath/trace/geometry/box_hierarchy.h"

#include <algorithm>
#include <numeric>

namespace echopath {
namespace {

constexpr int kBoxesOfLeaf = 4;

}  // namespace

bool reaches_into(const Eigen::AlignedBox3d& box, const std::vector<HalfSpace>& region) {
  for (const HalfSpace& half : region) {
    double farthest = 0.0;
    for (int axis = 0; axis < 3; ++axis)
      farthest += std::max(half.normal[axis] * box.min()[axis], half.normal[axis] * box.max()[axis]);
    if (farthest < half.offset) return false;
  }
  return true;
}

BoxHierarchy::BoxHierarchy(const std::vector<Eigen::AlignedBox3d>& boxes) : order_(boxes.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  if (!boxes.empty()) grow(boxes, 0, static_cast<int>(boxes.size()));
  for (const int index : order_) boxes_.push_back(boxes[static_cast<size_t>(index)]);
}

// Halves the boxes by their centres along the axis along which these lie farthest apart.
int BoxHierarchy::grow(const std::vector<Eigen::AlignedBox3d>& boxes, int begin, int end) {
  const auto index = branches_.size();
  branches_.emplace_back().begin = begin;
  branches_.back().end = end;
  Eigen::AlignedBox3d whole, centres;
  for (int i = begin; i < end; ++i) {
    const Eigen::AlignedBox3d& box = boxes[static_cast<size_t>(order_[static_cast<size_t>(i)])];
    whole.extend(box);
    centres.extend(box.center());
  }
  branches_[index].box = whole;
  if (end - begin > kBoxesOfLeaf) {
    Eigen::Index axis = 0;
    centres.sizes().maxCoeff(&axis);
    const int middle = (begin + end) / 2;
    const auto is_before = [&](int a, int b) {
      const double at_a = boxes[static_cast<size_t>(a)].center()[axis], at_b = boxes[static_cast<size_t>(b)].center()[axis];
      return at_a < at_b || (at_a == at_b && a < b);
    };
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, is_before);
    grow(boxes, begin, middle);
    branches_[index].second = grow(boxes, middle, end);
  }
  return static_cast<int>(index);
}

void BoxHierarchy::find(const std::vector<HalfSpace>& region, std::vector<int>& found) const {
  found.clear();
  std::array<int, 64> open;  // the tree halves, so that it is at most 31 deep
  size_t num_open = 0;
  if (!branches_.empty()) open[num_open++] = 0;
  while (num_open > 0) {
    const int index = open[--num_open];
    const Branch& branch = branches_[static_cast<size_t>(index)];
    if (!reaches_into(branch.box, region)) continue;
    if (branch.second >= 0) {
      open[num_open++] = branch.second;
      open[num_open++] = index + 1;
      continue;
    }
    for (auto i = static_cast<size_t>(branch.begin); i < static_cast<size_t>(branch.end); ++i) {
      if (reaches_into(boxes_[i], region)) found.push_back(order_[i]);
    }
  }
  std::sort(found.begin(), found.end());
}

}  // namespace echopath
