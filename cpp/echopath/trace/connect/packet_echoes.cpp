#include "echopath/trace/connect/packet_echoes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "echopath/base/lanes/simd.h"
#include "echopath/trace/sbr/weight.h"

namespace echopath {
namespace {

// Weighs the echoes of one ray's cell by physical optics and of its patch with a random phase (Connector tells why).
ECHOPATH_INLINE void weigh_lanes(const FirstHits* first, EchoWeights* out) {
  ECHOPATH_SIDE_BY_SIDE
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const double distance = first->hits.distance[lane], re = first->gamma_re[lane], im = first->gamma_im[lane];
    const double area = distance * distance / (first->densities[lane] * first->cos_incidence[lane]);
    const double field = area * first->hits.stretch[lane] * first->coherent[lane] * first->sign[lane];
    out->field_re[lane] = static_cast<float>(-im * field);
    out->field_im[lane] = static_cast<float>(re * field);
    const double power = ScalarMath::root(area) * first->facet[lane] * first->diffuse[lane];
    out->power_re[lane] = static_cast<float>(power * first->samples.phase_re[lane]);
    out->power_im[lane] = static_cast<float>(power * first->samples.phase_im[lane]);
  }
}

// Sets the matrix of a hit between a launch, whose horizontal field is (x, y) of TE and TM and whose vertical one is (y,
// -x), and straight ways on: re and im of each entry of a JonesMatrix.
ECHOPATH_INLINE void set_entries(const BasisAcross& launched, const ModeAxes& modes, const HitMatrix& hit, double scale,
                                 LanesOf<float> (*to)[2], int lane) {
  const double x = scale * dot(launched.horizontal, modes.te), y = scale * dot(launched.vertical, modes.te);
  const auto set = [&](int entry, const ComplexOf<double>& te, const ComplexOf<double>& tm) {
    to[entry][0][lane] = static_cast<float>(x * te.re + y * tm.re);
    to[entry][1][lane] = static_cast<float>(x * te.im + y * tm.im);
    to[entry + 1][0][lane] = static_cast<float>(y * te.re - x * tm.re);
    to[entry + 1][1][lane] = static_cast<float>(y * te.im - x * tm.im);
  };
  set(0, hit.h_te, hit.h_tm);
  set(2, hit.v_te, hit.v_tm);
}

ECHOPATH_INLINE void weigh_lanes_without_coefficients(const FirstHits* first, EchoWeights* out) {
  ECHOPATH_SIDE_BY_SIDE
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const double distance = first->hits.distance[lane], cos_incidence = first->cos_incidence[lane];
    const double area = distance * distance / (first->densities[lane] * cos_incidence), root_area = ScalarMath::root(area);
    out->field_re[lane] = 0.0f;
    out->field_im[lane] = static_cast<float>(area * first->hits.stretch[lane]);
    out->power_re[lane] = static_cast<float>(root_area * first->samples.phase_re[lane]);
    out->power_im[lane] = static_cast<float>(root_area * first->samples.phase_im[lane]);
  }
}

ECHOPATH_INLINE HitGeometryOfModes geometry_at(const FirstHits* first, int lane, const VectorOf<double>& line,
                                               double inverse) {
  return hit_geometry(first->directions.at(lane), first->hits.normal.at(lane), inverse * line);
}

// Finds the matrices of the coherent echoes (JonesWeight).
ECHOPATH_INLINE void polarize_lanes(const FirstHits* first, const LaneModes* modes, VectorOf<double> receiver,
                                    LanesOf<float> (*field)[2]) {
  ECHOPATH_SIDE_BY_SIDE
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const VectorOf<double> line = receiver - first->hits.position.at(lane);
    const double inverse = 1.0 / ScalarMath::root(dot(line, line));
    const HitGeometryOfModes hit = geometry_at(first, lane, line, inverse);
    const ComplexOf<double> te{modes->te_re[lane], modes->te_im[lane]}, tm{modes->tm_re[lane], modes->tm_im[lane]};
    const double scale =
        first->coherent[lane] * polarized_scale(first->cos_incidence[lane], inverse * first->cos_receiver[lane]);
    set_entries(basis_across(first->directions.at(lane)), hit.modes, radiated_modes(hit, te, tm), scale, field, lane);
  }
}

// Finds the matrices of the diffuse echoes.
ECHOPATH_INLINE void depolarize_lanes(const FirstHits* first, const LaneModes* modes, VectorOf<double> receiver,
                                      LanesOf<float> (*power)[2]) {
  ECHOPATH_SIDE_BY_SIDE
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const VectorOf<double> line = receiver - first->hits.position.at(lane);
    const HitGeometryOfModes hit = geometry_at(first, lane, line, 1.0 / ScalarMath::root(dot(line, line)));
    const AxisInModes axis = scattering_axis(hit, modes->axis_cosine[lane], modes->axis_sine[lane]);
    const HitMatrix matrix = scattered_modes(hit, first->facet[lane], mixing_of(modes->cross_share[lane]), axis);
    set_entries(basis_across(first->directions.at(lane)), hit.modes, matrix, first->diffuse[lane], power, lane);
  }
}

// Returns whether the hit of a lane sends an echo that the receiver sees.
bool is_open(const FirstHits& first, int lane) { return first.receiver[lane] == ShadowState::kOpen; }

bool any_open(const FirstHits& first) {
  return std::ranges::find(first.receiver, ShadowState::kOpen) != first.receiver.end();
}

bool any_scatters(const FirstHits& first) {
  for (int lane = 0; lane < first.count; ++lane) {
    if (is_open(first, lane) && first.diffuse[lane] > 0) return true;
  }
  return false;
}

JonesMatrix entries_of(const LaneMatrices& from, int lane) {
  const auto entry = [&](size_t i) { return std::complex<float>(from[i][0][lane], from[i][1][lane]); };
  return {entry(0), entry(1), entry(2), entry(3)};
}

}  // namespace

void ScalarEchoes::find(const FirstHits& first, const Vec3&) {
  if (any_open(first)) run_simd<&weigh_lanes>(&first, &weights_);
}

void JonesEchoes::find(const FirstHits& first, const Vec3& receiver) {
  if (!any_open(first)) return;
  for (int lane = 0; lane < first.count; ++lane) {
    if (is_open(first, lane)) find_modes(first, lane);
  }
  run_simd<&weigh_lanes_without_coefficients>(&first, &weights_);
  run_simd<&polarize_lanes>(&first, &std::as_const(modes_), unpacked(receiver), field_matrices_);
  if (any_scatters(first)) {
    run_simd<&depolarize_lanes>(&first, &std::as_const(modes_), unpacked(receiver), power_matrices_);
  }
}

// Finds how the surface of a lane's hit reflects and scatters field vectors.
void JonesEchoes::find_modes(const FirstHits& first, int lane) {
  const SurfaceModel& model = *first.models[lane];
  const ModeCoefficients modes = model.modes(first.cos_incidence[lane]);
  modes_.te_re[lane] = modes.te.real();
  modes_.te_im[lane] = modes.te.imag();
  modes_.tm_re[lane] = modes.tm.real();
  modes_.tm_im[lane] = modes.tm.imag();
  const double share = modes_.cross_share[lane] = model.material().cross_polarization;
  const double axis = share > 0 ? kPi * first.samples.axis_sample[lane] : 0.0;
  modes_.axis_cosine[lane] = share > 0 ? std::cos(axis) : 1.0;
  modes_.axis_sine[lane] = share > 0 ? std::sin(axis) : 0.0;
}

void JonesEchoes::add(const FirstHits& first, int lane, PathBlock& block) const {
  if (first.receiver[lane] != ShadowState::kOpen) return;
  if (first.coherent[lane] > 0) {
    block.add_prefix(1, 0, weights_.field(lane), first.places.strata[lane]);
    block.set_jones(entries_of(field_matrices_, lane));
  }
  if (first.diffuse[lane] > 0) {
    block.add_prefix(1, 1, weights_.power(lane), first.places.strata[lane]);
    block.set_jones(entries_of(power_matrices_, lane));
  }
}

}  // namespace echopath
