#include "echopath/scene/polygons/corner_tree.h"

#include <algorithm>

namespace echopath {
namespace {

// Rounding of `turn`, relative to the lengths that it multiplies, with room to spare.
constexpr double kTurnRounding = 1e-14;
constexpr uint32_t kCornersOfLeaf = 8;

// Returns whether no point of the box can be to the left of the line from a to b, seen against the normal.
bool is_right_of(const Box& box, const Vec3& a, const Vec3& b, const Vec3& normal) {
  const Vec3 line = b - a, left = normal.cross(line);  // turn(a, b, p, normal) = (p - b) . left
  const Vec3 low = box.min() - b, high = box.max() - b;
  const double most = low.cwiseProduct(left).cwiseMax(high.cwiseProduct(left)).sum();
  const double reach = low.cwiseAbs().cwiseMax(high.cwiseAbs()).norm();
  return most < -kTurnRounding * normal.norm() * line.norm() * reach;
}

// Holds what the projections of an ear and of a box along the ear's normal may be parted by, other than the ear's own edges:
// the edges of the box.
struct Slabs {
  std::array<Vec3, 3> across;  // the normal times the axes
  Vec3 low, high;              // of the ear along each, with room for rounding

  explicit Slabs(const Ear& ear) {
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 direction = ear.normal.cross(Vec3::Unit(axis));
      across[axis] = direction;
      const Vec3 at(ear.points[0].dot(direction), ear.points[1].dot(direction), ear.points[2].dot(direction));
      const double reach = std::max({ear.points[0].norm(), ear.points[1].norm(), ear.points[2].norm()});
      const double rounding = kTurnRounding * direction.norm() * reach;
      low[axis] = at.minCoeff() - rounding;
      high[axis] = at.maxCoeff() + rounding;
    }
  }

  bool part(const Box& box) const {
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3& direction = across[axis];
      const Vec3 one = box.min().cwiseProduct(direction), other = box.max().cwiseProduct(direction);
      if (one.cwiseMin(other).sum() > high[axis] || one.cwiseMax(other).sum() < low[axis]) return true;
    }
    return false;
  }
};

bool may_meet(const Box& box, const Ear& ear, const Slabs& slabs) {
  for (size_t i = 0; i < 3; ++i) {
    if (is_right_of(box, ear.points[i], ear.points[(i + 1) % 3], ear.normal)) return false;
  }
  return !slabs.part(box);
}

}  // namespace

bool Ear::holds(const Vec3& point) const {
  for (size_t i = 0; i < 3; ++i) {
    if (!(turn(points[i], points[(i + 1) % 3], point, normal) >= 0.0)) return false;
  }
  return true;
}

CornerTree::CornerTree(const std::vector<Vec3>& vertices, const std::vector<uint32_t>& corners)
    : vertices_(vertices), corners_(corners),
      tree_(static_cast<uint32_t>(corners.size()), [&](uint32_t i) { return Box(vertices[corners[i]]); }, kCornersOfLeaf),
      place_of_(corners.size()), is_left_(corners.size(), 1) {
  for (uint32_t place = 0; place < tree_.size(); ++place) place_of_[tree_.input_index(place)] = place;
  for (const BoxTree::Branch& branch : tree_.branches()) num_left_.push_back(branch.end - branch.begin);
}

void CornerTree::remove(uint32_t corner) {
  const uint32_t place = place_of_[corner];
  is_left_[place] = 0;
  for (uint32_t index = 0;;) {
    --num_left_[index];
    const uint32_t second_half = tree_.branches()[index].second_half;
    if (second_half == 0) return;
    index = place < tree_.branches()[second_half].begin ? index + 1 : second_half;
  }
}

bool CornerTree::has_corner_in(const Ear& ear, const BoxTree::Branch& leaf) const {
  for (uint32_t place = leaf.begin; place < leaf.end; ++place) {
    const uint32_t vertex = corners_[tree_.input_index(place)];
    const bool is_own = std::ranges::find(ear.vertices, vertex) != ear.vertices.end();
    if (is_left_[place] && !is_own && ear.holds(vertices_[vertex])) return true;
  }
  return false;
}

bool CornerTree::has_corner_in(const Ear& ear) const {
  const Slabs slabs(ear);
  const auto may_hold = [&](uint32_t branch) {
    return num_left_[branch] > 0 && may_meet(tree_.branches()[branch].box, ear, slabs);
  };
  bool found = false;
  tree_.walk(may_hold, [&](const BoxTree::Branch& leaf) {
    found = has_corner_in(ear, leaf);
    return !found;
  });
  return found;
}

}  // namespace echopath
