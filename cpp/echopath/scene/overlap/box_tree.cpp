#include "echopath/scene/overlap/box_tree.h"

#include <numeric>

namespace echopath {
namespace {

using Middle = std::array<float, 3>;

constexpr uint32_t kTrianglesBetweenChecks = 1 << 14;  // larger branches check for cancellation, some milliseconds apart

Middle middle_of(const Corners& corners) {
  const Eigen::Vector3f middle = box_of(corners).center().cast<float>();
  return {middle.x(), middle.y(), middle.z()};
}

// Returns the axis along which the box centres of some triangles are spread furthest.
size_t longest_axis(const std::vector<Middle>& middles, const uint32_t* begin, const uint32_t* end) {
  Middle low = middles[*begin], high = low;
  for (const uint32_t* index = begin; index != end; ++index) {
    for (size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], middles[*index][axis]);
      high[axis] = std::max(high[axis], middles[*index][axis]);
    }
  }
  size_t longest = 0;
  for (size_t axis = 1; axis < 3; ++axis) {
    if (high[axis] - low[axis] > high[longest] - low[longest]) longest = axis;
  }
  return longest;
}

}  // namespace

BoxTree::BoxTree(const std::vector<Corners>& triangles, const Job* job) : order_(triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  std::vector<Middle> middles;
  middles.reserve(triangles.size());
  for (const Corners& corners : triangles) middles.push_back(middle_of(corners));
  halve(0, size(), middles, job);
  triangles_.reserve(triangles.size());
  for (const uint32_t index : order_) triangles_.push_back(triangles[index]);
  fit_boxes();
}

void BoxTree::halve(uint32_t begin, uint32_t end, const std::vector<Middle>& middles, const Job* job) {
  if (job && end - begin >= kTrianglesBetweenChecks) job->throw_if_cancelled();
  const size_t index = branches_.size();
  branches_.push_back({Box(), begin, end, 0});
  if (end - begin <= kLeafSize) return;
  uint32_t* const first = order_.data() + begin;
  uint32_t* const last = order_.data() + end;
  const size_t axis = longest_axis(middles, first, last);
  const uint32_t half = begin + (end - begin) / 2;
  std::nth_element(first, order_.data() + half, last, [&](uint32_t a, uint32_t b) {
    return middles[a][axis] != middles[b][axis] ? middles[a][axis] < middles[b][axis] : a < b;
  });
  halve(begin, half, middles, job);
  branches_[index].second_half = static_cast<uint32_t>(branches_.size());
  halve(half, end, middles, job);
}

void BoxTree::fit_boxes() {
  for (size_t index = branches_.size(); index-- > 0;) {
    Branch& branch = branches_[index];
    if (branch.second_half != 0) {
      branch.box = branches_[index + 1].box.merged(branches_[branch.second_half].box);
      continue;
    }
    for (uint32_t place = branch.begin; place < branch.end; ++place) branch.box.extend(box_of(triangles_[place]));
  }
}

}  // namespace echopath
