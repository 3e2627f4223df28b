#include "echopath/power/shared_phase.h"

#include <bit>

namespace echopath {
namespace {

bool same_point(const Hit& a, const Hit& b) {
  return a.mesh_id == b.mesh_id && a.triangle_id == b.triangle_id && a.u == b.u && a.v == b.v;
}

// Returns the place of the k-th diffuse hit of a path, in travel order.
int diffuse_hit(uint64_t diffuse, int k) {
  for (; k > 0; --k) diffuse &= diffuse - 1;
  return std::countr_zero(diffuse);
}

}  // namespace

bool shares_phase(const Paths& paths, int64_t first, int64_t second) {
  const uint64_t of_first = paths.diffuse[first], of_second = paths.diffuse[second];
  const int count = std::popcount(of_first);
  if (count != std::popcount(of_second)) return false;
  const Hit *a = paths.hits_of(first), *b = paths.hits_of(second);
  if (count == 1) return same_point(a[std::countr_zero(of_first)], b[std::countr_zero(of_second)]);
  bool forward = true, backward = true;
  for (int k = 0; k < count; ++k) {
    const Hit& hit = a[diffuse_hit(of_first, k)];
    forward = forward && same_point(hit, b[diffuse_hit(of_second, k)]);
    backward = backward && same_point(hit, b[diffuse_hit(of_second, count - 1 - k)]);
  }
  return forward || backward;
}

}  // namespace echopath
