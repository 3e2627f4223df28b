#pragma once
// Which triangles may touch which: a binary tree of bounding boxes. Internal to the module.
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "echopath/base/geometry.h"
#include "echopath/base/job.h"

namespace echopath {

using Box = Eigen::AlignedBox3d;
using Corners = std::array<Vec3, 3>;

inline Box box_of(const Corners& corners) {
  Box box(corners[0]);
  box.extend(corners[1]);
  box.extend(corners[2]);
  return box;
}

// Halves its triangles at the median of their middles, so that neither their sizes nor one of them far away unbalance it:
// n log n steps, about 110 bytes a triangle. It puts the triangles in an order of its own, and names them by their places.
class BoxTree {
 public:
  // `triangles` [n]: corners in m, finite; at most 2^31. Raises Cancelled when the job is.
  explicit BoxTree(const std::vector<Corners>& triangles, const Job* job = nullptr);

  uint32_t size() const { return static_cast<uint32_t>(order_.size()); }
  const Corners& triangle(uint32_t place) const { return triangles_[place]; }
  uint32_t given(uint32_t place) const { return order_[place]; }  // its index among those given

  // Calls visit(place) for the triangles behind `place` whose boxes `may_meet` takes, by place. Boxes around several are
  // asked about first: it must take each that holds one it takes.
  template <class MayMeet, class Visit>
  void visit_behind(uint32_t place, const MayMeet& may_meet, const Visit& visit) const;

 private:
  static constexpr uint32_t kLeafSize = 4;
  struct Branch {
    Box box;
    uint32_t begin = 0, end = 0;  // places
    uint32_t second_half = 0;     // its branch; the first half's follows this one. 0 for a leaf
  };
  using Middle = std::array<float, 3>;
  void halve(uint32_t begin, uint32_t end, const std::vector<Middle>& middles, const Job* job);
  void fit_boxes();

  std::vector<uint32_t> order_;
  std::vector<Corners> triangles_;
  std::vector<Branch> branches_;  // each before those within it
};

template <class MayMeet, class Visit>
void BoxTree::visit_behind(uint32_t place, const MayMeet& may_meet, const Visit& visit) const {
  std::array<uint32_t, 64> open;  // one a level is open at a time, beside the one below: at most 31 levels
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
