#include "echopath/scene/readers/corner_tree.h"

#include <algorithm>
#include <numeric>

namespace echopath {
namespace {

// Rounding of `turn`, relative to the lengths that it multiplies, with room to spare.
constexpr double kTurnRounding = 1e-14;

// Returns whether no point of the box can be to the left of the line from a to b, seen against the normal.
bool is_right_of(const Eigen::AlignedBox3d& box, const Vec3& a, const Vec3& b, const Vec3& normal) {
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
      across[static_cast<size_t>(axis)] = direction;
      const Vec3 at(ear.points[0].dot(direction), ear.points[1].dot(direction), ear.points[2].dot(direction));
      const double reach = std::max({ear.points[0].norm(), ear.points[1].norm(), ear.points[2].norm()});
      const double rounding = kTurnRounding * direction.norm() * reach;
      low[axis] = at.minCoeff() - rounding;
      high[axis] = at.maxCoeff() + rounding;
    }
  }

  bool part(const Eigen::AlignedBox3d& box) const {
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3& direction = across[static_cast<size_t>(axis)];
      const Vec3 one = box.min().cwiseProduct(direction), other = box.max().cwiseProduct(direction);
      if (one.cwiseMin(other).sum() > high[axis] || one.cwiseMax(other).sum() < low[axis]) return true;
    }
    return false;
  }
};

bool may_meet(const Eigen::AlignedBox3d& box, const Ear& ear, const Slabs& slabs) {
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
    : vertices_(vertices), corners_(corners), order_(corners.size()), index_of_(corners.size()),
      is_left_(corners.size(), 1) {
  std::iota(order_.begin(), order_.end(), 0u);
  halve(0, static_cast<uint32_t>(order_.size()));
  for (uint32_t index = 0; index < order_.size(); ++index) index_of_[order_[index]] = index;
}

void CornerTree::halve(uint32_t begin, uint32_t end) {
  const size_t index = branches_.size();
  Branch branch{Eigen::AlignedBox3d(), begin, end, 0, end - begin};
  for (uint32_t i = begin; i < end; ++i) branch.box.extend(vertices_[corners_[order_[i]]]);
  branches_.push_back(branch);
  if (end - begin <= kLeafSize) return;
  Eigen::Index axis = 0;
  branch.box.sizes().maxCoeff(&axis);
  const uint32_t half = begin + (end - begin) / 2;
  std::nth_element(order_.data() + begin, order_.data() + half, order_.data() + end, [&](uint32_t a, uint32_t b) {
    const double at_a = vertices_[corners_[a]][axis], at_b = vertices_[corners_[b]][axis];
    return at_a != at_b ? at_a < at_b : a < b;
  });
  halve(begin, half);
  branches_[index].second_half = static_cast<uint32_t>(branches_.size());
  halve(half, end);
}

void CornerTree::remove(uint32_t place) {
  const uint32_t at = index_of_[place];
  is_left_[at] = 0;
  for (uint32_t index = 0;;) {
    Branch& branch = branches_[index];
    --branch.num_left;
    if (branch.second_half == 0) return;
    index = at < branches_[branch.second_half].begin ? index + 1 : branch.second_half;
  }
}

bool CornerTree::has_corner_in(const Ear& ear, const Branch& leaf) const {
  for (uint32_t index = leaf.begin; index < leaf.end; ++index) {
    const uint32_t vertex = corners_[order_[index]];
    const bool is_own = std::find(ear.vertices.begin(), ear.vertices.end(), vertex) != ear.vertices.end();
    if (is_left_[index] && !is_own && ear.holds(vertices_[vertex])) return true;
  }
  return false;
}

bool CornerTree::has_corner_in(const Ear& ear) const {
  std::array<uint32_t, 64> open;  // a depth-first walk keeps one open branch per level, of at most 32 levels
  size_t num_open = 0;
  open[num_open++] = 0;
  const Slabs slabs(ear);
  while (num_open > 0) {
    const uint32_t index = open[--num_open];
    const Branch& branch = branches_[index];
    if (branch.num_left == 0 || !may_meet(branch.box, ear, slabs)) continue;
    if (branch.second_half == 0) {
      if (has_corner_in(ear, branch)) return true;
      continue;
    }
    open[num_open++] = branch.second_half;
    open[num_open++] = index + 1;
  }
  return false;
}

}  // namespace echopath
