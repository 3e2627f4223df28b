#pragma once
// Holds the inner loops of replay, compiled once per instruction set (base/lanes/lane_math.h).
#include "echopath/base/lanes/lane_math.h"
#include "echopath/base/vector_of.h"
#include "echopath/replay/kernels/filter_bound.h"
#include "echopath/replay/kernels/path_formula.h"
#include "echopath/replay/kernels/shared_leg_kernels.h"

namespace echopath::ECHOPATH_KERNELS {
namespace {

// Gives the functions of LaneMath for one node.
struct OneMath : ScalarMath {
  static constexpr size_t kCount = 1;
  static ECHOPATH_INLINE double load(const double* from) { return *from; }
  static ECHOPATH_INLINE void store(double* to, double x) { *to = x; }
};

// Reads and writes rows at some neighbouring nodes.
template <class Math>
struct At {
  using Real = typename Math::Real;
  size_t node, stride;

  ECHOPATH_INLINE Real value(const double* rows, int row) const {
    return Math::load(rows + static_cast<size_t>(row) * stride + node);
  }
  ECHOPATH_INLINE VectorOf<Real> vector(const double* rows, int row) const {
    return {value(rows, row), value(rows, row + 1), value(rows, row + 2)};
  }
  ECHOPATH_INLINE void set(double* rows, int row, Real x) const {
    Math::store(rows + static_cast<size_t>(row) * stride + node, x);
  }
  ECHOPATH_INLINE void set(double* rows, int row, const VectorOf<Real>& v) const {
    set(rows, row, v.x);
    set(rows, row + 1, v.y);
    set(rows, row + 2, v.z);
  }
  // Turns a vector from the frame of a mesh to the world.
  ECHOPATH_INLINE VectorOf<Real> turned(const double* mesh, const double* v) const {
    const auto along = [&](int axis) {
      return value(mesh, 3 * axis) * v[0] + value(mesh, 3 * axis + 1) * v[1] + value(mesh, 3 * axis + 2) * v[2];
    };
    return {along(0), along(1), along(2)};
  }
};

template <class Math>
void pose(const PointToPose& point, size_t stride) {
  for (size_t node = 0; node < stride; node += Math::kCount) {
    const At<Math> at{node, stride};
    const auto turned = at.turned(point.mesh, point.position), moved = at.vector(point.mesh, PointToPose::kTranslation);
    at.set(point.out, PointToPose::kPosition, {turned.x + moved.x, turned.y + moved.y, turned.z + moved.z});
    at.set(point.out, PointToPose::kNormal, at.turned(point.mesh, point.normal));
    at.set(point.out, PointToPose::kAreaRatio, typename Math::Real{} + 1.0);
  }
}

template <class Math>
void measure(const LegToMeasure& leg, size_t stride) {
  for (size_t node = 0; node < stride; node += Math::kCount) {
    const At<Math> at{node, stride};
    const auto line = at.vector(leg.point, PointToPose::kPosition) - at.vector(leg.image, LegToMeasure::kImagePosition);
    const auto length = Math::root(dot(line, line)), inverse = 1.0 / length;
    const auto cosine = -inverse * dot(at.vector(leg.point, PointToPose::kNormal), line);
    const auto boresight = inverse * dot(at.vector(leg.image, LegToMeasure::kBoresight), line);
    at.set(leg.out, LegToMeasure::kLength, length);
    if (leg.exponent == LegToMeasure::kNoExponent) {
      at.set(leg.out, LegToMeasure::kFactor, cosine);
      at.set(leg.out, LegToMeasure::kGain, boresight);
      continue;
    }
    const auto gain = root_gain_of<Math>(leg.root_peak, leg.exponent, boresight);
    at.set(leg.out, LegToMeasure::kFactor, diffuse_leg<Math>(gain, cosine, length));
    at.set(leg.out, LegToMeasure::kGain, gain);
  }
}

template <class Math, class Real>
ECHOPATH_INLINE Real diffuse_size(const DiffusePath& diffuse, const At<Math>& at, Real start, Real end) {
  const double* inner = diffuse.path.inner;
  if (diffuse.begins_specular) {
    start =
        specular_leg(at.value(diffuse.path.start, LegToMeasure::kGain), at.value(diffuse.path.start, LegToMeasure::kLength),
                     at.value(inner, InnerRows::kToFirst), at.value(inner, InnerRows::kRootCosFirst));
  }
  const Real product = diffuse.is_single ? diffuse_product<Math>(start, end)
                                         : diffuse_product<Math>(start, end, at.value(inner, InnerRows::kFirstSign),
                                                                 at.value(inner, InnerRows::kLastSign));
  return product * at.value(inner, InnerRows::kFactor);
}

template <class Math, class Real>
ECHOPATH_INLINE void set_path(const PathToCombine& path, const At<Math>& at, const Real& length,
                              const ComplexOf<Real>& amplitude) {
  at.set(path.out, PathToCombine::kLength, length);
  at.set(path.out, PathToCombine::kRe, amplitude.re);
  at.set(path.out, PathToCombine::kIm, amplitude.im);
}

template <class Math>
void combine(const DiffusePath& diffuse, size_t stride) {
  const PathToCombine& path = diffuse.path;
  for (size_t node = 0; node < stride; node += Math::kCount) {
    const At<Math> at{node, stride};
    auto length = at.value(path.start, LegToMeasure::kLength);  // added up as in `reflect`: both may be of one echo
    const auto start = at.value(path.start, LegToMeasure::kFactor), end = at.value(path.end, LegToMeasure::kFactor);
    auto size = diffuse_product<Math>(start, end);
    if (path.inner) {
      length = length + at.value(path.inner, InnerRows::kLength);
      size = diffuse_size<Math>(diffuse, at, start, end);
    }
    length = length + at.value(path.end, LegToMeasure::kLength);
    set_path(path, at, length, amplitude_of<Math>(path.weight, size));
  }
}

template <class Math>
void connect(const PathToCombine& path, size_t stride) {
  for (size_t node = 0; node < stride; node += Math::kCount) {
    const At<Math> at{node, stride};
    const auto length = at.value(path.start, LegToMeasure::kLength);
    const auto gains = at.value(path.start, LegToMeasure::kGain) * at.value(path.end, LegToMeasure::kGain);
    set_path(path, at, length, amplitude_of<Math>(path.weight, mirror_size(gains, length)));
  }
}

template <class Math>
ECHOPATH_INLINE void set_turn(const PathToCombine&, const At<Math>&, const WithTurn&) {}
template <class Math>
ECHOPATH_INLINE void set_turn(const PathToCombine& path, const At<Math>& at, const TurnApart<typename Math::Real>& apart) {
  at.set(path.out, PathToCombine::kTurn, apart.turn);
}

// Holds a coherent path at some nodes: waves with signed cosines.
template <class Real>
struct CoherentWaves {
  Real first, in, out;  // m: the leg from the first antenna, all before the point, and all behind it
  Real cos_in, cos_out;
  CellWaves<Real> waves;  // as set_waves sets them
};

template <class Math>
ECHOPATH_INLINE CoherentWaves<typename Math::Real> waves_of(const CoherentPath& coherent, const At<Math>& at) {
  using Real = typename Math::Real;
  const PathToCombine& path = coherent.path;
  CoherentWaves<Real> of;
  of.first = at.value(path.start, LegToMeasure::kLength);
  of.out = at.value(path.end, LegToMeasure::kLength);
  const VectorOf<Real> point = at.vector(coherent.point, PointToPose::kPosition),
                       normal = at.vector(coherent.point, PointToPose::kNormal);
  of.in = path.inner ? of.first + at.value(path.inner, InnerRows::kLength) : of.first;
  const Real inverse_in = 1.0 / of.in, inverse_out = 1.0 / of.out;
  const VectorOf<Real> arrival = path.inner
                                     ? at.vector(path.inner, InnerRows::kArrival)
                                     : inverse_in * (point - at.vector(coherent.start_image, LegToMeasure::kImagePosition));
  const VectorOf<Real> departure = inverse_out * (at.vector(coherent.end_image, LegToMeasure::kImagePosition) - point);
  of.cos_in = -dot(normal, arrival);
  of.cos_out = dot(normal, departure);
  set_waves<Math>(of.cos_in, of.cos_out, inverse_in, inverse_out, of.waves);
  for (int a = 0; a < 2; ++a) {
    const VectorOf<Real> tangent = at.turned(coherent.mesh, coherent.tangent[a]);
    of.waves.along_arrival[a] = dot(tangent, arrival);
    of.waves.along_departure[a] = dot(tangent, departure);
  }
  return of;
}

// Turn is WithTurn or TurnApart.
template <class Math, class Turn>
void reflect(const CoherentPath& coherent, size_t begin, size_t end, size_t stride) {
  using Real = typename Math::Real;
  const PathToCombine& path = coherent.path;
  for (size_t node = begin; node < end; node += Math::kCount) {
    const At<Math> at{node, stride};
    const CoherentWaves<Real> of = waves_of<Math>(coherent, at);
    Turn turn;
    const ComplexOf<Real> filter = cell_filter_of<Math>(coherent.cell, of.waves, coherent.filter, turn);
    set_turn<Math>(path, at, turn);
    const Real inverse_tube = inverse_tube_of<Math>(coherent.cell.is_curved, coherent.root_area, of.waves);
    const Real gains = at.value(path.start, LegToMeasure::kGain) * at.value(path.end, LegToMeasure::kGain);
    const ComplexOf<Real> factor =
        coherent_factor(of.waves, gains, inverse_tube, filter, is_lit(of.cos_in, of.cos_out, of.first, of.out));
    const Real length = of.in + of.out;
    set_path(path, at, length, amplitude_of<Math>(path.weight, factor));
  }
}

template <class Math>
void bound(const AmplitudeToBound& work, size_t stride) {
  using Real = typename Math::Real;
  const CoherentPath& coherent = work.path;
  for (size_t node = 0; node < stride; node += Math::kCount) {
    const At<Math> at{node, stride};
    CoherentWaves<Real> of = waves_of<Math>(coherent, at);
    // Both antennas are taken to see the point from one side, whatever the signs of the cosines here: then both cosines
    // count the second fundamental form with the same sign.
    of.waves.cos_in = of.cos_in;
    of.waves.cos_out = of.cos_out;
    of.waves.side = of.cos_in * 0.0 + 1.0;
    const Real in = of.in - work.around_start, out = of.out - work.around_end;
    // An antenna may stand anywhere about a point that is nearer than the array is wide: nothing bounds how waves turn.
    at.set(work.out, AmplitudeToBound::kSpreading,
           Math::smaller(in, out) > 0.0 ? least_spreading(coherent.cell.is_curved, coherent.root_area, in, out) : in * 0.0);
    at.set(work.out, AmplitudeToBound::kFilter,
           largest_cell_filter<Math>(coherent.cell, of.waves, {work.around_start / in, work.around_end / out},
                                     coherent.filter));
  }
}

// Gives all lanes the same axes.
template <class Real>
ECHOPATH_INLINE AxesAcross<Real> in_lanes(const AxesAcross<double>& axes) {
  const auto real = [](double x) { return Real{} + x; };
  const auto vector = [&](const VectorOf<double>& v) { return VectorOf<Real>{real(v.x), real(v.y), real(v.z)}; };
  return {vector(axes.direction),
          vector(axes.horizontal),
          vector(axes.vertical),
          {real(axes.unseen.horizontal), real(axes.unseen.vertical)}};
}

template <class Math>
void find_components(const ComponentsToFind& leg, size_t stride) {
  const auto recorded = in_lanes<typename Math::Real>(leg.recorded);
  for (size_t node = 0; node < stride; node += Math::kCount) {
    const At<Math> at{node, stride};
    const auto line = at.vector(leg.point, PointToPose::kPosition) - at.vector(leg.image, LegToMeasure::kImagePosition);
    const auto along = [&](int axis) { return dot(at.vector(leg.axes, ComponentsToFind::kAxes + 3 * axis), line); };
    const auto inverse = 1.0 / Math::root(dot(line, line));
    const VectorOf<typename Math::Real> at_antenna{along(0), along(1), along(2)};
    const auto found = transverse_of<Math>(at.vector(leg.polarization, 0), inverse * at_antenna, recorded);
    at.set(leg.out, ComponentsToFind::kHorizontal, found.horizontal);
    at.set(leg.out, ComponentsToFind::kVertical, found.vertical);
  }
}

template <class Math>
void polarize(const PathToPolarize& path, size_t stride) {
  using Real = typename Math::Real;
  for (size_t node = 0; node < stride; node += Math::kCount) {
    const At<Math> at{node, stride};
    const auto components = [&](const double* rows) {
      return TransverseOf<Real>{at.value(rows, ComponentsToFind::kHorizontal), at.value(rows, ComponentsToFind::kVertical)};
    };
    const PairOfPolarizations<Real> pairs(components(path.start), components(path.end));
    const Real factor_re = pairs.through(path.re), factor_im = pairs.through(path.im);
    const Real re = at.value(path.out, PathToCombine::kRe), im = at.value(path.out, PathToCombine::kIm);
    at.set(path.out, PathToCombine::kRe, re * factor_re - im * factor_im);
    at.set(path.out, PathToCombine::kIm, re * factor_im + im * factor_re);
  }
}

template <class Math>
constexpr SharedLegKernels kSharedLegKernelsOf = {
    pose<Math>,    measure<Math>,           combine<Math>,
    connect<Math>, reflect<Math, WithTurn>, reflect<Math, TurnApart<typename Math::Real>>,
    bound<Math>,   find_components<Math>,   polarize<Math>};
constexpr ForRows<SharedLegKernels> kSharedLegKernels = {kSharedLegKernelsOf<LaneMath>, kSharedLegKernelsOf<OneMath>};

}  // namespace
}  // namespace echopath::ECHOPATH_KERNELS

namespace echopath {

template <>
const ForRows<SharedLegKernels>& kernels_for<ForRows<SharedLegKernels>, ECHOPATH_KERNELS::kInstructionSet>() {
  return ECHOPATH_KERNELS::kSharedLegKernels;
}

}  // namespace echopath
