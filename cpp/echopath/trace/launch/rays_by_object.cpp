#include "echopath/trace/launch/rays_by_object.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/bit_sum.h"
#include "echopath/trace/launch/launch.h"
#include "echopath/trace/scatter/scatter_points.h"

namespace echopath {
namespace {

constexpr double kStepOfObject = 0.5;  // of the binary logarithm of the rays of an object

uint64_t bits_of(std::string_view name) {
  BitSum sum;
  sum.add(name.size());
  sum.add_bytes(name.data(), name.size());
  return sum.value();
}

// Rounds to one of the steps of a name.
double rounded(double rays, std::string_view name) {
  const double place = static_cast<double>(bits_of(name) >> 11) * 0x1.0p-53;  // in [0, 1)
  return std::exp2(kStepOfObject * (std::round(std::log2(rays) / kStepOfObject + place) - place));
}

}  // namespace

std::vector<int64_t> rays_by_object(const Scene& scene, const std::vector<RayTarget>& targets, bool field_owns_any,
                                    double field_share, int64_t num_rays) {
  if (targets.empty()) return {num_rays};
  const auto all = static_cast<double>(num_rays);
  const double aimed = field_owns_any ? (1.0 - field_share) * all : all;
  double weights = 0.0;
  for (const RayTarget& target : targets) weights += target.weight;
  std::vector<int64_t> rays;
  double dropped = 0.0;
  for (const RayTarget& target : targets) {
    const std::string& name = scene.nodes()[target.stratum.object].name;
    const double of_object = rounded(aimed / weights, name);
    const double of_target = of_object * target.weight;
    const int64_t own = std::llround(of_target);
    const bool is_dropped = own < LaunchPlan::kFewestRays;
    rays.push_back(is_dropped ? 0 : own);
    if (is_dropped) dropped += of_target;
  }
  const double own_of_field = field_owns_any ? field_share * all : 0.0;
  const double of_dropped = dropped > 0.0 ? rounded(dropped, "field of view") : 0.0;
  const bool is_asked = field_owns_any || dropped > 0.0;
  rays.push_back(is_asked ? std::max<int64_t>(1, std::llround(own_of_field + of_dropped)) : 0);
  return rays;
}

int64_t first_number_of(std::string_view stratum) {
  return static_cast<int64_t>(bits_of(stratum) >> 2) / kScatterNetSize * kScatterNetSize;
}

}  // namespace echopath
