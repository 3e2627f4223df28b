#include "echopath/trace/geometry/convex_hull.h"

#include <algorithm>

namespace echopath {
namespace {

bool turns_left(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& next) {
  return (b[0] - a[0]) * (next[1] - a[1]) - (b[1] - a[1]) * (next[0] - a[0]) > 0;
}

}  // namespace

PlanePoints convex_hull(PlanePoints points) {
  const auto before = [](const auto& a, const auto& b) { return a[0] != b[0] ? a[0] < b[0] : a[1] < b[1]; };
  std::ranges::sort(points, before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  PlanePoints hull;
  for (const bool upper : {false, true}) {
    const size_t begin = hull.size();
    for (const Eigen::Vector2d& point : points) {
      while (hull.size() >= begin + 2 && !turns_left(hull[hull.size() - 2], hull.back(), point)) hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();  // begins the other half
    if (!upper) std::ranges::reverse(points);
  }
  return hull;
}

}  // namespace echopath
