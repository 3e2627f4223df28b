// Writes what kernels made of single bounces to the echoes of their paths.
#include "echopath/base/lanes/simd.h"
#include "echopath/replay/evaluate/single_bounces.h"

namespace echopath {
namespace {

constexpr size_t kSlots = SingleBounceSlots::kSlots, kOfNode = SingleBounceEvaluation::kOfNode;

std::complex<double> amplitude_at(const double* values, size_t kind, size_t slot) {
  const double* from = values + (SingleBouncesToEvaluate::kRe + 2 * kind) * kSlots + slot;
  return {from[0], from[kSlots]};
}

// Points to a node of eight points with two paths each that follow each other, and knows the way to the next node.
struct PairNode {
  const double* values;  // [SingleBouncesToEvaluate::Row, slot]
  size_t count, stride;  // of the nodes from this one on, and of their echoes
  double scale;
  double *length, *amplitude;  // of the first path

  ECHOPATH_INLINE void advance() {
    values += kOfNode;
    length += stride;
    amplitude += 2 * stride;
    --count;
  }
};

// Writes the values of pairs side by side.
ECHOPATH_INLINE void put_pairs(PairNode at) {
  for (; at.count > 0; at.advance()) {
    for (size_t slot = 0; slot < kSlots; ++slot) {
      at.length[2 * slot] = at.length[2 * slot + 1] = at.scale * at.values[slot];
      for (size_t row = 0; row < 4; ++row)
        at.amplitude[4 * slot + row] = at.values[(SingleBouncesToEvaluate::kRe + row) * kSlots + slot];
    }
  }
}

// Adds the sums of pairs to their echoes.
ECHOPATH_INLINE void add_pairs(PairNode at) {
  for (; at.count > 0; at.advance()) {
    for (size_t slot = 0; slot < kSlots; ++slot) {
      at.length[slot] = at.scale * at.values[slot];
      for (size_t part = 0; part < 2; ++part) {
        const double* kinds = at.values + (SingleBouncesToEvaluate::kRe + part) * kSlots + slot;
        at.amplitude[2 * slot + part] += kinds[0] + kinds[2 * kSlots];
      }
    }
  }
}

// Returns whether all points have both paths, and whether their echoes follow each other at these steps: `kinds` from kind
// to kind, `pairs` from point to point.
bool are_neighbours(std::span<const SharedLegPlan::SingleBounce* const> points, const ChannelNodes& to, size_t kinds,
                    size_t pairs) {
  if (points.size() != kSlots || !points[0]->has_path(0) || !points[0]->has_path(1)) return false;
  const size_t first = to.echo(points[0]->place[0]);
  for (size_t slot = 0; slot < kSlots; ++slot) {
    const SharedLegPlan::SingleBounce& point = *points[slot];
    if (!point.has_path(0) || !point.has_path(1)) return false;
    if (to.echo(point.place[0]) != first + pairs * slot || to.echo(point.place[1]) != first + pairs * slot + kinds)
      return false;
  }
  return true;
}

PairNode first_node(const SharedLegPlan::SingleBounce& first, const ChannelNodes& to, const double* values,
                    size_t num_nodes) {
  const size_t echo = to.echo(first.place[0]);
  return {values, num_nodes, to.stride, to.scale, to.length + echo, reinterpret_cast<double*>(to.amplitude + echo)};
}

// Returns whether both paths of a point go to one echo, or there is only one.
bool is_one_echo(const SharedLegPlan::SingleBounce& point, const ChannelNodes& to) {
  return !point.has_path(0) || !point.has_path(1) || to.echo(point.place[0]) == to.echo(point.place[1]);
}

}  // namespace

void SingleBounceEvaluation::put(Points points, const ChannelNodes& to, const double* values) const {
  if (to.echo_of) return put_joined(points, to, values);
  if (are_neighbours(points, to, 1, 2)) {
    return run_simd<put_pairs>(first_node(*points[0], to, values, work_.num_nodes));
  }
  for (size_t node = 0; node < work_.num_nodes; ++node, values += kOfNode) {
    for (size_t slot = 0; slot < points.size(); ++slot) {
      for (size_t kind = 0; kind < SingleBounceSlots::kNumKinds; ++kind) {
        if (points[slot]->has_path(kind))
          to.set(node, points[slot]->place[kind], values[slot], amplitude_at(values, kind, slot));
      }
    }
  }
}

// A path that does not exist has amplitude 0.
void SingleBounceEvaluation::put_joined(Points points, const ChannelNodes& to, const double* values) const {
  if (are_neighbours(points, to, 0, 1)) {
    return run_simd<add_pairs>(first_node(*points[0], to, values, work_.num_nodes));
  }
  for (size_t node = 0; node < work_.num_nodes; ++node, values += kOfNode) {
    for (size_t slot = 0; slot < points.size(); ++slot) {
      const SharedLegPlan::SingleBounce& point = *points[slot];
      const std::complex<double> coherent = amplitude_at(values, 0, slot), diffuse = amplitude_at(values, 1, slot);
      if (is_one_echo(point, to)) {
        to.set(node, point.place[point.has_path(0) ? 0 : 1], values[slot], coherent + diffuse);
      } else {
        to.set(node, point.place[0], values[slot], coherent);
        to.set(node, point.place[1], values[slot], diffuse);
      }
    }
  }
}

}  // namespace echopath
