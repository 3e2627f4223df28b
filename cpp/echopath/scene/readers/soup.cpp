#include "echopath/scene/readers/soup.h"

#include "echopath/scene/polygons/triangulate.h"

namespace echopath {

void Soup::add_polygon(const std::vector<uint32_t>& polygon, uint32_t group_index,
                       const std::vector<uint32_t>& its_normals) {
  for (const Triangle& places : triangulate(vertices, polygon)) {
    if (!its_normals.empty()) {
      normal.resize(triangles.size(), kNoNormals);
      normal.push_back({its_normals[places[0]], its_normals[places[1]], its_normals[places[2]]});
    }
    triangles.push_back({polygon[places[0]], polygon[places[1]], polygon[places[2]]});
    face.push_back(num_faces());
    group.push_back(group_index);
  }
  corners.insert(corners.end(), polygon.begin(), polygon.end());
  num_corners.push_back(static_cast<uint32_t>(polygon.size()));
}

}  // namespace echopath
