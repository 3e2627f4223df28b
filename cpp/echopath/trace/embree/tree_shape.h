#pragma once
// Tells in which shape of a mesh its tree is grown; as it moves, the boxes of that tree are fitted to it.
#include <array>
#include <cstdint>
#include <vector>

#include "echopath/scene/mesh/mesh.h"

namespace echopath {

// The shape follows from the mesh and where its vertices are now, not from where they were before: the shape of the mesh at
// rest, turned by the nearest of a grid of rotations, or its present one where it is bent by more than that.
struct TreeShape {
  bool is_present = true;
  std::array<int8_t, 9> turn{};  // the rotation, column by column, in units of kTurnStep

  static constexpr double kTurnStep = 0.25;
  bool operator==(const TreeShape&) const = default;
  Mat3 rotation() const;
};

// Returns the shape of the tree of a rigid mesh for the linear part of its pose.
TreeShape shape_of_rigid(const Mesh& mesh, const Mat3& linear, const std::vector<Vec3>& vertices);
// Returns the shape of the tree of a mesh that deforms, from its present vertices. Cost: 5 ns a triangle, where a tree costs
// 200 and its fit 6.
TreeShape shape_of_deformed(const Mesh& mesh, const std::vector<Vec3>& vertices);

}  // namespace echopath
