#include "echopath/scene/runs/triangle_runs.h"

namespace echopath {

std::vector<Box> find_boxes_of_runs(const std::vector<Vec3>& vertices,
                                    const std::vector<std::array<uint32_t, 3>>& triangles) {
  std::vector<Box> boxes((triangles.size() + kRunLength - 1) / kRunLength);
  for (size_t i = 0; i < triangles.size(); ++i) {
    for (const uint32_t vertex : triangles[i]) boxes[i / kRunLength].extend(vertices[vertex]);
  }
  return boxes;
}

}  // namespace echopath
