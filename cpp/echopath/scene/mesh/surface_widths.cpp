#include "echopath/scene/mesh/surface_widths.h"

#include <algorithm>

#include "echopath/base/principal_box.h"

namespace echopath {
namespace {

double middle_extent(const std::vector<Vec3>& vertices) {
  Vec3 extents = principal_box(vertices).box.sizes();
  std::ranges::sort(extents);
  return extents[1];
}

}  // namespace

double SurfaceWidths::width_of(const Mesh& mesh, const std::vector<Vec3>& vertices) {
  const double width = middle_extent(vertices);
  if (!mesh.whole()) return width;
  const double at_rest = middle_extent(mesh.vertices());
  return at_rest > 0 ? width_of_whole(*mesh.whole()) * (width / at_rest) : width;
}

double SurfaceWidths::width_of_whole(const Mesh& whole) {
  const auto [entry, is_new] = at_rest_.try_emplace(&whole);
  if (is_new) entry->second = middle_extent(whole.vertices());
  return entry->second;
}

}  // namespace echopath
