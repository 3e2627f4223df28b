#pragma once
// Knows which paths that rays found stand for the same field as paths over planes that the image method found.
#include <cstdint>
#include <map>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/record/paths.h"

namespace echopath {

// Holds a sequence of planes, and with it all in which the bounces of a stretch come in another order.
struct OrdersAboutCorners {
  std::vector<int> planes;
  std::vector<int64_t> ends;  // of the stretches, ascending

  bool contain(const std::vector<int>& sequence) const;  // of the same planes
  bool operator==(const OrdersAboutCorners&) const = default;
};

class PlaneDoubles {
 public:
  std::vector<std::vector<int>> plane_of_triangle;  // by mesh ID; empty: none. -1: on no plane
  // Leaves out the sequences.
  void add(OrdersAboutCorners orders);
  bool any() const { return !left_out_.empty(); }
  // Leaves out the paths that the images stand for. Raises Cancelled.
  void leave_out(Paths& paths, Job* job) const;
  bool operator==(const PlaneDoubles&) const = default;

 private:
  struct Sequence;  // the planes of a path, kept from path to path for its memory

  bool is_double(const Paths& paths, size_t path, Sequence& of_path) const;

  // Sequences whose echoes by rays are left out, by their planes in ascending order.
  std::map<std::vector<int>, std::vector<OrdersAboutCorners>> left_out_;
};

}  // namespace echopath
