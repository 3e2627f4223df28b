#pragma once
// Computes radar cross sections: what a target alone returns to antennas far away.
#include <complex>
#include <optional>
#include <span>
#include <vector>

#include "echopath/base/plane.h"
#include "echopath/base/threads/job.h"
#include "echopath/scene/scene.h"
#include "echopath/sim/rays/trace_to_error.h"

namespace echopath {

// Holds the directions of a bistatic cross section. Both vectors may have any length and point from the target to the
// antenna.
struct RcsDirections {
  Vec3 incidence = Vec3::UnitX();    // toward the transmitter
  Vec3 observation = Vec3::UnitX();  // toward the receiver; equal to `incidence` if monostatic
};

// Describes the polarisation of an antenna across its line of sight.
struct RcsPolarization {
  enum class Kind {
    kVector,
    kHorizontal,  // in the xy-plane (em/polarization/jones.h, transverse_basis)
    kVertical,    // up
  };
  Kind kind = Kind::kVector;
  Vec3 vector = Vec3::UnitZ();  // kVector: world axes; its part across the line of sight counts
  bool operator==(const RcsPolarization&) const = default;
  // Returns the unit vector of the polarisation of an antenna toward which the unit vector `toward` points. Raises
  // invalid_argument for a `vector` along it.
  Vec3 across(const Vec3& toward) const;
};

struct RcsChannel {
  RcsPolarization transmit, receive;
};

// Describes a cavity whose inside someone else computes.
struct RcsCavity {
  std::vector<uint32_t> walls;  // mesh IDs
  Plane mouth;                  // the plane in which it opens
};

struct RcsSettings {
  double frequency = 77e9;  // Hz
  std::vector<RcsChannel> channels = {RcsChannel{}};
  // These settings hold for the trace of each pair of directions and each transmit polarisation. The scalar model has no
  // cross-polarised reception; from two batches on cross sections have standard errors.
  TraceSettings tracing = {RecordSettings{}, 1 << 17};
  // Doubles the rays until the first channel of each transmit polarisation is known that well, or known to be a null
  // (sim/rays/trace_to_error.h); sets its least_power.
  std::optional<ErrorTarget> target;
  // Leaves out the paths that touch walls of a cavity anywhere but in the plane of its mouth.
  std::vector<RcsCavity> cavities;

  // Raises invalid_argument naming the field, the rule and the value.
  void validate() const;
};

// Returns the cross section in m^2 below which one is a null, a hundredth of the square of the wavelength: physical optics
// leaves out more at an edge that is a wavelength long, so that more rays tell nothing of the target.
double largest_null(double frequency);

// Holds cross sections in m^2. The errors are the standard errors of power/received_power.h, NaN for one batch, and beside
// them, as root sum of squares, what the footprint filter may take away, at the same confidence. Coherent echoes add as
// fields; diffuse ones, whose phases are random, as powers: their mean over realisations of the roughness. With batches the
// coherent part is free of bias by noise, which can take it below zero where it is not resolved.
struct RadarCrossSection {
  double total = 0.0, standard_error = 0.0;
  double coherent = 0.0, coherent_error = 0.0;
  double diffuse = 0.0, diffuse_error = 0.0;
  double error_db = 0.0;  // dB, what was reached where there is a target; else 0
  double high = 0.0;      // upper end of the 95 % interval of `total`, of bias and chance together
  // m: a wave of 1 V/m whose phase is 0 at the world's origin has the coherent echo field e^{-jkr}/r V/m. With one batch
  // `coherent` is 4 pi |field|^2.
  std::complex<double> field = 0.0;
};

// Computes sigma = |sum a e^{-jkL}|^2 (4 pi)^3 R^4 / (Q^2 lambda^2) for each pair, of the scene at time 0, from isotropic
// antennas at a distance R at which the wave fronts are flat over the scene's bounding sphere to 1e-3 rad and their
// amplitude to 1e-4. Returns [pair * channels + channel]. Each pair and transmit polarisation costs a trace of its own,
// which the channels of that polarisation share.
// Raises invalid_argument for bad settings, a zero direction, a direction along a polarization vector, a scene without
// meshes and one with mirrors: they stand for planes without end, which have no cross section. Raises out_of_range for walls
// of cavities that are no meshes of the scene.
std::vector<RadarCrossSection> rcs(const Scene& scene, std::span<const RcsDirections> directions,
                                   const RcsSettings& settings, Job* job);

}  // namespace echopath
