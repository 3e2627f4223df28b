#include "echopath/power/interval/triangle_points.h"

#include <algorithm>
#include <cmath>

namespace echopath {
namespace {

constexpr double kOfEven = 0.9;

}  // namespace

void TrianglePoints::add(const Hit& hit, double power) {
  if (!(power > 0.0)) return;
  if (hit.mesh_id != mesh_id_ || hit.triangle_id != triangle_id_) {
    before_ += of_triangle();
    levels_.clear();
    mesh_id_ = hit.mesh_id;
    triangle_id_ = hit.triangle_id;
  }
  const int exponent = static_cast<int>(std::floor(0.5 * std::log2(power)));
  auto level = std::ranges::find_if(levels_, [&](const Level& one) { return one.exponent == exponent; });
  if (level == levels_.end()) level = levels_.insert(level, Level{exponent});
  level->count += 1.0;
  level->squares += power * power;
}

double TrianglePoints::variance() const { return before_ + of_triangle(); }

double TrianglePoints::of_triangle() const {
  double sum = 0.0;
  for (const Level& level : levels_) sum += kOfEven * level.squares / std::sqrt(level.count);
  return sum;
}

}  // namespace echopath
