#pragma once
// Finds those of many objects, such as triangles, that may lie in a region of space, by a binary tree of bounding boxes.
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "echopath/base/geometry.h"
#include "echopath/base/threads/job.h"

namespace echopath {

// Holds a binary tree of boxes. Each branch divides its objects in two halves at the median of the centres of their boxes,
// so that neither large objects nor distant ones unbalance the tree. To build the tree of n objects takes n log n steps; it
// keeps about 40 bytes an object, and 12 more while it is built. The tree has an order of its own; an object's index in this
// order is its place.
class BoxTree {
 public:
  struct Branch {
    Box box;
    uint32_t begin = 0, end = 0;  // range of places
    uint32_t second_half = 0;     // index of the second half, 0 for a leaf; the first half follows this branch
  };

  // Builds the tree of `size` objects, at most 2^31, of which box_of(i) gives the box of object i, in m and finite. A leaf
  // has at most `leaf_size` objects. Raises Cancelled when the job is cancelled.
  BoxTree(uint32_t size, const std::function<Box(uint32_t)>& box_of, uint32_t leaf_size, const Job* job = nullptr);

  uint32_t size() const { return static_cast<uint32_t>(order_.size()); }
  uint32_t input_index(uint32_t place) const { return order_[place]; }  // the `i` of box_of
  const std::vector<Branch>& branches() const { return branches_; }     // the first one is the root, if there is any

  // Walks down from the root: enters(index of a branch) tells whether to look into it, and visit(leaf) gets the leaves that
  // were entered, in order of place, and tells whether to go on.
  template <class Enters, class Visit>
  void walk(const Enters& enters, const Visit& visit) const;

  // Calls visit(i) of the objects in all leaves whose boxes, and those of the branches above, may_hold(box) lets in, in
  // order of place. Their own boxes may lie beside.
  template <class MayHold, class Visit>
  void for_each(const MayHold& may_hold, const Visit& visit) const;

 private:
  using Middle = std::array<float, 3>;  // from that of object 0, as floats in m lose half a metre at 5e6 m
  void halve(uint32_t begin, uint32_t end, const std::vector<Middle>& middles, uint32_t leaf_size, const Job* job);

  std::vector<uint32_t> order_;
  std::vector<Branch> branches_;  // each stands before those within it
};

template <class Enters, class Visit>
void BoxTree::walk(const Enters& enters, const Visit& visit) const {
  std::array<uint32_t, 64> open;  // one open branch per level, of at most 32 levels
  size_t num_open = 0;
  if (!branches_.empty()) open[num_open++] = 0;
  while (num_open > 0) {
    const uint32_t index = open[--num_open];
    if (!enters(index)) continue;
    const Branch& branch = branches_[index];
    if (branch.second_half != 0) {
      open[num_open++] = branch.second_half;
      open[num_open++] = index + 1;
    } else if (!visit(branch)) {
      return;
    }
  }
}

template <class MayHold, class Visit>
void BoxTree::for_each(const MayHold& may_hold, const Visit& visit) const {
  walk([&](uint32_t index) { return may_hold(branches_[index].box); }, [&](const Branch& leaf) {
    for (uint32_t place = leaf.begin; place < leaf.end; ++place) visit(order_[place]);
    return true;
  });
}

}  // namespace echopath
