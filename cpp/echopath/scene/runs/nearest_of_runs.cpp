#include "echopath/scene/runs/nearest_of_runs.h"

#include <cmath>

namespace echopath {
namespace {

constexpr double kRounding = 1e-9;  // relative to a length, more than that of posed vertices

// Returns a factor by which a map lengthens nothing more: a bound of its largest singular value, which a rotation meets.
double largest_stretch(const Mat3& linear) {
  return std::sqrt((linear.transpose() * linear).cwiseAbs().rowwise().sum().maxCoeff());
}

}  // namespace

Vec3 nearest_of_triangle(const std::array<Vec3, 3>& corners, const Vec3& point) {
  const auto& [a, b, c] = corners;
  const Vec3 normal = cross_of_sides(a, b, c);
  const double square = normal.squaredNorm();
  bool is_above = square > 0.0;  // the foot of the perpendicular lies on the inner side of all three edges
  Vec3 nearest = a;
  for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
    is_above = is_above && normal.cross(to - from).dot(point - from) >= 0.0;
    const Vec3 on_edge = nearest_of_segment(point, from, to);
    if ((on_edge - point).squaredNorm() < (nearest - point).squaredNorm()) nearest = on_edge;
  }
  return is_above ? Vec3(point - normal.dot(point - a) / square * normal) : nearest;
}

FrameOfBoxes FrameOfBoxes::mapped(const Mat3& linear, const Vec3& place) {
  const Mat3 to_boxes = linear.inverse();
  return {to_boxes, place, 1.0 / largest_stretch(to_boxes), largest_stretch(linear)};
}

std::vector<std::pair<double, uint32_t>> NearestOfRuns::runs_within(double limit, const Vec3& point) const {
  const Vec3 at = frame_.to_boxes * (point - frame_.place);
  std::vector<std::pair<double, uint32_t>> runs;
  double nearest_end = limit;
  for (uint32_t run = 0; run < boxes_.size(); ++run) {
    const Box& box = boxes_[run];
    const double begin = box.exteriorDistance(at) * frame_.shortest * (1.0 - kRounding);
    if (begin >= nearest_end) continue;
    const Vec3 farthest = (at - box.min()).cwiseAbs().cwiseMax((at - box.max()).cwiseAbs());
    nearest_end = std::min(nearest_end, farthest.norm() * frame_.longest * (1.0 + kRounding));
    runs.emplace_back(begin, run);
  }
  std::erase_if(runs, [&](const auto& run) { return run.first > nearest_end; });
  std::ranges::sort(runs);
  return runs;
}

// Most triangles need not be asked more about than the box about them.
bool NearestOfRuns::is_box_nearer(const std::array<Vec3, 3>& corners, const Vec3& point, double least) {
  const auto& [a, b, c] = corners;
  const Vec3 below = a.cwiseMin(b).cwiseMin(c) - point, above = point - a.cwiseMax(b).cwiseMax(c);
  return below.cwiseMax(above).cwiseMax(0.0).squaredNorm() < least * least;
}

}  // namespace echopath
