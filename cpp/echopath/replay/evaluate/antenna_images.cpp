// Poses antennas and their images over mirrors, and measures the legs from them.
#include "echopath/replay/evaluate/shared_leg_tables.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/plane.h"
#include "echopath/replay/kernels/path_formula.h"

namespace echopath {
namespace {

constexpr int kMaxExponent = 16;  // of gains that are products of cosines

// Stores the axes of the antennas themselves (image 0), which tables of gains need.
void store_axes(const PosedNodes& nodes, bool of_receivers, AntennaImages& images) {
  for (size_t node = 0; node < nodes.size(); ++node) {
    for (size_t antenna = 0; antenna < images.num_antennas; ++antenna) {
      images.antenna_from_image[antenna * nodes.size() + node] =
          nodes.at(node).antennas(of_receivers)[antenna].antenna_from_world;
    }
  }
}

// Reflects one image in one more mirror: `from` and `to` are entries (image * num_antennas + antenna).
void store_image(const NodeRows& planes, size_t mirror, size_t from, size_t to, AntennaImages& images) {
  const size_t num_nodes = images.rows.num_nodes();
  for (size_t node = 0; node < num_nodes; ++node) {
    const Vec3 normal = load(planes, mirror, 0, node);
    const Plane plane{planes.row(mirror, 3)[node] * normal, normal};
    store(plane.image(load(images.rows, from, LegToMeasure::kImagePosition, node)), images.rows, to,
          LegToMeasure::kImagePosition, node);
    store(plane.mirrored(load(images.rows, from, LegToMeasure::kBoresight, node)), images.rows, to, LegToMeasure::kBoresight,
          node);
    if (images.antenna_from_image.empty()) continue;
    images.antenna_from_image[to * num_nodes + node] =
        images.antenna_from_image[from * num_nodes + node] * reflection(normal);
  }
  pad(images.rows, to, LegToMeasure::kNumImageRows);
}

}  // namespace

int exponent_of(const AntennaPattern& pattern) {
  if (pattern.kind == AntennaPattern::Kind::kIsotropic) return 0;
  if (pattern.kind == AntennaPattern::Kind::kTable || pattern.exponent > kMaxExponent) return LegToMeasure::kNoExponent;
  const int whole = static_cast<int>(pattern.exponent);
  // Behind the antenna there is no gain even where the exponent is 0, which the kernel takes as a gain in all directions.
  return whole == pattern.exponent && whole > 0 ? whole : LegToMeasure::kNoExponent;
}

// Turns the cosines that the kernel left into gains and factors.
void AntennaImages::finish(size_t entry, const double* point, double* out, double* phase) const {
  const size_t num_nodes = rows.num_nodes(), stride = rows.stride();
  const AntennaPattern& of = *pattern[entry % num_antennas];
  const double* length = out + LegToMeasure::kLength * stride;
  double *factor = out + LegToMeasure::kFactor * stride, *gain = out + LegToMeasure::kGain * stride;
  for (size_t node = 0; node < num_nodes; ++node) {
    const AntennaGain found = of.toward(gain[node], [&] {
      const Vec3 at(point[node], point[stride + node], point[2 * stride + node]);
      const Vec3 direction = (at - load(rows, entry, LegToMeasure::kImagePosition, node)).normalized();
      return Vec3(antenna_from_image[entry * num_nodes + node] * direction);
    });
    gain[node] = std::sqrt(found.power);
    factor[node] = diffuse_leg<ScalarMath>(gain[node], factor[node], length[node]);
    if (phase) phase[node] = found.phase;
  }
}

void AntennaImages::measure(size_t entry, const double* point, double* out, double* phase) const {
  const AntennaPattern& of = *pattern[entry % num_antennas];
  const int exponent = exponent_of(of);
  const size_t stride = rows.stride();
  shared_leg_kernels(stride).measure({rows.row(entry, 0), point, exponent, std::sqrt(of.peak_gain), out}, stride);
  if (phase) std::fill_n(phase, stride, 0.0);
  if (exponent == LegToMeasure::kNoExponent) finish(entry, point, out, phase);
}

void AntennaImages::find(const SharedLegPlan& plan, const NodeRows& mirrors, const PosedNodes& nodes, bool of_receivers) {
  const std::vector<PosedAntenna>& antennas = nodes.at(0).antennas(of_receivers);
  const NodeRows& own = nodes.antennas[of_receivers];
  num_antennas = antennas.size();
  pattern.clear();
  bool has_table = false;
  for (const PosedAntenna& antenna : antennas) {
    pattern.push_back(antenna.pattern);
    has_table = has_table || antenna.pattern->kind == AntennaPattern::Kind::kTable;
  }
  const size_t num_entries = plan.images.size() * num_antennas;
  rows.resize(num_entries, LegToMeasure::kNumImageRows, nodes.size());
  antenna_from_image.resize(has_table ? num_entries * nodes.size() : 0);
  if (has_table) store_axes(nodes, of_receivers, *this);
  for (size_t antenna = 0; antenna < num_antennas; ++antenna) {
    std::copy_n(own.row(antenna, 0), LegToMeasure::kNumImageRows * rows.stride(), rows.row(antenna, 0));
  }
  for (size_t image = 1; image < plan.images.size(); ++image) {
    for (size_t antenna = 0; antenna < num_antennas; ++antenna) {
      store_image(mirrors, plan.images[image].mirror, plan.images[image].parent * num_antennas + antenna,
                  image * num_antennas + antenna, *this);
    }
  }
}

}  // namespace echopath
