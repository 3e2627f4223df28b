#pragma once
// From a record's weight and the geometry of an instant to the length and amplitude of a path: the only home of the formula.
//
// Coherent path (regime C), physical optics at its last material point:
//   a = sqrt(Pt Gt Gr)/(4 pi) * weight * cos_i * F / (sqrt(D) r),   weight = j W_C Gamma s dS
//   dS is that of the time: the stored one times the area of the triangle over its area at the trace,
//   sqrt(D) = unfolded length TX -> point on flat chains (else from the launch cell), r = unfolded length point -> RX,
//   obliquity K = cos_i, F the footprint filter (launch_cell.h).
// Diffuse path (regime D), diffuse hits 1..n, legs unfolded over what lies between:
//   |a|^2 = Pt Gt/(4 pi) * |weight|^2 * cos_in1/r1^2 * prod [f cos_out cos_in / r^2] * f cos_out_n/r_n^2 * lambda^2 Gr/(4 pi)
//   weight = sqrt(prod dS) prod |Gamma| S * (mirror coefficients) * e^{j phi},   f = 1/pi (Lambert).
// Mirrors only: a = weight * lambda sqrt(Pt Gt Gr)/(4 pi L).
// In a polarised trace the matrix of the path (Paths::jones), between the polarisations of both antennas, holds all coefficients.
// Antennas whose tables have a phase turn a by e^{j (phase of transmitter + phase of receiver)}.
// A path whose surface is seen from opposite sides has amplitude 0. The phase of the length is not part of the amplitude.
#include "echopath/replay/cell_formula.h"
#include "echopath/replay/specular_slide.h"

namespace echopath {

// All that the formula knows of sliding hits (specular_slide.h) is where they stand: with SpecularPoints::kFermat the lengths,
// cosines, gains and spreading are those over the moved points, for each antenna at which the path begins; reflection
// coefficients and launch cells stay those of the trace.
struct RadioConstants {
  double transmit_power;  // W
  double wavelength;      // m, at the start frequency
  double wavenumber;      // rad/m
  Footprint footprint = Footprint::kSecondOrder;
  double spread = 0.65;  // of a launch cell (trace/sampler.h)
  SpecularPoints specular = SpecularPoints::kMaterial;
  CellView cells;

  CellFilter filter() const { return {wavenumber, spread, footprint, cells}; }
};

// Those of a record played back with `radar`.
RadioConstants radio_constants(const Paths& paths, const Radar& radar);

// Work space of one thread.
struct EvaluationScratch {
  std::vector<PosedHit> hits, moved;  // at least as many as the path's hits
  std::vector<AntennaLeg> receive;
  SpecularSlide slide;

  explicit EvaluationScratch(int longest) : hits(static_cast<size_t>(longest) + 1), moved(hits.size()) {}
};

struct ChannelValues {
  double* length;                    // m
  std::complex<double>* amplitude;   // sqrt(W)
  int64_t stride;                    // distance between channels in both
};

// Lengths and amplitudes of one path at one instant for all channels [tx * num_rx + rx]; N + M antenna legs are computed for
// N x M channels, and all that lies between once for each of the N where hits have to be moved for them.
void evaluate_path(const LocalPath& path, const Instant& instant, const RadioConstants& radio, EvaluationScratch& scratch,
                   const ChannelValues& out);

}  // namespace echopath
