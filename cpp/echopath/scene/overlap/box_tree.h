#pragma once
// A binary tree of bounding boxes that finds which triangles may touch which. Internal to the module.
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "echopath/base/geometry.h"
#include "echopath/base/threads/job.h"

namespace echopath {

using Box = Eigen::AlignedBox3d;
using Corners = std::array<Vec3, 3>;

inline Box box_of(const Corners& corners) {
  Box box(corners[0]);
  box.extend(corners[1]);
  box.extend(corners[2]);
  return box;
}

// Halves its triangles at the median of their box centres, so that neither large triangles nor distant ones unbalance it. It
// takes n log n steps and about 110 bytes per triangle. It sorts the triangles in an order of its own and names each by its
// place in it.
class BoxTree {
 public:
  // `triangles` [n] holds corners in m, finite, of at most 2^31 triangles. Raises Cancelled when the job is cancelled.
  explicit BoxTree(const std::vector<Corners>& triangles, const Job* job = nullptr);

  uint32_t size() const { return static_cast<uint32_t>(order_.size()); }
  const Corners& triangle(uint32_t place) const { return triangles_[place]; }
  uint32_t input_index(uint32_t place) const { return order_[place]; }  // index among the constructor's triangles

  // Calls visit(other) for each triangle behind `place` whose box `may_meet` accepts, in order of place. Boxes around
  // several triangles are asked about first, so `may_meet` must accept every box that contains one it accepts.
  template <class MayMeet, class Visit>
  void visit_behind(uint32_t place, const MayMeet& may_meet, const Visit& visit) const;

 private:
  static constexpr uint32_t kLeafSize = 4;
  struct Branch {
    Box box;
    uint32_t begin = 0, end = 0;  // range of places
    uint32_t second_half = 0;     // index of the second half, 0 for a leaf; the first half follows this branch
  };
  using Middle = std::array<float, 3>;
  void halve(uint32_t begin, uint32_t end, const std::vector<Middle>& middles, const Job* job);
  void fit_boxes();

  std::vector<uint32_t> order_;
  std::vector<Corners> triangles_;
  std::vector<Branch> branches_;  // each stands before those within it
};

template <class MayMeet, class Visit>
void BoxTree::visit_behind(uint32_t place, const MayMeet& may_meet, const Visit& visit) const {
  std::array<uint32_t, 64> open;  // a depth-first walk keeps one open branch per level, of at most 31 levels
  size_t num_open = 0;
  open[num_open++] = 0;
  while (num_open > 0) {
    const uint32_t index = open[--num_open];
    const Branch& branch = branches_[index];
    if (branch.end <= place + 1 || !may_meet(branch.box)) continue;
    if (branch.second_half != 0) {
      open[num_open++] = branch.second_half;
      open[num_open++] = index + 1;
      continue;
    }
    for (uint32_t other = std::max(branch.begin, place + 1); other < branch.end; ++other) {
      if (may_meet(box_of(triangles_[other]))) visit(other);
    }
  }
}

}  // namespace echopath
