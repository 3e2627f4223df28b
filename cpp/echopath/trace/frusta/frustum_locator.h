#pragma once
// Finds which frusta may light a point: it divides the space about the mirrors into cells, each with the frusta that reach
// into it.
#include <memory>
#include <span>

#include "echopath/trace/frusta/mirror_frusta.h"

namespace echopath {

class FrustumLocator {
 public:
  FrustumLocator() = default;
  // `radius` is in m, as in MirrorFrustum::reaches.
  FrustumLocator(std::span<const MirrorFrustum> frusta, double radius);
  // Returns the indices of all frusta into which a ball about the point reaches, and of some others; ascending. This is
  // thread-safe: cells are halved where the first points come to lie, as most of the space has none.
  std::span<const int> near(const Vec3& point) const;

 private:
  class Cells;
  std::shared_ptr<Cells> cells_;
};

}  // namespace echopath
