#pragma once
// Finds and removes paths of rays that carry the same field as paths over planes that the image method found.
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/record/paths.h"

namespace echopath {

// Describes a sequence of planes off which a path bounces, with other orders of the same planes that carry the same field.
// The sequence is divided into stretches of bounces that lie about one corner; the bounces of a stretch may come in any
// order.
struct OrdersAboutCorners {
  std::vector<int> planes;
  std::vector<int64_t> ends;  // of the stretches, ascending

  // Returns whether a sequence of the same planes is one of these.
  bool contain(const std::vector<int>& sequence) const;
  bool operator==(const OrdersAboutCorners&) const = default;
};

// Holds the sequences of planes whose paths the image method has found.
class PlaneDoubles {
 public:
  std::vector<std::vector<int>> plane_of_triangle;  // by mesh ID; empty: none. -1: on no plane
  // Adds sequences of planes whose paths the image method has found: leave_out() removes the paths of rays over these.
  void add(OrdersAboutCorners orders);
  bool any() const { return !left_out_.empty(); }
  // Returns what of it these images stand for: paths of no ray, of any record of the same scene.
  PlaneDoubles of_images_in(const Paths& paths) const;
  // Returns [P] 1 for the paths of rays for which the image method has paths of its own. Raises Cancelled.
  std::vector<uint8_t> doubles_in(const Paths& paths, Job* job) const;
  // Removes these. Raises Cancelled.
  void leave_out(Paths& paths, Job* job) const;
  // Returns whether both leave out the same, where the meshes of this one have the IDs `id_there` in the other one, or none
  // (numbers beyond its meshes).
  bool is_same(const PlaneDoubles& other, std::span<const uint32_t> id_there) const;

 private:
  struct Sequence;  // the planes of a path, kept from path to path for its memory

  // Returns the sequence that a path has, in one of its orders; null: none, or it meets something else.
  const OrdersAboutCorners* find(const Paths& paths, size_t path, Sequence& of_path) const;

  // Sequences whose echoes by rays are left out, by their planes in ascending order.
  std::map<std::vector<int>, std::vector<OrdersAboutCorners>> left_out_;
};

}  // namespace echopath
