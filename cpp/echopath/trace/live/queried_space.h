#pragma once
// Records the space through which the queries of rays went. A change of the scene outside of this space does not change the
// answers to these queries.
#include <span>
#include <vector>

#include "echopath/trace/embree/embree_scene.h"

namespace echopath {

using FloatBox = Eigen::AlignedBox3f;

// Holds the stretches of queries in single precision: up to the hit where there is one, else up to the far end. A shadow
// query that was blocked counts with its whole length.
class QueriedSpace {
 public:
  struct Point {
    float x, y, z;
  };
  void add(const Point& from, const Point& to);
  // Returns whether a stretch meets one of the boxes, or nearly does: it may say so of stretches that pass within a few
  // units of single precision of them.
  bool meets(std::span<const FloatBox> boxes) const;
  // Forgets everything but keeps the memory.
  void clear();

 private:
  struct alignas(64) Pack {  // of stretches side by side: middle and half of the vector from end to end
    float middle[3][kPacketSize], half[3][kPacketSize];
  };
  bool meets(const FloatBox& box) const;
  bool meets(const Pack& pack, const FloatBox& box) const;

  std::vector<Pack> packs_;      // the lanes of the last one that are not in use hold its first stretch
  std::vector<FloatBox> boxes_;  // of each pack
  FloatBox whole_;               // of all packs
  int num_in_last_ = kPacketSize;
};

// While it lives, the queries of a scene that a thread asks are added to the space that the thread watches, if any. No query
// may be under way when it begins or ends.
class QueryWatch {
 public:
  explicit QueryWatch(EmbreeScene& geometry);
  ~QueryWatch();

  // Has the calling thread watch the space while this lives.
  class OfThread {
   public:
    explicit OfThread(QueriedSpace& space);
    ~OfThread();
    OfThread(const OfThread&) = delete;
    OfThread& operator=(const OfThread&) = delete;
  };

 private:
  class Queries;
  EmbreeScene& geometry_;
  std::unique_ptr<const Queries> queries_;
};

}  // namespace echopath
