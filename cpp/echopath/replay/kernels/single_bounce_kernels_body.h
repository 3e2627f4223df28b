#pragma once
// Holds the loops of single_bounce_kernels.h, compiled once per instruction set (base/lanes/lane_math.h).
#include "echopath/replay/kernels/single_bounce_places_body.h"

namespace echopath::ECHOPATH_KERNELS {
namespace {

// Describes a launch cell on a flat triangle for the formulas of cell_formula.h, which ask for its curvature, too.
struct FlatCell {
  static constexpr bool is_curved = false;
  static constexpr double turn[3] = {0.0, 0.0, 0.0}, second_form[3] = {0.0, 0.0, 0.0};
  Vec product[3];
};

struct PointLanes {
  VectorOf<Vec> point, normal, tangent[2];
};

ECHOPATH_INLINE PointLanes points_at(const SingleBounceSlots& slots, size_t slot) {
  return {vector_at(slots.point, slot),
          vector_at(slots.normal, slot),
          {vector_at(slots.tangent[0], slot), vector_at(slots.tangent[1], slot)}};
}

// Returns the components (ComponentsToFind) of a leg along `line`, of which `inverse` is one over the length (1/m).
ECHOPATH_INLINE TransverseOf<Vec> transverse_over(const SingleBouncesToEvaluate& paths, const SingleBounceAntenna& antenna,
                                                  size_t node, const VectorOf<Vec>& line, Vec inverse,
                                                  const AxesAcross<Vec>& recorded) {
  const auto value = [&](const double* rows, int row) { return rows[static_cast<size_t>(row) * paths.stride + node]; };
  const auto along = [&](int axis) {
    const int row = ComponentsToFind::kAxes + 3 * axis;
    return value(paths.axes, row) * line.x + value(paths.axes, row + 1) * line.y + value(paths.axes, row + 2) * line.z;
  };
  const double* own = antenna.polarization;
  return transverse_of<LaneMath>(VectorOf<Vec>{all(value(own, 0)), all(value(own, 1)), all(value(own, 2))},
                                 inverse * VectorOf<Vec>{along(0), along(1), along(2)}, recorded);
}

// Returns the axes of the matrices at one end.
ECHOPATH_INLINE AxesAcross<Vec> recorded_axes(const SingleBouncesToEvaluate& paths, int end, const VectorOf<Vec>& point) {
  const double* antenna = paths.traced_antenna[end];
  return axes_across<LaneMath>(VectorOf<Vec>{point.x - antenna[0], point.y - antenna[1], point.z - antenna[2]});
}

template <bool kIsPolarized>
ECHOPATH_INLINE void measure_leg(const SingleBouncesToEvaluate& paths, const SingleBounceAntenna& antenna, size_t node,
                                 const PointLanes& at, const AxesAcross<Vec>& recorded, double* leg) {
  const auto value = [&](int row) { return antenna.rows[static_cast<size_t>(row) * paths.stride + node]; };
  const VectorOf<Vec> line{at.point.x - value(LegToMeasure::kImagePosition),
                           at.point.y - value(LegToMeasure::kImagePosition + 1),
                           at.point.z - value(LegToMeasure::kImagePosition + 2)};
  const Roots distance = roots_of(dot(line, line));
  const Vec inverse = distance.inverse, cosine = -inverse * dot(at.normal, line);
  Vec gain = all(antenna.root_peak);
  if (antenna.exponent != 0) {
    const Vec along = value(LegToMeasure::kBoresight) * line.x + value(LegToMeasure::kBoresight + 1) * line.y +
                      value(LegToMeasure::kBoresight + 2) * line.z;
    gain = root_gain_of<LaneMath>(antenna.root_peak, antenna.exponent, inverse * along);
  }
  const auto set = [&](int row, Vec x) { store(leg + static_cast<size_t>(row) * SingleBounceSlots::kSlots, x); };
  set(SingleBouncesToEvaluate::kLegLength, distance.root);
  set(SingleBouncesToEvaluate::kInverse, inverse);
  const Vec root_cosine = roots_of(LaneMath::magnitude(cosine)).root;
  set(SingleBouncesToEvaluate::kLegFactor, diffuse_leg<LaneMath>(gain, root_cosine, cosine, distance.root, inverse));
  set(SingleBouncesToEvaluate::kGain, gain);
  set(SingleBouncesToEvaluate::kCosine, cosine);
  if constexpr (kIsPolarized) {
    const TransverseOf<Vec> found = transverse_over(paths, antenna, node, line, inverse, recorded);
    set(SingleBouncesToEvaluate::kHorizontal, found.horizontal);
    set(SingleBouncesToEvaluate::kVertical, found.vertical);
  }
  if (!paths.has_coherent) return;
  for (int a = 0; a < 2; ++a) set(SingleBouncesToEvaluate::kAlong + a, inverse * dot(at.tangent[a], line));
}

ECHOPATH_INLINE ComplexOf<Vec> flat_filter_of(const SingleBounceSlots& slots, size_t slot, const CellWaves<Vec>& waves,
                                              const CellFilter& filter, double facet_area) {
  const Vec without = filter.view.weight == CellWeight::kFilter ? all(1.0) : Vec{};
  if (filter.order == Footprint::kNone) return {without, Vec{}};
  const FlatCell cell{{load(slots.product[0] + slot), load(slots.product[1] + slot), load(slots.product[2] + slot)}};
  ComplexOf<Vec> found{};
  if (filter.view.weight != CellWeight::kFilter) {
    found.re = between_rays_of_cell<LaneMath>(cell, is_coarse_cell<LaneMath>(cell.product, facet_area), waves, filter);
  } else if (filter.order == Footprint::kFirstOrder) {
    found.re = first_order_footprint_of<LaneMath>(cell_phase(cell, waves, filter));
  } else {
    WithTurn turn;
    found = flat_cell_filter<LaneMath>(cell_phase(cell, waves, filter), filter, turn);
  }
  const Mask has_cell = load(slots.has_cell + slot) > 0.0;
  return {has_cell ? found.re : without, has_cell ? found.im : Vec{}};
}

// Reads the rows of one leg.
struct LegLanes {
  const double* rows;
  ECHOPATH_INLINE Vec operator()(int row) const { return load(rows + static_cast<size_t>(row) * SingleBounceSlots::kSlots); }
};

// Returns the physical-optics factor over the legs in and out, relative to the weight.
ECHOPATH_INLINE ComplexOf<Vec> coherent_of(const SingleBouncesToEvaluate& paths, const LegLanes& in, const LegLanes& out,
                                           size_t slot) {
  using D = SingleBouncesToEvaluate;
  const Vec cos_in = in(D::kCosine), cos_out = out(D::kCosine);
  CellWaves<Vec> waves;
  set_waves<LaneMath>(cos_in, cos_out, in(D::kInverse), out(D::kInverse), waves);
  for (int a = 0; a < 2; ++a) {
    waves.along_arrival[a] = in(D::kAlong + a);
    waves.along_departure[a] = -out(D::kAlong + a);
  }
  const ComplexOf<Vec> filter = flat_filter_of(*paths.slots, slot, waves, paths.filter, paths.facet_area);
  const Mask lit = is_lit(cos_in, cos_out, in(D::kLegLength), out(D::kLegLength));
  const Vec inverse_tube = inverse_tube_of<LaneMath>(FlatCell::is_curved, 0.0, waves);
  return coherent_factor<Vec>(waves, in(D::kGain) * out(D::kGain), inverse_tube, filter, lit);
}

// Holds the weights of both kinds, multiplied by the polarisations of both ends.
template <bool kIsPolarized>
struct WeightLanes;
template <>
struct WeightLanes<false> {
  const SingleBounceSlots& slots;
  size_t slot;

  ECHOPATH_INLINE WeightLanes(const SingleBounceSlots& from, const LegLanes&, const LegLanes&, size_t first)
      : slots(from), slot(first) {}
  ECHOPATH_INLINE Vec operator()(int kind, int part) const { return load(slots.weight[kind][part] + slot); }
};
template <>
struct WeightLanes<true> {
  const SingleBounceSlots& slots;
  size_t slot;
  PairOfPolarizations<Vec> pairs;

  static ECHOPATH_INLINE TransverseOf<Vec> components(const LegLanes& leg) {
    return {leg(SingleBouncesToEvaluate::kHorizontal), leg(SingleBouncesToEvaluate::kVertical)};
  }
  ECHOPATH_INLINE WeightLanes(const SingleBounceSlots& from, const LegLanes& in, const LegLanes& out, size_t first)
      : slots(from), slot(first), pairs(components(in), components(out)) {}
  ECHOPATH_INLINE Vec operator()(int kind, int part) const {
    const auto entry = [&](int i) { return load(slots.matrix[kind][i][part] + slot); };
    const Vec matrix[] = {entry(0), entry(1), entry(2), entry(3)};
    return pairs.through(matrix);
  }
};

template <bool kIsPolarized>
ECHOPATH_INLINE void combine_legs(const SingleBouncesToEvaluate& paths, const LegLanes& in, const LegLanes& out, size_t slot,
                                  double* to) {
  using D = SingleBouncesToEvaluate;
  const auto set = [&](int row, Vec x) { store(to + static_cast<size_t>(row) * SingleBounceSlots::kSlots + slot, x); };
  const WeightLanes<kIsPolarized> weight(*paths.slots, in, out, slot);
  const auto put = [&](int kind, ComplexOf<Vec> amplitude) {
    set(D::kRe + 2 * kind, amplitude.re);
    set(D::kIm + 2 * kind, amplitude.im);
  };
  const auto weight_of = [&](int kind) { return ComplexOf<Vec>{weight(kind, 0), weight(kind, 1)}; };
  const Vec length = in(D::kLegLength) + out(D::kLegLength);
  set(D::kLength, length);
  const Vec diffuse = diffuse_product<LaneMath>(in(D::kLegFactor), out(D::kLegFactor));
  put(SingleBounceSlots::kDiffuse, amplitude_of<LaneMath>(weight_of(SingleBounceSlots::kDiffuse), diffuse));
  ComplexOf<Vec> factor{};
  if (paths.has_coherent) factor = coherent_of(paths, in, out, slot);
  put(SingleBounceSlots::kCoherent, amplitude_of<LaneMath>(weight_of(SingleBounceSlots::kCoherent), factor));
}

ECHOPATH_INLINE double* leg_of(const SingleBouncesToEvaluate& paths, size_t node, int end, size_t antenna, size_t slot) {
  const size_t num_legs = paths.num_antennas[0] + paths.num_antennas[1],
               of_end = end == 0 || paths.is_monostatic ? 0 : paths.num_antennas[0];
  const size_t leg = node % SingleBouncesToEvaluate::kNodesTogether * num_legs + of_end + antenna;
  return paths.legs + leg * SingleBouncesToEvaluate::kNumLegRows * SingleBounceSlots::kSlots + slot;
}

// Notes at node 0 which sides the points show to the first antennas, and at the last node whether these have changed.
ECHOPATH_INLINE void see_sides(const SingleBouncesToEvaluate& paths, size_t node, size_t slot, Mask* first) {
  Mask turned = {};
  for (int end = 0; end < 2; ++end) {
    const Mask side = bits(LegLanes{leg_of(paths, node, end, 0, slot)}(SingleBouncesToEvaluate::kCosine)) < 0;
    if (node == 0) first[end] = side;
    turned |= side ^ first[end];
  }
  store(paths.turned + slot, turned ? all(1.0) : Vec{});
}

// Returns the size of the weight of the coherent paths, between the polarisations that it serves best.
ECHOPATH_INLINE Vec size_of_weight(const SingleBouncesToEvaluate& paths, size_t slot) {
  constexpr auto kKind = SingleBounceSlots::kCoherent;
  const SingleBounceSlots& slots = *paths.slots;
  Vec largest{};
  for (int i = 0; i < (paths.axes ? 4 : 1); ++i) {
    const auto& parts = paths.axes ? slots.matrix[kKind][i] : slots.weight[kKind];
    const Vec re = load(parts[0] + slot), im = load(parts[1] + slot);
    largest = LaneMath::larger(largest, re * re + im * im);
  }
  return LaneMath::root(largest);
}

ECHOPATH_INLINE void store_unfiltered(const SingleBouncesToEvaluate& paths, size_t slot) {
  using D = SingleBouncesToEvaluate;
  const LegLanes in{leg_of(paths, 0, 0, 0, slot)}, out{leg_of(paths, 0, 1, 0, slot)};
  const Vec gains = in(D::kGain) * out(D::kGain), cos_in = LaneMath::magnitude(in(D::kCosine));
  const Vec of_cell = size_of_weight(paths, slot) * coherent_size(gains, cos_in, in(D::kInverse), out(D::kInverse));
  const Vec of_mirror = paths.mirror_scale * mirror_size(gains, in(D::kLegLength) + out(D::kLegLength));
  store(paths.unfiltered + slot, LaneMath::smaller(of_cell, of_mirror));
}

template <bool kIsPolarized>
ECHOPATH_INLINE void measure_legs(const SingleBouncesToEvaluate& paths, size_t node, size_t slot,
                                  const AxesAcross<Vec>* recorded) {
  const PointLanes at = points_at(*paths.slots, slot);
  for (int end = 0; end < (paths.is_monostatic ? 1 : 2); ++end) {
    for (size_t a = 0; a < paths.num_antennas[end]; ++a) {
      measure_leg<kIsPolarized>(paths, paths.antennas[end][a], node, at, recorded[end], leg_of(paths, node, end, a, slot));
    }
  }
}

template <bool kIsPolarized>
ECHOPATH_INLINE void combine_node(const SingleBouncesToEvaluate& paths, size_t node, size_t slot) {
  constexpr size_t kOfNode = SingleBouncesToEvaluate::kNumRows * SingleBounceSlots::kSlots;
  const size_t num_receivers = paths.num_antennas[1];
  for (size_t i = 0; i < paths.num_channels; ++i) {
    const size_t channel = paths.first_channel + i;
    const LegLanes in{leg_of(paths, node, 0, channel / num_receivers, slot)};
    const LegLanes out{leg_of(paths, node, 1, channel % num_receivers, slot)};
    combine_legs<kIsPolarized>(paths, in, out, slot, paths.out + (i * paths.num_nodes + node) * kOfNode);
  }
}

// The legs of several nodes come first, then the paths over them: so the processor works on several nodes at a time while
// each waits for its own results.
template <bool kIsPolarized>
void evaluate_all(const SingleBouncesToEvaluate& paths) {
  constexpr size_t kTogether = SingleBouncesToEvaluate::kNodesTogether;
  Mask sides[2] = {};
  for (size_t slot = 0; slot < SingleBounceSlots::kSlots; slot += kLanes) {
    AxesAcross<Vec> recorded[2];
    if constexpr (kIsPolarized) {
      for (int end = 0; end < 2; ++end) recorded[end] = recorded_axes(paths, end, vector_at(paths.slots->point, slot));
    }
    for (size_t first = 0; first < paths.num_nodes; first += kTogether) {
      const size_t end = first + kTogether < paths.num_nodes ? first + kTogether : paths.num_nodes;
      for (size_t node = first; node < end; ++node) measure_legs<kIsPolarized>(paths, node, slot, recorded);
      if (first == 0) {
        see_sides(paths, 0, slot, sides);
        store_unfiltered(paths, slot);
      }
      if (end == paths.num_nodes) see_sides(paths, end - 1, slot, sides);
      for (size_t node = first; node < end; ++node) combine_node<kIsPolarized>(paths, node, slot);
    }
  }
}

void evaluate(const SingleBouncesToEvaluate& paths) {
  if (paths.axes) evaluate_all<true>(paths);
  else evaluate_all<false>(paths);
}

constexpr ForRows<SingleBounceKernels> kSingleBounceKernels = {{see<LaneMath>, prepare, evaluate},
                                                               {see<OneMath>, prepare, evaluate}};

}  // namespace
}  // namespace echopath::ECHOPATH_KERNELS

namespace echopath {

template <>
const ForRows<SingleBounceKernels>& kernels_for<ForRows<SingleBounceKernels>, ECHOPATH_KERNELS::kInstructionSet>() {
  return ECHOPATH_KERNELS::kSingleBounceKernels;
}

}  // namespace echopath
